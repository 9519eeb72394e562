//! The contraction rate in a metric that counts position errors for more where tanh is flat, [`Stretch`]: of any two solutions while both
//! have position errors in the region and velocity errors up to a bound.
//!
//! With P = Π r² in place of Π the coupling does not cancel any more: what is left of it couples, joint by joint, δq̃_l with δs_l, and δq̃_m
//! with δs_l and δs_m. Eliminating positions and motor momenta leaves a load on the damping of the links, so that one inequality of the
//! links' momentum block remains, B − diag(load) − β M ≻ 0. The largest errors decide: growth costs most there, and the
//! metric is nowhere farther from Π.
//!
//! The same with the metric of a law whose Π_l itself grows with the error, linear φ included: there Π̇_l takes from the rate.

use flexure_core::contraction::{Stretch, Stretched, StretchedSide};
use flexure_core::control::{Linear, Metric, Tanh};
use flexure_core::linalg::Vector;
use flexure_core::scalar::{Interval, Over, Piecewise, Scalar};

use crate::linalg::Symmetric;
use crate::prove::engine::certificate::{
    CertifiedPhi, DecimalGains, DecimalLaw, DecimalRobot, StretchedClaim, bounds,
};
use crate::prove::engine::momentum;
use crate::prove::engine::number::Number;
use crate::prove::engine::rate::{Inequality, greatest};
use crate::prove::engine::reserve::Reserve;

/// What is asked: a loop with φ = Λ tanh, or Λ q̃, and the errors that both solutions have at most.
#[derive(Clone, Copy, Debug)]
pub struct StretchedQuestion<'a> {
    /// The robot.
    pub robot: &'a DecimalRobot,
    /// The law.
    pub controller: &'a DecimalLaw,
    /// Largest |q̃_i| in rad, links then motors.
    pub error: &'a [Option<Number>],
    /// Largest |s_i| [rad/s], links then motors.
    pub velocity_error: &'a [Number],
    /// Rate that is proved of the links' momentum block [1/s].
    pub block_rate: Interval,
}

/// The position error of one joint on one side.
#[derive(Clone, Copy, Debug)]
struct Side<T> {
    metric: T,
    shaping: T,
    /// Growth of Π with the squared error.
    hardening: Option<T>,
    /// Largest error in rad, where φ is tanh; none where it is linear.
    error: Option<T>,
    /// Fastest drift [rad/s].
    drift: T,
}

impl Side<Interval> {
    fn midpoint(&self) -> Side<f64> {
        let Self { metric, shaping, hardening, error, drift } = self;
        let [metric, shaping, drift] = [metric, shaping, drift].map(|x| x.midpoint());
        let [hardening, error] = [hardening, error].map(|x| x.map(Interval::midpoint));
        Side { metric, shaping, hardening, error, drift }
    }
}

/// What a metric Π (1 + g x²) loses at most, at the error x ≥ 0, of the rate that Π has, where φ ≥ `chord` x: half its relative
/// growth, g x/(1 + g x²), times chord x − drift is least where its derivative vanishes, and is there ½ (c − √(c² + g drift²)).
fn hardening_loss<T: Scalar>(chord: T, drift: T, growth: T) -> T {
    T::from_f64(0.5) * ((chord.square() + growth * drift.square()).sqrt() - chord)
}

impl<T: Over<T> + Piecewise> Side<T> {
    /// What is left of its inequality wherever errors are no larger.
    fn at(&self, exponent: Option<T>) -> Stretched<T> {
        let Self { metric, shaping, hardening, error, drift } = *self;
        let gain = Vector([shaping]);
        let largest = error.unwrap_or(T::ZERO);
        let stretch = exponent.map_or(Stretch::NONE, |b| Stretch::tanh(b, largest));
        let metric = hardening.map_or(metric, |h| metric + h * largest.square());
        let metric = Metric::Constant(Vector([metric]));
        let (mut at, chord) = match error {
            Some(error) => {
                let side = StretchedSide { metric, shaping: &Tanh { gain }, stretch, drift };
                (side.at(error), shaping * error.tanh() / error)
            }
            None => {
                (StretchedSide { metric, shaping: &Linear { gain }, stretch, drift }.at(largest), shaping)
            }
        };
        if let Some(h) = hardening {
            at.rate -= hardening_loss(chord, drift, h / self.metric);
        }
        at
    }
}

/// One joint.
#[derive(Clone, Copy, Debug)]
struct Joint<T> {
    link: Side<T>,
    motor: Side<T>,
    /// K/Π_m: what the link's velocity error moves the motor's position error by.
    coupling: T,
    /// D_m + K_md [N m s/rad].
    damping: T,
    /// M_m [kg m²].
    inertia: T,
}

impl Joint<Interval> {
    fn midpoint(&self) -> Joint<f64> {
        let Self { link, motor, coupling, damping, inertia } = self;
        let [coupling, damping, inertia] = [coupling, damping, inertia].map(|x| x.midpoint());
        Joint { link: link.midpoint(), motor: motor.midpoint(), coupling, damping, inertia }
    }
}

/// A number that may be known to be positive.
trait Sign: Over<Self> + Piecewise {
    fn is_positive(self) -> bool;
}

impl Sign for f64 {
    fn is_positive(self) -> bool {
        self > 0.0
    }
}

impl Sign for Interval {
    fn is_positive(self) -> bool {
        self.lo() > 0.0
    }
}

/// x / 4y where y is positive.
fn quarter<T: Sign>(x: T, y: T) -> Option<T> {
    y.is_positive().then(|| x / (T::from_f64(4.0) * y))
}

impl<T: Sign> Joint<T> {
    /// What the link's position error takes from the damping of the link at the rate `beta` [N m s/rad]; none where it does not contract.
    fn link_load(&self, exponent: Option<T>, beta: T) -> Option<T> {
        let Stretched { rate, mismatch } = self.link.at(exponent);
        quarter(mismatch, rate - beta)
    }

    /// What the motor's errors take.
    fn motor_load(&self, exponent: Option<T>, beta: T) -> Option<T> {
        let Stretched { rate, mismatch } = self.motor.at(exponent);
        let taken = quarter(mismatch, self.damping - beta * self.inertia)?;
        quarter(self.coupling.square() * mismatch, rate - beta - taken)
    }
}

/// The joints of the question, enclosed.
fn joints(question: &StretchedQuestion<'_>) -> Result<Vec<Joint<Interval>>, String> {
    let StretchedQuestion { robot, controller, error, velocity_error, .. } = question;
    let n = robot.joints;
    let flattens = controller.phi == CertifiedPhi::Tanh;
    if velocity_error.len() != 2 * n || flattens && error.iter().any(Option::is_none) {
        return Err("a stretched metric needs a largest error on both sides of every joint".to_owned());
    }
    let speed = bounds(velocity_error);
    let [link, motor] = [&controller.link, &controller.motor];
    let side = |gains: &DecimalGains, i: usize, at: usize, drift| Side {
        metric: gains.metric[i].bounds(),
        shaping: gains.shaping[i].bounds(),
        hardening: gains.hardening.as_ref().map(|h| h[i].bounds()),
        error: error[at].as_ref().filter(|_| flattens).map(Number::bounds),
        drift,
    };
    let joint = |i: usize| {
        let coupling = robot.stiffness[i].bounds() / motor.metric[i].bounds();
        Joint {
            link: side(link, i, i, speed[i]),
            motor: side(motor, i, n + i, speed[n + i] + coupling * speed[i]),
            coupling,
            damping: robot.motor_damping[i].bounds() + motor.damping[i].bounds(),
            inertia: robot.motor_inertia[i].bounds(),
        }
    };
    Ok((0..n).map(joint).collect())
}

/// b of one joint, link and motor; none where nothing is stretched.
type Exponents = [Option<f64>; 2];

/// Largest exponent that is tried: the metric grows as e^(2 b |x|).
const LARGEST_EXPONENT: f64 = 0.99;

/// Exponents of three digits that are tried at once, and how often closer ones are.
const TRIED: u8 = 48;
const ROUNDS: usize = 4;

/// The exponent of the least load, with the load, where sech² of the largest error is `flat`: no smaller one stretches anything.
fn least(flat: f64, load: impl Fn(Option<f64>) -> Option<f64>) -> Option<(Option<f64>, f64)> {
    let of = |b: Option<f64>| load(b).map(|load| (b, load));
    let rounded = |b: f64| format!("{b:.2e}").parse().ok().filter(|b| *b > flat && *b <= LARGEST_EXPONENT);
    let (mut best, mut middle, mut width) =
        (of(None), 0.5 * (flat + LARGEST_EXPONENT), LARGEST_EXPONENT - flat);
    for _ in 0..ROUNDS {
        let places = (0..=TRIED).map(|k| middle + width * (f64::from(k) / f64::from(TRIED) - 0.5));
        let found = places.filter_map(rounded).filter_map(|b| of(Some(b)));
        best = found.chain(best).min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((Some(b), _)) = best else { return best };
        (middle, width) = (b, width * 4.0 / f64::from(TRIED));
    }
    best
}

/// The links' momentum block under loads.
struct Links {
    damping: Vec<Interval>,
    masses: Vec<Symmetric<Interval>>,
}

impl Links {
    /// Whether B − diag(`loads`) − β M is positive definite for all q.
    fn bear(&self, loads: &[Interval], beta: Interval) -> bool {
        let left: Vec<Interval> = self.damping.iter().zip(loads).map(|(&d, &load)| d - load).collect();
        let inequality = |weight: &Symmetric<Interval>| Inequality {
            form: Symmetric::diagonal(&left),
            weight: weight.clone(),
        };
        self.masses.iter().all(|weight| inequality(weight).margin(beta) > 0.0)
    }
}

/// By how much the search in floats may miss the largest rate, relatively.
const SEARCH: f64 = 1e-5;

/// The largest rate for the best exponents, less what `reserve` leaves unclaimed.
///
/// # Errors
/// The reason in words, if no positive rate could be shown.
pub fn claim(question: &StretchedQuestion<'_>, reserve: Reserve) -> Result<StretchedClaim, String> {
    let joints = joints(question)?;
    let StretchedQuestion { robot, controller, velocity_error, block_rate, .. } = question;
    let damping = momentum::damping(&robot.link_damping, &controller.link.damping);
    let masses = momentum::upper_masses(&robot.links, &damping, *block_rate);
    let links = Links { damping, masses };
    let floats: Vec<Joint<f64>> = joints.iter().map(Joint::midpoint).collect();
    let best = |beta: f64| -> Option<Vec<Exponents>> {
        // A slope that does not flatten needs no stretch.
        let flat = |side: &Side<f64>| side.error.map_or(1.0, |error| error.cosh().powi(-2));
        let of = |joint: &Joint<f64>| {
            let (link, link_load) = least(flat(&joint.link), |b| joint.link_load(b, beta))?;
            let (motor, motor_load) = least(flat(&joint.motor), |b| joint.motor_load(b, beta))?;
            Some(([link, motor], Interval::point(link_load + motor_load)))
        };
        let (exponents, loads): (Vec<_>, Vec<_>) = floats.iter().map(of).collect::<Option<_>>()?;
        links.bear(&loads, Interval::point(beta)).then_some(exponents)
    };
    let nothing = || "no positive rate in a stretched metric could be shown".to_owned();
    let exponents = greatest(|beta| best(beta).is_some(), SEARCH).and_then(best).ok_or_else(nothing)?;

    let enclosed = |b: f64| Number::decimal(b).bounds();
    let holds = |beta: Interval| {
        let of = |(joint, [link, motor]): (&Joint<Interval>, &Exponents)| {
            let link = joint.link_load(link.map(enclosed), beta)?;
            Some(link + joint.motor_load(motor.map(enclosed), beta)?)
        };
        let loads: Option<Vec<_>> = joints.iter().zip(&exponents).map(of).collect();
        loads.is_some_and(|loads| links.bear(&loads, beta))
    };
    let largest = greatest(|beta| holds(Interval::point(beta)), reserve.relative()).ok_or_else(nothing)?;
    let rate = Number::below(largest * (1.0 - reserve.relative()));
    if !holds(rate.bounds()) {
        return Err(nothing());
    }
    let side = |k: usize| exponents.iter().map(move |of| of[k].map(Number::decimal));
    Ok(StretchedClaim {
        velocity_error: velocity_error.to_vec(),
        exponent: side(0).chain(side(1)).collect(),
        rate,
    })
}
