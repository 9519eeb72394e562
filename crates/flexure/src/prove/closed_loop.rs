//! The closed loop of a scenario as the engines take it: over intervals that enclose its decimals, its joint count hidden.

use flexure_core::scalar::{Interval, Scalar};

use crate::feasible;
use crate::files::Problems;
use crate::laws::{law, law_over};
use crate::prove::engine::certificate::Certificate;
use crate::prove::engine::direct::{Flow, StateBox, VcbcLoop, full_turn, vcbc};
use crate::prove::engine::envelope::closed_loop::{Enclosed, TrackingLoop};
use crate::prove::engine::number::Number;
use crate::robot::links::FromFile as _;
use crate::robot::sized::{OF_THE_KIND, fjr, sized};
use crate::robot::{JointKind, Robot};
use crate::scenario::Scenario;

/// The loop along its reference.
///
/// # Errors
/// If the law is not v-CBC, the robot has too many joints, or the reference is no path inside the limits.
pub(crate) fn along_reference(scenario: &Scenario) -> Result<Box<dyn TrackingLoop>, Problems> {
    let (gains, robot) = (scenario.vcbc()?, &scenario.robot);
    Ok(sized!(robot, L, N => {
        let enclosed =
            fjr::<_, L<Interval>, N>(robot, &robot.enclosed, |x| robot.bounds(x), &Interval::midpoint);
        let alone = (0..robot.joint_count()).map(|link| {
            let only = robot.enclosed.only(link);
            L::<Interval>::from_file(&only, robot.gravity.map(|x| robot.bounds(x)), &Interval::midpoint)
        });
        let alone = alone.collect::<Option<_>>().expect(OF_THE_KIND);
        let reference = feasible::enclosed_reference::<N>(scenario)?;
        let [breaks, kinks] = [reference.breaks(), reference.kinks()];
        let law = law_over(gains, |x| scenario.bounds(x));
        Box::new(Enclosed { robot: enclosed.expect(OF_THE_KIND), alone, law, reference, breaks, kinks })
    }))
}

/// The variations of the loop over the region of `certificate`: what the direct engine proves about.
///
/// # Errors
/// If the law is not v-CBC, or the robot has too many joints.
pub(crate) fn over_region(scenario: &Scenario, certificate: &Certificate) -> Result<Box<dyn Flow>, Problems> {
    let (gains, robot) = (scenario.vcbc()?, &scenario.robot);
    Ok(sized!(robot, L, N => {
        let enclosed = fjr(robot, &robot.enclosed, |x| robot.bounds(x), &Interval::midpoint);
        let point = fjr(robot, &robot.links, |x| x, &|x| x);
        let bounds = VcbcLoop::<Interval, L<Interval>, _, _, N> {
            robot: enclosed.expect(OF_THE_KIND),
            law: law_over(gains, |x| scenario.bounds(x)),
        };
        let point = VcbcLoop::<f64, L<f64>, _, _, N> { robot: point.expect(OF_THE_KIND), law: law(gains) };
        Box::new(vcbc(bounds, point, &region(robot, certificate)))
    }))
}

/// The region of `certificate`.
fn region<const N: usize>(robot: &Robot, certificate: &Certificate) -> StateBox<N> {
    let n = robot.joint_count();
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
        position: of_joints(&|i| range(robot, i)),
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
