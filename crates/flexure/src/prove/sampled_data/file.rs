//! The file of a tube: what it is about, what is claimed, and every section; `docs/tube.md` states what each number means.

use flexure_core::scalar::Interval;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::files::Problems;
use crate::prove::documents::{self, ROOM, TUBE, Told, lower, packed, text};
use crate::prove::engine::number::Number;
use crate::prove::engine::sampled_data::section::Section;
use crate::prove::engine::sampled_data::watch::Passes;
use crate::prove::sampled_data::spoken_of::{passes, sensors};
use crate::prove::sampled_data::{SampledTube, late};
use crate::scenario::Scenario;

/// All of a file.
pub(super) type Document = documents::Document<Own>;

/// What it says beside what all files tell.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Own {
    #[serde(rename = "loop")]
    pub sampled: Value,
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
        document.own.asked = AskedTexts {
            extents: self.asked.extents.iter().map(|&x| restored(x)).collect(),
            rate: restored(self.asked.rate),
        };
        let above = |all: &[f64]| all.iter().map(|&x| text(Number::above(x * (1.0 + ROOM)))).collect();
        document.own.claims = Claims {
            rate: text(Number::below(self.rate * (1.0 - ROOM))),
            error: above(&self.error),
            torque: above(&self.torque),
        };
        document.own.kept = self.sections.iter().map(|section| section.past.columns()).collect();
        let section = |section: &Section| packed(section.center.iter().copied().chain(lower(&section.lower)));
        Ok(document.with_lines(self.sections.iter().map(section)))
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

/// What a file says of the loop of `scenario`, without a tube.
pub(super) fn about(scenario: &Scenario) -> Result<Document, Problems> {
    let (sensors, late) = (sensors(scenario), late(scenario));
    let filter = sensors.filter.map(|filter| {
        let both = |of: [Interval; 2]| of.map(|x| exact(x.midpoint()));
        json!({ "feedback": both(filter.feedback), "forward": both(filter.forward) })
    });
    let own = Own {
        sampled: json!({
            "control_period": Number::read(scenario.control_period, scenario.bounds(scenario.control_period)),
            "waiting": late.waiting,
            "offset": late.offset.map(Number::computed),
            // From below: the float that is proved about is above its shortest decimal.
            "off": sensors.off.iter().map(|&off| Number::decimal(off.next_down())).collect::<Vec<_>>(),
            "filter": filter,
            "limits": limits(&passes(scenario)),
        }),
        asked: AskedTexts::default(),
        periods: scenario.periods() as usize,
        claims: Claims { rate: String::new(), error: Vec::new(), torque: Vec::new() },
        kept: Vec::new(),
        sections: Vec::new(),
    };
    Ok(Document { told: Told::of(TUBE, scenario)?, own })
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
