//! What logs tell of the joints, as a picture: numbers with their error bars, beside what the robot file says.

use crate::files::number::significant;
use crate::identify::{Estimate, Identified};
use crate::report::draw::range::Range;
use crate::report::draw::scene::Scene;
use crate::report::draw::style::{HOLDS, INK, MUTED, Stroke};
use crate::report::draw::ticks;
use crate::report::draw::tracks::{Bar, Track, swatch, tracks};
use crate::units::raised;

const VALUE: Stroke = Stroke::solid(INK, 2.4);
const BEFORE: Stroke = Stroke { color: MUTED, width: 2.0, dash: &[3.0, 2.0] };
/// Farthest from a number that its axis goes, in % of it.
const FARTHEST: f64 = 300.0;

/// A row a number that the logs know: its error bar of three standard deviations in % of it, and where the robot file had it.
pub fn identified_figure(found: &Identified) -> Scene {
    let subtitle = "error bars of three standard deviations, in % of the number that was found; numbers that the logs do not know have none";
    let legend = [
        ("found".to_owned(), VALUE),
        swatch("three standard deviations", HOLDS),
        ("in the robot file".to_owned(), BEFORE),
    ];
    let rows: Vec<Track> = found
        .joints
        .iter()
        .flat_map(|joint| joint.parameters.iter().filter_map(|estimate| track(&joint.name, estimate)))
        .collect();
    tracks(&format!("{}: what the logs tell", found.robot), subtitle, &legend, rows)
}

/// The row of a number; none where there is neither a number nor one to be found.
fn track(joint: &str, estimate: &Estimate) -> Option<Track> {
    let Estimate { key, unit, value, error, before, known } = *estimate;
    if !known && before.is_none() {
        return None;
    }
    let percent = |x: f64| 100.0 * x / value.abs();
    let error_bar = percent(error).min(FARTHEST);
    let before_at = before.map(|before| percent(before - value)).filter(|_| known);
    let reach = before_at.map_or(0.0, f64::abs).max(error_bar).clamp(0.1, FARTHEST) * 1.2;
    let axis = if known { Range { low: -reach, high: reach } } else { Range { low: -1.0, high: 1.0 } };
    let was = before.map(|before| format!("in the file {}", significant(before, 4)));
    let words = if known {
        let number = format!("{} ± {} {}", significant(value, 5), significant(error, 2), raised(unit));
        [Some(number), was].into_iter().flatten().collect()
    } else {
        [Some("not known".to_owned()), was].into_iter().flatten().collect()
    };
    Some(Track {
        name: format!("{joint}  {} [%]", key.replace('_', " ")),
        axis,
        ticks: if known { ticks::even(axis, 6.0) } else { Vec::new() },
        bars: if known {
            vec![Bar { height: 0.4, ..Bar::whole(-error_bar, error_bar, HOLDS) }]
        } else {
            Vec::new()
        },
        marks: if known {
            std::iter::once((0.0, VALUE)).chain(before_at.map(|at| (at, BEFORE))).collect()
        } else {
            Vec::new()
        },
        words,
    })
}
