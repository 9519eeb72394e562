//! Lanes that the integrator has done again.

use flexure_core::linalg::Vector;
use flexure_core::scalar::Lanes;

use super::robots::{Kind, OneLink};
use super::{EFFORT, PERIOD, TOLERANCE, redone, together};
use crate::plant::Plant;
use crate::simulate::gauss::Integrator;
use crate::simulate::strides::{Strides, taken};

/// What the integrator's last step leads on to is what the stride would have led on to, as far as it is the same polynomial.
fn leads_on<const S: usize>(step: f64, close: f64) {
    let plants = [0, 2].map(OneLink::plant);
    let plant = Plant::together(OneLink::links([0, 2]), plants.each_ref()).expect("smooth");
    let mut strides = Strides::<S, 1, 2>::new(TOLERANCE, EFFORT);
    let mut integrator = Integrator::new(TOLERANCE);
    let mut x = together([0, 2].map(OneLink::start));
    for k in 0..20 {
        let u = Vector([0.2 * (0.05 * f64::from(k)).sin()]);
        let strode = strides.advance(&plant, &x, &u.map(Lanes::splat), PERIOD);
        let own = strides.past;
        integrator.step = step;
        redone(&mut strides, 0, &mut integrator, &plants[0], taken(&x, 0), u);
        for (own, found) in [(own.link, strides.past.link), (own.motor, strides.past.motor)] {
            for (own, found) in own.iter().zip(&found) {
                let [[own, other], [found, untouched]] = [own, found].map(|v| v[0].to_array());
                assert!((found - own).abs() < close * (own.abs() + 1.0), "{step}, period {k}: {found} {own}");
                assert!(other.to_bits() == untouched.to_bits());
            }
        }
        x = strode.end;
    }
    strides.forget(0);
    let [of_lane, other] = strides.past.link[0][0].to_array();
    assert!(of_lane == 0.0 && other != 0.0);
}

#[test]
fn a_lane_that_was_done_again_leads_on() {
    leads_on::<2>(1.0, 1e-3);
    leads_on::<4>(1.0, 1e-3);
    leads_on::<2>(6e-4, 2e-3);
    // Too short to lead on: nothing is known.
    let mut strides = Strides::<2, 1, 2>::new(TOLERANCE, EFFORT);
    let plants = [0, 2].map(OneLink::plant);
    let plant = Plant::together(OneLink::links([0, 2]), plants.each_ref()).expect("smooth");
    let x = together([0, 2].map(OneLink::start));
    strides.advance(&plant, &x, &Vector::ZERO, PERIOD);
    let mut integrator = Integrator { step: 1e-4, ..Integrator::new(1e-16) };
    redone(&mut strides, 0, &mut integrator, &plants[0], taken(&x, 0), Vector::ZERO);
    assert!(strides.past.link[0][0].to_array()[0] == 0.0);
}
