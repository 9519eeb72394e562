//! A proof as a file: found by the prover, checked by a verifier that shares no code with it, and refused when tampered with.

use std::error::Error;
use std::fs;

use flexure::Scenario;
use flexure::prove::question::{Question, Region};
use flexure::report::write_certificate;
use flexure::verify::{Rejected, verify};

/// Proves, writes, checks; then claims more than was proved.
pub fn main() -> Result<(), Box<dyn Error>> {
    // How fast do errors decay, for position errors of links and motors up to 0.2 rad and motor torques unknown by 0.1 N m?
    let question = Question {
        region: Region::Errors(vec![0.2; 4]),
        disturbance: Some(vec![0.1; 2]),
        ..Question::default()
    };
    let proof = Scenario::load("two-link-tanh")?.certify(&question)?;
    let certificate = proof.verdict.proved().ok_or("nothing was proved")?;

    // Everything that a checker needs, as JSON: docs/certificate.md says what each number claims.
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("two-link-tanh.certificate.json");
    write_certificate(&file, certificate)?;
    let text = fs::read_to_string(&file)?;

    let report = verify(&text)?;
    println!("{}: {} claims hold, among them", report.name, report.claims.len());
    let contraction = report.contraction_rate.ok_or("no contraction rate")?;
    println!("  any two motions approach each other with {contraction} 1/s");
    println!("  errors decay with {} 1/s", report.convergence_rate);
    let tube = certificate.tube.as_ref().ok_or("no tube")?;
    for (i, error) in tube.error.iter().enumerate().take(2) {
        println!("  joint {} ends within {:.3} mrad", i + 1, 1e3 * error.approximate());
    }

    // A bolder claim than was proved does not pass.
    let honest = format!("\"contraction_rate\": \"{contraction}\"");
    assert!(text.contains(&honest));
    let bold = text.replace(&honest, "\"contraction_rate\": \"9999\"");
    match verify(&bold) {
        Err(Rejected::False { claim, reason }) => println!("9999 1/s is refused: {claim}: {reason}"),
        other => panic!("a false claim passed: {other:?}"),
    }
    assert!(contraction.parse::<f64>()? > 0.0);
    Ok(())
}
