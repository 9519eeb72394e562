//! The flexible-joint robot: links, springs and motors.

use super::{LinkMatrices, Links, MassFactor, Motion, State, links::seeded};
use crate::linalg::Vector;
use crate::scalar::{Dual, Over, Scalar};

/// A flexible-joint robot as a port-Hamiltonian system. Paper, eq. phmechanical-flexible.
///
/// Each motor's inertia is constant and its centre of mass lies on its axis, so M_m is diagonal, E_m = 0 and the
/// motors have no gravity potential (the paper's standing assumptions). Everything is on the link side of the gear.
///
/// ```
/// use flexure_core::linalg::Vector;
/// use flexure_core::model::{Fjr, Motion};
/// use flexure_core::robots::Pendulum;
///
/// let robot = Fjr {
///     links: Pendulum { inertia: 0.5, weight_moment: 10.0 },
///     motor_inertia: Vector([0.1]),
///     stiffness: Vector([100.0]),
///     link_damping: Vector([0.2]),
///     motor_damping: Vector([0.3]),
/// };
/// // Held horizontally, the weight of 10 N m winds the spring of 100 N m/rad up by 0.1 rad.
/// let q_l = Vector([core::f64::consts::FRAC_PI_2]);
/// let held = Motion { q_m: robot.motors_at_rest(&q_l), ..Motion::at_rest(q_l) };
/// assert!((held.deflection()[0] - 0.1).abs() < 1e-12);
/// assert!(robot.link_acceleration(&held)[0].abs() < 1e-12);
/// // Let go, the motor falls after: 10 N m on 0.1 kg m².
/// assert!((robot.motor_acceleration(&held, &Vector([0.0]))[0] + 100.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Fjr<C, L, const N: usize> {
    /// The rigid links: mass matrix, Coriolis and gravity torques.
    pub links: L,
    /// Motor inertias, the diagonal of M_m [kg m²].
    pub motor_inertia: Vector<C, N>,
    /// Spring constants, the diagonal of K [N m/rad].
    pub stiffness: Vector<C, N>,
    /// Link damping, the diagonal of D_l [N m s/rad].
    pub link_damping: Vector<C, N>,
    /// Motor damping, the diagonal of D_m [N m s/rad].
    pub motor_damping: Vector<C, N>,
}

/// The terms of the power balance Ḣ = supplied − dissipated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power<T> {
    /// yᵀ u_m = q̇_mᵀ u_m in W.
    pub supplied: T,
    /// q̇_lᵀ D_l q̇_l + q̇_mᵀ D_m q̇_m in W.
    pub dissipated: T,
}

impl<C: Scalar, L: Links<C, N>, const N: usize> Fjr<C, L, N> {
    /// The state: momenta p_l = M_l q̇_l, p_m = M_m q̇_m from velocities.
    #[inline]
    pub fn state<T: Over<C>>(&self, x: &Motion<T, N>) -> State<T, N> {
        State {
            q_l: x.q_l,
            q_m: x.q_m,
            p_l: self.links.mass_mul(&x.q_l, &x.v_l),
            p_m: self.motor_inertia.diag_mul(&x.v_m),
        }
    }

    /// The motion: velocities q̇ = ∂H/∂p from momenta.
    #[inline]
    pub fn motion<T: Over<C>>(&self, x: &State<T, N>) -> Motion<T, N> {
        Motion {
            q_l: x.q_l,
            q_m: x.q_m,
            v_l: self.links.factor(&x.q_l).solve(&x.p_l),
            v_m: Vector::from_fn(|i| x.p_m[i] / T::constant(self.motor_inertia[i])),
        }
    }

    /// Spring torque K ζ on the links [N m]; the motors feel its opposite.
    #[inline]
    pub fn spring_torque<T: Over<C>>(&self, q_l: &Vector<T, N>, q_m: &Vector<T, N>) -> Vector<T, N> {
        self.stiffness.diag_mul(&(*q_m - *q_l))
    }

    /// Hamiltonian H in J: kinetic, gravity and spring energy.
    #[inline]
    pub fn hamiltonian<T: Over<C>>(&self, x: &State<T, N>) -> T {
        let motion = self.motion(x);
        let kinetic = x.p_l.dot(&motion.v_l) + x.p_m.dot(&motion.v_m);
        self.energy(&motion, kinetic)
    }

    /// Total energy in J from velocities: the Hamiltonian without solving for them.
    #[inline]
    pub fn total_energy<T: Over<C>>(&self, x: &Motion<T, N>) -> T {
        let p = self.state(x);
        self.energy(x, p.p_l.dot(&x.v_l) + p.p_m.dot(&x.v_m))
    }

    #[inline]
    fn energy<T: Over<C>>(&self, x: &Motion<T, N>, twice_kinetic: T) -> T {
        let zeta = x.deflection();
        let twice_spring = zeta.dot(&self.stiffness.diag_mul(&zeta));
        T::from_f64(0.5) * (twice_kinetic + twice_spring) + self.links.potential_energy(&x.q_l)
    }

    /// ∂H/∂x, with the shape of a state: torques [N m] for positions, velocities [rad/s] for momenta.
    #[inline]
    pub fn gradient<T: Over<C>>(&self, x: &State<T, N>) -> State<T, N> {
        let motion = self.motion(x);
        let constant = |v: &Vector<T, N>| v.map(Dual::<T, N>::constant);
        let dual = State {
            q_l: seeded(&x.q_l),
            q_m: constant(&x.q_m),
            p_l: constant(&x.p_l),
            p_m: constant(&x.p_m),
        };
        State {
            q_l: Vector(self.hamiltonian(&dual).gradient),
            q_m: self.spring_torque(&x.q_l, &x.q_m),
            p_l: motion.v_l,
            p_m: motion.v_m,
        }
    }

    /// ẋ in Hamiltonian form, (J − R) ∂H/∂x + g u_m. Paper, eq. phmechanical-flexible.
    #[inline]
    pub fn hamiltonian_dynamics<T: Over<C>>(&self, x: &State<T, N>, u_m: &Vector<T, N>) -> State<T, N> {
        let dh = self.gradient(x);
        State {
            q_l: dh.p_l,
            q_m: dh.p_m,
            p_l: -dh.q_l - self.link_damping.diag_mul(&dh.p_l),
            p_m: -dh.q_m - self.motor_damping.diag_mul(&dh.p_m) + *u_m,
        }
    }

    /// ẋ in workless form, with E_l instead of ∂H/∂q_l. Paper, eq. phmechanical-alternative and workless-flexible.
    #[inline]
    pub fn workless_dynamics<T: Over<C>>(&self, x: &State<T, N>, u_m: &Vector<T, N>) -> State<T, N> {
        let Motion { v_l, v_m, .. } = self.motion(x);
        let E_l = LinkMatrices::new(&self.links, &x.q_l, &v_l).workless();
        let spring = self.spring_torque(&x.q_l, &x.q_m);
        State {
            q_l: v_l,
            q_m: v_m,
            p_l: spring - E_l * v_l - self.link_damping.diag_mul(&v_l) - self.links.gravity_torque(&x.q_l),
            p_m: *u_m - spring - self.motor_damping.diag_mul(&v_m),
        }
    }

    /// Link torque that the springs and the link damping leave for motion: K ζ − D_l q̇_l [N m].
    #[inline]
    pub fn link_torque<T: Over<C>>(&self, x: &Motion<T, N>) -> Vector<T, N> {
        self.spring_torque(&x.q_l, &x.q_m) - self.link_damping.diag_mul(&x.v_l)
    }

    /// Link accelerations q̈_l [rad/s²]: they do not depend on the motor torque.
    #[inline]
    pub fn link_acceleration<T: Over<C>>(&self, x: &Motion<T, N>) -> Vector<T, N> {
        self.links.forward_dynamics(&x.q_l, &x.v_l, &self.link_torque(x))
    }

    /// Motor accelerations q̈_m [rad/s²] under the motor torque u_m [N m].
    #[inline]
    pub fn motor_acceleration<T: Over<C>>(&self, x: &Motion<T, N>, u_m: &Vector<T, N>) -> Vector<T, N> {
        let torque = *u_m - self.spring_torque(&x.q_l, &x.q_m) - self.motor_damping.diag_mul(&x.v_m);
        Vector::from_fn(|i| torque[i] / T::constant(self.motor_inertia[i]))
    }

    /// Motor torque u_m [N m] that gives the motors the accelerations `a_m` [rad/s²].
    #[inline]
    pub fn motor_torque<T: Over<C>>(&self, x: &Motion<T, N>, a_m: &Vector<T, N>) -> Vector<T, N> {
        self.motor_inertia.diag_mul(a_m)
            + self.motor_damping.diag_mul(&x.v_m)
            + self.spring_torque(&x.q_l, &x.q_m)
    }

    /// The power that flows in through the motors and out through the dampers.
    #[inline]
    pub fn power<T: Over<C>>(&self, x: &Motion<T, N>, u_m: &Vector<T, N>) -> Power<T> {
        Power {
            supplied: x.v_m.dot(u_m),
            dissipated: x.v_l.dot(&self.link_damping.diag_mul(&x.v_l))
                + x.v_m.dot(&self.motor_damping.diag_mul(&x.v_m)),
        }
    }
}
