//! Intervals are not wider than they must be.

use flexure_core::scalar::{Interval, Scalar};

use super::oracle::{ENCLOSURES, Random, apply, rows, ulps};

fn steps(x: Interval) -> u64 {
    ulps(x.lo(), x.hi())
}

/// An inexact result lies between two floats, and no narrower interval would contain it. An exact one is a point.
#[test]
fn arithmetic_is_optimal() {
    let mut random = Random(1);
    for _ in 0..100_000 {
        let (x, y) = (random.magnitude(-300, 300), random.magnitude(-300, 300));
        let (xs, ys) = (Interval::point(x), Interval::point(y));
        for z in [xs + ys, xs - ys, xs * ys, xs / ys, xs.square(), ys.recip(), xs.square().sqrt()] {
            // The square widens by a step before its root is taken.
            assert!(steps(z) <= 2, "{x:e} {y:e}: {z:?}");
        }
        assert_eq!((xs + ys) == Interval::point(x + y), (xs + ys).lo() == (xs + ys).hi());
    }
    for (x, y) in [(0.5, 0.25), (3.0, 7.0), (-1e10, 2.0_f64.powi(-70))] {
        let (xs, ys) = (Interval::point(x), Interval::point(y));
        assert_eq!(xs * ys, Interval::point(x * y));
        assert_eq!((xs * ys) / ys, xs);
        assert_eq!((xs * xs).sqrt(), Interval::point(f64::abs(x)));
    }
    let tiny = Interval::point(f64::from_bits(1));
    assert_eq!((Interval::ONE * tiny, tiny / -Interval::ONE), (tiny, -tiny));
}

#[test]
fn sums_that_are_floats_are_points() {
    let mut random = Random(2);
    for _ in 0..10_000 {
        let (x, y) = (random.integer(1 << 20), random.integer(1 << 20) / 1024.0);
        assert_eq!(Interval::point(x) + Interval::point(y), Interval::point(x + y));
        assert_eq!(Interval::point(x) * Interval::point(y), Interval::point(x * y));
    }
}

/// One step each way from the nearest float.
#[test]
fn elementary_functions_at_points() {
    for row in rows::<2>(ENCLOSURES) {
        let allowed = if row.name == "ln_cosh" { LN_COSH } else { 2 };
        let y = apply(row.name, Interval::point(row.x));
        assert!(steps(y) <= allowed, "{} {:e}: {y:?} is {} steps wide", row.name, row.x, steps(y));
    }
}

/// Below 1: sinh 2 steps, squared 4 in relative terms, twice that in steps where the mantissa is small, and log1p's own.
const LN_COSH: u64 = 16;

#[test]
fn log_cosh_is_a_few_steps_wide() {
    let mut random = Random(3);
    let widest = (0..200_000).map(|_| steps(Interval::point(random.magnitude(-20, 9)).ln_cosh())).max();
    assert!(widest <= Some(LN_COSH), "{widest:?}");
}

/// Over an interval, too, the ends of a monotone function's range are values: nothing is lost to dependency.
#[test]
fn monotone_ranges_are_tight() {
    let x = Interval::new(-0.5, 0.75).unwrap();
    for (range, lo, hi) in [
        (x.exp(), core_math::exp(-0.5), core_math::exp(0.75)),
        (x.tanh(), core_math::tanh(-0.5), core_math::tanh(0.75)),
        (x.sin(), core_math::sin(-0.5), core_math::sin(0.75)),
        (x.cos(), core_math::cos(0.75), 1.0),
        (x.atan(), core_math::atan(-0.5), core_math::atan(0.75)),
    ] {
        assert!(ulps(range.lo(), lo) <= 1 && ulps(range.hi(), hi) <= 1, "{range:?}");
    }
}
