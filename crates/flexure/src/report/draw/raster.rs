//! A drawing as pixels.
#![expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "pixels are drawn in f32")]

use std::fmt;

use tiny_skia::{Color, FillRule, LineJoin, Paint, Path, PathBuilder, Pixmap, StrokeDash, Transform};
use ttf_parser::OutlineBuilder;

use super::png;
use super::scene::{Point, Scene, Shape};
use super::style::{self, OPACITY, Stroke};
use super::text;

/// Width of every picture \[px\].
pub const WIDTH: u32 = 1600;

/// Why a picture could not be made: the drawing has no area, or is more than ten times as high as wide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterError {
    /// Width of the drawing \[px\].
    pub width: f64,
    /// Height of the drawing \[px\].
    pub height: f64,
}

impl fmt::Display for RasterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a drawing of {} by {} px has no picture", self.width, self.height)
    }
}

impl std::error::Error for RasterError {}

/// The drawing as a PNG file, [`WIDTH`] pixels wide.
pub(crate) fn png(scene: &Scene) -> Result<Vec<u8>, RasterError> {
    let no_area = || RasterError { width: scene.width, height: scene.height };
    let scale = f64::from(WIDTH) / scene.width;
    let height = Some((scale * scene.height).round()).filter(|height| *height <= 10.0 * f64::from(WIDTH));
    // Not a number, and below zero: zero, which has no pixels.
    let height = height.ok_or_else(no_area)? as u32;
    let mut canvas = Canvas {
        pixels: Pixmap::new(WIDTH, height).ok_or_else(no_area)?,
        page: Transform::from_scale(scale as f32, scale as f32),
    };
    canvas.pixels.fill(Color::WHITE);
    scene.shapes.iter().for_each(|shape| canvas.draw(shape));
    let rgb: Vec<u8> = canvas.pixels.data().chunks_exact(4).flat_map(|pixel| &pixel[..3]).copied().collect();
    Ok(png::encode(WIDTH, height, &rgb))
}

struct Canvas {
    pixels: Pixmap,
    /// From the drawing's pixels to those of the picture.
    page: Transform,
}

impl Canvas {
    fn draw(&mut self, shape: &Shape) {
        match shape {
            Shape::Line { ends, stroke } => self.stroke(lines(&[ends]), stroke),
            Shape::Curve { pieces, stroke } => self.stroke(lines(pieces), stroke),
            Shape::Polygon { corners, fill, rim } => {
                let mut pen = pen(&[corners]);
                pen.close();
                let path = pen.finish();
                self.fill(path.as_ref(), *fill);
                self.stroke(path, rim);
            }
            Shape::Band { corners, fill } => {
                let mut pen = pen(&[corners]);
                pen.close();
                self.cover(pen.finish().as_ref(), *fill, OPACITY);
            }
            Shape::Circle { center: [x, y], radius, fill, rim } => {
                let path = PathBuilder::from_circle(*x as f32, *y as f32, *radius as f32);
                self.fill(path.as_ref(), *fill);
                self.stroke(path, rim);
            }
            Shape::Text(text) => {
                let mut pen = Pen(PathBuilder::new());
                text::outline(text, &mut pen);
                self.fill(pen.0.finish().as_ref(), text.lettering.color);
            }
        }
    }

    fn fill(&mut self, path: Option<&Path>, color: style::Color) {
        self.cover(path, color, 1.0);
    }

    fn cover(&mut self, path: Option<&Path>, color: style::Color, opacity: f32) {
        if let Some(path) = path {
            let mut paint = paint(color);
            paint.shader.apply_opacity(opacity);
            self.pixels.fill_path(path, &paint, FillRule::Winding, self.page, None);
        }
    }

    fn stroke(&mut self, path: Option<Path>, Stroke { color, width, dash }: &Stroke) {
        let dash = dash.iter().map(|&length| length as f32).collect();
        let stroke = tiny_skia::Stroke {
            width: *width as f32,
            line_join: LineJoin::Round,
            // None for a solid line.
            dash: StrokeDash::new(dash, 0.0),
            ..tiny_skia::Stroke::default()
        };
        if let Some(path) = path {
            self.pixels.stroke_path(&path, &paint(*color), &stroke, self.page, None);
        }
    }
}

fn paint(style::Color([red, green, blue]): style::Color) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(red, green, blue, 255);
    paint
}

/// Straight lines through the points of each piece.
fn lines<P: AsRef<[Point]>>(pieces: &[P]) -> Option<Path> {
    pen(pieces).finish()
}

fn pen<P: AsRef<[Point]>>(pieces: &[P]) -> PathBuilder {
    let mut pen = PathBuilder::new();
    for piece in pieces {
        for (k, point) in piece.as_ref().iter().enumerate() {
            let [x, y] = point.map(|x| x as f32);
            if k == 0 { pen.move_to(x, y) } else { pen.line_to(x, y) }
        }
    }
    pen
}

/// Collects the outlines of glyphs as a path.
struct Pen(PathBuilder);

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.0.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.0.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.0.close();
    }
}
