//! `[[imperfection]]`, `[estimator]`, `[disturbance_observer]`, `[guard]` and `seed` of scenario files: read as written,
//! refused at the right place.

use std::fs;
use std::path::Path;

use flexure::core::scalar::Interval;
use flexure::estimators::{Encoders, Estimator};
use flexure::files::{Problem, Problems};
use flexure::imperfections::IMPERFECTIONS;
use flexure::imperfections::{
    Deadline, DropoutMode, Imperfection, ModelError, Outage, Side, Sides, VelocityFilter,
};
use flexure::plant::Shape;
use flexure::robot::load_robot;
use flexure::robot::{Links, Robot};
use flexure::scenario::{Believed, Collision, Reaction, Rejoin, Scenario, scenario_from_text};
use miette::Diagnostic;
use tempfile::TempDir;

const QUANSER: &str = include_str!("../../../../robots/quanser-2dof.toml");

const DRIVES: &str = "[joints]\ngear_ratio = [100.0, -50.0]\ntorque_limit = [8.39, 1.67]\ntorque_rate_limit = [4000.0, 800.0]\n";

const SCENARIO: &str = r#"robot = "arm.toml"
duration = 2.0
control_period = 0.001
seed = 42
[reference]
kind = "sine"
amplitude = 0.3
frequency = 3.0
[controller]
kind = "vcbc"
phi = "tanh"
[controller.link]
metric = 50.0
damping = 10.0
[controller.motor]
metric = 60.0
damping = 10.0
"#;

/// Every kind, and what the controller does about them.
const REAL: &str = r#"
[[imperfection]]
kind = "encoder"
placement = "motor"
counts_per_turn = 4096
dither = true
[[imperfection]]
kind = "encoder"
placement = "link"
resolution = [1e-4, 2e-4]
[[imperfection]]
kind = "noise"
link = 1e-5
motor = [1e-5, 2e-5]
[[imperfection]]
kind = "sampling"
side = "link"
period = 0.002
[[imperfection]]
kind = "dropout"
from = 0.5
until = 0.6
[[imperfection]]
kind = "dropout"
side = "link"
mode = "hold"
probability = 0.01
mean_length = 3.0
[[imperfection]]
kind = "delay"
computation = 0.0002
actuation = 0.0005
[[imperfection]]
kind = "deadline"
every = 100
[[imperfection]]
kind = "saturation"
[[imperfection]]
kind = "torque-rate"
[[imperfection]]
kind = "current-quantisation"
step = 0.01
[[imperfection]]
kind = "friction"
side = "motor"
coulomb = [0.2, 0.05]
static = [0.3, 0.05]
stribeck_velocity = 0.1
[[imperfection]]
kind = "spring"
hardening = [100.0, 50.0]
dead_zone = 0.001
hysteresis_stiffness = [1.0, 0.5]
hysteresis_torque = 0.02
[[imperfection]]
kind = "model-error"
mass = [1.1, 0.9]
stiffness = 0.7
[imperfection.payload]
mass = 0.2
position = [0.267, 0.0, 0.0]
[[imperfection]]
kind = "push"
torque = [1.0, -0.5]
from = 1.0
duration = 0.1
shape = "half-sine"
[[imperfection]]
kind = "bias"
motor = [0.01, -0.02]
[[imperfection]]
kind = "jump"
side = "motor"
size = [0.0, 6.0]
from = 1.0
[[imperfection]]
kind = "freeze"
side = "link"
from = 1.5
until = 1.6
[estimator]
kind = "observer"
encoders = "both"
bandwidth = [300.0, 400.0]
[disturbance_observer]
bandwidth = 50.0
[guard]
max_age = 1
torque_limit = [8.0, 1.5]
stop_damping = [4.0, 1.0]
rejoin_speed = 0.1
rejoin_error = [0.3, 0.2]
rejoin_duration = 0.2
off_after = 5.0
latch_stops = 3
latch_within = 10.0
position = [3.0, 2.0]
speed = 6.0
deflection = 0.4
jump = 0.05
frozen_after = 5
frozen_travel = 0.01
velocity_gap = [2.0, 3.0]
motor_residual = 1.0
collision = [2.0, 0.5]
reaction = "retract"
retract_duration = 0.1
residual_bandwidth = 30.0
"#;

/// A folder with the paper's arm and data of its drives, and its sister in the laboratory's drawings.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("arm.toml"), QUANSER.replace("[joints]\n", DRIVES)).unwrap();
    fs::write(folder.path().join("plain.toml"), QUANSER).unwrap();
    fs::write(folder.path().join("cad.toml"), QUANSER.replace("[1.510, 0.873]", "[1.500, 0.873]")).unwrap();
    fs::write(folder.path().join("bad.toml"), QUANSER.replace("[1.510, 0.873]", "[-1.5, 0.873]")).unwrap();
    folder
}

fn read(text: &str) -> Result<Scenario, Problems> {
    scenario_from_text("s.toml", text, folder().path())
}

fn good(text: &str) -> Scenario {
    read(text).unwrap_or_else(|problems| panic!("{problems}"))
}

fn with(more: &str) -> String {
    format!("{SCENARIO}{more}\n")
}

#[test]
fn everything_is_read() {
    let scenario = good(&with(REAL));
    assert_eq!(scenario.warnings.len(), 0, "{:?}", scenario.warnings);
    assert_eq!(scenario.seed, 42);
    let kinds: Vec<_> = scenario.imperfections.iter().map(Imperfection::kind).collect();
    for entry in IMPERFECTIONS {
        // A filter and an observer exclude each other; the gain of the drive is read in the tests of whole loops.
        let elsewhere = ["velocity-filter", "torque-gain"].contains(&entry.name);
        assert!(kinds.contains(&entry.name) || elsewhere, "{}", entry.name);
    }
    let [
        motor,
        link,
        noise,
        sampling,
        window,
        chance,
        delay,
        deadline,
        limit,
        rate,
        step,
        friction,
        spring,
        model,
        push,
        bias,
        jump,
        freeze,
    ] = scenario.imperfections.as_slice()
    else {
        panic!("{kinds:?}")
    };
    let Imperfection::Encoder(motor) = motor else { panic!() };
    // 2π/(4096 · 100) and 2π/(4096 · 50): the sense of the gear does not matter.
    let count = std::f64::consts::TAU / 4096.0;
    let resolution = motor.resolution(Side::Motor).unwrap();
    assert!((resolution[0] * 100.0 - count).abs() < 1e-18 && (resolution[1] * 50.0 - count).abs() < 1e-18);
    assert!(motor.resolution(Side::Link).is_none() && motor.dither);
    let Imperfection::Encoder(link) = link else { panic!() };
    assert_eq!(
        (link.link.as_deref(), link.motor.as_deref(), link.dither),
        (Some(&[1e-4, 2e-4][..]), None, false)
    );
    let Imperfection::Noise(noise) = noise else { panic!() };
    assert_eq!(
        (&noise.link, &noise.motor, &noise.link_velocity),
        (&vec![1e-5; 2], &vec![1e-5, 2e-5], &vec![0.0; 2])
    );
    let Imperfection::Sampling(sampling) = sampling else { panic!() };
    assert_eq!((sampling.sides, sampling.periods), (Sides::One(Side::Link), 2));
    let (Imperfection::Dropout(window), Imperfection::Dropout(chance)) = (window, chance) else { panic!() };
    assert_eq!((window.sides, window.mode), (Sides::Both, DropoutMode::Nan));
    assert_eq!(window.outage, Outage::Window { from: 0.5, until: 0.6 });
    assert_eq!((chance.sides, chance.mode), (Sides::One(Side::Link), DropoutMode::Hold));
    assert_eq!(chance.outage, Outage::Random { probability: 0.01, mean_length: 3.0 });
    let Imperfection::Delay(delay) = delay else { panic!() };
    assert!((delay.total() - 7e-4).abs() < 1e-18);
    assert!(matches!(deadline, Imperfection::Deadline(Deadline::Every(100))));
    // From the robot.
    assert!(matches!(limit, Imperfection::Saturation(drive) if drive.limit == [8.39, 1.67]));
    assert!(matches!(rate, Imperfection::TorqueRate(drive) if drive.limit == [4000.0, 800.0]));
    assert!(matches!(step, Imperfection::CurrentQuantisation(drive) if drive.step == [0.01, 0.01]));
    let Imperfection::Friction(friction) = friction else { panic!() };
    let stribeck = friction.stribeck.as_ref().unwrap();
    assert_eq!((friction.side, friction.coulomb.as_slice()), (Side::Motor, &[0.2, 0.05][..]));
    assert_eq!(
        (stribeck.breakaway.as_slice(), stribeck.velocity.as_slice()),
        (&[0.3, 0.05][..], &[0.1, 0.1][..])
    );
    let Imperfection::Spring(spring) = spring else { panic!() };
    assert_eq!((spring.hardening[1], spring.dead_zone[1]), (50.0, 0.001));
    assert_eq!((spring.hysteresis_stiffness[1], spring.hysteresis_torque[1]), (0.5, 0.02));
    assert!(
        matches!(model, Imperfection::ModelError(model) if model.payload.is_some() && model.robot.is_none())
    );
    let Imperfection::Push(push) = push else { panic!() };
    assert_eq!((push.torque[1], push.from, push.duration, push.shape), (-0.5, 1.0, 0.1, Shape::HalfSine));
    assert!(matches!(bias, Imperfection::Bias(bias) if bias.link == [0.0; 2] && bias.motor == [0.01, -0.02]));
    let Imperfection::Jump(jump) = jump else { panic!() };
    assert_eq!((jump.sides, jump.size[1], jump.from), (Sides::One(Side::Motor), 6.0, 1.0));
    assert!(jump.until.is_infinite(), "for good");
    let Imperfection::Freeze(freeze) = freeze else { panic!() };
    assert_eq!((freeze.sides, freeze.from, freeze.until), (Sides::One(Side::Link), 1.5, 1.6));
    let Some(Estimator::Observer { encoders: Encoders::Both, bandwidth }) = scenario.estimator else {
        panic!()
    };
    assert_eq!(bandwidth, [300.0, 400.0]);
    assert!(scenario.disturbance_observer.is_some_and(|o| o.compensate && o.bandwidth == [50.0; 2]));
}

/// Every key of a guard.
#[test]
fn a_guard_is_read() {
    let scenario = good(&with(REAL));
    let guard = scenario.guard.unwrap();
    assert_eq!((guard.torque_limit.as_slice(), guard.torque_rate_limit[0]), (&[8.0, 1.5][..], 4000.0));
    let rejoin = Rejoin {
        after: 10,
        speed: vec![0.1; 2],
        error: vec![0.3, 0.2],
        duration: 0.2,
        settle: 0.2, // no longer than the reference takes
    };
    assert_eq!((guard.max_age, guard.rejoin), (1, rejoin));
    assert_eq!((guard.off_after, guard.latch), (Some(5.0), Some((3, 10.0))));
    let believed = Believed {
        position: [vec![-3.0, -2.0], vec![3.0, 2.0]],
        speed: vec![6.0; 2],
        deflection: vec![0.4; 2],
        jump: vec![0.05; 2],
        frozen: (5, 0.01),
        velocity_gap: vec![2.0, 3.0],
        motor_residual: vec![1.0; 2],
    };
    assert_eq!(guard.believed, believed);
    let collision = Collision { threshold: vec![2.0, 0.5], reaction: Reaction::Retract, retract: 0.1 };
    assert_eq!((guard.collision, guard.residual_bandwidth), (Some(collision), 30.0));
}

/// Nothing is there unless asked for.
#[test]
fn the_default_is_ideal() {
    let scenario = good(&SCENARIO.replace("seed = 42\n", "").replace("arm.toml", "plain.toml"));
    assert_eq!(scenario.seed, 0);
    assert!(scenario.imperfections.is_empty() && scenario.estimator.is_none());
    assert!(scenario.disturbance_observer.is_none() && scenario.guard.is_none());
    assert!(scenario.robot.limits.torque_rate.iter().all(|limit| limit.is_infinite()));
    let filter = |text: &str| match good(&with(text)).imperfections.as_slice() {
        [Imperfection::VelocityFilter(filter)] => *filter,
        other => panic!("{other:?}"),
    };
    let first = "[[imperfection]]\nkind = \"velocity-filter\"\norder = 1\ncutoff = 40";
    assert_eq!(filter(first), VelocityFilter::First { cutoff: 40.0 });
    let second = first.replace("order = 1", "damping = 0.9\norder = 2");
    assert_eq!(filter(&second), VelocityFilter::Second { cutoff: 40.0, damping: 0.9 });
    // Several entries of kinds that come and go, and of those on different sides.
    let push = "[[imperfection]]\nkind = \"push\"\ntorque = 1\nfrom = 0\nduration = 0.1\n";
    let friction = "[[imperfection]]\nkind = \"friction\"\nside = \"link\"\ncoulomb = 1\n";
    let text = push.repeat(3) + friction + &friction.replace("link", "motor");
    assert_eq!(good(&with(&text)).imperfections.len(), 5);
    // The mechanics may be imperfect in continuous time.
    good(&with(&text).replace("seed = 42", "hold = \"continuous\""));
}

/// Numbers of a plant whose model is wrong; the law's robot stays.
#[test]
fn a_wrong_model_is_another_robot() {
    let applied = |text: &str| -> (Robot, Robot) {
        let scenario = good(&with(&format!("[[imperfection]]\nkind = \"model-error\"\n{text}")));
        let [Imperfection::ModelError(model)] = scenario.imperfections.as_slice() else { panic!() };
        (ModelError::apply(model, &scenario.robot), scenario.robot)
    };
    let (plant, robot) = applied("mass = [2.0, 1.0]\nstiffness = [0.5, 1.0]\nmotor_inertia = 3.0");
    let (
        Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { mass, inertia, com, .. }),
        Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { mass: m, inertia: i, com: r, .. }),
    ) = (&plant.links, &robot.links)
    else {
        panic!()
    };
    assert_eq!((*mass, *inertia, com), ([2.0 * m[0], m[1]], [2.0 * i[0], i[1]], r));
    assert_eq!((plant.stiffness, plant.motor_inertia[1]), (vec![4.5, 4.0], 3.0 * robot.motor_inertia[1]));
    assert_eq!(plant.link_damping, robot.link_damping);
    let (plant, robot) = applied("robot = \"cad.toml\"");
    let Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { mass, .. }) = plant.links else { panic!() };
    assert_eq!((mass[0], robot.name), (1.5, "quanser-2dof".to_owned()));
    // 0.2 kg at 0.267 m: mass and first moment add, and so do inertias about the joint.
    let (plant, _) = applied("payload = { mass = 0.2, position = [0.267, 0, 0] }");
    let Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { mass, inertia, com, .. }) = plant.links else {
        panic!()
    };
    assert!((mass[1] - m[1] - 0.2).abs() < 1e-15);
    assert!((mass[1] * com[1] - m[1] * r[1] - 0.2 * 0.267).abs() < 1e-15);
    let about_the_joint = inertia[1] + mass[1] * com[1] * com[1];
    assert!((about_the_joint - (i[1] + m[1] * r[1] * r[1] + 0.2 * 0.267 * 0.267)).abs() < 1e-15);
    let Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { inertia: bounds, .. }) = plant.enclosed else {
        panic!()
    };
    assert!(bounds[1].contains_interval(Interval::point(inertia[1])) && bounds[1].width() < 1e-15);
}

/// A payload on a tree is the same as one more body that is fixed to it.
#[test]
fn payloads_on_trees_are_fixed_bodies() {
    let tree = "name = \"tree\"\n[links]\nkind = \"tree\"\n[[links.joint]]\nname = \"a\"\nkind = \"revolute\"\n\
                axis = [0, 1, 0]\nmass = 2\ncom = [0.1, 0.2, 0.3]\ninertia = [0.02, 0.001, 0, 0.03, 0.002, 0.04]\n";
    let drives = "[joints]\nstiffness = 100\nmotor_inertia = 0.1\nlink_damping = 0\nmotor_damping = 0\n";
    let body = "[[links.joint]]\nname = \"b\"\nparent = \"a\"\nkind = \"fixed\"\nxyz = [0.3, -0.1, 0.2]\nmass = 0.7\ncom = [0, 0, 0]\n\
                inertia = [0, 0, 0, 0, 0, 0]\n";
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: String| {
        fs::write(folder.path().join(name), text).unwrap();
        load_robot(folder.path().join(name).to_str().unwrap()).unwrap_or_else(|problems| panic!("{problems}"))
    };
    let robot = file("bare.toml", format!("{tree}{drives}"));
    let heavy = file("heavy.toml", format!("{tree}{body}{drives}"));
    let more =
        "[[imperfection]]\nkind = \"model-error\"\npayload = { mass = 0.7, position = [0.3, -0.1, 0.2] }\n";
    let text = with(more).replace("arm.toml", "bare.toml");
    let scenario =
        scenario_from_text("s.toml", &text, folder.path()).unwrap_or_else(|problems| panic!("{problems}"));
    let [Imperfection::ModelError(model)] = scenario.imperfections.as_slice() else { panic!() };
    let (Links::Tree(loaded), Links::Tree(heavy)) = (model.apply(&robot).links, heavy.links) else {
        panic!()
    };
    let numbers = |links: &[flexure::robot::Body]| -> Vec<f64> {
        let body = links[0];
        [body.mass].into_iter().chain(body.com).chain(body.inertia.into_iter().flatten()).collect()
    };
    for (a, b) in numbers(&loaded).into_iter().zip(numbers(&heavy)) {
        assert!((a - b).abs() < 1e-15, "{loaded:?} and {heavy:?}");
    }
}

/// What is appended, the text that the problem must point at (in what is appended), its code, and part of the message.
type Case = (&'static str, &'static str, &'static str, &'static str);

const ENTRY: &str = "[[imperfection]]";

/// Bad entries of kind KIND with keys KEYS.
const ENTRIES: &[(&str, &str, &str, &str, &str)] = &[
    ("encoders", "", "\"encoders\"", "unknown-name", "imperfection[0].kind is 'encoders'"),
    ("encoder", "", ENTRY, "missing-key", "neither of counts_per_turn and resolution"),
    (
        "encoder",
        "resolution = 0.1\ncounts_per_turn = 100",
        ENTRY,
        "unused",
        "both of counts_per_turn and resolution",
    ),
    ("encoder", "resolution = -0.1", "-0.1", "range", "imperfection[0].resolution is -0.1 rad, must be >= 0"),
    ("encoder", "counts_per_turn = [4096, 0]", "0]", "range", "counts_per_turn[1] is 0, must be > 0"),
    ("encoder", "resolution = 0.1\nplacement = \"gear\"", "\"gear\"", "unknown-name", "placement is 'gear'"),
    (
        "encoder",
        "resolution = 0.1\nplacement = \"motor\"",
        ENTRY,
        "contradiction",
        "no encoder on the link side",
    ),
    (
        "encoder",
        "resolution = 0.1\nplacement = \"link\"",
        ENTRY,
        "contradiction",
        "no encoder on the motor side",
    ),
    ("encoder", "resolution = 0.1\ndither = 7", "7\n", "type", "dither is a number, must be true or false"),
    ("encoder", "resolution = [0.1, 0.1, 0.1]", "[0.1, 0.1, 0.1]", "length", "2 numbers expected"),
    ("noise", "", ENTRY, "missing-key", "no standard deviation"),
    ("noise", "link = [0.1, nan]", "nan", "missing-number", "link[1] is nan rad"),
    ("noise", "link = 0.1\nvelocity = 0.1", "velocity", "unknown-key", "unknown key 'velocity'"),
    ("sampling", "", ENTRY, "missing-key", "missing key imperfection[0].period"),
    ("sampling", "period = 0.0015", "0.0015", "range", "must be a multiple of control_period, 0.001 s"),
    ("sampling", "period = 0.0004", "0.0004", "range", "must be a multiple of control_period"),
    ("sampling", "period = 3", "3\n", "range", "must be <= duration, 2 s"),
    ("dropout", "", ENTRY, "missing-key", "either from and until, or probability"),
    ("dropout", "from = 1\nprobability = 0.1", ENTRY, "missing-key", "either from and until, or probability"),
    ("dropout", "from = 1", ENTRY, "missing-key", "missing key imperfection[0].until"),
    ("dropout", "from = 1\nuntil = 0.5", "0.5", "range", "from is 1 s and until 0.5 s"),
    ("dropout", "probability = 1.5", "1.5", "range", "probability is 1.5, must be from 0 to 1"),
    ("dropout", "probability = 0.1\nmean_length = 0.5", "0.5", "range", "must be >= 1"),
    ("dropout", "probability = 0.1\nmode = \"zero\"", "\"zero\"", "unknown-name", "mode is 'zero'"),
    (
        "velocity-filter",
        "order = 3\ncutoff = 40",
        "3\n",
        "range",
        "order is 3, must be a whole number from 1 to 2",
    ),
    ("velocity-filter", "order = 1.0\ncutoff = 40", "1.0", "type", "must be a whole number from 1 to 2"),
    ("velocity-filter", "order = 1\ncutoff = 500", "500", "range", "must be < 500 Hz, half the control rate"),
    (
        "velocity-filter",
        "order = 2\ncutoff = 40",
        ENTRY,
        "missing-key",
        "missing key imperfection[0].damping",
    ),
    (
        "velocity-filter",
        "order = 1\ncutoff = 40\ndamping = 1",
        "1\n[",
        "unused",
        "the order is 1, which has no damping",
    ),
    ("bias", "", ENTRY, "missing-key", "neither link nor motor"),
    ("jump", "from = 1", ENTRY, "missing-key", "missing key imperfection[0].size"),
    (
        "jump",
        "size = 1\nfrom = 1\nuntil = 0.75",
        "0.75",
        "range",
        "from is 1 s and until 0.75 s, must be from",
    ),
    ("freeze", "from = 1\nuntil = 0.5", "0.5", "range", "from is 1 s and until 0.5 s, must be from < until"),
    ("delay", "", ENTRY, "missing-key", "neither computation nor actuation"),
    ("delay", "computation = -0.001", "-0.001", "range", "computation is -0.001 s, must be >= 0"),
    (
        "delay",
        "computation = 0.5\nactuation = 2",
        ENTRY,
        "range",
        "the delay is 2.5 s, must be < duration, 2 s",
    ),
    ("deadline", "", ENTRY, "missing-key", "either probability or every"),
    ("deadline", "every = 1", "1\n", "range", "every is 1, must be a whole number from 2"),
    ("deadline", "every = -3", "-3", "range", "every is -3, must be"),
    ("deadline", "every = 2\nprobability = 0.1", ENTRY, "missing-key", "either probability or every"),
    ("saturation", "limit = [1, 0]", "0]", "range", "limit[1] is 0 N m, must be > 0"),
    (
        "torque-rate",
        "limit = [1, 1e-3]",
        ENTRY,
        "range",
        "at 1 N m/s joint 1 takes 8.3900 s to its torque limit",
    ),
    ("current-quantisation", "step = -0.1", "-0.1", "range", "step is -0.1 N m, must be >= 0"),
    (
        "current-quantization",
        "step = 0.1",
        "\"current-quantization\"",
        "unknown-name",
        "'current-quantization'",
    ),
    ("friction", "coulomb = 1", ENTRY, "missing-key", "missing key imperfection[0].side"),
    ("friction", "side = \"both\"\ncoulomb = 1", "\"both\"", "unknown-name", "side is 'both'"),
    (
        "friction",
        "side = \"link\"\ncoulomb = 1\nstatic = [2, 0.5]\nstribeck_velocity = 1",
        "[2, 0.5]",
        "range",
        "static friction of joint 2 is 0.5 N m, must be >= coulomb, 1 N m",
    ),
    ("friction", "side = \"link\"\ncoulomb = 1\nstatic = 2", ENTRY, "missing-key", "stribeck_velocity"),
    ("friction", "side = \"link\"\ncoulomb = 1\nstribeck_velocity = 2", "2\n", "unused", "static is not"),
    ("spring", "", ENTRY, "missing-key", "spring: nothing is given"),
    ("spring", "hysteresis_torque = 1", "1\n", "missing-key", "hysteresis_torque is given alone"),
    ("spring", "dead_zone = -0.1", "-0.1", "range", "dead_zone is -0.1 rad, must be >= 0"),
    ("model-error", "", ENTRY, "missing-key", "model-error: nothing is given"),
    ("model-error", "mass = 0", "0\n", "range", "mass is 0, must be > 0"),
    (
        "model-error",
        "robot = \"pendulum-1dof\"",
        "\"pend",
        "contradiction",
        "has 1 moving joints, must have 2",
    ),
    ("model-error", "robot = \"none.toml\"", "\"none.toml\"", "unreadable", "cannot read"),
    (
        "model-error",
        "robot = \"cad.toml\"\nmass = 1.1",
        "1.1",
        "contradiction",
        "mass is given, and another robot too",
    ),
    (
        "model-error",
        "payload = { mass = 1, position = [0, 0.1, 0] }",
        "[0, 0.1, 0]",
        "range",
        "must be [x, 0, 0]",
    ),
    (
        "model-error",
        "payload = { mass = 1 }",
        "{ mass",
        "missing-key",
        "missing key imperfection[0].payload.position",
    ),
    ("push", "torque = 1\nfrom = 0", ENTRY, "missing-key", "missing key imperfection[0].duration"),
    (
        "push",
        "side = \"motor\"\ntorque = 1\nfrom = 0\nduration = 1",
        "\"motor\"",
        "unknown-name",
        "side is 'motor'",
    ),
    ("push", "torque = 1\nfrom = -1\nduration = 1", "-1", "range", "from is -1 s, must be >= 0"),
];

const CASES: &[Case] = &[
    (
        "[imperfection]\nkind = \"delay\"",
        "[imperfection]",
        "type",
        "imperfection is a table, must be an array of tables",
    ),
    (
        "[estimator]\nkind = \"kalman\"\nbandwidth = 1",
        "\"kalman\"",
        "unknown-name",
        "estimator.kind is 'kalman'",
    ),
    ("[estimator]\nkind = \"observer\"", "[estimator]", "missing-key", "missing key estimator.bandwidth"),
    ("[estimator]\nkind = \"observer\"\nbandwidth = 0", "0\n", "range", "bandwidth is 0 rad/s, must be > 0"),
    (
        "[estimator]\nkind = \"observer\"\nencoders = \"link\"\nbandwidth = 9",
        "\"link\"",
        "unknown-name",
        "encoders is 'link'",
    ),
    ("[disturbance_observer]\nbandwidth = [1]", "[1]", "length", "2 numbers expected"),
    ("[guard]", "[guard]", "missing-key", "missing key guard.stop_damping"),
    ("[guard]\nstop_damping = -1", "-1", "range", "stop_damping is -1 N m s/rad, must be >= 0"),
    (
        "[guard]\nstop_damping = 1\nrejoin_after = 0",
        "0\n",
        "range",
        "rejoin_after is 0, must be a whole number from 1",
    ),
    (
        "[guard]\nstop_damping = 1\nlatch_stops = 3",
        "[guard]",
        "missing-key",
        "latch_stops and latch_within must both be given",
    ),
    (
        "[guard]\nstop_damping = 1\nlatch_stops = 17\nlatch_within = 1",
        "17",
        "range",
        "latch_stops is 17, must be a whole number from 1 to 16",
    ),
    ("[guard]\nstop_damping = 1\njump = 0", "0\n", "range", "jump is 0 rad, must be > 0"),
    ("[guard]\nstop_damping = 1\ncollision = [1, -1]", "-1", "range", "collision[1] is -1 N m, must be > 0"),
    ("[guard]\nstop_damping = 1\nreaction = \"flee\"", "\"flee\"", "unknown-name", "reaction is 'flee'"),
    (
        "[guard]\nstop_damping = 1\nmax_age = 0.5",
        "0.5",
        "type",
        "guard.max_age is a number, must be a whole number from 0",
    ),
    (
        "[[imperfection]]\nkind = \"velocity-filter\"\norder = 1\ncutoff = 40\n[estimator]\nkind = \"observer\"\nbandwidth = 300",
        ENTRY,
        "contradiction",
        "velocity-filter, but [estimator] in line 22 gives velocities too",
    ),
    (
        "[[imperfection]]\nkind = \"saturation\"\n[[imperfection]] \nkind = \"saturation\"\nlimit = 1",
        "[[imperfection]] ",
        "contradiction",
        "a second saturation; the first is in line 18",
    ),
    (
        "[[imperfection]]\nkind = \"encoder\"\nresolution = 0.1\n[[imperfection]] \nkind = \"encoder\"\nplacement = \"link\"\nresolution = 0.1",
        "[[imperfection]] ",
        "contradiction",
        "a second encoder on the link side; the first is in line 18",
    ),
    (
        "[[imperfection]]\nkind = \"sampling\"\nperiod = 0.002\n[[imperfection]] \nkind = \"sampling\"\nside = \"motor\"\nperiod = 0.004",
        "[[imperfection]] ",
        "contradiction",
        "a second sampling on the motor side; the first is in line 18",
    ),
    (
        "[[imperfection]]\nkind = \"delay\"\nactuation = 0.001\n[[imperfection]] \nkind = \"delay\"\ncomputation = 0.001",
        "[[imperfection]] ",
        "contradiction",
        "a second delay; the first is in line 18",
    ),
    (
        "[[imperfection]]\nkind = \"noise\"\nlink_velocity = 0.1\n[[imperfection]]\nkind = \"velocity-filter\"\norder = 1\ncutoff = 40",
        ENTRY,
        "contradiction",
        "noise on velocities, but they are computed from positions, as line 21 says",
    ),
    (
        "[[imperfection]]\nkind = \"encoder\"\nresolution = 0.1\nplacement = \"motor\"\n[[imperfection]]\nkind = \"velocity-filter\"\norder = 1\ncutoff = 40",
        ENTRY,
        "contradiction",
        "no encoder on the link side, but velocity-filter in line 22 needs one",
    ),
    (
        "[[imperfection]]\nkind = \"encoder\"\nresolution = 0.1\nplacement = \"motor\"\n[estimator]\nkind = \"observer\"\nbandwidth = 300",
        ENTRY,
        "contradiction",
        "no encoder on the link side, but [estimator] in line 22 needs one",
    ),
    (
        "[plant]\nspring_hardening = 10\n[[imperfection]]\nkind = \"spring\"\nhardening = 20",
        "20\n",
        "contradiction",
        "imperfection[0].hardening and plant.spring_hardening in line 19 both say",
    ),
    (
        "[[imperfection]]\nkind = \"saturation\"\n[guard]\ntorque_limit = [8.0, 1.68]\nstop_damping = 1",
        "[8.0, 1.68]",
        "contradiction",
        "the guard lets 1.68 N m through for joint 2, must be <= 1.67 N m, the saturation in line 18",
    ),
    (
        "[[imperfection]]\nkind = \"saturation\"\nlimit = 1\n[guard]\nstop_damping = 1",
        "[guard]",
        "contradiction",
        "the guard lets 8.39 N m through for joint 1, must be <= 1 N m",
    ),
    (
        "[[imperfection]]\nkind = \"torque-rate\"\nlimit = 100\n[guard]\ntorque_rate_limit = 1e4\nstop_damping = 1",
        "1e4",
        "contradiction",
        "the guard lets 10000 N m/s through for joint 1, must be <= 100 N m/s, the torque-rate in line 18",
    ),
    (
        "[[imperfection]]\nkind = \"sampling\"\nperiod = 0.005\n[guard]\nmax_age = 3\nstop_damping = 1",
        ENTRY,
        "contradiction",
        "readings become 4 control periods old, guard.max_age is 3",
    ),
];

/// The problem with `fragment` when `more` is appended: at `at`, with a code and a hint.
fn refused(base: &str, (more, at, code, fragment): (&str, &str, &str, &str)) {
    let text = format!("{base}{more}\n[sources]\n");
    let problems = read(&text).err().unwrap_or_else(|| panic!("accepted: {more}"));
    let problem = problems.iter().find(|problem| problem.to_string().contains(fragment));
    let problem = problem.unwrap_or_else(|| panic!("{more}: no '{fragment}' in\n{problems}"));
    let offset = base.len() + text[base.len()..].find(at).unwrap_or_else(|| panic!("no {at} in {more}"));
    let before = &text[..offset];
    let column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
    assert_eq!(problem.line_column(), Some((before.matches('\n').count() + 1, column)), "{more}: {problem}");
    assert_eq!(problem.code().unwrap().to_string(), format!("error[{code}]"), "{more}");
    assert!(problem.hint().len() > 8 && problem.file() == Some("s.toml"), "{more}: {}", problem.hint());
    assert_eq!(problems.iter().filter(|problem| !problem.is_warning()).count(), 1, "{more}:\n{problems}");
}

#[test]
fn bad_entries() {
    for (kind, keys, at, code, fragment) in ENTRIES {
        refused(SCENARIO, (&format!("[[imperfection]]\nkind = \"{kind}\"\n{keys}"), at, code, fragment));
    }
}

#[test]
fn bad_loops() {
    for case in CASES {
        refused(SCENARIO, *case);
    }
    for (seed, fragment) in [("-1", "seed is -1, must be a whole number from 0"), ("0.5", "seed is a number")]
    {
        let text = SCENARIO.replace("42", seed);
        let problems = read(&text).unwrap_err();
        assert!(problems.to_string().starts_with(&format!("s.toml:4:8: {fragment}")), "{problems}");
    }
}

/// In continuous time nothing samples, estimates or guards.
#[test]
fn continuous_loops_have_no_devices() {
    let base = SCENARIO.replace("seed = 42", "hold = \"continuous\"");
    for (more, at, what) in [
        ("[[imperfection]]\nkind = \"delay\"\nactuation = 0.001", ENTRY, "delay"),
        ("[[imperfection]]\nkind = \"encoder\"\nresolution = 0.001", ENTRY, "encoder"),
        ("[[imperfection]]\nkind = \"saturation\"", ENTRY, "saturation"),
        ("[estimator]\nkind = \"observer\"\nbandwidth = 300", "[estimator]", "estimator"),
        ("[disturbance_observer]\nbandwidth = 300", "[disturbance_observer]", "disturbance_observer"),
        ("[guard]\nstop_damping = 1", "[guard]", "guard"),
    ] {
        let fragment = format!("{what}, but hold is \"continuous\" in line 4");
        refused(&base, (more, at, "contradiction", &fragment));
    }
}

#[test]
fn what_the_robot_does_not_say_is_asked_for() {
    let base = SCENARIO.replace("arm.toml", "plain.toml");
    for (more, at, fragment) in [
        (
            "[[imperfection]]\nkind = \"encoder\"\ncounts_per_turn = 4096",
            "4096",
            "robot quanser-2dof has no gear ratios",
        ),
        ("[[imperfection]]\nkind = \"saturation\"", ENTRY, "robot quanser-2dof has no torque_limit"),
        ("[[imperfection]]\nkind = \"torque-rate\"", ENTRY, "robot quanser-2dof has no torque_rate_limit"),
    ] {
        refused(&base, (more, at, "missing-key", fragment));
    }
    // A link encoder needs no gear, but a link that turns.
    good(&format!(
        "{base}[[imperfection]]\nkind = \"encoder\"\nplacement = \"link\"\ncounts_per_turn = 4096\n[[imperfection]]\nkind = \"encoder\"\nplacement = \"motor\"\nresolution = 0.001"
    ));
    // Of a robot that cannot be read nothing is said twice, and of another one in its own file.
    let problems = read(&with("[[imperfection]]\nkind = \"model-error\"\nrobot = \"bad.toml\"")).unwrap_err();
    assert!(problems.iter().next().and_then(Problem::file).is_some_and(|file| file.ends_with("bad.toml")));
    let problems = read(&with(REAL).replace("arm.toml", "bad.toml")).unwrap_err();
    assert_eq!(problems.iter().count(), 1, "{problems}");
}

/// What can be meant, but hardly is.
#[test]
fn doubts_are_said() {
    for (more, fragment) in [
        ("[[imperfection]]\nkind = \"dropout\"\nfrom = 0.5\nuntil = 0.6", "dropout, but there is no guard"),
        ("[[imperfection]]\nkind = \"dropout\"\nfrom = 5\nuntil = 6", "after the end of the run at 2 s"),
        ("[[imperfection]]\nkind = \"encoder\"\nresolution = 1e-3", "encoder, but velocities stay exact"),
        ("[[imperfection]]\nkind = \"encoder\"\nresolution = 4", "it looks like degrees"),
        ("[[imperfection]]\nkind = \"delay\"\ncomputation = 0.7", "is it in milliseconds?"),
        ("[[imperfection]]\nkind = \"push\"\ntorque = 1\nfrom = 3\nduration = 1", "nobody pushes"),
        ("[[imperfection]]\nkind = \"model-error\"\nmass = 110", "is it in percent?"),
        ("[[imperfection]]\nkind = \"velocity-filter\"\norder = 1\ncutoff = 0.01", "between 10 and 1000 Hz"),
    ] {
        let scenario = good(&with(more));
        let said = |problem: &&Problem| format!("{problem} {}", problem.hint()).contains(fragment);
        let found =
            scenario.warnings.iter().find(said).unwrap_or_else(|| panic!("{more}: {:?}", scenario.warnings));
        assert!(found.is_warning() && found.line_column().is_some_and(|(line, _)| line > 17), "{found}");
    }
}

/// Cuts and stray tokens in everything that is new: accepted or refused at a place, never a panic.
#[test]
fn mangled_loops_never_panic() {
    let folder = folder();
    let (mut accepted, mut refused) = (0, 0);
    for at in (0..REAL.len()).step_by(5) {
        for token in ["", "-", "nan", "[", "]", "=", "\"", "\n", "1e308", "true", "é", "."] {
            for cut in [0, 1, 7] {
                let mut text = REAL.to_owned();
                text.replace_range(at..(at + cut).min(REAL.len()), token);
                match scenario_from_text("s.toml", &with(&text), folder.path()) {
                    Ok(_) => accepted += 1,
                    Err(problems) => {
                        refused += 1;
                        assert!(problems.iter().all(|p| p.line_column().is_some()), "{problems}");
                    }
                }
            }
        }
    }
    assert!(accepted > 50 && refused > 1000, "{accepted} accepted, {refused} refused");
}

/// The example of the guide is a good one, and names every kind.
#[test]
fn the_example_of_the_guide_loads() {
    let guide =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/files.md")).unwrap();
    let (_, section) = guide.split_once("## Real loops").expect("a section");
    let (_, example) = section.split_once("```toml\n").expect("an example");
    let (example, _) = example.split_once("```").expect("its end");
    let folder = folder();
    fs::write(folder.path().join("payload.toml"), QUANSER).unwrap();
    let scenario = scenario_from_text("s.toml", &with(&example.replace("seed = 42", "")), folder.path());
    let scenario = scenario.unwrap_or_else(|problems| panic!("{problems}"));
    assert!(scenario.warnings.is_empty(), "{:?}", scenario.warnings);
    for entry in IMPERFECTIONS {
        assert!(section.contains(&format!("`{}`", entry.name)), "{} is not in the guide", entry.name);
    }
}
