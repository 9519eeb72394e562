//! Strain wave gears with a ratio of 100, as in most light arms.

use crate::files::Entry;
use crate::robot::drives::{DriveClass, Typical};

pub(super) const HARMONIC_DRIVE: DriveClass = DriveClass {
    entry: Entry { name: "harmonic-drive", summary: "strain wave gears, ratio 100: most light arms" },
    // Harmonic Drive actuators: from 4.8 N m (FHA-8C) to 3400 N m (SHA), smaller ones in hands.
    torques: [0.5, 3500.0],
    stiffness: Typical {
        value: 150.0,
        source: "150 N m/rad for each N m of torque limit, 6.7 mrad at the limit: Harmonic Drive FHA and FHA-C Mini actuators \
                 at ratio 100 have 168 to 304 in their manuals; catalogues of the gears alone were not read",
    },
    motor_inertia: Typical {
        value: 0.01,
        source: "0.01 kg m² for each N m of torque limit: Harmonic Drive FHA-C Mini actuators at ratio 100 have 0.006 to 0.008 \
                 at the output, FHA-C 17 to 40 have 0.012 to 0.029, a public model of the FR3 arm 0.002 to 0.006",
    },
    link_damping: Typical {
        value: 0.001,
        source: "0.001 N m s/rad for each N m of torque limit: a guess, a small part of what gears lose",
    },
    motor_damping: Typical {
        value: 0.02,
        source: "0.02 N m s/rad for each N m of torque limit: the order of magnitude, public models that were identified have \
                 0.002 to 0.2",
    },
    friction: Typical {
        value: 0.03,
        source: "3 % of the torque limit: public models that were identified have 1 to 9 %, starting torques of new gears with \
                 seals 6 to 8 %",
    },
    torque_rate: Typical {
        value: 100.0,
        source: "from zero to the limit within 10 ms: a guess for current loops of servo drives",
    },
    gear_ratio: Typical { value: 100.0, source: "the usual ratio of strain wave gears in arms" },
};
