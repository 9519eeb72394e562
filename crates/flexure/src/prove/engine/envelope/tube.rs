//! Error tubes around a reference over a slab of time: what every one of them tells, and {W ≤ c} at the link positions that it
//! reaches.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Symmetric;
use crate::prove::engine::envelope::closed_loop::TrackingLoop;

/// A set of errors q̃_l, q̃_m in rad, s_l, s_m [rad/s] around 0, the same whatever their signs are.
pub trait Tube: std::fmt::Debug + Send + Sync {
    /// The box that it lies in, in the order q̃_l, q̃_m, s_l, s_m.
    fn errors(&self) -> Vec<Interval>;

    /// The values of g·x̃ over it, g the 4n derivatives `gradient` in that order.
    fn reach(&self, gradient: &[Interval]) -> Interval;

    /// A point of it, but for rounding, where g·x̃ is largest.
    fn farthest(&self, gradient: &[f64]) -> Vec<f64>;
}

/// Errors q̃_l, q̃_m, s_l, s_m with W ≤ c, W = ½ (q̃_lᵀ Π_l q̃_l + q̃_mᵀ Π_m q̃_m + s_lᵀ M_l s_l + s_mᵀ M_m s_m), and what the
/// inverse of diag(Π_l, Π_m, M_l, M_m) is there.
#[derive(Clone, Debug)]
pub struct ErrorTube {
    /// 2 c in J.
    twice_level: Interval,
    /// Π_l⁻¹, Π_m⁻¹, M_m⁻¹.
    inverses: [Vec<Interval>; 3],
    /// M_l⁻¹ over the tube's link positions.
    inverse_mass: Symmetric<Interval>,
}

impl ErrorTube {
    /// The tube of level `level` in J around the link positions `q_ld` in rad.
    pub fn new(system: &dyn TrackingLoop, level: f64, q_ld: &[Interval]) -> Self {
        let twice_level = Interval::point(2.0) * Interval::point(level);
        let inverses = system.metrics().map(|metric| metric.into_iter().map(Interval::recip).collect());
        let [link, ..]: &[Vec<Interval>; 3] = &inverses;
        let q_l: Vec<_> =
            q_ld.iter().zip(link).map(|(&q, &inverse)| q + ball(twice_level * inverse)).collect();
        let inverse_mass = system.inverse_mass(&q_l);
        Self { twice_level, inverses, inverse_mass }
    }

    /// √(gᵀ P⁻¹ g), from above: |g·x̃| is at most that times √(2 W).
    pub fn dual(&self, gradient: &[Interval]) -> Interval {
        Interval::point(self.dual_square(gradient).sqrt().hi())
    }

    fn dual_square(&self, gradient: &[Interval]) -> Interval {
        gradient.iter().zip(self.pull(gradient)).enumerate().fold(Interval::ZERO, |sum, (i, (&g, pull))| {
            sum + if self.is_link_velocity(i) { g * pull } else { g.square() * self.diagonal(i) }
        })
    }

    /// M_l⁻¹ over the tube's link positions [1/(kg m²)].
    pub fn inverse_mass(&self) -> &Symmetric<Interval> {
        &self.inverse_mass
    }

    /// A diagonal matrix above [`inverse_mass`](Self::inverse_mass): its sums of absolute values by rows, each entry weighed by
    /// the roots of the two diagonal ones, as Gershgorin has it.
    pub fn above_inverse_mass(&self) -> Vec<Interval> {
        let n = self.inverse_mass.size();
        // Any positive weights do.
        let weight: Vec<f64> = (0..n).map(|i| self.inverse_mass.at(i, i).midpoint().sqrt()).collect();
        let row = |i: usize| {
            let entry = |j: usize| {
                let size = Interval::point(self.inverse_mass.at(i, j).magnitude());
                size * Interval::point(weight[i]) / Interval::point(weight[j])
            };
            Interval::point((0..n).fold(Interval::ZERO, |sum, j| sum + entry(j)).hi())
        };
        (0..n).map(row).collect()
    }

    /// P⁻¹ g: the direction of the error at which g·x̃ is largest.
    fn pull(&self, gradient: &[Interval]) -> Vec<Interval> {
        let n = self.inverse_mass.size();
        let row = |i: usize| {
            (0..n).fold(Interval::ZERO, |sum, j| sum + self.inverse_mass.at(i, j) * gradient[2 * n + j])
        };
        let entry = |i: usize| {
            if self.is_link_velocity(i) { row(i - 2 * n) } else { gradient[i] * self.diagonal(i) }
        };
        (0..4 * n).map(entry).collect()
    }

    fn is_link_velocity(&self, i: usize) -> bool {
        let n = self.inverse_mass.size();
        (2 * n..3 * n).contains(&i)
    }

    /// Entry i of the diagonal of P⁻¹.
    fn diagonal(&self, i: usize) -> Interval {
        let n = self.inverse_mass.size();
        match i / n {
            0 => self.inverses[0][i],
            1 => self.inverses[1][i - n],
            2 => self.inverse_mass.at(i - 2 * n, i - 2 * n),
            _ => self.inverses[2][i - 3 * n],
        }
    }
}

impl Tube for ErrorTube {
    /// |x̃_i| ≤ √(2 c (P⁻¹)_ii).
    fn errors(&self) -> Vec<Interval> {
        let n = self.inverse_mass.size();
        let [link, motor, inertia] = &self.inverses;
        let mass = (0..n).map(|i| self.inverse_mass.at(i, i));
        let all = link.iter().chain(motor).copied().chain(mass).chain(inertia.iter().copied());
        all.map(|inverse| ball(self.twice_level * inverse)).collect()
    }

    /// At most √(2 c gᵀ P⁻¹ g), the norm dual to W's.
    fn reach(&self, gradient: &[Interval]) -> Interval {
        ball(self.twice_level * self.dual_square(gradient))
    }

    /// √(2 c) P⁻¹ g / √(gᵀ P⁻¹ g).
    fn farthest(&self, gradient: &[f64]) -> Vec<f64> {
        let points: Vec<_> = gradient.iter().map(|&g| Interval::point(g)).collect();
        let pull: Vec<f64> = self.pull(&points).iter().map(|x| x.midpoint()).collect();
        let length = gradient.iter().zip(&pull).map(|(g, x)| g * x).sum::<f64>().sqrt();
        let scale = if length > 0.0 { self.twice_level.midpoint().sqrt() / length } else { 0.0 };
        pull.iter().map(|x| x * scale).collect()
    }
}

/// The numbers x with x² ≤ `square`.
pub(super) fn ball(square: Interval) -> Interval {
    let radius = square.sqrt().hi();
    Interval::new(-radius, radius).unwrap_or(Interval::ENTIRE)
}
