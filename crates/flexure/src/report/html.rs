//! One self-contained HTML page about several runs.

use maud::{DOCTYPE, Markup, PreEscaped, html as markup};

use super::certificates::{self, CertificateReport};
use super::markdown::{ERRATA, subscripts};
use super::table::proved_rate;
use crate::files::number::{NONE, engineering};
use crate::simulate::Summary;
use crate::units;

/// Everything a report says. The same report gives the same page, byte for byte: no clock is read.
#[derive(Clone, Debug, Default)]
pub struct RunsReport {
    /// Heading of the page.
    pub title: String,
    /// What was run and why: paragraphs, separated by empty lines.
    pub introduction: String,
    /// The runs, in the order of the page.
    pub runs: Vec<RunReport>,
    /// Figure with all runs in one axis as SVG, from [`comparison`](super::comparison()).
    pub comparison_svg: Option<String>,
    /// Summaries of the proofs, a table each.
    pub certificates: Vec<CertificateReport>,
    /// Numbers that no source gives.
    pub assumptions: Vec<AssumedNumber>,
    /// How the numbers came about: version, seeds, what makes them reproducible.
    pub provenance: Vec<String>,
}

/// One run of a [`RunsReport`].
#[derive(Clone, Debug)]
pub struct RunReport {
    /// Errors, torques and rates of the run.
    pub summary: Summary,
    /// Its figure as SVG, from [`four_panel`](super::four_panel()).
    pub figure_svg: String,
    /// What the figure shows, in a sentence or two.
    pub description: String,
}

/// A number that was assumed, and why.
#[derive(Clone, Debug)]
pub struct AssumedNumber {
    /// File in which it stands.
    pub file: String,
    /// Key in the file.
    pub key: String,
    /// The number, with its unit.
    pub value: String,
    /// Reason after `assumed:` in the file.
    pub note: String,
}

/// The page.
///
/// Every text is escaped. Figures are inserted as they are: they come from this crate.
pub fn html(report: &RunsReport) -> String {
    markup! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (report.title) }
                style { (PreEscaped(include_str!("report.css"))) }
            }
            body { main {
                header {
                    h1 { (report.title) }
                    (paragraphs(&report.introduction))
                }
                (contents(report))
                section id="summary" { h2 { "Summary" } (summary_table(&report.runs)) }
                section id="runs" { h2 { "Runs" }
                    @for (index, run) in report.runs.iter().enumerate() { (figure(index + 1, run)) }
                }
                @if let Some(svg) = &report.comparison_svg {
                    section id="comparison" { h2 { "Comparison" }
                        figure {
                            div.card { (PreEscaped(svg)) }
                            figcaption {
                                "Largest link position error over the joints, for every run. On the logarithmic axis a straight "
                                "line is an exponential decay, and its slope is the rate."
                            }
                        }
                    }
                }
                @if !report.certificates.is_empty() {
                    section id="certificates" { h2 { "Certificates" } (certificates::section(&report.certificates)) }
                }
                section id="assumptions" { h2 { "Assumptions" } (assumptions(&report.assumptions)) }
                section id="errata" { h2 { "Slips of the paper" } div.scroll.prose { (PreEscaped(ERRATA)) } }
                footer { h2 { "How this page was made" }
                    ul { @for line in &report.provenance { li { (line) } } }
                }
            } }
        }
    }
    .into_string()
}

fn paragraphs(text: &str) -> Markup {
    markup! { @for paragraph in text.split("\n\n").filter(|paragraph| !paragraph.trim().is_empty()) { p { (paragraph.trim()) } } }
}

fn contents(report: &RunsReport) -> Markup {
    markup! {
        nav aria-label="Contents" {
            a href="#summary" { "Summary" }
            @for (index, run) in report.runs.iter().enumerate() { a href={ "#run-" (index + 1) } { (run.summary.name) } }
            @if report.comparison_svg.is_some() { a href="#comparison" { "Comparison" } }
            @if !report.certificates.is_empty() { a href="#certificates" { "Certificates" } }
            a href="#assumptions" { "Assumptions" }
            a href="#errata" { "Slips of the paper" }
        }
    }
}

/// Heading and unit of each number in the summary table.
const COLUMNS: [(&str, &str); 11] = [
    ("max |e_l|", units::ANGLE.raised),
    ("rms e_l", units::ANGLE.raised),
    ("final |e_l|", units::ANGLE.raised),
    ("settling time", units::TIME.raised),
    ("max |u_m|", units::TORQUE.raised),
    ("rms u_m", units::TORQUE.raised),
    ("saturated", "%"),
    ("rate at states", units::RATE.raised),
    ("rate certified", units::RATE.raised),
    ("energy drift", "–"),
    ("steps", "–"),
];

fn numbers(summary: &Summary) -> [String; COLUMNS.len()] {
    let optional = |value: Option<f64>| value.map_or(NONE.to_owned(), engineering);
    [
        engineering(summary.max_abs_e_l),
        engineering(summary.rms_e_l),
        engineering(summary.final_abs_e_l),
        optional(summary.settling_time),
        engineering(summary.max_abs_u_m),
        engineering(summary.rms_u_m),
        engineering(100.0 * summary.saturated_fraction),
        engineering(summary.rate_pointwise),
        proved_rate(summary.rate_certified),
        engineering(summary.energy_drift),
        summary.steps.to_string(),
    ]
}

fn summary_table(runs: &[RunReport]) -> Markup {
    markup! {
        div.scroll {
            table.numbers {
                thead { tr {
                    th { "run" br; span.unit { "controller, φ" } }
                    @for (title, unit) in COLUMNS {
                        th { (symbols(title)) br; span.unit { "[" (unit) "]" } }
                    }
                } }
                tbody {
                    @for (index, RunReport { summary, .. }) in runs.iter().enumerate() {
                        tr {
                            th scope="row" {
                                a href={ "#run-" (index + 1) } { (summary.name) } br;
                                span.unit { (summary.controller)
                                    @if let Some(phi) = &summary.phi { ", " (phi) }
                                }
                            }
                            @for number in numbers(summary) { td { (number) } }
                        }
                    }
                }
            }
        }
        p.note {
            "Settling time: after it every " (symbols("|e_l|")) " stays below 1 mrad; — if that never happens. "
            "Rate at states: the smallest contraction rate of the law in continuous time at the states of the run, evaluated and not proved. "
            "Rate certified: proved, on the region that " code { "flexure certify" } " takes by itself; — where nothing was proved of this loop. "
            "Energy drift: the energy balance's residual, relative to the energy that went through the robot."
        }
    }
}

/// `u_m` with its subscript lowered.
pub(super) fn symbols(text: &str) -> Markup {
    markup! { (PreEscaped(subscripts(text))) }
}

fn figure(number: usize, run: &RunReport) -> Markup {
    markup! {
        article id={ "run-" (number) } {
            h3 { (number) ". " (run.summary.name) }
            figure {
                div.card { (PreEscaped(&run.figure_svg)) }
                figcaption { (run.description) }
            }
        }
    }
}

pub(super) fn assumptions(assumptions: &[AssumedNumber]) -> Markup {
    let mut rows: Vec<(&AssumedNumber, Vec<&str>)> = Vec::new();
    for assumption in assumptions {
        let same = |other: &AssumedNumber| {
            (&other.key, &other.value, &other.note) == (&assumption.key, &assumption.value, &assumption.note)
        };
        match rows.iter_mut().find(|(first, _)| same(first)) {
            Some((_, files)) => files.push(&assumption.file),
            None => rows.push((assumption, vec![&assumption.file])),
        }
    }
    markup! {
        @if assumptions.is_empty() {
            p { "None: every number has a source." }
        } @else {
            p { "Numbers that the sources do not give. Change them in the files named here." }
            div.scroll { table {
                thead { tr { th { "key" } th { "value" } th { "why" } th { "files" } } }
                tbody {
                    @for (assumption, files) in &rows {
                        tr {
                            td { code { (assumption.key) } } td { (assumption.value) } td { (assumption.note) }
                            td.files { @for file in files { code { (file) } " " } }
                        }
                    }
                }
            } }
        }
    }
}
