//! What a certificate is about: is it the loop of this scenario?

use flexure_core::scalar::Interval;
use serde::Serialize;
use serde_json::Value;

use crate::files::Problems;
use crate::prove::decimals;
use crate::prove::engine::certificate::{CertifiedPhi, DecimalLaw, Subject};
use crate::scenario::Scenario;

/// What the files of a scenario say, hashed.
pub(crate) fn subject(scenario: &Scenario) -> Subject {
    Subject { robot: scenario.robot.digest.clone(), scenario: scenario.digest.clone() }
}

impl Scenario {
    /// SHA-256 of what its files say, in hexadecimal, of the robot's and then of its own: the same for files that differ in comments
    /// and spaces only.
    pub fn digest(&self) -> String {
        format!("{}{}", self.robot.digest, self.digest)
    }
}

/// A value that a certificate and a scenario have differently.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// Path in the certificate, like `controller.link.damping[0]`.
    pub place: String,
    /// What the certificate has there, as JSON; `null` if nothing.
    pub certificate: String,
    /// What the scenario makes of it, as JSON; `null` if nothing.
    pub scenario: String,
}

/// Where a certificate, as the text of its file, is about another loop than `scenario`: numbers of the robot, gains, and the
/// hashes of both files. None where it is about this one. Names and made-up texts do not count.
///
/// ```
/// use flexure::prove::{question::Question, subject::differences};
///
/// let scenario = flexure::Scenario::load("pendulum-tanh")?;
/// let proof = scenario.certify(&Question::default())?;
/// let text = serde_json::to_string(proof.verdict.proved().expect("proved"))?;
/// assert_eq!(differences(&text, &scenario)?, []);
///
/// let other = flexure::Scenario::load("two-link-tanh")?;
/// assert_eq!(differences(&text, &other)?[0].place, "robot.joints");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the scenario has no law that certificates speak of.
pub fn differences(certificate: &str, scenario: &Scenario) -> Result<Vec<Difference>, Problems> {
    let gains = scenario.vcbc()?;
    let certificate: Value = serde_json::from_str(certificate).unwrap_or_default();
    let robot = serde_json::to_value(decimals::robot(&scenario.robot)).unwrap_or_default();
    let mut found = Vec::new();
    compare("robot", &certificate["robot"], &robot, &mut found);
    found.retain(|difference| difference.place != "robot.name");
    let phi = CertifiedPhi::named(gains.phi.name());
    let (link, motor) = (decimals::gains(scenario, &gains.link), decimals::gains(scenario, &gains.motor));
    match phi.map(|phi| serde_json::to_value(DecimalLaw { phi, link, motor }).unwrap_or_default()) {
        Some(controller) => compare("controller", &certificate["controller"], &controller, &mut found),
        None => found.push(difference(
            "controller.phi",
            &certificate["controller"]["phi"],
            &Value::from(gains.phi.name()),
        )),
    }
    let subject = serde_json::to_value(subject(scenario)).unwrap_or_default();
    compare("subject", &certificate["subject"], &subject, &mut found);
    Ok(found)
}

/// Notes where two trees of JSON differ.
pub(crate) fn compare(place: &str, ours: &Value, theirs: &Value, found: &mut Vec<Difference>) {
    match (ours, theirs) {
        (Value::Object(ours), Value::Object(theirs)) => {
            let missing = theirs.keys().filter(|key| !ours.contains_key(*key));
            for key in ours.keys().chain(missing) {
                let at =
                    |object: &serde_json::Map<String, Value>| object.get(key).cloned().unwrap_or_default();
                compare(&format!("{place}.{key}"), &at(ours), &at(theirs), found);
            }
        }
        (Value::Array(ours), Value::Array(theirs)) if ours.len() == theirs.len() => {
            for (i, (ours, theirs)) in ours.iter().zip(theirs).enumerate() {
                compare(&format!("{place}[{i}]"), ours, theirs, found);
            }
        }
        _ if same(ours, theirs) => {}
        _ => found.push(difference(place, ours, theirs)),
    }
}

/// Whether two values are the same, numbers however they are written.
fn same(ours: &Value, theirs: &Value) -> bool {
    let number = |value: &Value| value.as_str().and_then(Interval::from_decimal);
    ours == theirs || number(ours).is_some_and(|ours| number(theirs) == Some(ours))
}

fn difference(place: &str, certificate: &Value, scenario: &Value) -> Difference {
    Difference {
        place: place.to_owned(),
        certificate: certificate.to_string(),
        scenario: scenario.to_string(),
    }
}
