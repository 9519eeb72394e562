//! A control law of one's own against one from the literature, on an arm whose joints bend.

use flexure::core::control::{ControlLaw, MotorPd, Pd};
use flexure::core::model::{Fjr, Links, Motion};
use flexure::core::reference::{PointToPoint, Smoothstep};
use flexure::core::scalar::{Jet, Over, Scalar};
use flexure::core::{linalg::Vector, robots::PlanarTwoLink};
use flexure::simulate::{Controller, Feedback, Simulation, Timing};

/// PD control of the motors that winds the springs up for the torque that the links will need.
struct WindUp<C, const N: usize>(MotorPd<C, N>);

impl<C: Scalar, const N: usize> ControlLaw<C, N> for WindUp<C, N> {
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        // θ_d = q_d + K⁻¹ (M q̈_d + C q̇_d + g + D q̇_d), with its rate: jets know it.
        let speed = q_ld.map(|q| q.differentiate::<3>());
        let spring = robot.links.torque_along::<T, 3, 5>(q_ld) + robot.link_damping.diag_mul(&speed);
        let theta_d = q_ld.map(|q| q.truncate()) + robot.stiffness.map(C::recip).diag_mul(&spring);
        let [position, rate, _] = theta_d.derivatives();
        let needed = spring.map(|u| u.coefficient(0)) + robot.motor_damping.diag_mul(&rate);
        needed + self.0.feedback(&(x.q_m - position), &(x.v_m - rate))
    }
}

/// Largest error of the links in rad on a move of 1 rad in 1 s, at 1 kHz.
fn worst_error(robot: Fjr<f64, PlanarTwoLink<f64>, 2>, law: impl Feedback<PlanarTwoLink<f64>, 2>) -> f64 {
    let (x, to) = (Motion::at_rest(Vector([0.0, 0.0])), Vector([1.0, -1.0]));
    let path = PointToPoint { from: x.q_l, to, start: 0.0, duration: 1.0, step: Smoothstep::Nonic };
    let timing = Timing::sampled(1e-3);
    let mut held = Simulation::new(timing, robot.into(), x, vec![], Controller::ideal(robot, path, law));
    let error = |_| {
        held.step().expect("the loop is stable");
        let now = held.instant().expect("after a step");
        let e_l = now.motion.q_l - now.action.reference.map(|q| q.coefficient(0));
        e_l.iter().fold(0.0, |worst: f64, e| worst.max(e.abs()))
    };
    (0..=1500).map(error).fold(0.0, f64::max)
}

/// A move of both laws on the same arm with the same gains.
pub fn main() {
    let robot = Fjr {
        links: PlanarTwoLink::new([1.51, 0.873], 0.343, [0.159, 0.055], [0.0392, 0.00808]),
        motor_inertia: Vector([0.0635, 0.00302]), // kg m²
        stiffness: Vector([39.96, 6.86]),         // N m/rad
        link_damping: Vector([0.8, 0.55]),        // N m s/rad
        motor_damping: Vector([4.0, 1.5]),        // N m s/rad
    };
    let gains = MotorPd { stiffness: Vector([400.0, 60.0]), damping: Vector([10.0, 1.0]) };
    let of_pd = worst_error(robot, |_, x: &_, q_ld: &_| Pd { motor: gains }.torque(&robot, x, q_ld));
    let of_own = worst_error(robot, |_, x: &_, q_ld: &_| WindUp(gains).torque(&robot, x, q_ld));
    println!("PD {:.1} mrad, with wind-up {:.1} mrad", 1e3 * of_pd, 1e3 * of_own);
    assert!(10.0 * of_own < of_pd);
}
