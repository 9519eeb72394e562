//! A scenario to start with, for a robot that was just imported.

use std::f64::consts::TAU;
use std::fmt::Write;

use crate::files::suggest::text;
use crate::robot::drives::rounded;
use crate::robot::{Import, JointKind, MovingJoint};

/// Largest amplitude \[rad or m\], and the largest part of a joint's range that the whole motion takes.
const AMPLITUDE: (f64, f64) = (0.3, 0.1);
const OF_THE_RANGE: f64 = 0.8;

/// How far joints after the first are bent from the middle of their range \[rad\], to either side in turn, and the largest part of the
/// range: an arm that is stretched has axes in one line, about which its last bodies weigh next to nothing.
const BEND: f64 = 0.6;
const BEND_OF_THE_RANGE: f64 = 0.2;

/// Period of the first joint's sine in s, and how much longer that of each next joint is.
const PERIODS: (f64, f64) = (3.0, 0.4);

/// Control period in s: 1 kHz, as the controllers of most arms.
const PERIOD: f64 = 0.001;

/// Counts in a turn of the motor (17 bits) and of the link (20 bits).
const COUNTS: (f64, f64) = (131_072.0, 1_048_576.0);

/// One count of a linear encoder in m.
const LINEAR_COUNT: f64 = 1e-6;

/// Bandwidth of the disturbance observer [rad/s]: above the motion, and slow beside the loop.
const OBSERVER: f64 = 20.0;

/// Motors that are stopped lose their speed at this rate [1/s].
const STOP_RATE: f64 = 10.0;

/// Drafts a scenario for `import`, whose robot file will be called `robot`: all joints swing about the middle of their range, as
/// fast as the robot's limits allow, with what encoders, computers and drives do between law and robot, and a guard.
pub fn draft(import: &Import, robot: &str) -> String {
    let Import { joints, class, name, .. } = import;
    let per_joint = |of: &dyn Fn(&MovingJoint) -> f64| list(joints.iter().map(of));
    let mut toml = format!(
        "# {} swings about a bent posture near the middle of its range: a scenario to start with. What sensors, computer and drives do is typical, not\n\
         # measured. `flexure check` says what the motion takes, `flexure run` whether the loop follows.\n\n\
         robot = {}\n\
         duration = 10.0                    # s\n\
         control_period = {PERIOD:?}             # s\n\
         initial = \"at rest\"                # where the reference starts, on springs that carry the robot\n\n\
         [reference]                        # rad, m for joints that slide\n\
         kind = \"sine\"\n",
        comment(name),
        text(robot),
    );
    let frequency = |i: usize| rounded(TAU / (PERIODS.0 + PERIODS.1 * i as f64));
    let mut line = |text: String| {
        let _ = writeln!(toml, "{text}");
    };
    line(format!("offset = {}", list(joints.iter().enumerate().map(|(i, joint)| posture(i, joint)))));
    line(format!("amplitude = {}", list(joints.iter().enumerate().map(|(i, joint)| amplitude(i, joint)))));
    line(format!("frequency = {}  # rad/s", list((0..joints.len()).map(frequency))));
    line("\n[reference.time_scaling]".into());
    line("margin = 0.8                       # share of the robot's limits that the motion may take".into());
    line("rise = 2.0                         # s, from rest".into());
    line(
        "\n[controller]                       # with gains that suit the robot: flexure check shows them"
            .into(),
    );
    line("kind = \"vcbc\"".into());
    line("\n[guard]                            # limits are those of the robot".into());
    match class {
        Some(class) => {
            let damping = |joint: &MovingJoint| {
                let torque = joint.drive.torque_limit.unwrap_or_default();
                rounded(STOP_RATE * class.drive(joint.kind, torque).motor_inertia)
            };
            line(format!("stop_damping = {}  # N m s/rad, of the motors while stopped", per_joint(&damping)));
        }
        None => {
            line(
                "stop_damping = nan                 # SUPPLY: N m s/rad, of the motors while stopped".into(),
            );
        }
    }
    line(format!(
        "\n[disturbance_observer]               # makes up for friction and what the model has wrong\nbandwidth = {OBSERVER:?}                   # rad/s"
    ));
    let mut entry = |kind: &str, rest: &[String]| {
        line(format!("\n[[imperfection]]\nkind = \"{kind}\"\n{}", rest.join("\n")));
    };
    let gear = |joint: &MovingJoint| class.map_or(1.0, |class| class.drive(joint.kind, 1.0).gear_ratio);
    let motor = |joint: &MovingJoint| rounded(TAU / (COUNTS.0 * gear(joint)));
    let link = |joint: &MovingJoint| match joint.kind {
        JointKind::Revolute => rounded(TAU / COUNTS.1),
        JointKind::Prismatic => LINEAR_COUNT,
    };
    entry(
        "encoder",
        &[
            "placement = \"motor\"                # 17 bits, behind the gear".into(),
            format!("resolution = {}  # rad", per_joint(&motor)),
        ],
    );
    entry(
        "encoder",
        &[
            "placement = \"link\"                 # 20 bits".into(),
            format!("resolution = {}  # rad", per_joint(&link)),
        ],
    );
    entry(
        "velocity-filter",
        &["order = 2".into(), "cutoff = 200.0                     # Hz".into(), "damping = 0.9".into()],
    );
    entry("saturation", &["# at the torque limits of the robot".into()]);
    entry("delay", &[format!("computation = {PERIOD:?}                # s, one control period")]);
    if let Some(class) = class {
        let typical = |joint: &MovingJoint| {
            class.drive(joint.kind, joint.drive.torque_limit.unwrap_or_default()).friction
        };
        let friction = |joint: &MovingJoint| joint.drive.friction.unwrap_or_else(|| typical(joint));
        entry("friction", &["side = \"motor\"".into(), format!("coulomb = {}  # N m", per_joint(&friction))]);
    }
    let friction = class
        .map_or(String::new(), |class| format!("; friction of the URDF, else {}", class.friction.source));
    line("\n[sources]".into());
    for (key, note) in [
        ("duration", "chosen"),
        ("control_period", "1 kHz, as the controllers of most arms"),
        ("reference", "chosen: about a bent posture near the middle of each range, of different periods"),
        ("disturbance_observer", "chosen: faster than the motion, slower than the loop"),
        ("stop_damping", "a tenth of a second for a motor alone to lose its speed"),
        (
            "imperfection",
            &format!("encoders of 17 and 20 bits, a filter of 200 Hz, a delay of one period{friction}"),
        ),
    ] {
        line(format!("{key} = {}", text(&format!("assumed: {note}"))));
    }
    toml
}

/// The middle of the range of `joint` in rad; 0 where the range has no end, or the end next to 0 where it has one.
fn middle(joint: &MovingJoint) -> f64 {
    match (joint.drive.position_lower, joint.drive.position_upper) {
        (Some(lower), Some(upper)) => (1e6 * 0.5 * (lower + upper)).round() / 1e6 + 0.0,
        (lower, upper) => 0.0_f64.max(lower.unwrap_or(0.0)).min(upper.unwrap_or(f64::INFINITY)),
    }
}

/// How far joint `i` is bent from the middle of its range \[rad\].
fn bend(i: usize, joint: &MovingJoint) -> f64 {
    if i == 0 || joint.kind == JointKind::Prismatic {
        return 0.0;
    }
    let side = if i % 2 == 1 { 1.0 } else { -1.0 };
    side * range(joint).map_or(BEND, |range| BEND.min(BEND_OF_THE_RANGE * range))
}

/// Where joint `i` swings about \[rad or m\].
fn posture(i: usize, joint: &MovingJoint) -> f64 {
    (1e6 * (middle(joint) + bend(i, joint))).round() / 1e6 + 0.0
}

/// Width of the range of `joint` \[rad or m\], if it has both ends.
fn range(joint: &MovingJoint) -> Option<f64> {
    joint.drive.position_upper.zip(joint.drive.position_lower).map(|(upper, lower)| upper - lower)
}

/// Amplitude of the sine of joint `i` \[rad or m\].
fn amplitude(i: usize, joint: &MovingJoint) -> f64 {
    let most = match joint.kind {
        JointKind::Revolute => AMPLITUDE.0,
        JointKind::Prismatic => AMPLITUDE.1,
    };
    let room = range(joint).map(|range| 0.5 * OF_THE_RANGE * range - bend(i, joint).abs());
    rounded(room.map_or(most, |room| most.min(room)))
}

/// Numbers as an array of TOML.
fn list(numbers: impl Iterator<Item = f64>) -> String {
    let numbers: Vec<_> = numbers.map(|x| format!("{x:?}")).collect();
    format!("[{}]", numbers.join(", "))
}

/// `name` in one line.
fn comment(name: &str) -> String {
    name.chars().filter(|c| !c.is_control()).collect()
}
