//! A run beside the file of a tube: how far out it is, and whether what is proved can hold of it.

use std::ops::ControlFlow;

use flexure_core::scalar::Interval;
use serde::Serialize;

use crate::files::Problems;
use crate::files::number::short;
use crate::prove::closed_loop::along_reference;
use crate::prove::engine::sampled_data::period::HeldLoop;
use crate::prove::engine::sampled_data::section::Section;
use crate::prove::sampled_data::check::{differences, document, given};
use crate::prove::sampled_data::file::about;
use crate::prove::sampled_data::spoken_of::{passes, sensors, suitable_when_sampled};
use crate::prove::sampled_data::{Late, late, start};
use crate::prove::subject::Difference;
use crate::scenario::Scenario;
use crate::simulate::{Signal, Sink};
use crate::units;
use crate::verify::Rejected;

/// The column of how far out a run is.
const COLUMN: &str = "tube";

/// The column of whether what is proved can hold.
const CERTIFICATE: &str = "certificate";

/// A tube that a run is watched beside.
#[derive(Clone, Debug)]
pub struct Beside {
    sections: Vec<Section>,
    /// Claimed errors of positions in rad, where readings are off: the file does not say how far out a motion is then.
    error: Option<Vec<f64>>,
    period: f64,
    /// Columns of the motion.
    motion: Vec<usize>,
    certificate: Option<usize>,
    stopped: Option<usize>,
    /// As many as the run has without those of the tube.
    columns: usize,
    row: Vec<f64>,
    holds: bool,
    instants: usize,
    certified: usize,
    found: InTube,
}

/// Where a run was.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InTube {
    /// Why nothing that the file claims is about this run, if so: another loop, or a start outside.
    pub void: Option<String>,
    /// How far out it was at most: 1 is the surface, or where readings are off a position's claimed error.
    pub farthest: f64,
    /// Whether readings are off, so that only claimed errors are known.
    #[serde(skip)]
    of_errors: bool,
    /// When it was outside first, or the tube had ended, in s.
    pub left: Option<f64>,
    /// Whether that is because the tube had ended.
    pub ended: bool,
    /// Part of the control instants at which what is claimed can hold.
    pub certified_fraction: f64,
}

impl Beside {
    /// Of the file whose text is `text`, for runs of `scenario`. The file is taken at its word: [`check`](super::check::check) follows it. It may be of
    /// the same loop from another start.
    ///
    /// # Errors
    /// As [`Scenario::open`], and if the law has no tubes.
    pub fn new(text: &str, scenario: &Scenario) -> Result<Result<Self, Rejected>, Problems> {
        let document = match document(text) {
            Ok(document) => document,
            Err(rejected) => return Ok(Err(rejected)),
        };
        let mut differences = differences(&document, &about(scenario)?);
        // Files that differ in where the run starts and ends have other hashes. A smooth start goes by where it starts.
        let is_known = !document.told.reference.is_null();
        let may_start_elsewhere = is_known && scenario.smooth_start.is_none();
        differences.retain(|found| {
            let place = found.place.as_str();
            let is_of_the_run = place == "periods" || may_start_elsewhere && place.starts_with("initial");
            !(is_of_the_run || is_known && place.starts_with("subject"))
        });
        let given = match given(&document, scenario) {
            Ok(given) => given,
            Err(rejected) if differences.is_empty() => return Ok(Err(rejected)),
            Err(_) => return Ok(Ok(Self::void(&differences_in_words(&differences), scenario)?)),
        };
        let void = match suitable_when_sampled(scenario) {
            Err(problems) => problems.iter().next().map(ToString::to_string),
            Ok(()) if !differences.is_empty() => Some(differences_in_words(&differences)),
            Ok(()) if starts_inside(scenario, &given.sections[0])? => None,
            Ok(()) => Some("the run does not start in the tube".to_owned()),
        };
        let upper = |text: &String| Interval::from_decimal(text).map_or(f64::NAN, Interval::hi);
        let is_off = !sensors(scenario).off.is_empty();
        let error = is_off.then(|| document.own.claims.error.iter().map(upper).collect());
        Ok(Ok(Self::watching(given.sections, error, void, scenario)?))
    }

    /// One that says nothing, and why.
    fn void(why: &str, scenario: &Scenario) -> Result<Self, Problems> {
        Self::watching(Vec::new(), None, Some(why.to_owned()), scenario)
    }

    fn watching(
        sections: Vec<Section>,
        error: Option<Vec<f64>>,
        void: Option<String>,
        scenario: &Scenario,
    ) -> Result<Self, Problems> {
        let (signals, of_errors) = (scenario.signals()?, error.is_some());
        let column = |name: &str| signals.iter().position(|signal| signal.name == name);
        let joints = 1..=scenario.robot.joint_count();
        let motion = ["q_l", "q_m", "dq_l", "dq_m"]
            .iter()
            .flat_map(|name| joints.clone().map(move |k| format!("{name}{k}")))
            .filter_map(|name| column(&name))
            .collect();
        Ok(Self {
            sections,
            error,
            period: scenario.control_period,
            motion,
            certificate: column(CERTIFICATE),
            stopped: column("stopped"),
            columns: signals.len(),
            row: Vec::new(),
            holds: void.is_none(),
            instants: 0,
            certified: 0,
            found: InTube {
                void,
                of_errors,
                farthest: 0.0,
                left: None,
                ended: false,
                certified_fraction: 0.0,
            },
        })
    }

    /// The columns of a run that has `signals` by itself: `certificate`, which says whether what is proved of the tube can hold, and `tube`, how far out
    /// the run is.
    pub fn signals(&self, mut signals: Vec<Signal>) -> Vec<Signal> {
        let signal = |name: &str| Signal { name: name.to_owned(), unit: units::NONE.plain };
        if self.certificate.is_none() {
            signals.push(signal(CERTIFICATE));
        }
        signals.push(signal(COLUMN));
        signals
    }

    /// What takes rows of the run and gives them on, with these columns, to `to`.
    pub fn before<'a>(&'a mut self, to: &'a mut dyn Sink) -> Widened<'a> {
        Widened { beside: self, to }
    }

    /// Where the run was, as far as it went.
    pub fn found(&self) -> InTube {
        let certified_fraction = self.certified as f64 / self.instants.max(1) as f64;
        InTube { certified_fraction, ..self.found.clone() }
    }

    /// How far out the motion of `row` is at the next instant: the least |y| of the tube's states with this motion, or where readings are off the
    /// largest part of a claimed error. Not a number after the end.
    fn out(&self, row: &[f64]) -> f64 {
        let Some(section) = self.sections.get(self.instants) else { return f64::NAN };
        let motion: Vec<f64> = self.motion.iter().map(|&column| row[column]).collect();
        match &self.error {
            None => section.distance(&motion),
            Some(error) => {
                let off = motion.iter().zip(&section.center).zip(error);
                off.map(|((x, c), error)| (x - c).abs() / error).fold(0.0, f64::max)
            }
        }
    }

    /// Fills `row` with that of the run and the columns of the tube.
    fn widen(&mut self, row: &[f64]) {
        let out = self.out(row);
        let is_inside = out <= 1.0;
        if !is_inside && self.found.left.is_none() {
            self.found.left = Some(self.instants as f64 * self.period);
            self.found.ended = self.instants >= self.sections.len();
        }
        self.found.farthest = self.found.farthest.max(out);
        let is_stopped = self.stopped.is_some_and(|column| row[column] > 0.0);
        // What has left the tube is not known to be in it again: filters and torques on their way are not looked at.
        self.holds &= is_inside && !is_stopped;
        self.certified += usize::from(self.holds);
        self.instants += 1;
        self.row.clear();
        self.row.extend_from_slice(&row[..self.columns]);
        let holds = f64::from(u8::from(self.holds));
        match self.certificate {
            Some(column) => self.row[column] = holds,
            None => self.row.push(holds),
        }
        self.row.push(out);
    }
}

/// What gives rows on with the columns of a tube.
pub struct Widened<'a> {
    beside: &'a mut Beside,
    to: &'a mut dyn Sink,
}

impl Sink for Widened<'_> {
    fn take(&mut self, row: &[f64]) -> ControlFlow<()> {
        self.beside.widen(row);
        self.to.take(&self.beside.row)
    }
}

impl InTube {
    /// In words, after the name of the tube.
    pub fn words(&self) -> String {
        match (&self.void, self.left) {
            (Some(why), _) => format!("says nothing of this run: {why}"),
            (None, None) => format!(
                "holds the run at every control instant, {} % of {} at most; its file is taken at its word: `flexure verify` follows it",
                short(100.0 * self.farthest, 3),
                if self.of_errors {
                    "the errors of positions that its file claims"
                } else {
                    "the way to its surface"
                }
            ),
            (None, Some(left)) if self.ended => {
                format!("ends before t = {} s, and the run does not", short(left, 5))
            }
            (None, Some(left)) => format!("has the run outside of it from t = {} s on", short(left, 5)),
        }
    }
}

fn differences_in_words(differences: &[Difference]) -> String {
    if differences.first().is_some_and(|first| first.place.starts_with("subject")) {
        return "its file does not tell a reference of this form, and is of scenario files that say something else".to_owned();
    }
    differences.first().map_or_else(String::new, |first| {
        format!("{} is {} in the file and {} in the scenario", first.place, first.certificate, first.scenario)
    })
}

/// Whether the run of `scenario` starts in `first`, with all that filters and torques on their way begin with.
fn starts_inside(scenario: &Scenario, first: &Section) -> Result<bool, Problems> {
    let system = along_reference(scenario)?;
    let (sensors, passes) = (sensors(scenario), passes(scenario));
    let Late { waiting, offset, .. } = late(scenario);
    let period = scenario.bounds(scenario.control_period);
    let of = HeldLoop { system: &*system, sensors: &sensors, period, waiting, offset, passes: &passes };
    Ok(first.reach(&of.started(&start(scenario))) <= 1.0)
}
