//! The file of a tube: what it is about, what is claimed, and every section; `docs/tube-file.md` states what each number means.

use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use flexure_core::scalar::{Interval, Scalar};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::feasible::enclosed_initial_motion;
use crate::files::Problems;
use crate::linalg::Dense;
use crate::progress::Progress;
use crate::prove::decimals;
use crate::prove::engine::certificate::{CertifiedPhi, DecimalLaw};
use crate::prove::engine::number::Number;
use crate::prove::engine::sampled_data::section::Section;
use crate::prove::engine::sampled_data::tube::Sections;
use crate::prove::sampled_data::spoken_of::{sensors, suitable_when_sampled};
use crate::prove::sampled_data::{Asked, NoTube, SampledTube, followed, late};
use crate::prove::subject::{Difference, compare, subject};
use crate::references::{Reference, Term};
use crate::scenario::Scenario;
use crate::verify::{Rejected, is_decimal, strict};

/// What the file says that it is.
pub const FORMAT: &str = "flexure-sampled-tube";

/// Version of the format.
const VERSION: u32 = 1;

/// Bytes that a file may have.
pub const LARGEST: u64 = 1 << 30;

/// All of a file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: String,
    version: u32,
    name: String,
    made_by: String,
    subject: Value,
    robot: Value,
    controller: Value,
    gravity: Value,
    reference: Value,
    #[serde(rename = "loop")]
    sampled: Value,
    initial: Value,
    asked: AskedTexts,
    periods: usize,
    claims: Claims,
    kept: Vec<usize>,
    sections: Vec<String>,
}

/// What a search was for, in decimals.
#[derive(Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct AskedTexts {
    extents: Vec<String>,
    rate: String,
}

impl AskedTexts {
    /// The floats that they restore, if all of them are positive.
    fn read(&self) -> Option<Asked> {
        let positive = |text: &String| text.parse().ok().filter(|x: &f64| *x > 0.0 && x.is_finite());
        let extents = self.extents.iter().map(positive).collect::<Option<_>>()?;
        Some(Asked { extents, rate: positive(&self.rate)? })
    }
}

/// What is claimed of the sections, in decimals.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Claims {
    rate: String,
    error: Vec<String>,
    torque: Vec<String>,
}

impl SampledTube {
    /// The file of this tube of `scenario`: JSON, a line for each section.
    ///
    /// # Errors
    /// If the scenario has no law that tubes speak of.
    ///
    /// # Panics
    /// Never: there is nothing in it that JSON cannot say.
    pub fn file(&self, scenario: &Scenario) -> Result<String, Problems> {
        let mut document = about(scenario)?;
        let restored = |x: f64| text(Number::decimal(x));
        document.asked = AskedTexts {
            extents: self.asked.extents.iter().map(|&x| restored(x)).collect(),
            rate: restored(self.asked.rate),
        };
        let above = |all: &[f64]| all.iter().map(|&x| text(Number::above(x))).collect();
        document.claims = Claims {
            rate: text(Number::below(self.rate)),
            error: above(&self.error),
            torque: above(&self.torque),
        };
        document.kept = self.sections.iter().map(|section| section.past.columns()).collect();
        let head = serde_json::to_string_pretty(&document).expect("texts and lists");
        let head = head.strip_suffix("]\n}").expect("sections are last");
        let sections: Vec<_> =
            self.sections.iter().map(|section| format!("\n    \"{}\"", written(section))).collect();
        Ok(format!("{head}{}\n  ]\n}}\n", sections.join(",")))
    }
}

/// All digits of a float, if they are few.
fn exact(x: f64) -> Number {
    // 2⁻²⁰ has its last digit 72 places behind the point, if 53 bits follow.
    let digits = format!("{x:.80}");
    let digits = digits.trim_end_matches('0').trim_end_matches('.');
    let is_all = x.abs() > 2.0_f64.powi(-20) && digits.len() < 100;
    if is_all { Number::Decimal(digits.to_owned()) } else { Number::computed(Interval::point(x)) }
}

fn text(number: Number) -> String {
    match number {
        Number::Decimal(text) | Number::Between([text, _]) => text,
    }
}

/// What a file says of the loop of `scenario`, without a tube.
fn about(scenario: &Scenario) -> Result<Document, Problems> {
    let (gains, robot) = (scenario.vcbc()?, &scenario.robot);
    let numbers = |all: &[f64]| all.iter().map(|&x| Number::read(x, scenario.bounds(x))).collect::<Vec<_>>();
    let [link, motor] = [&gains.link, &gains.motor].map(|side| decimals::gains(scenario, side));
    let law = CertifiedPhi::named(gains.phi.name()).map(|phi| json!(DecimalLaw { phi, link, motor }));
    let (sensors, late) = (sensors(scenario), late(scenario));
    let filter = sensors.filter.map(|filter| {
        let both = |of: [Interval; 2]| of.map(|x| exact(x.midpoint()));
        json!({ "feedback": both(filter.feedback), "forward": both(filter.forward) })
    });
    let initial = &scenario.initial;
    let initial = [&initial.q_l, &initial.q_m, &initial.dq_l, &initial.dq_m].map(|part| numbers(part));
    let lies = matches!(robot.links, crate::robot::Links::PlanarTwoLink(_));
    let gravity = robot.gravity.map(|x| Number::read(x, robot.bounds(x)));
    Ok(Document {
        format: FORMAT.to_owned(),
        version: VERSION,
        name: scenario.name.clone(),
        made_by: format!("flexure {}", env!("CARGO_PKG_VERSION")),
        subject: json!(subject(scenario)),
        robot: json!(decimals::robot(robot)),
        controller: json!(law),
        gravity: if lies { Value::Null } else { json!(gravity) },
        reference: json!(reference(scenario)?),
        sampled: json!({
            "control_period": Number::read(scenario.control_period, scenario.bounds(scenario.control_period)),
            "waiting": late.waiting,
            "offset": late.offset.map(Number::computed),
            // From below: the float that is proved about is above its shortest decimal.
            "off": sensors.off.iter().map(|&off| Number::decimal(off.next_down())).collect::<Vec<_>>(),
            "filter": filter,
        }),
        initial: json!(initial.concat()),
        asked: AskedTexts::default(),
        periods: scenario.periods() as usize,
        claims: Claims { rate: String::new(), error: Vec::new(), torque: Vec::new() },
        kept: Vec::new(),
        sections: Vec::new(),
    })
}

/// The reference where it is sines, from the start on or joined from rest; none where it is of another form.
fn reference(scenario: &Scenario) -> Result<Option<Value>, Problems> {
    let Reference::Sines(sines) = &scenario.reference else { return Ok(None) };
    if scenario.time_scaling.is_some() {
        return Ok(None);
    }
    let number = |x: f64| Number::read(x, scenario.bounds(x));
    let numbers = |all: &[f64]| all.iter().map(|&x| number(x)).collect::<Vec<_>>();
    let term = |term: &Term| {
        let Term { amplitude, frequency, phase } = term;
        json!({ "amplitude": numbers(amplitude), "frequency": numbers(frequency), "phase": numbers(phase) })
    };
    let join = match &scenario.smooth_start {
        None => None,
        Some(start) => {
            let motion = enclosed_initial_motion(scenario)?;
            if motion.iter().any(|q| (1..4).any(|k| q.coefficient(k) != Interval::ZERO)) {
                return Ok(None);
            }
            Some(json!({ "duration": number(start.duration), "position": numbers(&scenario.initial.q_l) }))
        }
    };
    let terms: Vec<_> = sines.terms.iter().map(term).collect();
    Ok(Some(json!({ "offset": numbers(&sines.offset), "terms": terms, "join": join })))
}

/// A section as the file has it, without P.
fn written(section: &Section) -> String {
    let lower = section.lower.rows().enumerate().flat_map(|(i, row)| &row[..=i]);
    let all = section.center.iter().chain(lower);
    BASE64.encode(all.flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>())
}

/// The section of `size` numbers that `text` is, without P; or what is wrong with it.
fn read(text: &str, size: usize) -> Result<Section, String> {
    let bytes = BASE64.decode(text).map_err(|error| format!("is no base64: {error}"))?;
    let (all, []) = bytes.as_chunks::<8>() else { return Err("is no list of 64-bit numbers".to_owned()) };
    let all: Vec<_> = all.iter().map(|&bytes| f64::from_le_bytes(bytes)).collect();
    let own = size + size * (size + 1) / 2;
    if all.len() != own {
        return Err(format!("has {} numbers, must have {own}", all.len()));
    }
    if !all.iter().all(|x| x.is_finite()) {
        return Err("has numbers that are not finite".to_owned());
    }
    let lower = |i: usize, j: usize| if j <= i { all[size + i * (i + 1) / 2 + j] } else { 0.0 };
    let section = Section {
        center: all[..size].to_vec(),
        lower: Dense::from_fn(size, size, lower),
        past: Dense::zeros(size, 0),
    };
    match (0..size).find(|&i| section.lower[(i, i)] <= 0.0) {
        Some(i) => Err(format!("has a diagonal that is not positive, at {i}")),
        None => Ok(section),
    }
}

/// What came of checking a file.
#[derive(Clone, Debug)]
pub enum Checked {
    /// It is about this loop, and everything that it claims holds.
    Holds(Box<SampledTube>),
    /// It is about another loop.
    Differs(Vec<Difference>),
    /// It is no such file, or what it claims does not hold.
    Rejected(Rejected),
    /// It was broken off.
    BrokenOff,
}

fn malformed(place: impl Into<String>, reason: impl Into<String>) -> Checked {
    Checked::Rejected(Rejected::Malformed {
        place: place.into(),
        reason: reason.into(),
        line: None,
        column: None,
    })
}

fn refuted(claim: &str, reason: impl Into<String>) -> Checked {
    Checked::Rejected(Rejected::False { claim: claim.to_owned(), reason: reason.into() })
}

/// Follows every section of the file whose text is `text` for a period of the loop of `scenario`.
///
/// # Errors
/// If tubes do not speak of such a loop.
pub fn check(text: &str, scenario: &Scenario, progress: Progress<'_>) -> Result<Checked, Problems> {
    let value = match strict(text) {
        Ok(value) => value,
        Err(error) => {
            return Ok(Checked::Rejected(Rejected::Malformed {
                place: "the file".to_owned(),
                reason: error.to_string(),
                line: Some(error.line()),
                column: Some(error.column()),
            }));
        }
    };
    // What is read into structs may not be lists.
    let is_object = |of: &Value| of.is_object();
    if !is_object(&value) || !["asked", "claims"].iter().all(|&key| value.get(key).is_none_or(is_object)) {
        return Ok(malformed("the file", "must be an object, asked and claims too"));
    }
    let document: Document = match serde_json::from_value(value) {
        Ok(document) => document,
        Err(error) => return Ok(malformed("the file", error.to_string())),
    };
    if document.format != FORMAT || document.version != VERSION {
        return Ok(malformed("format", format!("must be \"{FORMAT}\", version {VERSION}")));
    }
    suitable_when_sampled(scenario)?;
    let differences = differences(&document, &about(scenario)?);
    if !differences.is_empty() {
        return Ok(Checked::Differs(differences));
    }
    let Document { asked, claims, kept, sections, periods, .. } = document;
    let n = scenario.robot.joint_count();
    let lengths = [asked.extents.len(), claims.error.len() / 2, claims.torque.len()];
    if lengths != [n; 3] || claims.error.len() % 2 != 0 {
        return Ok(malformed("claims", format!("must be of {n} joints, and asked.extents too")));
    }
    let Some(asked) = asked.read() else { return Ok(malformed("asked", "must be positive numbers")) };
    for (what, all) in
        [("rate", std::slice::from_ref(&claims.rate)), ("error", &claims.error), ("torque", &claims.torque)]
    {
        if let Some(text) = all.iter().find(|text| !is_decimal(text)) {
            return Ok(malformed(format!("claims.{what}"), format!("'{text}' is no number")));
        }
    }
    if sections.len() != periods + 1 {
        return Ok(malformed("sections", format!("are {}, must be {}", sections.len(), periods + 1)));
    }
    let sensors = sensors(scenario);
    let most = |before: usize| before + sensors.off.len();
    let is_kept = kept.first() == Some(&0) && kept.windows(2).all(|two| two[1] <= most(two[0]));
    if kept.len() != sections.len() || !is_kept {
        let reason =
            format!("must be {} numbers from 0, each at most {} more than the last", periods + 1, most(0));
        return Ok(malformed("kept", reason));
    }
    let size = 4 * n + sensors.remembered(n) + late(scenario).waiting * n;
    let mut all = Vec::with_capacity(sections.len());
    for (k, text) in sections.iter().enumerate() {
        match read(text, size) {
            Ok(section) => all.push(section),
            Err(reason) => return Ok(malformed(format!("sections[{k}]"), reason)),
        }
    }
    Ok(match followed(scenario, asked, Sections::Given(&all, &kept), progress)? {
        None => Checked::BrokenOff,
        Some(Err(NoTube { at })) => refuted("sections", at),
        Some(Ok(tube)) => compared(&claims, tube),
    })
}

/// Where what the file says of its loop is not what the scenario's is.
fn differences(ours: &Document, theirs: &Document) -> Vec<Difference> {
    let mut found = Vec::new();
    for (place, ours, theirs) in [
        ("robot", &ours.robot, &theirs.robot),
        ("controller", &ours.controller, &theirs.controller),
        ("gravity", &ours.gravity, &theirs.gravity),
        ("reference", &ours.reference, &theirs.reference),
        ("loop", &ours.sampled, &theirs.sampled),
        ("initial", &ours.initial, &theirs.initial),
        ("periods", &ours.periods.into(), &theirs.periods.into()),
        ("subject", &ours.subject, &theirs.subject),
    ] {
        compare(place, ours, theirs, &mut found);
    }
    found.retain(|difference| difference.place != "robot.name");
    // Equal but for spelling, and keys that are missing or too many.
    let told = |of: &Document| {
        let mut parts =
            json!([of.robot, of.controller, of.gravity, of.reference, of.sampled, of.initial, of.subject]);
        parts[0]["name"] = Value::Null;
        parts
    };
    if found.is_empty() && (told(ours) != told(theirs) || !ours.robot["name"].is_string()) {
        let all = |of: &Document| told(of).to_string();
        found.push(Difference { place: "loop".to_owned(), certificate: all(ours), scenario: all(theirs) });
    }
    found
}

/// Whether what is claimed is not more than what was found.
fn compared(claims: &Claims, tube: SampledTube) -> Checked {
    let Some(rate) = Interval::from_decimal(&claims.rate) else {
        return malformed("claims.rate", "is no number");
    };
    let holds = rate.hi() <= tube.rate;
    if !holds {
        return refuted("rate", format!("{} 1/s are claimed, {} are there", claims.rate, tube.rate));
    }
    for (what, claimed, found) in
        [("error", &claims.error, &tube.error), ("torque", &claims.torque, &tube.torque)]
    {
        for (i, (text, &found)) in claimed.iter().zip(found).enumerate() {
            let Some(bound) = Interval::from_decimal(text) else {
                return malformed(format!("claims.{what}[{i}]"), "is no number");
            };
            let holds = bound.lo() >= found;
            if !holds {
                return refuted(
                    &format!("{what}[{i}]"),
                    format!("at most {text} is claimed, {found} is there"),
                );
            }
        }
    }
    Checked::Holds(Box::new(tube))
}
