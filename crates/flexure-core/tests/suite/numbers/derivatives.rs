//! Derivatives of every elementary function against 50-digit values, on jets, duals and their nestings.

use flexure_core::scalar::{Dual, Jet, Scalar};

use super::oracle::{DERIVATIVES, Row, apply, rows};

/// Order 6.
const K: usize = 7;

fn table() -> impl Iterator<Item = Row<K>> {
    rows(DERIVATIVES)
}

/// Taylor coefficients from derivatives.
fn taylor(derivatives: [f64; K]) -> [f64; K] {
    let mut factorial = 1.0;
    std::array::from_fn(|k| {
        factorial *= k.max(1) as f64;
        derivatives[k] / factorial
    })
}

/// The recurrences build each coefficient from sums of products of the lower ones: their rounding errors are relative to
/// the largest coefficient so far, not to a coefficient that cancels (tanh's at 18, say).
fn check(row: &Row<K>, k: usize, computed: f64, epsilon: f64) {
    let exact = taylor(row.values);
    let scale = exact[..=k].iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    // An order adds at most about 8 roundings, in sums of k terms.
    let tolerance = 8.0 * (1.0 + k as f64) * epsilon * scale;
    let error = (computed - exact[k]).abs();
    assert!(error <= tolerance, "{} at {}, order {k}: {computed} for {}", row.name, row.x, exact[k]);
}

#[test]
fn values() {
    for row in table() {
        check(&row, 0, apply(row.name, row.x), f64::EPSILON);
    }
}

#[test]
fn jets_have_every_order() {
    for row in table() {
        let y = apply(row.name, Jet::<f64, K>::variable(row.x));
        for k in 0..K {
            check(&row, k, y.coefficient(k), f64::EPSILON);
        }
    }
}

#[test]
fn a_jet_of_lower_order_is_a_truncation() {
    for row in table() {
        let high = apply(row.name, Jet::<f64, K>::variable(row.x));
        let low = apply(row.name, Jet::<f64, 3>::variable(row.x));
        assert_eq!(high.truncate::<3>(), low, "{} at {}", row.name, row.x);
    }
}

#[test]
fn duals_have_the_slope() {
    for row in table() {
        let y = apply(row.name, Dual::<f64, 2>::variable(row.x, 1));
        check(&row, 0, y.value, f64::EPSILON);
        check(&row, 1, y.gradient[1], f64::EPSILON);
        assert_eq!(y.gradient[0], 0.0);
    }
}

/// The gradient of a jet of f along x is the jet of f': coefficient k holds (k + 1) times coefficient k + 1 of f.
#[test]
fn duals_of_jets_agree_with_a_higher_order() {
    const J: usize = K - 1;
    for row in table() {
        let x = Dual { value: Jet::<f64, J>::variable(row.x), gradient: [Jet::ONE] };
        let y = apply(row.name, x);
        for k in 0..J {
            check(&row, k, y.value.coefficient(k), f64::EPSILON);
            check(&row, k + 1, y.gradient[0].coefficient(k) / (k + 1) as f64, f64::EPSILON);
        }
    }
}

#[test]
fn jets_of_duals_agree_with_a_higher_order() {
    const J: usize = K - 1;
    for row in table() {
        let y = apply(row.name, Jet::<Dual<f64, 1>, J>::variable(Dual::variable(row.x, 0)));
        for k in 0..J {
            check(&row, k, y.coefficient(k).value, f64::EPSILON);
            check(&row, k + 1, y.coefficient(k).gradient[0] / (k + 1) as f64, f64::EPSILON);
        }
    }
}

/// The argument itself is rounded to f32, which moves f by x f': points where that is more than rounding are left out.
#[test]
fn single_precision() {
    for row in table().filter(|row| row.x.abs() <= 5.0) {
        let y = apply(row.name, Jet::<f32, K>::variable(f32::from_f64(row.x)));
        for k in 0..K {
            check(&row, k, f64::from(y.coefficient(k)), 4.0 * f64::from(f32::EPSILON));
        }
    }
}

#[cfg(feature = "interval")]
#[test]
fn jets_of_intervals_contain_every_order() {
    use flexure_core::scalar::Interval;
    for row in table() {
        let y = apply(row.name, Jet::<Interval, K>::variable(Interval::point(row.x)));
        for (k, exact) in row.values.into_iter().enumerate() {
            // The table's own rounding: 20 digits, then one float.
            let exact = Interval::new(exact.next_down(), exact.next_up()).unwrap();
            let bound = y.derivative(k);
            assert!(bound.intersection(exact).is_some(), "{} at {}, order {k}: {bound:?}", row.name, row.x);
        }
    }
}

#[cfg(feature = "lanes")]
#[test]
fn jets_of_lanes_have_every_order() {
    use flexure_core::scalar::Lanes;
    for row in table() {
        // The other lanes hold other arguments, valid for every function.
        let x = Lanes::<f64, 4>::from_array([1.5, row.x, 0.25, 30.0]);
        let y = apply(row.name, Jet::<_, K>::variable(x));
        for k in 0..K {
            check(&row, k, y.coefficient(k).to_array()[1], f64::EPSILON);
        }
    }
}
