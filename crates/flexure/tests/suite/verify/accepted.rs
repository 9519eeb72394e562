//! The certificates as they are.

use flexure::verify::verify;

use super::{CERTIFICATES, tree_with_a_rod};

#[test]
fn certificates_are_verified_and_every_claim_is_reported() {
    for (name, text) in CERTIFICATES {
        let report = verify(text).unwrap_or_else(|rejected| panic!("{name}: {rejected}"));
        assert_eq!(report.name, name);
        assert_eq!(report.assumptions, ["robot.stiffness: assumed"]);
        let names: Vec<_> = report.claims.iter().map(|claim| claim.name.as_str()).collect();
        for wanted in [
            "closed_loop",
            "region",
            "mass_matrix",
            "blocks.phi_l",
            "blocks.phi_m",
            "blocks.sigma_l",
            "blocks.sigma_m",
            "contraction_rate",
            "convergence_rate",
            "measures.link.1",
            "measures.motor.inf",
            "structure.variational-ph",
            "structure.incremental-passivity",
        ] {
            assert!(names.contains(&wanted), "{name}: no {wanted} in {names:?}");
        }
        assert_eq!(names.contains(&"tube"), name != "two-link-linear", "{name}");
    }
}

#[test]
fn the_paper_s_arm_has_the_rates_known_from_elsewhere() {
    for (name, contraction, convergence) in [
        ("two-link-tanh", 0.295_981_114_963_205_7, 9.950_547_536_867_305),
        ("two-link-linear", 30.0, 30.0),
        ("two-link-coupled-tanh", 10.0 - 2.0_f64.sqrt(), 10.0 - 2.0_f64.sqrt()),
    ] {
        let (_, text) = CERTIFICATES.into_iter().find(|(known, _)| *known == name).unwrap();
        let report = verify(text).unwrap();
        for (found, wanted) in [
            (report.contraction_rate.as_ref().unwrap(), contraction),
            (&report.convergence_rate, convergence),
        ] {
            let found: f64 = found.parse().unwrap();
            assert!((found / wanted - 1.0).abs() < 1e-12, "{name}: {found} against {wanted}");
        }
        let sigma = |block: &str| {
            let claim = report.claims.iter().find(|claim| claim.name == block).unwrap();
            let text = claim.value.strip_prefix("contraction ").unwrap();
            text.split_once(' ').unwrap().0.parse::<f64>().unwrap()
        };
        assert!((sigma("blocks.sigma_l") / 69.013_154_939_393_06 - 1.0).abs() < 1e-12);
        assert!((sigma("blocks.sigma_m") / 44.347_826_086_956_52 - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_thin_rod_is_a_body() {
    verify(&tree_with_a_rod()).unwrap();
}

/// A pair stands for whatever lies between: the rates are those of the worst.
#[test]
fn pairs_count_with_their_worst_end() {
    let text = CERTIFICATES[4].1;
    let pair = |lower, upper| text.replacen("\"0.873\"", &format!("[\"{lower}\", \"{upper}\"]"), 1);
    assert!(text.contains("\"0.873\""));
    assert!(verify(&pair("0.873", "0.873")).is_ok());
    assert!(verify(&pair("0.873", "0.8730001")).unwrap_err().to_string().contains("sigma_l"));
}
