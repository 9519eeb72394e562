//! What proofs cost: `cargo bench -p flexure --bench certify`. The rates that they prove are printed first.

use arm::{ArmFlow, coupled_tanh, flow, linear, region, tanh};
use divan::{Bencher, black_box};
use flexure::prove::engine::certificate::Certificate;
use flexure::prove::engine::direct;
use flexure::prove::engine::direct::{Flow, best_rate};
use flexure::prove::engine::number::Number;
use flexure::prove::engine::structural::Proposition;
use flexure::prove::question::{Question, Region, prove};
use flexure::prove::verified::certify;
use flexure::scenario::load_scenario;
use flexure::verify::verify;
use flexure_core::control::{CoupledTanh, Linear, Tanh};
use flexure_core::scalar::Interval;

#[path = "../tests/suite/direct/arm.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod arm;

/// Boxes that a proof may look at.
const BUDGET: usize = 20_000;

/// True rates of the paper's arm over |q̃_i| ≤ 3, all q_l and q̇_l: theory, section 5.
const TANH: f64 = 0.295_981_114_963_205_7;
const LINEAR: f64 = 30.0;
const COUPLED_TANH: f64 = 10.0 - std::f64::consts::SQRT_2;

/// Block rates on |q̃_i| ≤ 3: σ_l at q_l2 = 0, σ_m, and φ_1's convergence rate 30 tanh(3)/3.
const SIGMA_L: f64 = 69.013_154_939_393_06;
const SIGMA_M: f64 = 44.347_826_086_956_52;
const TANH_CONVERGENCE: f64 = 9.950_547_536_867_305;

/// A built-in scenario with errors of up to `error` rad.
fn problem(scenario: &str, error: f64) -> Proposition {
    let scenario = load_scenario(scenario).expect("built in");
    let region = Region::Errors(vec![error; 2 * scenario.robot.joint_count()]);
    flexure::prove::proposition::proposition(&scenario, &Question { region, ..Question::default() }, None)
        .expect("a constant metric")
}

fn certificate(scenario: &str, error: f64) -> Certificate {
    certify(&problem(scenario, error)).proved().expect("proved").clone()
}

fn structural() {
    println!("structural engine, share of the exact rate that is proved:");
    let share = |name: &str, rate: &Number, exact: f64| {
        println!(
            "  {name}: {} 1/s, exact rate times 1 − {:.0e}",
            rate.approximate(),
            1.0 - rate.approximate() / exact
        );
    };
    let tanh = certificate("two-link-tanh", 3.0);
    share("σ_l", &tanh.blocks[2].contraction, SIGMA_L);
    share("σ_m", &tanh.blocks[3].contraction, SIGMA_M);
    let contraction = |of: &Certificate| of.contraction_rate.clone().expect("constant metric");
    share("φ_1", &contraction(&tanh), TANH);
    share("φ_1, convergence", &tanh.convergence_rate, TANH_CONVERGENCE);
    share("φ_2", &contraction(&certificate("two-link-linear", 3.0)), LINEAR);
    share("φ_3", &contraction(&certificate("two-link-coupled-tanh", 3.0)), COUPLED_TANH);
    println!("σ_l of trees, proved over densely sampled:");
    for name in
        ["planar-2r-tanh", "planar-3r-tanh", "tomei-3r-tanh", "tomei-3r-5kg-tanh", "panda-tanh-smooth"]
    {
        let proof =
            prove(&load_scenario(name).expect("built in"), &Question::default()).expect("a constant metric");
        let proved = proof.verdict.proved().expect("proved").blocks[2].contraction.approximate();
        println!(
            "  {name}: {proved:.6} of {:.6} 1/s, {:.2} %",
            proof.sampled.rate,
            100.0 * proved / proof.sampled.rate
        );
    }
}

/// Times of `tools/check_certificate.py`, which measures itself, if there is a Python with mpmath.
fn second_checker() {
    let folder = std::env::temp_dir();
    let files =
        ["two-link-tanh", "two-link-linear", "two-link-coupled-tanh", "panda-tanh-smooth"].map(|scenario| {
            let path = folder.join(format!("flexure-bench-{scenario}.json"));
            let text = serde_json::to_string(&certificate(scenario, 3.0)).expect("no maps");
            std::fs::write(&path, text).expect("a temporary file");
            path
        });
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tools/check_certificate.py");
    let output = std::process::Command::new("python3").arg(script).args(&files).output();
    let said = output.map_or_else(
        |error| error.to_string(),
        |output| String::from_utf8_lossy(&output.stdout).into_owned(),
    );
    println!("second checker:");
    for line in said.lines() {
        println!("  {}", line.split("flexure-bench-").last().unwrap_or(line));
    }
    for file in &files {
        // Nobody minds a temporary file that is gone already.
        let _ = std::fs::remove_file(file);
    }
}

fn main() {
    structural();
    second_checker();
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

/// A certificate, and checking it.
mod structural {
    use super::{Bencher, black_box, certificate, certify, problem, verify};

    const SCENARIOS: [&str; 4] =
        ["two-link-tanh", "two-link-linear", "two-link-coupled-tanh", "panda-tanh-smooth"];

    #[divan::bench(args = SCENARIOS)]
    fn prove(bencher: Bencher, scenario: &str) {
        let problem = problem(scenario, 3.0);
        bencher.bench_local(|| certify(black_box(&problem)));
    }

    #[divan::bench(args = SCENARIOS)]
    fn check(bencher: Bencher, scenario: &str) {
        let text = serde_json::to_string(&certificate(scenario, 3.0)).expect("no maps");
        bencher.bench_local(|| verify(black_box(&text)).is_ok());
    }
}

/// One attempt at a rate that is given.
mod direct_proof {
    use super::{BUDGET, Bencher, COUPLED_TANH, Flow, TANH, black_box, direct, phi_1, phi_3};

    fn time(bencher: Bencher, flow: &dyn Flow, exact: f64) {
        bencher.bench_local(|| direct::prove(black_box(flow), 0.9999 * exact, BUDGET));
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
