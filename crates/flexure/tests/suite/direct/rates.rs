//! Rates of the paper's arm, against theory, section 5: |q̃_i| ≤ 3, all q_l, all q̇_l.

use std::time::Instant;

use flexure::prove::engine::direct::BestRate;
use flexure::prove::engine::direct::StateBox;
use flexure::prove::engine::direct::{Flow, best_rate, prove};
use flexure::prove::engine::verdict::Verdict;
use flexure_core::scalar::Interval;

use super::arm::{coupled_tanh, flow, linear, region, tanh};

/// The digits of the true rate are good to 1e-15 of it.
const DIGITS: f64 = 2e-15;

fn best(name: &str, flow: &dyn Flow, exact: f64) -> BestRate {
    let start = Instant::now();
    let Verdict::Proved(best) = best_rate(flow, 20_000) else {
        panic!("{name}: {:?}", best_rate(flow, 20_000))
    };
    let (ratio, slack) = (best.rate / exact, 1.0 - best.rate / exact);
    println!(
        "{name}: {ratio:.15} of the true rate (1 − {slack:.1e}), {} boxes, {:?}",
        best.boxes,
        start.elapsed()
    );
    assert!(best.rate <= exact * (1.0 + DIGITS), "{name}: proved {}, true {exact}", best.rate);
    assert!(best.upper >= exact * (1.0 - DIGITS), "{name}: {} bounds {exact}", best.upper);
    assert!(best.rate > 0.9999 * exact, "{name}: {} of {exact}", best.rate);
    best
}

/// A rate barely too large is never proved.
fn no_more_than(name: &str, flow: &dyn Flow, exact: f64) {
    for excess in [1e-3, 1e-6, 1e-9] {
        match prove(flow, exact * (1.0 + excess), 2_000) {
            Verdict::Proved(proved) => panic!("{name}: {proved:?}, true {exact}"),
            Verdict::Refuted(witness) => {
                assert!(witness.value < 0.0 && witness.rate < exact * (1.0 + excess));
                assert!(witness.rate >= exact * (1.0 - DIGITS), "{name}: {} refutes {exact}", witness.rate);
            }
            Verdict::Undecided(undecided) => println!("{name}, {excess:e} above: {undecided:?}"),
        }
    }
}

const TANH: f64 = 0.295_981_114_963_205_7;

#[test]
fn tanh_contracts() {
    let flow = flow(tanh, tanh, &region());
    best("φ_1", &flow, TANH);
    no_more_than("φ_1", &flow, TANH);
    let Verdict::Refuted(witness) = prove(&flow, TANH * 1.01, 100) else { panic!("a corner refutes it") };
    // The second link is slow where its error is large: 30 sech² e ≤ 1.01 · 30 sech² 3.
    assert!(witness.at.get("e_l[1]").is_some_and(|e| e.abs() > 2.99), "{witness:?}");
}

#[test]
fn linear_contracts() {
    let flow = flow(linear, linear, &region());
    best("φ_2", &flow, 30.0);
    no_more_than("φ_2", &flow, 30.0);
}

#[test]
fn coupled_tanh_contracts() {
    let exact = 10.0 - std::f64::consts::SQRT_2;
    let flow = flow(coupled_tanh, coupled_tanh, &region());
    best("φ_3", &flow, exact);
    no_more_than("φ_3", &flow, exact);
}

/// φ_2 and φ_3 contract at one rate everywhere, φ_1 does not.
#[test]
fn errors_without_a_bound() {
    let everywhere = StateBox { error_l: [Interval::ENTIRE; 2], error_m: [Interval::ENTIRE; 2], ..region() };
    best("φ_2 everywhere", &flow(linear, linear, &everywhere), 30.0);
    best("φ_3 everywhere", &flow(coupled_tanh, coupled_tanh, &everywhere), 10.0 - std::f64::consts::SQRT_2);
    let verdict = best_rate(&flow(tanh, tanh, &everywhere), 2_000);
    assert!(verdict.proved().is_none(), "{verdict:?}");
}

/// What is proved of a region holds of its parts: a smaller one never has a lower rate.
#[test]
fn smaller_regions_are_no_slower() {
    let mut last = 0.0;
    for size in [3.0, 2.5, 2.0, 1.0, 0.5, 0.1] {
        let flow = flow(tanh, tanh, &StateBox::within(size));
        let Verdict::Proved(best) = best_rate(&flow, 20_000) else { panic!("{size}") };
        assert!(best.rate >= last, "{size}: {} after {last}", best.rate);
        last = best.rate;
    }
}
