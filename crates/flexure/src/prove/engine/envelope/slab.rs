//! What the robot may do in the tube over a slab of time, by Taylor's theorem.
//!
//! On the reference, what is asked for at a time t of the slab follows from value and slope at its middle and from the second
//! derivative over all of it. From there to any error x̃ in the tube it changes by g·x̃, with derivatives g taken somewhere
//! on the way. Positions and velocities of the motors, which the law's derivatives depend on, are enclosed in the same manner
//! first. How fast the torque changes in the tube is by its derivatives by time and by the errors, which move as a [`Flow`] says.

use std::sync::Arc;

use flexure_core::scalar::{Interval, Jet, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::envelope::Bounded;
use crate::prove::engine::envelope::closed_loop::{Answer, Place, Slope, TrackingLoop};
use crate::prove::engine::envelope::flow::Flow;
use crate::prove::engine::envelope::tube::{ErrorTube, Tube};

/// Quantities per joint that are bounded, in the order of a slab's ranges: those of all joints, one quantity after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoundedQuantity {
    /// Link velocity q̇_l [rad/s].
    Velocity,
    /// Deflection of the spring q_m − q_l in rad.
    Deflection,
    /// Motor torque u_m [N m].
    Torque,
}

/// Every quantity, in the order of limits and ranges.
pub const QUANTITIES: [BoundedQuantity; 3] =
    [BoundedQuantity::Velocity, BoundedQuantity::Deflection, BoundedQuantity::Torque];

/// The tube over a slab of time.
#[derive(Clone, Debug)]
pub struct Slab {
    /// Times that the slab covers in s.
    pub time: Interval,
    /// The errors.
    pub tube: Arc<dyn Tube>,
    /// The quantities on the reference at the middle.
    pub nominal: Vec<Interval>,
    /// Their derivatives by the errors q̃_l, q̃_m, s_l, s_m: a row per quantity, a column per error.
    pub gradients: Dense<Interval>,
    /// Ranges of the quantities over slab and tube.
    pub ranges: Vec<Interval>,
    /// Their derivatives by time [1/s] on the reference at the middle.
    pub nominal_drifts: Vec<Interval>,
    /// The same at errors that stay as they are, over slab and tube; anything where they may jump.
    pub drifts: Vec<Interval>,
}

impl Slab {
    /// The tube of level `level` in J over the times `time` in s.
    ///
    /// # Panics
    /// Never: nothing breaks it off.
    pub fn new(system: &dyn TrackingLoop, level: f64, time: Interval) -> Self {
        Self::watched(system, level, time, &|| true).expect("it goes on")
    }

    /// As [`new`](Self::new), which takes a third of a second for seven joints; none if it no longer `goes_on`.
    pub fn watched(
        system: &dyn TrackingLoop,
        level: f64,
        time: Interval,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<Self> {
        let q_ld: Vec<_> = system.reference(time).iter().map(|jet| jet[0]).collect();
        Self::of(system, Arc::new(ErrorTube::new(system, level, &q_ld)), time, goes_on)
    }

    /// The errors of `tube` over the times `time` in s; none if it no longer `goes_on`.
    pub fn of(
        system: &dyn TrackingLoop,
        tube: Arc<dyn Tube>,
        time: Interval,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<Self> {
        let way = Way { drifts: true, ..Way::new(system, &*tube, &system.reference(time), time, goes_on) };
        let (q_m, v_m) = way.motors(system)?;
        let all = way.along(&|seed| {
            let (q_m, v_m) = (q_m.at(seed), v_m.at(seed));
            let (q_l, v_l) = seed.links(system);
            [v_l, differences(&q_m, &q_l), seed.answer(system, &q_m, &v_m).u_m].concat()
        })?;
        let nominal = all.middle.iter().map(|x| x.coefficient(0)).collect();
        let nominal_drifts = all.middle.iter().map(|x| x.coefficient(1)).collect();
        let drifts = (0..all.ranges.len()).map(|k| way.drift(&all, k)).collect();
        Some(Self {
            time,
            nominal,
            gradients: all.gradients,
            ranges: all.ranges,
            nominal_drifts,
            drifts,
            tube,
        })
    }

    /// How fast quantity `k` may change [1/s] where errors move as `flow`, over this slab and tube, says: by time alone, and with the errors.
    pub fn rates(&self, k: usize, flow: &Flow) -> [Interval; 2] {
        [self.drifts[k], flow.along(self.gradients.row(k), &*self.tube, self.time)]
    }
}

impl Bounded for Slab {
    fn time(&self) -> Interval {
        self.time
    }

    fn quantities(&self) -> usize {
        self.ranges.len()
    }

    fn bound(&self, k: usize) -> f64 {
        self.ranges[k].magnitude()
    }

    /// At the slab's middle, as far as its derivatives are known.
    fn seen(&self, k: usize) -> f64 {
        let near_zero = |g: &Interval| Interval::point(g.lo().max(0.0) + g.hi().min(0.0));
        let gradient: Vec<_> = self.gradients.row(k).iter().map(near_zero).collect();
        self.nominal[k].midpoint().abs() + self.tube.reach(&gradient).hi()
    }
}

/// Errors that are looked at together with time move so fast [per s]: what intervals leave open of second derivatives by time and by errors then counts
/// about the same.
const TOGETHER: f64 = 10.0;

/// How smooth the reference is over a slab.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Smooth {
    /// The torque may jump.
    Not,
    /// The torque is continuous, its rate may jump.
    Once,
    /// Torque and rate are continuous.
    Twice,
}

impl Smooth {
    fn over(system: &dyn TrackingLoop, time: Interval) -> Self {
        let meets = |times: &[Interval]| times.iter().any(|at| at.intersection(time).is_some());
        match (meets(system.breaks()), meets(system.kinks())) {
            (true, _) => Self::Not,
            (_, true) => Self::Once,
            _ => Self::Twice,
        }
    }
}

/// Taylor coefficients of a reference over a slab, from those over it and in its `middle`: each is what it is there and `offset` in s times
/// its slope, if it is continuous.
fn tightened(all: &[Interval; 7], middle: &[Interval; 7], smooth: Smooth, offset: Interval) -> [Interval; 7] {
    let continuous = match smooth {
        Smooth::Not => 4,
        Smooth::Once => 5,
        Smooth::Twice => 6,
    };
    let mut tight = *all;
    for k in (0..continuous).rev() {
        let linear = middle[k] + tight[k + 1] * Interval::point((k + 1) as f64) * offset;
        tight[k] = linear.intersection(all[k]).unwrap_or(all[k]);
    }
    tight
}

/// Where numbers are looked at, and by what they are differentiated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum View {
    /// On the reference at the middle of the slab, by time.
    Middle,
    /// On the reference over the slab, by time.
    Track,
    /// Over slab and tube, by this error.
    Tube(usize),
    /// Over slab and tube, by nothing.
    Everywhere,
    /// Over slab and tube, by time.
    Drift,
    /// Over slab and tube, by time and this error together.
    DriftAnd(usize),
}

/// Reference and errors in a view.
pub(super) struct Seeded {
    pub(super) q_ld: Vec<[Slope; 5]>,
    errors: Vec<Slope>,
    view: View,
}

impl Seeded {
    /// q̃_l, q̃_m, s_l or s_m.
    fn part(&self, which: usize) -> &[Slope] {
        let n = self.q_ld.len();
        &self.errors[which * n..(which + 1) * n]
    }

    /// q_l = q_ld + q̃_l and q̇_l = q̇_ld − φ_l(q̃_l) + s_l.
    pub(super) fn links(&self, system: &dyn TrackingLoop) -> (Vec<Slope>, Vec<Slope>) {
        let order = |k: usize| self.q_ld.iter().map(|jet| jet[k]).collect::<Vec<_>>();
        let v_lr = differences(&order(1), &system.approach(self.part(0)));
        (sums(&order(0), self.part(0)), sums(&v_lr, self.part(2)))
    }

    pub(super) fn answer(&self, system: &dyn TrackingLoop, q_m: &[Slope], v_m: &[Slope]) -> Answer {
        let (q_l, v_l) = self.links(system);
        system.command(&Place { q_l, q_m: q_m.to_vec(), v_l, v_m: v_m.to_vec() }, &self.q_ld)
    }
}

/// From the reference to everywhere in the slab's tube.
pub(super) struct Way<'a> {
    n: usize,
    smooth: Smooth,
    /// The reference at the middle.
    middle: Vec<[Interval; 7]>,
    /// The reference over the slab.
    all: Vec<[Interval; 7]>,
    /// t − t_c in s.
    pub(super) offset: Interval,
    /// The box around the tube.
    errors: Vec<Interval>,
    tube: &'a dyn Tube,
    /// Whether derivatives by time are looked at over the tube, too.
    drifts: bool,
    /// Whether somebody waits for it.
    goes_on: &'a dyn Fn() -> bool,
}

/// Numbers in all views.
pub(super) struct Views {
    middle: Vec<Slope>,
    pub(super) track: Vec<Slope>,
    /// Their ranges over slab and tube.
    pub(super) ranges: Vec<Interval>,
    /// How far they are there from their lines in time.
    pub(super) beside: Vec<Interval>,
    /// Their derivatives by the errors: a row per number.
    pub(super) gradients: Dense<Interval>,
    /// How they drift; none where nobody looks at that.
    drifting: Option<Drifting>,
}

/// Numbers over slab and tube as series.
struct Drifting {
    /// By time.
    time: Vec<Slope>,
    /// By each error.
    errors: Vec<Vec<Slope>>,
    /// By time and each error together.
    both: Vec<Vec<Slope>>,
}

impl<'a> Way<'a> {
    pub(super) fn new(
        system: &dyn TrackingLoop,
        tube: &'a dyn Tube,
        jets: &[[Interval; 7]],
        time: Interval,
        goes_on: &'a dyn Fn() -> bool,
    ) -> Self {
        let at = Interval::point(time.midpoint());
        let (smooth, middle, offset) = (Smooth::over(system, time), system.reference(at), time - at);
        Self {
            n: system.joints(),
            all: jets
                .iter()
                .zip(&middle)
                .map(|(all, middle)| tightened(all, middle, smooth, offset))
                .collect(),
            smooth,
            middle,
            offset,
            errors: tube.errors(),
            tube,
            drifts: false,
            goes_on,
        }
    }

    /// Positions of the links in rad.
    pub(super) fn links(&self, system: &dyn TrackingLoop) -> Vec<Interval> {
        self.seeded(View::Everywhere).links(system).0.iter().map(|q| q.coefficient(0)).collect()
    }

    /// Positions and velocities of the motors.
    pub(super) fn motors(&self, system: &dyn TrackingLoop) -> Option<(Views, Views)> {
        // The law wants motor positions and velocities where it tells what they should be: what it tells does not depend
        // on them, so that any will do.
        let nothing = vec![Slope::ZERO; self.n];
        let q_m = self.along(&|seed| {
            let answer = seed.answer(system, &nothing, &nothing);
            sums(&answer.q_md, seed.part(1))
        })?;
        let v_m = self.along(&|seed| {
            let answer = seed.answer(system, &q_m.at(seed), &nothing);
            sums(&differences(&nothing, &answer.s_m), seed.part(3))
        })?;
        Some((q_m, v_m))
    }

    pub(super) fn seeded(&self, view: View) -> Seeded {
        let jets = if view == View::Middle { &self.middle } else { &self.all };
        // Coefficient k at t + τ is Σ_j C(k + j, j) c_(k+j) τʲ.
        let in_time = |jet: &[Interval; 7], k: usize| match view {
            View::Tube(_) | View::Everywhere => Slope::value(jet[k]),
            _ => Jet::new([
                jet[k],
                jet[k + 1] * Interval::point((k + 1) as f64),
                jet[k + 2] * Interval::point(((k + 1) * (k + 2) / 2) as f64),
            ]),
        };
        let error = |(i, &error): (usize, &Interval)| match view {
            View::Tube(direction) if i == direction => Slope::variable(error),
            View::DriftAnd(direction) if i == direction => {
                Jet::new([error, Interval::point(TOGETHER), Interval::ZERO])
            }
            View::Tube(_) | View::Everywhere | View::Drift | View::DriftAnd(_) => Slope::value(error),
            _ => Slope::ZERO,
        };
        Seeded {
            q_ld: jets.iter().map(|jet| std::array::from_fn(|k| in_time(jet, k))).collect(),
            errors: self.errors.iter().enumerate().map(error).collect(),
            view,
        }
    }

    /// The numbers that `f` makes, over the tube and the slab; none if nobody waits for them.
    pub(super) fn along(&self, f: &dyn Fn(&Seeded) -> Vec<Slope>) -> Option<Views> {
        let middle = f(&self.seeded(View::Middle));
        let track = f(&self.seeded(View::Track));
        let track: Vec<_> =
            middle.iter().zip(track).map(|(middle, track)| self.expanded(middle, &track)).collect();
        let pass = |i| (self.goes_on)().then(|| f(&self.seeded(View::Tube(i))));
        let passes = (0..4 * self.n).map(pass).collect::<Option<Vec<Vec<Slope>>>>()?;
        let gradients = Dense::from_fn(track.len(), passes.len(), |k, i| passes[i][k].coefficient(1));
        let range = |(k, gradient): (usize, &[Interval])| {
            let mean = track[k].coefficient(0) + self.tube.reach(gradient);
            // Both enclose it.
            mean.intersection(passes[0][k].coefficient(0)).unwrap_or(mean)
        };
        let ranges: Vec<_> = gradients.rows().enumerate().map(range).collect();
        let beside = |(k, gradient): (usize, &[Interval])| {
            let [at, rate] = line(&middle[k]).map(Interval::point);
            let bent = self.bent(&middle[k], &track[k]) + self.tube.reach(gradient);
            bent.intersection(ranges[k] - at - rate * self.offset).unwrap_or(bent)
        };
        let beside = gradients.rows().enumerate().map(beside).collect();
        let drifting = if self.drifts { Some(self.drifting(f, passes, &ranges)?) } else { None };
        Some(Views { middle, track, ranges, beside, gradients, drifting })
    }

    /// The numbers that `f` makes, of these `ranges`, as series by time and by the errors; `passes` are what it makes by each error.
    fn drifting(
        &self,
        f: &dyn Fn(&Seeded) -> Vec<Slope>,
        passes: Vec<Vec<Slope>>,
        ranges: &[Interval],
    ) -> Option<Drifting> {
        let known = |all: Vec<Slope>| -> Vec<Slope> {
            let known =
                |(x, &range): (Slope, &Interval)| Jet::new([range, x.coefficient(1), x.coefficient(2)]);
            all.into_iter().zip(ranges).map(known).collect()
        };
        let both = |i| (self.goes_on)().then(|| known(f(&self.seeded(View::DriftAnd(i)))));
        Some(Drifting {
            time: known(f(&self.seeded(View::Drift))),
            both: (0..passes.len()).map(both).collect::<Option<_>>()?,
            errors: passes.into_iter().map(known).collect(),
        })
    }

    /// The derivative by time of number `k` of `views` at errors that stay as they are, over slab and tube: what it is on the reference, and how that changes
    /// with the errors. That is the mixed derivative: half the second one in both directions together, less half of that in each.
    fn drift(&self, views: &Views, k: usize) -> Interval {
        let Some(Drifting { time, errors, both }) = &views.drifting else { return Interval::ENTIRE };
        if self.smooth == Smooth::Not {
            return Interval::ENTIRE;
        }
        let half = |all: &[Slope]| all[k].coefficient(2);
        let rate = Interval::point(TOGETHER);
        let mixed: Vec<_> = both
            .iter()
            .zip(errors)
            .map(|(both, error)| (half(both) - half(time) - half(error) * rate.square()) / rate)
            .collect();
        let mean = views.track[k].coefficient(1) + self.tube.reach(&mixed);
        // Both enclose it.
        mean.intersection(time[k].coefficient(1)).unwrap_or(mean)
    }

    /// How far a number on the reference over the slab is from its line in time.
    fn bent(&self, middle: &Slope, track: &Slope) -> Interval {
        let [value, slope, curvature] = [0, 1, 2].map(|k| track.coefficient(k));
        let [at, rate] = line(middle).map(Interval::point);
        let off = middle.coefficient(0) - at;
        match self.smooth {
            Smooth::Not => value - at - rate * self.offset,
            Smooth::Once => off + (slope - rate) * self.offset,
            Smooth::Twice => {
                off + (middle.coefficient(1) - rate) * self.offset + curvature * self.offset.square()
            }
        }
    }

    /// A number on the reference over the slab: what its evaluation there says, and what follows from the middle.
    fn expanded(&self, middle: &Slope, track: &Slope) -> Slope {
        let both = |a: Interval, b: Interval| a.intersection(b).unwrap_or(a);
        let [value, slope, curvature] = [0, 1, 2].map(|k| track.coefficient(k));
        let [at, rate] = [0, 1].map(|k| middle.coefficient(k));
        match self.smooth {
            Smooth::Not => *track,
            Smooth::Once => Jet::new([both(at + slope * self.offset, value), slope, curvature]),
            Smooth::Twice => {
                let linear = rate + curvature * self.offset * Interval::point(2.0);
                let slope = both(linear, slope);
                let first = both(
                    at + rate * self.offset + curvature * self.offset.square(),
                    at + slope * self.offset,
                );
                Jet::new([both(first, value), slope, curvature])
            }
        }
    }
}

/// Value and rate at the middle of the slab of a straight line in time near a number on the reference.
fn line(middle: &Slope) -> [f64; 2] {
    [0, 1].map(|k| middle.coefficient(k).midpoint())
}

impl Views {
    /// Value and rate at the middle of the slab of number `k`'s line in time.
    pub(super) fn line(&self, k: usize) -> [f64; 2] {
        line(&self.middle[k])
    }

    /// The numbers in the view of `seed`.
    pub(super) fn at(&self, seed: &Seeded) -> Vec<Slope> {
        match seed.view {
            View::Middle => self.middle.clone(),
            View::Track => self.track.clone(),
            View::Everywhere => self.ranges.iter().map(|&x| Slope::value(x)).collect(),
            View::Drift => self.drifting.as_ref().map_or_else(Vec::new, |all| all.time.clone()),
            View::DriftAnd(i) => self.drifting.as_ref().map_or_else(Vec::new, |all| all.both[i].clone()),
            View::Tube(i) if let Some(all) = &self.drifting => all.errors[i].clone(),
            View::Tube(i) => {
                let slopes = self.gradients.rows().map(|gradient| gradient[i]);
                self.ranges
                    .iter()
                    .zip(slopes)
                    .map(|(&x, slope)| Jet::new([x, slope, Interval::ZERO]))
                    .collect()
            }
        }
    }
}

fn sums(a: &[Slope], b: &[Slope]) -> Vec<Slope> {
    a.iter().zip(b).map(|(&a, &b)| a + b).collect()
}

pub(super) fn differences(a: &[Slope], b: &[Slope]) -> Vec<Slope> {
    a.iter().zip(b).map(|(&a, &b)| a - b).collect()
}
