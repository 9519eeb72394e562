//! What the engine proves about.

use flexure_core::scalar::Interval;

use crate::linalg::Symmetric;
use crate::prove::engine::direct::closed_loop::VcbcLoop;

/// How a quadratic storage W = ½ δzᵀ `weight` δz balances: Ẇ = −δzᵀ `dissipation` δz.
///
/// √W decays at least at the rate β where `dissipation − β weight` and `weight` are positive definite.
#[derive(Clone, Debug, PartialEq)]
pub struct Balance<T> {
    /// Quadratic form of −Ẇ.
    pub dissipation: Symmetric<T>,
    /// Twice the quadratic form of W: the metric.
    pub weight: Symmetric<T>,
}

/// One coordinate of a region.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinate {
    /// Name in messages.
    pub name: String,
    /// SI unit as plain text.
    pub unit: &'static str,
    /// Its range; an infinite end means no bound.
    pub range: Interval,
}

/// Variations δz of a dynamical system over a box of coordinates: its states and whatever else it depends on.
///
/// Sizes are known at run time only, so that the engine is compiled once.
pub trait Flow {
    /// The coordinates and their ranges.
    fn coordinates(&self) -> &[Coordinate];

    /// Encloses the balance at every point of the box `at`, and for every value of constants that are intervals.
    fn enclosure(&self, at: &[Interval]) -> Balance<Interval>;

    /// The balance at a point in plain `f64`: for samples. No proof depends on it.
    fn value(&self, at: &[f64]) -> Balance<f64>;
}

/// A system written once over its number type, constants included.
pub trait System<C> {
    /// The balance at the coordinates `at`.
    fn balance(&self, at: &[C]) -> Balance<C>;
}

/// The same system twice: with constants enclosed, for proofs, and with `f64` constants inside those, for samples.
#[derive(Clone, Debug)]
pub struct Twins<A, B> {
    /// The system with enclosed constants, over intervals: for proofs.
    pub bounds: A,
    /// The system with `f64` constants: for samples.
    pub point: B,
    /// Coordinates of both.
    pub coordinates: Vec<Coordinate>,
}

/// [`Twins`] of the v-CBC law's closed loop.
pub type VcbcFlow<LI, PlI, PmI, L, Pl, Pm, const N: usize> =
    Twins<VcbcLoop<Interval, LI, PlI, PmI, N>, VcbcLoop<f64, L, Pl, Pm, N>>;

impl<A: System<Interval>, B: System<f64>> Flow for Twins<A, B> {
    fn coordinates(&self) -> &[Coordinate] {
        &self.coordinates
    }

    fn enclosure(&self, at: &[Interval]) -> Balance<Interval> {
        self.bounds.balance(at)
    }

    fn value(&self, at: &[f64]) -> Balance<f64> {
        self.point.balance(at)
    }
}
