//! Strain wave gears with a ratio of 100, as in most light arms.

use crate::files::Entry;
use crate::robot::drives::{DriveClass, Typical};

pub(super) const HARMONIC_DRIVE: DriveClass = DriveClass {
    entry: Entry { name: "harmonic-drive", summary: "strain wave gears, ratio 100: most light arms" },
    stiffness: Typical {
        value: 150.0,
        source: "150 N m/rad for each N m of torque limit, 6.7 mrad at the limit: K1 over repeated peak torque of \
                 Harmonic Drive CSG gears, ratios from 80, sizes 14 to 40, lies between 130 and 180 per rad",
    },
    motor_inertia: Typical {
        value: 0.01,
        source: "0.01 kg m² for each N m of torque limit: Harmonic Drive FHA-C Mini actuators at ratio 100 have 0.006 to 0.008 at \
                 the output, the published motors of the Panda arm 0.007 to 0.017",
    },
    link_damping: Typical {
        value: 0.001,
        source: "0.001 N m s/rad for each N m of torque limit: bearings of the link, a small part of the gear's losses",
    },
    motor_damping: Typical {
        value: 0.02,
        source: "0.02 N m s/rad for each N m of torque limit: grease and seals, as no-load running torques of strain wave gears \
                 grow with speed",
    },
    friction: Typical {
        value: 0.03,
        source: "3 % of the torque limit: starting torques of strain wave gears seen from the link",
    },
    torque_rate: Typical {
        value: 100.0,
        source: "from zero to the limit within 10 ms: current loops of servo drives",
    },
    gear_ratio: Typical { value: 100.0, source: "the usual ratio of strain wave gears in arms" },
};
