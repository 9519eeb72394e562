//! Marks of points in figures: a shape and a colour for each law.

use super::scene::{Point, Scene, Shape};
use super::style::{INK, Stroke, WHITE, hue};

/// Radius of a mark that stands alone [px].
pub(crate) const RADIUS: f64 = 6.0;

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
pub(crate) struct Marker {
    index: usize,
    /// Whether it has a dark rim.
    emphasised: bool,
}

impl Marker {
    /// Of the law with this index.
    pub(crate) fn new(index: usize, emphasised: bool) -> Self {
        Self { index, emphasised }
    }

    /// Draws it about a point.
    pub(crate) fn draw(self, scene: &mut Scene, center: Point, radius: f64) {
        let (fill, shape) = (hue(self.index), SHAPES[self.index % SHAPES.len()]);
        let rim = if self.emphasised { Stroke::solid(INK, 1.8) } else { Stroke::solid(WHITE, 0.8) };
        scene.shapes.push(if shape.is_empty() {
            Shape::Circle { center, radius, fill, rim }
        } else {
            let [x, y] = center;
            let corner = |[right, down]: &[f64; 2]| [x + radius * right, y + radius * down];
            Shape::Polygon { corners: shape.iter().map(corner).collect(), fill, rim }
        });
    }
}
