//! What a loop bears, as a picture: how far from the scenario it holds, and where it stops.

use crate::files::number::{short, significant};
use crate::margins::{Edge, Margins};
use crate::report::draw::range::Range;
use crate::report::draw::scene::Scene;
use crate::report::draw::style::{Color, HOLDS, INK, MUTED, STOPPED, Stroke};
use crate::report::draw::ticks;
use crate::report::draw::tracks::{Bar, Track, swatch, tracks};
use crate::units;

const SCENARIO: Stroke = Stroke::solid(INK, 2.4);

/// A change and how far the loop bears it, in the unit of its axis.
struct Row {
    name: &'static str,
    unit: String,
    /// Where the scenario is.
    scenario: f64,
    /// Downwards from there, if it can be less.
    low: Option<Edge>,
    high: Edge,
    /// What the numbers of the edges are multiplied by.
    scale: f64,
}

/// A bar for each change from where the loop holds to where it stops holding, about where the scenario is.
pub fn margins_figure(margins: &Margins) -> Scene {
    let unstable = if margins.is_unstable() {
        "; unstable as sampled: it follows in so short a run, and no longer"
    } else {
        ""
    };
    let subtitle = format!(
        "{}, by runs of {} s; it holds as long as it follows, with an rms error of at most {} {} and torques of at most {} {}{unstable}",
        margins.law(),
        short(margins.duration, 4),
        significant(1e3 * margins.allowed_rms_e_l, 3),
        margins.unit(units::ANGLE, "m"),
        significant(margins.allowed_max_u_m, 3),
        margins.unit(units::TORQUE, "")
    );
    let title = format!("{}: what the loop bears", margins.name);
    let (word, color) = seen(margins);
    let legend =
        [("the scenario".to_owned(), SCENARIO), swatch(word, color), swatch("does not hold", STOPPED)];
    tracks(&title, &subtitle, &legend, rows(margins).map(|row| row.track(word, color)).into())
}

/// What is seen of a loop where its runs follow.
fn seen(margins: &Margins) -> (&'static str, Color) {
    if margins.is_unstable() { ("follows", MUTED) } else { ("holds", HOLDS) }
}

fn rows(margins: &Margins) -> [Row; 4] {
    let milli = margins.unit(units::ANGLE, "m");
    let added = |name, unit, high, scale| Row { name, unit, scenario: 0.0, low: None, high, scale };
    let factor =
        |name, low, high| Row {
            name, unit: "×".to_owned(), scenario: 1.0, low: Some(low), high, scale: 1.0
        };
    [
        added("delay added", "ms".to_owned(), margins.delay, 1e3),
        factor("torque gain", margins.gain_low, margins.gain_high),
        factor("plant stiffness", margins.stiffness_low, margins.stiffness_high),
        added("noise added", milli, margins.noise, 1e3),
    ]
}

impl Row {
    fn track(&self, word: &str, color: Color) -> Track {
        let holds = [self.low.map_or(self.at(self.scenario), |edge| self.held(&edge)), self.held(&self.high)];
        let fails = [self.low.and_then(|edge| self.failed(&edge)), self.failed(&self.high)];
        let axis = self.range(holds, fails);
        let below = fails[0].map(|fails| Bar::whole(axis.low, fails, STOPPED));
        let above = fails[1].map(|fails| Bar::whole(fails, axis.high, STOPPED));
        Track {
            name: format!("{} [{}]", self.name, self.unit),
            axis,
            ticks: if self.low.is_some() { ticks::logarithmic(axis, 8.0) } else { ticks::even(axis, 8.0) },
            bars: below.into_iter().chain(above).chain([Bar::whole(holds[0], holds[1], color)]).collect(),
            marks: vec![(self.at(self.scenario), SCENARIO)],
            words: self.words(word),
        }
    }

    /// Where a value lies along the axis: its exponent of ten where that is logarithmic.
    fn at(&self, value: f64) -> f64 {
        if self.low.is_some() { value.log10() } else { value }
    }

    fn held(&self, edge: &Edge) -> f64 {
        self.at(match edge {
            Edge::Between { holds, .. } | Edge::Beyond { holds } | Edge::Open { holds } => self.scale * holds,
            Edge::Nowhere => self.scenario,
        })
    }

    fn failed(&self, edge: &Edge) -> Option<f64> {
        let fails = match edge {
            Edge::Between { fails, .. } => self.scale * fails,
            Edge::Nowhere => self.scenario,
            Edge::Beyond { .. } | Edge::Open { .. } => return None,
        };
        Some(self.at(fails))
    }

    /// The axis: all that was found, with room beyond, and the scenario.
    fn range(&self, holds: [f64; 2], fails: [Option<f64>; 2]) -> Range {
        let values = holds.into_iter().chain(fails.into_iter().flatten()).chain([self.at(self.scenario)]);
        let (low, high) = values
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let least = if self.low.is_some() { 0.2 } else { f64::MIN_POSITIVE };
        let room = if self.low.is_none() && high <= low { 1.0 } else { 0.22 * (high - low).max(least) };
        Range { low: if self.low.is_some() { low - room } else { 0.0 }, high: high + room }
    }

    /// What was found of either end.
    fn words(&self, word: &str) -> Vec<String> {
        let number = |x: f64| format!("{} {}", significant(self.scale * x, 3), self.unit);
        let end = |edge: &Edge, far: &str| match edge {
            Edge::Between { holds, fails } => {
                format!("{word} {far} {}; not at {}", number(*holds), number(*fails))
            }
            Edge::Beyond { holds } => format!("{word} {far} {}: no end was found", number(*holds)),
            Edge::Open { holds } => format!("{word} {far} {} at least: broken off", number(*holds)),
            Edge::Nowhere => "the loop does not hold as it is".to_owned(),
        };
        let low = self.low.iter().map(|edge| end(edge, "down to"));
        let mut words: Vec<String> = low.chain([end(&self.high, "up to")]).collect();
        words.dedup();
        words
    }
}

#[cfg(test)]
mod tests {
    use super::{HOLDS, Row};
    use crate::margins::Edge;

    #[test]
    fn axes_show_both_ends_and_the_scenario() {
        let between = |holds, fails| Edge::Between { holds, fails };
        let factor = |low, high| Row {
            name: "gain",
            unit: "×".to_owned(),
            scenario: 1.0,
            low: Some(low),
            high,
            scale: 1.0,
        };
        for row in [
            factor(between(0.3, 0.29), between(4.0, 4.1)),
            factor(Edge::Beyond { holds: 0.01 }, Edge::Nowhere),
            factor(Edge::Nowhere, Edge::Nowhere),
            factor(Edge::Open { holds: 1.0 }, Edge::Beyond { holds: 100.0 }),
        ] {
            let track = row.track("holds", HOLDS);
            assert!(track.axis.low < 0.0 && track.axis.high > 0.0, "{:?}", track.axis);
            let ends = track.bars.iter().flat_map(|bar| [bar.from, bar.to]);
            assert!(ends.into_iter().all(|end| track.axis.contains(end)));
            assert!(!track.words.is_empty() && track.bars.iter().all(|bar| bar.from <= bar.to));
        }
    }
}
