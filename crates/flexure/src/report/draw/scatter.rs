//! One panel of points on two logarithmic axes.

use super::axes::{Axes, Axis, BOTTOM};
use super::marker::{Marker, RADIUS};
use super::range::Range;
use super::scene::{Anchor, Lettering, Point, Scene};
use super::style::{INK, Stroke, bold, letters};
use super::text;
use super::ticks::logarithmic;

/// A point with its mark, in the units of the axes.
pub(crate) struct Item {
    pub x: f64,
    pub y: f64,
    pub marker: Marker,
}

/// A panel: points that have a place, and marks of what has none.
pub(crate) struct Scatter<'a> {
    /// Left, top, width and height of everything, labels included [px].
    pub place: [f64; 4],
    pub title: &'a str,
    pub x_label: &'a str,
    pub y_label: &'a str,
    pub points: Vec<Item>,
    /// A value of x that a dotted line marks; none where it is no positive number.
    pub line: f64,
    /// What the marks beside the title are of, and the marks.
    pub aside: (&'a str, Vec<Marker>),
}

const LEFT: f64 = 78.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 34.0;
const MARK: Stroke = Stroke { color: INK, width: 1.4, dash: &[2.0, 4.0] };
const NAMES: Lettering = letters(13.0, INK);
/// Space between an axis' end and the outermost points, as a part of the axis.
const ROOM: f64 = 0.08;
/// Shortest axis, in decades.
const SHORTEST: f64 = 0.12;

impl Scatter<'_> {
    pub(crate) fn draw(&self, scene: &mut Scene) {
        let [left, top, width, height] = self.place;
        let marked = Some(self.line).filter(|x| x.is_finite() && *x > 0.0);
        let x = exponents(self.points.iter().map(|point| point.x).chain(marked));
        let y = exponents(self.points.iter().map(|point| point.y));
        let axes = Axes {
            frame: [left + LEFT, top + TOP, width - LEFT - RIGHT, height - TOP - BOTTOM],
            left: LEFT,
            x: Axis { range: x, ticks: logarithmic(x, 5.0), label: self.x_label },
            y: Axis { range: y, ticks: logarithmic(y, 6.0), label: self.y_label },
        };
        if !self.title.is_empty() {
            scene.text([left + LEFT, top + 22.0], self.title, bold(15.0, INK), Anchor::Start);
        }
        self.draw_aside(scene);
        axes.draw(scene);
        if let Some(value) = marked {
            axes.mark(scene, value.log10(), MARK);
        }
        self.draw_points(scene, &axes);
    }

    /// Marks that would cover each other stand side by side.
    fn draw_points(&self, scene: &mut Scene, axes: &Axes) {
        let mut drawn: Vec<Point> = Vec::new();
        for Item { x, y, marker } in &self.points {
            // What has no logarithm lies on the lower end.
            let at = axes.place(x.log10().max(axes.x.range.low), y.log10().max(axes.y.range.low));
            let at = beside(at, &drawn);
            marker.draw(scene, at, RADIUS);
            drawn.push(at);
        }
    }

    /// Flush right, beside the title.
    fn draw_aside(&self, scene: &mut Scene) {
        const STEP: f64 = 15.0;
        let (what, markers) = &self.aside;
        if markers.is_empty() {
            return;
        }
        let [left, top, width, _] = self.place;
        let start = left + width - RIGHT - STEP * markers.len() as f64;
        scene.text([start - 2.0, top + 21.5], what, NAMES, Anchor::End);
        for (i, marker) in markers.iter().enumerate() {
            marker.draw(scene, [start + STEP * (i as f64 + 0.5), top + 17.0], 0.8 * RADIUS);
        }
    }
}

/// The place closest to `at`, to its right or left, at which a mark covers none of those at `drawn`.
fn beside([x, y]: Point, drawn: &[Point]) -> Point {
    /// Between the middles of two marks, in radii, and the step of the search.
    const APART: f64 = 2.0;
    const STEP: f64 = 0.25;
    let free = |at: &Point| drawn.iter().all(|[x, y]| (x - at[0]).hypot(y - at[1]) >= APART * RADIUS);
    let steps = (0..).map(|k: u32| STEP * RADIUS * f64::from(k));
    let mut places = steps.flat_map(|step| [[x + step, y], [x - step, y]]);
    places.find(free).unwrap_or([x, y])
}

/// A row or more of marks with their names from `y` down. Returns the height of the rows.
pub(crate) fn legend(scene: &mut Scene, [left, y]: Point, entries: &[(String, Marker)]) -> f64 {
    const ROW: f64 = 22.0;
    const NAMES: Lettering = letters(14.0, INK);
    let (mut x, mut row) = (left, 0.0);
    for (name, marker) in entries {
        let advance = 18.0 + text::width(name, NAMES) + 22.0;
        if x > left && x + advance > scene.width - left {
            (x, row) = (left, row + ROW);
        }
        marker.draw(scene, [x + RADIUS, y + row - 5.0], RADIUS);
        scene.text([x + 18.0, y + row], name, NAMES, Anchor::Start);
        x += advance;
    }
    row + ROW
}

/// The exponents of ten that an axis for these values goes through, with room at both ends.
fn exponents(values: impl Iterator<Item = f64>) -> Range {
    let (low, high) = values
        .filter(|value| value.is_finite() && *value > 0.0)
        .map(f64::log10)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if low > high {
        return Range { low: -1.0, high: 1.0 };
    }
    let (middle, half) = (0.5 * (low + high), (0.5 * (high - low)).max(0.5 * SHORTEST) * (1.0 + 2.0 * ROOM));
    Range { low: middle - half, high: middle + half }
}

#[cfg(test)]
mod tests {
    use super::{RADIUS, beside, exponents};

    #[test]
    fn marks_on_one_place_all_show() {
        let mut drawn = Vec::new();
        for _ in 0..9 {
            drawn.push(beside([50.0, 20.0], &drawn));
        }
        assert!(drawn.iter().all(|[x, y]| (*y - 20.0).abs() < 1e-9 && (x - 50.0).abs() <= 8.5 * RADIUS));
        let apart = |a: f64, b: f64| (a - b).abs() >= 2.0 * RADIUS;
        assert!((0..9).all(|i| (0..i).all(|j| apart(drawn[i][0], drawn[j][0]))), "{drawn:?}");
        assert_eq!(beside([50.0, 90.0], &drawn).map(f64::to_bits), [50.0, 90.0].map(f64::to_bits));
    }

    #[test]
    fn axes_hold_their_values_and_nothing_gives_an_axis() {
        let axis = exponents([3.0, 0.02, f64::NAN, 0.0].into_iter());
        assert!(axis.contains(3f64.log10()) && axis.contains(0.02f64.log10()) && axis.span() < 3.0);
        assert!(exponents(std::iter::empty()).span() > 0.0 && exponents([5.0].into_iter()).span() > 0.0);
    }
}
