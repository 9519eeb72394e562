//! The frame of every figure: grid, ticks, labels, and what lies where in it.

use super::curve::Curve;
use super::range::Range;
use super::scene::{Anchor, Lettering, Point, Scene, Shape};
use super::style::{GRID, INK, MUTED, Stroke, letters};
use super::text;
use super::ticks::Tick;

/// One direction of a frame.
pub(crate) struct Axis<'a> {
    pub range: Range,
    pub ticks: Vec<Tick>,
    pub label: &'a str,
}

/// A frame and what is written around it.
pub(crate) struct Axes<'a> {
    /// Left, top, width and height of the frame [px].
    pub frame: [f64; 4],
    /// Room for labels left of the frame [px].
    pub left: f64,
    pub x: Axis<'a>,
    pub y: Axis<'a>,
}

/// Room below a frame for the labels of an axis [px].
pub(crate) const BOTTOM: f64 = 48.0;

const NUMBERS: Lettering = letters(13.0, INK);
const LABELS: Lettering = letters(14.0, INK);
const EDGE: Stroke = Stroke::solid(MUTED, 1.0);
const GRID_LINE: Stroke = Stroke::solid(GRID, 1.0);
/// Length of a tick, into the frame [px].
const TICK: f64 = 5.0;
/// Room for numbers on the left that are narrower [px]: labels of most panels stand in a line.
const NARROWEST: f64 = 26.0;
/// Room between the frame and the numbers on its left [px].
const GAP: f64 = 8.0;
/// Room between numbers of an axis, at least [px].
const APART: f64 = 6.0;
/// From the middle of a number to its base line: half the height of digits [px].
const HALF_DIGIT: f64 = 4.74;

impl Axes<'_> {
    /// Draws the frame with its grid, ticks, numbers and labels.
    pub(crate) fn draw(&self, scene: &mut Scene) {
        let [left, top, width, height] = self.frame;
        let (right, bottom) = (left + width, top + height);
        let columns = self.x.ticks.iter().map(|tick| (self.across(tick.at), &tick.name));
        let rows = self.y.ticks.iter().map(|tick| (self.down(tick.at), &tick.name));
        // Under the edges, lines of the grid would only thicken them.
        for (x, _) in columns.clone().filter(|(x, _)| x - left >= 1.0) {
            scene.line([x, top], [x, bottom], GRID_LINE);
        }
        for (y, _) in rows.clone().filter(|(y, _)| bottom - y >= 1.0) {
            scene.line([left, y], [right, y], GRID_LINE);
        }
        // A number that would touch the one before it is left out: its tick is there.
        let mut free = f64::NEG_INFINITY;
        for (x, name) in columns {
            scene.line([x, bottom - TICK], [x, bottom], EDGE);
            let half = 0.5 * text::width(name, NUMBERS);
            if !name.is_empty() && x - half >= free {
                scene.text([x, bottom + 17.07], name, NUMBERS, Anchor::Middle);
                free = x + half + APART;
            }
        }
        let mut free = f64::INFINITY;
        for (y, name) in rows {
            scene.line([left, y], [left + TICK, y], EDGE);
            if y + HALF_DIGIT <= free {
                scene.text([left - GAP, y + HALF_DIGIT], name, NUMBERS, Anchor::End);
                free = y - HALF_DIGIT - 0.5 * APART;
            }
        }
        scene.line([left, bottom], [right, bottom], EDGE);
        scene.line([left, top], [left, bottom], EDGE);
        scene.line([left, top], [right, top], EDGE);
        scene.line([right, top], [right, bottom], EDGE);
        if !self.x.label.is_empty() {
            scene.text([left + 0.5 * width, bottom + 41.0], self.x.label, LABELS, Anchor::Middle);
        }
        if !self.y.label.is_empty() {
            scene.upwards([self.label_left(), top + 0.5 * height], self.y.label, LABELS);
        }
    }

    /// Draws a curve, cut at the frame; where it swings too fast for a line, as a band with its middle.
    pub(crate) fn curve(&self, scene: &mut Scene, curve: &Curve, buckets: usize) {
        let (pieces, bands) = curve.drawn(self, buckets);
        for corners in bands {
            scene.shapes.push(Shape::Band { corners, fill: curve.stroke.color });
        }
        if !pieces.is_empty() {
            scene.shapes.push(Shape::Curve { pieces, stroke: curve.stroke });
        }
    }

    /// Draws a line from top to bottom at a value of x.
    pub(crate) fn mark(&self, scene: &mut Scene, value: f64, stroke: Stroke) {
        let [_, top, _, height] = self.frame;
        let x = self.across(value);
        scene.line([x, top], [x, top + height], stroke);
    }

    /// Draws a line from left to right at a value of y.
    pub(crate) fn level(&self, scene: &mut Scene, value: f64, stroke: Stroke) {
        let [left, _, width, _] = self.frame;
        let y = self.down(value);
        scene.line([left, y], [left + width, y], stroke);
    }

    /// Where a point in the units of the axes lies.
    pub(crate) fn place(&self, x: f64, y: f64) -> Point {
        [self.across(x), self.down(y)]
    }

    fn across(&self, x: f64) -> f64 {
        let [left, _, width, _] = self.frame;
        left + width * (x - self.x.range.low) / self.x.range.span()
    }

    fn down(&self, y: f64) -> f64 {
        let [_, top, _, height] = self.frame;
        top + height * (self.y.range.high - y) / self.y.range.span()
    }

    /// Where the base line of the label on the left is: beside the widest number, but on the page.
    fn label_left(&self) -> f64 {
        let widths = self.y.ticks.iter().map(|tick| text::width(&tick.name, NUMBERS));
        let beside = self.left - GAP - widths.fold(NARROWEST, f64::max) - 12.0;
        self.frame[0] - self.left + beside.max(15.0)
    }
}
