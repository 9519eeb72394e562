//! Where a loop stops holding, by growing steps and bisection.

use serde::Serialize;

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

/// How likely a loop is believed to hold under the next change while none has failed.
const OUTWARD: f64 = 0.75;

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

    /// A search for the edge that has seen nothing yet.
    pub fn search(self) -> Search {
        Search { way: self, good: self.from, tried: 0, phase: Phase::Outward { next: self.first } }
    }
}

/// A search for an edge, trial by trial.
#[derive(Clone, Copy, Debug)]
pub struct Search {
    way: Way,
    /// The farthest change that was seen to hold.
    good: f64,
    tried: usize,
    phase: Phase,
}

/// What a search is about to do.
#[derive(Clone, Copy, Debug)]
enum Phase {
    /// Nothing has failed yet.
    Outward {
        next: f64,
    },
    /// The edge is nearer than what failed.
    Between {
        next: f64,
        bad: f64,
    },
    Done(Edge),
}

impl Search {
    /// The change that is to be tried next, and how far the search is; none once the edge is found.
    pub fn next(&self) -> Option<(f64, Stage)> {
        let (next, left) = match self.phase {
            Phase::Outward { next } => {
                let growth = self.growth();
                let to_last = whole((self.way.last / next).ln() / growth.ln());
                // Where the edge lies nobody knows: as far again as was gone, or at the end if that is nearer.
                (next, self.tried.clamp(1, to_last.max(1)) + bisections(next / growth, next))
            }
            Phase::Between { next, .. } => (next, bisections(self.good, next)),
            Phase::Done(_) => return None,
        };
        Some((next, Stage { tried: self.tried, left }))
    }

    /// At most `most` changes to try: the [next](Self::next) one, then those that it is likely to be followed by, whatever comes of it. None once
    /// the edge is found.
    pub fn ahead(&self, most: usize) -> Vec<f64> {
        let (mut courses, mut changes) = (vec![(1.0, *self)], Vec::new());
        while changes.len() < most {
            let likeliest = courses.iter().map(|(part, _)| *part).fold(0.0, f64::max);
            let Some(place) = courses.iter().position(|(part, _)| *part >= likeliest) else { break };
            let (part, course) = courses.remove(place);
            let Some((next, _)) = course.next() else { continue };
            changes.push(next);
            let holds = if matches!(course.phase, Phase::Outward { .. }) { OUTWARD } else { 0.5 };
            for (holds, probability) in [(true, holds), (false, 1.0 - holds)] {
                let mut after = course;
                after.tell(holds);
                courses.push((part * probability, after));
            }
        }
        changes
    }

    /// Takes in whether the loop holds under the [next](Self::next) change.
    pub fn tell(&mut self, holds: bool) {
        self.phase = match self.phase {
            Phase::Outward { next } if holds => {
                self.good = next;
                if self.is_short_of_last(next) {
                    let farther = next * self.growth();
                    let next = if self.is_short_of_last(farther) { farther } else { self.way.last };
                    Phase::Outward { next }
                } else {
                    Phase::Done(Edge::Beyond { holds: next })
                }
            }
            Phase::Between { next, bad } if holds => {
                self.good = next;
                self.narrowed(bad)
            }
            Phase::Outward { next } | Phase::Between { next, .. } => self.narrowed(next),
            done @ Phase::Done(_) => done,
        };
        self.tried += 1;
    }

    /// The edge, and how many changes were tried; an [open](Edge::Open) one if it is not found yet.
    pub fn edge(&self) -> (Edge, usize) {
        let edge = match self.phase {
            Phase::Done(edge) => edge,
            _ => Edge::Open { holds: self.good },
        };
        (edge, self.tried)
    }

    /// On between what holds and what fails, `bad`, if that is still wide.
    fn narrowed(&self, bad: f64) -> Phase {
        let Self { way, good, .. } = *self;
        // Of a loop that bears nothing at all the bracket would shrink for ever.
        let least = LEAST * (way.first - way.from).abs();
        let is_wide =
            (bad - good).abs() > RESOLUTION * good.abs().max(bad.abs()) && (bad - way.from).abs() > least;
        if is_wide {
            Phase::Between { next: 0.5 * (good + bad), bad }
        } else {
            Phase::Done(Edge::Between { holds: good, fails: bad })
        }
    }

    fn growth(&self) -> f64 {
        if self.way.last > self.way.from { GROWTH } else { 1.0 / GROWTH }
    }

    fn is_short_of_last(&self, x: f64) -> bool {
        if self.growth() > 1.0 { x < self.way.last } else { x > self.way.last }
    }
}

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
    use super::{Edge, Stage, Way};

    /// The edge of what `holds`, how many changes were tried, and the stage of each.
    fn edge(way: Way, holds: impl Fn(f64) -> bool) -> (Edge, usize, Vec<Stage>) {
        let (mut search, mut stages) = (way.search(), Vec::new());
        while let Some((x, stage)) = search.next() {
            stages.push(stage);
            search.tell(holds(x));
        }
        let (edge, tried) = search.edge();
        (edge, tried, stages)
    }

    #[test]
    fn brackets_the_edge_to_a_hundredth() {
        for (way, at) in [
            (Way::outward(0.0, 1e-4, 1.0), 0.0123),
            (Way::inward(1.0, 100.0), 3.7),
            (Way::inward(1.0, 0.01), 0.41),
        ] {
            let inside = |x: f64| (x < at) == (way.last > way.from);
            let (Edge::Between { holds, fails }, ..) = edge(way, inside) else { panic!("an edge at {at}") };
            assert!(inside(holds) && !inside(fails));
            assert!((holds - fails).abs() <= 0.01 * holds.max(fails));
        }
    }

    #[test]
    fn what_bears_nothing_is_found_soon() {
        let (found, tried, _) = edge(Way::outward(0.0, 1e-4, 1.0), |_| false);
        assert!(
            tried < 30 && matches!(found, Edge::Between { holds: 0.0, fails } if fails < 1e-9),
            "{found:?}"
        );
    }

    #[test]
    fn stops_at_the_end_of_the_way() {
        assert_eq!(edge(Way::inward(1.0, 0.01), |_| true).0, Edge::Beyond { holds: 0.01 });
        assert_eq!(edge(Way::outward(0.0, 0.1, 1.0), |_| true).0, Edge::Beyond { holds: 1.0 });
    }

    /// Changes that are tried before it is their turn are those that come one after the other, and some more.
    #[test]
    fn changes_ahead_are_those_that_come() {
        let (way, at) = (Way::outward(0.0, 1e-4, 1.0), 0.0123);
        let (found, tried, _) = edge(way, |x| x < at);
        for (most, enough) in [(1, tried), (2, tried), (3, 2 * tried / 3 + 1), (8, tried / 2)] {
            let (mut search, mut rounds, mut known) = (way.search(), 0, Vec::new());
            while search.next().is_some() {
                let ahead = search.ahead(most);
                assert_eq!(search.next().map(|(x, _)| x), ahead.first().copied());
                assert!(ahead.len() <= most);
                (rounds, known) = (rounds + 1, [known, ahead].concat());
                while let Some((x, _)) = search.next().filter(|(x, _)| known.contains(x)) {
                    search.tell(x < at);
                }
            }
            assert_eq!(search.edge(), (found, tried));
            assert!(rounds <= enough, "{most}: {rounds} of {tried}");
            assert!(search.ahead(most).is_empty());
        }
    }

    /// A search that is broken off says how far it came; its fraction is 1 at the end, near the truth once the edge lies between
    /// two trials, and before, when nobody knows how far the edge is, not less than half of it.
    #[test]
    fn a_search_says_how_far_it_is() {
        let (way, at) = (Way::outward(0.0, 1e-4, 1.0), 0.0123);
        let (_, tried, stages) = edge(way, |x| x < at);
        let mut search = way.search();
        let mut outward = 0;
        for (i, stage) in stages.iter().enumerate() {
            assert_eq!(stage.tried, i);
            let (open, after) = search.edge();
            assert_eq!(after, i);
            let Edge::Open { holds } = open else { panic!("{open:?}") };
            assert!((0.0..at).contains(&holds) && (i == 0) == (holds == 0.0), "{holds}");
            let x = search.next().expect("it is not done").0;
            search.tell(x < at);
            if outward == 0 && x >= at {
                outward = i + 1;
            }
        }
        let last = stages.last().expect("some").fraction(1.0);
        assert!(last > 0.9, "{last}");
        for stage in &stages {
            let (said, truth) = (stage.fraction(0.0), stage.tried as f64 / tried as f64);
            let least = if stage.tried < outward { 0.5 * truth } else { truth - 0.1 };
            assert!(said >= least && said < truth + 0.2, "{said} of {truth}");
        }
    }
}
