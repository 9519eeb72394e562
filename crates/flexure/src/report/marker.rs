//! Marks of points in figures: a shape and a colour for each law.

use kuva::render::render::{PathData, Primitive};

use crate::report::sheet::Sheet;
use crate::report::style::{INK, hue};

/// Radius of a mark that stands alone [px].
pub(super) const RADIUS: f64 = 6.0;

/// Corners of the shapes, on a circle of radius 1, in steps of y downwards; none for the circle.
const SHAPES: [&[[f64; 2]]; 5] = [
    &[],
    &[[-0.85, -0.85], [0.85, -0.85], [0.85, 0.85], [-0.85, 0.85]],
    &[[0.0, -1.15], [1.05, 0.75], [-1.05, 0.75]],
    &[[0.0, -1.2], [1.2, 0.0], [0.0, 1.2], [-1.2, 0.0]],
    &[[0.0, 1.15], [1.05, -0.75], [-1.05, -0.75]],
];

/// How the points of a law look. Shape and colour repeat after 5 and 8: together they tell 40 laws apart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Marker {
    index: usize,
    /// Whether it has a dark rim.
    emphasised: bool,
}

impl Marker {
    /// Of the law with this index.
    pub(super) fn new(index: usize, emphasised: bool) -> Self {
        Self { index, emphasised }
    }

    /// Draws it about `(x, y)`.
    pub(super) fn draw(self, sheet: &mut Sheet, (x, y): (f64, f64), radius: f64) {
        let (fill, shape) = (hue(self.index), SHAPES[self.index % SHAPES.len()]);
        let (stroke, stroke_width) = if self.emphasised { (INK, 1.8) } else { ("#ffffff", 0.8) };
        if shape.is_empty() {
            sheet.scene.add(Primitive::Circle {
                cx: round(x),
                cy: round(y),
                r: radius,
                fill: fill.into(),
                fill_opacity: None,
                stroke: Some(stroke.into()),
                stroke_width: Some(stroke_width),
            });
            return;
        }
        let corners: Vec<String> = shape
            .iter()
            .map(|[right, down]| format!("{} {}", round(x + radius * right), round(y + radius * down)))
            .collect();
        sheet.scene.add(Primitive::Path(Box::new(PathData {
            d: format!("M{}Z", corners.join("L")),
            fill: Some(fill.into()),
            stroke: stroke.into(),
            stroke_width,
            opacity: None,
            stroke_dasharray: None,
        })));
    }
}

/// To tenths of a pixel.
fn round(x: f64) -> f64 {
    (10.0 * x).round() / 10.0
}
