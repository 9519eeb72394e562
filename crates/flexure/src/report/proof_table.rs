//! A proof as text for the terminal.

use std::fmt::Write;

use super::number::{NONE, engineering};
use super::table::{headed, right};
use crate::certify::certificate::{BlockName, Norm, Side, StructureName};
use crate::proof_summary::{BlockRates, ProofSummary, WitnessSummary};

/// What was proved, refuted or left undecided, at most 100 columns wide.
pub fn proof_table(summary: &ProofSummary) -> String {
    let mut text = format!("{}: {}\n", summary.name, summary.verdict);
    if let (Some(contraction), Some(convergence)) = (summary.blocks, summary.convergence_blocks) {
        text += &rates(summary, contraction, convergence);
    }
    for line in lines(summary) {
        // Writing to a text cannot fail.
        let _ = write!(text, "\n{line}");
    }
    text
}

fn rates(summary: &ProofSummary, contraction: BlockRates, convergence: BlockRates) -> String {
    let mut table = headed(["rate", "contraction\n[1/s]", "convergence\n[1/s]"].into_iter());
    let number = |x: Option<f64>| right(x.map_or(NONE.to_owned(), |x| format!("{x:.6}")));
    let mut row = |name: &str, contraction, convergence| {
        table.add_row(vec![comfy_table::Cell::new(name), number(contraction), number(convergence)]);
    };
    row("phi_l    link positions", Some(contraction.phi_l), Some(convergence.phi_l));
    row("phi_m    motor positions", Some(contraction.phi_m), Some(convergence.phi_m));
    row("sigma_l  link momenta", Some(contraction.sigma_l), Some(convergence.sigma_l));
    row("sigma_m  motor momenta", Some(contraction.sigma_m), Some(convergence.sigma_m));
    row("closed loop", summary.contraction_rate, summary.convergence_rate);
    row("the paper's formula", Some(summary.paper_rate), None);
    table.to_string()
}

fn lines(summary: &ProofSummary) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(region) = &summary.region {
        lines.push(match (&region.error, region.level, &region.error_at_level) {
            (Some(error), Some(level), Some(at_level)) => format!(
                "region       errors up to {} rad; {{W <= {} J}} lies inside and is invariant: errors up to {} rad",
                list(error),
                engineering(level),
                list(at_level)
            ),
            _ => "region       everything: any error, any speed, any configuration".to_owned(),
        });
        lines.push("mass matrix  positive definite at every configuration".to_owned());
    }
    if let Some(tightness) = summary.tightness {
        lines.push(format!(
            "tightness    sigma_l is proved to {:.2} % of the slowest of 20000 sampled configurations, {} 1/s",
            100.0 * tightness,
            engineering(summary.sampled.rate)
        ));
    }
    for side in [Side::Link, Side::Motor] {
        let bounds = summary.measures.iter().filter(|measure| measure.side == side).map(|measure| {
            let norm = match measure.norm {
                Norm::One => "1",
                Norm::Two => "2",
                Norm::Infinity => "inf",
            };
            format!("mu_{norm} <= {:.6}", measure.bound)
        });
        let bounds = bounds.collect::<Vec<_>>().join(", ");
        if !bounds.is_empty() {
            let side = if side == Side::Link { "link " } else { "motor" };
            lines.push(format!("measures     {side} slopes: {bounds} 1/s"));
        }
    }
    for structure in &summary.structure {
        let name = match structure.name {
            StructureName::VariationalPh => "variational port-Hamiltonian structure",
            StructureName::PhLike => "port-Hamiltonian-like structure",
            StructureName::StrictDifferentialPassivity => "strict differential passivity",
            StructureName::IncrementalPassivity => "incremental passivity of Pi phi",
        };
        lines.push(format!("structure    {}: {name}", if structure.holds { "kept    " } else { "not kept" }));
    }
    if let Some(tube) = &summary.tube {
        lines.push(format!(
            "tube         motors disturbed by up to {} N m: W settles below {} J, errors below {} rad",
            list(&tube.disturbance),
            engineering(tube.level),
            list(&tube.error)
        ));
    }
    lines.extend(summary.witness.as_ref().map(witness));
    if let Some(undecided) = &summary.undecided {
        lines.push(format!("undecided    {} (boxes looked at: {})", undecided.at, undecided.spent));
    }
    lines
}

fn witness(witness: &WitnessSummary) -> String {
    let block = match witness.block {
        BlockName::PhiL => "phi_l",
        BlockName::PhiM => "phi_m",
        BlockName::SigmaL => "sigma_l",
        BlockName::SigmaM => "sigma_m",
    };
    let place = match (&witness.error, &witness.configuration) {
        (Some(error), _) => format!("at errors {} rad", list(error)),
        (_, Some(q)) => format!("at q_l = {} rad", list(q)),
        _ => "everywhere".to_owned(),
    };
    format!(
        "witness      {block} contracts at {} 1/s only, {place}, in direction {}",
        engineering(witness.rate),
        list(&witness.direction)
    )
}

/// Numbers with blanks; one if all are the same.
fn list(numbers: &[f64]) -> String {
    match numbers {
        [first, rest @ ..] if rest.iter().all(|x| x == first) => engineering(*first),
        _ => format!("({})", numbers.iter().map(|&x| engineering(x)).collect::<Vec<_>>().join(", ")),
    }
}
