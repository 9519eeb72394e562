//! Control laws in files: good and bad tables, gains by name, starting gains, and every registered law on every number.

use std::path::Path;

use flexure::core::control::ControlLaw;
use flexure::core::linalg::Vector;
use flexure::core::model::{Fjr, Links, Motion};
use flexure::core::reference::Reference as _;
use flexure::core::scalar::{Dual, Interval, Jet, Over};
use flexure::evaluate::evaluate_law;
use flexure::io::{
    BASELINES, Controller, Problems, Robot, Scenario, StateFile, StateRow, load_robot, load_scenario,
    scenario_from_text,
};
use flexure::proof::{Question, prove};
use flexure::registry::{AnyReference, CONTROLLERS, RobotVisitor, any_law, with_enclosed_robot, with_robot};
use flexure::run::run;

const HEAD: &str = "robot = \"planar-2r\"\nduration = 1.0\ncontrol_period = 0.001\n\
    [reference]\nkind = \"quintic\"\nfrom = 0.0\nto = 0.1\nstart = 0.0\nduration = 1.0\n[controller]\n";

fn read(controller: &str) -> Result<Scenario, Problems> {
    scenario_from_text("test.toml", &format!("{HEAD}{controller}"), Path::new("."))
}

/// `[controller]` as a file has it, two numbers for every gain.
fn written(kind: &str) -> String {
    let shape = BASELINES.iter().find(|shape| shape.kind == kind).expect("registered");
    let gains: String =
        shape.gains.iter().enumerate().map(|(i, gain)| format!("{} = [{i}.5, 7]\n", gain.key)).collect();
    format!("kind = \"{kind}\"\n{gains}")
}

#[test]
fn every_registered_law_is_read() {
    let kinds: Vec<_> = CONTROLLERS.iter().map(|entry| entry.name).filter(|name| *name != "vcbc").collect();
    assert_eq!(kinds.len(), BASELINES.len());
    for kind in kinds {
        let scenario = read(&written(kind)).unwrap_or_else(|problems| panic!("{kind}: {problems}"));
        assert_eq!(scenario.controller.kind(), kind);
        assert_eq!(scenario.controller.phi(), None);
        for (i, (_, values)) in scenario.controller.gains().iter().enumerate() {
            assert_eq!(*values, [i as f64 + 0.5, 7.0]);
        }
    }
}

#[test]
fn bad_controllers_are_refused_at_their_place() {
    for (controller, at, message) in [
        (
            "kind = \"pdd\"\nstiffness = 1\ndamping = 1",
            "\"pdd\"",
            "controller.kind is 'pdd', which is not known",
        ),
        ("kind = \"pd\"\nstiffnes = 1\ndamping = 1", "stiffnes", "unknown key 'stiffnes' in [controller]"),
        ("kind = \"pd\"\nstiffness = 0\ndamping = 1", "0", "controller.stiffness is 0 N m/rad, must be > 0"),
        (
            "kind = \"pd\"\nstiffness = 1\ndamping = -1",
            "-1",
            "controller.damping is -1 N m s/rad, must be >= 0",
        ),
        ("kind = \"pd\"\nstiffness = [1, 2, 3]\ndamping = 1", "[1, 2, 3]", "2 numbers expected"),
        ("kind = \"pd\"\nstiffness = 1", "", "missing key controller.damping"),
        ("kind = \"pd\"\nstiffness = 1\ndamping = 1\nphi = \"tanh\"", "phi", "unknown key 'phi'"),
        ("kind = \"esp\"\nstiffness = \"1\"\ndamping = 1\nlink_damping = 1", "\"1\"", "must be a number"),
        ("kind = 3", "3", "must be text"),
    ] {
        let problems = read(controller).expect_err(controller).to_string();
        assert!(problems.contains(message), "{problems}");
        let line =
            HEAD.lines().count() + controller.lines().position(|line| line.contains(at)).unwrap_or(0) + 1;
        let anywhere = at.is_empty();
        assert!(anywhere || problems.contains(&format!("test.toml:{line}:")), "line {line}: {problems}");
    }
}

#[test]
fn gains_change_by_their_order() {
    for name in CONTROLLERS.iter().map(|entry| entry.name) {
        let robot = load_robot("planar-3r").expect("built in");
        let controller = Controller::default_for(name, &robot).expect("registered");
        let doubled: Vec<Vec<f64>> =
            controller.gains().iter().map(|(_, x)| x.iter().map(|x| 2.0 * x).collect()).collect();
        let changed = controller.with_gains(&doubled);
        assert_eq!(changed.kind(), name);
        for (((path, a), (same, b)), doubled) in controller.gains().iter().zip(changed.gains()).zip(&doubled)
        {
            assert_eq!(*path, same);
            assert!(a.iter().all(|x| *x > 0.0) && b == doubled, "{name}: {path}");
        }
    }
    let scenario = load_scenario("two-link-coupled-tanh").expect("built in");
    let paths: Vec<_> = scenario.controller.gains().into_iter().map(|(path, _)| path).collect();
    let side = ["metric", "shaping", "damping", "kappa"];
    let expected: Vec<_> =
        ["link", "motor"].iter().flat_map(|s| side.map(|key| format!("{s}.{key}"))).collect();
    assert_eq!(paths, expected);
}

fn names() -> impl Iterator<Item = &'static str> {
    CONTROLLERS.iter().map(|entry| entry.name)
}

/// The scenario of a seven-joint arm under gravity with the starting gains of a law.
fn panda(kind: &str) -> Scenario {
    let mut scenario = load_scenario("panda-tanh-smooth").expect("built in");
    scenario.controller = Controller::default_for(kind, &scenario.robot).expect("registered");
    scenario
}

#[test]
fn unknown_kinds_have_no_gains() {
    let robot = load_robot("panda").expect("built in");
    assert!(Controller::default_for("pdd", &robot).is_err());
}

/// Starting gains keep every law within a few degrees of a smooth motion.
#[test]
fn starting_gains_follow() {
    for kind in names() {
        let mut scenario = panda(kind);
        scenario.duration = 1.0;
        let run = run(&scenario, &|_| ()).expect("seven joints");
        assert_eq!(run.divergence, None, "{kind}");
        assert!(run.summary.max_abs_e_l < 0.1, "{kind}: {}", run.summary.max_abs_e_l);
        assert_eq!(run.summary.rate_measured.is_nan(), kind != "vcbc", "{kind}");
    }
}

#[test]
fn certificates_are_for_v_cbc() {
    let problems =
        prove(&read(&written("pd")).expect("good"), &Question::default()).expect_err("no certificate");
    assert!(problems.to_string().contains("controller.kind is 'pd'"), "{problems}");
}

#[test]
fn rows_of_other_laws_leave_out_what_only_v_cbc_has() {
    let scenario = read("kind = \"pd\"\nstiffness = [3, 5]\ndamping = [0.25, 0.5]\n").expect("good");
    let state = StateRow {
        t: 0.0,
        q_l: vec![0.1, -0.1],
        q_m: vec![0.2, 0.3],
        dq_l: vec![0.0, 0.0],
        dq_m: vec![1.0, -2.0],
        ..StateRow::default()
    };
    let states = StateFile { name: "test".to_owned(), rows: vec![state] };
    let rows = evaluate_law(&scenario, &states).expect("finite");
    let row = serde_json::to_value(&rows[0]).expect("JSON");
    let keys: Vec<_> = row.as_object().expect("an object").keys().map(String::as_str).collect();
    assert_eq!(keys, ["H", "e_l", "t", "u_m"]);
    // A horizontal arm: no gravity.
    let expected = [-(3.0 * 0.2 + 0.25), -(5.0 * 0.3 - 0.5 * 2.0)];
    for (u, expected) in rows[0].u_m.iter().zip(expected) {
        assert!((u - expected).abs() < 1e-14, "{u}, expected {expected}");
    }
}

/// A motion near the reference of a scenario at one second.
fn near<const N: usize>(q_ld: &Vector<Jet<f64, 5>, N>) -> Motion<f64, N> {
    let [q, v, ..] = q_ld.derivatives();
    let off = |scale: f64| Vector::from_fn(|i| scale * (i as f64 + 1.0).sin());
    Motion { q_l: q + off(0.01), q_m: q + off(0.012), v_l: v + off(0.1), v_m: v + off(-0.1) }
}

struct Numbers<'a>(&'a Scenario);

impl RobotVisitor for Numbers<'_> {
    type Output = Vec<f64>;

    /// The same values on duals and jets to the bit, the same rates on both; the torques on floats.
    fn visit<L: Links<f64, N> + Sync, const N: usize>(self, robot: Fjr<f64, L, N>) -> Vec<f64> {
        let law = any_law::<f64, N>(&self.0.controller, |x| x);
        let q_ld = AnyReference::new(self.0).expect("a path").at::<5>(1.0);
        let x = near(&q_ld);
        let u = law.torque(&robot, &x, &q_ld);
        let moving = |x: f64| (Dual { value: x, gradient: [x.sin()] }, Jet::<f64, 2>::new([x, x.sin()]));
        let dual = law.torque(&robot, &x.map(|x| moving(x).0), &constant::<Dual<f64, 1>, N>(&q_ld));
        let jet = law.torque(&robot, &x.map(|x| moving(x).1), &constant::<Jet<f64, 2>, N>(&q_ld));
        for ((u, dual), jet) in u.iter().zip(dual.iter()).zip(jet.iter()) {
            assert_eq!([dual.value, jet.coefficient(0)], [u, u]);
            let (a, b) = (dual.gradient[0], jet.coefficient(1));
            assert!((a - b).abs() <= 1e-9 * (1.0 + a.abs()), "{}: {a} and {b}", self.0.controller.kind());
        }
        u.iter().collect()
    }
}

fn constant<T: Over<f64>, const N: usize>(q: &Vector<Jet<f64, 5>, N>) -> Vector<Jet<T, 5>, N> {
    q.map(|q| Jet::from_fn(|k| T::constant(q.coefficient(k))))
}

struct Enclosed<'a>(&'a Scenario);

impl RobotVisitor<Interval> for Enclosed<'_> {
    type Output = Vec<Interval>;

    fn visit<L: Links<Interval, N> + Sync, const N: usize>(
        self,
        robot: Fjr<Interval, L, N>,
    ) -> Vec<Interval> {
        let law = any_law::<Interval, N>(&self.0.controller, |x| self.0.bounds(x));
        let q_ld = AnyReference::<f64, N>::new(self.0).expect("a path").at::<5>(1.0);
        let x = near(&q_ld).map(Interval::point);
        let q_ld = q_ld.map(|q| Jet::from_fn(|k| Interval::point(q.coefficient(k))));
        law.torque(&robot, &x, &q_ld).iter().collect()
    }
}

#[test]
fn every_law_runs_on_every_number() {
    for kind in names() {
        let scenario = panda(kind);
        let robot: &Robot = &scenario.robot;
        let floats = with_robot(robot, Numbers(&scenario)).expect("seven joints");
        let bounds = with_enclosed_robot(robot, Enclosed(&scenario)).expect("seven joints");
        for (u, bounds) in floats.iter().zip(&bounds) {
            // Exact torques lie inside, floats a few thousand roundings from them.
            let slack = 1e-10 * (1.0 + u.abs());
            assert!(bounds.lo() - slack <= *u && *u <= bounds.hi() + slack, "{kind}: {u} and {bounds:?}");
            assert!(bounds.width() < 1e-3 * (1.0 + u.abs()), "{kind}: {bounds:?}");
        }
    }
}
