//! Springs between gear and link that are soft on purpose.

use crate::files::Entry;
use crate::robot::drives::{DriveClass, Typical};

pub(super) const SERIES_ELASTIC: DriveClass = DriveClass {
    entry: Entry { name: "series-elastic", summary: "gears with a soft spring behind them, by design" },
    // From wrists of 15 N m to legs of 450 N m, with reserve.
    torques: [1.0, 500.0],
    stiffness: Typical {
        value: 17.0,
        source: "17 N m/rad for each N m of torque limit, 59 mrad at the limit: soft springs of the TREE and WALK-MAN \
                 actuators have 13 to 32 (parameter files of the CompliantJointToolbox)",
    },
    motor_inertia: Typical {
        value: 0.003,
        source: "0.003 kg m² for each N m of torque limit: actuators of the CompliantJointToolbox have 0.001 to 0.005",
    },
    link_damping: Typical { value: 0.001, source: "0.001 N m s/rad for each N m of torque limit: a guess" },
    motor_damping: Typical {
        value: 0.02,
        source: "0.02 N m s/rad for each N m of torque limit: actuators of the CompliantJointToolbox have 0.012 to 0.08",
    },
    friction: Typical {
        value: 0.03,
        source: "3 % of the torque limit: soft actuators of the CompliantJointToolbox have 3.0 to 3.3 %",
    },
    torque_rate: Typical {
        value: 100.0,
        source: "from zero to the limit within 10 ms: a guess for current loops of servo drives",
    },
    gear_ratio: Typical { value: 100.0, source: "actuators of the CompliantJointToolbox have 50 to 160" },
};
