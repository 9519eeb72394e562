//! The closed loop of the v-CBC law as the core computes it.

use flexure_core::control::{Input, Shaping, Vcbc};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links};
use flexure_core::scalar::{Dual, Interval, Over, Scalar};
use flexure_core::virtual_system::{ErrorState, VelocityErrors, velocity_error_rates};

use crate::linalg::Symmetric;
use crate::prove::engine::direct::flow::{Balance, Coordinate, System, Twins, VcbcFlow};
use crate::prove::engine::direct::jacobian::{jacobian, symmetric_part};
use crate::units::{self, Unit};

/// A robot under the v-CBC law, constants of type `C`.
///
/// Coordinates, `N` each: q̃_l, q̃_m in rad, s_l, s_m [rad/s] (errors) and q_l in rad (real motion). Variations are those of the
/// errors, δz = (δq̃_l, δq̃_m, δs_l, δs_m) with δs = M⁻¹ δσ at the real motion, which needs no inverse of M:
/// W = ½ δzᵀ diag(Π_l, Π_m, M_l, M_m) δz. How fast the links move does not matter: E_l + ½ Ṁ_l is skew.
#[derive(Clone, Debug)]
pub struct VcbcLoop<C, L, Pl, Pm, const N: usize> {
    /// The robot.
    pub robot: Fjr<C, L, N>,
    /// The law.
    pub law: Vcbc<C, Pl, Pm, N>,
}

/// A box of states of the closed loop; what is not said is unbounded.
#[derive(Clone, Debug, PartialEq)]
pub struct StateBox<const N: usize> {
    /// Link position errors q̃_l in rad.
    pub error_l: [Interval; N],
    /// Motor position errors q̃_m in rad.
    pub error_m: [Interval; N],
    /// Link velocity errors s_l [rad/s]: they matter only where the metric depends on q̃_l.
    pub velocity_error_l: [Interval; N],
    /// Motor velocity errors s_m [rad/s].
    pub velocity_error_m: [Interval; N],
    /// Link positions q_l in rad; [`full_turn`] is every angle.
    pub position: [Interval; N],
}

/// Every angle in rad: [−π, π], rounded outwards.
pub fn full_turn() -> Interval {
    // The float nearest to π is below it.
    let turn = core::f64::consts::PI.next_up();
    Interval::point(-turn).hull(Interval::point(turn))
}

impl<const N: usize> StateBox<N> {
    /// Position errors within ±`error` in rad on both sides, all angles, all velocity errors.
    pub fn within(error: f64) -> Self {
        let error = [Interval::point(-error).hull(Interval::point(error)); N];
        Self {
            error_l: error,
            error_m: error,
            velocity_error_l: [Interval::ENTIRE; N],
            velocity_error_m: [Interval::ENTIRE; N],
            position: [full_turn(); N],
        }
    }

    /// The coordinates of `n` joints in the order of [`VcbcLoop`].
    pub fn coordinates(&self, n: usize) -> Vec<Coordinate> {
        let blocks = [
            ("e_l", units::ANGLE, &self.error_l),
            ("e_m", units::ANGLE, &self.error_m),
            ("s_l", units::SPEED, &self.velocity_error_l),
            ("s_m", units::SPEED, &self.velocity_error_m),
            ("q_l", units::ANGLE, &self.position),
        ];
        let named = |(name, unit, ranges): (&str, Unit, &[Interval; N])| {
            let coordinate = |(i, &range): (usize, &Interval)| Coordinate {
                name: format!("{name}[{i}]"),
                unit: unit.plain,
                range,
            };
            ranges.iter().take(n).enumerate().map(coordinate).collect::<Vec<_>>()
        };
        blocks.into_iter().flat_map(named).collect()
    }
}

/// The v-CBC law's closed loop over a region: robot and law with constants enclosed, and again in `f64`.
pub fn vcbc<LI, PlI, PmI, L, Pl, Pm, const N: usize>(
    bounds: VcbcLoop<Interval, LI, PlI, PmI, N>,
    point: VcbcLoop<f64, L, Pl, Pm, N>,
    region: &StateBox<N>,
) -> VcbcFlow<LI, PlI, PmI, L, Pl, Pm, N>
where
    LI: Links<Interval, N>,
{
    let coordinates = region.coordinates(bounds.robot.links.joints());
    Twins { bounds, point, coordinates }
}

impl<C, L, Pl, Pm, const N: usize> System<C> for VcbcLoop<C, L, Pl, Pm, N>
where
    C: Scalar + Over<C>,
    L: Links<C, N>,
    Pl: Shaping<C, N>,
    Pm: Shaping<C, N>,
{
    /// Ẇ = δzᵀ G δz, G = diag(Π_l, Π_m, 1, 1) F + diag(½ Π̇_l, 0, −½ Ṁ_l, 0), F the Jacobian of the rates of
    /// (q̃_l, q̃_m, σ_l, σ_m): d/dt ½ δσᵀ M⁻¹ δσ = δsᵀ δσ̇ − ½ δsᵀ Ṁ δs.
    ///
    /// Of the motion of the links, F has −E_l = ½ Ṁ_l − S_l with a skew S_l in the rows and columns of momenta: with −½ Ṁ_l a skew matrix is left,
    /// δsᵀ S_l δs = 0. So both are left out before anything is enclosed. Enclosed they would not cancel, and no rate would be shown at
    /// every speed, nor of three joints at any.
    fn balance(&self, at: &[C]) -> Balance<C> {
        let n = self.robot.links.joints();
        let mass = self.robot.links.mass_matrix(&block(at, n, 4));

        let F = jacobian(&at[..4 * n], 4 * n, |z| self.rates(z));
        let (Pi_l, Pi_l_rate) = self.link_metric(at);
        let half = C::from_f64(0.5);
        let carried = |i: usize, j: usize| match i / n {
            0 => Pi_l[i] * F[(i, j)],
            1 => self.law.motor.metric[i - n] * F[(i, j)],
            _ => F[(i, j)],
        };
        let dissipation = Symmetric::from_fn(4 * n, |i, j| {
            let metric_rate = if i == j && i < n { half * Pi_l_rate[i] } else { C::ZERO };
            -(symmetric_part(carried, i, j) + metric_rate)
        });
        let weight = Symmetric::from_fn(4 * n, |i, j| match i / n {
            2 if j / n == 2 => mass[(i - 2 * n, j - 2 * n)],
            _ if i != j => C::ZERO,
            0 => Pi_l[i],
            1 => self.law.motor.metric[i - n],
            _ => self.robot.motor_inertia[i - 3 * n],
        });
        Balance { dissipation, weight }
    }
}

impl<C, L, Pl, Pm, const N: usize> VcbcLoop<C, L, Pl, Pm, N>
where
    C: Scalar + Over<C>,
    L: Links<C, N>,
    Pl: Shaping<C, N>,
    Pm: Shaping<C, N>,
{
    /// The rates of (q̃_l, q̃_m, σ_l, σ_m) at z, but for −E_l s_l.
    fn rates(&self, z: &[Dual<C, 1>]) -> Vec<Dual<C, 1>> {
        let n = self.robot.links.joints();
        let block = |k: usize| block(z, n, k);
        let errors = VelocityErrors { e_l: block(0), e_m: block(1), s_l: block(2), s_m: block(3) };
        let ErrorState { e_l, e_m, sigma_l, sigma_m } =
            velocity_error_rates(&self.robot, &self.law, &errors, &Matrix::ZERO, &Input::ZERO);
        [e_l, e_m, sigma_l, sigma_m].iter().flat_map(|part| part.iter().take(n)).collect()
    }

    /// Π_l and its rate: it moves with q̃_l.
    fn link_metric(&self, at: &[C]) -> (Vector<C, N>, Vector<C, N>) {
        let z: Vec<Dual<C, 1>> = at.iter().map(|&x| Dual::constant(x)).collect();
        let rates = self.rates(&z);
        let moving = Vector::from_fn(|i| match rates.get(i) {
            Some(rate) if i < self.robot.links.joints() => Dual { value: at[i], gradient: [rate.value] },
            _ => Dual::constant(C::ZERO),
        });
        let metric: Vector<Dual<C, 1>, N> = self.law.link.metric.at(&moving);
        (metric.map(|x| x.value), metric.map(|x| x.gradient[0]))
    }
}

/// Part `k` of numbers that come as `n` for each part; zero for joints that only fill the capacity.
fn block<T: Scalar, const N: usize>(values: &[T], n: usize, k: usize) -> Vector<T, N> {
    Vector::from_fn(|i| if i < n { values[k * n + i] } else { T::ZERO })
}
