//! The page of what logs tell of a robot's joints.

use std::path::Path;

use maud::{Markup, html as markup};

use super::kit::{Page, Section, Verdict, figure, made, numbers};
use crate::files::Problem;
use crate::files::number::{NONE, significant};
use crate::identify::{Estimate, Identified, Parameter};
use crate::report::draw::scene::Scene;
use crate::report::tables::grid::Grid;
use crate::units::raised;

/// The page: whether the logs know the numbers that a law needs, each with its error bar, and how well the model explains the logs.
pub(crate) fn identify_page(
    found: &Identified,
    objection: Option<&Problem>,
    picture: &Scene,
    file: Option<&Path>,
) -> String {
    let caption = markup! {
        "Each row on an axis of its own, zero at the number that was found. Error bars are those of a model that has all that the robot has: where prediction \
         errors are larger than the noise of the encoders it has not, and numbers may be farther off than their bars."
    };
    let sections = vec![
        Section::new("numbers", "In numbers", estimates(found)),
        Section::new("fit", "How well the model explains the logs", fit(found)),
    ];
    let mut lines = vec![
        format!("{} samples were fitted, {} kept from the fit.", found.samples, found.held_out),
        "Errors are three standard deviations.".to_owned(),
    ];
    lines.extend(
        file.and_then(Path::file_name)
            .map(|name| format!("The robot file with these numbers is {}.", name.display())),
    );
    Page {
        title: &format!("{}: identified joints", found.robot),
        verdict: Some(&verdict(found, objection)),
        lead: figure(&picture.svg(), &caption),
        sections,
        provenance: made(&lines),
    }
    .html()
}

/// Prediction errors over the noise of the encoders up to which the model is taken to explain the logs.
const MISFIT: f64 = 1.4;

fn verdict(found: &Identified, objection: Option<&Problem>) -> Verdict {
    if let Some(problem) = objection {
        return Verdict { good: Some(false), words: format!("{problem}.") };
    }
    let worst = (0..found.joints.len())
        .flat_map(|joint| {
            Parameter::ALL
                .into_iter()
                .filter(|parameter| parameter.is_needed())
                .map(move |parameter| (joint, parameter))
        })
        .map(|(joint, parameter)| (&found.joints[joint].name, found.estimate(joint, parameter)))
        .max_by(|(_, a), (_, b)| (a.error / a.value.abs()).total_cmp(&(b.error / b.value.abs())));
    let worst = worst.map_or_else(String::new, |(joint, Estimate { key, value, error, unit, .. })| {
        format!(
            " Least well known: {} of {joint}, {} ± {} {}.",
            key.replace('_', " "),
            significant(*value, 4),
            significant(*error, 2),
            raised(unit)
        )
    });
    let ratios = found
        .joints
        .iter()
        .flat_map(|joint| joint.noise_ratio.link.into_iter().chain([joint.noise_ratio.motor]));
    let misfit = ratios.fold(0.0, f64::max);
    let (good, fit) = if misfit <= MISFIT {
        (Some(true), "")
    } else {
        (
            None,
            ": the model lacks something that is in the logs, and numbers may be farther off than their errors say",
        )
    };
    let words = format!(
        "The logs know the stiffness and the motor inertia of every joint.{worst} Prediction errors are up to {} times the noise of the encoders{fit}.",
        significant(misfit, 3)
    );
    Verdict { good, words }
}

fn estimates(found: &Identified) -> Markup {
    let rows = found.joints.iter().flat_map(|joint| {
        joint.parameters.iter().map(|Estimate { key, unit, value, error, before, known }| {
            let number = |x: f64| significant(x, 5);
            let values = if *known {
                [number(*value), significant(*error, 2)]
            } else {
                [NONE, NONE].map(str::to_owned)
            };
            let [value, error] = values;
            let name = format!("{}, {}", joint.name, key.replace('_', " "));
            vec![name, value, error, before.map_or(NONE.to_owned(), number), raised(unit)]
        })
    });
    markup! {
        (numbers(&Grid::new(&["number", "found", "±", "in the robot file", "unit"], rows.collect())))
        p.note { "— where the logs do not know the number: it stays as it was." }
    }
}

fn fit(found: &Identified) -> Markup {
    let number = |x: f64| significant(x, 3);
    let rows = found.joints.iter().map(|joint| {
        let optional = |x: Option<f64>| x.map_or(NONE.to_owned(), number);
        let [link, motor] = [optional(joint.noise_ratio.link), number(joint.noise_ratio.motor)];
        vec![joint.name.clone(), link, motor, optional(joint.held_out)]
    });
    markup! {
        (numbers(&Grid::new(
            &["joint", "link: prediction errors over the encoder's noise", "motor", "squares in the held-out part over those in the fitted"],
            rows.collect()
        )))
        ul {
            @for offset in &found.offsets {
                li { (offset.log) ": torques act " (format!("{:.4}", 1e3 * offset.value)) " ± " (significant(1e3 * offset.error, 2)) " ms after they are logged." }
            }
            @for joint in &found.joints {
                @if let Some(doubt) = &joint.doubt { li { (joint.name) ": nothing of it counts as known: " (doubt) } }
            }
            li { "Known least: " (found.weakest) "; condition " (number(found.condition)) " (1: nothing hides behind anything else)." }
        }
    }
}
