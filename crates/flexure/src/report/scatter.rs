//! One panel of points on two logarithmic axes.

use kuva::render::render::{Primitive, TextAnchor};

use crate::files::number::{power_of_ten, short};
use crate::report::marker::{Marker, RADIUS};
use crate::report::range::{Range, round_step};
use crate::report::sheet::{Sheet, text_width};
use crate::report::style::{GRID, INK, MUTED};

/// A point, in the units of the axes.
pub(super) struct Point {
    pub x: f64,
    pub y: f64,
    pub marker: Marker,
}

/// A panel: points that have a place, and marks of what has none.
pub(super) struct Scatter<'a> {
    /// Left, top, width and height of everything, labels included [px].
    pub place: [f64; 4],
    pub title: &'a str,
    pub x_label: &'a str,
    pub y_label: &'a str,
    pub points: Vec<Point>,
    /// A value of x that a dotted line marks; none where it is no positive number.
    pub line: f64,
    /// What the marks beside the title are of, and the marks.
    pub aside: (&'a str, Vec<Marker>),
}

const LEFT: f64 = 64.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 46.0;
/// Space between an axis' end and the outermost points, as a part of the axis.
const ROOM: f64 = 0.08;
/// Shortest axis, in decades.
const SHORTEST: f64 = 0.12;

impl Scatter<'_> {
    pub(super) fn draw(&self, sheet: &mut Sheet) {
        let [left, top, width, height] = self.place;
        let frame = [left + LEFT, top + TOP, width - LEFT - RIGHT, height - TOP - BOTTOM];
        let marked = Some(self.line).filter(|x| x.is_finite() && *x > 0.0);
        let x = exponents(self.points.iter().map(|point| point.x).chain(marked));
        let y = exponents(self.points.iter().map(|point| point.y));
        sheet.text((left + LEFT, top + 22.0), self.title, 15, INK, true);
        self.draw_aside(sheet);
        // What has no logarithm lies on the lower end.
        let across = |value: f64| frame[0] + frame[2] * (value.log10().max(x.low) - x.low) / x.span();
        let down = |value: f64| frame[1] + frame[3] * (y.high - value.log10().max(y.low)) / y.span();
        for (value, name) in ticks(x, 5.0) {
            line(sheet, [across(value), frame[1], across(value), frame[1] + frame[3]], GRID, None);
            let below = (across(value), frame[1] + frame[3] + 17.0);
            label(sheet, below, &name, TextAnchor::Middle, None);
        }
        for (value, name) in ticks(y, 6.0) {
            line(sheet, [frame[0], down(value), frame[0] + frame[2], down(value)], GRID, None);
            label(sheet, (frame[0] - 6.0, down(value) + 4.5), &name, TextAnchor::End, None);
        }
        sheet.scene.add(Primitive::Rect {
            x: frame[0],
            y: frame[1],
            width: frame[2],
            height: frame[3],
            fill: "none".into(),
            stroke: Some(MUTED.into()),
            stroke_width: Some(1.0),
            opacity: None,
        });
        let middle = (frame[0] + 0.5 * frame[2], frame[1] + frame[3] + 36.0);
        label(sheet, middle, self.x_label, TextAnchor::Middle, None);
        label(sheet, (left + 14.0, frame[1] + 0.5 * frame[3]), self.y_label, TextAnchor::Middle, Some(-90.0));
        if let Some(value) = marked {
            line(sheet, [across(value), frame[1], across(value), frame[1] + frame[3]], INK, Some("2 4"));
        }
        self.draw_points(sheet, &across, &down);
    }

    /// Points that lie on each other are drawn smaller and smaller, so that all of them show.
    fn draw_points(&self, sheet: &mut Sheet, across: &dyn Fn(f64) -> f64, down: &dyn Fn(f64) -> f64) {
        let mut drawn: Vec<(f64, f64)> = Vec::new();
        for Point { x, y, marker } in &self.points {
            let at = (across(*x), down(*y));
            let below = drawn.iter().filter(|(x, y)| (x - at.0).hypot(y - at.1) < 0.5 * RADIUS).count();
            marker.draw(sheet, at, RADIUS * 0.72_f64.powi(i32::try_from(below).unwrap_or(i32::MAX)));
            drawn.push(at);
        }
    }

    /// Flush right, beside the title.
    fn draw_aside(&self, sheet: &mut Sheet) {
        const STEP: f64 = 15.0;
        let (what, markers) = &self.aside;
        if markers.is_empty() {
            return;
        }
        let [left, top, width, _] = self.place;
        let start = left + width - RIGHT - STEP * markers.len() as f64;
        label(sheet, (start - 2.0, top + 21.5), what, TextAnchor::End, None);
        for (i, marker) in markers.iter().enumerate() {
            marker.draw(sheet, (start + STEP * (i as f64 + 0.5), top + 17.0), 0.8 * RADIUS);
        }
    }
}

/// A row or more of marks with their names from `y` down. Returns the height of the rows.
pub(super) fn legend(sheet: &mut Sheet, (left, y): (f64, f64), entries: &[(String, Marker)]) -> f64 {
    const ROW: f64 = 22.0;
    let (mut x, mut row) = (left, 0.0);
    for (name, marker) in entries {
        let advance = 18.0 + text_width(name, 14) + 16.0;
        if x > left && x + advance > sheet.scene.width - left {
            (x, row) = (left, row + ROW);
        }
        marker.draw(sheet, (x + RADIUS, y + row - 5.0), RADIUS);
        sheet.text((x + 18.0, y + row), name, 14, INK, false);
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

/// Values along an axis of these exponents, at most about `most`, and what is written there: powers of ten on long axes,
/// 1, 2 and 5 times them on shorter ones, even steps where the axis is so short that it is hardly bent.
fn ticks(axis: Range, most: f64) -> Vec<(f64, String)> {
    let ends = Range { low: 10f64.powf(axis.low), high: 10f64.powf(axis.high) };
    let named = |value: f64| (value, name(value));
    if axis.span() < 0.6 {
        let step = round_step(ends, most);
        let first = (ends.low / step).ceil();
        return steps(first, (ends.high / step).floor()).map(|k| named(k * step)).collect();
    }
    let multiples: &[f64] = if axis.span() < 2.2 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let every = (axis.span() / most).ceil().max(1.0);
    steps(axis.low.floor(), axis.high.floor())
        .filter(|decade| multiples.len() > 1 || (decade / every).fract() == 0.0)
        .flat_map(|decade| multiples.iter().map(move |m| m * 10f64.powf(decade)))
        .filter(|value| ends.contains(*value))
        .map(named)
        .collect()
}

/// A round number, as short as it gets.
#[expect(clippy::cast_possible_truncation, reason = "an exponent of ten of an f64: within ±308")]
fn name(value: f64) -> String {
    // A product of a power of ten is off by a rounding.
    let exponent = (value.log10() + 1e-9).floor();
    if (-3.0..5.0).contains(&exponent) {
        return short(value, 4);
    }
    match short(value / 10f64.powf(exponent), 4).as_str() {
        "1" => power_of_ten(exponent as i32),
        mantissa => format!("{mantissa}×{}", power_of_ten(exponent as i32)),
    }
}

/// Whole numbers, both ends included.
fn steps(first: f64, last: f64) -> impl Iterator<Item = f64> {
    std::iter::successors(Some(first), |k| Some(k + 1.0)).take_while(move |k| *k <= last)
}

fn line(sheet: &mut Sheet, [x1, y1, x2, y2]: [f64; 4], color: &str, dash: Option<&str>) {
    sheet.scene.add(Primitive::Line {
        x1,
        y1,
        x2,
        y2,
        stroke: color.into(),
        stroke_width: if dash.is_some() { 1.4 } else { 1.0 },
        stroke_dasharray: dash.map(str::to_owned),
    });
}

fn label(sheet: &mut Sheet, (x, y): (f64, f64), content: &str, anchor: TextAnchor, rotate: Option<f64>) {
    sheet.scene.add(Primitive::Text {
        x,
        y,
        content: content.to_owned(),
        size: 13,
        anchor,
        rotate,
        bold: false,
        color: Some(INK.into()),
    });
}

#[cfg(test)]
mod tests {
    use super::{Range, exponents, name, ticks};

    /// At least two labels on any axis, at most nine, all inside.
    #[test]
    fn every_axis_has_labels() {
        for k in 1..60 {
            let span = 0.13 * f64::from(k);
            for low in [-7.3, -0.04, 0.0, 2.71] {
                let axis = Range { low, high: low + span };
                let values: Vec<f64> = ticks(axis, 5.0).into_iter().map(|(value, _)| value).collect();
                assert!((2..=9).contains(&values.len()), "{axis:?}: {values:?}");
                assert!(values.iter().all(|value| axis.contains(value.log10())), "{axis:?}: {values:?}");
            }
        }
    }

    #[test]
    fn labels_are_short() {
        let names = [0.0001, 2e-7, 0.001, 0.2, 1.0, 50.0, 5e5, 2.25].map(name);
        assert_eq!(names, ["10⁻⁴", "2×10⁻⁷", "0.001", "0.2", "1", "50", "5×10⁵", "2.25"]);
    }

    #[test]
    fn axes_hold_their_values_and_nothing_gives_an_axis() {
        let axis = exponents([3.0, 0.02, f64::NAN, 0.0].into_iter());
        assert!(axis.contains(3f64.log10()) && axis.contains(0.02f64.log10()) && axis.span() < 3.0);
        assert!(exponents(std::iter::empty()).span() > 0.0 && exponents([5.0].into_iter()).span() > 0.0);
    }
}
