//! Certificates of the two-link robot with the paper's gains: the figures of the theory.

use flexure::files::SCENARIOS;
use flexure::prove::engine::certificate::{
    BlockName, Certificate, CertifiedPhi, DecimalBody, DecimalGains, DecimalLaw, DecimalLinks, DecimalRobot,
    JointMotion, LoopSide, StructureName, Witness,
};
use flexure::prove::engine::number::Number;
use flexure::prove::engine::region::RequestedRegion;
use flexure::prove::engine::structural::Proposition;
use flexure::prove::engine::verdict::Verdict;
use flexure::prove::engine::witness::WitnessState;
use flexure::prove::proposition::proposition;
use flexure::prove::question::{Question, prove};
use flexure::prove::verified::certify;
use flexure::scenario::load_scenario;
use flexure_core::control::{CoupledTanh, Linear, Shaping, Tanh};
use flexure_core::linalg::Vector;

fn decimals(numbers: &[f64]) -> Vec<Number> {
    numbers.iter().map(|&x| Number::decimal(x)).collect()
}

fn arm() -> DecimalRobot {
    let two = |a: f64, b: f64| [Number::decimal(a), Number::decimal(b)];
    DecimalRobot {
        name: "quanser-2dof".to_owned(),
        joints: 2,
        links: DecimalLinks::PlanarTwoLink {
            mass: two(1.510, 0.873),
            length: Number::decimal(0.343),
            com: two(0.159, 0.055),
            inertia: two(0.0392, 0.00808),
        },
        stiffness: decimals(&[9.0, 4.0]),
        motor_inertia: decimals(&[0.23, 0.01]),
        link_damping: decimals(&[0.8, 0.55]),
        motor_damping: decimals(&[0.2, 90.0]),
    }
}

fn gains(metric: [f64; 2], damping: [f64; 2], kappa: Option<[f64; 2]>) -> DecimalGains {
    DecimalGains {
        metric: decimals(&metric),
        shaping: decimals(&metric),
        damping: decimals(&damping),
        kappa: kappa.map(|kappa| decimals(&kappa)),
        hardening: None,
    }
}

fn problem(phi: CertifiedPhi, region: RequestedRegion) -> Proposition {
    let kappa = (phi == CertifiedPhi::CoupledTanh).then_some([10.0, 8.0]);
    Proposition {
        subject: None,
        name: "two-link".to_owned(),
        assumptions: Vec::new(),
        robot: arm(),
        controller: DecimalLaw {
            phi,
            link: gains([55.0, 30.0], [15.0, 10.0], kappa),
            motor: gains([70.0, 60.0], [10.0, 5.0], kappa),
        },
        region,
        disturbance: None,
        velocity_error: None,
    }
}

fn proved(phi: CertifiedPhi) -> Certificate {
    match certify(&problem(phi, RequestedRegion::Box(decimals(&[3.0; 4])))) {
        Verdict::Proved(certificate) => certificate,
        other => panic!("{other:?}"),
    }
}

/// At least 1 − 1e-12 of the exact rate, and never above it.
#[track_caller]
fn tight(rate: &Number, exact: f64) {
    let rate = rate.bounds();
    // The exact figures are rounded to 1e-16.
    assert!(rate.hi() <= exact * (1.0 + 2e-16), "{rate:?} above {exact}");
    assert!(rate.lo() >= exact * (1.0 - 1e-12), "{rate:?} below {exact}");
}

/// theory.md, section 5: rates of the blocks on |q̃_i| ≤ 3 at all angles of the second link.
#[test]
fn block_rates_are_the_exact_ones() {
    let exact = [
        (CertifiedPhi::Linear, 30.0, 30.0),
        (CertifiedPhi::Tanh, 0.295_981_114_963_205_7, 9.950547536867305),
        (CertifiedPhi::CoupledTanh, 10.0 - 2.0_f64.sqrt(), 10.0 - 2.0_f64.sqrt()),
    ];
    for (phi, contraction, convergence) in exact {
        let certificate = proved(phi);
        for block in &certificate.blocks {
            match block.block {
                BlockName::PhiL => {
                    tight(&block.contraction, contraction);
                    tight(&block.convergence, convergence);
                }
                BlockName::PhiM => {}
                BlockName::SigmaL => tight(&block.contraction, 69.013_154_939_393_06),
                BlockName::SigmaM => tight(&block.contraction, 44.347_826_086_956_52),
            }
        }
        tight(certificate.contraction_rate.as_ref().unwrap(), contraction);
        tight(&certificate.convergence_rate, convergence);
    }
}

/// A larger region never has a larger rate, and the level set lies inside its box.
#[test]
fn rates_fall_as_regions_grow() {
    for phi in [CertifiedPhi::Tanh, CertifiedPhi::Linear, CertifiedPhi::CoupledTanh] {
        let mut last = f64::INFINITY;
        for error in [0.1, 0.5, 1.0, 2.0, 5.0, 12.0] {
            let Verdict::Proved(certificate) =
                certify(&problem(phi, RequestedRegion::Box(decimals(&[error; 4]))))
            else {
                panic!("{phi:?} at {error}");
            };
            let rate = certificate.contraction_rate.as_ref().unwrap().bounds();
            // Rates that do not depend on the region are found anew each time, to 1e-13.
            assert!(rate.lo() <= last * (1.0 + 1e-12), "{phi:?} at {error}: {rate:?} after {last}");
            last = rate.hi();
            let level = certificate.region.level.unwrap().bounds();
            assert!(level.hi() <= 0.5 * 30.0 * error * error, "30 is the smallest metric");
        }
    }
}

/// The tanh law has no rate everywhere: undecided, not a rate of zero.
#[test]
fn tanh_has_no_rate_everywhere() {
    match certify(&problem(CertifiedPhi::Tanh, RequestedRegion::Everywhere)) {
        Verdict::Undecided(undecided) => assert!(undecided.at.contains("phi_l"), "{}", undecided.at),
        other => panic!("{other:?}"),
    }
    for phi in [CertifiedPhi::Linear, CertifiedPhi::CoupledTanh] {
        assert!(certify(&problem(phi, RequestedRegion::Everywhere)).proved().is_some());
    }
}

/// A metric far from Λ makes the coupling of φ_3 too strong for it: refuted, and the slope of the very φ says so in f64.
#[test]
fn a_refutation_is_confirmed_by_the_law() {
    let mut bad = problem(CertifiedPhi::CoupledTanh, RequestedRegion::Box(decimals(&[3.0; 4])));
    let metric = [1.0, 10_000.0];
    bad.controller.link.metric = decimals(&metric);
    let Verdict::Refuted(witness) = certify(&bad) else { panic!("not refuted") };
    let WitnessState::Error(error) = &witness.state else { panic!("{witness:?}") };
    assert_eq!(witness.block, BlockName::PhiL);
    let phi = CoupledTanh::new(Vector([10.0, 8.0]), &Vector([55.0, 30.0]));
    let slope = phi.slope(&Vector([error[0], error[1]]));
    let d = &witness.direction;
    let form = |i: usize, j: usize| d[i] * metric[i] * slope[(i, j)] * d[j];
    let (value, weight) = (
        form(0, 0) + form(0, 1) + form(1, 0) + form(1, 1),
        metric[0] * d[0] * d[0] + metric[1] * d[1] * d[1],
    );
    assert!(value < 0.0, "{value}");
    assert!((value / weight - witness.rate).abs() < 1e-9 * witness.rate.abs());
}

/// What is proved for the links' momenta never exceeds what the mass matrix shows at any configuration, for every robot.
#[test]
fn proved_rates_lie_below_samples() {
    for (name, _) in SCENARIOS {
        let scenario = load_scenario(name).unwrap();
        let proof = prove(&scenario, &Question::default()).unwrap();
        let certificate = proof.verdict.proved().unwrap_or_else(|| panic!("{name}: {:?}", proof.verdict));
        let sigma_l =
            &certificate.blocks.iter().find(|block| block.block == BlockName::SigmaL).unwrap().contraction;
        let tightness = sigma_l.bounds().hi() / proof.sampled.rate;
        assert!(tightness <= 1.0 + 1e-12 && tightness > 0.9998, "{name}: {tightness}");
    }
}

/// The same programme in Python, solved by a library and by a damped Newton method, found these rates of the links' momenta [1/s].
#[test]
fn chains_are_as_tight_as_elsewhere() {
    for (name, elsewhere) in [
        ("panda-tanh-smooth", 4.56542),
        ("planar-3r-tanh", 6.449324),
        ("tomei-3r-tanh", 1.45798),
        ("tomei-3r-5kg-tanh", 1.12880),
    ] {
        let scenario = load_scenario(name).unwrap();
        let problem = proposition(&scenario, &Question::default(), None).unwrap();
        let verdict = certify(&problem);
        let rate = &verdict.proved().unwrap().blocks[2].contraction;
        // Six digits were noted.
        assert!(rate.bounds().lo() >= elsewhere * (1.0 - 1e-6), "{name}: {rate:?}");
    }
}

/// The paper's arm as a tree: the chain loses nothing of what its mass matrix at both ends of the cosine shows.
#[test]
fn a_chain_reaches_the_closed_form() {
    let numbers = |x: [f64; 3]| x.map(Number::decimal);
    let body = |parent, x, mass, com, inertia| DecimalBody {
        parent,
        kind: JointMotion::Revolute,
        axis: numbers([0.0, 0.0, 1.0]),
        rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(numbers),
        translation: numbers([x, 0.0, 0.0]),
        mass: Number::decimal(mass),
        com: numbers([com, 0.0, 0.0]),
        inertia: [0.0, 0.0, 0.0, 0.0, 0.0, inertia].map(Number::decimal),
        travel: None,
    };
    let mut problem = problem(CertifiedPhi::Linear, RequestedRegion::Everywhere);
    problem.robot.links = DecimalLinks::Tree {
        bodies: vec![body(None, 0.0, 1.510, 0.159, 0.0392), body(Some(0), 0.343, 0.873, 0.055, 0.00808)],
    };
    let verdict = certify(&problem);
    let rate = verdict.proved().unwrap().blocks[2].contraction.bounds();
    let exact = 69.013_154_939_393_06;
    assert!(rate.hi() <= exact && rate.lo() > exact * (1.0 - 1e-6), "{rate:?} of {exact}");
}

/// A joint that slides without limits has no bound on its inertia; with limits it does.
#[test]
fn travel_bounds_a_sliding_joint() {
    let body = |kind, parent, travel: Option<[f64; 2]>| DecimalBody {
        parent,
        kind,
        axis: [0.0, 0.0, 1.0].map(Number::decimal),
        rotation: [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]].map(|row| row.map(Number::decimal)),
        translation: [0.0, 0.0, 0.0].map(Number::decimal),
        mass: Number::decimal(2.0),
        com: [0.0, 0.0, 0.0].map(Number::decimal),
        inertia: [0.1, 0.0, 0.0, 0.1, 0.0, 0.1].map(Number::decimal),
        travel: travel.map(|ends| ends.map(Number::decimal)),
    };
    let rate = |travel| {
        let mut problem = problem(CertifiedPhi::Linear, RequestedRegion::Everywhere);
        let bodies =
            vec![body(JointMotion::Revolute, None, None), body(JointMotion::Prismatic, Some(0), travel)];
        problem.robot.links = DecimalLinks::Tree { bodies };
        certify(&problem).proved().map(|certificate| certificate.blocks[2].contraction.bounds().midpoint())
    };
    // The slider moves across the first axis, 3 m from it at most: inertia 0.2 + 2 · 9 against 15.8, and 2 kg against 10.55.
    let found = rate(Some([-1.0, 3.0])).expect("bounded");
    let exact = 15.8 / 18.2;
    assert!(found <= exact && found > exact * (1.0 - 1e-6), "{found} of {exact}");
    assert!(rate(None).is_none());
}

/// theory.md, section 6: which of the family keeps what, each loss with a state at which the slopes of the very φ show it.
#[test]
fn structures_are_kept_as_the_theory_says() {
    let metric = [[55.0, 30.0], [70.0, 60.0]];
    for (phi, variational, ph_like) in [
        (CertifiedPhi::Tanh, true, false),
        (CertifiedPhi::Linear, true, true),
        (CertifiedPhi::CoupledTanh, false, false),
    ] {
        let certificate = proved(phi);
        let holds = |name| certificate.structure.iter().find(|claim| claim.name == name).unwrap();
        assert_eq!(holds(StructureName::VariationalPh).holds, variational, "{phi:?}");
        assert_eq!(holds(StructureName::PhLike).holds, ph_like, "{phi:?}");
        assert!(holds(StructureName::StrictDifferentialPassivity).holds);
        for claim in certificate.structure.iter().filter(|claim| !claim.holds) {
            let Witness { side, error, row, column, difference } = claim.witness.as_ref().unwrap();
            let gain = metric[usize::from(*side == LoopSide::Motor)];
            let e = Vector([error[0].approximate(), error[1].approximate()]);
            let slope = match phi {
                CertifiedPhi::Tanh => Tanh { gain: Vector(gain) }.slope(&e),
                CertifiedPhi::Linear => Linear { gain: Vector(gain) }.slope(&e),
                CertifiedPhi::CoupledTanh => CoupledTanh::new(Vector([10.0, 8.0]), &Vector(gain)).slope(&e),
            };
            let (i, j) = (*row, *column);
            let found = match claim.name {
                StructureName::VariationalPh => slope[(i, j)] / gain[j] - slope[(j, i)] / gain[i],
                _ => slope[(i, j)] - if i == j { gain[i] } else { 0.0 },
            };
            assert!(found.abs() >= difference.approximate(), "{phi:?}: {claim:?}, {found}");
        }
    }
    // The same gain everywhere but one last digit: no longer the gradient of its own metric.
    let mut close = problem(CertifiedPhi::Linear, RequestedRegion::Everywhere);
    close.controller.motor.shaping[1] = Number::decimal(60.000_000_000_001);
    let verdict = certify(&close);
    let claim = &verdict.proved().unwrap().structure[1];
    assert_eq!((claim.name, claim.holds), (StructureName::PhLike, false));
}
