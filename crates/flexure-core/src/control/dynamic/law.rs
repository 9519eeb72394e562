//! What laws with memory have in common.

use super::step::{Seen, advanced};
use crate::control::Signals;
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Piecewise, Scalar};

/// A tracking law with memory: `K` numbers per joint z that obey an ordinary differential equation of their own.
///
/// Torque and ż are functions of the motion, the reference and z on every number type, so that the closed loop stays an ordinary differential
/// equation: identities, Jacobians and enclosures work as for static laws ([`ControlLaw`](crate::control::ControlLaw)). [`Running`](super::Running)
/// carries the memory from one control instant to the next.
///
/// ```
/// use flexure_core::control::{Applied, DynamicLaw, Running, Signals};
/// use flexure_core::linalg::Vector;
/// use flexure_core::model::{Fjr, Links, Motion};
/// use flexure_core::robots::Pendulum;
/// use flexure_core::scalar::{Jet, Over, Scalar};
///
/// /// u = −D a (θ − z), ż = a (θ − z): a brake that needs no velocities.
/// struct Brake<C, const N: usize> {
///     /// The diagonal of D [N m s/rad].
///     damping: Vector<C, N>,
///     /// a [1/s].
///     cutoff: Vector<C, N>,
/// }
///
/// impl<C: Scalar, const N: usize> DynamicLaw<C, N, 1> for Brake<C, N> {
///     const READS: Signals = Signals::MOTOR_POSITIONS;
///     const JOINTWISE: bool = true;
///
///     fn start<T: Over<C>, L: Links<C, N>>(
///         &self,
///         _: &Fjr<C, L, N>,
///         x: &Motion<T, N>,
///         _: &Vector<Jet<T, 5>, N>,
///     ) -> [Vector<T, N>; 1] {
///         [x.q_m]
///     }
///
///     fn torque<T: Over<C>, L: Links<C, N>>(
///         &self,
///         robot: &Fjr<C, L, N>,
///         x: &Motion<T, N>,
///         q_ld: &Vector<Jet<T, 5>, N>,
///         z: &[Vector<T, N>; 1],
///     ) -> Vector<T, N> {
///         let [rate] = self.rate(robot, x, q_ld, z, &Applied::NOTHING);
///         -self.damping.diag_mul(&rate)
///     }
///
///     fn rate<T: Over<C>, L: Links<C, N>>(
///         &self,
///         _: &Fjr<C, L, N>,
///         x: &Motion<T, N>,
///         _: &Vector<Jet<T, 5>, N>,
///         [z]: &[Vector<T, N>; 1],
///         _: &Applied<T, N>,
///     ) -> [Vector<T, N>; 1] {
///         [self.cutoff.diag_mul(&(x.q_m - *z))]
///     }
/// }
///
/// let one = Vector([1.0]);
/// let links = Pendulum { inertia: 0.1, weight_moment: 5.0 };
/// let robot = Fjr { links, motor_inertia: one, stiffness: one, link_damping: one, motor_damping: one };
/// let law = Brake { damping: Vector([2.0]), cutoff: Vector([100.0]) };
/// let (mut x, q_ld) = (Motion::at_rest(Vector([0.0])), Vector::ZERO);
/// let mut running = Running::start(&law, &robot, &x, &q_ld);
/// for k in 1..=1000 {
///     x.q_m[0] = 3.0 * 1e-3 * f64::from(k); // 3 rad/s
///     running.advance(&law, &robot, &x, &q_ld, &Applied::NOTHING, 1e-3);
/// }
/// let u = law.torque(&robot, &x, &q_ld, &running.memory);
/// assert!((u[0] + 2.0 * 3.0).abs() < 1e-9);
/// ```
pub trait DynamicLaw<C: Scalar, const N: usize, const K: usize>: Sized {
    /// What it reads of the motion.
    const READS: Signals;

    /// Whether the memory of a joint is all of the memory that moves the rate of its own: filters and integrators joint by joint. The step is then
    /// found joint by joint.
    const JOINTWISE: bool;

    /// The memory that a robot which moves as `x` starts with: without a jump of the torque, as far as the law can see to it.
    fn start<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; K];

    /// The memory of a loop that has followed for long and moves as `x`: what small errors are about.
    #[inline]
    fn settled<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; K] {
        self.start(robot, x, q_ld)
    }

    /// Motor torque [N m] at the motion `x` with the memory `z`; `q_ld` is the reference of the links in rad to order 4.
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        z: &[Vector<T, N>; K],
    ) -> Vector<T, N>;

    /// ż, while the motors get `applied`.
    fn rate<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        z: &[Vector<T, N>; K],
        applied: &Applied<T, N>,
    ) -> [Vector<T, N>; K];

    /// z at the second of two instants that it has `seen`, a `period` in s after it was `z`: by the trapezoidal rule, with all of it solved for together. A
    /// law whose memory is slow in part, or has bounds, says so here.
    #[inline]
    fn advanced<T: Over<C> + Piecewise, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        seen: [&Seen<T, N>; 2],
        z: &[Vector<T, N>; K],
        applied: &Applied<T, N>,
        period: T,
    ) -> [Vector<T, N>; K] {
        advanced::<K, _, _, _, _, N, K>(self, robot, seen, z, applied, period)
    }
}

/// What the motors get of what was asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Applied<T, const N: usize> {
    /// Torque that left the controller [N m].
    pub asked: Vector<T, N>,
    /// Torque on the motors, after limits and delays [N m].
    pub given: Vector<T, N>,
}

impl<T: Scalar, const N: usize> Applied<T, N> {
    /// No torque at all.
    pub const NOTHING: Self = Self { asked: Vector::ZERO, given: Vector::ZERO };

    /// All of `torque` [N m], as in continuous time without limits.
    #[inline]
    pub fn fully(torque: Vector<T, N>) -> Self {
        Self { asked: torque, given: torque }
    }

    /// What was withheld, asked − given [N m]: what integrators must not integrate against.
    #[inline]
    pub fn withheld(&self) -> Vector<T, N> {
        self.asked - self.given
    }
}
