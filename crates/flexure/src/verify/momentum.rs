//! Momentum blocks: the damping outweighs the inertia at every configuration.

use std::collections::BTreeMap;

use flexure_core::scalar::Interval;

use crate::verify::block;
use crate::verify::chain::Chain;
use crate::verify::document::{Certificate, Side};
use crate::verify::mass::{pendulum_mass, planar_mass};
use crate::verify::matrix::Symmetric;
use crate::verify::number::Number;
use crate::verify::reach::mass_bound;
use crate::verify::robot::Links;
use crate::verify::shaping::Rate;
use crate::verify::verdict::{Claim, Rejected, ensure};

pub(super) fn check(certificate: &Certificate) -> Result<Vec<Claim>, Rejected> {
    Ok(vec![links(certificate)?, motors(certificate)?])
}

/// D + K_d.
pub(super) fn damping(damper: &[Number], gain: &[Number]) -> Vec<Interval> {
    damper.iter().zip(gain).map(|(d, k)| d.value + k.value).collect()
}

fn links(certificate: &Certificate) -> Result<Claim, Rejected> {
    let block = block::find(certificate, "sigma_l")?;
    let robot = &certificate.robot;
    let damping = damping(&robot.link_damping, &certificate.controller.gains(Side::Link).damping);
    // B − β M.
    let pivot = |mass: &dyn Fn(usize, usize) -> Interval, rate: Rate| {
        let beta = block.rate(rate).claimed;
        let entry = |i: usize, j: usize| {
            let inertia = beta * mass(i, j);
            if i == j { damping[i] - inertia } else { -inertia }
        };
        Symmetric::from_fn(robot.joints, entry).smallest_pivot()
    };
    let one = [String::new()];
    equal_rates(block)?;
    match &robot.links {
        Links::PlanarTwoLink(_) => {
            let ends = ["L".to_owned(), "H".to_owned()];
            block::check(block, &ends, |case, rate| {
                let mass = planar_mass(&robot.links, if case == "L" { -1.0 } else { 1.0 });
                pivot(&|i, j| mass[i + j], rate)
            })
        }
        Links::Pendulum(_) => {
            let mass = pendulum_mass(&robot.links);
            block::check(block, &one, |_, rate| pivot(&|_, _| mass, rate))
        }
        Links::Tree(bodies) => match &certificate.forms {
            None => {
                let bound = mass_bound(bodies)?;
                block::check(block, &one, |_, rate| pivot(&|i, j| bound[i][j], rate))
            }
            Some(forms) => {
                let chain = Chain::new(bodies, forms)?;
                let cases: BTreeMap<_, _> =
                    chain.cases().into_iter().map(|case| (case.name.clone(), case)).collect();
                let names: Vec<_> = cases.keys().cloned().collect();
                block::check(block, &names, |case, rate| {
                    let case = &cases[case];
                    chain.matrix(case, damping[case.joint], block.rate(rate).claimed).smallest_pivot()
                })
            }
        },
    }
}

fn motors(certificate: &Certificate) -> Result<Claim, Rejected> {
    let block = block::find(certificate, "sigma_m")?;
    let robot = &certificate.robot;
    let damping = damping(&robot.motor_damping, &certificate.controller.gains(Side::Motor).damping);
    equal_rates(block)?;
    block::check(block, &[String::new()], |_, rate| {
        let entry = |(d, m): (&Interval, &Number)| (*d - block.rate(rate).claimed * m.value).lo();
        damping.iter().zip(&robot.motor_inertia).map(entry).fold(f64::INFINITY, f64::min)
    })
}

fn equal_rates(block: &super::document::Block) -> Result<(), Rejected> {
    ensure(block.contraction.is(&block.convergence), format!("blocks.{}", block.name), || {
        format!("both rates are equal in this block, not {} and {}", block.contraction, block.convergence)
    })
}
