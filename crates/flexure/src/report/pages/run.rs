//! The page of a run.

use maud::{Markup, html as markup};

use super::kit::{Page, Section, Verdict, figure, made, numbers};
use super::runs;
use crate::files::number::{NONE, engineering, short, significant};
use crate::report::assumptions;
use crate::report::draw::scene::Scene;
use crate::report::tables::grid::Grid;
use crate::report::tables::summary::proved_rate;
use crate::scenario::Scenario;
use crate::simulate::{Summary, Used};
use crate::units::{self, Unit, of_joints};

/// What the page of a run tells.
#[derive(Clone, Copy, Debug)]
pub struct RunTold<'a> {
    /// What was run.
    pub scenario: &'a Scenario,
    /// What came of it.
    pub summary: &'a Summary,
    /// When it ended \[s\]: at the end of the scenario, or where it diverged or was broken off.
    pub end: f64,
    /// The same in a sentence.
    pub verdict: &'a Verdict,
    /// Its figure.
    pub figure: &'a Scene,
    /// Whether a proved bound is in it.
    pub proved: bool,
    /// What is to be said beside the numbers, a sentence each.
    pub notes: &'a [String],
    /// What else the run left in the folder of the page: a file name and what it is.
    pub beside: &'a [(String, &'static str)],
}

/// The page: what came of the run, its figure, what it took of its limits.
pub(crate) fn run_page(told: &RunTold<'_>) -> String {
    let RunTold { scenario, summary, end, verdict, figure: picture, proved, notes, beside } = *told;
    let caption = markup! {
        "Errors are on logarithmic axes, where an exponential decay is a straight line."
        @if proved {
            " What is proved is proved of the law in continuous time: what holding the torque for a control period leaves, and what the simulation's own tolerance does, "
            "is not in it."
        }
    };
    let lead = markup! {
        (figure(&picture.svg(), &caption))
        @for note in notes { p.note { (note) } }
    };
    let mut sections = vec![
        Section::new("limits", "What it takes of its limits", limits(told)),
        Section::new("numbers", "All numbers", numbers(&all(summary))),
    ];
    if !beside.is_empty() {
        let links =
            markup! { ul { @for (name, what) in beside { li { a href=(name) { (name) } ": " (what) } } } };
        sections.push(Section::new("files", "Files", links));
    }
    let assumed = assumptions([scenario].into_iter());
    sections.push(Section::new("assumptions", "Assumptions", runs::assumptions(&assumed)).folded());
    let of =
        if end < scenario.duration { format!(" of {}", short(scenario.duration, 4)) } else { String::new() };
    let lines = [format!(
        "{}{of} s of the loop in {} integration steps. The same build makes the same run, bit for bit, on any number of threads.",
        short(end, 4),
        summary.steps
    )];
    Page {
        title: &format!("{}: run", scenario.name),
        verdict: Some(verdict),
        lead,
        sections,
        provenance: made(&lines),
    }
    .html()
}

/// What the run came to of each limit, and what the limits are.
fn limits(RunTold { summary, verdict, end, .. }: &RunTold<'_>) -> Markup {
    let following = &summary.following;
    let row = |used: &Used| {
        let unit = if used.unit.is_empty() { NONE } else { used.unit };
        // Of what counts from some time on nothing is known before.
        let counts = !used.measure.is_settled() || *end > following.accepted.settling;
        let or_none = |text: String| if counts { text } else { NONE.to_owned() };
        vec![
            used.measure.what().trim_end_matches(',').to_owned(),
            used.joint.clone(),
            or_none(engineering(used.value)),
            engineering(used.limit),
            unit.to_owned(),
            or_none(share(100.0 * used.value / used.limit)),
        ]
    };
    let headings = ["", "joint", "at most", "limit", "unit", "share [%]"];
    let grid = Grid { words: 2, ..Grid::new(&headings, following.used.iter().map(row).collect()) };
    markup! {
        @if verdict.good.is_none() {
            p { "As far as it went; whether it follows its reference is not known." }
        } @else if following.reasons.is_empty() {
            p { "No measure of the run exceeds its limit." }
        } @else {
            p { "It does not follow its reference:" }
            ul { @for reason in &following.reasons { li { (reason.words) } } }
        }
        @if !grid.rows.is_empty() { (numbers(&grid)) }
        ul { @for line in following.accepted.words(&summary.kinds) { li { (line) } } }
    }
}

/// A part in percent: nothing hangs on the digits of what is less than a hundredth of that.
fn share(percent: f64) -> String {
    if percent > 0.0 && percent < 0.01 { "<0.01".to_owned() } else { significant(percent, 3) }
}

/// Every figure of the run, with its unit.
fn all(summary: &Summary) -> Grid {
    let unit = |unit: Unit| of_joints(unit, "", &summary.kinds);
    let [angle, torque] = [units::ANGLE, units::TORQUE].map(unit);
    let [time, rate, percent, none] = [units::TIME.plain, units::RATE.plain, "%", NONE].map(str::to_owned);
    let settled = format!("every error below 1 {} after", of_joints(units::ANGLE, "m", &summary.kinds));
    let optional = |value: Option<f64>| value.map_or(NONE.to_owned(), engineering);
    let number = |value: f64| optional(Some(value).filter(|value| value.is_finite()));
    let part = |value: f64| number(100.0 * value);
    let rows = [
        ("largest position error of the links", number(summary.max_abs_e_l), &angle),
        ("the same, root mean square over time", number(summary.rms_e_l), &angle),
        ("position error of the links at the end", number(summary.final_abs_e_l), &angle),
        (&settled, optional(summary.settling_time), &time),
        ("largest motor torque", number(summary.max_abs_u_m), &torque),
        ("the same, root mean square over time", number(summary.rms_u_m), &torque),
        ("its change a control period, root mean square", number(summary.rms_torque_change), &torque),
        ("control periods at a torque limit", part(summary.saturated_fraction), &percent),
        (
            "control periods in which the motors gave other torques than the law's",
            part(summary.suspended_fraction),
            &percent,
        ),
        (
            "contraction rate of the law in continuous time at the states of the run",
            number(summary.rate_pointwise),
            &rate,
        ),
        ("contraction rate proved of the law in continuous time", proved_rate(summary.rate_certified), &rate),
        (
            "what the energy balance is off, as a part of what went through the robot",
            number(summary.energy_drift),
            &none,
        ),
    ]
    .map(|(what, value, unit)| vec![what.to_owned(), value, unit.clone()]);
    Grid::new(&["", "value", "unit"], rows.into())
}
