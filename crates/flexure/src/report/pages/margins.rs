//! The page of what loops bear.

use maud::{Markup, html as markup};

use super::kit::{self, Page, Section, Verdict, figure, made};
use super::runs::{AssumedNumber, assumptions};
use crate::files::Problem;
use crate::files::number::{NONE, short, significant};
use crate::margins::{Edge, Margins};
use crate::report::draw::scene::Scene;
use crate::report::tables::grid::Grid;
use crate::scenario::Scenario;
use crate::units;

/// The page, with a figure for each loop: for each what it bears, as a picture, then all numbers. The same margins give the same page, byte for byte.
pub(crate) fn margins_page(
    loops: &[Margins],
    figures: &[Scene],
    scenario: &Scenario,
    assumed: &[AssumedNumber],
) -> String {
    let title =
        loops.first().map_or_else(|| "Margins".to_owned(), |first| format!("{}: margins", first.name));
    let verdict = verdict(loops, scenario);
    let caption = markup! {
        "Bars end where the loop was seen to hold last, red begins where it did not. Each change is made alone, from the scenario as it is, by \
         steps and bisection to 1 %: where a loop holds again farther out was not looked for. Holding is seen in runs: errors that grow so slowly \
         that a run is too short for them do not show."
    };
    let lead = markup! { @for scene in figures { (figure(&scene.svg(), &caption)) } };
    let sections = vec![
        Section::new("numbers", "In numbers", numbers(loops)),
        Section::new("holds", "What holding means", criteria(loops)).folded(),
        Section::new("assumptions", "Assumptions", assumptions(assumed)).folded(),
    ];
    let runs: usize = loops.iter().map(|margins| margins.runs).sum();
    let provenance = made(&[format!(
        "{runs} runs were simulated. The same build writes the same page, byte for byte, on any number of threads."
    )]);
    Page { title: &title, verdict: Some(&verdict), lead, sections, provenance }.html()
}

/// What the loops bear, a sentence each; it is good if nothing is to be said against any of them.
fn verdict(loops: &[Margins], scenario: &Scenario) -> Verdict {
    let objections: Vec<Option<Problem>> = loops.iter().map(|margins| margins.objection(scenario)).collect();
    let words = loops.iter().zip(&objections).map(|(margins, objection)| match objection {
        Some(problem) => format!("{problem}."),
        None => borne(margins),
    });
    let words = words.collect::<Vec<_>>().join(" ");
    Verdict { good: Some(objections.iter().all(Option::is_none)), words }
}

/// What a loop bears.
fn borne(margins: &Margins) -> String {
    let number = |edge: &Edge, scale: f64| match edge {
        Edge::Between { holds, .. } => significant(scale * holds, 3),
        Edge::Beyond { holds } | Edge::Open { holds } => {
            format!("{} and more", significant(scale * holds, 3))
        }
        Edge::Nowhere => NONE.to_owned(),
    };
    let least = |edge: &Edge| match edge {
        Edge::Beyond { holds } | Edge::Open { holds } => format!("{} and less", significant(*holds, 3)),
        edge => number(edge, 1.0),
    };
    format!(
        "{} holds, in runs of {} s, with {} ms of delay more, {} to {} times its torque, {} to {} times its stiffness, and {} {} of noise more.",
        margins.law(),
        short(margins.duration, 4),
        number(&margins.delay, 1e3),
        least(&margins.gain_low),
        number(&margins.gain_high, 1.0),
        least(&margins.stiffness_low),
        number(&margins.stiffness_high, 1.0),
        number(&margins.noise, 1e3),
        margins.unit(units::ANGLE, "m")
    )
}

fn numbers(loops: &[Margins]) -> Markup {
    markup! {
        @for margins in loops {
            h3 { (margins.law()) }
            (kit::numbers(&changes(margins)))
            @if let (Some(error), Some(torque)) = (margins.noise_to_error, margins.noise_to_torque) {
                p.note {
                    "At a tenth of that noise: " "link errors are " (significant(error, 3)) " times the noise, and torques step by "
                    (significant(1e-3 * torque, 3)) " " (margins.unit(units::TORQUE, "")) " for each " (margins.unit(units::ANGLE, "m")) " (root mean squares)."
                }
            }
            @if let Some(sampled) = &margins.sampled { p.note { (sampled.line()) } }
        }
    }
}

fn changes(margins: &Margins) -> Grid {
    let both = |edge: &Edge, scale: f64| match edge {
        Edge::Between { holds, fails } => [holds, fails].map(|x| significant(scale * x, 3)),
        Edge::Beyond { holds } | Edge::Open { holds } => [significant(scale * holds, 3), NONE.to_owned()],
        Edge::Nowhere => [NONE.to_owned(), NONE.to_owned()],
    };
    let noise = format!(
        "white noise added to all positions, standard deviation [{}]",
        margins.unit(units::ANGLE, "m")
    );
    let rows = [
        ("delay from command to torque added [ms]", &margins.delay, 1e3),
        ("torque too small by the factor", &margins.gain_low, 1.0),
        ("torque too large by the factor", &margins.gain_high, 1.0),
        ("springs softer than the law believes by the factor", &margins.stiffness_low, 1.0),
        ("springs stiffer than the law believes by the factor", &margins.stiffness_high, 1.0),
        (&noise, &margins.noise, 1e3),
    ];
    let rows =
        rows.map(|(name, edge, scale)| std::iter::once(name.to_owned()).chain(both(edge, scale)).collect());
    Grid::new(
        &["change", if margins.is_unstable() { "follows" } else { "holds" }, "does not hold"],
        rows.into(),
    )
}

fn criteria(loops: &[Margins]) -> Markup {
    markup! {
        ul { @for margins in loops {
            li {
                (margins.law()) ": it follows its reference by the verdict on runs, with an rms error of at most "
                (significant(1e3 * margins.allowed_rms_e_l, 3)) " " (margins.unit(units::ANGLE, "m")) ", torques of at most " (significant(margins.allowed_max_u_m, 3))
                " " (margins.unit(units::TORQUE, "")) ", and steps of the torque of at most " (significant(margins.allowed_rms_torque_change, 3)) " "
                (margins.unit(units::TORQUE, "")) " (rms) a control period."
            }
        } }
    }
}
