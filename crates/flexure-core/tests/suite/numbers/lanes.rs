//! Lanes are scalars side by side.

use flexure_core::scalar::{Jet, Lanes, Over, Piecewise, Scalar};

use super::oracle::{Random, apply, ulps};

type Batch = Lanes<f64, 4>;

fn draw(random: &mut Random) -> [f64; 4] {
    std::array::from_fn(|_| random.magnitude(-1000, 1000))
}

/// Same bits, any NaN being one.
fn same(lanes: Batch, scalars: [f64; 4]) -> bool {
    lanes
        .to_array()
        .into_iter()
        .zip(scalars)
        .all(|(a, b)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()))
}

#[test]
fn arithmetic_is_bitwise_that_of_scalars() {
    let mut random = Random(1);
    for _ in 0..100_000 {
        let (a, b) = (draw(&mut random), draw(&mut random));
        let (x, y) = (Batch::from_array(a), Batch::from_array(b));
        let each = |f: fn(f64, f64) -> f64| std::array::from_fn(|i| f(a[i], b[i]));
        assert!(same(x + y, each(|a, b| a + b)));
        assert!(same(x - y, each(|a, b| a - b)));
        assert!(same(x * y, each(|a, b| a * b)));
        assert!(same(x / y, each(|a, b| a / b)));
        assert!(same(-x, each(|a, _| -a)));
        assert!(same(x.sqrt(), each(|a, _| a.sqrt())));
        assert!(same(x.scale(b[0]), a.map(|a| a * b[0])));
        assert!(same(x.recip(), each(|a, _| 1.0 / a)));
    }
}

#[test]
fn pieces_are_those_of_scalars_and_keep_nan() {
    let values = [f64::NAN, -f64::INFINITY, f64::INFINITY, -1.0, -0.0, 0.0, 2.0, f64::MAX];
    for a in values {
        for b in values {
            // The other lanes choose otherwise.
            let (x, y) =
                (Batch::from_array([a, 1.0, -1.0, 0.0]), Batch::from_array([b, -1.0, 1.0, f64::NAN]));
            let pieces = [
                (x.select(y, Batch::splat(7.0)), Piecewise::select(a, b, 7.0)),
                (x.min(y), Piecewise::min(a, b)),
                (x.max(y), Piecewise::max(a, b)),
                (x.abs(), Piecewise::abs(a)),
            ];
            for (lanes, scalar) in pieces {
                let lane = lanes.to_array()[0];
                assert!(lane == scalar || (lane.is_nan() && scalar.is_nan()), "{a} {b}: {lane} for {scalar}");
                assert!(!lanes.to_array()[1].is_nan() && !lanes.to_array()[2].is_nan());
            }
        }
    }
}

/// The worst distance from the correctly rounded value over a million arguments in a range.
fn worst_f64(name: &str, correct: fn(f64) -> f64, (lo, hi): (f64, f64)) -> u64 {
    let mut random = Random(2);
    let mut worst = 0;
    for _ in 0..250_000 {
        // Half uniform, half log-uniform towards zero.
        let x: [f64; 4] = std::array::from_fn(|i| {
            if i % 2 == 0 { random.uniform(lo, hi) } else { (hi * random.magnitude(-40, -1)).abs() }
        });
        let y = apply(name, Batch::from_array(x)).to_array();
        for (x, y) in x.into_iter().zip(y) {
            worst = worst.max(ulps(y, correct(x)));
        }
    }
    worst
}

fn ulps_f32(a: f32, b: f32) -> u32 {
    let ordered = |x: f32| {
        if x.to_bits() >> 31 == 0 { x.to_bits().cast_signed() } else { -(x.abs().to_bits().cast_signed()) }
    };
    ordered(a).abs_diff(ordered(b))
}

fn worst_f32(name: &str, correct: fn(f64) -> f64, (lo, hi): (f64, f64)) -> u32 {
    let mut random = Random(3);
    let mut worst = 0;
    for _ in 0..125_000 {
        let x: [f32; 8] = std::array::from_fn(|i| {
            let x = if i % 2 == 0 { random.uniform(lo, hi) } else { (hi * random.magnitude(-20, -1)).abs() };
            f32::from_f64(x)
        });
        let y = apply(name, Lanes::<f32, 8>::from_array(x)).to_array();
        for (x, y) in x.into_iter().zip(y) {
            worst = worst.max(ulps_f32(y, f32::from_f64(correct(f64::from(x)))));
        }
    }
    worst
}

/// A coarse `ln cosh`, good to 3 roundings, in place of core-math's, which has none.
fn ln_cosh(x: f64) -> f64 {
    if x.abs() < 1.0 {
        core_math::log1p(2.0 * core_math::sinh(0.5 * x).powi(2))
    } else {
        (x.abs() - core::f64::consts::LN_2) + core_math::log1p(core_math::exp(-2.0 * x.abs()))
    }
}

/// The table in the documentation of `Lanes`: function, range, worst ulp in f64, range, worst ulp in f32.
#[test]
fn elementary_functions_are_within_the_documented_ulp() {
    type Range = (f64, f64);
    type Line = (&'static str, fn(f64) -> f64, Range, u64, Range, u32);
    let table: [Line; 7] = [
        ("exp", core_math::exp, (-700.0, 700.0), 1, (-87.0, 88.0), 1),
        ("ln", core_math::log, (1e-300, 1e300), 1, (1e-30, 1e30), 1),
        ("sin", core_math::sin, (-1000.0, 1000.0), 2, (-100.0, 100.0), 2),
        ("cos", core_math::cos, (-1000.0, 1000.0), 2, (-100.0, 100.0), 2),
        ("tanh", core_math::tanh, (-20.0, 20.0), 6, (-20.0, 20.0), 4),
        ("ln_cosh", ln_cosh, (-800.0, 800.0), 10, (-800.0, 800.0), 8),
        ("atan", core_math::atan, (-1e6, 1e6), 1, (-1e6, 1e6), 1),
    ];
    for (name, correct, double, worst_double, single, worst_single) in table {
        let (d, s) = (worst_f64(name, correct, double), worst_f32(name, correct, single));
        println!("{name}: {d} ulp in f64, {s} in f32");
        assert!(d <= worst_double && s <= worst_single, "{name}: {d} and {s} ulp");
    }
}

#[test]
fn saturation_is_finite() {
    let far = Batch::from_array([800.0, -800.0, 1e300, 0.0]);
    assert_eq!(far.tanh().to_array(), [1.0, -1.0, 1.0, 0.0]);
    let line = 800.0 - core::f64::consts::LN_2;
    assert_eq!(far.ln_cosh().to_array(), [line, line, 1e300, 0.0]);
    let far = Lanes::<f32, 4>::from_array([800.0, -800.0, 1e30, 0.0]);
    assert_eq!(far.tanh().to_array(), [1.0, -1.0, 1.0, 0.0]);
    assert!(far.ln_cosh().to_array().into_iter().all(f32::is_finite));
}

/// No function lets a lane see its neighbours: NaN and infinity next door change nothing.
#[test]
fn lanes_are_independent() {
    for name in ["sqrt", "exp", "ln", "sin", "cos", "tanh", "ln_cosh", "atan", "recip"] {
        for x in [0.3, 2.0, 17.0, 300.0] {
            let alone = apply(name, Batch::splat(x)).to_array()[1];
            for other in [f64::NAN, f64::INFINITY, -f64::INFINITY, -1.0, 0.0, 1e300] {
                let beside = apply(name, Batch::from_array([other, x, -other, other])).to_array()[1];
                assert_eq!(alone.to_bits(), beside.to_bits(), "{name} {x} beside {other}");
            }
            assert!(
                apply(name, Batch::from_array([f64::NAN, x, x, x])).to_array()[0].is_nan(),
                "{name} of NaN"
            );
        }
    }
}

/// Jets of lanes are lanes of jets: exact for arithmetic.
#[test]
fn jets_of_lanes_are_jets_side_by_side() {
    let mut random = Random(4);
    for _ in 0..1000 {
        let mut series = || {
            std::array::from_fn::<_, 4, _>(|_| std::array::from_fn::<_, 3, _>(|_| random.uniform(0.5, 2.0)))
        };
        let (a, b) = (series(), series());
        let batch = |c: [[f64; 3]; 4]| Jet::<Batch, 3>::from_fn(|k| Batch::from_array(c.map(|lane| lane[k])));
        let together = (batch(a) * batch(b) - batch(b)).sqrt() / (batch(a) + batch(b));
        for lane in 0..4 {
            let (a, b) = (Jet::new(a[lane]), Jet::new(b[lane]));
            let alone = (a * b - b).sqrt() / (a + b);
            for k in 0..3 {
                let (x, y) = (together.coefficient(k).to_array()[lane], alone.coefficient(k));
                assert!(x.to_bits() == y.to_bits() || (x.is_nan() && y.is_nan()));
            }
        }
    }
}
