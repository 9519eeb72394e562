//! The page of tuned gains.

use std::path::Path;

use maud::{Markup, html as markup};

use super::kit::{Page, Section, Verdict, figure, made, numbers};
use super::runs;
use crate::design::{Constraint, Design};
use crate::files::Problem;
use crate::files::number::{short, significant};
use crate::report::assumptions;
use crate::report::draw::scene::Scene;
use crate::report::figures::margins::margins_figure;
use crate::report::tables::design;
use crate::sampled::Sampled;
use crate::scenario::Scenario;
use crate::units::{self, of_joints};

/// The page: whether gains were found that keep every constraint, what they leave of each, and what speaks for them.
pub(crate) fn tune_page(
    scenario: &Scenario,
    found: &Design,
    objection: Option<&Problem>,
    picture: &Scene,
    file: Option<&Path>,
) -> String {
    let caption = markup! {
        "A bar is the share of its limit that the loop takes, with the best gains that were found: the nearer to the line, the less is left. Of a rate, which \
         shall be large, what is left is what it has more."
    };
    let joints: Vec<String> = scenario.robot.joints.iter().map(|joint| joint.name.clone()).collect();
    let mut sections = vec![
        Section::new("constraints", "Constraints in numbers", constraints(&found.constraints)),
        Section::new("gains", "Gains", numbers(&design::gains(&joints, found))),
        Section::new("trades", "What each gain trades", numbers(&design::trades(&found.gains))),
        Section::new("evidence", "What the loop does with them", evidence(scenario, found)),
    ];
    if let Some(margins) = &found.evidence.margins {
        let caption = markup! {
            "Each change is made alone, from the scenario as it is. Holding is seen in runs: errors that grow so slowly that a run is too short for them do not \
             show, and constraints on the sampled loop may say no sooner."
        };
        let body = figure(&margins_figure(margins).svg(), &caption);
        sections.push(Section::new("margins", "What it bears", body));
    }
    let assumed = assumptions([scenario].into_iter());
    sections.push(Section::new("assumptions", "Assumptions", runs::assumptions(&assumed)).folded());
    let mut lines = vec![format!(
        "{} loops were run in the search. The same build writes the same page, byte for byte, on any number of threads.",
        found.runs
    )];
    lines.extend(
        file.and_then(Path::file_name)
            .map(|name| format!("The scenario with these gains is {}.", name.display())),
    );
    Page {
        title: &format!("{}: tuned gains", found.name),
        verdict: Some(&verdict(scenario, found, objection)),
        lead: figure(&picture.svg(), &caption),
        sections,
        provenance: made(&lines),
    }
    .html()
}

fn verdict(scenario: &Scenario, design: &Design, objection: Option<&Problem>) -> Verdict {
    if let Some(problem) = objection {
        return Verdict { good: Some(false), words: format!("{problem}.") };
    }
    let asked = design.constraints.iter().filter(|constraint| constraint.asked && constraint.limit != 0.0);
    let closest = asked.min_by(|a, b| a.slack.total_cmp(&b.slack)).map(
        |Constraint { what, joint, value, limit, unit, .. }| {
            let of = joint.as_ref().map_or_else(String::new, |joint| format!(" of {joint}"));
            let amount = |x: f64| format!("{} {unit}", short(x, 3)).trim_end().to_owned();
            format!(
                " Least is left of “{what}”{of}: {}, where {} is the limit.",
                amount(*value),
                amount(*limit)
            )
        },
    );
    let frail = design.frail().map(|frail| {
        format!(" The loop is frail: with {frail} it does not hold, which is wished for and was not asked.")
    });
    let rms = design.evidence.runs.iter().map(|run| run.rms_e_l).fold(0.0, f64::max);
    let words = format!(
        "Gains that keep every constraint that is asked; the rms error is {} {}.{}{}",
        significant(1e3 * rms, 3),
        of_joints(units::ANGLE, "m", &scenario.robot.kinds()),
        closest.unwrap_or_default(),
        frail.unwrap_or_default()
    );
    Verdict { good: Some(true), words }
}

fn constraints(list: &[Constraint]) -> Markup {
    markup! {
        (numbers(&design::constraints(list)))
        @for constraint in list {
            @if let Some(note) = &constraint.note { p.note { (constraint.what) ": " (note) } }
        }
    }
}

fn evidence(scenario: &Scenario, design: &Design) -> Markup {
    let evidence = &design.evidence;
    let sampled = evidence.sampled.as_ref().map(Sampled::line).or(crate::sampled::not_looked_at(scenario));
    let proved = evidence.verdict.zip(evidence.rate_certified);
    let outside = crate::prove::standing::outside_of_proofs(&scenario.beyond_ideal());
    markup! {
        ul {
            @for run in &evidence.runs { li { (run.name) ": " (run.in_words()) } }
            @if let Some(line) = sampled { li { (line) } }
            @if let Some((verdict, rate)) = proved {
                li { "Contraction rate: " (short(rate, 4)) " 1/s, " (verdict) @if let Some(outside) = outside { ": " (outside) } "." }
            }
            @if let Some(tube) = evidence.tube { li { "Of the sampled loop " (tube.words()) " is proved." } }
        }
    }
}
