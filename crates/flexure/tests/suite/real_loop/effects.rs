//! More of an imperfection, more of its effect; and the effects that the issue of real loops is about.

use super::{ideal, simulate, with, with_these};
use flexure::imperfections::Imperfection;
use flexure::laws::Controller;

/// The imperfections of some text.
fn these(text: &str) -> Vec<Imperfection> {
    with("two-link-tanh-smooth", 1.0, text).imperfections
}

/// Root mean square link errors of the plausible arm with each of `texts`, 8 s long.
fn errors(texts: &[String]) -> Vec<f64> {
    texts.iter().map(|text| simulate(&with_these(ideal(8.0), these(text))).summary.rms_e_l).collect()
}

/// Errors grow along `strengths`, and the first is larger than the ideal loop's.
fn grows(strengths: &[f64], text: impl Fn(f64) -> String) {
    let texts: Vec<String> = strengths.iter().map(|&strength| text(strength)).collect();
    let perfect = simulate(&ideal(8.0)).summary.rms_e_l;
    let found = errors(&texts);
    let pairs = std::iter::once(perfect).chain(found.iter().copied()).zip(&found);
    for ((less, more), text) in pairs.zip(&texts) {
        assert!(less < *more, "{less} then {more} with {text}");
    }
}

/// Factors of four and more: chance, and errors that happen to cancel, do not reach that far.
#[test]
fn errors_grow_with_each_imperfection() {
    grows(&[1e-4, 1e-3, 1e-2], |std| {
        format!("[[imperfection]]\nkind = \"noise\"\nlink = {std}\nmotor = {std}")
    });
    grows(&[2e-3, 2e-2], |count| format!("[[imperfection]]\nkind = \"encoder\"\nresolution = {count}"));
    grows(&[1e-3, 4e-3, 1.6e-2], |delay| format!("[[imperfection]]\nkind = \"delay\"\nactuation = {delay}"));
    grows(&[0.03, 0.12, 0.48], |torque| {
        format!("[[imperfection]]\nkind = \"friction\"\nside = \"motor\"\ncoulomb = {torque}")
    });
    grows(&[0.95, 0.8, 0.6], |factor| format!("[[imperfection]]\nkind = \"torque-gain\"\nfactor = {factor}"));
    grows(&[0.95, 0.8, 0.6], |factor| {
        format!("[[imperfection]]\nkind = \"model-error\"\nstiffness = {factor}")
    });
    grows(&[0.02, 0.08, 0.3], |mass| {
        format!(
            "[[imperfection]]\nkind = \"model-error\"\npayload = {{ mass = {mass}, position = [0.2, 0.0, 0.0] }}"
        )
    });
    grows(&[0.1, 0.4, 1.6], |torque| {
        format!("[[imperfection]]\nkind = \"push\"\ntorque = [{torque}, 0.0]\nfrom = 3.0\nduration = 0.2")
    });
    grows(&[0.004, 0.016, 0.04], |gap| format!("[[imperfection]]\nkind = \"spring\"\ndead_zone = {gap}"));
    grows(&[40.0, 10.0, 4.0], |cutoff| {
        format!("[[imperfection]]\nkind = \"velocity-filter\"\norder = 2\ncutoff = {cutoff}\ndamping = 0.9")
    });
}

/// The paper's gains bear no slow computer: at 500 Hz the loop diverges, with 1 ms held torque it does not.
#[test]
fn the_papers_gains_diverge_at_500_hz() {
    let at = |period: f64| {
        let mut scenario = with("two-link-tanh-smooth", 4.0, "");
        scenario.control_period = period;
        simulate(&scenario)
    };
    assert!(at(0.001).divergence.is_none());
    let slow = at(0.002);
    let divergence = slow.divergence.expect("diverges at 500 Hz");
    // What was recorded up to there is kept.
    assert!(!slow.trace.is_empty() && *slow.trace.column("t").unwrap().last().unwrap() < divergence.time);
}

/// At 10 kHz they bear between 1.0 and 1.5 ms of delay more.
#[test]
fn the_papers_gains_bear_a_millisecond_of_delay_at_10_khz() {
    let with_delay = |ms: f64| {
        let text = format!("[[imperfection]]\nkind = \"delay\"\nactuation = {}", 1e-3 * ms);
        simulate(&with("two-link-tanh-10khz", 2.5, &text))
    };
    let held = with_delay(1.0);
    assert!(held.divergence.is_none() && held.summary.final_abs_e_l < 1e-3, "{:?}", held.summary);
    assert!(with_delay(1.5).divergence.is_some());
}

/// With a drive that gives (20, 150) N m the paper's start from rest ends in a limit cycle of radians.
#[test]
fn the_papers_start_on_a_real_drive_does_not_track() {
    let text = "[[imperfection]]\nkind = \"saturation\"\nlimit = [20.0, 150.0]";
    let run = simulate(&with("two-link-tanh", 4.0, text));
    assert!(run.divergence.is_some() || run.summary.rms_e_l > 0.2, "{:?}", run.summary);
    // From a smooth start no torque comes near that, and nothing happens.
    let smooth = simulate(&with("two-link-tanh-smooth", 4.0, text));
    assert!(smooth.summary.rms_e_l < 1e-4, "{:?}", smooth.summary);
}

/// The dead zone of a file is to either side: a deflection inside it moves nothing.
#[test]
fn a_dead_zone_is_to_either_side() {
    let spring = "[[imperfection]]\nkind = \"spring\"\ndead_zone = 0.01\n";
    let mut scenario = with_these(ideal(0.2), with("two-link-tanh-smooth", 1.0, spring).imperfections);
    let pd = Controller::default_for("pd", &scenario.robot).unwrap();
    scenario.controller = pd.with_gains(&[vec![1e-12; 2], vec![0.0; 2]]);
    let moved = |deflection: f64| {
        let mut scenario = scenario.clone();
        scenario.initial.q_m = vec![deflection; 2];
        let run = simulate(&scenario);
        *run.trace.column("q_l1").unwrap().last().unwrap()
    };
    for inside in [0.008, -0.008] {
        assert!(moved(inside).abs() < 1e-12, "{} rad", moved(inside));
    }
    assert!(moved(0.012) > 1e-6 && moved(-0.012) < -1e-6);
}
