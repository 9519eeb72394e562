//! Torques that no model knows.

use flexure_core::control::{
    Applied, DisturbanceRejecting, DynamicLaw, Linear, LinkGains, LoadedLaw, Metric, MotorGains, Running,
    Vcbc,
};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::{Jet, Over};

use crate::all::immersion;
use crate::common::plant::{Arm, Push, advance, plausible_arm};
use crate::common::{Numbers, branched, close, flexible, gains, linear, planar, serial};

/// Links that bear a constant torque which is in the model: P − dᵀ q.
struct Loaded<L, const N: usize> {
    links: L,
    load: Vector<f64, N>,
}

impl<L: Links<f64, N>, const N: usize> Links<f64, N> for Loaded<L, N> {
    type Factor<'a, T: Over<f64>>
        = L::Factor<'a, T>
    where
        L: 'a;

    fn mass_matrix<T: Over<f64>>(&self, q: &Vector<T, N>) -> Matrix<T, N, N> {
        self.links.mass_matrix(q)
    }

    fn potential_energy<T: Over<f64>>(&self, q: &Vector<T, N>) -> T {
        self.links.potential_energy(q) - q.dot(&self.load.map(T::constant))
    }

    fn factor<T: Over<f64>>(&self, q: &Vector<T, N>) -> L::Factor<'_, T> {
        self.links.factor(q)
    }

    fn carrier_rates<T: Over<f64>>(&self, q: &Vector<T, N>, v: &Vector<T, N>) -> Vector<T, N> {
        self.links.carrier_rates(q, v)
    }
}

/// A law that counts on a load is the law for a robot whose model has it. Accelerations and two derivatives of Coriolis torques come to the same in other ways:
/// 1e-10 of the torques.
fn counts_on_it<L: Links<f64, N>, const N: usize>(
    law: &impl LoadedLaw<f64, N>,
    links: fn() -> L,
    r: &mut Numbers,
) {
    let (robot, x, q_ld, load) = (flexible(links(), r), r.motion(1.0), r.series(1.0), r.vector(2.0));
    let Fjr { motor_inertia, stiffness, link_damping, motor_damping, .. } = robot;
    let links = Loaded { links: links(), load };
    let loaded = Fjr { links, motor_inertia, stiffness, link_damping, motor_damping };
    let (found, expected) = (law.torque_under(&robot, &x, &q_ld, &load), law.torque(&loaded, &x, &q_ld));
    close(&found, &expected, 1e-10);
    assert!((found - law.torque(&robot, &x, &q_ld)).iter().any(|u| u.abs() > 1e-2));
}

#[test]
fn are_counted_on_as_if_the_model_had_them() {
    let r = &mut Numbers(7);
    for _ in 0..10 {
        counts_on_it(&immersion(r), planar, r);
        counts_on_it(&gains::<_, 2>(linear, false, r), planar, r);
        counts_on_it(&immersion(r), || branched::<5>(2), r);
        counts_on_it(&gains::<_, 5>(linear, false, r), || branched::<5>(2), r);
        counts_on_it(&immersion(r), serial::<7>, r);
        counts_on_it(&gains::<_, 7>(linear, false, r), serial::<7>, r);
    }
}

#[test]
fn leave_no_error() {
    leaves_none(immersion(&mut Numbers(3)));
    // The gains of the built-in scenario `two-link-hardware`.
    let shaping = |rate: f64| Linear { gain: Vector([rate; 2]) };
    leaves_none(Vcbc {
        link: LinkGains {
            metric: Metric::Constant(Vector([1.9, 0.11])),
            shaping: shaping(8.0),
            damping: Vector([0.21, 0.011]),
        },
        motor: MotorGains {
            metric: Vector([63.5, 3.0]),
            shaping: shaping(3.0),
            damping: Vector([0.0635, 0.003]),
        },
    });
}

/// A constant torque on the links, which no motor reaches at once, and one on the motors leave no error at rest; without the residuals they do.
fn leaves_none(inner: impl LoadedLaw<f64, 2> + Copy) {
    let robot: Arm = plausible_arm();
    let push = Push { link: Vector([0.5, -0.2]), motor: Vector([0.3, 0.1]) };
    let (goal, period) = (Vector([0.5, -0.4]), 1e-3);
    let q_ld = goal.map(Jet::value);
    let off = |x: &Motion<f64, 2>| (x.q_l - goal).iter().map(f64::abs).sum::<f64>();

    let law = DisturbanceRejecting { law: inner, bandwidth: Vector([20.0; 2]) };
    let mut x = Motion::at_rest(Vector::ZERO);
    let mut running = Running::start(&law, &robot, &x, &q_ld);
    let mut applied = Applied::NOTHING;
    for k in 0..8000 {
        if k > 0 {
            running.advance(&law, &robot, &x, &q_ld, &applied, period);
        }
        applied = Applied::fully(law.torque(&robot, &x, &q_ld, &running.memory));
        x = advance(&robot, &x, &applied.given, &push, period, 10);
    }
    assert!(off(&x) < 1e-6, "{}", off(&x));

    let mut x = Motion::at_rest(Vector::ZERO);
    for _ in 0..8000 {
        x = advance(&robot, &x, &inner.torque(&robot, &x, &q_ld), &push, period, 10);
    }
    assert!(off(&x) > 1e-3, "{}", off(&x));
}
