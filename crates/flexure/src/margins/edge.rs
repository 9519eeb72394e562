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
    /// Nowhere: the loop does not hold as it is.
    Nowhere,
}

impl Edge {
    /// The farthest change at which the loop holds, if there is one.
    pub fn holds(&self) -> Option<f64> {
        match self {
            Self::Between { holds, .. } | Self::Beyond { holds } => Some(*holds).filter(|&holds| holds > 0.0),
            Self::Nowhere => None,
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

    /// The edge between what `holds` and what does not, and how many changes were tried.
    ///
    /// # Errors
    /// Those of `holds`.
    pub fn edge(&self, holds: &dyn Fn(f64) -> Result<bool, Problems>) -> Result<(Edge, usize), Problems> {
        let growth = if self.last > self.from { GROWTH } else { 1.0 / GROWTH };
        let short_of_last = |x: f64| if growth > 1.0 { x < self.last } else { x > self.last };
        let (mut good, mut bad, mut tried) = (self.from, self.first, 0);
        loop {
            tried += 1;
            if !holds(bad)? {
                break;
            }
            good = bad;
            if !short_of_last(bad) {
                return Ok((Edge::Beyond { holds: good }, tried));
            }
            bad *= growth;
            bad = if short_of_last(bad) { bad } else { self.last };
        }
        // Of a loop that bears nothing at all the bracket would shrink for ever.
        let least = LEAST * (self.first - self.from).abs();
        let is_wide = |good: f64, bad: f64| {
            (bad - good).abs() > RESOLUTION * good.abs().max(bad.abs()) && (bad - self.from).abs() > least
        };
        while is_wide(good, bad) {
            let middle = 0.5 * (good + bad);
            tried += 1;
            if holds(middle)? {
                good = middle;
            } else {
                bad = middle;
            }
        }
        Ok((Edge::Between { holds: good, fails: bad }, tried))
    }
}

#[cfg(test)]
mod tests {
    use super::{Edge, Way};

    fn edge(way: Way, holds: impl Fn(f64) -> bool) -> Edge {
        way.edge(&|x| Ok(holds(x))).expect("nothing goes wrong").0
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
        let (found, tried) = Way::outward(0.0, 1e-4, 1.0).edge(&|_| Ok(false)).expect("nothing goes wrong");
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
}
