//! The exact slopes of a whole control law, from dual numbers: no step width to choose, no digits lost.

use flexure::core::control::{Input, LinkGains, Metric, MotorGains, Tanh, Vcbc};
use flexure::core::linalg::Vector;
use flexure::core::model::{Fjr, Motion};
use flexure::core::reference::{Reference, Sine};
use flexure::core::robots::PlanarTwoLink;
use flexure::core::scalar::{Dual, Jet};

/// Slopes of the motor torques over motor positions, exactly and by difference quotients.
pub fn main() {
    let robot = Fjr {
        // Masses in kg, first length and centres of mass in m, inertias in kg m².
        links: PlanarTwoLink::new([1.51, 0.873], 0.343, [0.159, 0.055], [0.0392, 0.00808]),
        motor_inertia: Vector([0.23, 0.01]), // kg m²
        stiffness: Vector([9.0, 4.0]),       // N m/rad
        link_damping: Vector([0.8, 0.55]),   // N m s/rad
        motor_damping: Vector([0.2, 90.0]),  // N m s/rad
    };
    let (link, motor) = (Vector([55.0, 30.0]), Vector([70.0, 60.0]));
    let law = Vcbc {
        link: LinkGains {
            metric: Metric::Constant(link),
            shaping: Tanh { gain: link },
            damping: Vector([15.0, 10.0]),
        },
        motor: MotorGains { metric: motor, shaping: Tanh { gain: motor }, damping: Vector([10.0, 5.0]) },
    };
    let sine = Sine { amplitude: Vector([1.0; 2]), frequency: Vector([1.0; 2]), ..Sine::ZERO };
    let q_ld = sine.at::<5>(0.5);
    let x = Motion::at_rest(Vector([0.4, 0.5]));

    // Motor positions as variables: the torque comes with its slopes.
    let mut dual = x.lift::<Dual<f64, 2>>();
    dual.q_m = Vector::from_fn(|i| Dual::variable(x.q_m[i], i));
    let fixed = q_ld.map(|jet| Jet::from_fn(|k| Dual::constant(jet.coefficient(k))));
    let exact = law.command(&robot, &dual, &fixed, &Input::ZERO).u_m;

    // The same by differences, with ever smaller steps.
    let torque = |q_m| law.command(&robot, &Motion { q_m, ..x }, &q_ld, &Input::ZERO).u_m;
    let mut best = f64::INFINITY;
    for digits in 1..=12 {
        let h = 10.0_f64.powi(-digits);
        let mut worst = 0.0_f64;
        for j in 0..2 {
            let step = Vector::from_fn(|i| if i == j { h } else { 0.0 });
            let quotient = (torque(x.q_m + step) - torque(x.q_m - step)).scaled(0.5 / h);
            let errors = (0..2).map(|i| (quotient[i] / exact[i].gradient[j] - 1.0).abs());
            worst = errors.fold(worst, f64::max);
        }
        println!("step 1e-{digits:02} rad: off by {worst:.1e}");
        best = best.min(worst);
    }
    println!("slopes {:?} N m/rad", exact.map(|u| u.gradient).0);
    assert!(best < 1e-8, "differences agree with the exact slopes as far as they can: {best:e}");
}
