//! Cycloidal gears, as in the large joints of industrial arms.

use crate::files::Entry;
use crate::robot::drives::{DriveClass, Typical};

pub(super) const CYCLOIDAL: DriveClass = DriveClass {
    entry: Entry { name: "cycloidal", summary: "cycloidal gears, ratio 120: industrial arms" },
    // Nabtesco RV-E: from 6E to 450E, while they accelerate.
    torques: [100.0, 12_000.0],
    stiffness: Typical {
        value: 380.0,
        source: "380 N m/rad for each N m of torque limit, 2.6 mrad at the limit: a Nabtesco RV-42N has 113 N m/arcmin and \
                 gives 1029 N m while it accelerates, 2.5 times what it is rated for (figures of resellers)",
    },
    motor_inertia: Typical {
        value: 0.012,
        source: "0.012 kg m² for each N m of torque limit: a guess, servo motors behind a ratio of 120",
    },
    link_damping: Typical { value: 0.002, source: "0.002 N m s/rad for each N m of torque limit: a guess" },
    motor_damping: Typical {
        value: 0.03,
        source: "0.03 N m s/rad for each N m of torque limit: the order of magnitude, large axes of an ABB IRB 2400 were \
                 identified with 8 to 12 N m s/rad",
    },
    friction: Typical {
        value: 0.04,
        source: "4 % of the torque limit: the order of magnitude, large axes of an ABB IRB 2400 were identified with 17 to 31 N m",
    },
    torque_rate: Typical {
        value: 100.0,
        source: "from zero to the limit within 10 ms: a guess for current loops of servo drives",
    },
    gear_ratio: Typical { value: 120.0, source: "offered in most sizes of the Nabtesco RV-E series" },
};
