//! What linear differential equations with coefficients in intervals make of their states.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::sampled_data::norm::{around_zero, radius};

/// Largest norm of coefficients that the series is summed for.
const LARGEST: f64 = 4.0;

/// The series ends where what follows is smaller than this.
const REST: f64 = 1e-20;

/// More than what some hundred sums and products of numbers above 0 lose by rounding, relatively.
const INFLATED: f64 = 1.0 + 1e-9;

/// Coefficients J(t) of Ẋ = J(t) X for t in [0, 1].
#[derive(Clone, Debug)]
pub struct Coefficients {
    /// J(t) is in this + t `change`, at all times.
    pub begin: Dense<Interval>,
    /// How they change from 0 to 1.
    pub change: Dense<Interval>,
    /// Where others are, too, at all times.
    pub anywhere: Dense<Interval>,
}

/// What becomes of states.
#[derive(Clone, Debug)]
pub struct Fundamental {
    /// X(1) of all solutions with J(t) along the line.
    pub at_end: Dense<Interval>,
    /// X(t) X(s)⁻¹ for all s ≤ t in [0, 1] and all J(t), in size, from above.
    pub between: Dense<f64>,
    /// Y(1), within rounding.
    about: Dense<Interval>,
    /// How far J(t) is beside the line anywhere, from above.
    beside: Dense<f64>,
}

impl Fundamental {
    /// What the states `start` become where J(t) is anywhere: Y(1) and G D G of them.
    pub fn anywhere(&self, start: &[Interval]) -> Vec<Interval> {
        let sized: Vec<_> = start.iter().map(|x| x.magnitude()).collect();
        let open = self.between.apply(&self.beside.apply(&self.between.apply(&sized)));
        let about = self.about.apply(start);
        about.iter().zip(open).map(|(&x, open)| x + around_zero(open * INFLATED)).collect()
    }
}

/// Encloses X(1) of every solution of Ẋ = J(t) X with X(0) = 1 and J(t) along the line of `rates`, and of those with J(t) anywhere; none where those are too large for a
/// single step.
///
/// Of the line A + t C of floats, Y(1) = Σ Y_k with Y_0 = 1, (k + 1) Y_{k+1} = A Y_k + C Y_{k−1}. If |J(t) − A − t C| ≤ D, entry by entry, then
/// X(1) = Y(1) + ∫ Y(1) Y(t)⁻¹ (J(t) − A − t C) X(t) dt, both factors beside it are at most G ≥ e^(|A| + |C| + D) in size, and so |X(1) − Y(1)| ≤ G D G. What rounding
/// makes of the sum is below 2 (p + 1) (2 n + 8) ulp of G (Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., section 3.5: each Y_k is made of k
/// such products, and sizes of the Y_k add up to less than G).
pub fn fundamental(rates: &Coefficients) -> Option<Fundamental> {
    let n = rates.begin.columns();
    let [start, change] = [&rates.begin, &rates.change].map(|all| all.map(Interval::midpoint));
    let line = |i: usize, j: usize| (radius(rates.begin[(i, j)]) + radius(rates.change[(i, j)])).hi();
    let everywhere = |i: usize, j: usize| {
        let along = Interval::ZERO.hull(Interval::point(change[(i, j)]));
        (rates.anywhere[(i, j)] - Interval::point(start[(i, j)]) - along).magnitude()
    };
    let line = Dense::from_fn(n, n, line);
    let everywhere = Dense::from_fn(n, n, everywhere);
    let above = Dense::from_fn(n, n, |i, j| {
        let at = (i, j);
        (start[at].abs() + change[at].abs() + line[at].max(everywhere[at])) * INFLATED
    });
    let norm = |all: &Dense<f64>| {
        all.rows().map(|row| row.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max) * INFLATED
    };
    let (size, slope) = (norm(&above), norm(&change));
    if size.is_nan() || size > LARGEST {
        return None;
    }
    // Norms of the terms of both series, the last two of them. From order 2 (size + slope) on, two more halve what they are at most.
    let (mut order, mut terms) = (0.0, [0.0, 1.0_f64]);
    while terms[0].max(terms[1]) > REST || order < 2.0 * (size + slope) {
        order += 1.0;
        terms = [terms[1], (size * terms[1] + slope * terms[0]) / order];
    }
    let rest = (2.0 * terms[0].max(terms[1]) * INFLATED).max(f64::MIN_POSITIVE);
    let about = series(&start, Some(&change), order);
    let above = series(&above, None, order).map(|x| x * INFLATED + rest);
    let rounding = 2.0 * (order + 1.0) * (2.0 * n as f64 + 8.0) * f64::EPSILON;
    let about = Dense::from_fn(n, n, |i, j| {
        Interval::point(about[(i, j)]) + around_zero((rounding * above[(i, j)] + rest) * INFLATED)
    });
    let open = &(&above * &line) * &above;
    let at_end = Dense::from_fn(n, n, |i, j| about[(i, j)] + around_zero(open[(i, j)] * INFLATED));
    Some(Fundamental { at_end, between: above, about, beside: everywhere })
}

/// Y(1) of Ẏ = (A + t C) Y, Y(0) = 1, by terms up to `order`.
fn series(a: &Dense<f64>, c: Option<&Dense<f64>>, order: f64) -> Dense<f64> {
    let one = Dense::identity(a.columns());
    let (mut sum, mut before, mut term, mut k) = (one.clone(), None, one, 0.0);
    while k < order {
        k += 1.0;
        let mut next = a * &term;
        if let (Some(c), Some(before)) = (c, &before) {
            next = &next + &(c * before);
        }
        before = Some(term);
        term = next.scaled(1.0 / k);
        sum = &sum + &term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use flexure_core::scalar::Interval;

    use super::{Coefficients, Dense, Fundamental};

    /// Of coefficients that may be anywhere in `rates`.
    fn fundamental(rates: &Dense<Interval>) -> Option<Fundamental> {
        let change = rates.map(|_| Interval::point(0.0));
        super::fundamental(&Coefficients { begin: rates.clone(), change, anywhere: rates.clone() })
    }

    /// A solution in short steps, by its columns, off by less than 1e-7.
    fn solved(coefficients: &dyn Fn(f64) -> [[f64; 2]; 2]) -> [[f64; 2]; 2] {
        let (steps, mut x) = (4000, [[1.0, 0.0], [0.0, 1.0]]);
        for step in 0..steps {
            let h = 1.0 / f64::from(steps);
            let a = coefficients((f64::from(step) + 0.5) * h);
            for x in &mut x {
                let rate = |x: &[f64; 2]| a.map(|a| a[0] * x[0] + a[1] * x[1]);
                let first = rate(x);
                let half = [x[0] + 0.5 * h * first[0], x[1] + 0.5 * h * first[1]];
                let second = rate(&half);
                *x = [x[0] + h * second[0], x[1] + h * second[1]];
            }
        }
        x
    }

    /// A damped oscillator whose spring becomes stiffer as time goes by, in short steps: inside, and near the ends where the spring is at one.
    #[test]
    fn a_spring_that_changes_stays_inside() {
        let coefficients = |k: f64| [[0.0, 1.0], [-k, -0.4]];
        let rates = Dense::from_fn(2, 2, |i, j| {
            let [low, high] = [0.8, 1.3].map(|k| Interval::point(coefficients(k)[i][j]));
            low.hull(high)
        });
        let found = fundamental(&rates).unwrap().at_end;
        let ways: [&dyn Fn(f64) -> f64; 4] =
            [&|_| 0.8, &|_| 1.3, &|t| 0.8 + 0.5 * t, &|t| if t < 0.5 { 1.3 } else { 0.8 }];
        for way in ways {
            let x = solved(&|t| coefficients(way(t)));
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let wide = found[(i, j)] + Interval::new(-1e-7, 1e-7).unwrap();
                assert!(wide.contains(x[j][i]), "{i} {j}: {} not in {:?}", x[j][i], found[(i, j)]);
            }
        }
        let width = found.rows().flatten().fold(0.0, |widest: f64, x| widest.max(x.width()));
        assert!(width < 4.0, "{width}");
    }

    /// A spring that stiffens along a line, with a little beside it: far closer than without the line, and motions that may be anywhere reach farther.
    #[test]
    fn along_a_line_little_is_open() {
        let coefficients = |k: f64| [[0.0, 1.0], [-k, -0.4]];
        let of = |wide: f64, line: bool| {
            let at = |k: f64, wide: f64| {
                Dense::from_fn(2, 2, |i, j| {
                    let spring = if (i, j) == (1, 0) { wide } else { 0.0 };
                    Interval::point(coefficients(k)[i][j]) + Interval::new(-spring, spring).unwrap()
                })
            };
            let change = Dense::from_fn(2, 2, |i, j| {
                Interval::point(if line && (i, j) == (1, 0) { -0.5 } else { 0.0 })
            });
            let begin = if line { at(0.8, wide) } else { at(1.05, 0.25 + wide) };
            super::fundamental(&Coefficients { begin, change, anywhere: at(1.05, 0.25 + wide) }).unwrap()
        };
        let width =
            |all: &Dense<Interval>| all.rows().flatten().fold(0.0, |most: f64, x| most.max(x.width()));
        // Rounding of some two dozen terms.
        assert!(width(&of(0.0, true).at_end) < 1e-11);
        assert!(width(&of(0.0, false).at_end) > 0.3);
        let close = of(1e-3, true);
        assert!((1e-3..3e-2).contains(&width(&close.at_end)), "{}", width(&close.at_end));
        let wave = |t: f64| 0.8 + 0.5 * t + 1e-3 * (40.0 * t).sin();
        for (way, anywhere) in [(&wave as &dyn Fn(f64) -> f64, false), (&|_| 1.3, true), (&|_| 0.8, true)] {
            let x = solved(&|t| coefficients(way(t)));
            let any = close.anywhere(&[0.6, -0.8].map(Interval::point));
            for i in 0..2 {
                let wide = |x: Interval| x + Interval::new(-1e-7, 1e-7).unwrap();
                assert!(wide(any[i]).contains(0.6 * x[0][i] - 0.8 * x[1][i]), "{i}");
                assert!((0..2).all(|j| wide(close.at_end[(i, j)]).contains(x[j][i]) || anywhere), "{i}");
            }
        }
        let far = solved(&|_| coefficients(1.3));
        assert!(!close.at_end[(1, 0)].contains(far[0][1]));
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
