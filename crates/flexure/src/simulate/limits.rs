//! Did the robot stay inside its limits?

use std::ops::ControlFlow;

use crate::feasible::limit_words;
use crate::files::Problem;
use crate::robot::{JointKind, Robot};
use crate::simulate::interface::{Signal, of_joints};
use crate::simulate::sink::Sink;
use crate::simulate::trace::Trace;

/// Watches the limits of position, velocity and deflection of a robot's joints along a run.
#[derive(Clone, Debug)]
pub struct LimitWatch<'a> {
    robot: &'a Robot,
    time: Option<usize>,
    joints: Vec<Watched>,
}

/// The columns of a joint, and what came of its limits.
#[derive(Clone, Debug)]
struct Watched {
    q_l: usize,
    q_m: usize,
    v_l: usize,
    /// In the order of [`limits`].
    excesses: [Option<Excess>; 4],
}

/// A limit that was exceeded.
#[derive(Clone, Copy, Debug)]
struct Excess {
    /// From when on \[s\].
    since: f64,
    /// By how much at worst.
    largest: f64,
    /// The value that was so far out.
    value: f64,
}

/// Key and limit of everything that is watched of a joint.
fn limits(robot: &Robot, joint: usize) -> [(&'static str, f64); 4] {
    let limits = &robot.limits;
    [
        ("position_lower", limits.lower[joint]),
        ("position_upper", limits.upper[joint]),
        ("velocity_limit", limits.velocity[joint]),
        ("deflection_limit", limits.deflection[joint]),
    ]
}

impl<'a> LimitWatch<'a> {
    /// Of nothing yet, for runs of `robot` that have these signals.
    pub fn new(robot: &'a Robot, signals: &[Signal]) -> Self {
        let [q_l, q_m, v_l] = ["q_l", "q_m", "dq_l"].map(|prefix| of_joints(signals, prefix));
        let sides = q_l.into_iter().zip(q_m).zip(v_l);
        let joints = sides.map(|((q_l, q_m), v_l)| Watched { q_l, q_m, v_l, excesses: [None; 4] });
        let time = signals.iter().position(|signal| signal.name == "t");
        Self { robot, time, joints: joints.take(robot.joints.len()).collect() }
    }

    /// Whether a sliding joint was outside of its travel: certificates say nothing of robots that are.
    pub fn has_left_travel(&self) -> bool {
        let outside = |excesses: &[Option<Excess>; 4]| excesses[..2].iter().any(Option::is_some);
        let sides = self.robot.joints.iter().zip(&self.joints);
        sides
            .filter(|(joint, _)| joint.kind == JointKind::Prismatic)
            .any(|(_, watched)| outside(&watched.excesses))
    }

    /// A warning for each joint and limit that was exceeded: from when on, and how far. For torques there is
    /// [`Summary::saturated_fraction`](crate::simulate::summary::Summary).
    pub fn warnings(&self) -> Vec<Problem> {
        let mut warnings = Vec::new();
        for (i, watched) in self.joints.iter().enumerate() {
            let joint = &self.robot.joints[i];
            for ((key, limit), excess) in limits(self.robot, i).into_iter().zip(watched.excesses) {
                let Some(Excess { since, value, .. }) = excess else { continue };
                let (what, unit) = limit_words(key, joint.kind);
                let message = format!(
                    "joint {}: {what} exceeds {key}, {limit} {unit}, from t = {since:.3} s on: {value:.4} {unit} at worst",
                    joint.name,
                );
                let hint = "the simulation does not stop there; choose a slower or smaller reference";
                let places = &self.robot.places;
                warnings.push(places.problem(&format!("joints.{key}"), "limits", message, hint).warning());
            }
        }
        warnings
    }
}

impl Sink for LimitWatch<'_> {
    fn take(&mut self, row: &[f64]) -> ControlFlow<()> {
        let now = self.time.map_or(f64::NAN, |column| row[column]);
        for (i, watched) in self.joints.iter_mut().enumerate() {
            let [(_, lower), (_, upper), (_, velocity), (_, deflection)] = limits(self.robot, i);
            let (q, v, zeta) = (row[watched.q_l], row[watched.v_l], row[watched.q_m] - row[watched.q_l]);
            let found =
                [(q, lower - q), (q, q - upper), (v, v.abs() - velocity), (zeta, zeta.abs() - deflection)];
            for (excess, (value, largest)) in watched.excesses.iter_mut().zip(found) {
                if largest > 0.0 && excess.is_none_or(|before| largest >= before.largest) {
                    *excess =
                        Some(Excess { since: excess.map_or(now, |excess| excess.since), largest, value });
                }
            }
        }
        ControlFlow::Continue(())
    }
}

/// The [warnings](LimitWatch::warnings) of a recorded run.
pub fn exceeded(robot: &Robot, trace: &Trace) -> Vec<Problem> {
    let mut watch = LimitWatch::new(robot, &trace.signals());
    trace.pour(&mut watch);
    watch.warnings()
}
