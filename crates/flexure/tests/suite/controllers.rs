//! Control laws in files: good and bad tables, gains by name, and starting gains.

use std::path::Path;

use flexure::eval::evaluate_law;
use flexure::files::{Problems, StateFile, StateRow};
use flexure::laws::{CONTROLLERS, Controller, Phi, any_law};
use flexure::prove::question::{Question, prove};
use flexure::robot::load_robot;
use flexure::scenario::load_scenario;
use flexure::scenario::{Scenario, scenario_from_text};
use flexure::simulate::run;

use crate::laws_on_numbers::{arm, place};

const HEAD: &str = "robot = \"quanser-2dof\"\nduration = 1.0\ncontrol_period = 0.001\n\
    [reference]\nkind = \"quintic\"\nfrom = 0.0\nto = 0.1\nstart = 0.0\nduration = 1.0\n[controller]\n";

fn read(controller: &str) -> Result<Scenario, Problems> {
    scenario_from_text("test.toml", &format!("{HEAD}{controller}"), Path::new("."))
}

/// `[controller]` as a file has it, two numbers for every gain.
fn written(kind: &str) -> String {
    let robot = load_robot("quanser-2dof").expect("built in");
    let controller = Controller::default_for(kind, &robot).expect("registered");
    let gains: Vec<_> = controller
        .gains()
        .iter()
        .enumerate()
        .map(|(i, (key, _))| format!("{key} = {:?}", gain(i, key)))
        .collect();
    format!("kind = \"{kind}\"\n{}\n", gains.join("\n"))
}

/// Gain number `i` in these files, which is called `key`: below what springs and dampers allow of some laws.
fn gain(i: usize, key: &str) -> [f64; 2] {
    match key {
        // One for all joints, a factor of at least 1, and a share.
        "step" => [0.25; 2],
        "attenuation" => [1.25; 2],
        "least" => [0.25, 0.125],
        _ => {
            let first = [[0.5, 0.01], [1.5, 0.75], [2.5, 0.8], [0.25, 0.125]];
            first.get(i).copied().unwrap_or([i as f64 + 0.5, 7.0])
        }
    }
}

#[test]
fn every_registered_law_is_read() {
    // Those of v-CBC have tables: `a_kind_alone_has_starting_gains`.
    for kind in names().filter(|name| !["vcbc", "disturbance-rejecting-vcbc"].contains(name)) {
        let scenario = read(&written(kind)).unwrap_or_else(|problems| panic!("{kind}: {problems}"));
        assert_eq!(scenario.controller.kind(), kind);
        assert_eq!(scenario.controller.phi(), None);
        for (i, (key, values)) in scenario.controller.gains().iter().enumerate() {
            assert_eq!(*values, gain(i, key));
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
            // Cross damping is made from the dampers of the robot, which has none.
            let least = if path == "cross" { 0.0 } else { f64::MIN_POSITIVE };
            assert!(a.iter().all(|x| *x >= least) && b == doubled, "{name}: {path}");
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

#[test]
fn unknown_kinds_have_no_gains() {
    let robot = load_robot("panda").expect("built in");
    assert!(Controller::default_for("pdd", &robot).is_err());
}

/// At 1 kHz starting gains keep every law near smooth motions, but for laws of two time scales where a link is too light for
/// damping of its motor to reach it, and, of laws without a model, a somewhat larger error.
#[test]
fn starting_gains_follow() {
    let mut strayed = Vec::new();
    let two_time_scales =
        |kind| ["integral-manifold", "singular-perturbation", "composite-ph"].contains(&kind);
    for (name, kind) in ["panda-tanh-smooth", "tomei-3r-tanh", "planar-3r-tanh"]
        .into_iter()
        .flat_map(|name| names().map(move |kind| (name, kind)))
        .filter(|&(name, kind)| !(name == "tomei-3r-tanh" && two_time_scales(kind)))
    {
        let mut scenario = load_scenario(name).expect("built in");
        scenario.controller = Controller::default_for(kind, &scenario.robot).expect("registered");
        scenario.duration = 2.0;
        let run = run(&scenario, &flexure::progress::unwatched).expect("few joints");
        let error = run.summary.max_abs_e_l;
        // Not a number if it diverged.
        if error.is_nan() || error > if kind == "pid" { WITHOUT_A_MODEL } else { NEAR } {
            strayed.push((name, kind, error));
        }
        assert_eq!(run.summary.rate_pointwise.is_nan(), kind != "vcbc", "{kind}");
    }
    assert!(strayed.is_empty(), "{strayed:?}");
}

/// In rad.
const NEAR: f64 = 0.25;
const WITHOUT_A_MODEL: f64 = 0.6;

/// A file that names a kind alone has the starting gains of its robot, and written down they are read as they are.
#[test]
fn a_kind_alone_has_starting_gains() {
    let robot = load_robot("quanser-2dof").expect("built in");
    let given = |text: &str| read(text).unwrap_or_else(|problems| panic!("{text}: {problems}"));
    for kind in names() {
        let scenario = given(&format!("kind = \"{kind}\""));
        let expected = Controller::default_for(kind, &robot).expect("registered");
        assert!(scenario.controller == expected && scenario.has_starting_gains(), "{kind}");
        let written = expected.to_toml();
        let table = written.strip_prefix("[controller]\n").expect("the table");
        let scenario = given(table);
        assert!(scenario.controller == expected && !scenario.has_starting_gains(), "{written}");
    }
    let shaped = |kind: &'static str| Phi::ALL.iter().map(move |phi| (kind, phi));
    for (kind, phi) in shaped("vcbc").chain(shaped("disturbance-rejecting-vcbc")) {
        let scenario = given(&format!("kind = \"{kind}\"\nphi = \"{}\"", phi.name()));
        assert_eq!(scenario.controller.phi(), Some(phi.name()));
        let written = scenario.controller.to_toml();
        assert_eq!(given(&written[13..]).controller, scenario.controller, "{written}");
    }
    // Λ is a rate, whatever the metric is.
    let side = |metric: f64| format!("metric = {metric}\ndamping = 2");
    for metric in [20.0, 1e4] {
        let scenario = given(&format!(
            "kind = \"vcbc\"\nphi = \"tanh\"\n[controller.link]\n{}\n[controller.motor]\n{}",
            side(metric),
            side(metric)
        ));
        let gains = scenario.vcbc().expect("v-CBC");
        let start = Controller::default_for("vcbc", &robot).expect("registered");
        let rates: Vec<_> = start.gains().into_iter().filter(|(key, _)| key.ends_with("shaping")).collect();
        assert_eq!([&gains.link.shaping[..], &gains.motor.shaping], [rates[0].1, rates[1].1]);
    }
    for (bad, said) in [
        ("kind = \"pd\"\nstiffness = 2", "missing key controller.damping"),
        ("kind = \"vcbc\"\nphi = \"tan\"", "controller.phi is 'tan'"),
        ("kind = \"vcbc\"\n[controller.link]\nmetric = 1\ndamping = 1", "missing key controller.phi"),
    ] {
        let problems = read(bad).expect_err(bad).to_string();
        assert!(problems.contains(said), "{problems}");
    }
    let text = format!("{HEAD}kind = \"pd\"").replace("quanser-2dof", "nothing.toml");
    let problems = scenario_from_text("test.toml", &text, Path::new(".")).expect_err("no robot");
    assert_eq!(problems.iter().count(), 1, "{problems}");
}

/// The residuals are at a key of their own beside the sides, and start where they are left out.
#[test]
fn v_cbc_with_residuals_has_their_bandwidth() {
    let sides = "[controller.link]\nmetric = 20\ndamping = 2\n[controller.motor]\nmetric = 20\ndamping = 2";
    let given = |more: &str| {
        let text = format!("kind = \"disturbance-rejecting-vcbc\"\nphi = \"tanh\"\n{more}{sides}");
        read(&text).unwrap_or_else(|problems| panic!("{text}: {problems}")).controller
    };
    let start =
        Controller::default_for("disturbance-rejecting-vcbc", &load_robot("quanser-2dof").expect("built in"));
    let bandwidth = |controller: &Controller| controller.gains()[0].1.to_vec();
    assert_eq!(bandwidth(&given("")), bandwidth(&start.expect("registered")));
    assert_eq!(bandwidth(&given("bandwidth = [3, 4]\n")), [3.0, 4.0]);
    for (bad, said) in [
        ("bandwidth = 0", "controller.bandwidth is 0 1/s, must be > 0"),
        ("bandwith = 1", "unknown key 'bandwith'"),
        ("phi = \"tanh\"\n[controller.link]\nmetric = 1\ndamping = 1", "missing key controller.motor"),
    ] {
        let problems =
            read(&format!("kind = \"disturbance-rejecting-vcbc\"\n{bad}")).expect_err(bad).to_string();
        assert!(problems.contains(said), "{problems}");
    }
}

/// A kilogram that the model does not know bends v-CBC away from its goal, and with residuals inside it does not.
#[test]
fn v_cbc_with_residuals_carries_what_it_does_not_know() {
    let mut scenario = load_scenario("task-payload").expect("built in");
    let mut left = |kind: &str| {
        scenario.controller = Controller::default_for(kind, &scenario.robot).expect("registered");
        let run = run(&scenario, &flexure::progress::unwatched).expect("few joints");
        let shown = if kind == "vcbc" { "linear" } else { "disturbance-rejecting-vcbc linear" };
        assert_eq!(run.summary.law(), shown);
        run.summary.final_abs_e_l
    };
    let (without, with) = (left("vcbc"), left("disturbance-rejecting-vcbc"));
    assert_eq!(scenario.controller.in_words(), "disturbance-rejecting-vcbc with φ = linear");
    assert!(with < 1e-2 * without, "{with} and {without}");
}

/// Far above the least attenuation the H∞ gain is that of `lqr`, near it another, and what is below no number.
#[test]
fn h_infinity_is_lqr_where_torques_may_cost_anything() {
    let data = load_robot("tomei-3r").expect("built in");
    let (x, q_ld) = place();
    let start = |kind: &str| Controller::default_for(kind, &data).expect("registered");
    let torque = |controller: &Controller| {
        let law = any_law::<f64, 3>(controller, &data, &|x| x);
        law.static_torque(&arm(&data, |x| x, |x| x), &x, &q_ld).expect("no memory")
    };
    let above = |factor: f64| {
        let mut gains: Vec<_> = start("h-infinity").gains().iter().map(|(_, gain)| gain.to_vec()).collect();
        gains[5] = vec![factor; 3];
        start("h-infinity").with_gains(&gains)
    };
    let lqr = torque(&start("lqr"));
    let off = |factor: f64| {
        (torque(&above(factor)) - lqr).iter().zip(lqr.iter()).fold(0.0, |m: f64, (d, u)| m.max((d / u).abs()))
    };
    assert!(off(1e5) < 1e-6 && off(1.05) > 1e-2, "{} {}", off(1e5), off(1.05));
    let one = written("h-infinity");
    for (good, bad, said) in [
        ("[1.25, 1.25]", "0.9", "controller.attenuation is 0.9, must be >= 1"),
        ("[1.25, 1.25]", "[1.25, 1.5]", "attenuation is 1.25 for one joint and 1.5 for another"),
    ] {
        let text = one.replace(good, bad);
        let problems = read(&text).expect_err(&text).to_string();
        assert!(problems.contains(said), "{problems}");
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

/// Every law has a row in both tables of its page, and the first names all its gains.
#[test]
fn every_law_is_on_its_page() {
    let page = include_str!("../../../../docs/controllers.md");
    let robot = load_robot("tomei-3r").expect("built in");
    for name in names().filter(|name| *name != "vcbc") {
        let rows: Vec<_> = page.lines().filter(|line| line.starts_with(&format!("| `{name}` |"))).collect();
        assert_eq!(rows.len(), 2, "{name}");
        for (key, _) in Controller::default_for(name, &robot).expect("registered").gains() {
            assert!(rows[0].contains(&format!("`{key}`")) || rows[0].contains("as above"), "{name}: {key}");
        }
    }
}
