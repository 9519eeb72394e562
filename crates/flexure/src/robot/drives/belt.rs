//! Toothed belts of small ratio, as in arms for research and small arms.

use crate::files::Entry;
use crate::robot::drives::{DriveClass, Typical};

pub(super) const BELT: DriveClass = DriveClass {
    entry: Entry { name: "belt", summary: "toothed belts, ratio 10: small arms, little friction" },
    stiffness: Typical {
        value: 50.0,
        source: "50 N m/rad for each N m of torque limit, 20 mrad at the limit: steel cords of toothed belts stretch by 0.4 % at \
                 their permissible tension, 0.2 m of them on a pulley of 40 mm radius turn it by 20 mrad",
    },
    motor_inertia: Typical {
        value: 0.002,
        source: "0.002 kg m² for each N m of torque limit: servo motors of small inertia behind a ratio of 10",
    },
    link_damping: Typical {
        value: 0.001,
        source: "0.001 N m s/rad for each N m of torque limit: bearings of the link",
    },
    motor_damping: Typical {
        value: 0.005,
        source: "0.005 N m s/rad for each N m of torque limit: bearings of motor and pulleys, and the belt",
    },
    friction: Typical {
        value: 0.02,
        source: "2 % of the torque limit: belts lose 2 to 5 % of the power that they carry",
    },
    torque_rate: Typical {
        value: 200.0,
        source: "from zero to the limit within 5 ms: current loops of servo drives",
    },
    gear_ratio: Typical { value: 10.0, source: "one or two stages of belts" },
};
