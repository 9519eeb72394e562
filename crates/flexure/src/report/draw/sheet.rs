//! The page of a figure: title, and one legend for all panels.

use super::scene::{Anchor, Lettering, Scene};
use super::style::{INK, MUTED, Stroke, bold, letters};
use super::text;

/// White border on the left and the right [px].
pub(crate) const MARGIN: f64 = 24.0;

/// An empty white page with its title and subtitle (either may be empty), and where the base line of what follows is.
pub(crate) fn page(width: f64, title: &str, subtitle: &str) -> (Scene, f64) {
    const LINE: f64 = 19.0;
    const WORDS: Lettering = letters(14.0, MUTED);
    let mut scene = Scene::new(width, 0.0);
    fitted_text(&mut scene, 30.0, title, bold(21.0, INK));
    let mut y = 52.0;
    for line in lines(subtitle, width - 2.0 * MARGIN, WORDS) {
        fitted_text(&mut scene, y, &line, WORDS);
        y += LINE;
    }
    (scene, y + 11.0)
}

/// `content` in lines that are at most `room` wide [px], as far as its words allow.
fn lines(content: &str, room: f64, lettering: Lettering) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in content.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text::width(&format!("{line} {word}"), lettering) <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// A legend in rows from `y` down: each entry a piece of its line and its name. Returns the height of the rows.
pub(crate) fn line_legend(scene: &mut Scene, y: f64, entries: &[(String, Stroke)]) -> f64 {
    const SAMPLE: f64 = 26.0;
    const ROW: f64 = 22.0;
    const NAMES: Lettering = letters(14.0, INK);
    let (mut x, mut row) = (MARGIN, 0.0);
    for (name, stroke) in entries {
        let advance = SAMPLE + 6.0 + text::width(name, NAMES) + 22.0;
        if x > MARGIN && x + advance > scene.width {
            (x, row) = (MARGIN, row + ROW);
        }
        let level = y + row - 4.5;
        scene.line([x, level], [x + SAMPLE, level], Stroke { width: stroke.width.max(1.8), ..*stroke });
        scene.text([x + SAMPLE + 6.0, y + row], name, NAMES, Anchor::Start);
        x += advance;
    }
    row + ROW
}

/// Text that shrinks until it fits the page: titles come from users, and words have no end.
fn fitted_text(scene: &mut Scene, y: f64, content: &str, lettering: Lettering) {
    const SMALLEST: f64 = 9.0;
    let room = scene.width - 2.0 * MARGIN;
    let fits = room / text::width(content, lettering);
    let size = (lettering.size * fits).floor().clamp(SMALLEST, lettering.size);
    if !content.is_empty() {
        scene.text([MARGIN, y], content, Lettering { size, ..lettering }, Anchor::Start);
    }
}
