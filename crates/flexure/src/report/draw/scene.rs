//! A drawing as data: lines, shapes and text in pixels, from which both the SVG and the PNG are made.

use super::raster::{self, RasterError};
use super::style::{Color, Stroke};
use super::svg;

/// Right and down from the upper left corner [px].
pub(crate) type Point = [f64; 2];

/// A figure: white page, shapes drawn in their order.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Width of the page [px].
    pub(crate) width: f64,
    /// Height of the page [px].
    pub(crate) height: f64,
    pub(crate) shapes: Vec<Shape>,
}

/// Something drawn.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Line {
        ends: [Point; 2],
        stroke: Stroke,
    },
    /// Lines through points, each piece on its own.
    Curve {
        pieces: Vec<Vec<Point>>,
        stroke: Stroke,
    },
    /// A filled shape with straight sides.
    Polygon {
        corners: Vec<Point>,
        fill: Color,
        rim: Stroke,
    },
    /// A shape with straight sides through which one sees what is behind it.
    Band {
        corners: Vec<Point>,
        fill: Color,
    },
    /// A filled circle.
    Circle {
        center: Point,
        radius: f64,
        fill: Color,
        rim: Stroke,
    },
    Text(Text),
}

/// A line of text.
#[derive(Clone, Debug)]
pub(crate) struct Text {
    /// Point on the base line at which the text is anchored.
    pub at: Point,
    pub content: String,
    pub lettering: Lettering,
    /// Which part of the text is at `at`.
    pub anchor: Anchor,
    /// Whether it runs upwards instead of to the right.
    pub upwards: bool,
}

/// How text looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lettering {
    /// Size of the letters' square [px].
    pub size: f64,
    pub bold: bool,
    pub color: Color,
}

/// Part of a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

impl Scene {
    pub(crate) fn new(width: f64, height: f64) -> Self {
        Self { width, height, shapes: Vec::new() }
    }

    pub(crate) fn line(&mut self, from: Point, to: Point, stroke: Stroke) {
        self.shapes.push(Shape::Line { ends: [from, to], stroke });
    }

    pub(crate) fn text(&mut self, at: Point, content: &str, lettering: Lettering, anchor: Anchor) {
        let content = plain(content);
        self.shapes.push(Shape::Text(Text { at, content, lettering, anchor, upwards: false }));
    }

    /// Text that runs upwards, with its middle at `at`.
    pub(crate) fn upwards(&mut self, at: Point, content: &str, lettering: Lettering) {
        let (content, anchor) = (plain(content), Anchor::Middle);
        self.shapes.push(Shape::Text(Text { at, content, lettering, anchor, upwards: true }));
    }

    /// A filled rectangle: left, top, width and height, with a rim.
    pub(crate) fn rectangle(&mut self, [x, y, width, height]: [f64; 4], fill: Color, rim: Stroke) {
        let corners = vec![[x, y], [x + width, y], [x + width, y + height], [x, y + height]];
        self.shapes.push(Shape::Polygon { corners, fill, rim });
    }

    /// The drawing as SVG, scalable to any width; text stays text.
    pub fn svg(&self) -> String {
        svg::svg(self)
    }

    /// The drawing as a PNG file, [`WIDTH`](raster::WIDTH) pixels wide: the same pixels on every machine.
    ///
    /// # Errors
    /// If the drawing is more than ten times as high as wide.
    pub fn png(&self) -> Result<Vec<u8>, RasterError> {
        raster::png(self)
    }
}

/// As XML shows it: without control characters, which it cannot say, and with one space for many.
fn plain(content: &str) -> String {
    let words: Vec<String> = content
        .split_ascii_whitespace()
        .map(|word| {
            word.chars().filter(|c| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}')).collect()
        })
        .collect();
    words.join(" ")
}
