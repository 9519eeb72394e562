//! Can the robot have moved so? A log that is another one than it says is refused, without any limits, which many robots lack.
//!
//! Springs carry the links: K (q_m − q_l) goes with τ + D_l q̇_l, where τ are the links' inverse dynamics; and motors move all of it:
//! u goes with M_m q̈_m + D_m q̇_m + D_l q̇_l + τ. Loads, friction and wrong numbers of the robot change by how much, not the sign. Where
//! springs carry the links only if the sides are exchanged, they are; where motors move the robot only if its positions are in degrees, these
//! are. What is merely unlikely is a warning. Everything is smoothed, so that encoders and delays hardly count.

use std::iter::zip;

use crate::files::number::significant;
use crate::files::{Problem, Problems};
use crate::logs::Log;
use crate::logs::smooth::{REACH, rates, rms, smoothed, window};
use crate::robot::{Arm, JointKind, Robot};

/// Torques go together where their correlation is at least this, and one is the other to this factor.
const TOGETHER: f64 = 0.8;
const RIGHT: f64 = 5.0;

/// They do not where it is at most this, or where more than so many times is wanted of what is done: friction takes torque, but gives none.
const APART: f64 = 0.3;
const WRONG: f64 = 10.0;

/// Correlation of torques below which one of them has the other sign.
const AGAINST: f64 = -0.5;

/// Torques that go together this closely, and of which one is the other to another factor than this, have another scale: friction that
/// takes torque changes its course, too.
const CLOSELY: f64 = 0.98;
const SCALED: f64 = 1.5;

/// Another way to read positions.
#[derive(Clone, Copy)]
struct Reading {
    swapped: bool,
    /// Factor on the positions of joints that turn.
    turn: f64,
}

const AS_IT_STANDS: Reading = Reading { swapped: false, turn: 1.0 };
const SWAPPED: Reading = Reading { swapped: true, ..AS_IT_STANDS };
const DEGREES: Reading = Reading { turn: std::f64::consts::PI / 180.0, ..AS_IT_STANDS };

/// What is doubtful about `log` as one of `robot`.
///
/// # Errors
/// If its sides are swapped, or it is in degrees: with the joints that show it.
pub(super) fn check(robot: &Robot, log: &Log) -> Result<Vec<Problem>, Problems> {
    let arm = robot.arm()?;
    let as_read = |reading| Motion::of(robot, &*arm, log, reading);
    let Some(stands) = as_read(AS_IT_STANDS) else { return Ok(Vec::new()) };
    let mut problems = Vec::new();
    let mut refuse = |stands: &[Match], other: &[Match], what: &str, help: &str| {
        let shown = zip(&robot.joints, zip(stands, other));
        let shown = shown.filter(|(_, (stands, other))| stands.apart() && other.together());
        let words: Vec<String> =
            shown.map(|(joint, (stands, other))| format!("{} ({stands}; so: {other})", joint.name)).collect();
        if !words.is_empty() {
            let message = format!("{}: the log has {what}: {}", log.name, words.join(", "));
            problems.push(Problem::new("log-mismatch", message, help));
        }
    };
    if let Some(stands) = stands.carried()
        && let Some(other) = as_read(SWAPPED).and_then(|swapped| swapped.carried())
    {
        refuse(
            &stands,
            &other,
            "links and motors swapped, or the springs do not carry the links",
            "exchange the columns of q_l and q_m: --columns",
        );
    }
    let moved = stands.moved();
    if let Some(degrees) = as_read(DEGREES) {
        refuse(
            &moved,
            &degrees.moved(),
            "positions in degrees, or its torques do not move the robot",
            "--columns with unit = \"deg\" for positions",
        );
    }
    if problems.is_empty() {
        let odd = zip(&robot.joints, &moved).filter(|(_, found)| found.odd());
        let words: Vec<String> = odd.map(|(joint, found)| format!("{} ({found})", joint.name)).collect();
        if !words.is_empty() {
            let message =
                format!("{}: by the robot's numbers other torques move it: {}", log.name, words.join(", "));
            let help = "is it a log of this robot, are its columns, units and signs what they are taken for, the robot's numbers right?";
            problems.push(Problem::new("suspicious", message, help).warning());
        }
    }
    Problems::or_warnings(problems)
}

/// How a torque goes with what it is to do.
#[derive(Clone, Copy, Debug)]
struct Match {
    correlation: f64,
    /// What is to be done over what is done, root mean squares.
    times: f64,
}

impl Match {
    /// Of `done` and `wanted`, both about their means; no numbers that are finite where one of them does not change.
    fn of(done: &[f64], wanted: &[f64]) -> Self {
        let [done, wanted] = [done, wanted].map(|torque| {
            let mean = torque.iter().sum::<f64>() / torque.len() as f64;
            torque.iter().map(|x| x - mean).collect::<Vec<_>>()
        });
        let common = zip(&done, &wanted).map(|(a, b)| a * b).sum::<f64>() / done.len() as f64;
        let [done, wanted] = [done, wanted].map(|torque| rms(&torque, 1, 0));
        Self { correlation: common / (done * wanted), times: wanted / done }
    }

    fn together(self) -> bool {
        self.correlation >= TOGETHER && (RIGHT.recip()..=RIGHT).contains(&self.times)
    }

    fn apart(self) -> bool {
        self.correlation <= APART || self.off()
    }

    /// Nothing is said of torques that do not change.
    fn off(self) -> bool {
        self.times > WRONG && self.times.is_finite()
    }

    /// Whether less is wanted than is done, or more, by a factor that friction does not explain.
    fn scaled(self) -> bool {
        let least = if self.times > 1.0 { TOGETHER } else { CLOSELY };
        self.correlation >= least && !(SCALED.recip()..=SCALED).contains(&self.times)
    }

    fn odd(self) -> bool {
        self.correlation < AGAINST || self.off() || self.scaled()
    }
}

impl std::fmt::Display for Match {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "correlation {:.2}, {} times the torque", self.correlation, significant(self.times, 2))
    }
}

/// Position, rate and second rate of a joint.
type Course = [Vec<f64>; 3];

/// Torques of a log, read in some way and smoothed: a joint each, of the samples that smoothing does not blur.
struct Motion {
    /// Of the springs [N m]; none without positions of both sides.
    springs: Option<Vec<Vec<f64>>>,
    /// What they carry [N m].
    links: Vec<Vec<f64>>,
    /// What motors move [N m].
    all: Vec<Vec<f64>>,
    /// Of the motors, as logged [N m].
    motors: Vec<Vec<f64>>,
}

impl Motion {
    /// None of a log that is too short to be smoothed.
    fn of(robot: &Robot, arm: &dyn Arm, log: &Log, reading: Reading) -> Option<Self> {
        let window = window(REACH, log.period);
        let inside = window.len()..log.samples().checked_sub(window.len())?;
        if inside.len() < window.len() {
            return None;
        }
        let n = log.joints;
        let course = |q: &Vec<f64>| -> Vec<Course> {
            let joint = |i: usize| {
                let turn = if robot.joints[i].kind == JointKind::Revolute { reading.turn } else { 1.0 };
                let q: Vec<f64> = smoothed(q, n, i, &window).iter().map(|q| turn * q).collect();
                let [v, a] = rates(&q, log.period);
                [q, v, a].map(|signal| signal[inside.clone()].to_vec())
            };
            (0..n).map(joint).collect()
        };
        let (q_l, q_m) = (log.q_l.as_ref().map(course), log.q_m.as_ref().map(course));
        let (q_l, q_m) = if reading.swapped { (q_m, q_l) } else { (q_l, q_m) };
        let springs = q_l.as_ref().zip(q_m.as_ref()).map(|(q_l, q_m)| {
            let torque = |i: usize| {
                let deflection = zip(&q_m[i][0], &q_l[i][0]).map(|(q_m, q_l)| q_m - q_l);
                deflection.map(|deflection| robot.stiffness[i] * deflection).collect()
            };
            (0..n).map(torque).collect()
        });
        // Where one side is measured alone the other moves with it.
        let (q_l, q_m) = (q_l.as_ref().or(q_m.as_ref())?, q_m.as_ref().or(q_l.as_ref())?);
        let mut links = weights(arm, q_l, inside.len());
        for (i, torque) in links.iter_mut().enumerate() {
            for (torque, v) in zip(torque, &q_l[i][1]) {
                *torque += robot.link_damping[i] * v;
            }
        }
        let all = |i: usize| {
            let [_, v, a] = &q_m[i];
            let own = zip(a, v).map(|(a, v)| robot.motor_inertia[i] * a + robot.motor_damping[i] * v);
            zip(own, &links[i]).map(|(own, links)| own + links).collect()
        };
        let all = (0..n).map(all).collect();
        let motors = (0..n).map(|i| smoothed(&log.u_m, n, i, &window)[inside.clone()].to_vec()).collect();
        Some(Self { springs, links, all, motors })
    }

    /// How springs go with what they carry.
    fn carried(&self) -> Option<Vec<Match>> {
        let pairs = zip(self.springs.as_ref()?, &self.links);
        Some(pairs.map(|(springs, links)| Match::of(springs, links)).collect())
    }

    /// How motors go with what they move.
    fn moved(&self) -> Vec<Match> {
        zip(&self.motors, &self.all).map(|(motors, all)| Match::of(motors, all)).collect()
    }
}

/// The links' inverse dynamics at so many `samples`, a joint each [N m].
fn weights(arm: &dyn Arm, links: &[Course], samples: usize) -> Vec<Vec<f64>> {
    let mut torques = vec![Vec::with_capacity(samples); links.len()];
    let mut torque = vec![0.0; links.len()];
    for k in 0..samples {
        let [q, v, a] = [0, 1, 2].map(|part| links.iter().map(|link| link[part][k]).collect::<Vec<_>>());
        arm.inverse_dynamics(&q, &v, &a, &mut torque).expect("a number per joint");
        for (all, torque) in zip(&mut torques, &torque) {
            all.push(*torque);
        }
    }
    torques
}
