//! What is simulated: the robot as the law knows it, and what the law does not know of it.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links, MassFactor, Motion, Power, RotorCoupling};
use flexure_core::scalar::{Over, Piecewise, Scalar};

use crate::plant::friction::Friction;
use crate::plant::spring::Hysteresis;

/// A robot with what its model leaves out. The law is built on [`robot`](Self::robot) alone. Its constants are of type `C`: floats, or
/// lanes where several robots are moved together. What makes a plant rough is floats always: rough plants are moved one by one.
#[derive(Clone, Copy, Debug)]
pub struct Plant<L, const N: usize, C = f64> {
    /// The reduced model with linear springs.
    pub robot: Fjr<C, L, N>,
    /// k ≥ 0 in the spring torque K ε + k ε³ [N m/rad³].
    pub spring_hardening: Vector<C, N>,
    /// Play ≥ 0 in the springs, all of it, in rad: ε = ζ − clamp(ζ, ±gap/2).
    pub spring_gap: Vector<f64, N>,
    /// Springs that slip inside, in parallel with the others.
    pub hysteresis: Hysteresis<N>,
    /// Dry friction of the links.
    pub link_friction: Friction<N>,
    /// Dry friction of the motors, on the link side of the gear.
    pub motor_friction: Friction<N>,
    /// Inertial coupling of the rotors; without it they only spin about their own axes.
    pub rotor_coupling: Option<RotorCoupling<C, N>>,
    /// What the motors give of the torque that their drives believe to give > 0: torque constants that differ from the data
    /// sheet. Drives report what they believe.
    pub torque_gain: Vector<C, N>,
    /// Torque on the links from outside, constant while the plant is advanced [N m].
    pub external: Vector<C, N>,
}

/// One vector for the links and one for the motors.
pub(crate) type Sides<const N: usize, T = f64> = [Vector<T, N>; 2];

impl<C: Scalar, L, const N: usize> From<Fjr<C, L, N>> for Plant<L, N, C> {
    /// The plant that is as its model.
    fn from(robot: Fjr<C, L, N>) -> Self {
        Self {
            robot,
            spring_hardening: Vector::ZERO,
            spring_gap: Vector::ZERO,
            hysteresis: Hysteresis::NONE,
            link_friction: Friction::NONE,
            motor_friction: Friction::NONE,
            rotor_coupling: None,
            torque_gain: Vector([C::ONE; N]),
            external: Vector::ZERO,
        }
    }
}

impl<C, L, const N: usize> Plant<L, N, C> {
    /// Whether torques are smooth functions of the motion: no dry friction, no play, no hysteresis.
    pub fn is_smooth(&self) -> bool {
        self.link_friction.is_none()
            && self.motor_friction.is_none()
            && self.hysteresis.is_none()
            && self.spring_gap.iter().all(|gap| gap == 0.0)
    }
}

impl<C: Piecewise + Over<C>, L: Links<C, N>, const N: usize> Plant<L, N, C> {
    /// Total energy in J, without what hysteresis keeps.
    pub fn total_energy(&self, x: &Motion<C, N>) -> C {
        let coupling = self.rotor_coupling.map_or(C::ZERO, |coupling| coupling.energy(&self.robot.links, x));
        self.robot.total_energy(x) + self.nonlinear_energy(x) + coupling
    }

    /// The power that flows in through the motors and from outside, and out through the dampers.
    pub fn power(&self, x: &Motion<C, N>, u_m: &Vector<C, N>) -> Power<C> {
        let Power { supplied, dissipated } = self.robot.power(x, u_m);
        Power { supplied: supplied + x.v_l.dot(&self.external), dissipated }
    }

    /// S(q_l) of the rotor coupling [kg m²], if there is any.
    pub(crate) fn coupling_matrix<T: Over<C>>(&self, q_l: &Vector<T, N>) -> Option<Matrix<T, N, N>> {
        self.rotor_coupling.map(|coupling| coupling.matrix(&self.robot.links, q_l))
    }

    /// Torques on links and motors that the accelerations `a` leave unbalanced under the motor torque `u_m` [N m]; without
    /// friction and hysteresis.
    #[inline]
    pub(crate) fn unbalanced<T: Over<C> + Piecewise>(
        &self,
        x: &Motion<T, N>,
        u_m: &Vector<T, N>,
        a: Sides<N, T>,
    ) -> Sides<N, T> {
        let (robot, [a_l, a_m]) = (&self.robot, a);
        let external = self.external.map(T::constant);
        let nonlinear = self.nonlinear_torque(x);
        let needed = robot.links.inverse_dynamics(&x.q_l, &x.v_l, &x.v_l, &a_l);
        let spring = robot.spring_torque(&x.q_l, &x.q_m);
        let damping_m = robot.motor_damping.diag_mul(&x.v_m);
        let inertia_m = robot.motor_inertia.diag_mul(&a_m);
        let link = robot.link_torque(x) + nonlinear - needed + external;
        let motor = *u_m - nonlinear - spring - damping_m - inertia_m;
        match &self.rotor_coupling {
            None => [link, motor],
            Some(coupling) => {
                let [of_links, of_motors] = self.coupling_torques(coupling, x, a);
                [link - of_links, motor - of_motors]
            }
        }
    }

    /// Torques that the coupling needs on links and motors [N m]. Compiled once: it is much code in many places.
    #[inline(never)]
    pub(crate) fn coupling_torques<T: Over<C>>(
        &self,
        coupling: &RotorCoupling<C, N>,
        x: &Motion<T, N>,
        [a_l, a_m]: Sides<N, T>,
    ) -> Sides<N, T> {
        let links = &self.robot.links;
        [coupling.link_torque(links, x, &a_m), coupling.motor_torque(links, x, &a_l)]
    }

    /// Accelerations of links and motors [rad/s²] under the motor torque `u_m` [N m]; without friction and hysteresis.
    pub fn accelerations<T: Over<C> + Piecewise>(
        &self,
        x: &Motion<T, N>,
        u_m: &Vector<T, N>,
    ) -> [Vector<T, N>; 2] {
        let robot = &self.robot;
        let inertia = robot.motor_inertia.map(T::constant);
        let [link, motor] = self.unbalanced(x, u_m, [Vector::ZERO; 2]);
        let per_inertia = |torque: Vector<T, N>| Vector::from_fn(|i| torque[i] / inertia[i]);
        match self.coupling_matrix(&x.q_l) {
            None => [robot.links.factor(&x.q_l).solve(&link), per_inertia(motor)],
            Some(S) => {
                let a_l = self.felt_mass(&x.q_l, &S).ldl().solve(&(link - S * per_inertia(motor)));
                [a_l, per_inertia(motor - S.transpose() * a_l)]
            }
        }
    }

    /// Mass that the links feel with motors left to themselves: M_l − S M_m⁻¹ Sᵀ [kg m²].
    fn felt_mass<T: Over<C>>(&self, q_l: &Vector<T, N>, S: &Matrix<T, N, N>) -> Matrix<T, N, N> {
        let mass = self.robot.links.mass_matrix(q_l);
        let inertia = self.robot.motor_inertia.map(T::constant);
        Matrix::from_fn(|k, l| {
            let shared = (0..N).fold(T::ZERO, |sum, i| sum + S[(k, i)] * S[(l, i)] / inertia[i]);
            mass[(k, l)] - shared
        })
    }
}

impl<L: Links<f64, N>, const N: usize> Plant<L, N> {
    /// Whether the mass matrix with the rotors coupled is positive definite at `q_l` in rad: it is not if the rotors
    /// that the gear ratios imply are too heavy for the links that carry them.
    pub fn carries_its_rotors(&self, q_l: &Vector<f64, N>) -> bool {
        self.coupling_matrix(q_l)
            .is_none_or(|S| self.felt_mass(q_l, &S).ldl().pivots().iter().all(|pivot| pivot > 0.0))
    }
}
