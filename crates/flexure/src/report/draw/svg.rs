//! A drawing as SVG.

use std::fmt::{self, Display, Formatter};

use super::scene::{Anchor, Point, Scene, Shape, Text};
use super::style::{FONT, OPACITY, Stroke, WHITE, in_the_dark};

/// The drawing; text stays text.
pub(crate) fn svg(scene: &Scene) -> String {
    let (width, height) = (Px(scene.width), Px(scene.height));
    let shapes: String = scene.shapes.iter().map(Shape::to_string).collect();
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" role=\"img\" width=\"{width}\" \
         height=\"{height}\" font-family=\"{FONT}\" class=\"flexure\"><style>{}</style><rect width=\"100%\" height=\"100%\" \
         fill=\"{WHITE}\"/>{shapes}</svg>",
        dark()
    )
}

/// Has the colours follow a page that is dark on a screen.
fn dark() -> String {
    let rule = |(light, dark)| {
        format!(".flexure [fill=\"{light}\"]{{fill:{dark}}}.flexure [stroke=\"{light}\"]{{stroke:{dark}}}")
    };
    let rules: String = in_the_dark().map(rule).collect();
    format!("@media screen and (prefers-color-scheme:dark){{{rules}}}")
}

impl Display for Shape {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        match self {
            Self::Line { ends: [[x1, y1], [x2, y2]], stroke } => {
                let [x1, y1, x2, y2] = [x1, y1, x2, y2].map(|&x| Px(x));
                write!(f, "<line x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"{}/>", lines(stroke, 1.0))
            }
            Self::Curve { pieces, stroke } => {
                // In tenths of a pixel: short to write, finer than any screen.
                write!(f, "<path transform=\"scale(.1)\" fill=\"none\" stroke-linejoin=\"round\"")?;
                write!(f, "{} d=\"", lines(stroke, 10.0))?;
                pieces.iter().try_for_each(|piece| steps(f, piece))?;
                f.write_str("\"/>")
            }
            Self::Polygon { corners, fill, rim } => {
                let corners: Vec<String> =
                    corners.iter().map(|&[x, y]| format!("{} {}", Px(x), Px(y))).collect();
                write!(f, "<path fill=\"{fill}\"{} d=\"M{}Z\"/>", lines(rim, 1.0), corners.join("L"))
            }
            Self::Band { corners, fill } => {
                write!(f, "<path transform=\"scale(.1)\" fill=\"{fill}\" fill-opacity=\"{OPACITY}\" d=\"")?;
                steps(f, corners)?;
                f.write_str("Z\"/>")
            }
            Self::Circle { center: [x, y], radius, fill, rim } => {
                let [x, y, radius] = [x, y, radius].map(|&x| Px(x));
                write!(f, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"{fill}\"{}/>", lines(rim, 1.0))
            }
            Self::Text(text) => text.fmt(f),
        }
    }
}

impl Display for Text {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let [x, y] = self.at.map(Px);
        let anchor = match self.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let bold = if self.lettering.bold { " font-weight=\"bold\"" } else { "" };
        write!(f, "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\"{anchor}{bold}", Px(self.lettering.size))?;
        if self.upwards {
            write!(f, " transform=\"rotate(-90 {x} {y})\"")?;
        }
        write!(f, " fill=\"{}\">{}</text>", self.lettering.color, escaped(&self.content))
    }
}

/// The attributes of a stroke, in units of which a pixel has `scale`.
fn lines(stroke: &Stroke, scale: f64) -> String {
    let dash: Vec<String> = stroke.dash.iter().map(|&length| Px(scale * length).to_string()).collect();
    let dash =
        if dash.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{}\"", dash.join(" ")) };
    format!(" stroke=\"{}\" stroke-width=\"{}\"{dash}", stroke.color, Px(scale * stroke.width))
}

/// A line through points in relative, whole steps: their sum is exact, so nothing drifts.
fn steps(f: &mut Formatter, points: &[Point]) -> fmt::Result {
    let mut before: Option<[i64; 2]> = None;
    for point in points {
        let [x, y] = point.map(tenths);
        match before {
            None => write!(f, "M{x} {y}")?,
            // A minus sign separates numbers as well as a space does.
            Some([left, above]) if y < above => write!(f, "l{}{}", x - left, y - above)?,
            Some([left, above]) => write!(f, "l{} {}", x - left, y - above)?,
        }
        before = Some([x, y]);
    }
    Ok(())
}

#[expect(clippy::cast_possible_truncation, reason = "on the page: a few hundred thousand at most")]
fn tenths(pixels: f64) -> i64 {
    (10.0 * pixels).round() as i64
}

/// A length to hundredths.
struct Px(f64);

impl Display for Px {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        // Of −0 and 0 the sum is 0.
        write!(f, "{}", (100.0 * self.0).round() / 100.0 + 0.0)
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::{Px, Scene, Shape, Stroke};
    use crate::report::draw::style::INK;

    #[test]
    fn lengths_are_short() {
        let texts = [0.1 + 0.2, 2.0, -0.001, 17.068, 1e3 / 3.0].map(|x| Px(x).to_string());
        assert_eq!(texts, ["0.3", "2", "0", "17.07", "333.33"]);
    }

    #[test]
    fn curves_are_steps_in_tenths() {
        let stroke = Stroke { color: INK, width: 1.3, dash: &[2.0, 4.0] };
        let mut scene = Scene::new(20.0, 10.0);
        let pieces = vec![vec![[1.0, 2.0], [1.5, 1.0], [1.55, 3.0]], vec![[0.0, 0.0], [4.0, 0.0]]];
        scene.shapes.push(Shape::Curve { pieces, stroke });
        let svg = scene.svg();
        assert!(
            svg.contains("stroke-width=\"13\" stroke-dasharray=\"20 40\" d=\"M10 20l5-10l1 20M0 0l40 0\""),
            "{svg}"
        );
    }
}
