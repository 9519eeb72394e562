//! The law and the model of a 7-joint arm against `golden/panda.json`: the links of `robots/panda.toml`, with the gains
//! and drives of the file.

use flexure::files::{StateFile, StateRow};
use flexure::laws;
use flexure::references;
use flexure::scenario;
use serde::Deserialize;

/// The issue asks for 1e-8; the file's numbers and ours agree to rounding amplified by torques of 1e5 N m.
const TOLERANCE: f64 = 1e-9;

#[derive(Deserialize)]
struct Golden {
    cases: Vec<Case>,
}

#[derive(Deserialize)]
#[expect(non_snake_case, reason = "field names of the file")]
struct Case {
    phi: String,
    K: Vec<f64>,
    M_m: Vec<f64>,
    D_l: Vec<f64>,
    D_m: Vec<f64>,
    Lambda_l: Vec<f64>,
    Lambda_m: Vec<f64>,
    K_ld: Vec<f64>,
    K_md: Vec<f64>,
    reference: Reference,
    samples: Vec<Sample>,
}

#[derive(Deserialize)]
struct Reference {
    offset: Vec<f64>,
    amplitude: Vec<f64>,
    frequency: Vec<f64>,
}

#[derive(Deserialize)]
struct Sample {
    t: f64,
    q_l: Vec<f64>,
    q_m: Vec<f64>,
    dq_l: Vec<f64>,
    dq_m: Vec<f64>,
    expect: Expect,
}

#[derive(Deserialize)]
#[expect(non_snake_case, reason = "field names of the file")]
struct Expect {
    u_m: Vec<f64>,
    u_l: Vec<f64>,
    q_md: Vec<f64>,
    M_l: Vec<Vec<f64>>,
    bias: Vec<f64>,
    ddq_l: Vec<f64>,
}

/// Relative to the largest entry.
fn close(what: &str, got: &[f64], expected: &[f64]) {
    let scale = expected.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    for (g, e) in got.iter().zip(expected) {
        assert!((g - e).abs() <= TOLERANCE * scale, "{what}: got {got:?}, expected {expected:?}");
    }
}

fn side(gains: &mut laws::SideGains, metric: &[f64], damping: &[f64]) {
    gains.metric = metric.to_vec();
    gains.shaping = metric.to_vec();
    gains.damping = damping.to_vec();
    gains.extra.clear();
}

fn scenario(case: &Case) -> scenario::Scenario {
    let mut scenario = scenario::load_scenario("panda-tanh-smooth").expect("built in");
    scenario.robot.stiffness.clone_from(&case.K);
    scenario.robot.motor_inertia.clone_from(&case.M_m);
    scenario.robot.link_damping.clone_from(&case.D_l);
    scenario.robot.motor_damping.clone_from(&case.D_m);
    let laws::Controller::Vcbc(gains) = &mut scenario.controller else { panic!("the scenario is of v-CBC") };
    let laws::VcbcGains { phi, link, motor } = gains.as_mut();
    *phi = match case.phi.as_str() {
        "tanh" => laws::Phi::Tanh,
        "linear" => laws::Phi::Linear,
        other => panic!("no case of the file has {other}"),
    };
    side(link, &case.Lambda_l, &case.K_ld);
    side(motor, &case.Lambda_m, &case.K_md);
    let Reference { offset, amplitude, frequency } = &case.reference;
    scenario.smooth_start = None;
    scenario.reference = references::Reference::Sines(references::Sines {
        offset: offset.clone(),
        terms: vec![references::Term {
            amplitude: amplitude.clone(),
            frequency: frequency.clone(),
            phase: vec![0.0; offset.len()],
        }],
    });
    scenario
}

#[test]
fn panda_golden_file() {
    let golden: Golden =
        serde_json::from_str(include_str!("../golden/panda.json")).expect("golden file parses");
    let mut count = 0;
    for case in &golden.cases {
        let scenario = scenario(case);
        let rows = case
            .samples
            .iter()
            .map(|s| StateRow {
                t: s.t,
                q_l: s.q_l.clone(),
                q_m: s.q_m.clone(),
                dq_l: s.dq_l.clone(),
                dq_m: s.dq_m.clone(),
                u_m: None,
                ..StateRow::default()
            })
            .collect();
        let states = StateFile { name: "golden".to_owned(), rows };
        let laws = flexure::eval::evaluate_law(&scenario, &states).expect("seven joints");
        let models = flexure::eval::evaluate_model(&scenario.robot, &states).expect("seven joints");
        for ((law, model), sample) in laws.iter().zip(&models).zip(&case.samples) {
            let expect = &sample.expect;
            close("u_m", &law.u_m, &expect.u_m);
            close("u_l", law.u_l.as_deref().expect("v-CBC"), &expect.u_l);
            close("q_md", law.q_md.as_deref().expect("v-CBC"), &expect.q_md);
            close("M_l", &model.M_l.concat(), &expect.M_l.concat());
            close("bias", &model.bias, &expect.bias);
            close("ddq_l", &model.ddq_l, &expect.ddq_l);
            count += 1;
        }
    }
    assert_eq!(count, 12);
}
