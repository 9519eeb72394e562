//! Regulation by interconnection and damping assignment.

use flexure_core::control::{self, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::Drive;
use crate::laws::gain::{Gain, MOTOR, SHAPED_INERTIA};
use crate::laws::registry::{Claim, Doubt, LawKind};
use crate::robot::Robot;
use crate::units;

/// The kind `ida-pbc`: [`control::IdaPbc`].
pub struct IdaPbc;

impl LawKind for IdaPbc {
    const NAME: &'static str = "ida-pbc";
    const SUMMARY: &'static str =
        "regulation by interconnection and damping assignment (after Zhang et al. 2014)";
    const CLAIM: Claim = Claim::Regulation;

    type Gains = [Vec<f64>; 4];
    const GAINS: [Gain; 4] = [
        SHAPED_INERTIA,
        MOTOR[0],
        MOTOR[1],
        Gain::new(
            "cross",
            Quantity::non_negative("damping R of links, fed to the motors", units::DAMPING),
            Drive::cross_damping,
        ),
    ];

    fn doubt(gains: &Self::Gains, robot: &Robot) -> Option<Doubt> {
        let [inertia, _, damping, cross] = gains;
        let joint = (0..cross.len()).find(|&i| {
            (cross[i] * inertia[i] / robot.motor_inertia[i]).powi(2) > robot.link_damping[i] * damping[i]
        })?;
        let message = format!(
            "cross of joint {} is {} N m s/rad, too much for its dampers: (cross · inertia / motor_inertia)² must not exceed link_damping · damping, or \
             motion may feed energy into the loop",
            joint + 1,
            cross[joint]
        );
        Some(Doubt { message, help: "lower cross, or raise damping: what is proved of the law holds then" })
    }

    type Core<C: Scalar, const N: usize> = control::IdaPbc<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [inertia, stiffness, damping, cross] = gains.each_ref().map(vector);
        control::IdaPbc { inertia, motor: MotorPd { stiffness, damping }, cross }
    }
}
