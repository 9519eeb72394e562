//! One frame with its axes and curves.

use std::sync::Arc;

use kuva::render::axis::{add_axes_and_grid, add_labels_and_title};
use kuva::render::layout::{ComputedLayout, Layout, TickFormat};
use kuva::render::render::{PathData, Primitive};
use kuva::render::theme::Theme;

use crate::files::number::{power_of_ten, short};
use crate::report::curve::Curve;
use crate::report::range::{Range, decade_step, round_step};
use crate::report::sheet::Sheet;
use crate::report::style::{FONT, GRID, INK, MUTED};

/// How the numbers along an axis are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Labels {
    /// As they are.
    Linear,
    /// The axis carries exponents of ten.
    Decades,
}

/// A frame and what is written on it.
pub(super) struct Axes<'a> {
    /// Left, top, width and height of everything, labels included [px].
    pub place: [f64; 4],
    pub x: Range,
    pub y: Range,
    pub x_label: &'a str,
    pub y_label: &'a str,
    pub y_labels: Labels,
    /// Room left of the frame [px].
    pub left: f64,
}

const TOP: f64 = 6.0;
const RIGHT: f64 = 12.0;
const BOTTOM: f64 = 48.0;

impl Axes<'_> {
    /// Draws the frame, then the curves in their order, then a dotted line at `mark` (an instant), if there is one.
    pub(super) fn draw(&self, sheet: &mut Sheet, curves: &[Curve], mark: Option<f64>, buckets: usize) {
        let [x, y, _, _] = self.place;
        let layout = self.layout();
        let computed = ComputedLayout::from_layout(&layout);
        group(sheet, format!("translate({x} {y})"), None);
        add_axes_and_grid(&mut sheet.scene, &computed, &layout);
        add_labels_and_title(&mut sheet.scene, &computed, &layout);
        sheet.scene.add(Primitive::GroupEnd);

        let [width, height] = self.frame();
        // Paths are in whole tenths of a pixel: short to write, finer than any screen.
        let attributes = "stroke-linejoin=\"round\"".to_owned();
        group(sheet, format!("translate({} {}) scale(.1)", x + self.left, y + TOP), Some(attributes));
        for curve in curves {
            let d = curve.path(self.x, self.y, width, height, buckets);
            if !d.is_empty() {
                sheet.scene.add(path(
                    d,
                    curve.stroke.color,
                    curve.stroke.width,
                    curve.stroke.dasharray(10.0),
                ));
            }
        }
        if let Some(t) = mark {
            let right = (10.0 * width * (t - self.x.low) / self.x.span()).round();
            sheet.scene.add(path(
                format!("M{right} 0v{}", 10.0 * height),
                MUTED,
                1.2,
                Some("15 30".to_owned()),
            ));
        }
        sheet.scene.add(Primitive::GroupEnd);
    }

    fn frame(&self) -> [f64; 2] {
        let [_, _, width, height] = self.place;
        [width - self.left - RIGHT, height - TOP - BOTTOM]
    }

    fn layout(&self) -> Layout {
        let [_, _, width, height] = self.place;
        let [frame_width, _] = self.frame();
        let theme = Theme {
            grid_color: GRID.to_owned(),
            axis_color: MUTED.to_owned(),
            tick_color: MUTED.to_owned(),
            text_color: INK.to_owned(),
            ..Theme::light()
        };
        let y_step = match self.y_labels {
            Labels::Linear => round_step(self.y, 6.0),
            Labels::Decades => decade_step(self.y),
        };
        let y_labels = self.y_labels;
        Layout::new((self.x.low, self.x.high), (self.y.low, self.y.high))
            .with_width(width)
            .with_height(height)
            .with_force_margins(self.left, RIGHT)
            .with_force_margins_y(TOP, BOTTOM)
            .with_x_axis_min(self.x.low)
            .with_x_axis_max(self.x.high)
            .with_y_axis_min(self.y.low)
            .with_y_axis_max(self.y.high)
            .with_x_tick_step(round_step(self.x, (frame_width / 55.0).clamp(2.0, 10.0)))
            .with_y_tick_step(y_step)
            .with_x_tick_format(TickFormat::Custom(Arc::new(number)))
            .with_y_tick_format(TickFormat::Custom(Arc::new(move |value| label(y_labels, value))))
            .with_x_label(self.x_label)
            .with_y_label(self.y_label)
            .with_tick_size(13)
            .with_label_size(14)
            .with_box_axes()
            .with_tick_align("inside")
            .with_font_family(FONT)
            .with_theme(theme)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "an exponent of ten of an f64: within ±308")]
fn label(labels: Labels, value: f64) -> String {
    match labels {
        Labels::Linear => number(value),
        Labels::Decades => power_of_ten(value.round() as i32),
    }
}

/// A step apart, labels differ in fewer than six digits; 0 comes out of the stepping as a rounding error.
fn number(value: f64) -> String {
    if value.abs() < 1e-12 { "0".to_owned() } else { short(value, 6) }
}

fn group(sheet: &mut Sheet, transform: String, extra_attrs: Option<String>) {
    sheet.scene.add(Primitive::GroupStart { transform: Some(transform), title: None, extra_attrs });
}

/// A stroke in tenths of a pixel; `width` in pixels.
fn path(d: String, color: &str, width: f64, stroke_dasharray: Option<String>) -> Primitive {
    Primitive::Path(Box::new(PathData {
        d,
        fill: None,
        stroke: color.into(),
        stroke_width: (100.0 * width).round() / 10.0,
        opacity: None,
        stroke_dasharray,
    }))
}
