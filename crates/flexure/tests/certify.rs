//! Certificates of the two-link robot with the paper's gains: the figures of the theory.

use flexure::certify::certificate::{BlockName, Controller, Gains, Links, Phi, Robot};
use flexure::certify::{Certificate, Number, Problem, Request, Verdict, certify};

fn decimals(numbers: &[f64]) -> Vec<Number> {
    numbers.iter().map(|&x| Number::decimal(x)).collect()
}

fn arm() -> Robot {
    let two = |a: f64, b: f64| [Number::decimal(a), Number::decimal(b)];
    Robot {
        name: "quanser-2dof".to_owned(),
        joints: 2,
        links: Links::PlanarTwoLink {
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

fn gains(metric: [f64; 2], damping: [f64; 2], kappa: Option<[f64; 2]>) -> Gains {
    Gains {
        metric: decimals(&metric),
        shaping: decimals(&metric),
        damping: decimals(&damping),
        kappa: kappa.map(|kappa| decimals(&kappa)),
    }
}

fn problem(phi: Phi, region: Request) -> Problem {
    let kappa = (phi == Phi::CoupledTanh).then_some([10.0, 8.0]);
    Problem {
        name: "two-link".to_owned(),
        assumptions: Vec::new(),
        robot: arm(),
        controller: Controller {
            phi,
            link: gains([55.0, 30.0], [15.0, 10.0], kappa),
            motor: gains([70.0, 60.0], [10.0, 5.0], kappa),
        },
        region,
        disturbance: None,
    }
}

fn proved(phi: Phi) -> Certificate {
    match certify(&problem(phi, Request::Box(decimals(&[3.0; 4])))) {
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
        (Phi::Linear, 30.0, 30.0),
        (Phi::Tanh, 0.295981114963205738, 9.950547536867305),
        (Phi::CoupledTanh, 10.0 - 2.0_f64.sqrt(), 10.0 - 2.0_f64.sqrt()),
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
                BlockName::SigmaL => tight(&block.contraction, 69.0131549393930643),
                BlockName::SigmaM => tight(&block.contraction, 44.3478260869565217),
            }
        }
        tight(&certificate.contraction_rate, contraction);
        tight(&certificate.convergence_rate, convergence);
        println!("{}", serde_json::to_string_pretty(&certificate).unwrap());
    }
}
