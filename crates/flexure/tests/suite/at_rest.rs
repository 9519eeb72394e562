//! `initial = "at rest"`: robots that hang in their springs and do not move.

use std::path::Path;

use flexure::Scenario;
use flexure::scenario::scenario_from_text;
use flexure::simulate::preload;

const PANDA: &str = include_str!("../../../../scenarios/panda-tanh-smooth.toml");
const PENDULUM: &str = include_str!("../../../../scenarios/pendulum-tanh.toml");

/// `text` with `initial` in place of its own, and `more` at its end.
fn read(text: &str, initial: &str, more: &str) -> Result<Scenario, String> {
    let is_initial = |table: &&str| table.starts_with("initial]");
    let tables: Vec<&str> = text.split("\n[").filter(|table| !is_initial(table)).collect();
    let tables = tables.join("\n[").replace("initial = \"assumed: chosen\"", "");
    let text = format!("{initial}\n{tables}\n{more}");
    scenario_from_text("test.toml", &text, Path::new(".")).map_err(|problems| problems.to_string())
}

/// Largest acceleration [rad/s²] of links and motors under the torque that the springs have.
fn acceleration(scenario: &Scenario) -> f64 {
    let (robot, initial) = (&scenario.robot, &scenario.initial);
    let motion = [&initial.q_l, &initial.q_m, &initial.dq_l, &initial.dq_m].map(Vec::as_slice).concat();
    let bent = initial.q_m.iter().zip(&initial.q_l).map(|(q_m, q_l)| q_m - q_l);
    let u_m: Vec<f64> = bent.zip(&robot.stiffness).map(|(bent, stiffness)| bent * stiffness).collect();
    let mut acceleration = vec![0.0; 2 * robot.joint_count()];
    robot.arm().unwrap().forward_dynamics(&motion, &u_m, &mut acceleration).unwrap();
    acceleration.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
}

#[test]
fn nothing_moves_at_rest() {
    let posture = "at_rest = [0.0, -0.6, 0.0, -1.8, 0.0, 1.5, 0.5]";
    let words = read(PANDA, "initial = \"at rest\"", "").unwrap();
    let table = read(PANDA, "", &format!("[initial]\n{posture}")).unwrap();
    assert_eq!(words.initial, table.initial, "the reference starts there");
    // Stiff springs on light links: an ulp of a position is 1e-16 · 5000 N m/rad on 0.006 kg m².
    assert!(acceleration(&words) < 1e-8, "{}", acceleration(&words));
    // What the file holds to ten digits.
    let written = Scenario::load("panda-tanh-smooth").unwrap();
    for (computed, written) in words.initial.q_m.iter().zip(&written.initial.q_m) {
        assert!((computed - written).abs() < 1e-9, "{computed} {written}");
    }
    assert!(words.assumptions.iter().all(|assumed| assumed.key != "initial"));
    assert!(preload(&words).unwrap().is_none());
    // Of a robot whose motors are anywhere else the same measure says so.
    let mut off = words.clone();
    off.initial.q_m[1] += 1e-4;
    assert!(acceleration(&off) > 0.1);
}

/// Springs that harden and have play carry the pendulum where K ε + k ε³ is its weight, beyond half the play.
#[test]
fn springs_of_the_plant_count() {
    let spring = "[[imperfection]]\nkind = \"spring\"\nhardening = 300.0\ndead_zone = 0.01";
    let scenario = read(PENDULUM, "", &format!("[initial]\nat_rest = [0.7]\n{spring}")).unwrap();
    let (robot, initial) = (&scenario.robot, &scenario.initial);
    let mut weight = [0.0];
    robot.arm().unwrap().inverse_dynamics(&[0.7], &[0.0], &[0.0], &mut weight).unwrap();
    assert!(weight[0] > 0.1);
    let wound = initial.q_m[0] - initial.q_l[0] - 0.01;
    let torque = robot.stiffness[0] * wound + 300.0 * wound.powi(3);
    assert!((torque - weight[0]).abs() < 1e-12 * weight[0], "{torque} {}", weight[0]);
    assert!(preload(&scenario).unwrap().is_none());
}

#[test]
fn what_is_no_posture_is_refused() {
    for (initial, said) in [
        ("initial = \"at reset\"", "did you mean 'at rest'"),
        ("initial = 3", "initial is a number, must be a table"),
        ("initial = \"\"", "initial is empty"),
        ("initial = { at_rest = [0.1], q_m = [0.2] }", "initial.at_rest and initial.q_m are given"),
        ("initial = { at_rest = [0.1, 0.2] }", "1 number expected"),
        ("initial = { at_rest = [nan] }", "must be a number"),
        ("initial = { at_rest = true }", "must be a number"),
        ("initial = { at_rset = [0.1] }", "did you mean 'at_rest'"),
    ] {
        let problems = scenario_problems(initial);
        assert!(problems.contains(said), "{initial}: {problems}");
    }
    // A robot that cannot be read is the only complaint.
    let text = format!("initial = \"at rest\"\n{}", PENDULUM.replace("pendulum-1dof", "pendulum-9dof"));
    let problems = scenario_from_text("test.toml", &text, Path::new(".")).unwrap_err();
    assert_eq!(problems.iter().count(), 1, "{problems}");
}

/// What is said of the pendulum's scenario with `initial`, hints included.
fn scenario_problems(initial: &str) -> String {
    let tables: Vec<&str> = PENDULUM.split("\n[").filter(|table| !table.starts_with("initial]")).collect();
    let text = format!("{initial}\n{}", tables.join("\n["));
    let problems = scenario_from_text("test.toml", &text, Path::new(".")).unwrap_err();
    problems.iter().map(|problem| format!("{problem}; {}", problem.hint())).collect::<Vec<_>>().join("\n")
}
