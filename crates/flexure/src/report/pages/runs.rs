//! One self-contained HTML page about several runs.

use maud::{Markup, PreEscaped, html as markup};

use super::certificates::{self, CertificateReport};
use super::kit::{Page, Section, Verdict, figure};
use super::markdown::{ERRATA, subscripts};
use super::practical;
use crate::files::number::{NONE, engineering};
use crate::report::tables::summary::proved_rate;
use crate::report::ultimate::Practical;
use crate::simulate::Summary;
use crate::units;

/// Everything a report says. The same report gives the same page, byte for byte: no clock is read.
#[derive(Clone, Debug, Default)]
pub struct RunsReport {
    /// Heading of the page.
    pub title: String,
    /// What came of the runs in a sentence; none if nothing is to be said of all of them.
    pub verdict: Option<Verdict>,
    /// What was run and why: paragraphs, separated by empty lines.
    pub introduction: String,
    /// The runs, in the order of the page.
    pub runs: Vec<RunReport>,
    /// The figure that shows what came of them, as SVG, from [`comparison`](crate::report::comparison()).
    pub comparison_svg: Option<String>,
    /// Runs in motion, a page of its own, from [`view`](crate::report::view()).
    pub motion: Option<String>,
    /// Summaries of the proofs, a table each.
    pub certificates: Vec<CertificateReport>,
    /// How far runs with imperfections converge, a table of all.
    pub practical: Vec<Practical>,
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
    /// Its figure as SVG, from [`run_figure`](crate::report::run_figure()).
    pub figure_svg: String,
    /// What the figure shows, in a sentence or two.
    pub description: String,
    /// What is to be minded of it; such runs come last.
    pub warning: Option<String>,
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
    let RunsReport { title, verdict, introduction, runs, comparison_svg, motion, .. } = report;
    let (minded, good): (Vec<_>, Vec<_>) =
        runs.iter().enumerate().partition(|(_, run)| run.warning.is_some());
    let mut sections = Vec::new();
    if let Some(page) = motion {
        sections.push(Section::new("motion", "In motion", moving(page)));
    }
    if !report.certificates.is_empty() {
        sections.push(Section::new(
            "certificates",
            "Proved rates",
            certificates::section(&report.certificates),
        ));
    }
    if !report.practical.is_empty() {
        sections.push(Section::new(
            "practical",
            "Practical convergence",
            practical::section(&report.practical),
        ));
    }
    sections.push(Section::new("summary", "All runs in numbers", summary_table(runs)));
    if !minded.is_empty() {
        sections.push(Section::new(
            "warnings",
            "Runs with a warning",
            markup! {
                @for (index, run) in minded { (run_figure(index + 1, run)) }
            },
        ));
    }
    if !good.is_empty() {
        let figures = markup! { @for (index, run) in good { (run_figure(index + 1, run)) } };
        sections.push(Section::new("runs", "Each run", figures).folded());
    }
    sections.push(Section::new("assumptions", "Assumptions", assumptions(&report.assumptions)).folded());
    let errata = markup! { div.scroll.prose { (PreEscaped(ERRATA)) } };
    sections.push(Section::new("errata", "Slips of the paper", errata).folded());
    let caption = markup! {
        "Largest link position error over the joints, of the runs that join their reference smoothly. On the logarithmic axis a straight line is an exponential decay, and its slope \
         is the rate."
    };
    let lead = markup! {
        @if let Some(svg) = comparison_svg { (figure(svg, &caption)) }
        (paragraphs(introduction))
    };
    let provenance = markup! { ul { @for line in &report.provenance { li { (line) } } } };
    Page { title, verdict: verdict.as_ref(), lead, sections, provenance }.html()
}

fn paragraphs(text: &str) -> Markup {
    markup! { @for paragraph in text.split("\n\n").filter(|paragraph| !paragraph.trim().is_empty()) { p { (paragraph.trim()) } } }
}

/// A page within the page: what it does stays in there.
fn moving(page: &str) -> Markup {
    markup! {
        iframe.motion title="The robot in motion" sandbox="allow-scripts" loading="lazy" srcdoc=(page) {}
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
        drift(summary.energy_drift),
        summary.steps.to_string(),
    ]
}

/// An energy drift: what is below this is rounding, whose digits say nothing.
fn drift(value: f64) -> String {
    if value < 1e-12 { "< 10⁻¹²".to_owned() } else { engineering(value) }
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
            "Rate certified: proved on the region that " code { "flexure certify" } " takes by itself, smaller or larger than the errors of up to 3 rad of the rates above; — where nothing was proved of this loop. "
            "Energy drift: the energy balance's residual, relative to the energy that went through the robot."
        }
    }
}

/// `u_m` with its subscript lowered.
pub(crate) fn symbols(text: &str) -> Markup {
    markup! { (PreEscaped(subscripts(text))) }
}

fn run_figure(number: usize, run: &RunReport) -> Markup {
    markup! {
        article id={ "run-" (number) } {
            h3 { (number) ". " (run.summary.name) }
            @if let Some(warning) = &run.warning { p.warning { strong { "Warning" } ": " (warning) } }
            (figure(&run.figure_svg, &markup! { (run.description) }))
        }
    }
}

pub(crate) fn assumptions(assumptions: &[AssumedNumber]) -> Markup {
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
