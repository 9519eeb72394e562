//! Impedance of the links by energy that only motors see.

use flexure_core::control::{self, MotorPd, in_series};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::gain::{Gain, MOTOR, SHAPED_INERTIA};
use crate::laws::registry::{Claim, LawKind};
use crate::robot::Robot;
use crate::units;

/// The kind `link-impedance`: [`control::LinkImpedance`].
pub struct LinkImpedance;

impl LawKind for LinkImpedance {
    const NAME: &'static str = "link-impedance";
    const SUMMARY: &'static str = "impedance of the links (after Ott, Albu-Schäffer, Kugi, Hirzinger 2008)";
    const CLAIM: Claim = Claim::Regulation;

    type Gains = [Vec<f64>; 3];
    const GAINS: [Gain; 3] = [
        SHAPED_INERTIA,
        Gain::new(
            "stiffness",
            Quantity::positive(
                "stiffness K_des of the links at rest, below that of the springs",
                units::STIFFNESS,
            ),
            |drive| 0.5 * drive.stiffness,
        ),
        MOTOR[1],
    ];

    fn objection(gains: &Self::Gains, robot: &Robot) -> Option<String> {
        let [_, wanted, _] = gains;
        let joint = robot.stiffness.iter().zip(wanted).position(|(k, wanted)| wanted >= k)?;
        Some(format!(
            "stiffness of joint {} is {} N m/rad, not below the {} N m/rad of its spring: links are as soft as their springs at least",
            joint + 1,
            wanted[joint],
            robot.stiffness[joint]
        ))
    }

    type Core<C: Scalar, const N: usize> = control::LinkImpedance<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        robot: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [inertia, wanted, damping] = gains;
        let stiffness: Vec<f64> =
            robot.stiffness.iter().zip(wanted).map(|(k, wanted)| in_series(*k, *wanted)).collect();
        let [inertia, stiffness, damping] = [inertia, &stiffness, damping].map(&vector);
        control::LinkImpedance { inertia, motor: MotorPd { stiffness, damping } }
    }
}
