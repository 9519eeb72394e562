//! Springs between gear and link that are soft on purpose.

use crate::files::Entry;
use crate::robot::drives::{DriveClass, Typical};

pub(super) const SERIES_ELASTIC: DriveClass = DriveClass {
    entry: Entry { name: "series-elastic", summary: "gears with a soft spring behind them, by design" },
    stiffness: Typical {
        value: 17.0,
        source: "17 N m/rad for each N m of torque limit, 59 mrad at the limit: springs of Baxter, 843 N m/rad at 50 N m and \
                 250 N m/rad at 15 N m",
    },
    motor_inertia: Typical {
        value: 0.01,
        source: "0.01 kg m² for each N m of torque limit: motors and gears as of strain wave actuators at ratio 100",
    },
    link_damping: Typical {
        value: 0.001,
        source: "0.001 N m s/rad for each N m of torque limit: bearings of the link and losses of the spring",
    },
    motor_damping: Typical {
        value: 0.02,
        source: "0.02 N m s/rad for each N m of torque limit: grease and seals of the gear",
    },
    friction: Typical {
        value: 0.03,
        source: "3 % of the torque limit: starting torques of strain wave gears",
    },
    torque_rate: Typical {
        value: 100.0,
        source: "from zero to the limit within 10 ms: current loops of servo drives",
    },
    gear_ratio: Typical { value: 100.0, source: "the usual ratio of gears before series springs in arms" },
};
