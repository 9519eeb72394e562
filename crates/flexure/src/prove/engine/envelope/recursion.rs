//! Ellipsoids that follow a flow, in floats: they suggest, and never prove.
//!
//! Ẋ = A X + X Aᵀ + Σ α X + Σ (D²/α + τ) n nᵀ + Σ X c cᵀ X / τ, sums over what drives the errors and over the numbers of each. The multipliers α and τ are free; they
//! are taken where the link errors of the X that stays are least: with S from the adjoint equation the derivatives of tr(E X Eᵀ) by them
//! are zero at α = D √(nᵀ S n / tr(S X)) and τ = √(cᵀ X S X c / nᵀ S n). Kurzhanski & Vályi, *Ellipsoidal Calculus for Estimation and
//! Control* (1997), chapter 3; Boyd et al., *Linear Matrix Inequalities in System and Control Theory* (1994), section 6.1.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Leading, Symmetric, cholesky, eigenvectors, lower_inverse, lyapunov};
use crate::prove::engine::envelope::flow::{Channel, Flow};
use crate::prove::engine::envelope::shape::Shape;

/// Weights of what drives the errors: the channels of a flow, and then what it leaves open of each error.
#[derive(Clone, Debug, PartialEq)]
pub struct Multipliers {
    /// α [1/s], above 0; 0 where nothing constant drives.
    pub alpha: Vec<f64>,
    /// τ, above 0; 0 where nothing depends on the errors.
    pub tau: Vec<f64>,
    /// Of what the ellipsoid grows by, the part that is for what numbers leave open.
    pub open: f64,
}

/// Multipliers are found by so many fixed-point steps.
const STEPS: usize = 8;

/// α is halved so often to find some for which something stays.
const HALVINGS: usize = 12;

/// The first guess of the sum of all α [1/s].
const FIRST: f64 = 1.0;

/// Σ α is at least this [1/s] where something stays with it: where next to nothing drives, errors beyond are to come back all the same.
const LEAST: f64 = 1.0;

/// X of directions that nothing drives, over that of the ellipsoid nearby.
const UNDRIVEN: f64 = 1e-6;

/// A flow at a time, in the coordinates of an ellipsoid, in which that is the unit ball.
struct Scaled {
    matrix: Dense<f64>,
    drives: Vec<Channel>,
    /// q̃_l.
    links: Dense<f64>,
}

impl Multipliers {
    /// Where the link errors of the X that stays are least, and that X: of `flow` as it stands around an ellipsoid of about the size of
    /// `near`, from `start` on; none if nothing stays.
    pub fn best(flow: &Flow, near: &Shape, start: Option<&Self>) -> Option<(Self, Shape)> {
        // Near what just stays the last ones may lead too far out.
        Self::from(flow, near, start).or_else(|| start.and_then(|_| Self::from(flow, near, None)))
    }

    fn from(flow: &Flow, near: &Shape, start: Option<&Self>) -> Option<(Self, Shape)> {
        let scaled = Scaled::new(flow, near, flow.time);
        let first = Self::first(&scaled);
        let mut found =
            start.filter(|start| start.alpha.len() == scaled.drives.len()).unwrap_or(&first).clone();
        let mut x = Dense::zeros(near.size(), near.size());
        let mut last = x.clone();
        let unit = Dense::identity(near.size());
        let links = &scaled.links.transposed() * &scaled.links;
        for step in 0..STEPS {
            let mut both = None;
            for _ in 0..HALVINGS {
                let matrix = scaled.effective(&found, &x);
                both = lyapunov(&matrix, &scaled.source(&found)).zip(lyapunov(&matrix.transposed(), &links));
                if both.is_some() {
                    break;
                }
                found.alpha.iter_mut().for_each(|alpha| *alpha *= 0.5);
            }
            let (stays, adjoint) = both?;
            last = stays.clone();
            // Where less stays than there is, what there is counts.
            x = if product_trace(&stays, &adjoint) > product_trace(&unit, &adjoint) {
                stays
            } else {
                unit.clone()
            };
            if step + 1 < STEPS {
                // The first guess knows nothing of the sizes.
                let guessed = step == 0 && start.is_none();
                found = scaled.stationary(&found, if guessed { 1.0 } else { 0.5 }, &x, &adjoint)?;
            }
        }
        // Where little drives, some directions are not driven at all.
        Some((found, shaped(near, &(&last + &unit.scaled(UNDRIVEN)))?))
    }

    /// α in equal parts, τ of 1 in scaled coordinates.
    fn first(scaled: &Scaled) -> Self {
        let share = FIRST / scaled.drives.len().max(1) as f64;
        let of = |value: fn(&Channel) -> f64| scaled.drives.iter().map(value).collect::<Vec<_>>();
        let alpha = of(|drive| if drive.size > 0.0 { 1.0 } else { 0.0 }).iter().map(|x| x * share).collect();
        let length = |rows: &[Vec<f64>]| rows.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
        let ratio = |drive: &Channel| {
            if drive.slopes.is_empty() { 0.0 } else { length(&drive.slopes) / length(&drive.columns) }
        };
        let tau = scaled.drives.iter().map(ratio);
        Self { alpha, tau: tau.collect(), open: 1.0 }
    }

    /// Σ α.
    pub fn growth(&self) -> f64 {
        self.alpha.iter().sum()
    }

    /// Σ α from below [1/s]: the rate at which V − 1 falls.
    pub fn rate(&self) -> f64 {
        self.alpha.iter().fold(Interval::ZERO, |sum, &alpha| sum + Interval::point(alpha)).lo()
    }
}

/// What drives the errors of `flow`: its channels, and then what it leaves open of each.
pub fn drives(flow: &Flow) -> Vec<Channel> {
    let n = flow.rest.len();
    let open = flow.rest.iter().enumerate().filter(|(_, rest)| **rest > 0.0).map(|(i, &size)| {
        let column = (0..n).map(|k| if k == i { 1.0 } else { 0.0 }).collect();
        Channel {
            cause: flow.causes + i,
            columns: vec![column],
            drifts: Vec::new(),
            size,
            slopes: Vec::new(),
            is_open: true,
        }
    });
    flow.channels.iter().cloned().chain(open).collect()
}

impl Scaled {
    /// At the time `t` in s.
    fn new(flow: &Flow, shape: &Shape, t: f64) -> Self {
        let (lower, n) = (&shape.lower, shape.size());
        let matrix = &flow.matrix + &flow.drift.scaled(t - flow.time);
        let inverse = lower_inverse(lower);
        let late = Interval::point(t - flow.time);
        let through = |column: &[Interval]| {
            (0..n).map(|i| (0..=i).map(|k| inverse[(i, k)] * column[k].midpoint()).sum()).collect()
        };
        let seen = |row: &[f64]| (0..n).map(|j| (j..n).map(|k| row[k] * lower[(k, j)]).sum()).collect();
        let scaled = |drive: Channel| Channel {
            cause: drive.cause,
            columns: drive.at(late).iter().map(|column| through(column)).collect(),
            drifts: Vec::new(),
            size: drive.size,
            is_open: drive.is_open,
            slopes: drive.slopes.iter().map(|slope| seen(slope)).collect(),
        };
        Self {
            matrix: &(&inverse * &matrix) * lower,
            drives: drives(flow).into_iter().map(scaled).collect(),
            links: lower.slice(0..n / 4),
        }
    }

    /// A + ½ Σ α + ½ Σ X c cᵀ / τ.
    fn effective(&self, with: &Multipliers, x: &Dense<f64>) -> Dense<f64> {
        let n = self.matrix.columns();
        let growth = 0.5 * with.growth();
        let mut matrix = Dense::from_fn(n, n, |i, j| self.matrix[(i, j)] + if i == j { growth } else { 0.0 });
        for (drive, tau) in self.drives.iter().zip(&with.tau) {
            for slope in &drive.slopes {
                let pulled = times(x, slope);
                for i in 0..n {
                    for j in 0..n {
                        matrix[(i, j)] += 0.5 * pulled[i] * slope[j] / tau;
                    }
                }
            }
        }
        matrix
    }

    /// Σ (D²/α + τ) n nᵀ.
    fn source(&self, with: &Multipliers) -> Dense<f64> {
        let n = self.matrix.columns();
        let mut source = Dense::zeros(n, n);
        for (k, drive) in self.drives.iter().enumerate() {
            let weight = weight(drive.size, with.alpha[k], with.tau[k]);
            for column in &drive.columns {
                for i in 0..n {
                    for j in 0..n {
                        source[(i, j)] += weight * column[i] * column[j];
                    }
                }
            }
        }
        source
    }

    /// The multipliers at which the derivatives are zero with these X and S, or `part` of the way there from `before`.
    fn stationary(
        &self,
        before: &Multipliers,
        part: f64,
        x: &Dense<f64>,
        adjoint: &Dense<f64>,
    ) -> Option<Multipliers> {
        let trace = product_trace(x, adjoint);
        let on_the_way = |before: f64, now: f64| {
            if now > 0.0 { before.powf(1.0 - part) * now.powf(part) } else { before }
        };
        // By what is known and by what is left open [1/s]: α, and √(nᵀ S n · cᵀ X S X c) over tr(S X).
        let mut grows = [0.0, 0.0];
        let one = |(k, drive): (usize, &Channel)| {
            let seen = |v: &[f64]| dot(v, &times(adjoint, v));
            let felt: f64 = drive.columns.iter().map(|column| seen(column)).sum();
            let alpha = drive.size * (felt / trace).sqrt();
            let pulled: f64 = drive.slopes.iter().map(|slope| seen(&times(x, slope))).sum();
            let tau = if drive.slopes.is_empty() { 0.0 } else { (pulled / felt).sqrt() };
            grows[usize::from(drive.is_open)] += alpha + (felt * pulled).sqrt() / trace;
            (on_the_way(before.alpha[k], alpha), on_the_way(before.tau[k], tau))
        };
        let (mut alpha, tau): (Vec<f64>, Vec<f64>) = self.drives.iter().enumerate().map(one).unzip();
        let all: f64 = alpha.iter().sum();
        if 0.0 < all && all < LEAST {
            for alpha in &mut alpha {
                *alpha *= LEAST / all;
            }
        }
        let finite = alpha.iter().chain(&tau).all(|x| x.is_finite());
        let [known, open] = grows;
        let open = if open > 0.0 { open / (open + known) } else { 0.0 };
        finite.then_some(Multipliers { alpha, tau, open })
    }
}

/// How often what an end of a step lacks is added.
const ADDED: usize = 8;

/// Where `flow` leads from `from` over `time`, with `slack` [1/s] more than is needed; none where nothing comes of it.
///
/// With F = Ẋ of the unit ball, and 𝓛 how Ẋ depends on X, each as they are at an end, the ends of the step ask for Ẋ ≥ F and Ẋ − h 𝓛 Ẋ ≥ F. An
/// implicit step has Ẋ − h 𝓛 Ẋ = F + E with E = 0; E grows by what the first asks for.
pub fn next(flow: &Flow, with: &Multipliers, from: &Shape, time: Interval, slack: f64) -> Option<Shape> {
    let ends = [time.lo(), time.hi()];
    let step = ends[1] - ends[0];
    let n = from.size();
    let unit = Dense::identity(n);
    let [begin, end] = ends.map(|t| Scaled::new(flow, from, t));
    let [first, matrix] = [&begin, &end].map(|scaled| scaled.effective(with, &unit));
    let applied = |matrix: &Dense<f64>, x: &Dense<f64>| {
        let moved = matrix * x;
        &moved + &moved.transposed()
    };
    let shifted = &matrix.scaled(step) + &unit.scaled(-0.5);
    let least = &applied(&first, &unit) + &begin.source(with);
    let rate = &applied(&matrix, &unit) + &end.source(with);
    let mut more = unit.scaled(slack);
    for _ in 0..ADDED {
        let found = lyapunov(&shifted, &(&rate + &more))?;
        let missing = parts(&(&found + &least.scaled(-1.0)), |x| (-x).max(0.0));
        if (0..n).all(|i| missing[(i, i)] < 0.1 * slack) {
            return shaped(from, &(&unit + &(&found + &unit.scaled(slack)).scaled(step)));
        }
        let forward = &missing + &applied(&matrix, &missing).scaled(-step);
        more = &more + &parts(&forward, |x| x.max(0.0));
    }
    None
}

/// The ellipsoid that stays as it is where `flow` stands, with `slack` [1/s] more growth than there is; found from `near` on.
pub fn staying(flow: &Flow, with: &Multipliers, near: &Shape, slack: f64) -> Option<Shape> {
    let scaled = Scaled::new(flow, near, flow.time);
    let unit = Dense::identity(near.size());
    let mut x = unit.clone();
    let steps = if scaled.drives.iter().any(|drive| !drive.slopes.is_empty()) { STEPS } else { 1 };
    for _ in 0..steps {
        let matrix = &scaled.effective(with, &x) + &unit.scaled(0.5 * slack);
        x = lyapunov(&matrix, &scaled.source(with))?;
    }
    shaped(near, &(&x + &unit.scaled(UNDRIVEN)))
}

/// By how much `a` has to be wider in every direction to hold `b`, about.
pub fn covering(a: &Shape, b: &Shape) -> f64 {
    let half = &lower_inverse(&a.lower) * &b.lower;
    let mut square = &half * &half.transposed();
    eigenvectors(Leading::whole(&mut square));
    (0..a.size()).map(|i| square[(i, i)]).fold(0.0, f64::max).sqrt()
}

/// An ellipsoid that holds both, about.
pub fn joined(a: &Shape, b: &Shape) -> Option<Shape> {
    let (n, inverse) = (a.size(), lower_inverse(&a.lower));
    let half = &inverse * &b.lower;
    let beyond = &(&half * &half.transposed()) + &Dense::identity(n).scaled(-1.0);
    shaped(a, &(&parts(&beyond, |x| x.max(0.0)) + &Dense::identity(n)))
}

/// D²/α + τ.
pub fn weight(size: f64, alpha: f64, tau: f64) -> f64 {
    if size > 0.0 { size * size / alpha + tau } else { tau }
}

/// The matrix with the eigenvectors of `a` and its eigenvalues through `f`.
fn parts(a: &Dense<f64>, f: impl Fn(f64) -> f64) -> Dense<f64> {
    let n = a.columns();
    let mut diagonal = a.clone();
    let vectors = eigenvectors(Leading::whole(&mut diagonal));
    Dense::from_fn(n, n, |i, j| (0..n).map(|k| vectors[(i, k)] * f(diagonal[(k, k)]) * vectors[(j, k)]).sum())
}

/// L C with C Cᵀ = `x`, L that of `shape`.
fn shaped(shape: &Shape, x: &Dense<f64>) -> Option<Shape> {
    let factor = cholesky(&Symmetric::from_fn(x.columns(), |i, j| x[(i, j)]))?;
    let lower = &shape.lower * &factor;
    Some(Shape { lower })
}

/// tr(A B) of symmetric matrices.
fn product_trace(a: &Dense<f64>, b: &Dense<f64>) -> f64 {
    a.rows().zip(b.rows()).map(|(a, b)| dot(a, b)).sum()
}

fn times(a: &Dense<f64>, x: &[f64]) -> Vec<f64> {
    a.rows().map(|row| dot(row, x)).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
