//! What linear differential equations with coefficients in intervals make of their states.

use flexure_core::scalar::Interval;

use crate::linalg::Dense;
use crate::prove::engine::sampled_data::norm::{around_zero, radius};

/// Largest norm of coefficients that the series is summed for.
const LARGEST: f64 = 4.0;

/// The series ends where what follows is smaller than this.
const REST: f64 = 1e-20;

/// More than what some hundred sums and products of numbers above 0 lose by rounding, relatively.
const INFLATED: f64 = 1.0 + 1e-9;

/// What becomes of states.
#[derive(Clone, Debug)]
pub struct Fundamental {
    /// X(1) of all solutions.
    pub at_end: Dense<Interval>,
    /// X(t) X(s)⁻¹ for all s ≤ t in [0, 1], in size, from above.
    pub between: Dense<f64>,
}

/// Encloses X(1) of every solution of Ẋ = J(t) X with X(0) = 1 and J(t) in `rates` at all times; none where those are too large for a single
/// step.
///
/// With B the middles, D the radii and G ≥ e^(|B| + D), all entry by entry: X(1) = e^B + ∫ e^(B(1 − t)) (J(t) − B) X(t) dt, both factors beside
/// J(t) − B are at most G in size, and so |X(1) − e^B| ≤ G D G. e^B is its Taylor polynomial of degree p in floats: what rounding makes of it is below
/// 2 (p + 1) (n + 6) ulp of G (Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., section 3.5), what the polynomial leaves is below
/// ‖B‖^(p+1)/(p + 1)!/(1 − ‖B‖/(p + 2)).
pub fn fundamental(rates: &Dense<Interval>) -> Option<Fundamental> {
    let n = rates.columns();
    let middle = rates.map(Interval::midpoint);
    let radius = rates.map(|x| radius(x).hi());
    let above = Dense::from_fn(n, n, |i, j| (middle[(i, j)].abs() + radius[(i, j)]) * INFLATED);
    let norm = above.rows().map(|row| row.iter().sum::<f64>()).fold(0.0, f64::max) * INFLATED;
    if norm.is_nan() || norm > LARGEST {
        return None;
    }
    let (mut order, mut rest) = (0.0, 1.0);
    while rest > REST || norm >= 0.5 * (order + 2.0) {
        order += 1.0;
        rest *= norm / order;
    }
    // The power after the last, and the geometric series that the others are below.
    let rest = (rest * norm / (order + 1.0) * 2.0 * INFLATED).max(f64::MIN_POSITIVE);
    let about = series(&middle, order);
    let above = series(&above, order).map(|x| x * INFLATED + rest);
    let rounding = 2.0 * (order + 1.0) * (n as f64 + 6.0) * f64::EPSILON;
    let open = &(&above * &radius) * &above;
    let at_end = Dense::from_fn(n, n, |i, j| {
        let error = (open[(i, j)] + rounding * above[(i, j)] + rest) * INFLATED;
        Interval::point(about[(i, j)]) + around_zero(error)
    });
    Some(Fundamental { at_end, between: above })
}

/// Σ Aᵏ/k! up to `order`, by Horner's rule.
fn series(a: &Dense<f64>, order: f64) -> Dense<f64> {
    let one = Dense::identity(a.columns());
    let (mut sum, mut k) = (one.clone(), order);
    while k > 0.0 {
        sum = &one + &(a * &sum).scaled(1.0 / k);
        k -= 1.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use flexure_core::scalar::Interval;

    use super::{Dense, fundamental};

    /// A damped oscillator whose spring becomes stiffer as time goes by, in short steps: inside, and near the ends where the spring is at one.
    #[test]
    fn a_spring_that_changes_stays_inside() {
        let coefficients = |k: f64| [[0.0, 1.0], [-k, -0.4]];
        let rates = Dense::from_fn(2, 2, |i, j| {
            let [low, high] = [0.8, 1.3].map(|k| Interval::point(coefficients(k)[i][j]));
            low.hull(high)
        });
        let found = fundamental(&rates).unwrap().at_end;
        let solved = |k: &dyn Fn(f64) -> f64| {
            let (steps, mut x) = (4000, [[1.0, 0.0], [0.0, 1.0]]);
            for step in 0..steps {
                let h = 1.0 / f64::from(steps);
                let a = coefficients(k((f64::from(step) + 0.5) * h));
                for x in &mut x {
                    let rate = |x: &[f64; 2]| a.map(|a| a[0] * x[0] + a[1] * x[1]);
                    let first = rate(x);
                    let half = [x[0] + 0.5 * h * first[0], x[1] + 0.5 * h * first[1]];
                    let second = rate(&half);
                    *x = [x[0] + h * second[0], x[1] + h * second[1]];
                }
            }
            x
        };
        let ways: [&dyn Fn(f64) -> f64; 4] =
            [&|_| 0.8, &|_| 1.3, &|t| 0.8 + 0.5 * t, &|t| if t < 0.5 { 1.3 } else { 0.8 }];
        for way in ways {
            let x = solved(way);
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                // The solution in steps is off by less than 1e-7.
                let wide = found[(i, j)] + Interval::new(-1e-7, 1e-7).unwrap();
                assert!(wide.contains(x[j][i]), "{i} {j}: {} not in {:?}", x[j][i], found[(i, j)]);
            }
        }
        let width = found.rows().flatten().fold(0.0, |widest: f64, x| widest.max(x.width()));
        assert!(width < 4.0, "{width}");
    }

    /// Numbers that are known give numbers that are known to rounding; e^(-1) and a rotation.
    #[test]
    fn points_stay_points() {
        let angle = 0.7_f64;
        let rates = [[-1.0, 0.0, 0.0], [0.0, 0.0, -angle], [0.0, angle, 0.0]];
        let found = fundamental(&Dense::from_fn(3, 3, |i, j| Interval::point(rates[i][j]))).unwrap().at_end;
        let exact =
            [[(-1.0_f64).exp(), 0.0, 0.0], [0.0, angle.cos(), -angle.sin()], [0.0, angle.sin(), angle.cos()]];
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            assert!((found[(i, j)].midpoint() - exact[i][j]).abs() < 1e-14);
            assert!(found[(i, j)].contains(exact[i][j]) && found[(i, j)].width() < 1e-12);
        }
    }

    #[test]
    fn what_is_too_fast_for_a_step_is_refused() {
        let fast = Dense::from_fn(1, 1, |_, _| Interval::point(-9.0));
        assert!(fundamental(&fast).is_none());
        assert!(fundamental(&Dense::from_fn(1, 1, |_, _| Interval::ENTIRE)).is_none());
    }
}
