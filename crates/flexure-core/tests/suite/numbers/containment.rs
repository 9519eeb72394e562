//! Containment: for x in X and y in Y, the exact `x op y` lies in `X op Y`. A million random points an operation.
//!
//! "Exact" is decided without rounding: a fused multiply-add has the sign of the exact `a b − c`, and core-math returns
//! the float nearest to the exact value. None of this shares code with the interval type.

use flexure_core::scalar::{Interval, Scalar};

use super::oracle::{ENCLOSURES, Random, apply, rows};

const POINTS: usize = 1_000_000;

/// Whether `a b ≤ c` exactly. A fused result underflows to a zero of the right sign.
fn product_at_most(a: f64, b: f64, c: f64) -> bool {
    if a == 0.0 || b == 0.0 {
        return c >= 0.0;
    }
    let difference = a.mul_add(b, -c);
    // ±∞ − ±∞: an unbounded end, which holds.
    difference.is_nan()
        || difference < 0.0
        || (difference == 0.0 && (difference.is_sign_negative() || exactly(a, b, c)))
}

/// Whether `a b = c`, for results that a fused multiply-add cannot tell from an underflow: scaled away from it.
fn exactly(a: f64, b: f64, c: f64) -> bool {
    let scale = |x: f64| if x.abs() < 1.0 { (x * 2.0_f64.powi(540), 1) } else { (x, 0) };
    let ((a, i), (b, j)) = (scale(a), scale(b));
    let mut c = c;
    for _ in 0..i + j {
        c *= 2.0_f64.powi(540);
    }
    a.mul_add(b, -c) == 0.0
}

fn product_inside(a: f64, b: f64, bounds: Interval) -> bool {
    product_at_most(-a, b, -bounds.lo()) && product_at_most(a, b, bounds.hi())
}

/// An interval (a point every other time) and a number inside, at an end every other time.
fn draw(random: &mut Random, low: i32, high: i32) -> (Interval, f64) {
    let a = random.magnitude(low, high);
    let b = match random.bits() % 4 {
        0 => random.magnitude(low, high),
        1 => a * (1.0 + 1e-3 * random.unit()),
        _ => a,
    };
    let interval = Interval::new(a.min(b), a.max(b)).unwrap();
    let x = match random.bits() % 4 {
        0 => random.uniform(a, b).clamp(a.min(b), a.max(b)),
        1 => b,
        _ => a,
    };
    (interval, x)
}

/// Runs a check on a million draws, over ordinary and over extreme magnitudes.
fn sweep(seed: u64, check: impl Fn(&mut Random, i32, i32)) {
    let mut random = Random(seed);
    for i in 0..POINTS {
        let (low, high) = [(-4, 5), (-40, 40), (-1022, 1023)][i % 3];
        check(&mut random, low, high);
    }
}

#[test]
fn sums() {
    sweep(1, |random, low, high| {
        let ((xs, x), (ys, y)) = (draw(random, low, high), draw(random, low, high));
        for (bounds, y) in [(xs + ys, y), (xs - ys, -y)] {
            // TwoSum by the larger number first: s + e is the exact sum.
            let (a, b) = if x.abs() >= y.abs() { (x, y) } else { (y, x) };
            let s = a + b;
            let e = if s.is_finite() { b - (s - a) } else { -s.signum() };
            let above = bounds.lo() < s || (bounds.lo() == s && e >= 0.0);
            let below = s < bounds.hi() || (bounds.hi() == s && (e <= 0.0 || s.is_infinite()));
            assert!(above && below, "{x:e} + {y:e} not in {bounds:?}");
        }
    });
}

#[test]
fn products() {
    sweep(2, |random, low, high| {
        let ((xs, x), (ys, y)) = (draw(random, low, high), draw(random, low, high));
        assert!(product_inside(x, y, xs * ys), "{x:e} · {y:e} not in {:?}", xs * ys);
        assert!(product_inside(x, x, xs.square()), "{x:e}² not in {:?}", xs.square());
        assert!((xs * xs).contains_interval(xs.square()));
    });
}

/// `lo ≤ x / y ≤ hi` multiplied by y.
#[test]
fn quotients() {
    sweep(3, |random, low, high| {
        let ((xs, x), (ys, y)) = (draw(random, low, high), draw(random, low, high));
        let bounds = xs / ys;
        let (x, y) = (x * y.signum(), y.abs());
        assert!(
            product_at_most(bounds.lo(), y, x) && product_at_most(-bounds.hi(), y, -x),
            "{x:e} / {y:e} not in {bounds:?}"
        );
    });
}

/// `lo² ≤ x ≤ hi²`.
#[test]
fn square_roots() {
    sweep(4, |random, low, high| {
        let (xs, x) = draw(random, low, high);
        if x >= 0.0 {
            let bounds = xs.sqrt();
            let inside = product_at_most(bounds.lo(), bounds.lo(), x)
                && product_at_most(-bounds.hi(), bounds.hi(), -x);
            assert!(inside, "√{x:e} not in {bounds:?}");
        }
    });
}

/// A correctly rounded value strictly inside proves the exact one inside: it is less than a float away. At the ends of the
/// function's range (±1, 0, ∞) the value itself may be the bound.
fn encloses(bounds: Interval, nearest: f64, (least, greatest): (f64, f64)) -> bool {
    (bounds.lo() < nearest || bounds.lo() == least) && (nearest < bounds.hi() || bounds.hi() == greatest)
}

fn function(seed: u64, name: &str, correct: fn(f64) -> f64, range: (f64, f64)) {
    sweep(seed, |random, low, high| {
        let (xs, x) = draw(random, low, high);
        let bounds = apply(name, xs);
        let nearest = correct(x);
        assert!(
            nearest.is_nan() || encloses(bounds, nearest, range),
            "{name} {x:e} = {nearest:e} not in {bounds:?}"
        );
    });
}

const INFINITY: f64 = f64::INFINITY;

#[test]
fn exponential() {
    function(5, "exp", core_math::exp, (0.0, INFINITY));
}

#[test]
fn logarithm() {
    function(6, "ln", core_math::log, (-INFINITY, INFINITY));
}

#[test]
fn sine() {
    function(7, "sin", core_math::sin, (-1.0, 1.0));
}

#[test]
fn cosine() {
    function(8, "cos", core_math::cos, (-1.0, 1.0));
}

#[test]
fn hyperbolic_tangent() {
    function(9, "tanh", core_math::tanh, (-1.0, 1.0));
}

#[test]
fn arc_tangent() {
    function(10, "atan", core_math::atan, (-INFINITY, INFINITY));
}

/// `lo ≤ ln cosh x` is `e^lo − 1 ≤ 2 sinh² (x/2)`. Each side is good to 4 roundings: a coarse check at every magnitude,
/// which the table makes fine.
#[test]
fn log_cosh() {
    sweep(11, |random, low, high| {
        let (xs, x) = draw(random, low.max(-500), high.min(9));
        let bounds = xs.ln_cosh();
        let excess = 2.0 * core_math::sinh(x / 2.0) * core_math::sinh(x / 2.0);
        let slack = 5.0 * f64::EPSILON;
        let below = f64::exp_m1(bounds.lo()) <= excess * (1.0 + slack);
        assert!(below && excess * (1.0 - slack) <= f64::exp_m1(bounds.hi()), "{x:e} {bounds:?}");
    });
}

/// Against mpmath: the exact value lies strictly between two neighbouring floats, so both must be inside.
#[test]
fn exact_values() {
    for row in rows::<2>(ENCLOSURES) {
        let (bounds, [below, above]) = (apply(row.name, Interval::point(row.x)), row.values);
        assert!(bounds.contains(below) && bounds.contains(above), "{} {:e}: {bounds:?}", row.name, row.x);
    }
}

/// More is never less: growing the arguments grows the result.
#[test]
fn isotone() {
    sweep(12, |random, low, high| {
        let ((x, _), (y, _)) = (draw(random, low, high), draw(random, low, high));
        let ((dx, _), (dy, _)) = (draw(random, low, high), draw(random, low, high));
        let (wide_x, wide_y) = (x.hull(dx), y.hull(dy));
        let pairs = [
            (wide_x + wide_y, x + y),
            (wide_x - wide_y, x - y),
            (wide_x * wide_y, x * y),
            (wide_x / wide_y, x / y),
        ];
        for (wide, narrow) in pairs {
            assert!(wide.contains_interval(narrow), "{x:?} {y:?} {wide_x:?} {wide_y:?}");
        }
        let name = random.choice(["sin", "cos", "tanh", "ln_cosh", "exp", "atan", "recip"]);
        assert!(apply(name, wide_x).contains_interval(apply(name, x)), "{name} {x:?} in {wide_x:?}");
    });
}
