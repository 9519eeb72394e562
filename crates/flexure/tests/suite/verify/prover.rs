//! What the prover writes: both checkers accept it for every built-in scenario, and refuse it once it claims a millionth
//! more, or lacks a case.

use flexure::files::SCENARIOS;
use flexure::prove::proposition::proposition;
use flexure::prove::question::{Question, Region};
use flexure::prove::verified::certify;
use flexure::robot::robot_from_text;
use flexure::scenario::load_scenario;
use flexure::verify::verify;
use serde_json::Value;

use super::python;

/// A certificate of each scenario: errors up to 0.3 rad, a disturbance of 0.1 mN m on every motor, and under tanh velocity errors up to
/// 0.1 rad/s.
pub fn certificates() -> Vec<(&'static str, Value)> {
    SCENARIOS
        .iter()
        .map(|&(name, _)| {
            let scenario = load_scenario(name).unwrap();
            let n = scenario.robot.joint_count();
            let question = Question {
                region: Region::Errors(vec![0.3; 2 * n]),
                disturbance: Some(vec![1e-4; n]),
                velocity_error: (scenario.controller.phi() == Some("tanh")).then(|| vec![0.1; 2 * n]),
                ..Question::default()
            };
            let verdict = certify(&proposition(&scenario, &question, None).unwrap());
            let certificate = verdict.proved().unwrap_or_else(|| panic!("{name}: {verdict:?}"));
            (name, serde_json::to_value(certificate).unwrap())
        })
        .collect()
}

/// The number at `path` times `factor`.
fn scaled(certificate: &Value, paths: &[&str], factor: f64) -> Value {
    let mut mutant = certificate.clone();
    for path in paths {
        let number = mutant.pointer_mut(path).unwrap();
        *number = (number.as_str().unwrap().parse::<f64>().unwrap() * factor).to_string().into();
    }
    mutant
}

/// Every claim a millionth stronger, one at a time, and every block without its last case.
fn mutants(certificate: &Value) -> Vec<Value> {
    let mut mutants = vec![
        scaled(certificate, &["/contraction_rate"], 1.0 + 1e-6),
        scaled(certificate, &["/convergence_rate"], 1.0 + 1e-6),
        scaled(certificate, &["/region/level"], 1.0 + 1e-6),
        scaled(certificate, &["/tube/level"], 1.0 - 1e-6),
    ];
    for block in 0..4 {
        let of = |rate: &str| format!("/blocks/{block}/{rate}");
        let (contraction, convergence) = (of("contraction"), of("convergence"));
        if block < 2 {
            mutants.push(scaled(certificate, &[&contraction], 1.0 + 1e-6));
            mutants.push(scaled(certificate, &[&convergence], 1.0 + 1e-6));
        } else {
            mutants.push(scaled(certificate, &[&contraction, &convergence], 1.0 + 1e-6));
        }
        let mut fewer = certificate.clone();
        fewer.pointer_mut(&of("cases")).unwrap().as_array_mut().unwrap().pop();
        mutants.push(fewer);
    }
    if !certificate["stretched"].is_null() {
        mutants.push(scaled(certificate, &["/stretched/rate"], 1.0 + 1e-6));
    }
    for measure in 0..6 {
        mutants.push(scaled(certificate, &[&format!("/measures/{measure}/bound")], 1.0 + 1e-6));
    }
    mutants
}

/// A form with a wrong sign, a number that is not there and one too many, or a millionth less of it: refused by both checkers.
#[test]
fn forms_that_bound_nothing_are_refused() {
    let scenario = load_scenario("panda-tanh-smooth").unwrap();
    let verdict = certify(&proposition(&scenario, &Question::default(), None).unwrap());
    let certificate = serde_json::to_value(verdict.proved().unwrap()).unwrap();
    let path = |joint: usize, i: usize| format!("/mass_matrix/forms/{joint}/{i}");
    let (mut wrong, mut malformed) = (Vec::new(), Vec::new());
    for joint in 1..7 {
        let numbers: Vec<_> = (0..7).map(|i| path(joint, i)).collect();
        let all: Vec<&str> = numbers.iter().map(String::as_str).collect();
        wrong.push(scaled(&certificate, &all, 1.0 - 1e-6).to_string());
        // Parts of ω and of v across and along the axis.
        wrong.extend(all[..4].iter().map(|one| scaled(&certificate, &[one], -1.0).to_string()));
        let changed = |change: &dyn Fn(&mut Vec<Value>)| {
            let mut mutant = certificate.clone();
            let forms = mutant.pointer_mut(&format!("/mass_matrix/forms/{joint}")).unwrap();
            change(forms.as_array_mut().unwrap());
            mutant.to_string()
        };
        malformed.push(changed(&|form| drop(form.pop())));
        malformed.push(changed(&|form| form.push("0".into())));
    }
    for (texts, code) in [(wrong, 1), (malformed, 2)] {
        for text in &texts {
            let rejected = verify(text).unwrap_err();
            let malformed = matches!(rejected, flexure::verify::Rejected::Malformed { .. });
            assert_eq!(malformed, code == 2, "{rejected}");
        }
        assert!(python::codes(&texts).is_none_or(|codes| codes.iter().all(|&found| found == code)));
    }
}

/// A sliding joint between two that turn: its form is asked at both ends of its travel.
#[test]
fn a_sliding_joint_on_the_way() {
    let text = "name = 'slider'\n[links]\nkind = 'tree'\n\
        [[links.joint]]\nname = 'a'\nkind = 'revolute'\nmass = 1.0\ncom = [0.1, 0.0, 0.0]\ninertia = [0.1, 0.0, 0.0, 0.1, 0.0, 0.1]\n\
        [[links.joint]]\nname = 'b'\nparent = 'a'\nkind = 'prismatic'\naxis = [1.0, 0.0, 0.0]\nmass = 1.0\ncom = [0.0, 0.0, 0.0]\n\
        inertia = [0.1, 0.0, 0.0, 0.1, 0.0, 0.1]\n\
        [[links.joint]]\nname = 'c'\nparent = 'b'\nkind = 'revolute'\naxis = [0.0, 1.0, 0.0]\nmass = 1.0\ncom = [0.3, 0.0, 0.0]\n\
        inertia = [0.1, 0.0, 0.0, 0.1, 0.0, 0.1]\n\
        [joints]\nstiffness = 100.0\nmotor_inertia = 0.1\nlink_damping = 0.1\nmotor_damping = 0.1\n\
        position_lower = [-3.0, -0.5, -3.0]\nposition_upper = [3.0, 2.0, 3.0]\n";
    let mut scenario = load_scenario("tomei-3r-tanh").unwrap();
    scenario.robot = robot_from_text("slider.toml", text, ".".as_ref()).unwrap();
    let verdict = certify(&proposition(&scenario, &Question::default(), None).unwrap());
    let certificate =
        serde_json::to_string(verdict.proved().unwrap_or_else(|| panic!("{verdict:?}"))).unwrap();
    verify(&certificate).unwrap_or_else(|rejected| panic!("{rejected}"));
    assert!(python::codes(&[certificate]).is_none_or(|codes| codes == [0]));
}

#[test]
fn both_checkers_accept_what_the_prover_writes_and_nothing_stronger() {
    let certificates = certificates();
    let genuine: Vec<String> = certificates.iter().map(|(_, certificate)| certificate.to_string()).collect();
    let stronger: Vec<String> = certificates
        .iter()
        .flat_map(|(_, certificate)| mutants(certificate))
        .map(|mutant| mutant.to_string())
        .collect();
    for ((name, _), text) in certificates.iter().zip(&genuine) {
        verify(text).unwrap_or_else(|rejected| panic!("{name}: {rejected}"));
    }
    assert!(stronger.iter().all(|text| verify(text).is_err()));
    if let Some(codes) = python::codes(&genuine) {
        assert!(codes.iter().all(|&code| code == 0), "{codes:?}");
    }
    if let Some(codes) = python::codes(&stronger) {
        assert!(codes.iter().all(|&code| code == 1), "{codes:?}");
    }
}
