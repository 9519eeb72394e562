//! Toothed belts of small ratio, as in arms for research and small arms.

use crate::files::Entry;
use crate::robot::drives::{DriveClass, Typical};

pub(super) const BELT: DriveClass = DriveClass {
    entry: Entry { name: "belt", summary: "toothed belts, ratio 10: small arms, little friction" },
    // From legs of half a N m to arms of 60 N m; a pulley of 40 mm radius cannot give more.
    torques: [0.3, 150.0],
    stiffness: Typical {
        value: 50.0,
        source: "50 N m/rad for each N m of torque limit, 20 mrad at the limit: polyurethane belts with steel cords stretch by \
                 0.4 % at their permissible tension (Elatech T5, BRECO T2,5), 0.2 m of one strand on a pulley of 40 mm radius \
                 turn it by 20 mrad; no robot was compared",
    },
    motor_inertia: Typical {
        value: 0.001,
        source: "0.001 kg m² for each N m of torque limit: the Barrett WAM (cables, ratios of 9 to 42) has 0.0005 to 0.0033 \
                 for each N m that it gives for long, the Solo legs less than 0.001",
    },
    link_damping: Typical { value: 0.001, source: "0.001 N m s/rad for each N m of torque limit: a guess" },
    motor_damping: Typical {
        value: 0.005,
        source: "0.005 N m s/rad for each N m of torque limit: the Barrett WAM (cables) has 0.002 to 0.02 for each N m that it \
                 gives for long",
    },
    friction: Typical {
        value: 0.02,
        source: "2 % of the torque limit: toothed belts pass on up to 98 % of the power (BRECO)",
    },
    torque_rate: Typical {
        value: 200.0,
        source: "from zero to the limit within 5 ms: a guess for current loops of servo drives",
    },
    gear_ratio: Typical { value: 10.0, source: "the Barrett WAM has 9 to 42, the Solo legs 9" },
};
