//! How far the law is from linear, over boxes that last for some instants.

use flexure_core::scalar::Interval;

use crate::linalg::Dense;
use crate::prove::engine::sampled_data::bends::{Bends, Order};
use crate::prove::engine::sampled_data::frame::Frame;
use crate::prove::engine::sampled_data::instant::{Instant, Middle};
use crate::prove::engine::sampled_data::norm::onwards;
use crate::prove::engine::sampled_data::period::HeldLoop;
use crate::prove::engine::sampled_data::spread::{Sizes, Spread};

/// Instants that boxes are made for at most.
const LONGEST: f64 = 64.0;

/// Of what a tube can take to be left open, boxes of second derivatives for instants to come may leave this part, those of third ones all of it, and are made for more of them where
/// they leave half of that.
const MOST: f64 = 0.1;
const LITTLE: f64 = 0.5;

/// Of motions of more numbers third derivatives are not looked for: of seven joints a box of them takes four thousand evaluations of a law, seconds, and what ends tubes
/// are torques.
const MANY: usize = 16;

/// Instants for which each has its own box where one for two left too much open.
const REST: u32 = 16;

/// The columns by which motions are seen, those of readings as long as they may be off.
fn by(seen: &Spread, sizes: &Sizes) -> Dense<f64> {
    let all = &seen.deviations;
    Dense::from_fn(all.rows().len(), all.columns(), |i, j| {
        let size = j.checked_sub(sizes.ball).map_or(1.0, |k| sizes.most[k]);
        all[(i, j)].midpoint() * size
    })
}

/// What is known from instants before.
pub struct Ahead {
    /// Second derivatives until those leave open too much.
    order: Order,
    bends: Option<Bends>,
    before: Option<Vec<f64>>,
    /// Instants that boxes are made for, beside the one where they are.
    instants: f64,
    /// Instants until boxes for more than one are tried again.
    rest: u32,
}

impl Default for Ahead {
    fn default() -> Self {
        Self { order: Order::Second, bends: None, before: None, instants: 0.0, rest: 0 }
    }
}

impl Ahead {
    /// Of what a tube can take to be left open, what boxes for instants to come may leave.
    fn most(&self) -> f64 {
        match self.order {
            Order::Second => MOST,
            Order::Third => 1.0,
        }
    }

    /// The law at the time `t` in s over what is `seen`. Boxes are as long as all |η_j| are up to `enough`, which costs a tube nothing.
    pub fn law(
        &mut self,
        of: &HeldLoop<'_>,
        t: Interval,
        seen: &Spread,
        sizes: &Sizes,
        enough: &[f64],
    ) -> Instant {
        let frame = Frame::of(&by(seen, sizes));
        let middle = Middle::of(of.system, t, &seen.center, frame.clone());
        let ranges = seen.ranges(sizes);
        let now: Vec<_> = seen.center.iter().map(|c| c.midpoint()).collect();
        let before = self.before.replace(now.clone()).unwrap_or_else(|| now.clone());
        let within = |instant: &Instant, part: f64| {
            let Sizes { slopes, most, .. } = &instant.sizes;
            slopes.iter().zip(most).zip(enough).all(|((slope, most), enough)| slope + most <= part * enough)
        };
        if let Some(bends) = self.bends.as_ref().filter(|bends| bends.cover(t, &ranges)) {
            let instant = middle.over(of.system, seen, sizes, bends);
            if within(&instant, self.most()) {
                return instant;
            }
        }
        loop {
            let instants = Interval::point(self.instants);
            let times = t.hull(t + instants * of.period);
            // As from the instant before to this one.
            let roomy = |(x, (now, before)): (&Interval, (&f64, &f64))| {
                onwards(*x, instants * Interval::point(now - before))
            };
            let boxes = || ranges.iter().zip(now.iter().zip(&before));
            let over = if self.instants > 0.0 { boxes().map(roomy).collect() } else { ranges.clone() };
            let bends = Bends::over(of.system, times, over, &frame, self.order);
            let instant = middle.over(of.system, seen, sizes, &bends);
            if self.instants == 0.0
                && self.order == Order::Second
                && now.len() <= MANY
                && !within(&instant, 1.0)
            {
                self.order = Order::Third;
                continue;
            }
            if self.instants == 0.0 || within(&instant, self.most()) {
                if self.rest == 0 && within(&instant, LITTLE * self.most()) {
                    self.instants = (2.0 * self.instants).clamp(1.0, LONGEST);
                }
                self.rest = self.rest.saturating_sub(1);
                self.bends = Some(bends);
                return instant;
            }
            self.instants = (0.5 * self.instants).floor();
            self.rest = if self.instants == 0.0 { REST } else { 0 };
        }
    }
}
