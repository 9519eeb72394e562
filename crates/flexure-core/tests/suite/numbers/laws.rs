//! Laws that every number type keeps, written once.

#[cfg(feature = "interval")]
use flexure_core::scalar::Interval;
#[cfg(feature = "lanes")]
use flexure_core::scalar::Lanes;
use flexure_core::scalar::{Dual, Jet, Over, Scalar};

use super::oracle::Random;
use super::probe::Probe;

/// Ring laws. All components are integers below 2²⁴ throughout: equality is exact, also in `f32` and on intervals.
fn is_a_ring<S: Probe>() {
    let mut random = Random(1);
    for _ in 0..200 {
        let [a, b, c] = std::array::from_fn(|_| S::sample(random.integer(8), &mut random));
        assert_eq!(a + b, b + a);
        assert_eq!((a + b) + c, a + (b + c));
        assert_eq!(a * b, b * a);
        assert_eq!((a * b) * c, a * (b * c));
        assert_eq!(a * (b + c), a * b + a * c);
        assert_eq!((a + S::ZERO, a * S::ONE, a * S::ZERO), (a, a, S::ZERO));
        assert_eq!((a - b, a + -a), (a + -b, S::ZERO));
        assert_eq!(a.square(), a * a);
        let mut d = a;
        d += b;
        d *= c;
        d -= a;
        assert_eq!(d, (a + b) * c - a);
    }
}

/// Division undoes multiplication. Divisors are powers of two: integer quotients stay exact in every component.
fn divides<S: Probe>() {
    let mut random = Random(2);
    for _ in 0..200 {
        let a = S::sample(random.integer(8), &mut random);
        let b = S::sample(random.choice([1.0, -1.0, 2.0, 0.5]), &mut random);
        assert_eq!((a * b) / b, a);
        assert_eq!(b.recip() * b, S::ONE);
        assert_eq!(S::from_ratio(-3, 4), S::from_f64(-3.0) / S::from_f64(4.0));
    }
}

/// All operations at once, in the way that physics and laws use them.
fn composite<S: Scalar>(x: S, y: S) -> S {
    let (s, c) = (x * y).sin_cos();
    let hyperbolic = (x - y).tanh() * y.ln_cosh();
    let roots = (S::ONE + x.square()).sqrt() / (S::from_ratio(3, 2) + s);
    (roots + hyperbolic * c - (-x.square()).exp()).atan() + (S::ONE + y.square()).ln() * x.recip() - s
}

/// Constants map to constants: whatever `f64` computes, the type computes, with all derivatives zero.
fn extends_f64<S: Probe>(steps: f64) {
    for (x, y) in [(0.5, -2.0), (1.25, 3.0), (-4.0, 0.125), (0.0625, -0.75)] {
        let exact = composite(x, y);
        let here = composite(S::from_f64(x), S::from_f64(y));
        assert!(here.agrees(exact, steps), "{here:?} is not {exact} at ({x}, {y})");
    }
}

/// `constant` and `scale` are the embedding and the product.
fn is_over<C: Scalar, S: Probe + Over<C>>() {
    let mut random = Random(3);
    for _ in 0..50 {
        let (a, c) = (S::sample(random.integer(8), &mut random), C::from_f64(random.integer(8)));
        assert_eq!(a.scale(c), a * S::constant(c));
        assert_eq!(S::constant(c) + S::constant(C::ONE), S::constant(c + C::ONE));
    }
}

/// Every law on every type named.
macro_rules! laws {
    ($($name:ident: $t:ty, over $c:ty, $steps:expr;)*) => {$(
        #[test]
        fn $name() {
            is_a_ring::<$t>();
            divides::<$t>();
            extends_f64::<$t>($steps);
            is_over::<$c, $t>();
        }
    )*};
}

// Jets and duals over f64 run the very same operations on the values: no tolerance.
const SAME: f64 = 0.0;
// f32: about 20 roundings, of which sin of an argument near 4 and the last difference magnify a few.
const SINGLE: f64 = 40.0;

laws! {
    float64: f64, over f64, SAME;
    float32: f32, over f32, SINGLE;
    jets: Jet<f64, 4>, over f64, SAME;
    jets_of_order_zero: Jet<f64, 1>, over f64, SAME;
    duals: Dual<f64, 3>, over f64, SAME;
    jets_of_duals: Jet<Dual<f64, 2>, 3>, over f64, SAME;
    duals_of_jets: Dual<Jet<f64, 3>, 2>, over f64, SAME;
    jets_of_jets: Jet<Jet<f64, 2>, 3>, over f64, SAME;
    single_jets: Jet<f32, 3>, over f32, SINGLE;
}

// The composite magnifies the few ulp of each enclosure by its slopes, here below 20.
#[cfg(feature = "interval")]
const ENCLOSED: f64 = 100.0;

#[cfg(feature = "interval")]
laws! {
    intervals: Interval, over Interval, ENCLOSED;
    jets_of_intervals: Jet<Interval, 3>, over Interval, ENCLOSED;
    duals_of_jets_of_intervals: Dual<Jet<Interval, 2>, 2>, over Interval, ENCLOSED;
}

// A dozen elementary functions, each within 5 ulp of libm's.
#[cfg(feature = "lanes")]
const BATCH: f64 = 60.0;

#[cfg(feature = "lanes")]
laws! {
    lanes_f64_2: Lanes<f64, 2>, over f64, BATCH;
    lanes_f64_4: Lanes<f64, 4>, over f64, BATCH;
    lanes_f64_8: Lanes<f64, 8>, over f64, BATCH;
    lanes_f32_4: Lanes<f32, 4>, over f32, BATCH;
    lanes_f32_8: Lanes<f32, 8>, over f32, BATCH;
    jets_of_lanes: Jet<Lanes<f64, 4>, 3>, over f64, BATCH;
    duals_of_jets_of_lanes: Dual<Jet<Lanes<f64, 2>, 2>, 2>, over f64, BATCH;
}
