//! A certified rate once more, by the engine that knows nothing of how it was found.

use flexure_core::model::{Fjr, Links};
use flexure_core::scalar::Interval;

use crate::files::Problems;
use crate::laws::{VcbcGains, law, law_over};
use crate::prove::engine::certificate::Certificate;
use crate::prove::engine::direct::{DirectWitness, Proved, StateBox, VcbcLoop, full_turn, prove, vcbc};
use crate::prove::engine::number::Number;
use crate::prove::engine::verdict::Verdict;
use crate::robot::{JointKind, Robot, TwinVisitor, with_twins};
use crate::scenario::Scenario;

/// What is left of a certified rate for the direct engine to prove: the certificate's last digits are those of its own
/// rounding.
const SHARE: f64 = 1.0 - 1e-9;

/// What the direct engine says of a certified rate.
pub type Confirmation = Verdict<Proved, DirectWitness>;

/// Proves the contraction rate of `certificate` again, on its region and for link speeds of up to `speed` [rad/s], from
/// the full inequality, looking at no more than `budget` boxes.
///
/// # Errors
/// If the robot has too many joints, or the law is not v-CBC.
pub fn confirm(
    scenario: &Scenario,
    certificate: &Certificate,
    speed: f64,
    budget: usize,
) -> Result<Confirmation, Problems> {
    let gains = scenario.vcbc()?;
    with_twins(&scenario.robot, Confirm { scenario, gains, certificate, speed, budget })
}

struct Confirm<'a> {
    scenario: &'a Scenario,
    gains: &'a VcbcGains,
    certificate: &'a Certificate,
    speed: f64,
    budget: usize,
}

impl TwinVisitor for Confirm<'_> {
    type Output = Confirmation;

    fn visit<E: Links<Interval, N>, F: Links<f64, N>, const N: usize>(
        self,
        enclosed: Fjr<Interval, E, N>,
        point: Fjr<f64, F, N>,
    ) -> Confirmation {
        let Self { scenario, gains, certificate, speed, budget } = self;
        let errors = &certificate.region.error;
        let around = |x: f64| Interval::point(-x).hull(Interval::point(x));
        let error =
            |i: usize| errors[i].as_ref().map_or(Interval::ENTIRE, |e: &Number| around(e.bounds().hi()));
        let region = StateBox {
            error_l: std::array::from_fn(error),
            error_m: std::array::from_fn(|i| error(N + i)),
            velocity_error_l: [Interval::ENTIRE; N],
            velocity_error_m: [Interval::ENTIRE; N],
            position: std::array::from_fn(|i| range(&scenario.robot, i)),
            velocity: [around(speed); N],
        };
        let bounds = VcbcLoop { robot: enclosed, law: law_over(gains, |x| scenario.bounds(x)) };
        let point = VcbcLoop { robot: point, law: law(gains) };
        let rate = certificate.contraction_rate.bounds().lo() * SHARE;
        prove(&vcbc(bounds, point, &region), rate, budget)
    }
}

/// Every angle for a joint that turns, the travel for one that slides.
fn range(robot: &Robot, joint: usize) -> Interval {
    match robot.joints[joint].kind {
        JointKind::Revolute => full_turn(),
        JointKind::Prismatic => {
            Interval::new(robot.limits.lower[joint], robot.limits.upper[joint]).unwrap_or(Interval::ENTIRE)
        }
    }
}
