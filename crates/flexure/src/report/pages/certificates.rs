//! The section of the report on what was proved.

use maud::{Markup, html as markup};

use crate::files::number::{NONE, engineering, short, significant};
use crate::prove::engine::certificate::StructureName;
use crate::prove::summary::ProofSummary;
use crate::report::tables::summary::proved_rate;
use crate::units;

/// A proof as the report shows it.
#[derive(Clone, Debug)]
pub struct CertificateReport {
    /// Rates, region, structures and limits that were proved.
    pub summary: ProofSummary,
    /// Shaping function.
    pub phi: String,
    /// Name of the certificate file, from the folder of the page; none if it is not there.
    pub file: Option<String>,
}

/// The table of proofs, with what it means.
pub(crate) fn section(certificates: &[CertificateReport]) -> Markup {
    let unit = certificates.first().map_or_else(String::new, |first| first.summary.unit(units::ANGLE));
    let files: Vec<&String> =
        certificates.iter().filter_map(|certificate| certificate.file.as_ref()).collect();
    markup! {
        div.prose {
            p {
                "Proved with every rounding outwards, from the decimals of the robot and scenario files, for the closed loop in "
                "continuous time: " strong { "contraction" } " is the rate at which the distance between any two solutions of the "
                "virtual system shrinks, " strong { "convergence" } " the rate towards the reference. Both hold for position errors "
                "up to those in the column region, at every configuration and every speed, while no torque limit is active. The last "
                "column is the contraction rate once more, from the full inequality without the theorem on its blocks."
            }
        }
        div.scroll {
            table.numbers {
                thead { tr {
                    th { "φ" }
                    th { "region" br; span.unit { "|q̃| [" (unit) "]" } }
                    @for title in ["contraction", "convergence", "paper’s formula", "φ_l", "φ_m", "σ_l", "σ_m"] {
                        th { (crate::report::pages::runs::symbols(title)) br; span.unit { "[1/s]" } }
                    }
                    th { "keeps" br; span.unit { "structure" } }
                    th { "direct" br; span.unit { "[1/s]" } }
                } }
                tbody { @for certificate in certificates { (row(certificate)) } }
            }
        }
        p.note {
            (crate::report::pages::runs::symbols("φ_l … σ_m")) ": contraction rates of the blocks of positions and momenta, links and motors. Check a certificate with "
            code { "flexure verify FILE" } " or " code { "tools/check_certificate.py FILE" }
            @for (i, file) in files.iter().enumerate() {
                @if i > 0 { ", " } @else { ": " }
                a href=(file) { (file) }
            }
            "."
        }
    }
}

fn row(certificate: &CertificateReport) -> Markup {
    let CertificateReport { summary, phi, .. } = certificate;
    let rate = |rate: Option<f64>| match rate {
        Some(rate) if rate >= 1e-3 => significant(rate, 6),
        rate => proved_rate(rate),
    };
    let rough = |rate: f64| if rate.abs() < 1e-3 { proved_rate(Some(rate.abs())) } else { engineering(rate) };
    let blocks = summary.blocks;
    let region = summary.region.as_ref().and_then(|region| region.error.as_ref());
    let largest = region.map(|errors| errors.iter().copied().fold(0.0, f64::max));
    let direct = summary.direct.as_ref().and_then(|direct| direct.rate);
    markup! {
        tr {
            th scope="row" { (phi) }
            td { (largest.map_or("any".to_owned(), |error| short(error, 3))) }
            td { (rate(summary.contraction_rate)) }
            td { (rate(summary.convergence_rate)) }
            td { (rough(summary.paper_rate)) }
            @for block in [blocks.map(|b| b.phi_l), blocks.map(|b| b.phi_m), blocks.map(|b| b.sigma_l), blocks.map(|b| b.sigma_m)] {
                td { (block.map_or(NONE.to_owned(), rough)) }
            }
            td { (structures(summary)) }
            td { (rate(direct)) }
        }
    }
}

/// Which port-Hamiltonian structures are kept.
fn structures(summary: &ProofSummary) -> String {
    let kept = |name| summary.structure.iter().any(|structure| structure.name == name && structure.holds);
    match (kept(StructureName::VariationalPh), kept(StructureName::PhLike)) {
        (true, true) => "pH-like, variational pH".to_owned(),
        (true, false) => "variational pH".to_owned(),
        (false, true) => "pH-like".to_owned(),
        (false, false) => "neither".to_owned(),
    }
}
