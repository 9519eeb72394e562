//! A certified rate once more, by the engine that knows nothing of how it was found.

use flexure_core::scalar::{Interval, Scalar};

use crate::files::Problems;
use crate::laws::{law, law_over};
use crate::prove::engine::certificate::Certificate;
use crate::prove::engine::direct::{DirectWitness, Proved, StateBox, VcbcLoop, full_turn, prove, vcbc};
use crate::prove::engine::number::Number;
use crate::prove::engine::verdict::Verdict;
use crate::robot::sized::{OF_THE_KIND, fjr, sized};
use crate::robot::{JointKind, Robot};
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
///
/// # Panics
/// Never: the links are of the type that was chosen by their kind.
pub fn confirm(
    scenario: &Scenario,
    certificate: &Certificate,
    speed: f64,
    budget: usize,
) -> Result<Confirmation, Problems> {
    let gains = scenario.vcbc()?;
    let robot = &scenario.robot;
    let rate = certificate.contraction_rate.bounds().lo() * SHARE;
    Ok(sized!(robot, L, N => {
        let enclosed = fjr(robot, &robot.enclosed, |x| robot.bounds(x), &Interval::midpoint);
        let point = fjr(robot, &robot.links, |x| x, &|x| x);
        let bounds = VcbcLoop::<Interval, L<Interval>, _, _, N> {
            robot: enclosed.expect(OF_THE_KIND),
            law: law_over(gains, |x| scenario.bounds(x)),
        };
        let point = VcbcLoop::<f64, L<f64>, _, _, N> { robot: point.expect(OF_THE_KIND), law: law(gains) };
        prove(&vcbc(bounds, point, &region(scenario, certificate, speed)), rate, budget)
    }))
}

/// The region of `certificate` with link speeds of up to `speed` [rad/s].
fn region<const N: usize>(scenario: &Scenario, certificate: &Certificate, speed: f64) -> StateBox<N> {
    let n = scenario.robot.joint_count();
    let errors = &certificate.region.error;
    let around = |x: f64| Interval::point(-x).hull(Interval::point(x));
    let error = |i: usize| errors[i].as_ref().map_or(Interval::ENTIRE, |e: &Number| around(e.bounds().hi()));
    let of_joints = |range: &dyn Fn(usize) -> Interval| {
        std::array::from_fn(|i| if i < n { range(i) } else { Interval::ZERO })
    };
    StateBox {
        error_l: of_joints(&error),
        error_m: of_joints(&|i| error(n + i)),
        velocity_error_l: of_joints(&|_| Interval::ENTIRE),
        velocity_error_m: of_joints(&|_| Interval::ENTIRE),
        position: of_joints(&|i| range(&scenario.robot, i)),
        velocity: of_joints(&|_| around(speed)),
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
