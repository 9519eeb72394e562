//! Which structures the closed loop keeps under a shaping function: claims with witnesses.

use flexure_core::scalar::Interval;

use crate::prove::engine::certificate::{
    CertifiedPhi, DecimalGains, LoopSide, StructureClaim, StructureName, Witness,
};
use crate::prove::engine::number::Number;
use crate::prove::engine::position::Position;

/// A side of the robot: whose φ, its gains, and both enclosed.
pub struct SideOf<'a> {
    /// Links or motors.
    pub side: LoopSide,
    /// The gains.
    pub gains: &'a DecimalGains,
    /// φ and Π, enclosed.
    pub position: &'a Position,
}

/// The four claims; the reason in words if one of them can be neither shown nor refuted.
///
/// # Errors
/// If numbers are known too coarsely.
pub fn claims(phi: CertifiedPhi, sides: &[SideOf<'_>]) -> Result<Vec<StructureClaim>, String> {
    let holding = |name| StructureClaim { name, holds: true, witness: None };
    let failing = |name, witness| StructureClaim { name, holds: false, witness: Some(witness) };
    let n = sides[0].position.joints();

    let variational = StructureName::VariationalPh;
    let kept = phi.certified().is_diagonal(n);
    let variational = if kept {
        holding(variational)
    } else {
        failing(variational, search(sides, asymmetry).ok_or("∂φ Π⁻¹ may or may not be symmetric")?)
    };

    let ph_like = StructureName::PhLike;
    let equal = |side: &SideOf<'_>| {
        let pairs = side.gains.metric.iter().zip(&side.gains.shaping);
        pairs.into_iter().all(|(a, b)| matches!((a, b), (Number::Decimal(a), Number::Decimal(b)) if a == b))
    };
    let ph_like = if phi.certified().is_constant() && sides.iter().all(equal) {
        holding(ph_like)
    } else {
        failing(ph_like, search(sides, distance).ok_or("∂φ may or may not be Π")?)
    };
    Ok(vec![
        variational,
        ph_like,
        holding(StructureName::StrictDifferentialPassivity),
        holding(StructureName::IncrementalPassivity),
    ])
}

/// Υ_ij − Υ_ji with Υ = ∂φ Π⁻¹.
fn asymmetry(position: &Position, a: &[Interval], i: usize, j: usize) -> Interval {
    let upsilon = |i, j| position.slope(a, i, j) / position.metric(j);
    upsilon(i, j) - upsilon(j, i)
}

/// ∂φ_ij − Π_ij.
fn distance(position: &Position, a: &[Interval], i: usize, j: usize) -> Interval {
    let slope = position.slope(a, i, j);
    if i == j { slope - position.metric(i) } else { slope }
}

/// The error, among 0 and those with one joint far out, and the entry at which `difference` is largest.
fn search(
    sides: &[SideOf<'_>],
    difference: fn(&Position, &[Interval], usize, usize) -> Interval,
) -> Option<Witness> {
    let mut found: Option<(f64, Witness)> = None;
    for SideOf { side, position, .. } in sides {
        let n = position.joints();
        for far in 0..=n {
            let ends: Vec<bool> = (0..n).map(|j| j == far).collect();
            let error = position.error_at(&ends);
            let a = Position::slopes_at(&error);
            for (row, column) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let size = difference(position, &a, row, column);
                let least = size.lo().max(-size.hi());
                if least > found.as_ref().map_or(0.0, |(best, _)| *best) {
                    let witness = Witness {
                        side: *side,
                        error: error.iter().map(|&e| Number::decimal(e)).collect(),
                        row,
                        column,
                        difference: Number::margin(0.5 * least),
                    };
                    found = Some((least, witness));
                }
            }
        }
    }
    found.map(|(_, witness)| witness)
}
