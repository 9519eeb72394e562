//! Where a loop stops holding, by growing steps and bisection.

use serde::Serialize;

use crate::files::Problems;

/// The largest change under which a loop still holds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "edge")]
pub enum Edge {
    /// Up to here, within the resolution of the bisection.
    Between {
        /// The farthest change at which the loop holds.
        holds: f64,
        /// The nearest one at which it does not.
        fails: f64,
    },
    /// It holds as far as was looked.
    Beyond {
        /// The farthest change that was tried: the loop holds there.
        holds: f64,
    },
    /// The search was broken off: it holds at least as far as this.
    Open {
        /// The farthest change at which the loop was seen to hold; the scenario as it is if none was.
        holds: f64,
    },
    /// Nowhere: the loop does not hold as it is.
    Nowhere,
}

impl Edge {
    /// The farthest change at which the loop holds, if there is one and it was found.
    pub fn holds(&self) -> Option<f64> {
        match self {
            Self::Between { holds, .. } | Self::Beyond { holds } => Some(*holds).filter(|&holds| holds > 0.0),
            Self::Open { .. } | Self::Nowhere => None,
        }
    }
}

/// The way from the scenario as it is to the largest change that is tried.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    from: f64,
    first: f64,
    last: f64,
}

/// The bracket is narrowed to this part of its outer end.
const RESOLUTION: f64 = 0.01;

/// What is less than this part of the first step is nothing.
const LEAST: f64 = 1e-6;

/// Factor from one change to the next until one fails.
const GROWTH: f64 = 1.5;

impl Way {
    /// From `from` by a first step `first`, growing, to `last`.
    pub fn outward(from: f64, first: f64, last: f64) -> Self {
        Self { from, first: from + first, last }
    }

    /// From the factor `from` up or down to `last`.
    pub fn inward(from: f64, last: f64) -> Self {
        let step = if last > from { 1.1 } else { 1.0 / 1.1 };
        Self { from, first: from * step, last }
    }

    /// The edge between what `holds` and what does not, and how many changes were tried. `holds` is also told the [`Stage`] of
    /// the search; what it breaks off ends [open](Edge::Open).
    ///
    /// # Errors
    /// Those of `holds`.
    pub fn edge(&self, holds: &Trial<'_>) -> Result<(Edge, usize), Problems> {
        let mut seen = Seen { good: self.from, tried: 0 };
        match self.search(&mut seen, holds) {
            Err(problems) if problems.is_interrupted() => Ok((Edge::Open { holds: seen.good }, seen.tried)),
            found => Ok((found?, seen.tried)),
        }
    }

    fn search(&self, seen: &mut Seen, holds: &Trial<'_>) -> Result<Edge, Problems> {
        let growth = if self.last > self.from { GROWTH } else { 1.0 / GROWTH };
        let short_of_last = |x: f64| if growth > 1.0 { x < self.last } else { x > self.last };
        let mut bad = self.first;
        loop {
            let to_last = whole((self.last / bad).ln() / growth.ln());
            // Where the edge lies nobody knows: as far again as was gone, or at the end if that is nearer.
            let left = seen.tried.clamp(1, to_last.max(1)) + bisections(bad / growth, bad);
            if !seen.tries(bad, left, holds)? {
                break;
            }
            if !short_of_last(bad) {
                return Ok(Edge::Beyond { holds: bad });
            }
            bad *= growth;
            bad = if short_of_last(bad) { bad } else { self.last };
        }
        // Of a loop that bears nothing at all the bracket would shrink for ever.
        let least = LEAST * (self.first - self.from).abs();
        let is_wide = |good: f64, bad: f64| {
            (bad - good).abs() > RESOLUTION * good.abs().max(bad.abs()) && (bad - self.from).abs() > least
        };
        while is_wide(seen.good, bad) {
            let middle = 0.5 * (seen.good + bad);
            if !seen.tries(middle, bisections(seen.good, middle), holds)? {
                bad = middle;
            }
        }
        Ok(Edge::Between { holds: seen.good, fails: bad })
    }
}

/// Whether a loop holds under a change; also told how far the search is.
pub type Trial<'a> = dyn Fn(f64, Stage) -> Result<bool, Problems> + 'a;

/// How far a search is.
#[derive(Clone, Copy, Debug)]
pub struct Stage {
    /// Changes that were tried.
    pub tried: usize,
    /// Changes that are likely to be tried after this one.
    pub left: usize,
}

impl Stage {
    /// The fraction done of the search, with `fraction` of this trial.
    pub fn fraction(self, fraction: f64) -> f64 {
        (self.tried as f64 + fraction) / (self.tried + 1 + self.left) as f64
    }
}

/// What a search has seen.
struct Seen {
    /// The farthest change that holds.
    good: f64,
    tried: usize,
}

impl Seen {
    fn tries(&mut self, x: f64, left: usize, holds: &Trial<'_>) -> Result<bool, Problems> {
        let is_good = holds(x, Stage { tried: self.tried, left })?;
        self.tried += 1;
        if is_good {
            self.good = x;
        }
        Ok(is_good)
    }
}

/// A number of trials, rounded up.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [0, 1000]")]
fn whole(trials: f64) -> usize {
    trials.ceil().clamp(0.0, 1000.0) as usize
}

/// Bisections after which a bracket is as narrow as it shall be.
fn bisections(good: f64, bad: f64) -> usize {
    whole(((bad - good).abs() / (RESOLUTION * good.abs().max(bad.abs()))).log2())
}

#[cfg(test)]
mod tests {
    use std::cell::{Cell, RefCell};

    use super::{Edge, Problems, Way};

    fn edge(way: Way, holds: impl Fn(f64) -> bool) -> Edge {
        way.edge(&|x, _| Ok(holds(x))).expect("nothing goes wrong").0
    }

    #[test]
    fn brackets_the_edge_to_a_hundredth() {
        for (way, at) in [
            (Way::outward(0.0, 1e-4, 1.0), 0.0123),
            (Way::inward(1.0, 100.0), 3.7),
            (Way::inward(1.0, 0.01), 0.41),
        ] {
            let inside = |x: f64| (x < at) == (way.last > way.from);
            let Edge::Between { holds, fails } = edge(way, inside) else { panic!("an edge at {at}") };
            assert!(inside(holds) && !inside(fails));
            assert!((holds - fails).abs() <= 0.01 * holds.max(fails));
        }
    }

    #[test]
    fn what_bears_nothing_is_found_soon() {
        let (found, tried) =
            Way::outward(0.0, 1e-4, 1.0).edge(&|_, _| Ok(false)).expect("nothing goes wrong");
        assert!(
            tried < 30 && matches!(found, Edge::Between { holds: 0.0, fails } if fails < 1e-9),
            "{found:?}"
        );
    }

    #[test]
    fn stops_at_the_end_of_the_way() {
        assert_eq!(edge(Way::inward(1.0, 0.01), |_| true), Edge::Beyond { holds: 0.01 });
        assert_eq!(edge(Way::outward(0.0, 0.1, 1.0), |_| true), Edge::Beyond { holds: 1.0 });
    }

    /// A search that is broken off says how far it came; its fraction is 1 at the end, near the truth once the edge lies between
    /// two trials, and before, when nobody knows how far the edge is, not less than half of it.
    #[test]
    fn a_search_says_how_far_it_is() {
        let way = Way::outward(0.0, 1e-4, 1.0);
        let (stages, outward) = (RefCell::new(Vec::new()), Cell::new(0));
        let (_, tried) = way
            .edge(&|x, stage| {
                stages.borrow_mut().push(stage);
                if outward.get() == 0 && x >= 0.0123 {
                    outward.set(stage.tried + 1);
                }
                Ok(x < 0.0123)
            })
            .expect("nothing goes wrong");
        let stages = stages.into_inner();
        assert!(stages.iter().enumerate().all(|(i, stage)| stage.tried == i));
        let last = stages.last().expect("some").fraction(1.0);
        assert!(last > 0.9, "{last}");
        for stage in &stages {
            let (said, truth) = (stage.fraction(0.0), stage.tried as f64 / tried as f64);
            let least = if stage.tried < outward.get() { 0.5 * truth } else { truth - 0.1 };
            assert!(said >= least && said < truth + 0.2, "{said} of {truth}");
        }
        for limit in [0, 3, tried - 1] {
            let broken = way.edge(&|x, stage| {
                if stage.tried == limit { Err(Problems::interrupted()) } else { Ok(x < 0.0123) }
            });
            let (edge, after) = broken.expect("an open edge");
            assert_eq!(after, limit);
            let Edge::Open { holds } = edge else { panic!("{edge:?}") };
            assert!((0.0..0.0123).contains(&holds) && (limit == 0) == (holds == 0.0), "{holds}");
        }
    }
}
