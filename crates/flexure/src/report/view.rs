//! A run in motion: one page with the robot, its motors, its springs and what acts on them, that needs nothing else.
//!
//! The page itself is written in JavaScript, in the folder `viewer` of the repository, and is here as it was built there; this puts the runs into it.

mod document;
mod events;
mod film;
mod shapes;

pub use film::Film;

use super::sketch::Sketch;
use crate::files::{Problem, Problems};
use crate::scenario::Scenario;
use crate::simulate::Run;
use document::Document;

/// The page without a run.
const PAGE: &str = include_str!("view.html");

/// What stands in the page where the runs go.
const NOTHING: &str = r#"id="flexure-runs">null<"#;

/// A run to be shown.
#[derive(Clone, Copy, Debug)]
pub struct Viewed<'a> {
    /// The scenario that was run.
    pub scenario: &'a Scenario,
    /// What came of it.
    pub run: &'a Run,
    /// Its instants.
    pub film: &'a Film,
    /// What figures show of it: it knows when the robot was stopped.
    pub sketch: &'a Sketch,
    /// Whether that is good; none of a run that was broken off.
    pub good: Option<bool>,
    /// What came of it in a sentence.
    pub words: &'a str,
}

/// The page that shows `runs`, one or two, side by side, with warnings of robots whose links it has in another way than their URDFs say.
///
/// # Errors
/// As [`Scenario::open`].
///
/// # Panics
/// Never: what is written as JSON has no keys but names.
pub fn view(runs: &[Viewed<'_>]) -> Result<(String, Vec<Problem>), Problems> {
    let (document, warnings) = Document::new(runs)?;
    let document = serde_json::to_string(&document).expect("a document of names, numbers and lists");
    // No text of a file ends the element that it stands in.
    let document = document.replace('<', "\\u003c");
    Ok((PAGE.replacen(NOTHING, &format!(r#"id="flexure-runs">{document}<"#), 1), warnings))
}
