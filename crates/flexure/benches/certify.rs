//! What proofs cost: `cargo bench -p flexure --bench certify`. The rates that they prove are printed first.

use divan::{Bencher, black_box};
use flexure::certify::direct::{Flow, best_rate, prove};
use flexure_core::control::{CoupledTanh, Linear, Tanh};

#[path = "../tests/direct/arm.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod arm;
use arm::{ArmFlow, coupled_tanh, flow, linear, region, tanh};
use flexure_core::scalar::Interval;

/// Boxes that a proof may look at.
const BUDGET: usize = 20_000;

/// True rates of the paper's arm over |q̃_i| ≤ 3, all q_l, |q̇_l| ≤ 5: theory, section 5.
const TANH: f64 = 0.295_981_114_963_205_7;
const LINEAR: f64 = 30.0;
const COUPLED_TANH: f64 = 10.0 - std::f64::consts::SQRT_2;

fn main() {
    println!("direct engine, share of the true rate that is proved:");
    for (name, flow, exact) in
        [("φ_1", &phi_1() as &dyn Flow, TANH), ("φ_2", &phi_2(), LINEAR), ("φ_3", &phi_3(), COUPLED_TANH)]
    {
        match best_rate(flow, BUDGET).proved() {
            Some(best) => println!(
                "  {name}: {} 1/s, true rate times 1 − {:.0e}, {} boxes",
                best.rate,
                1.0 - best.rate / exact,
                best.boxes
            ),
            None => println!("  {name}: nothing"),
        }
    }
    divan::main();
}

fn phi_1() -> ArmFlow<Tanh<Interval, 2>, Tanh<f64, 2>> {
    flow(tanh, tanh, &region())
}

fn phi_2() -> ArmFlow<Linear<Interval, 2>, Linear<f64, 2>> {
    flow(linear, linear, &region())
}

fn phi_3() -> ArmFlow<CoupledTanh<Interval, 2>, CoupledTanh<f64, 2>> {
    flow(coupled_tanh, coupled_tanh, &region())
}

/// One attempt at a rate that is given.
mod direct_proof {
    use super::{BUDGET, Bencher, COUPLED_TANH, Flow, TANH, black_box, phi_1, phi_3, prove};

    fn time(bencher: Bencher, flow: &dyn Flow, exact: f64) {
        bencher.bench_local(|| prove(black_box(flow), 0.9999 * exact, BUDGET));
    }

    #[divan::bench]
    fn tanh(bencher: Bencher) {
        time(bencher, &phi_1(), TANH);
    }

    #[divan::bench]
    fn coupled_tanh(bencher: Bencher) {
        time(bencher, &phi_3(), COUPLED_TANH);
    }
}

/// From nothing to the best rate, samples included.
mod direct_best_rate {
    use super::{BUDGET, Bencher, Flow, best_rate, black_box, phi_1, phi_3};

    fn time(bencher: Bencher, flow: &dyn Flow) {
        bencher.bench_local(|| best_rate(black_box(flow), BUDGET));
    }

    #[divan::bench]
    fn tanh(bencher: Bencher) {
        time(bencher, &phi_1());
    }

    #[divan::bench]
    fn coupled_tanh(bencher: Bencher) {
        time(bencher, &phi_3());
    }
}

/// The matrices of one box.
#[divan::bench]
fn direct_enclosure(bencher: Bencher) {
    let flow = phi_1();
    let at: Vec<Interval> = flow.coordinates().iter().map(|c| c.range).collect();
    bencher.bench_local(|| flow.enclosure(black_box(&at)));
}
