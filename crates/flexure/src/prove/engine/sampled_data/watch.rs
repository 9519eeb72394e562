//! What a guard and drives do nothing about: motions and torques inside what they let pass.

use std::collections::VecDeque;

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::sampled_data::instant::Instant;
use crate::prove::engine::sampled_data::period::{Before, HeldLoop, Passage};
use crate::prove::engine::sampled_data::spread::{Sizes, Spread};

/// What passes, each from below, per joint; infinite where all does.
#[derive(Clone, Debug)]
pub struct Passes {
    /// Largest torques [N m].
    pub torque: Vec<f64>,
    /// Largest changes of them from one control instant to the next [N m].
    pub torque_step: Vec<f64>,
    /// What readings of positions and velocities are believed, if anything doubts them.
    pub readings: Option<Readings>,
}

/// Readings that are believed, per joint.
#[derive(Clone, Debug)]
pub struct Readings {
    /// Least and largest positions in rad.
    pub position: [Vec<f64>; 2],
    /// Largest speeds [rad/s].
    pub speed: Vec<f64>,
    /// Largest deflections of springs in rad.
    pub deflection: Vec<f64>,
    /// Largest changes of a position from one control instant to the next in rad.
    pub jump: Vec<f64>,
    /// A position that stays the same while another or the reference moves by more than this is doubted, in rad.
    pub travel: f64,
}

/// What may be beyond what passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// A torque.
    Torque,
    /// The change of a torque in a control period.
    TorqueStep,
    /// A reading of a position, on its way up.
    Highest,
    /// Minus a reading of a position, on its way down.
    Lowest,
    /// A velocity.
    Speed,
    /// The deflection of a spring.
    Deflection,
    /// The change of a reading in a control period.
    Jump,
    /// How far the other side of a joint, or the reference, moves while a reading may stay the same.
    Travel,
}

/// A number that may be beyond what passes: which, of what joint, by index, up to where, and what passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beyond {
    /// Which.
    pub limit: Limit,
    /// By index.
    pub joint: usize,
    /// In N m, rad or rad/s.
    pub found: f64,
    /// In the same.
    pub passes: f64,
    /// Of a torque, what the run on exact readings takes of it and what readings may add, to first order.
    pub parts: Option<[f64; 2]>,
}

/// The first of those that are.
fn beyond(limit: Limit, found: impl IntoIterator<Item = f64>, passes: &[f64]) -> Option<Beyond> {
    let mut all = found.into_iter().zip(passes.iter().enumerate().cycle());
    let found = all.find(|(found, (_, passes))| found.is_nan() || found > passes);
    found.map(|(found, (joint, &passes))| Beyond { limit, joint, found, passes, parts: None })
}

/// What is remembered from the instant before.
struct Last {
    after: Spread,
    sizes: Sizes,
    asked: Spread,
    readings: Spread,
}

/// Looks at one control instant after the other.
#[derive(Default)]
pub struct Watch {
    last: Option<Last>,
    /// Since some reading may be what it is now, from the latest.
    spans: VecDeque<Span>,
}

/// Some control instants, one after the other.
struct Span {
    /// Readings of links, then motors in rad.
    readings: Vec<Interval>,
    /// The reference in rad.
    reference: Vec<Interval>,
}

/// Instants are taken together as long as that makes what is known of them wider by at most this part.
const TOGETHER: f64 = 0.05;

impl Span {
    /// How far the other side and the reference of reading `i` may be from `now`.
    fn travel(&self, now: &Self, i: usize) -> f64 {
        let n = self.reference.len();
        let other = now.readings[(i + n) % (2 * n)] - self.readings[(i + n) % (2 * n)];
        other.magnitude().max((now.reference[i % n] - self.reference[i % n]).magnitude())
    }

    fn both(&self, other: &Self) -> Self {
        let hull = |a: &[Interval], b: &[Interval]| a.iter().zip(b).map(|(a, b)| a.hull(*b)).collect();
        Self {
            readings: hull(&self.readings, &other.readings),
            reference: hull(&self.reference, &other.reference),
        }
    }
}

impl Watch {
    /// What may be beyond what passes at the time `t` in s, if anything.
    pub fn look(&mut self, of: &HeldLoop<'_>, t: Interval, before: &Before, law: &Instant) -> Option<Beyond> {
        let n = of.system.joints();
        let passes = of.passes;
        let torque = beyond(Limit::Torque, law.largest(), &passes.torque)
            .map(|torque| Beyond { parts: Some(law.parts(torque.joint)), ..torque });
        torque.or_else(|| self.step(of, before, law)).or_else(|| {
            let believed = passes.readings.as_ref()?;
            let seen = before.seen.ranges(&before.sizes);
            let deflection = deflection(&before.seen, n).ranges(&before.sizes);
            let [least, most] = &believed.position;
            let minus: Vec<_> = least.iter().map(|x| -x).collect();
            let positions = || seen[..2 * n].iter();
            beyond(Limit::Highest, positions().map(|q| q.hi()), most)
                .or_else(|| beyond(Limit::Lowest, positions().map(|q| -q.lo()), &minus))
                .or_else(|| {
                    beyond(Limit::Speed, seen[2 * n..].iter().map(|v| v.magnitude()), &believed.speed)
                })
                .or_else(|| {
                    beyond(Limit::Deflection, deflection.iter().map(|x| x.magnitude()), &believed.deflection)
                })
                .or_else(|| {
                    let reference = of.system.reference(t).iter().map(|jet| jet[0]).collect();
                    let now = Span { readings: seen[..2 * n].to_vec(), reference };
                    beyond(Limit::Travel, self.travel(now), &vec![believed.travel; n])
                })
        })
    }

    /// How far other sides or references may have moved since readings are the same.
    fn travel(&mut self, now: Span) -> Vec<f64> {
        let mut longest = 0;
        let one = |i: usize| {
            let since =
                self.spans.iter().take_while(|span| span.readings[i].intersection(now.readings[i]).is_some());
            let (mut most, mut count) = (0.0_f64, 0);
            for span in since {
                (most, count) = (most.max(span.travel(&now, i)), count + 1);
            }
            longest = longest.max(count);
            most
        };
        let found = (0..now.readings.len()).map(one).collect();
        self.spans.truncate(longest);
        let little = |both: &Span| {
            let mut each = both.readings.iter().zip(&now.readings);
            each.all(|(both, now)| both.width() <= (1.0 + TOGETHER) * now.width())
        };
        match self.spans.front().map(|last| last.both(&now)).filter(little) {
            Some(both) => self.spans[0] = both,
            None => self.spans.push_front(now),
        }
        found
    }

    /// Changes from the instant before.
    fn step(&self, of: &HeldLoop<'_>, before: &Before, law: &Instant) -> Option<Beyond> {
        let (n, passes) = (of.system.joints(), of.passes);
        let minus = Interval::ZERO - Interval::ONE;
        let largest = |change: &Spread, sizes: &Sizes| -> Vec<f64> {
            change.ranges(sizes).iter().map(|x| x.magnitude()).collect()
        };
        let Some(last) = &self.last else {
            // Motors are held against their springs until now.
            let springs = of.springs(&before.state);
            let change = Spread::sum(&[(Interval::ONE, &law.asked), (minus, &springs)]);
            let before = springs.followed_by(&of.on_their_way(&before.state));
            return beyond(Limit::Torque, largest(&before, &law.sizes), &passes.torque)
                .or_else(|| beyond(Limit::TorqueStep, largest(&change, &law.sizes), &passes.torque_step));
        };
        let off = &of.sensors.off;
        let state = last.after.widened(off.len());
        let mut sizes = last.sizes.clone();
        sizes.slopes.extend(off.iter().map(|_| 0.0));
        sizes.most.extend(off);
        let [seen, _] = of.sensors.seen(&state, n, last.after.deviations.columns());
        let asked = law.at(&seen);
        let change = Spread::sum(&[(Interval::ONE, &asked), (minus, &last.asked.widened(off.len()))]);
        let beside = law.sizes.slopes.iter().zip(&law.sizes.most);
        let changes = largest(&change, &sizes).into_iter().zip(beside).map(|(change, (&slope, &most))| {
            (Interval::point(change) + Interval::point(slope) + Interval::point(most)).hi()
        });
        beyond(Limit::TorqueStep, changes, &passes.torque_step).or_else(|| {
            let believed = passes.readings.as_ref()?;
            let readings = seen.part(0, 2 * n);
            let change =
                Spread::sum(&[(Interval::ONE, &readings), (minus, &last.readings.widened(off.len()))]);
            beyond(Limit::Jump, largest(&change, &sizes), &believed.jump)
        })
    }

    /// Remembers an instant.
    pub fn passed(&mut self, before: &Before, passage: &Passage, n: usize) {
        self.last = Some(Last {
            after: passage.after.clone(),
            sizes: passage.law.sizes.clone(),
            asked: passage.law.asked.clone(),
            readings: before.seen.part(0, 2 * n),
        });
    }
}

/// Motors beside links.
fn deflection(seen: &Spread, n: usize) -> Spread {
    let minus = Interval::ZERO - Interval::ONE;
    Spread::sum(&[(Interval::ONE, &seen.part(n, n)), (minus, &seen.part(0, n))])
}

impl HeldLoop<'_> {
    /// What springs hold motors with where the loop is at `state` [N m].
    fn springs(&self, state: &Spread) -> Spread {
        let n = self.system.joints();
        let wound = deflection(state, n);
        let stiffness = self.system.drive().stiffness;
        let scaled =
            Dense::from_fn(n, wound.deviations.columns(), |i, j| stiffness[i] * wound.deviations[(i, j)]);
        Spread {
            center: wound.center.iter().zip(&stiffness).map(|(&x, &k)| k * x).collect(),
            deviations: scaled,
        }
    }
}
