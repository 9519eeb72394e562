//! The file of a tube: what it is about, what is claimed, and every section; `docs/tube.md` states what each number means.

use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use flexure_core::scalar::Interval;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::files::{self, Problem, Problems};
use crate::prove::decimals;
use crate::prove::engine::certificate::{CertifiedPhi, DecimalLaw};
use crate::prove::engine::number::Number;
use crate::prove::engine::sampled_data::section::Section;
use crate::prove::engine::sampled_data::watch::Passes;
use crate::prove::sampled_data::spoken_of::{passes, sensors};
use crate::prove::sampled_data::{SampledTube, late};
use crate::prove::subject::subject;
use crate::references::{Reference, Term};
use crate::robot::Links;
use crate::scenario::Scenario;

/// What the file says that it is.
pub const FORMAT: &str = "flexure-sampled-tube";

/// Version of the format.
pub(super) const VERSION: u32 = 1;

/// Claims are weaker than what was found by this part, so that checkers with bounds a little wider find them, too.
const ROOM: f64 = 1e-4;

/// All of a file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Document {
    pub format: String,
    pub version: u32,
    pub name: String,
    pub made_by: String,
    pub subject: Value,
    pub robot: Value,
    pub controller: Value,
    pub gravity: Value,
    pub reference: Value,
    #[serde(rename = "loop")]
    pub sampled: Value,
    pub initial: Value,
    pub asked: AskedTexts,
    pub periods: usize,
    pub claims: Claims,
    pub kept: Vec<usize>,
    pub sections: Vec<String>,
}

/// What a search was for, in decimals.
#[derive(Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AskedTexts {
    pub extents: Vec<String>,
    pub rate: String,
}

/// What is claimed of the sections, in decimals.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Claims {
    pub rate: String,
    pub error: Vec<String>,
    pub torque: Vec<String>,
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
        let above = |all: &[f64]| all.iter().map(|&x| text(Number::above(x * (1.0 + ROOM)))).collect();
        document.claims = Claims {
            rate: text(Number::below(self.rate * (1.0 - ROOM))),
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

/// Where the file of a tube is: NAME.tube.json beside NAME.certificate.json.
pub fn beside(certificate: &Path) -> PathBuf {
    let name = certificate.file_name().unwrap_or_default().to_string_lossy();
    let name = name.strip_suffix(".json").unwrap_or(&name);
    certificate.with_file_name(format!("{}.tube.json", name.strip_suffix(".certificate").unwrap_or(name)))
}

/// Whether the file at `path` begins as one of a tube.
pub fn is_tube(path: &Path) -> bool {
    // What is in a pipe can be read once.
    if !path.is_file() {
        return false;
    }
    let mut begin = Vec::new();
    let read = File::open(path).and_then(|file| file.take(64).read_to_end(&mut begin));
    read.is_ok() && begin.windows(FORMAT.len()).any(|part| part == FORMAT.as_bytes())
}

/// That the file of a tube may be written at `path`.
///
/// # Errors
/// As [`spare`](files::spare).
pub fn spare(path: &Path) -> Result<(), Problem> {
    // Not by its text, which may be long.
    if is_tube(path) { Ok(()) } else { files::spare(path, "tube", |_| false, &[]) }
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
pub(super) fn about(scenario: &Scenario) -> Result<Document, Problems> {
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
    let is_horizontal = matches!(robot.links, Links::PlanarTwoLink(_));
    let gravity = robot.gravity.map(|x| Number::read(x, robot.bounds(x)));
    Ok(Document {
        format: FORMAT.to_owned(),
        version: VERSION,
        name: scenario.name.clone(),
        made_by: format!("flexure {}", env!("CARGO_PKG_VERSION")),
        subject: json!(subject(scenario)),
        robot: json!(decimals::robot(robot)),
        controller: json!(law),
        gravity: if is_horizontal { Value::Null } else { json!(gravity) },
        reference: json!(reference(scenario)),
        sampled: json!({
            "control_period": Number::read(scenario.control_period, scenario.bounds(scenario.control_period)),
            "waiting": late.waiting,
            "offset": late.offset.map(Number::computed),
            // From below: the float that is proved about is above its shortest decimal.
            "off": sensors.off.iter().map(|&off| Number::decimal(off.next_down())).collect::<Vec<_>>(),
            "filter": filter,
            "limits": limits(&passes(scenario)),
        }),
        initial: json!(initial.concat()),
        asked: AskedTexts::default(),
        periods: scenario.periods() as usize,
        claims: Claims { rate: String::new(), error: Vec::new(), torque: Vec::new() },
        kept: Vec::new(),
        sections: Vec::new(),
    })
}

/// What guard and drives do nothing about, null where all passes.
fn limits(passes: &Passes) -> Value {
    let numbers =
        |all: &[f64]| all.iter().map(|&x| x.is_finite().then(|| Number::decimal(x))).collect::<Vec<_>>();
    let readings = passes.readings.as_ref().map(|believed| {
        json!({
            "lowest": numbers(&believed.position[0]),
            "highest": numbers(&believed.position[1]),
            "speed": numbers(&believed.speed),
            "deflection": numbers(&believed.deflection),
            "jump": numbers(&believed.jump),
            "travel": Number::decimal(believed.travel),
        })
    });
    json!({ "torque": numbers(&passes.torque), "torque_step": numbers(&passes.torque_step), "readings": readings })
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

/// A section as the file has it, without P.
fn written(section: &Section) -> String {
    let lower = section.lower.rows().enumerate().flat_map(|(i, row)| &row[..=i]);
    let all = section.center.iter().chain(lower);
    BASE64.encode(all.flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>())
}
