//! Cycloidal gears, as in the large joints of industrial arms.

use crate::files::Entry;
use crate::robot::drives::{DriveClass, Typical};

pub(super) const CYCLOIDAL: DriveClass = DriveClass {
    entry: Entry { name: "cycloidal", summary: "cycloidal gears, ratio 120: industrial arms" },
    stiffness: Typical {
        value: 380.0,
        source: "380 N m/rad for each N m of torque limit, 2.6 mrad at the limit: Nabtesco RV-E gears have 49 N m/arcmin at \
                 167 N m rated to 392 N m/arcmin at 1568 N m, and the limit is 2.5 times the rated torque",
    },
    motor_inertia: Typical {
        value: 0.012,
        source: "0.012 kg m² for each N m of torque limit: servo motors of medium inertia behind a ratio of 120",
    },
    link_damping: Typical {
        value: 0.002,
        source: "0.002 N m s/rad for each N m of torque limit: main bearings of the gear",
    },
    motor_damping: Typical {
        value: 0.03,
        source: "0.03 N m s/rad for each N m of torque limit: no-load running torques of cycloidal gears grow with speed",
    },
    friction: Typical {
        value: 0.04,
        source: "4 % of the torque limit: no-load running torques of cycloidal gears seen from the link",
    },
    torque_rate: Typical {
        value: 100.0,
        source: "from zero to the limit within 10 ms: current loops of servo drives",
    },
    gear_ratio: Typical { value: 120.0, source: "a usual ratio of cycloidal gears in arms" },
};
