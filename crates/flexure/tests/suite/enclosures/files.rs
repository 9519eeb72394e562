//! Numbers of files: from TOML, from a URDF, with digits that no float has.

use flexure::core::scalar::Interval;
use flexure::robot::{Links, Robot, robot_from_text};
use flexure::scenario::load_scenario;
use flexure::scenario::scenario_from_text;

const PENDULUM: &str = "name = 'arm'
[links]
kind = 'pendulum'
mass = 0.1
com = 0.25
inertia = 0x10
[joints]
stiffness = 55.0
motor_inertia = 3e-1
link_damping = 1_000
motor_damping = 0.0
";

fn pendulum(from: &str, to: &str) -> Robot {
    assert!(PENDULUM.contains(from));
    robot_from_text("arm.toml", &PENDULUM.replace(from, to), ".".as_ref())
        .unwrap_or_else(|problems| panic!("{problems}"))
}

fn ends(x: Interval) -> (f64, f64) {
    (x.lo(), x.hi())
}

/// A tenth is between two floats, of which the one it is read as is the upper.
#[test]
fn numbers_are_their_decimals() {
    let robot = pendulum("", "");
    assert_eq!(ends(robot.bounds(0.1)), (0.1_f64.next_down(), 0.1));
    let Links::Pendulum(flexure::robot::Pendulum { mass, com, inertia }) = robot.enclosed else {
        panic!("a pendulum")
    };
    assert_eq!(
        (ends(mass), ends(com), ends(inertia)),
        ((0.1_f64.next_down(), 0.1), (0.25, 0.25), (16.0, 16.0))
    );
    for x in [55.0, 1000.0, 0.0, f64::INFINITY] {
        assert_eq!(ends(robot.bounds(x)), (x, x));
    }
}

/// One number with digits beyond its float, wherever it stands, and every number is known to one step only.
#[test]
fn excess_digits_are_noticed() {
    for (from, to) in [
        ("0.1", "0.10000000000000000001"),
        ("0.25", "0.25000000000000000001"),
        ("0x10", "0x20000000000001"),
        ("1_000", "9007199254740993"),
        ("3e-1", "0.3000000000000000000001"),
        ("55.0", "[55.000_000_000_000_000_01]"),
    ] {
        let widened = ends(pendulum(from, to).bounds(0.5));
        assert_eq!(widened, (0.5_f64.next_down(), 0.5_f64.next_up()), "{to}");
    }
    for (from, to) in
        [("0.1", "0.1000000000000000000000"), ("0.25", "2500.0000E-4"), ("0x10", "0x20000000000000")]
    {
        assert_eq!(ends(pendulum(from, to).bounds(0.5)), (0.5, 0.5), "{to}");
    }
}

/// A link behind a fixed joint and two that mimic each other, the last of them locked.
const URDF: &str = r#"<robot name="arm"><link name="base"/>
<link name="a"><inertial><origin xyz="0.1 0 0"/><mass value="0.3"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="2.4e-35" izz="0.02"/></inertial></link>
<link name="b"><inertial><mass value="0.7"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
<link name="c"/>
<joint name="turn" type="continuous"><parent link="base"/><child link="a"/><origin xyz="0 0 0.3" rpy="0 0 0"/><axis xyz="0 0.1 0"/></joint>
<joint name="slide" type="prismatic"><parent link="a"/><child link="b"/><mimic joint="push" multiplier="-2" offset="0.7"/></joint>
<joint name="push" type="prismatic"><parent link="a"/><child link="c"/></joint></robot>"#;

fn from_urdf(urdf: &str) -> Robot {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("arm.urdf"), urdf).expect("a file");
    let text = "name = 'arm'
[links]
kind = 'urdf'
file = 'arm.urdf'
locked = { push = 0.3 }
[joints]
stiffness = 100
motor_inertia = 0.1
link_damping = 0.1
motor_damping = 0.2
";
    robot_from_text("arm.toml", text, folder.path()).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Held at 0.7 − 2 · 0.3 = 0.1 m, the 0.7 kg of b and the 0.3 kg of a are centred at 0.1 m: in decimals, exactly.
#[test]
fn the_bodies_of_a_urdf_enclose_what_its_decimals_make() {
    let robot = from_urdf(URDF);
    let Links::Tree(bodies) = &robot.enclosed else { panic!("a tree") };
    let [body] = bodies.as_slice() else { panic!("{bodies:?}") };
    assert_eq!(body.axis.map(ends), [(0.0, 0.0), (1.0, 1.0), (0.0, 0.0)]);
    assert_eq!(body.rotation.map(|row| row.map(Interval::width)), [[0.0; 3]; 3]);
    let inertia = [body.inertia[0][0], body.inertia[1][1], body.inertia[2][2]];
    for (bounds, decimal) in [body.mass, body.com[0], body.translation[2]]
        .into_iter()
        .chain(inertia)
        .zip(["1", "0.1", "0.3", "0.02", "0.03", "0.03"])
    {
        let exact = Interval::from_decimal(decimal).expect("a decimal");
        assert!(bounds.contains_interval(exact) && bounds.width() < 1e-14, "{bounds:?} for {decimal}");
    }
    assert_eq!(ends(robot.bounds(0.5)), (0.5, 0.5), "what is dust is zero");
}

#[test]
fn excess_digits_of_a_urdf_are_noticed() {
    let robot = from_urdf(&URDF.replace(r#"value="0.3""#, r#"value="0.30000000000000000001""#));
    assert_eq!(ends(robot.bounds(0.5)), (0.5_f64.next_down(), 0.5_f64.next_up()));
    let Links::Tree(bodies) = &robot.enclosed else { panic!("a tree") };
    assert!(bodies[0].mass.lo() < 1.0 && bodies[0].mass.hi() > 1.0);
    assert_eq!(bodies[0].axis.map(ends), [(0.0, 0.0), (1.0, 1.0), (0.0, 0.0)]);
}

/// A scenario's own digits do not widen its robot; its robot's widen what the scenario says of its numbers.
#[test]
fn scenarios_know_their_own_numbers() {
    let (_, text) =
        flexure::files::SCENARIOS.iter().find(|(name, _)| *name == "two-link-tanh-smooth").expect("built in");
    let scenario = load_scenario("two-link-tanh-smooth").expect("built in");
    assert_eq!(ends(scenario.bounds(55.0)), (55.0, 55.0));
    let long = text.replace("metric = [55.0, 30.0]", "metric = [55.00000000000000000001, 30.0]");
    let long =
        scenario_from_text("long.toml", &long, ".".as_ref()).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(ends(long.bounds(30.0)), (30.0_f64.next_down(), 30.0_f64.next_up()));
    assert_eq!(ends(long.robot.bounds(30.0)), (30.0, 30.0));
}
