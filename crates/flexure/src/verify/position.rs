//! Position blocks: the shaping function contracts in its metric at every vertex of the slopes.

use flexure_core::scalar::{Interval, Scalar};

use crate::verify::block;
use crate::verify::document::{Certificate, Phi, Side};
use crate::verify::matrix::Symmetric;
use crate::verify::shaping::{Law, Rate};
use crate::verify::verdict::{Claim, Rejected};

pub(super) fn check(certificate: &Certificate) -> Result<Vec<Claim>, Rejected> {
    let mut claims = Vec::new();
    for (name, side) in [("phi_l", Side::Link), ("phi_m", Side::Motor)] {
        let block = block::find(certificate, name)?;
        let law = Law::of(certificate, side);
        let ends = [law.lower_ends(Rate::Contraction), law.lower_ends(Rate::Convergence)];
        let pivot = |case: &str, rate: Rate| {
            let lower = &ends[usize::from(rate == Rate::Convergence)];
            inequality(&law, &vertex(case, lower), block.rate(rate).claimed).smallest_pivot()
        };
        claims.push(block::check(block, &cases(&law), pivot)?);
    }
    Ok(claims)
}

/// The words of `L` and `H` that have to be looked at.
fn cases(law: &Law<'_>) -> Vec<String> {
    let n = law.n;
    match law.phi {
        Phi::Tanh => vec!["L".repeat(n)],
        Phi::CoupledTanh if n > 1 => {
            let letter = |word: u32, j: usize| if word >> j & 1 == 0 { 'L' } else { 'H' };
            (0..1_u32 << n).map(|word| (0..n).map(|j| letter(word, j)).collect()).collect()
        }
        Phi::Linear | Phi::CoupledTanh => vec![String::new()],
    }
}

/// The slopes at a vertex: lower ends at `L`, 1 elsewhere.
fn vertex(case: &str, lower: &[Interval]) -> Vec<Interval> {
    let letters = case.chars().chain(std::iter::repeat('H'));
    lower.iter().zip(letters).map(|(low, letter)| if letter == 'L' { *low } else { Interval::ONE }).collect()
}

/// G(a) = sym(Π ∂φ(a)) − β Π.
fn inequality(law: &Law<'_>, a: &[Interval], beta: Interval) -> Symmetric {
    let product = |i: usize, j: usize| law.metric[i].value * law.entry(i, j, a[j], Interval::ONE);
    Symmetric::from_fn(law.n, |i, j| {
        if i == j {
            law.metric[i].value * (law.entry(i, i, a[i], Interval::ONE) - beta)
        } else {
            (product(i, j) + product(j, i)) * Interval::from_f64(0.5)
        }
    })
}
