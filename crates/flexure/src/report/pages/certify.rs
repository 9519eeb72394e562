//! The page of a proof.

use std::collections::BTreeSet;

use maud::{Markup, html as markup};

use super::certificates::{self, CertificateReport};
use super::kit::{Page, Section, Verdict, figure, made};
use super::runs::symbols;
use crate::files::Problems;
use crate::files::number::{rounded_down, rounded_up, short};
use crate::prove::standing::Standing;
use crate::prove::summary::{FunnelSummary, ProofSummary, SampledTubeSummary};
use crate::report::draw::scene::Scene;
use crate::report::tables::proof::statements;
use crate::report::tables::summary::proved_rate;
use crate::sampled::not_looked_at;
use crate::scenario::Scenario;
use crate::units;

/// What a proof comes to in a sentence: good if it is about the loop in the file and its start, bad if it is wrong, if that loop is unstable, or if a `strict`
/// question gets a proof of another loop; else no verdict, as where the loop that holds its torque was not looked at.
pub fn proof_verdict(
    scenario: &Scenario,
    standing: &Standing<'_>,
    summary: &ProofSummary,
    strict: bool,
) -> Verdict {
    let proved = rates(summary);
    match standing {
        Standing::Proved if summary.start.is_some_and(|start| !start.inside) => Verdict {
            good: None,
            words: format!(
                "Proved in continuous time, but the start of this file is not known to be inside: {proved}"
            ),
        },
        Standing::Proved => match (&summary.sampled, not_looked_at(scenario)) {
            (Some(sampled), _) => Verdict {
                good: Some(true),
                words: format!(
                    "Proved in continuous time: {proved} Of the loop that holds its torque: {}.",
                    sampled.words()
                ),
            },
            (None, Some(why)) => {
                Verdict { good: None, words: format!("Proved in continuous time: {proved} {why}.") }
            }
            (None, None) => Verdict { good: Some(true), words: format!("Proved: {proved}") },
        },
        Standing::Near => {
            Verdict { good: Some(true), words: near(summary) + &format!(" Of the ideal loop: {proved}") }
        }
        Standing::Ideal(conditions) => Verdict {
            good: strict.then_some(false),
            words: format!(
                "Proved of the ideal loop only: {proved} The loop in the file has, outside of the proof: {}.",
                conditions.join(", ").replace('_', " ")
            ),
        },
        Standing::Unstable { sampled, proved } => {
            let rest = if *proved { " What is proved in continuous time is not true of it." } else { "" };
            let help = sampled.help().map_or_else(String::new, |help| format!(" What helps: {help}."));
            Verdict {
                good: Some(false),
                words: format!("Unstable as sampled: {}.{rest}{help}", sampled.words()),
            }
        }
        Standing::Refuted(problem) => Verdict { good: Some(false), words: format!("Refuted: {problem}.") },
        Standing::Undecided(problem) => Verdict { good: None, words: format!("Undecided: {problem}.") },
    }
}

/// What is proved of the loop in the file, as sampled.
fn near(summary: &ProofSummary) -> String {
    let Some(SampledTubeSummary::Proved(found)) = &summary.sampled_tube else { return String::new() };
    let (run, alike) = if found.readings.is_empty() {
        ("its run", "")
    } else {
        ("its run on exact readings", " of the same errors of readings")
    };
    format!(
        "Proved of the loop in the file, as sampled: motions that start in a tube around {run} stay in it at every control instant, links at most {} {} from that run, \
         and two of them{alike} come closer at {} 1/s or faster.",
        largest(&found.error[..found.tracking.len()]),
        summary.unit(units::ANGLE),
        proved_rate(Some(found.rate))
    )
}

/// The largest of them, from above.
fn largest(all: &[f64]) -> String {
    short(rounded_up(all.iter().copied().fold(0.0, f64::max), 3), 3)
}

/// The rates that are proved, and where.
fn rates(summary: &ProofSummary) -> String {
    let region = summary.region.as_ref();
    let errors = region.and_then(|region| region.level).map_or_else(
        || "errors of any size".to_owned(),
        |level| format!("errors that start with W ≤ {} J", short(rounded_down(level, 3), 3)),
    );
    let place = region.and_then(|region| region.error.as_ref()).map_or_else(String::new, |errors| {
        format!(" where position errors are up to {} {}", largest(errors), summary.unit(units::ANGLE))
    });
    let contraction = summary.contraction_rate.map_or_else(String::new, |rate| {
        let rate = proved_rate(Some(rate));
        format!(", and any two solutions of the virtual system come together at {rate} 1/s or faster")
    });
    let stretched = summary.stretched.as_ref().map_or_else(String::new, |stretched| {
        format!(
            ". While velocity errors of both are up to {} {} as well, two solutions come together at {} 1/s or faster in a metric that \
             grows with the error",
            largest(&stretched.velocity_error),
            summary.unit(units::SPEED),
            proved_rate(Some(stretched.rate))
        )
    });
    format!(
        "{errors} shrink at {} 1/s or faster{contraction}{place}{stretched}.",
        proved_rate(summary.convergence_rate)
    )
}

/// The page: what is proved, with the run in it, or why there is no such picture. The certificate, called so, is linked if it lies `beside` the page.
pub(crate) fn certify_page(
    scenario: &Scenario,
    summary: &ProofSummary,
    verdict: &Verdict,
    picture: &Result<Scene, Problems>,
    certificate: Option<&str>,
    beside: bool,
) -> String {
    let caption = markup! {
        "Above: the storage W of the errors along the run. "
        @if matches!(summary.funnel, Some(FunnelSummary::Proved(_))) {
            "In the middle: the link error of each joint over time, and the funnel that no run of the ideal loop leaves. "
        }
        @if matches!(summary.sampled_tube, Some(SampledTubeSummary::Proved(_))) {
            "In the middle" @if matches!(summary.funnel, Some(FunnelSummary::Proved(_))) { ", too" } ": the link error of each joint over time in the tube, where links are at control instants of all motions that start in it, of the loop in the \
             file, as sampled. "
        }
        "Below: the position errors of each joint, from the ring on"
        @if summary.region.as_ref().is_some_and(|region| region.level.is_some()) {
            "; a level of W is an ellipse there, and what is outside of the ellipse is outside of the level, while a point inside of it may have momenta that are \
             not"
        }
        ". "
        @if summary.convergence_rate.is_some() {
            "The decay of W is proved of the law in continuous time; a loop that holds its torque for a control period, or has imperfections, is left with an \
             error of its own."
        }
    };
    let lead = match picture {
        Ok(scene) => figure(&scene.svg(), &caption),
        Err(problems) => markup! { p { "There is no picture of this loop: " (problems) "." } },
    };
    let mut sections = Vec::new();
    if summary.convergence_rate.is_some() {
        let report = CertificateReport {
            summary: summary.clone(),
            phi: scenario.controller.phi().unwrap_or_default().to_owned(),
            file: certificate.filter(|_| beside).map(str::to_owned),
        };
        sections.push(Section::new("rates", "Proved rates", certificates::section(&[report])));
    }
    sections.push(Section::new("statements", "All that is said", said(summary)));
    // Each sensor of a side says it.
    let once: BTreeSet<&String> = summary.assumptions.iter().collect();
    let assumed = markup! { ul { @for assumed in once { li { (assumed) } } } };
    sections.push(Section::new("assumptions", "Assumptions", assumed).folded());
    let mut lines = vec![
        "Rounded outwards, from the decimals of the robot and scenario files. The same build writes the same page, byte for byte, on any number of \
         threads."
            .to_owned(),
    ];
    lines.extend(certificate.map(|name| format!("The certificate is {name}.")));
    Page {
        title: &format!("{}: proof", scenario.name),
        verdict: Some(verdict),
        lead,
        sections,
        provenance: made(&lines),
    }
    .html()
}

fn said(summary: &ProofSummary) -> Markup {
    markup! {
        @if let Some(sampled) = &summary.sampled { p.note { (sampled.line()) } }
        div.scroll { table { tbody {
            @for [label, words] in statements(summary).iter().filter(|[label, _]| label != "assumed") {
                tr {
                    th scope="row" { (label) }
                    // Keys of files have no subscripts.
                    td { @if ["limit", "witness"].contains(&&**label) { (words) } @else { (symbols(words)) } }
                }
            }
        } } }
    }
}
