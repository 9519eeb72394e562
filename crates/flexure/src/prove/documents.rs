//! What files of proofs along a run have in common: what they tell of a loop, whether that is a scenario's, and how they pack numbers.

use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use flexure_core::scalar::Interval;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::files::{self, Problem, Problems};
use crate::linalg::Dense;
use crate::prove::decimals;
use crate::prove::engine::certificate::{CertifiedPhi, DecimalLaw};
use crate::prove::engine::number::Number;
use crate::prove::subject::{Difference, compare, subject};
use crate::references::{Reference, Term};
use crate::robot::Links;
use crate::scenario::Scenario;
use crate::verify::{Rejected, strict};

/// Bytes that a file may have.
pub const LARGEST: u64 = 1 << 30;

/// Claims are weaker than what was found by this part, so that checkers with bounds a little wider find them, too.
pub(super) const ROOM: f64 = 1e-4;

/// A kind of files beside certificates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// What it is called, and the end of its files' names.
    pub name: &'static str,
    /// What such a file says that it is.
    pub format: &'static str,
    /// Version of the format.
    pub version: u32,
}

/// Tubes of the sampled loop: `docs/tube.md`.
pub const TUBE: Kind = Kind { name: "tube", format: "flexure-sampled-tube", version: 1 };

/// Funnels: `docs/funnel.md`.
pub const FUNNEL: Kind = Kind { name: "funnel", format: "flexure-funnel", version: 2 };

/// What came of checking a file, with what it is of.
#[derive(Clone, Debug)]
pub enum Checked<T> {
    /// It is about this loop, and everything that it claims holds.
    Holds(Box<T>),
    /// It is about another loop.
    Differs(Vec<Difference>),
    /// It is no such file, or what it claims does not hold.
    Rejected(Rejected),
    /// It was broken off.
    BrokenOff,
}

impl Kind {
    /// Where a file of this kind is: NAME.tube.json beside NAME.certificate.json.
    pub fn beside(&self, certificate: &Path) -> PathBuf {
        let name = certificate.file_name().unwrap_or_default().to_string_lossy();
        let name = name.strip_suffix(".json").unwrap_or(&name);
        let name = name.strip_suffix(".certificate").unwrap_or(name);
        certificate.with_file_name(format!("{name}.{}.json", self.name))
    }

    /// Whether the file at `path` begins as one of this kind.
    pub fn is_of(&self, path: &Path) -> bool {
        // What is in a pipe can be read once.
        if !path.is_file() {
            return false;
        }
        let mut begin = Vec::new();
        let read = File::open(path).and_then(|file| file.take(64).read_to_end(&mut begin));
        read.is_ok() && begin.windows(self.format.len()).any(|part| part == self.format.as_bytes())
    }

    /// That such a file may be written at `path`.
    ///
    /// # Errors
    /// As [`spare`](files::spare).
    pub fn spare(&self, path: &Path) -> Result<(), Problem> {
        // Not by its text, which may be long.
        if self.is_of(path) { Ok(()) } else { files::spare(path, self.name, |_| false, &[]) }
    }

    /// What the file says, its values at `objects` being some; `D` are the keys beside those of [`Told`].
    pub(super) fn read<D: DeserializeOwned>(
        &self,
        text: &str,
        objects: &[&str],
    ) -> Result<Document<D>, Rejected> {
        let value = strict(text).map_err(|error| Rejected::Malformed {
            place: "the file".to_owned(),
            reason: error.to_string(),
            line: Some(error.line()),
            column: Some(error.column()),
        })?;
        // What is read into structs may not be lists.
        let Value::Object(mut own) = value else { return Err(malformed("the file", "must be an object")) };
        if own.get("format") != Some(&self.format.into()) || own.get("version") != Some(&self.version.into())
        {
            let reason = format!("must be \"{}\", version {}", self.format, self.version);
            return Err(malformed("format", reason));
        }
        if let Some(key) = objects.iter().find(|key| !own.get(**key).is_some_and(Value::is_object)) {
            return Err(malformed("the file", format!("'{key}' must be an object")));
        }
        let told = Told::KEYS.iter().filter_map(|key| own.remove_entry(*key)).collect();
        let broken = |error: serde_json::Error| malformed("the file", error.to_string());
        Ok(Document {
            told: serde_json::from_value(Value::Object(told)).map_err(broken)?,
            own: serde_json::from_value(Value::Object(own)).map_err(broken)?,
        })
    }
}

/// A file: what all tell, and the keys of its kind.
#[derive(Serialize)]
pub(super) struct Document<D> {
    #[serde(flatten)]
    pub told: Told,
    #[serde(flatten)]
    pub own: D,
}

impl<D: Serialize> Document<D> {
    /// Its text, with a line for each of the texts of its last list, which is empty here.
    pub fn with_lines(&self, lines: impl Iterator<Item = String>) -> String {
        let head = serde_json::to_string_pretty(self).expect("texts and lists");
        let head = head.strip_suffix("]\n}").expect("a list is last");
        let lines: Vec<_> = lines.map(|line| format!("\n    \"{line}\"")).collect();
        format!("{head}{}\n  ]\n}}\n", lines.join(","))
    }
}

/// What a file is, and what it tells of a loop.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Told {
    pub format: String,
    pub version: u32,
    pub name: String,
    pub made_by: String,
    pub subject: Value,
    pub robot: Value,
    pub controller: Value,
    pub gravity: Value,
    pub reference: Value,
    pub initial: Value,
}

impl Told {
    const KEYS: [&'static str; 10] = [
        "format",
        "version",
        "name",
        "made_by",
        "subject",
        "robot",
        "controller",
        "gravity",
        "reference",
        "initial",
    ];

    /// By a file of this `kind`, of the loop of `scenario`.
    ///
    /// # Errors
    /// If its law is none that proofs speak of.
    pub fn of(kind: Kind, scenario: &Scenario) -> Result<Self, Problems> {
        let (gains, robot) = (scenario.vcbc()?, &scenario.robot);
        let numbers =
            |all: &[f64]| all.iter().map(|&x| Number::read(x, scenario.bounds(x))).collect::<Vec<_>>();
        let [link, motor] = [&gains.link, &gains.motor].map(|side| decimals::gains(scenario, side));
        let law = CertifiedPhi::named(gains.phi.name()).map(|phi| json!(DecimalLaw { phi, link, motor }));
        let initial = &scenario.initial;
        let initial = [&initial.q_l, &initial.q_m, &initial.dq_l, &initial.dq_m].map(|part| numbers(part));
        let is_horizontal = matches!(robot.links, Links::PlanarTwoLink(_));
        let gravity = robot.gravity.map(|x| Number::read(x, robot.bounds(x)));
        Ok(Self {
            format: kind.format.to_owned(),
            version: kind.version,
            name: scenario.name.clone(),
            made_by: format!("flexure {}", env!("CARGO_PKG_VERSION")),
            subject: json!(subject(scenario)),
            robot: json!(decimals::robot(robot)),
            controller: json!(law),
            gravity: if is_horizontal { Value::Null } else { json!(gravity) },
            reference: json!(reference(scenario)),
            initial: json!(initial.concat()),
        })
    }

    /// Where this is not what a scenario's file would tell, `own` being places beside, what is there and what would be.
    pub fn differences(&self, of_scenario: &Self, own: &[(&str, Value, Value)]) -> Vec<Difference> {
        let (ours, theirs) = (self, of_scenario);
        let parts: Vec<_> = [
            ("robot", &ours.robot, &theirs.robot),
            ("controller", &ours.controller, &theirs.controller),
            ("gravity", &ours.gravity, &theirs.gravity),
            ("reference", &ours.reference, &theirs.reference),
        ]
        .into_iter()
        .chain(own.iter().map(|(place, ours, theirs)| (*place, ours, theirs)))
        .chain([("initial", &ours.initial, &theirs.initial), ("subject", &ours.subject, &theirs.subject)])
        .collect();
        differences(&parts)
    }
}

/// The reference where it is sines, from the start on or joined; none where it is of another form.
fn reference(scenario: &Scenario) -> Option<Value> {
    let Reference::Sines(sines) = &scenario.reference else { return None };
    if scenario.time_scaling.is_some() {
        return None;
    }
    let number = |x: f64| Number::read(x, scenario.bounds(x));
    let numbers = |all: &[f64]| all.iter().map(|&x| number(x)).collect::<Vec<_>>();
    let term = |term: &Term| {
        let Term { amplitude, frequency, phase } = term;
        json!({ "amplitude": numbers(amplitude), "frequency": numbers(frequency), "phase": numbers(phase) })
    };
    let join = scenario
        .smooth_start
        .map(|start| json!({ "duration": number(start.duration), "settle": number(start.settle) }));
    let terms: Vec<_> = sines.terms.iter().map(term).collect();
    Some(json!({ "offset": numbers(&sines.offset), "terms": terms, "join": join }))
}

/// Where what a file says of its loop is not what the scenario's is: `parts` are places, what is there and what would be.
fn differences(parts: &[(&str, &Value, &Value)]) -> Vec<Difference> {
    let mut found = Vec::new();
    for (place, ours, theirs) in parts {
        compare(place, ours, theirs, &mut found);
    }
    found.retain(|difference| difference.place != "robot.name");
    // Equal but for spelling, and keys that are missing or too many.
    let nameless = |value: &Value| {
        let mut value = value.clone();
        if let Some(name) = value.get_mut("name").filter(|name| name.is_string()) {
            *name = Value::from("");
        }
        value
    };
    if found.is_empty() && parts.iter().any(|(_, ours, theirs)| nameless(ours) != nameless(theirs)) {
        found.push(Difference {
            place: "loop".to_owned(),
            certificate: "spelt otherwise, or with other keys".to_owned(),
            scenario: "as this program writes it".to_owned(),
        });
    }
    found
}

pub(super) fn malformed(place: impl Into<String>, reason: impl Into<String>) -> Rejected {
    Rejected::Malformed { place: place.into(), reason: reason.into(), line: None, column: None }
}

pub(super) fn refuted(claim: &str, reason: impl Into<String>) -> Rejected {
    Rejected::False { claim: claim.to_owned(), reason: reason.into() }
}

/// Claims of which none is left out.
pub(super) fn every(texts: &[String]) -> Vec<Option<&String>> {
    texts.iter().map(Some).collect()
}

/// That a `rate` that is claimed is no more than what was `found` \[1/s\].
pub(super) fn rate_holds(rate: &str, found: f64) -> Result<(), Rejected> {
    let holds = Interval::from_decimal(rate).is_some_and(|rate| rate.hi() <= found);
    if holds { Ok(()) } else { Err(refuted("rate", format!("{rate} 1/s are claimed, {found} are there"))) }
}

/// That bounds of `what` that are claimed are no less than what is `there`; none is claimed where there is no text.
pub(super) fn bounds_hold(what: &str, texts: &[Option<&String>], there: &[f64]) -> Result<(), Rejected> {
    for (i, (text, &there)) in texts.iter().zip(there).enumerate() {
        let holds = text.is_none_or(|text| Interval::from_decimal(text).is_some_and(|x| x.lo() >= there));
        if !holds {
            let claimed = text.map_or("", String::as_str);
            let reason = format!("at most {claimed} is claimed, {there} is there");
            return Err(refuted(&format!("{what}[{i}]"), reason));
        }
    }
    Ok(())
}

/// The text of a number.
pub(super) fn text(number: Number) -> String {
    match number {
        Number::Decimal(text) | Number::Between([text, _]) => text,
    }
}

/// `numbers` of 64 bits, the lowest byte first, in base64.
pub(super) fn packed(numbers: impl Iterator<Item = f64>) -> String {
    BASE64.encode(numbers.flat_map(f64::to_le_bytes).collect::<Vec<u8>>())
}

/// The numbers that `text` packs, or what is wrong with it.
pub(super) fn unpacked(text: &str) -> Result<Vec<f64>, String> {
    let bytes = BASE64.decode(text).map_err(|error| format!("is no base64: {error}"))?;
    let (all, []) = bytes.as_chunks::<8>() else { return Err("is no list of 64-bit numbers".to_owned()) };
    let all: Vec<_> = all.iter().map(|&bytes| f64::from_le_bytes(bytes)).collect();
    if all.iter().all(|x| x.is_finite()) {
        Ok(all)
    } else {
        Err("has numbers that are not finite".to_owned())
    }
}

/// Entries of a lower triangle of `size` rows.
pub(super) fn triangle(size: usize) -> usize {
    size * (size + 1) / 2
}

/// The entries of a lower triangle, row by row.
pub(super) fn lower(matrix: &Dense<f64>) -> impl Iterator<Item = f64> + '_ {
    matrix.rows().enumerate().flat_map(|(i, row)| row[..=i].iter().copied())
}

/// The lower triangular matrix of `size` rows with these `entries`, row by row, if its diagonal is positive; else where it is not.
pub(super) fn of_lower(size: usize, entries: &[f64]) -> Result<Dense<f64>, String> {
    let entry = |i: usize, j: usize| if j <= i { entries[triangle(i) + j] } else { 0.0 };
    let matrix = Dense::from_fn(size, size, entry);
    match (0..size).find(|&i| matrix[(i, i)] <= 0.0) {
        Some(i) => Err(format!("has a diagonal that is not positive, at {i}")),
        None => Ok(matrix),
    }
}
