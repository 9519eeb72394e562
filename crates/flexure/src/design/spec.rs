//! SPEC files: what a tuned loop shall do.

use std::path::Path;

use toml_edit::{DocumentMut, Item};

use crate::files::bounds;
use crate::files::document::{self, Form, Places};
use crate::files::field::Field;
use crate::files::quantity::{self, Quantity};
use crate::files::source::{self, Source};
use crate::files::table::Table;
use crate::files::{Problem, Problems};

/// What a tuned loop shall do beside following its reference inside the limits of the robot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spec {
    /// The rate at which errors shall decay, proved of the ideal loop; for v-CBC alone.
    pub rate: Option<Rate>,
    /// The rate at which motions near its run shall come closer in every control period, proved of the sampled loop [1/s]; for v-CBC alone.
    pub sampled_rate: Option<f64>,
    /// Shortest and longest delay from the sensors to the torque that the loop shall bear, in s; none for the scenario's own.
    pub delay: Option<[f64; 2]>,
    /// How wrong the model may be.
    pub uncertainty: Uncertainty,
    /// What the loop shall bear beyond that.
    pub margins: AskedMargins,
}

/// A rate to be proved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rate {
    /// At least this [1/s].
    AtLeast(f64),
    /// As large as the other wishes allow.
    Largest,
}

/// Largest parts by which the robot may differ from its model, either way; none where nothing is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Uncertainty {
    /// Of all masses and inertias of the links.
    pub mass: Option<f64>,
    /// Of all springs.
    pub stiffness: Option<f64>,
}

/// Margins of a loop; none where nothing is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AskedMargins {
    /// Delay beyond the longest, in s.
    pub delay: Option<f64>,
    /// Smallest and largest factor on the torque of the motors.
    pub gain: Option<[f64; 2]>,
}

/// A SPEC file: wishes, and what replaces parts of the scenario.
#[derive(Clone, Debug)]
pub struct SpecFile {
    /// The wishes.
    pub spec: Spec,
    /// The file as it is, with the parts that replace those of the scenario.
    pub(super) document: DocumentMut,
    /// Where its keys stand.
    pub(super) places: Option<Places>,
}

const FORM: Form = Form {
    what: "spec file",
    required: &[],
    optional: &[
        "rate",
        "sampled_rate",
        "delay",
        "uncertainty",
        "margins",
        "control_period",
        "reference",
        "accept",
        "imperfection",
    ],
    other: (
        "robot",
        "scenario file",
        "a spec says what a loop shall do; the scenario is the argument before --spec",
    ),
};

const DECAY: Quantity = Quantity::positive("rate at which errors shall decay", crate::units::RATE);
const CLOSER: Quantity =
    Quantity::positive("rate at which motions of the sampled loop shall come closer", crate::units::RATE);
const UNCERTAIN: Quantity =
    Quantity::non_negative("largest part that the model may be off by", crate::units::NONE);
const FACTOR: Quantity = Quantity::positive("factor on the torque", crate::units::NONE);

impl SpecFile {
    /// No wishes but the usual ones.
    pub fn usual() -> Self {
        Self { spec: Spec::default(), document: DocumentMut::new(), places: None }
    }

    /// Reads the file at `path`.
    ///
    /// # Errors
    /// With everything that is wrong, as far as it shows without the scenario.
    pub fn load(path: &Path) -> Result<Self, Problems> {
        let source = source::read(path, bounds::LIMIT)?;
        Self::read(&source)
    }

    /// Reads one from `text`, which is called `name` in messages.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn from_text(name: &str, text: &str) -> Result<Self, Problems> {
        Self::read(&Source::new(name, text))
    }

    fn read(source: &Source) -> Result<Self, Problems> {
        let mut found = None;
        let (spec, _) = document::parse(source, &[], &FORM, |root, places| {
            found = Some(places.clone());
            spec(root)
        })?;
        // What one parser of the format took, the other takes: both are the same.
        let document = source.text.parse().unwrap_or_default();
        let read = Self { spec, document, places: found };
        if read.spec.delay.is_some() && read.has_delay() {
            let message =
                "delay and an [[imperfection]] of the kind \"delay\" both say how late torques come"
                    .to_owned();
            return Err(read.problem("delay", "contradiction", message, "leave one of them out").into());
        }
        Ok(read)
    }
}

impl SpecFile {
    /// Whether one of its imperfections is a delay.
    pub(super) fn has_delay(&self) -> bool {
        let imperfections = self.document.get("imperfection").and_then(Item::as_array_of_tables);
        let is_delay = |entry: &toml_edit::Table| entry.get("kind").and_then(Item::as_str) == Some("delay");
        imperfections.is_some_and(|entries| entries.iter().any(is_delay))
    }

    /// A problem at `key` of the file.
    pub(super) fn problem(
        &self,
        key: &str,
        code: &'static str,
        message: String,
        help: impl Into<String>,
    ) -> Problem {
        match &self.places {
            Some(places) => places.problem(key, code, message, help),
            None => Problem::new(code, message, help),
        }
    }
}

fn spec(root: &Table<'_>) -> Option<Spec> {
    let rate = root.optional("rate", rate);
    let sampled_rate = root.optional("sampled_rate", |field| field.number(&CLOSER));
    let delay = root.optional("delay", delay);
    let uncertainty = root.optional("uncertainty", uncertainty);
    let margins = root.optional("margins", margins);
    Some(Spec {
        rate: rate?,
        sampled_rate: sampled_rate?,
        delay: delay?,
        uncertainty: uncertainty?.unwrap_or_default(),
        margins: margins?.unwrap_or_default(),
    })
}

/// A number, or `"max"`.
fn rate(field: &Field<'_>) -> Option<Rate> {
    if field.is_text() {
        return field.choice(&[("max", Rate::Largest)]);
    }
    field.number(&DECAY).map(Rate::AtLeast)
}

/// One delay, or the shortest and the longest.
fn delay(field: &Field<'_>) -> Option<[f64; 2]> {
    let [shortest, longest] = if field.is_array() {
        field.array(&quantity::DELAY, "shortest, longest")?
    } else {
        [field.number(&quantity::DELAY)?; 2]
    };
    if shortest > longest {
        let message = format!("{} is [{shortest}, {longest}] s, must be [shortest, longest]", field.path);
        field.error("range", message, "delay = [0.0, 0.001], or one number");
        return None;
    }
    Some([shortest, longest])
}

fn uncertainty(field: &Field<'_>) -> Option<Uncertainty> {
    let table = field.table(&["mass", "stiffness"])?;
    let part = |field: &Field<'_>| {
        let part = field.number(&UNCERTAIN)?;
        if part >= 1.0 {
            let message = format!("{} is {part}, must be < 1", field.path);
            field.error("range", message, "0.1 is a tenth either way");
            return None;
        }
        Some(part)
    };
    let (mass, stiffness) = (table.optional("mass", part), table.optional("stiffness", part));
    Some(Uncertainty { mass: mass?, stiffness: stiffness? })
}

fn margins(field: &Field<'_>) -> Option<AskedMargins> {
    let table = field.table(&["delay", "gain"])?;
    let delay = table.optional("delay", |field| field.number(&quantity::DELAY));
    let gain = table.optional("gain", |field| {
        let [low, high] = field.array(&FACTOR, "smallest, largest")?;
        if low > 1.0 || high < 1.0 {
            let message = format!("{} is [{low}, {high}], must have 1 inside", field.path);
            field.error("range", message, "gain = [0.8, 1.25]: a fifth less and a quarter more torque");
            return None;
        }
        Some([low, high])
    });
    Some(AskedMargins { delay: delay?, gain: gain? })
}
