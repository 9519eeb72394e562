//! What a loop bears, as a picture: how far from the scenario it holds, and where it stops.

use super::axes::{Axes, Axis};
use super::range::Range;
use super::scene::{Anchor, Lettering, Scene};
use super::sheet::{MARGIN, line_legend, page};
use super::style::{Color, HOLDS, INK, MUTED, STOPPED, Stroke, bold, letters};
use super::ticks;
use crate::files::number::significant;
use crate::margins::{Edge, Margins};

const WIDTH: f64 = 1200.0;
/// Left end of the frames: names stand before it [px].
const LEFT: f64 = 206.0;
/// Right of the frames, for words [px].
const WORDS: f64 = 300.0;
const ROW: f64 = 84.0;
const FRAME: f64 = 30.0;
const NAMES: Lettering = bold(15.0, INK);
const NOTES: Lettering = letters(13.0, MUTED);
const SCENARIO: Stroke = Stroke::solid(INK, 2.4);

/// A change and how far the loop bears it, in the unit of its axis.
struct Row {
    name: &'static str,
    unit: &'static str,
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
    let subtitle = format!(
        "{}, by simulation; it holds as long as it follows, with an rms error of at most {} mrad and torques of at most {} N m",
        margins.law(),
        significant(1e3 * margins.allowed_rms_e_l, 3),
        significant(margins.allowed_max_u_m, 3)
    );
    let (mut scene, top) = page(WIDTH, &format!("{}: what the loop bears", margins.name), &subtitle);
    let swatch = |color| Stroke::solid(color, 12.0);
    let legend = [("the scenario", SCENARIO), ("holds", swatch(HOLDS)), ("does not hold", swatch(STOPPED))];
    let top = top + line_legend(&mut scene, top, &legend.map(|(name, stroke)| (name.to_owned(), stroke)));
    let rows = rows(margins);
    scene.height = top + ROW * rows.len() as f64 + 4.0;
    for (i, row) in rows.iter().enumerate() {
        row.draw(&mut scene, top + ROW * i as f64);
    }
    scene
}

fn rows(margins: &Margins) -> [Row; 4] {
    let added = |name, unit, high, scale| Row { name, unit, scenario: 0.0, low: None, high, scale };
    let factor = |name, low, high| Row { name, unit: "×", scenario: 1.0, low: Some(low), high, scale: 1.0 };
    [
        added("delay added", "ms", margins.delay, 1e3),
        factor("torque gain", margins.gain_low, margins.gain_high),
        factor("plant stiffness", margins.stiffness_low, margins.stiffness_high),
        added("noise added", "mrad", margins.noise, 1e3),
    ]
}

impl Row {
    fn draw(&self, scene: &mut Scene, top: f64) {
        let holds = [self.low.map_or(self.scenario, |edge| self.held(&edge)), self.held(&self.high)];
        let fails = [self.low.and_then(|edge| self.failed(&edge)), self.failed(&self.high)];
        let range = self.range(holds, fails);
        let [low, high] = [range.low, range.high];
        let frame = [LEFT, top + 12.0, WIDTH - LEFT - WORDS - MARGIN, FRAME];
        let ticks = if self.low.is_some() { ticks::logarithmic(range, 8.0) } else { ticks::even(range, 8.0) };
        let axes = Axes {
            frame,
            left: LEFT,
            x: Axis { range, ticks, label: "" },
            y: Axis { range: Range { low: 0.0, high: 1.0 }, ticks: Vec::new(), label: "" },
        };
        for (from, to) in [(Some(low), fails[0]), (fails[1], Some(high))] {
            if let (Some(from), Some(to)) = (from, to) {
                bar(scene, &axes, [self.at(from, low), self.at(to, high)], STOPPED);
            }
        }
        axes.draw(scene);
        bar(scene, &axes, holds.map(|x| self.exponent(x).clamp(low, high)), HOLDS);
        let [x, _] = axes.place(self.exponent(self.scenario), 0.0);
        scene.line([x, frame[1] - 5.0], [x, frame[1] + FRAME + 5.0], SCENARIO);
        scene.text(
            [LEFT - 16.0, frame[1] + 19.0],
            &format!("{} [{}]", self.name, self.unit),
            NAMES,
            Anchor::End,
        );
        let right = frame[0] + frame[2] + 16.0;
        for (line, words) in self.words().iter().enumerate() {
            scene.text([right, frame[1] + 13.0 + 17.0 * line as f64], words, NOTES, Anchor::Start);
        }
    }

    /// An end of a bar: what lies on the edge of the frame is there already.
    fn at(&self, value: f64, edge: f64) -> f64 {
        if value.to_bits() == edge.to_bits() { edge } else { self.exponent(value) }
    }

    /// Where a value lies along the axis: its exponent of ten where that is logarithmic.
    fn exponent(&self, value: f64) -> f64 {
        if self.low.is_some() { value.log10() } else { value }
    }

    fn held(&self, edge: &Edge) -> f64 {
        match edge {
            Edge::Between { holds, .. } | Edge::Beyond { holds } | Edge::Open { holds } => self.scale * holds,
            Edge::Nowhere => self.scenario,
        }
    }

    fn failed(&self, edge: &Edge) -> Option<f64> {
        match edge {
            Edge::Between { fails, .. } => Some(self.scale * fails),
            Edge::Nowhere => Some(self.scenario),
            Edge::Beyond { .. } | Edge::Open { .. } => None,
        }
    }

    /// The axis: all that was found, with room beyond, and the scenario.
    fn range(&self, holds: [f64; 2], fails: [Option<f64>; 2]) -> Range {
        let values = holds.into_iter().chain(fails.into_iter().flatten()).chain([self.scenario]);
        let (low, high) = values
            .map(|value| self.exponent(value))
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let room = 0.22 * (high - low).max(if self.low.is_some() { 0.2 } else { 1e-6 });
        Range { low: if self.low.is_some() { low - room } else { 0.0 }, high: high + room }
    }

    /// What was found of either end.
    fn words(&self) -> Vec<String> {
        let number = |x: f64| format!("{} {}", significant(self.scale * x, 3), self.unit);
        let end = |edge: &Edge, far: &str| match edge {
            Edge::Between { holds, fails } => format!("{far} {}; not at {}", number(*holds), number(*fails)),
            Edge::Beyond { holds } => format!("{far} {}: no end was found", number(*holds)),
            Edge::Open { holds } => format!("{far} {} at least: broken off", number(*holds)),
            Edge::Nowhere => "the loop does not hold as it is".to_owned(),
        };
        let low = self.low.iter().map(|edge| end(edge, "holds down to"));
        let mut words: Vec<String> = low.chain([end(&self.high, "holds up to")]).collect();
        words.dedup();
        words
    }
}

/// A bar between two places of an axis, as high as the frame.
fn bar(scene: &mut Scene, axes: &Axes, [from, to]: [f64; 2], fill: Color) {
    if to > from {
        let [left, right] = [from, to].map(|x| axes.place(x, 0.0)[0]);
        let [_, top, _, height] = axes.frame;
        scene.rectangle([left, top, right - left, height], fill, Stroke::solid(fill, 0.0));
    }
}

#[cfg(test)]
mod tests {
    use super::Row;
    use crate::margins::Edge;

    #[test]
    fn axes_show_both_ends_and_the_scenario() {
        let between = |holds, fails| Edge::Between { holds, fails };
        let factor =
            |low, high| Row { name: "gain", unit: "×", scenario: 1.0, low: Some(low), high, scale: 1.0 };
        for row in [
            factor(between(0.3, 0.29), between(4.0, 4.1)),
            factor(Edge::Beyond { holds: 0.01 }, Edge::Nowhere),
            factor(Edge::Nowhere, Edge::Nowhere),
            factor(Edge::Open { holds: 1.0 }, Edge::Beyond { holds: 100.0 }),
        ] {
            let holds = [row.low.map_or(1.0, |edge| row.held(&edge)), row.held(&row.high)];
            let fails = [row.low.and_then(|edge| row.failed(&edge)), row.failed(&row.high)];
            let range = row.range(holds, fails);
            assert!(range.low < 0.0 && range.high > 0.0, "{range:?}");
            assert!(holds.iter().chain(fails.iter().flatten()).all(|x| range.contains(x.log10())));
            assert!(!row.words().is_empty());
        }
    }
}
