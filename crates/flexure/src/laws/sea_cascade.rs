//! The cascade that series-elastic drives run.

use flexure_core::control::{self, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::gain::{Gain, LINK};
use crate::laws::registry::LawKind;
use crate::robot::Robot;
use crate::units;

/// The kind `sea-cascade`: [`control::SeaCascade`].
pub struct SeaCascade;

impl LawKind for SeaCascade {
    const NAME: &'static str = "sea-cascade";
    const SUMMARY: &'static str =
        "torque by velocity, velocity by torque: the cascade of series-elastic drives";
    const MEMORY: &'static [(&'static str, &'static str)] = &[("z_torque", "N m s"), ("z_velocity", "rad")];

    type Gains = [Vec<f64>; 6];
    const GAINS: [Gain; 6] = [
        LINK[0],
        LINK[1],
        Gain::new(
            "torque",
            Quantity::positive("motor velocity K_τ for spring torque", units::ADMITTANCE),
            |drive| drive.inner_bandwidth() / drive.stiffness,
        ),
        Gain::new(
            "torque_integral",
            Quantity::non_negative("motor velocity K_τi for its integral", units::ADMITTANCE_RATE),
            |drive| drive.bandwidth() * drive.inner_bandwidth() / drive.stiffness,
        ),
        Gain::new(
            "velocity",
            Quantity::positive("motor torque K_w for motor velocity", units::DAMPING),
            |drive| 3.0 * drive.inner_bandwidth() * drive.motor_inertia,
        ),
        Gain::new(
            "velocity_integral",
            Quantity::non_negative("motor torque K_wi for its integral", units::STIFFNESS),
            |drive| 3.0 * drive.inner_bandwidth() * drive.bandwidth() * drive.motor_inertia,
        ),
    ];

    type Core<C: Scalar, const N: usize> = control::SeaCascade<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [stiffness, damping, torque, torque_integral, velocity, velocity_integral] =
            gains.each_ref().map(vector);
        let link = MotorPd { stiffness, damping };
        control::SeaCascade { link, torque, torque_integral, velocity, velocity_integral }
    }
}
