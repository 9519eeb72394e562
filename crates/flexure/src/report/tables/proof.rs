//! A proof as text for the terminal.

use std::fmt::Write;

use super::columns::laid_out;
use super::summary::{headed, right};
use crate::files::number::{NONE, engineering, rounded_down, rounded_up, short, significant};
use crate::prove::along::{Along, Limit};
use crate::prove::engine::certificate::{LoopSide, Norm, StructureName};
use crate::prove::engine::verdict::Verdict;
use crate::prove::standing::outside_of_proofs;
use crate::prove::summary::{
    BlockSummary, FunnelSummary, ProofSummary, SampledTubeSummary, WithinSummary, WitnessSummary,
};
use crate::report::tables::funnel::funnel_lines;
use crate::report::tables::tube::tube_lines;
use crate::robot::JointKind;
use crate::units::{self, Unit};

/// What was proved, refuted or left undecided; the table in so many columns.
pub fn proof_table(summary: &ProofSummary, width: usize) -> String {
    let mut text = format!("{}: {}\n", summary.name, summary.verdict);
    if let Some(step) = summary.step {
        let more = if summary.may_be_higher { "; --strongest looks for the sampled one" } else { "" };
        // Writing to a text cannot fail.
        let _ = writeln!(text, "highest step proved: {}{more}", step.words());
    }
    if let Some(outside) = outside_of_proofs(&summary.left_out) {
        let but = match &summary.sampled_tube {
            Some(SampledTubeSummary::Proved(_)) => {
                "; the sampled tube, below, is of the loop in the file, with all of them"
            }
            _ => "",
        };
        let _ = writeln!(text, "{outside}{but}");
    }
    if let Some(sampled) = &summary.sampled {
        let _ = writeln!(text, "{}", sampled.line());
    }
    if let (Some(contraction), Some(convergence)) = (summary.blocks, summary.convergence_blocks) {
        text += &rates(summary, contraction, convergence, width);
    }
    for line in lines(summary) {
        let _ = write!(text, "\n{line}");
    }
    text
}

/// What was proved of several scenarios, a row each, in so many columns.
pub fn certificate_table(summaries: &[ProofSummary], width: usize) -> String {
    let titles = [
        "proved",
        "errors\nup to\n[rad]",
        "con-\ntraction\n[1/s]",
        "conver-\ngence\n[1/s]",
        "paper's\nformula\n[1/s]",
        "σ_l\n\n[1/s]",
        "σ_m\n\n[1/s]",
        "full\ninequality\n[1/s]",
    ];
    let mut table = headed(titles.into_iter());
    let rate = |rate: Option<f64>| right(rate.map_or(NONE.to_owned(), |rate| significant(rate, 6)));
    for summary in summaries {
        let region = summary.region.as_ref().and_then(|region| region.error.as_ref());
        table.add_row(vec![
            comfy_table::Cell::new(&summary.name),
            right(region.map_or("any".to_owned(), |errors| list(errors))),
            rate(summary.contraction_rate),
            rate(summary.convergence_rate),
            right(short(summary.paper_rate, 4)),
            rate(summary.blocks.map(|blocks| blocks.sigma_l)),
            rate(summary.blocks.map(|blocks| blocks.sigma_m)),
            rate(summary.direct.as_ref().and_then(|direct| direct.rate)),
        ]);
    }
    laid_out(&table, 1, width)
}

fn rates(
    summary: &ProofSummary,
    contraction: BlockSummary,
    convergence: BlockSummary,
    width: usize,
) -> String {
    let mut table = headed(["block", "contraction\n[1/s]", "convergence\n[1/s]"].into_iter());
    let number = |x: Option<f64>| right(x.map_or(NONE.to_owned(), |x| significant(x, 6)));
    let mut row = |name: &str, contraction, convergence| {
        table.add_row(vec![comfy_table::Cell::new(name), number(contraction), number(convergence)]);
    };
    row("φ_l  link positions", Some(contraction.phi_l), Some(convergence.phi_l));
    row("φ_m  motor positions", Some(contraction.phi_m), Some(convergence.phi_m));
    row("σ_l  link momenta", Some(contraction.sigma_l), Some(convergence.sigma_l));
    row("σ_m  motor momenta", Some(contraction.sigma_m), Some(convergence.sigma_m));
    row("closed loop", summary.contraction_rate, summary.convergence_rate);
    row("the paper's formula", Some(summary.paper_rate), None);
    laid_out(&table, 1, width)
}

/// Columns of a line that its label takes.
const LABEL: usize = 13;

/// What the table does not say, in sentences with labels.
pub(crate) fn statements(summary: &ProofSummary) -> Vec<[String; 2]> {
    let labelled = |line: String| {
        let label = line.char_indices().nth(LABEL).map_or(line.len(), |(end, _)| end);
        let (label, words) = line.split_at(label);
        [label.trim().to_owned(), words.to_owned()]
    };
    lines(summary).into_iter().map(labelled).collect()
}

/// Below this W is the rounding of a start on the reference [J].
const ROUNDING: f64 = 1e-15;

fn lines(summary: &ProofSummary) -> Vec<String> {
    let [rad, torque] = [units::ANGLE, units::TORQUE].map(|unit| summary.unit(unit));
    let mut lines = Vec::new();
    if let Some(region) = &summary.region {
        match (&region.error, region.level, &region.error_at_level) {
            (Some(error), Some(level), Some(at_level)) => {
                lines.push(format!(
                    "region       |q̃_i| ≤ {} {rad}, any speed, any configuration",
                    list(error)
                ));
                lines.push(format!(
                    "invariant    {{W ≤ {} J}}, where |q̃_i| ≤ {} {rad}",
                    short(rounded_down(level, 3), 3),
                    at_most(at_level)
                ));
            }
            _ => lines.push("region       any error, any speed, any configuration".to_owned()),
        }
        if let Some(start) = summary.start.filter(|_| region.level.is_some()) {
            let place = if start.inside {
                "inside: the model, in continuous time, stays in it"
            } else {
                "not known to be inside: nothing is said of this run"
            };
            lines.push(format!("start        W ≤ {} J, {place}", most(start.level.max(ROUNDING))));
        }
        lines.push("mass matrix  positive definite at every configuration".to_owned());
    }
    if let Some(tightness) = summary.tightness {
        lines.push(format!(
            "tightness    σ_l: {} % of {} 1/s, the slowest configuration of a dense sample",
            short(100.0 * tightness, 4),
            significant(summary.sigma_l_sampled.rate, 6)
        ));
    }
    for side in [LoopSide::Link, LoopSide::Motor] {
        let bounds = summary.measures.iter().filter(|measure| measure.side == side).map(|measure| {
            let norm = match measure.norm {
                Norm::One => "1",
                Norm::Two => "2",
                Norm::Infinity => "∞",
            };
            format!("μ_{norm} ≤ {}", significant(rounded_up(measure.bound, 6), 6))
        });
        let bounds = bounds.collect::<Vec<_>>().join(", ");
        if !bounds.is_empty() {
            let side = if side == LoopSide::Link { "links: " } else { "motors:" };
            lines.push(format!("measures     of −Θ ∂φ Θ⁻¹, {side} {bounds} 1/s"));
        }
    }
    for structure in &summary.structure {
        let name = match structure.name {
            StructureName::VariationalPh => "variational port-Hamiltonian structure",
            StructureName::PhLike => "port-Hamiltonian-like structure",
            StructureName::StrictDifferentialPassivity => "strict differential passivity from δω to M⁻¹ δσ",
            StructureName::IncrementalPassivity => "incremental passivity of χ = Π φ",
        };
        lines
            .push(format!("structure    {} {name}", if structure.holds { "keeps the" } else { "loses the" }));
    }
    if let Some(direct) = &summary.direct {
        lines.push(match (direct.rate, direct.boxes, &direct.at) {
            (Some(rate), Some(boxes), _) => format!(
                "direct       {} 1/s proved from the full inequality, {boxes} {}",
                significant(rounded_down(rate, 6), 6),
                if boxes == 1 { "box" } else { "boxes" }
            ),
            (_, boxes, at) => format!(
                "direct       {} after {} boxes, at {}",
                direct.verdict,
                boxes.unwrap_or_default(),
                shortened(at.as_deref().unwrap_or(NONE))
            ),
        });
    }
    if let Some(tube) = &summary.tube {
        lines.push(format!(
            "tube         |d_m| ≤ {} {torque}: W comes below {} J, where |q̃_i| ≤ {} {rad}",
            list(&tube.disturbance),
            most(tube.level),
            at_most(&tube.error)
        ));
    }
    lines.extend(stretched(summary));
    let in_funnel = matches!(summary.funnel, Some(FunnelSummary::Proved(_)));
    if let Some(within) = summary.within.as_ref().filter(|within| within.rate.is_some() || !in_funnel) {
        lines.extend(tolerated(within, &rad));
    }
    lines.extend(summary.funnel.iter().flat_map(|found| funnel(found, summary)));
    lines.extend(summary.sampled_tube.iter().flat_map(|found| sampled_tube(found, summary)));
    lines.extend(summary.along.iter().flat_map(|along| bounds(along, summary)));
    lines.extend(summary.witness.as_ref().map(|found| witness(found, &rad)));
    if let Some(undecided) = &summary.undecided {
        lines.push(format!("undecided    {} (boxes looked at: {})", undecided.at, undecided.spent));
    }
    lines.extend(summary.assumptions.iter().map(|note| format!("assumed      {note}")));
    lines
}

/// What holds of any two solutions in a metric that grows with the error.
fn stretched(summary: &ProofSummary) -> Option<String> {
    let stretched = summary.stretched.as_ref()?;
    let [rad, speed] = [units::ANGLE, units::SPEED].map(|unit| summary.unit(unit));
    let errors = summary.region.as_ref().and_then(|region| region.error.as_deref());
    let errors = errors.map_or(String::new(), |errors| format!("|q̃_i| ≤ {} {rad} and ", list(errors)));
    Some(format!(
        "stretched    {} 1/s between any two solutions of the virtual system, while both have {errors}|s_i| ≤ {} {speed}",
        significant(rounded_down(stretched.rate, 6), 6),
        list(&stretched.velocity_error)
    ))
}

/// What holds of the robots within the tolerances.
fn tolerated(within: &WithinSummary, rad: &str) -> Vec<String> {
    let (Some(rate), Some(level), Some(settles), Some(error)) =
        (within.rate, within.level, within.settles, &within.error)
    else {
        let open = format!("tolerances   not decided: {}", within.at.as_deref().unwrap_or(NONE));
        let closer = within.closer.as_ref().map(|closer| {
            format!(
                "tolerances   with all of them times {} that is proved of the ideal loop, at {} 1/s; what counts most is {} of joint {}",
                short(closer.factor, 4),
                significant(closer.rate, 6),
                closer.key,
                closer.joint + 1
            )
        });
        return std::iter::once(open).chain(closer).collect();
    };
    vec![
        format!(
            "tolerances   every robot within them, in the ideal loop along the reference, from W ≤ {} J: √W comes down at {} 1/s",
            engineering(rounded_down(level, 3)),
            significant(rounded_down(rate, 6), 6)
        ),
        format!(
            "tolerances   to that of W = {} J, where |q̃_i| ≤ {} {rad}, not to 0",
            most(settles),
            at_most(error)
        ),
    ]
}

/// What holds in the funnel.
fn funnel(found: &FunnelSummary, summary: &ProofSummary) -> Vec<String> {
    match found {
        FunnelSummary::Proved(found) => funnel_lines(found, &summary.kinds),
        FunnelSummary::Undecided(none) => vec![format!("funnel       none was found: {}", none.at)],
    }
}

/// What holds of motions of the sampled loop.
fn sampled_tube(found: &SampledTubeSummary, summary: &ProofSummary) -> Vec<String> {
    match found {
        SampledTubeSummary::Proved(found) => tube_lines(found, &summary.kinds),
        SampledTubeSummary::Undecided(none) => vec![format!("sampled      no tube was found: {}", none.at)],
    }
}

/// What is known of limits.
pub(super) fn of_limits(limits: &[Limit], kinds: &[JointKind]) -> Vec<String> {
    let undecided = limits.iter().filter(|limit| matches!(limit.verdict, Verdict::Undecided(_)));
    limits.iter().filter_map(|bound| limit(bound, kinds)).chain(open(undecided)).collect()
}

/// What is bounded along the reference.
fn bounds(along: &Along, summary: &ProofSummary) -> Vec<String> {
    let [rad, speed, torque] = [units::ANGLE, units::SPEED, units::TORQUE].map(|unit| summary.unit(unit));
    let mut lines = vec![
        format!(
            "along        while W ≤ {} J: |q̇_l| {}",
            short(along.level, 3),
            bounded(&along.velocity.bound, &speed)
        ),
        format!("along        |q_m − q_l| {}", bounded(&along.deflection.bound, &rad)),
        format!(
            "along        |u_m| {}, {} {torque} on the reference with the numbers of the file",
            bounded(&along.torque.bound, &torque),
            list(&along.torque.nominal)
        ),
    ];
    lines.extend(of_limits(&along.limits, &summary.kinds));
    lines
}

/// What is known of a limit.
fn limit(limit: &Limit, kinds: &[JointKind]) -> Option<String> {
    let kind = kinds.get(limit.joint).copied().unwrap_or(JointKind::Revolute);
    let (joint, key, unit) =
        (limit.joint + 1, limit.key, Unit::of_key(limit.key).unwrap_or(units::NONE).of(kind).plain);
    let verdict = match &limit.verdict {
        Verdict::Proved(bound) => {
            format!("never reached in the ideal loop, at most {} {unit}", short(above(*bound), 3))
        }
        Verdict::Refuted(state) => {
            format!("exceeded: {} {unit} at t = {} s", short(state.value, 3), short(state.t, 4))
        }
        Verdict::Undecided(_) => return None,
    };
    Some(format!("limit        {key} {} {unit} of joint {joint}: {verdict}", short(limit.limit, 4)))
}

/// Limits of which nothing is known, a line for those of a kind.
fn open<'a>(limits: impl Iterator<Item = &'a Limit>) -> Vec<String> {
    let mut joints: Vec<(&str, Vec<String>)> = Vec::new();
    for Limit { key, joint, .. } in limits {
        let joint = (joint + 1).to_string();
        match joints.iter_mut().find(|(known, _)| known == key) {
            Some((_, of_kind)) => of_kind.push(joint),
            None => joints.push((key, vec![joint])),
        }
    }
    let line = |(key, joints): (&str, Vec<String>)| {
        let s = if joints.len() == 1 { "" } else { "s" };
        format!("limit        {key} of joint{s} {}: not decided", joints.join(", "))
    };
    joints.into_iter().map(line).collect()
}

fn witness(witness: &WitnessSummary, rad: &str) -> String {
    let block = witness.block.name();
    let place = match (&witness.error, &witness.configuration) {
        (Some(error), _) => format!("at errors {} {rad}", list(error)),
        (_, Some(q)) => format!("at q_l = {} {rad}", list(q)),
        _ => "everywhere".to_owned(),
    };
    format!(
        "witness      {block} contracts at {} 1/s only, {place}, in direction {}",
        engineering(witness.rate),
        list(&witness.direction)
    )
}

/// At most 120 characters of a long text.
fn shortened(text: &str) -> String {
    let mut short: String = text.chars().take(120).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short
}

/// Bounds, if there are any: where one is not finite none are.
pub(super) fn bounded(bounds: &[f64], unit: &str) -> String {
    if bounds.iter().all(|bound| bound.is_finite()) {
        format!("≤ {} {unit}", at_most(bounds))
    } else {
        "not bounded".to_owned()
    }
}

/// An upper bound: what is printed is one, too, but for this part of it, so that 0.2 rounded outwards is not 0.201.
const OUTWARDS: f64 = 1e-12;

/// An upper bound to three digits.
fn most(bound: f64) -> String {
    short(above(bound), 3)
}

/// Upper bounds to three digits.
pub(super) fn at_most(bounds: &[f64]) -> String {
    list(&bounds.iter().map(|&bound| above(bound)).collect::<Vec<_>>())
}

fn above(bound: f64) -> f64 {
    rounded_up(bound * (1.0 - OUTWARDS), 3)
}

/// Numbers with blanks; one if all are the same.
pub(super) fn list(numbers: &[f64]) -> String {
    match numbers {
        [first, rest @ ..] if rest.iter().all(|x| x.total_cmp(first).is_eq()) => short(*first, 3),
        _ => format!("({})", numbers.iter().map(|&x| short(x, 3)).collect::<Vec<_>>().join(", ")),
    }
}
