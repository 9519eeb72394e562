//! Feedback linearisation of the complete model, in which rotors feel the bodies that carry them.

use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// A reconstruction for two joints of the design of De Luca and Lucibello, *A general algorithm for dynamic feedback linearization of robots with elastic
/// joints*, IEEE Int. Conf. Robotics and Automation, 1998: with rotors coupled by S = [[0, s], [0, 0]] static feedback linearises nothing, and four more states
/// make the links two chains of six integrators, (d/dt + λ)⁶ e = 0.
///
/// The robot is M q̈ + S θ̈ + n = K ζ, Sᵀ q̈ + B θ̈ + D_m θ̇ + K ζ = u, ζ = θ − q. Memory ξ: q̈, q⃛, then q⁗ and the fifth derivative of the first joint.
///
/// It needs the reference to order 6, divides by s, and its hidden loop gain is K_1/s: a control period of 0.1 ms is too long for drives of arms, and what a
/// shorter one leaves falls with the period alone. So it is for simulations, and no [`DynamicLaw`](super::DynamicLaw).
#[derive(Clone, Copy, Debug)]
pub struct DynamicFeedbackLinearization<C> {
    /// λ [1/s].
    pub rate: Vector<C, 2>,
    /// s, inertia of the second rotor that the first link turns [kg m²], not 0.
    pub coupling: C,
}

/// What the law makes of a motion and its memory.
#[derive(Clone, Copy, Debug)]
pub struct Planned<T> {
    /// Derivatives of the link positions, 0 to 6, that state and memory decide.
    pub links: [Vector<T, 2>; 7],
    /// Motor torque [N m].
    pub torque: Vector<T, 2>,
    /// ξ̇.
    pub rate: [Vector<T, 2>; 2],
}

/// Coefficients of (s + 1)⁶ but for the first.
const BINOMIAL: [i32; 6] = [1, 6, 15, 20, 15, 6];

impl<C: Scalar> DynamicFeedbackLinearization<C> {
    /// The memory that a robot which moves as `x` starts with: acceleration and jerk of the first joint without coupling, and nothing of what follows.
    #[inline]
    pub fn start<T: Over<C>, L: Links<C, 2>>(
        &self,
        robot: &Fjr<C, L, 2>,
        x: &Motion<T, 2>,
    ) -> [Vector<T, 2>; 2] {
        let [_, _, a, jerk] = robot.link_motion(&robot.links.factor(&x.q_l), x).derivatives();
        [Vector([a[0], jerk[0]]), Vector::ZERO]
    }

    /// The plan at the motion `x` with the memory `xi`; `q_ld` is the reference in rad to order 6. One unknown at a time: each derivative of the second joint enters
    /// its row of M q̈ + n with the slope M_22.
    #[inline]
    pub fn planned<T: Over<C>, L: Links<C, 2>>(
        &self,
        robot: &Fjr<C, L, 2>,
        x: &Motion<T, 2>,
        q_ld: &Vector<Jet<T, 7>, 2>,
        [Vector([xi_2, xi_3]), Vector([xi_4, xi_5])]: &[Vector<T, 2>; 2],
    ) -> Planned<T> {
        let [k_1, k_2] = robot.stiffness.0;
        let [spring, spring_rate] =
            [robot.spring_torque(&x.q_l, &x.q_m), robot.spring_torque(&x.v_l, &x.v_m)];
        let slope = robot.links.mass_matrix(&x.q_l)[(1, 1)];
        let by_coupling = self.coupling.recip();
        // M q̈ + n along the links' motion, with its derivatives to order 4.
        let rows = |q: &[Vector<T, 2>; 7]| -> [Vector<T, 2>; 5] {
            let q = Vector::from_derivatives(q);
            let damped = robot.link_damping.diag_mul(&q.map(|q| q.differentiate::<5>()));
            (robot.links.torque_along::<_, 5, 7>(&q) + damped).derivatives()
        };
        let known = |first: T| Vector([first, T::ZERO]);
        let mut q = [x.q_l, x.v_l, known(*xi_2), known(*xi_3), known(*xi_4), known(*xi_5), Vector::ZERO];

        let [row, ..] = rows(&q);
        q[2][1] = (spring[1] - row[1]) / slope;
        let [row_0, row_1, ..] = rows(&q);
        q[3][1] = (spring_rate[1] - row_1[1]) / slope;
        let theta_2 = (spring[0] - row_0[0]).scale(by_coupling);
        let [_, row_1, row_2, ..] = rows(&q);
        q[4][1] = ((theta_2 - q[2][1]).scale(k_2) - row_2[1]) / slope;
        let theta_3 = (spring_rate[0] - row_1[0]).scale(by_coupling);
        let [.., row_3, _] = rows(&q);
        q[5][1] = ((theta_3 - q[3][1]).scale(k_2) - row_3[1]) / slope;

        q[6] = self.sixth(&q, q_ld);
        let [_, _, row_2, _, row_4] = rows(&q);
        let theta_4 = q[4][1] + row_4[1].scale(k_2.recip());
        let motor_1 = q[2][0] + (row_2[0] + theta_4.scale(self.coupling)).scale(k_1.recip());
        let carried = Vector([T::ZERO, xi_2.scale(self.coupling)]);
        Planned {
            links: q,
            torque: robot.motor_torque(x, &Vector([motor_1, theta_2])) + carried,
            rate: [Vector([*xi_3, *xi_4]), Vector([*xi_5, q[6][0]])],
        }
    }

    /// The sixth derivative of (d/dt + λ)⁶ e = 0.
    #[inline]
    fn sixth<T: Over<C>>(&self, q: &[Vector<T, 2>; 7], q_ld: &Vector<Jet<T, 7>, 2>) -> Vector<T, 2> {
        let wanted = q_ld.derivatives();
        let [.., mut sixth] = wanted;
        let orders = q.iter().zip(&wanted).zip(BINOMIAL).enumerate();
        for (order, ((q, wanted), binomial)) in orders {
            let gain = self
                .rate
                .map(|rate| (order..6).fold(C::from_ratio(binomial, 1), |product, _| product * rate));
            sixth -= gain.diag_mul(&(*q - *wanted));
        }
        sixth
    }
}
