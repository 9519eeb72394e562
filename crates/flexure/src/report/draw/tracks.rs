//! Figures of rows that have an axis each: bars on a track, marks, and what they say in words.

use super::axes::{Axes, Axis};
use super::range::Range;
use super::scene::{Anchor, Lettering, Point, Scene};
use super::sheet::{MARGIN, line_legend, page};
use super::style::{Color, INK, MUTED, Stroke, bold, letters};
use super::text;
use super::ticks::Tick;

const WIDTH: f64 = 1200.0;
/// Room for names and words beside the tracks, at most; longer ones are made smaller [px].
const MOST: f64 = 420.0;
const ROW: f64 = 74.0;
const FRAME: f64 = 28.0;
const NAMES: Lettering = bold(14.0, INK);
const NOTES: Lettering = letters(12.5, MUTED);

/// A row: everything in the units of its own axis.
pub(crate) struct Track {
    pub name: String,
    pub axis: Range,
    pub ticks: Vec<Tick>,
    /// Drawn in their order.
    pub bars: Vec<Bar>,
    /// Lines across the track.
    pub marks: Vec<(f64, Stroke)>,
    /// On the right, at most two lines.
    pub words: Vec<String>,
}

/// A part of a track.
pub(crate) struct Bar {
    pub from: f64,
    pub to: f64,
    pub color: Color,
    /// The part of the track's height that it has.
    pub height: f64,
}

impl Bar {
    /// As high as the track.
    pub(crate) fn whole(from: f64, to: f64, color: Color) -> Self {
        Self { from, to, color, height: 1.0 }
    }
}

/// A line of a legend for bars.
pub(crate) fn swatch(name: &str, color: Color) -> (String, Stroke) {
    (name.to_owned(), Stroke::solid(color, 12.0))
}

/// The tracks below each other, with a legend above them. Where all have the same axis its numbers stand below the last one.
pub(crate) fn tracks(
    title: &str,
    subtitle: &str,
    legend: &[(String, Stroke)],
    mut tracks: Vec<Track>,
) -> Scene {
    let (mut scene, top) = page(WIDTH, title, subtitle);
    let mut top = top + line_legend(&mut scene, top, legend);
    let widest = |texts: &mut dyn Iterator<Item = &String>, lettering| {
        texts.map(|words| text::width(words, lettering)).fold(90.0, f64::max)
    };
    let left = MARGIN + 18.0 + widest(&mut tracks.iter().map(|track| &track.name), NAMES).min(MOST);
    let right = MARGIN + 18.0 + widest(&mut tracks.iter().flat_map(|track| &track.words), NOTES).min(MOST);
    let is_shared = tracks.len() > 1 && tracks.windows(2).all(|pair| pair[0].axis == pair[1].axis);
    let row = if is_shared { FRAME + 20.0 } else { ROW };
    let last = tracks.len().saturating_sub(1);
    for (i, track) in tracks.iter_mut().enumerate() {
        if is_shared && i < last {
            track.ticks.iter_mut().for_each(|tick| tick.name.clear());
        }
        track.draw(&mut scene, [left, top], WIDTH - left - right);
        top += row;
    }
    scene.height = top + if is_shared { 34.0 } else { 4.0 };
    scene
}

impl Track {
    fn draw(&self, scene: &mut Scene, [left, top]: Point, width: f64) {
        let frame = [left, top + 12.0, width, FRAME];
        let ticks = self.ticks.iter().map(|tick| Tick { at: tick.at, name: tick.name.clone() }).collect();
        let axes = Axes {
            frame,
            left,
            x: Axis { range: self.axis, ticks, label: "" },
            y: Axis { range: Range { low: 0.0, high: 1.0 }, ticks: Vec::new(), label: "" },
        };
        axes.draw(scene);
        let Range { low, high } = self.axis;
        for Bar { from, to, color, height } in &self.bars {
            let [from, to] = [from, to].map(|x| axes.place(x.clamp(low, high), 0.0)[0]);
            if to > from {
                let top = frame[1] + 0.5 * FRAME * (1.0 - height);
                scene.rectangle([from, top, to - from, FRAME * height], *color, Stroke::solid(*color, 0.0));
            }
        }
        for (value, stroke) in self.marks.iter().filter(|(value, _)| self.axis.contains(*value)) {
            let [x, _] = axes.place(*value, 0.0);
            scene.line([x, frame[1] - 5.0], [x, frame[1] + FRAME + 5.0], *stroke);
        }
        scene.text(
            [left - 16.0, frame[1] + 0.5 * FRAME + 5.0],
            &self.name,
            fitting(&self.name, NAMES),
            Anchor::End,
        );
        let middle = frame[1] + 0.5 * FRAME + 4.5 - 8.0 * (self.words.len().max(1) - 1) as f64;
        for (line, words) in self.words.iter().enumerate() {
            let at = [frame[0] + frame[2] + 16.0, middle + 16.0 * line as f64];
            scene.text(at, words, fitting(words, NOTES), Anchor::Start);
        }
    }
}

/// As large as there is room for.
fn fitting(content: &str, lettering: Lettering) -> Lettering {
    let size = lettering.size * (MOST / text::width(content, lettering)).min(1.0);
    Lettering { size, ..lettering }
}
