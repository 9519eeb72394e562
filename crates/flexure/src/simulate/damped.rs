//! A motor under its damper, exactly.
//!
//! With a damper of rate λ = D_m / M_m the speed of a motor obeys q̈_m + λ q̇_m = f, and f, all other torque over the inertia, is as
//! smooth as the springs are even where the speed is not. So f is what is collocated, and speed and position follow from its polynomial by
//! exponentials: Hochbruck & Ostermann, *Exponential integrators*, Acta Numerica 19 (2010), section 2. Without a damper this is
//! Gauss' collocation itself.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::Scalar;

use crate::simulate::scheme::{Scheme, StageMap, Stages, factorial};

/// φ_k(−x) for k = 0, 1, …: ∫₀¹ e^(−x (1 − s)) s^(k−1) / (k − 1)! ds.
type Phi = [f64; COUNT];

const COUNT: usize = 9;

/// A damping rate times the length of a step from which on speeds are damped within the step. Below it positions at the stages are those of
/// a polynomial through the speeds there, as in Gauss' method: that is what makes it symplectic where nothing is damped.
pub(crate) const WITHIN: f64 = 1.0;

/// How a damped motor moves by the instant c h of a step of length h, from its speed at the start and f at the stages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach<const S: usize, T = f64> {
    /// What is left of the speed: e^(−λ h c).
    pub decay: T,
    /// How far the speed at the start carries, in h.
    pub drift: T,
    /// What f adds to the speed, in h.
    pub once: Stages<S, T>,
    /// What f adds to the position, in h².
    pub twice: Stages<S, T>,
}

/// The coefficients of one damped motor for steps of one length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Damped<const S: usize, T = f64> {
    /// What is left of the speed at the stages.
    pub decay: Stages<S, T>,
    /// How far the speed at the start carries by the stages, in h.
    pub drift: Stages<S, T>,
    /// What f adds to the speed at the stages, in h.
    pub once: StageMap<S, T>,
    /// By the end of the step.
    pub end: Reach<S, T>,
    /// What f adds to the position at the stages, in h².
    pub twice: StageMap<S, T>,
    /// What the acceleration at the stages has of f at the stages: q̈_m = f − λ q̇_m.
    pub acceleration: StageMap<S, T>,
    /// By how much means of e^(−λ t) over the weights of the stages exceed its values there, where that matters: a spring that feels the
    /// means gets the impulse of a speed that is damped within the step.
    pub excess: Stages<S, T>,
    /// ∫ ℓ_i q̇_m dt for the polynomials ℓ_i of the stages, from the speed at the start, in h: they sum to `end.drift`.
    pub work_of_speed: Stages<S, T>,
    /// The same from f, in h².
    pub work: StageMap<S, T>,
    /// By how much the end of the step, its speed counted by how far it carries, moves for a defect of 1 at the start that vanishes
    /// at the stages, in h.
    pub error_of_defect: T,
}

impl<const S: usize> Damped<S> {
    /// For the damping rate times the length of the step, λ h ≥ 0.
    pub(crate) fn new(scheme: &Scheme<S>, rate: f64) -> Self {
        const { assert!(2 * S < COUNT) };
        let exact: [Reach<S>; S] = std::array::from_fn(|i| Reach::new(scheme, rate, scheme.nodes[i]));
        let speeds = Matrix(exact.map(|reach| reach.once.0));
        let mut stages = exact;
        if rate < WITHIN {
            for (i, reach) in stages.iter_mut().enumerate() {
                reach.drift = scheme.once.row(i).dot(&Vector(exact.map(|reach| reach.decay)));
                reach.twice = (scheme.once * speeds).row(i);
            }
        }
        let phi = phi(rate);
        // ∫₀¹ s^m s^k φ_k(−λ h s) ds, by parts.
        let moment =
            |m: usize, k: usize| (0..=m).rev().fold(0.0, |sum, r| phi[k + 1 + r] - (m - r) as f64 * sum);
        let p = &scheme.polynomials;
        let end = Reach::new(scheme, rate, 1.0);
        let over = |k: usize| {
            let moments: Stages<S> = Vector::from_fn(|m| moment(m, k));
            Vector::from_fn(|i| (0..S).map(|m| p[(i, m)] * moments[m]).sum::<f64>())
        };
        let work_of_speed: Stages<S> = over(0);
        let work_of_powers: [Stages<S>; S] = std::array::from_fn(|k| over(k + 1).scaled(FACTORIAL[k]));
        let excess = Vector::from_fn(|i| work_of_speed[i] / scheme.weights[i] - stages[i].decay);
        Self {
            decay: Vector(stages.map(|reach| reach.decay)),
            drift: Vector(stages.map(|reach| reach.drift)),
            once: StageMap::new(&speeds),
            twice: StageMap::new(&Matrix(stages.map(|reach| reach.twice.0))),
            end,
            acceleration: StageMap::new(&(Matrix::identity() - speeds.scaled(rate))),
            excess: if rate < WITHIN { Stages::ZERO } else { excess },
            work_of_speed,
            work: StageMap::new(&Matrix::from_fn(|i, j| {
                (0..S).map(|k| p[(j, k)] * work_of_powers[k][i]).sum()
            })),
            error_of_defect: error_of_defect(scheme, rate),
        }
    }
}

impl<const S: usize, T: Scalar> Damped<S, T> {
    /// The coefficients of several motors, each number put together by `of`, which is told how to find it in the coefficients of one.
    pub(crate) fn together(of: impl Fn(&dyn Fn(&Damped<S>) -> f64) -> T) -> Self {
        let stages = |find: &dyn Fn(&Damped<S>) -> Stages<S>| Vector::from_fn(|i| of(&|one| find(one)[i]));
        let map = |find: &dyn Fn(&Damped<S>) -> StageMap<S>| {
            StageMap::new(&Matrix::from_fn(|i, j| of(&|one| find(one).row(i)[j])))
        };
        let reach = |find: &dyn Fn(&Damped<S>) -> Reach<S>| Reach {
            decay: of(&|one| find(one).decay),
            drift: of(&|one| find(one).drift),
            once: stages(&|one| find(one).once),
            twice: stages(&|one| find(one).twice),
        };
        Self {
            decay: stages(&|one| one.decay),
            drift: stages(&|one| one.drift),
            once: map(&|one| one.once),
            twice: map(&|one| one.twice),
            end: reach(&|one| one.end),
            acceleration: map(&|one| one.acceleration),
            excess: stages(&|one| one.excess),
            work_of_speed: stages(&|one| one.work_of_speed),
            work: map(&|one| one.work),
            error_of_defect: of(&|one| one.error_of_defect),
        }
    }
}

/// As [`Damped::error_of_defect`], for the damping rate times the length of the step.
pub(crate) fn error_of_defect<const S: usize>(scheme: &Scheme<S>, rate: f64) -> f64 {
    let phi = phi(rate);
    // The polynomial that is 1 at the start and 0 at the stages: its leading coefficient, then the others.
    let leading = scheme.nodes.iter().fold(1.0, |product, c| -product / c);
    let powers: [f64; S] = std::array::from_fn(|j| powers(scheme.nodes[j])[S]);
    let rest = |m: usize| -leading * (0..S).map(|j| scheme.polynomials[(j, m)] * powers[j]).sum::<f64>();
    let at_end =
        (0..S).fold(leading * FACTORIAL[S] * phi[S + 1], |sum, m| sum + rest(m) * FACTORIAL[m] * phi[m + 1]);
    (at_end * phi[1]).abs()
}

impl<const S: usize> Reach<S> {
    fn new(scheme: &Scheme<S>, rate: f64, c: f64) -> Self {
        let (phi, powers) = (phi(rate * c), powers(c));
        // ∫₀ᶜ e^(−λh (c − s)) s^k ds = k! c^(k+1) φ_(k+1)(−λh c), and once more.
        let integral = |times: usize| {
            let of_power: Stages<S> = Vector::from_fn(|k| FACTORIAL[k] * powers[k + times] * phi[k + times]);
            let weights = scheme.polynomials * of_power;
            // What f does that is constant is known without the cancellations.
            weights.scaled(powers[times] * phi[times] / weights.iter().sum::<f64>())
        };
        Self { decay: phi[0], drift: c * phi[1], once: integral(1), twice: integral(2) }
    }
}

/// 1, c, c², …
fn powers(c: f64) -> [f64; COUNT] {
    let mut powers = [1.0; COUNT];
    for k in 1..COUNT {
        powers[k] = powers[k - 1] * c;
    }
    powers
}

/// 0!, 1!, …
const FACTORIAL: [f64; COUNT] = {
    let (mut each, mut k) = ([1.0; COUNT], 1);
    while k < COUNT {
        each[k] = factorial(k);
        k += 1;
    }
    each
};

/// What they are divided by to be 1.
const INVERSE_FACTORIAL: [f64; COUNT] = {
    let (mut each, mut k) = ([1.0; COUNT], 1);
    while k < COUNT {
        each[k] = 1.0 / FACTORIAL[k];
        k += 1;
    }
    each
};

/// Terms of the series of the last φ_k(−x): those after so many are less than a rounding of the sum for x < 4, after [`FEW`] for x < 1.
const TERMS: usize = 26;

const FEW: usize = 16;

/// Their coefficients 1 / (k + j)!, but for signs.
const OF_LAST: [f64; TERMS] = {
    let (mut each, mut j) = ([INVERSE_FACTORIAL[COUNT - 1]; TERMS], 1);
    while j < TERMS {
        each[j] = each[j - 1] / (COUNT - 1 + j) as f64;
        j += 1;
    }
    each
};

/// φ_k(−x) for x ≥ 0.
fn phi(x: f64) -> Phi {
    let mut phi = [0.0; COUNT];
    if x < 4.0 {
        // The last one from its series, the others from φ_k = 1/k! − x φ_(k+1), which shrinks errors here.
        let last = COUNT - 1;
        let terms = if x < 1.0 { &OF_LAST[..FEW] } else { &OF_LAST };
        phi[last] = terms.iter().rev().fold(0.0, |sum, coefficient| coefficient - x * sum);
        for k in (0..last).rev() {
            phi[k] = INVERSE_FACTORIAL[k] - x * phi[k + 1];
        }
    } else {
        phi[0] = Scalar::exp(-x);
        for k in 1..COUNT {
            phi[k] = (INVERSE_FACTORIAL[k - 1] - phi[k - 1]) / x;
        }
    }
    phi
}

#[cfg(test)]
mod tests {
    use flexure_core::linalg::Vector;

    use super::{Damped, Reach};
    use crate::linalg::{Dense, exponential};
    use crate::simulate::scheme::Scheme;

    const RATES: [f64; 8] = [0.0, 1e-9, 0.3, 3.99, 4.01, 9.0, 50.0, 3e4];

    /// ∫₀¹ by Gauss' rule in parts that are short where e^(−λ s) or e^(−λ (1 − s)) changes.
    fn integral(rate: f64, f: impl Fn(f64) -> f64) -> f64 {
        let scheme = Scheme::<4>::gauss();
        let mut edges = vec![0.0];
        let shortest = 0.1 / (1.0 + rate);
        while edges[edges.len() - 1] < 0.5 {
            let last = edges[edges.len() - 1];
            edges.push((last + shortest.max(0.1 * last)).min(0.5));
        }
        let mirrored: Vec<_> = edges.iter().rev().skip(1).map(|x| 1.0 - x).collect();
        edges.extend(mirrored);
        let part = |from: f64, to: f64| {
            (0..4)
                .map(|i| (to - from) * scheme.weights[i] * f(from + (to - from) * scheme.nodes[i]))
                .sum::<f64>()
        };
        edges.windows(2).map(|edge| part(edge[0], edge[1])).sum()
    }

    /// Position, speed and the powers 1, s, … as one linear system, whose exponential is exact.
    fn exact<const S: usize>(rate: f64, c: f64, speed: f64, powers: &[f64; S]) -> [f64; 2] {
        let mut columns = vec![vec![0.0; S + 2]; S + 2];
        columns[1][0] = 1.0;
        columns[1][1] = -rate;
        for k in 0..S {
            // f = Σ p_k s^k with the derivatives of s^k chained.
            columns[2 + k][1] = powers[k];
            if k + 1 < S {
                columns[2 + k][2 + k + 1] = (k + 1) as f64;
            }
        }
        let flow = exponential(&Dense::from_columns(&columns).scaled(c));
        [0, 1].map(|row| flow[(row, 1)] * speed + flow[(row, 2)])
    }

    fn check<const S: usize>() {
        let scheme = Scheme::<S>::gauss();
        let (speed, powers): (f64, [f64; S]) = (0.7, std::array::from_fn(|k| [1.3, -2.0, 0.9, 1.7][k]));
        let at = |s: f64| powers.iter().rev().fold(0.0, |sum, p: &f64| sum * s + p);
        let f = scheme.nodes.map(at);
        for rate in RATES {
            let damped = Damped::new(&scheme, rate);
            let stage = |i: usize| Reach {
                decay: damped.decay[i],
                drift: damped.drift[i],
                once: damped.once.row(i),
                twice: damped.twice.row(i),
            };
            let reaches = scheme.nodes.iter().zip((0..S).map(stage)).chain([(1.0, damped.end)]);
            for (i, (c, reach)) in reaches.enumerate() {
                let got =
                    [reach.drift * speed + reach.twice.dot(&f), reach.decay * speed + reach.once.dot(&f)];
                let mut expected = exact(rate, c, speed, &powers);
                if rate < 1.0 && i < S {
                    let speeds = scheme.nodes.map(|c| exact(rate, c, speed, &powers)[1]);
                    expected[0] = scheme.once.row(i).dot(&speeds);
                }
                // Squaring the exponential of the oracle loses bits.
                for (got, expected) in got.iter().zip(expected) {
                    assert!(
                        (got - expected).abs() < 1e-12 * (1.0 + rate).sqrt(),
                        "{rate}, {c}: {got} {expected}"
                    );
                }
            }
            for i in 0..S {
                let here = |s: f64| scheme.at(s)[i];
                let moved = |s: f64| Reach::new(&scheme, rate, s);
                let of_speed = integral(rate, |s| here(s) * moved(s).decay);
                assert!((damped.work_of_speed[i] - of_speed).abs() < 1e-11, "{rate}: {of_speed}");
                let of_f = integral(rate, |s| here(s) * moved(s).once.dot(&f));
                assert!((damped.work.row(i).dot(&f) - of_f).abs() < 1e-11, "{rate}: {of_f}");
                let mean = of_speed / scheme.weights[i] - (-rate * scheme.nodes[i]).exp();
                let felt = if rate < 1.0 { 0.0 } else { mean };
                assert!((damped.excess[i] - felt).abs() < 1e-10, "{rate}: {felt}");
            }
            let defect = |s: f64| scheme.nodes.iter().fold(1.0, |product, c| product * (c - s) / c);
            let at_end = integral(rate, |s| (-rate * (1.0 - s)).exp() * defect(s));
            let error = (at_end * damped.end.drift).abs();
            assert!((damped.error_of_defect - error).abs() < 1e-12, "{rate}: {error}");
        }
    }

    #[test]
    fn a_damped_motor_moves_as_the_exponential_says() {
        check::<2>();
        check::<4>();
    }

    #[test]
    fn without_a_damper_it_is_collocation() {
        let scheme = Scheme::<4>::gauss();
        let Damped { once, end, twice, .. } = Damped::new(&scheme, 0.0);
        for i in 0..4 {
            let differences = [once.row(i) - scheme.once.row(i), twice.row(i) - scheme.twice.row(i)];
            assert!(differences.iter().flat_map(Vector::iter).all(|x| x.abs() < 1e-14), "{differences:?}");
        }
        let differences = [end.once - scheme.weights, end.twice - scheme.end_twice];
        assert!(differences.iter().flat_map(Vector::iter).all(|x| x.abs() < 1e-14), "{differences:?}");
    }
}
