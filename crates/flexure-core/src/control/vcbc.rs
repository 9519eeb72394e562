//! The v-CBC law for flexible-joint robots.

use super::{LinkGains, LinkTorque, MotorGains, Shaping};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// The virtual-contraction law (Π, K_d, φ). Paper, proposition fullstatecontroller-flexible and eq. control-flexible.
///
/// It takes positions, velocities and a reference with four derivatives. Accelerations and jerks of the links follow
/// from the model; those of the motors, and the torque itself, are never needed: u̇_l and ü_l depend on q̈_l and
/// q⃛_l, and q⃛_l on q̇_m but not on q̈_m.
///
/// ```
/// use flexure_core::control::{Input, LinkGains, Metric, MotorGains, Tanh, Vcbc};
/// use flexure_core::linalg::Vector;
/// use flexure_core::model::{Fjr, Motion};
/// use flexure_core::reference::{Reference, Sine};
/// use flexure_core::robots::Pendulum;
///
/// let one = |x: f64| Vector([x]);
/// let links = Pendulum { inertia: 0.5, weight_moment: 10.0 };
/// let (motor_inertia, stiffness) = (one(0.1), one(100.0));
/// let robot = Fjr { links, motor_inertia, stiffness, link_damping: one(0.2), motor_damping: one(0.3) };
/// let shaping = Tanh { gain: one(10.0) };
/// let law = Vcbc {
///     link: LinkGains { metric: Metric::Constant(one(40.0)), shaping, damping: one(5.0) },
///     motor: MotorGains { metric: one(60.0), shaping, damping: one(3.0) },
/// };
///
/// // Where the robot is on the reference, the law asks for what keeps it there, and nothing else.
/// let q_ld = Sine { amplitude: one(0.5), frequency: one(2.0), ..Sine::ZERO }.at::<5>(0.7);
/// let nominal = robot.inverse_dynamics::<_, 1, 3, 5>(&q_ld);
/// let ([q_l, v_l, ..], [q_m, v_m, _]) = (q_ld.derivatives(), nominal.q_m.derivatives());
/// let command = law.command(&robot, &Motion { q_l, q_m, v_l, v_m }, &q_ld, &Input::ZERO);
/// let [u_d] = nominal.u_m.derivatives();
/// assert!((command.u_m[0] - u_d[0]).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Vcbc<C, Pl, Pm, const N: usize> {
    /// Gains of the link side.
    pub link: LinkGains<C, Pl, N>,
    /// Gains of the motor side.
    pub motor: MotorGains<C, Pm, N>,
}

/// External input ω = (ω_l, ω_m) of the differentially passive port.
///
/// u_l contains ω_l and is differentiated twice, so ω_l comes with two derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Input<T, const N: usize> {
    /// ω_l and its first two time derivatives [N m].
    pub link: Vector<Jet<T, 3>, N>,
    /// ω_m, added to the motor torque [N m].
    pub motor: Vector<T, N>,
}

impl<T: Scalar, const N: usize> Input<T, N> {
    /// No external input.
    pub const ZERO: Self = Self { link: Vector::ZERO, motor: Vector::ZERO };
}

/// What the law asks of the motors, and its errors on the way.
#[derive(Clone, Copy, Debug)]
pub struct Command<T, const N: usize> {
    /// Motor torque [N m].
    pub u_m: Vector<T, N>,
    /// Torque that the springs should put on the links [N m].
    pub u_l: Vector<T, N>,
    /// Motor position that would do so, q_md = q_l + K⁻¹ u_l in rad.
    pub q_md: Vector<T, N>,
    /// Link position error q̃_l in rad.
    pub e_l: Vector<T, N>,
    /// Motor position error q̃_m in rad.
    pub e_m: Vector<T, N>,
    /// Link velocity error M_l⁻¹ σ_l [rad/s].
    pub s_l: Vector<T, N>,
    /// Motor velocity error M_m⁻¹ σ_m [rad/s].
    pub s_m: Vector<T, N>,
}

impl<C: Scalar, Pl: Shaping<C, N>, Pm: Shaping<C, N>, const N: usize> Vcbc<C, Pl, Pm, N> {
    /// The motor torque for the robot at `x`, following `q_ld`, the reference in rad to order 4.
    #[inline]
    pub fn command<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        omega: &Input<T, N>,
    ) -> Command<T, N> {
        self.command_under(robot, x, q_ld, omega, &Vector::ZERO)
    }

    /// [`command`](Self::command) of a robot whose links bear the constant torque `load` [N m] besides: accelerations are those under it, and the springs are to
    /// carry its opposite.
    #[inline]
    pub fn command_under<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        omega: &Input<T, N>,
        load: &Vector<T, N>,
    ) -> Command<T, N> {
        let links = &robot.links;
        let factor = links.factor(&x.q_l);
        let motion = robot.link_motion_under(&factor, x, load);
        let (q, v) = (motion.map(|x| x.truncate::<3>()), motion.map(|x| x.differentiate::<3>()));
        let link = self.link.torque(&robot.link_damping, &motion, q_ld, |v_r, a_r| {
            links.reference_torque(&factor, &q, &v, v_r, a_r) - load.map(Jet::value)
        });
        self.motor_side(robot, x, &q, link, omega)
    }

    /// The law of the virtual system: the virtual state `x_v` is controlled, mass, Coriolis and damping matrices are
    /// those of the real motion `x`. On `x_v = x` it is [`command`](Self::command). Paper, eq. controlaw-motor.
    #[inline]
    pub fn virtual_command<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x_v: &Motion<T, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        omega: &Input<T, N>,
    ) -> Command<T, N> {
        let links = &robot.links;
        let factor = links.factor(&x.q_l);
        let real = robot.link_motion(&factor, x);
        let (q, v) = (real.map(|x| x.truncate::<3>()), real.map(|x| x.differentiate::<3>()));
        let (q2, v2) = (q.map(|x| x.truncate::<2>()), v.map(|x| x.truncate::<2>()));

        // M(q) a_v = K ζ_v − D_l v_v − C(q, v) v_v − g(q_v).
        let bias =
            links.inertial_torque(&x.q_l, &x.v_l, &x_v.v_l, &Vector::ZERO) + links.gravity_torque(&x_v.q_l);
        let virtual_motion = robot.link_motion_with(&factor, x_v, &bias, |a_v| {
            let (q_v, v_v) = (x_v.q_l.with_rate(&x_v.v_l), x_v.v_l.with_rate(a_v));
            links.inertial_torque(&q2, &v2, &v_v, &a_v.map(Jet::value)) + links.gravity_torque(&q_v)
        });
        let q_v = virtual_motion.map(|x| x.truncate::<3>());
        let link = self.link.torque(&robot.link_damping, &virtual_motion, q_ld, |v_r, a_r| {
            links.inertial_torque(&q, &v, v_r, a_r) + links.gravity_torque(&q_v)
        });
        self.motor_side(robot, x_v, &q_v, link, omega)
    }

    /// From the link part to the motor torque. Paper, eq. auxiliarreference-motor and controlaw-motor1, with
    /// v̄_mr = −Π_m⁻¹ Kᵀ M_l⁻¹ σ_l. `q` is the (virtual) link position along the motion.
    #[inline]
    fn motor_side<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q: &Vector<Jet<T, 3>, N>,
        link: LinkTorque<T, N, 3>,
        omega: &Input<T, N>,
    ) -> Command<T, N> {
        let gains = &self.motor;
        let u_l = link.torque + omega.link;
        let s_l = link.velocity_error.map(|x| x.truncate::<2>());
        let q_md = *q + robot.stiffness.map(C::recip).diag_mul(&u_l);

        // Only q_m and q̇_m are known: the motor errors are series of two coefficients.
        let e_m = x.q_m.with_rate(&x.v_m) - q_md.map(|x| x.truncate::<2>());
        let coupling = Vector::from_fn(|i| s_l[i].scale(robot.stiffness[i] / gains.metric[i]));
        let v_mr = q_md.map(|x| x.differentiate::<2>()) - gains.shaping.eval(&e_m) - coupling;

        let a_mr = v_mr.map(|x| x.coefficient(1));
        let (v_mr, e_m, s_l) = (value(&v_mr), value(&e_m), value(&s_l));
        let s_m = x.v_m - v_mr;
        let u_m = robot.motor_inertia.diag_mul(&a_mr)
            + robot.spring_torque(&x.q_l, &x.q_m)
            + robot.motor_damping.diag_mul(&v_mr)
            - gains.metric.diag_mul(&e_m)
            - gains.damping.diag_mul(&s_m)
            + omega.motor;
        Command { u_m, u_l: value(&u_l), q_md: value(&q_md), e_l: value(&link.error), e_m, s_l, s_m }
    }
}

/// Order 0 of every entry.
#[inline]
fn value<T: Scalar, const N: usize, const K: usize>(x: &Vector<Jet<T, K>, N>) -> Vector<T, N> {
    x.map(|jet| jet.coefficient(0))
}
