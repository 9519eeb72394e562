//! Intervals as sets: construction, lattice, pieces, edges of the domain.

use flexure_core::scalar::{Interval, Piecewise, Scalar};

fn interval(lo: f64, hi: f64) -> Interval {
    Interval::new(lo, hi).unwrap()
}

const INFINITY: f64 = f64::INFINITY;

#[test]
fn construction_refuses_what_is_no_interval() {
    assert_eq!(Interval::new(1.0, 0.0), None);
    assert_eq!(Interval::new(f64::NAN, 0.0), None);
    assert_eq!(Interval::new(0.0, f64::NAN), None);
    assert_eq!(Interval::from_f64(f64::NAN), Interval::ENTIRE);
    assert_eq!((Interval::point(2.0).lo(), Interval::point(2.0).hi()), (2.0, 2.0));
}

#[test]
fn lattice() {
    let (a, b, c) = (interval(-1.0, 2.0), interval(1.0, 4.0), interval(3.0, 5.0));
    assert_eq!(a.hull(c), interval(-1.0, 5.0));
    assert_eq!(a.intersection(b), Some(interval(1.0, 2.0)));
    assert_eq!(a.intersection(c), None);
    assert!(a.hull(b).contains_interval(a) && !a.contains_interval(b));
    assert!(a.contains(2.0) && !a.contains(2.1) && !a.contains(f64::NAN));
    assert_eq!((a.width(), a.midpoint(), a.magnitude()), (3.0, 0.5, 2.0));
}

#[test]
fn halves_meet_and_cover() {
    for x in [
        interval(-1.0, 2.0),
        interval(0.1, 0.1),
        interval(0.0, f64::from_bits(1)),
        interval(-f64::MAX, f64::MAX),
        interval(1.0, INFINITY),
        Interval::ENTIRE,
    ] {
        let (left, right) = x.split();
        assert!(x.midpoint().is_finite());
        assert_eq!(left.hull(right), x);
        assert_eq!((left.hi(), right.lo()), (x.midpoint(), x.midpoint()));
    }
}

#[test]
fn decimals_are_rationals() {
    let tenth = Interval::from_decimal("0.1").unwrap();
    assert!((tenth * Interval::point(10.0)).contains(1.0));
    assert_eq!(tenth.lo().next_up(), tenth.hi());
    // 0.1 as a float is above 1/10.
    assert_eq!(tenth.hi(), 0.1);
    for (text, value) in
        [("3", 3.0), ("-0.5", -0.5), ("+2.50e1", 25.0), ("9007199254740992", 2.0_f64.powi(53)), (".5", 0.5)]
    {
        assert_eq!(Interval::from_decimal(text), Some(Interval::point(value)), "{text}");
    }
    // Rounds to 1 and is not 1.
    let below = Interval::from_decimal("0.99999999999999999999999999").unwrap();
    assert!(below.lo() < 1.0);
    assert_eq!(Interval::from_decimal("1e400").unwrap(), interval(f64::MAX, INFINITY));
    assert!(Interval::from_decimal("-1e-400").unwrap().contains(0.0));
    for text in ["", ".", "-", "inf", "nan", "NaN", "0x10", "1e", "e5", "--1", "1.2.3", "1 "] {
        assert_eq!(Interval::from_decimal(text), None, "{text:?}");
    }
}

#[test]
fn pieces_are_tight() {
    let (x, one, two) = (interval(-3.0, 2.0), Interval::ONE, interval(2.0, 2.5));
    assert_eq!(x.abs(), interval(0.0, 3.0));
    assert_eq!((-two).abs(), two);
    assert_eq!(x.select(one, two), interval(1.0, 2.5));
    assert_eq!((two.select(one, two), (-two).select(one, two)), (one, two));
    assert_eq!((x.max(one), x.min(one)), (interval(1.0, 2.0), interval(-3.0, 1.0)));
    assert_eq!(x.clamp(-one, one), interval(-1.0, 1.0));
    // The boundary belongs to the first piece.
    assert_eq!(Interval::ZERO.select(one, two), one);
}

#[test]
fn squares_know_their_sign() {
    assert_eq!(interval(-3.0, 2.0).square(), interval(0.0, 9.0));
    assert_eq!(interval(-3.0, -2.0).square(), interval(4.0, 9.0));
}

#[test]
fn outside_the_domain_nothing_is_claimed() {
    let negative = interval(-2.0, -1.0);
    for nothing in [negative.sqrt(), negative.ln(), Interval::ZERO.ln(), Interval::ONE / interval(-1.0, 1.0)]
    {
        assert_eq!(nothing, Interval::ENTIRE);
    }
    assert_eq!(Interval::ZERO / Interval::ZERO, Interval::ENTIRE);
    assert_eq!(Interval::ONE / interval(0.0, 1.0), Interval::ENTIRE);
    assert_eq!(interval(-1.0, 4.0).sqrt(), interval(0.0, 2.0));
    assert_eq!(interval(-1.0, 1.0).ln(), interval(-INFINITY, 0.0));
}

/// Every operation on every combination of extreme ends: never NaN, never inside out, contains finite samples.
#[test]
fn extreme_ends_stay_intervals() {
    let tiny = f64::from_bits(1);
    let ends = [
        -INFINITY,
        -f64::MAX,
        -1e300,
        -1.0,
        -tiny,
        -0.0,
        0.0,
        tiny,
        1e-300,
        1.0,
        800.0,
        1e300,
        f64::MAX,
        INFINITY,
    ];
    let all: Vec<Interval> =
        ends.iter().flat_map(|&lo| ends.iter().filter_map(move |&hi| Interval::new(lo, hi))).collect();
    let sound = |x: Interval| assert!(x.lo() <= x.hi(), "{x:?}");
    for &x in &all {
        let (sin, cos) = x.sin_cos();
        let unary = [
            x.sqrt(),
            x.exp(),
            x.ln(),
            sin,
            cos,
            x.tanh(),
            x.ln_cosh(),
            x.atan(),
            x.square(),
            x.recip(),
            x.abs(),
            -x,
        ];
        unary.into_iter().for_each(sound);
        for &y in &all {
            [x + y, x - y, x * y, x / y, x.min(y), x.max(y), x.select(y, x)].into_iter().for_each(sound);
        }
    }
}

#[test]
fn unbounded_times_zero_is_zero() {
    assert_eq!(Interval::ENTIRE * Interval::ZERO, Interval::ZERO);
    assert_eq!(interval(0.0, INFINITY) * interval(0.0, 2.0), interval(0.0, INFINITY));
    assert_eq!(interval(1.0, 2.0) / interval(1.0, INFINITY), interval(0.0, 2.0));
}

#[test]
fn ranges_stay_in_bounds() {
    let unit = interval(-1.0, 1.0);
    assert_eq!(interval(0.0, 7.0).sin_cos(), (unit, unit));
    assert_eq!(Interval::point(1e300).sin(), unit);
    assert_eq!(Interval::ENTIRE.tanh(), unit);
    assert_eq!(Interval::point(800.0).tanh().hi(), 1.0);
    assert!(Interval::point(-800.0).exp().lo() >= 0.0);
    assert_eq!(interval(-2.0, 1.0).ln_cosh(), Interval::point(2.0).ln_cosh().hull(Interval::ZERO));
    // One extreme inside, the other not.
    let arc = interval(1.0, 2.0);
    assert_eq!(arc.sin().hi(), 1.0);
    assert!(arc.sin().lo() > 0.84 && arc.cos().hi() < 0.55);
}
