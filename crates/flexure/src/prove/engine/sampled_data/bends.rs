//! How far the law is from linear: its second derivatives on the way from a motion to others, over boxes.

use flexure_core::scalar::{Dual, Interval, Jet, Scalar};

use crate::linalg::{Dense, Symmetric};
use crate::prove::engine::envelope::closed_loop::{Place, Slope, Tilt, TrackingLoop};
use crate::prove::engine::sampled_data::frame::Frame;
use crate::prove::engine::sampled_data::norm::around_zero;
use crate::prove::engine::sampled_data::second::second_derivatives;

/// Which derivatives of the law are known over boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// The second. In intervals they are some thirty times as wide as what they enclose: terms with large gains cancel, which intervals do not see.
    Second,
    /// The third, and the second at motions: closer by far, and more to evaluate, n³ instead of n².
    Third,
}

/// What is known of the law's torques by the coordinates ξ of a frame, over a box of motions and some time.
#[derive(Clone, Debug)]
pub struct Bends {
    times: Interval,
    over: Vec<Interval>,
    frame: Frame,
    known: Known,
}

#[derive(Clone, Debug)]
enum Known {
    /// ∂²u_j/∂ξ².
    Second(Vec<Symmetric<Interval>>),
    /// |∂³u_j/∂ξ_i∂ξ_k∂ξ_m| from above: for each m, for each j, those of i, k ≤ m.
    Third(Vec<Vec<Symmetric<f64>>>),
}

/// A motion (q_l, q_m, q̇_l, q̇_m).
fn place<S>(x: Vec<S>) -> Place<S> {
    let (n, mut x) = (x.len() / 4, x.into_iter());
    let [q_l, q_m, v_l, v_m] = std::array::from_fn(|_| x.by_ref().take(n).collect());
    Place { q_l, q_m, v_l, v_m }
}

/// A number that moves at `rate`.
fn moving(x: Interval, rate: Interval) -> Slope {
    Jet::new([x, rate, Interval::ZERO])
}

/// The law's torques [N m] along a line of motions x = (q_l, q_m, q̇_l, q̇_m) that move at `rates`.
pub fn along(
    system: &dyn TrackingLoop,
    q_ld: &[[Slope; 5]],
    x: &[Interval],
    rates: &[Interval],
) -> Vec<Slope> {
    let x = x.iter().zip(rates).map(|(&x, &rate)| moving(x, rate)).collect();
    system.command(&place(x), q_ld).u_m
}

/// The sum of so many columns.
pub fn columns(lower: &Dense<f64>, of: &[usize]) -> Vec<Interval> {
    let sum = |row: &[f64]| of.iter().fold(Interval::ZERO, |sum, &k| sum + Interval::point(row[k]));
    lower.rows().map(sum).collect()
}

/// Taylor coefficients of the reference over the times `t` in s.
pub fn reference(system: &dyn TrackingLoop, t: Interval) -> Vec<[Slope; 5]> {
    system.reference(t).iter().map(|jet| std::array::from_fn(|k| Slope::value(jet[k]))).collect()
}

/// ∂²u_j/∂ξ² over `x`.
fn second(
    system: &dyn TrackingLoop,
    q_ld: &[[Slope; 5]],
    x: &[Interval],
    frame: &Frame,
) -> Vec<Symmetric<Interval>> {
    second_derivatives(x.len(), &|_, _| false, &|directions| {
        let torques = along(system, q_ld, x, &columns(&frame.lower, directions));
        torques.iter().map(|u| u.coefficient(2)).collect()
    })
}

/// ∂³u_j/∂ξ_i∂ξ_k∂ξ_m over `x` for i, k ≤ m.
fn third(
    system: &dyn TrackingLoop,
    q_ld: &[[Slope; 5]],
    x: &[Interval],
    frame: &Frame,
    m: usize,
) -> Vec<Symmetric<Interval>> {
    let beside = columns(&frame.lower, &[m]);
    second_derivatives(m + 1, &|_, _| false, &|directions| {
        let rates = columns(&frame.lower, directions);
        let tilt = |i: usize| -> Tilt {
            Dual { value: moving(x[i], rates[i]), gradient: [Slope::value(beside[i])] }
        };
        let torques = system.torques(&place((0..x.len()).map(tilt).collect()), q_ld);
        torques.iter().map(|u| u.gradient[0].coefficient(2)).collect()
    })
}

impl Bends {
    /// Over the `times` in s and the box `over` of motions.
    pub fn over(
        system: &dyn TrackingLoop,
        times: Interval,
        over: Vec<Interval>,
        frame: &Frame,
        order: Order,
    ) -> Self {
        let q_ld = reference(system, times);
        let known = match order {
            Order::Second => Known::Second(second(system, &q_ld, &over, frame)),
            Order::Third => {
                let sizes = |m| {
                    let all = third(system, &q_ld, &over, frame, m);
                    all.iter().map(|of| of.map(Interval::magnitude)).collect()
                };
                Known::Third((0..over.len()).map(sizes).collect())
            }
        };
        Self { times, over, frame: frame.clone(), known }
    }

    /// Coordinates of what lies `by` beside a motion.
    pub fn coordinates(&self, by: &Dense<Interval>) -> Dense<Interval> {
        self.frame.coordinates(by)
    }

    /// Whether they are known at the time `t` in s over all of the box `x`.
    pub fn cover(&self, t: Interval, x: &[Interval]) -> bool {
        self.times.contains_interval(t) && self.over.iter().zip(x).all(|(over, x)| over.contains_interval(*x))
    }

    /// ∂²u_j/∂ξ² at the time `t` in s and the motion `x`, where [`mean`](Self::mean) needs it; else none.
    pub fn second_at(
        &self,
        system: &dyn TrackingLoop,
        t: Interval,
        x: &[Interval],
    ) -> Vec<Symmetric<Interval>> {
        match self.known {
            Known::Second(_) => Vec::new(),
            Known::Third(_) => second(system, &reference(system, t), x, &self.frame),
        }
    }

    /// H(c + t ξ) for a motion c with H(c) in `at`, |ξ_i| ≤ `reach`_i and t from 0 to 1, averaged with weights that have t at `mean` in the mean.
    ///
    /// Of third derivatives T, H(c + t ξ) − H(c) is t T ξ with T taken somewhere on the way.
    pub fn mean(
        &self,
        at: &[Symmetric<Interval>],
        reach: &[Interval],
        mean: Interval,
    ) -> Vec<Symmetric<Interval>> {
        let third = match &self.known {
            Known::Second(all) => return all.clone(),
            Known::Third(third) => third,
        };
        let change = |j: usize, i: usize, k: usize| {
            let size = |m: usize| {
                let mut all = [i, k, m];
                all.sort_unstable();
                Interval::point(third[all[2]][j].at(all[1], all[0]))
            };
            reach.iter().enumerate().fold(Interval::ZERO, |sum, (m, &reach)| sum + size(m) * reach)
        };
        let of = |(j, at): (usize, &Symmetric<Interval>)| {
            Symmetric::from_fn(reach.len(), |i, k| at.at(i, k) + around_zero((mean * change(j, i, k)).hi()))
        };
        at.iter().enumerate().map(of).collect()
    }
}
