//! What is simulated: the robot as the law knows it, and what the law does not know of it.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links, MassFactor, Motion, Power, RotorCoupling};

/// A robot with what its model leaves out. The law is built on [`robot`](Self::robot) alone.
#[derive(Clone, Copy, Debug)]
pub struct Plant<L, const N: usize> {
    /// The reduced model with linear springs.
    pub robot: Fjr<f64, L, N>,
    /// k ≥ 0 in the spring torque K ζ + k ζ³ [N m/rad³].
    pub spring_hardening: Vector<f64, N>,
    /// Inertial coupling of the rotors; without it they only spin about their own axes.
    pub rotor_coupling: Option<RotorCoupling<f64, N>>,
}

/// One vector for the links and one for the motors.
pub(super) type Sides<const N: usize> = [Vector<f64, N>; 2];

impl<L, const N: usize> From<Fjr<f64, L, N>> for Plant<L, N> {
    /// The plant that is as its model.
    fn from(robot: Fjr<f64, L, N>) -> Self {
        Self { robot, spring_hardening: Vector::ZERO, rotor_coupling: None }
    }
}

impl<L: Links<f64, N>, const N: usize> Plant<L, N> {
    /// Torque K ζ + k ζ³ of the springs on the links [N m]; the motors feel its opposite.
    pub fn spring_torque(&self, x: &Motion<f64, N>) -> Vector<f64, N> {
        self.robot.spring_torque(&x.q_l, &x.q_m) + self.hardening_torque(x)
    }

    fn hardening_torque(&self, x: &Motion<f64, N>) -> Vector<f64, N> {
        let zeta = x.deflection();
        Vector::from_fn(|i| self.spring_hardening[i] * zeta[i] * zeta[i] * zeta[i])
    }

    /// Slope K + 3 k ζ² of the spring torque [N m/rad].
    pub(super) fn tangent_stiffness(&self, x: &Motion<f64, N>) -> Vector<f64, N> {
        let zeta = x.deflection();
        Vector::from_fn(|i| self.robot.stiffness[i] + 3.0 * self.spring_hardening[i] * zeta[i] * zeta[i])
    }

    /// Deflection in rad at which the springs give `torque` [N m].
    pub fn deflection_under(&self, torque: &Vector<f64, N>) -> Vector<f64, N> {
        Vector::from_fn(|i| {
            let (stiffness, hardening) = (self.robot.stiffness[i], self.spring_hardening[i]);
            // Newton's iteration from beyond the root of a function that is convex there: monotone.
            (0..100).fold(torque[i] / stiffness, |zeta, _| {
                let square = hardening * zeta * zeta;
                zeta - ((stiffness + square) * zeta - torque[i]) / (stiffness + 3.0 * square)
            })
        })
    }

    /// Total energy in J.
    pub fn total_energy(&self, x: &Motion<f64, N>) -> f64 {
        let hardening = 0.25 * self.hardening_torque(x).dot(&x.deflection());
        let coupling = self.rotor_coupling.map_or(0.0, |coupling| coupling.energy(&self.robot.links, x));
        self.robot.total_energy(x) + hardening + coupling
    }

    /// The power that flows in through the motors and out through the dampers.
    pub fn power(&self, x: &Motion<f64, N>, u_m: &Vector<f64, N>) -> Power<f64> {
        self.robot.power(x, u_m)
    }

    /// S(q_l) of the rotor coupling [kg m²], if there is any.
    pub(super) fn coupling_matrix(&self, q_l: &Vector<f64, N>) -> Option<Matrix<f64, N, N>> {
        self.rotor_coupling.map(|coupling| coupling.matrix(&self.robot.links, q_l))
    }

    /// Torques on links and motors that the accelerations `a` leave unbalanced under the motor torque `u_m` [N m].
    #[inline]
    pub(super) fn unbalanced(&self, x: &Motion<f64, N>, u_m: &Vector<f64, N>, a: Sides<N>) -> Sides<N> {
        let (robot, [a_l, a_m]) = (&self.robot, a);
        let hardening = self.hardening_torque(x);
        let needed = robot.links.inverse_dynamics(&x.q_l, &x.v_l, &x.v_l, &a_l);
        let spring = robot.spring_torque(&x.q_l, &x.q_m);
        let damping_m = robot.motor_damping.diag_mul(&x.v_m);
        let inertia_m = robot.motor_inertia.diag_mul(&a_m);
        let link = robot.link_torque(x) + hardening - needed;
        let motor = *u_m - hardening - spring - damping_m - inertia_m;
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
    fn coupling_torques(
        &self,
        coupling: &RotorCoupling<f64, N>,
        x: &Motion<f64, N>,
        [a_l, a_m]: Sides<N>,
    ) -> Sides<N> {
        let links = &self.robot.links;
        [coupling.link_torque(links, x, &a_m), coupling.motor_torque(links, x, &a_l)]
    }

    /// Accelerations of links and motors [rad/s²] under the motor torque `u_m` [N m].
    pub fn accelerations(&self, x: &Motion<f64, N>, u_m: &Vector<f64, N>) -> [Vector<f64, N>; 2] {
        let robot = &self.robot;
        let [link, motor] = self.unbalanced(x, u_m, [Vector::ZERO; 2]);
        let per_inertia = |torque: Vector<f64, N>| Vector::from_fn(|i| torque[i] / robot.motor_inertia[i]);
        match self.coupling_matrix(&x.q_l) {
            None => [robot.links.factor(&x.q_l).solve(&link), per_inertia(motor)],
            Some(S) => {
                let a_l = self.felt_mass(&x.q_l, &S).ldl().solve(&(link - S * per_inertia(motor)));
                [a_l, per_inertia(motor - S.transpose() * a_l)]
            }
        }
    }

    /// Whether the mass matrix with the rotors coupled is positive definite at `q_l` in rad: it is not if the rotors
    /// that the gear ratios imply are too heavy for the links that carry them.
    pub fn carries_its_rotors(&self, q_l: &Vector<f64, N>) -> bool {
        self.coupling_matrix(q_l)
            .is_none_or(|S| self.felt_mass(q_l, &S).ldl().pivots().iter().all(|pivot| pivot > 0.0))
    }

    /// Mass that the links feel with motors left to themselves: M_l − S M_m⁻¹ Sᵀ [kg m²].
    fn felt_mass(&self, q_l: &Vector<f64, N>, S: &Matrix<f64, N, N>) -> Matrix<f64, N, N> {
        let mass = self.robot.links.mass_matrix(q_l);
        Matrix::from_fn(|k, l| {
            let shared: f64 = (0..N).map(|i| S[(k, i)] * S[(l, i)] / self.robot.motor_inertia[i]).sum();
            mass[(k, l)] - shared
        })
    }
}
