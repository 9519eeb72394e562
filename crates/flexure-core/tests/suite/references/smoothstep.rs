//! The polynomials that join postures.

use flexure_core::scalar::Jet;

use super::{STEPS, assert_close};

#[test]
fn smoothstep_slope_is_the_bell() {
    // s' = (2m + 1)! / m!² τᵐ (1 − τ)ᵐ: an independent characterisation, with s(0) = 0.
    for (step, scale) in STEPS.into_iter().zip([30.0, 140.0, 630.0]) {
        let m = i32::try_from(step.smoothness()).unwrap();
        for i in 0..=1000 {
            let tau = f64::from(i) / 1000.0;
            let s = step.eval(Jet::<f64, 2>::variable(tau));
            let bell = scale * (tau * (1.0 - tau)).powi(m);
            // Ten operations on intermediate sums up to 30 times the slope: 100 ε × 2.5, the largest slope.
            assert_close(s.derivative(1), bell, 6e-14, &format!("{step:?} at {tau}"));
        }
        assert_eq!(step.eval(0.0), 0.0);
        assert_eq!(step.eval(0.5), 0.5);
    }
}

#[test]
fn smoothstep_is_its_published_polynomial() {
    let published: [&[f64]; 3] =
        [&[10.0, -15.0, 6.0], &[35.0, -84.0, 70.0, -20.0], &[126.0, -420.0, 540.0, -315.0, 70.0]];
    for (step, coefficients) in STEPS.into_iter().zip(published) {
        let jet = step.eval(Jet::<f64, 10>::variable(0.0));
        for k in 0..10 {
            let expected = usize::checked_sub(k, step.smoothness() + 1).and_then(|j| coefficients.get(j));
            // Integers: no rounding.
            assert_eq!(jet.coefficient(k), expected.copied().unwrap_or(0.0), "{step:?}, power {k}");
        }
    }
}

#[test]
fn smoothstep_is_exact_at_its_ends() {
    for step in STEPS {
        let m = step.smoothness();
        for (tau, s) in [(0.0, 0.0), (1.0, 1.0)] {
            let jet = step.eval(Jet::<f64, 6>::variable(tau));
            assert_eq!(jet.derivative(0), s);
            for k in 1..=m {
                assert_eq!(jet.derivative(k), 0.0, "{step:?} at {tau}, derivative {k}");
            }
            assert!(jet.derivative(m + 1).abs() >= 60.0, "{step:?} is smoother than promised");
        }
        for tau in [-3.0, -1e-300, 1.0 + f64::EPSILON, 7.0] {
            let held = if tau < 0.0 { 0.0 } else { 1.0 };
            assert_eq!(step.eval(Jet::<f64, 6>::variable(tau)), Jet::value(held), "{step:?} at {tau}");
        }
    }
}

#[test]
fn smoothstep_is_antisymmetric_and_increasing() {
    for step in STEPS {
        let mut before = 0.0;
        for i in 0..=4096 {
            // Dyadic, so that 1 − τ is exact, and with it the law.
            let tau = f64::from(i) / 4096.0;
            let s = step.eval(tau);
            assert_eq!(s + step.eval(1.0 - tau), 1.0, "{step:?} at {tau}");
            assert!(s >= before, "{step:?} falls at {tau}");
            before = s;
        }
    }
}

#[test]
fn smoothstep_meets_itself_in_the_middle() {
    for step in STEPS {
        let (left, right) = (0.5f64.next_down(), 0.5f64.next_up());
        let (left, right) =
            (step.eval(Jet::<f64, 10>::variable(left)), step.eval(Jet::<f64, 10>::variable(right)));
        for k in 0..10 {
            // Coefficients up to 9e3 at the middle from binomial sums: 100 ε of that.
            assert_close(left.coefficient(k), right.coefficient(k), 2e-10, &format!("{step:?}, power {k}"));
        }
    }
}
