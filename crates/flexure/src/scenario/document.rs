//! Scenario files.

use std::path::Path;

use flexure_core::scalar::Interval;

use crate::estimators::{DisturbanceObserver, Estimator, document as estimator};
use crate::files::base::Base;
use crate::files::change::Change;
use crate::files::decimals::Decimals;
use crate::files::document::{self, Form};
use crate::files::field::Field;
use crate::files::normal::Normal;
use crate::files::source::Source;
use crate::files::table::Table;
use crate::files::{Assumption, Outside, Places, Problem, Problems, provenance, quantity};
use crate::imperfections::document::Context;
use crate::imperfections::{Imperfection, Kind as _, Saturation, document as imperfection};
use crate::laws::{self, Controller, VcbcGains, document as controller};
use crate::references::document::Timed;
use crate::references::{Reference, SmoothStart, TimeScaling, document as reference};
use crate::robot::{self, Robot, links};
use crate::scenario::accept::{self, Accept};
use crate::scenario::agreement;
use crate::scenario::guard::{self, GuardSettings};
use crate::scenario::initial::{self, Initial, Rest};
use crate::scenario::integration::{self, Integration};
use crate::scenario::plant::{self, Plant};

/// Farthest that a reference without smooth start may be from the robot at t = 0 \[rad\].
const FAR: f64 = 0.5;

/// Most control periods in a run: a trace that is held, as in Python, keeps every one of them in memory.
const MOST_PERIODS: f64 = 5e6;

/// Largest part of a control period that a run may be longer or shorter than whole ones without a word.
const UNEVEN: f64 = 1e-6;

/// One closed loop, as data.
///
/// ```
/// let mut scenario = flexure::Scenario::load("pendulum-tanh")?;
/// scenario.duration = 0.1; // s
/// let run = scenario.simulate()?;
/// assert_eq!(run.trace.len(), 101); // one instant a millisecond, both ends included
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Scenario {
    /// The file's name without folder and ending.
    pub name: String,
    /// The robot as the law knows it.
    pub robot: Robot,
    /// Length of the run \[s\].
    pub duration: f64,
    /// Time between two evaluations of the law \[s\].
    pub control_period: f64,
    /// What the torque does between them.
    pub hold: Hold,
    /// How the motion of smooth plants is computed.
    pub integration: Integration,
    /// State at t = 0.
    pub initial: Initial,
    /// Positions of the links over time that the law shall follow \[rad\].
    pub reference: Reference,
    /// Another clock for the reference, if it has one.
    pub time_scaling: Option<TimeScaling>,
    /// How the robot joins the reference from where it is and how it moves at t = 0, if it does.
    pub smooth_start: Option<SmoothStart>,
    /// What the simulated robot has that the law does not know.
    pub plant: Plant,
    /// The law with its gains.
    pub controller: Controller,
    /// What sensors, actuators and mechanics do that the ideal loop does not, in the order of the file.
    pub imperfections: Vec<Imperfection>,
    /// Where the motion that the law sees comes from, if not from its sensors alone.
    pub estimator: Option<Estimator>,
    /// What estimates unknown torques, if anything.
    pub disturbance_observer: Option<DisturbanceObserver>,
    /// What the controller refuses to do.
    pub guard: Option<GuardSettings>,
    /// What a run is held to, as far as the file says so.
    pub accept: Accept,
    /// Seed of all random numbers: the same seed gives the same run, bit for bit.
    pub seed: u64,
    /// Numbers that no source vouches for: the robot's, then those of the scenario.
    pub assumptions: Vec<Assumption>,
    /// What is suspicious in the robot's file and in this one.
    pub warnings: Vec<Problem>,
    /// Line and column of each key of the file, for messages.
    pub places: Places,
    decimals: Decimals,
    /// SHA-256 of what the file says, without its robot, in hexadecimal.
    pub(crate) digest: String,
}

impl Scenario {
    /// Encloses the decimal that `x`, a number of the scenario file or of its robot's files, was read from: 0.1 as a tenth,
    /// what is a float as a point. The samples of a path are taken as floats instead: see
    /// [`AnyReference`](crate::references::AnyReference).
    pub fn bounds(&self, x: f64) -> Interval {
        self.decimals.and(self.robot.decimals).enclose(x)
    }

    /// Number of control periods in the run.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [1, 1e9]")]
    pub fn periods(&self) -> u32 {
        (self.duration / self.control_period).round().clamp(1.0, 1e9) as u32
    }

    /// What is between this loop and the ideal one, in words: options of the plant, kinds of imperfections, `observer`,
    /// `disturbance observer`, `guard`; and that the limits of the robot's torques do not act, if it has some.
    pub fn conditions(&self) -> Vec<&'static str> {
        let mut conditions = self.plant.options();
        if self.plant.unlimited && self.robot.limits.torque.iter().any(|limit| limit.is_finite()) {
            conditions.push("torque limits off");
        }
        conditions.extend(self.between());
        conditions
    }

    /// What the loop has that the ideal one has not, the law on true states with its torque on the motors at once, in the same
    /// words: what certificates leave out.
    pub fn beyond_ideal(&self) -> Vec<&'static str> {
        let between = self.between();
        let limits = self.drive_limits().filter(|_| !between.contains(&Saturation::NAME));
        // The errors of the law have derivatives of the reference up to the third in them.
        let jumps = self.reference.jump().filter(|jump| jump.derivative <= 3);
        let options = self.plant.options().into_iter().chain(limits.map(|_| "torque limits"));
        options.chain(jumps.map(|_| "jumps of the reference")).chain(between).collect()
    }

    /// What stands between motion and torque.
    fn between(&self) -> Vec<&'static str> {
        let mut kinds: Vec<_> = self.imperfections.iter().map(Imperfection::kind).collect();
        kinds.dedup();
        let parts = [
            (self.estimator.is_some(), "observer"),
            (self.disturbance_observer.is_some(), "disturbance observer"),
            (self.guard.is_some(), "guard"),
        ];
        kinds.extend(parts.iter().filter(|(is_there, _)| *is_there).map(|(_, name)| name));
        kinds
    }

    /// Largest torques that the drives give, in the order of the joints, infinite where there is no limit [N m]: those of a
    /// `saturation`, or else the robot's. None where neither acts: switched off by `[plant]`, or in continuous time, which has
    /// no drives.
    pub fn drive_limits(&self) -> Option<Vec<f64>> {
        let explicit = self.imperfections.iter().find_map(|imperfection| imperfection.of::<Saturation>());
        if let Some(saturation) = explicit {
            return Some(saturation.limit.clone());
        }
        let limits = &self.robot.limits.torque;
        let act = !self.plant.unlimited && self.hold == Hold::ZeroOrder;
        (act && limits.iter().any(|limit| limit.is_finite())).then(|| limits.clone())
    }

    /// The same loop under another law.
    #[must_use]
    pub fn under(&self, controller: &Controller) -> Self {
        Self { controller: controller.clone(), ..self.clone() }
    }

    /// Whether the simulated robot is not smooth: dry friction, play or hysteresis.
    pub fn is_rough(&self) -> bool {
        self.imperfections.iter().any(Imperfection::is_rough)
    }

    /// The same by collocation to the default tolerance, if it asks for midpoint steps, whose errors nobody estimates: for what decides by its runs.
    #[must_use]
    pub fn by_collocation(&self) -> Self {
        let integration = match self.integration {
            Integration::Midpoint => Integration::default(),
            collocation @ Integration::Collocation { .. } => collocation,
        };
        Self { integration, ..self.clone() }
    }

    /// Whether the file leaves the gains to the [starting rule](Controller::default_for): it has none.
    pub fn has_starting_gains(&self) -> bool {
        let gains = self.controller.gains();
        gains.iter().all(|(key, _)| !self.places.has(&format!("controller.{key}")))
    }

    /// The gains of its v-CBC law: what certificates are about.
    ///
    /// # Errors
    /// If its controller is another one.
    pub fn vcbc(&self) -> Result<&VcbcGains, Problem> {
        match &self.controller {
            Controller::Vcbc(gains) => Ok(gains.as_ref()),
            other => {
                let message = format!("controller.kind is '{}': certificates are for 'vcbc'", other.kind());
                let help = "other laws have no certificates; docs/controllers.md says what is proved of each, and `flexure run` simulates them";
                Err(self.places.problem("controller.kind", "unsupported", message, help))
            }
        }
    }
}

/// What the torque does between two evaluations of the law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Hold {
    /// It keeps its value, as on a digital controller.
    #[default]
    ZeroOrder,
    /// The law is evaluated at every stage of the integration: continuous time, as in the theory.
    Continuous,
}

/// Reads a scenario from `text`; `name` stands for the file in messages, relative paths in it start from `folder`
/// and stay there or below.
///
/// # Errors
/// With everything that is wrong, in the robot's file as well.
pub fn scenario_from_text(name: &str, text: &str, folder: &Path) -> Result<Scenario, Problems> {
    read(&Source::new(name, text), &Base::Folder(folder.to_owned(), Outside::Refused), &[])
}

const FORM: Form = Form {
    what: "scenario file",
    required: &["robot", "duration", "control_period", "reference", "controller"],
    optional: &[
        "hold",
        "integration",
        "integration_tolerance",
        "initial",
        "plant",
        "sources",
        "imperfection",
        "estimator",
        "disturbance_observer",
        "guard",
        "accept",
        "seed",
    ],
    other: (
        "links",
        "robot file",
        "write a scenario with robot = \"path of this file\"; `flexure list` shows examples",
    ),
};

/// Reads `source`, after `changes` of it and of the file of its robot.
pub(crate) fn read(source: &Source, base: &Base, changes: &[Change]) -> Result<Scenario, Problems> {
    let of_robot: Vec<_> = changes.iter().filter_map(Change::of_robot).collect();
    let own: Vec<_> = changes.iter().filter(|change| change.of_robot().is_none()).cloned().collect();
    let (mut scenario, warnings) =
        document::parse(source, &own, &FORM, |root, places| scenario(root, places, base, &of_robot))?;
    scenario.warnings.extend(warnings);
    Ok(scenario)
}

fn scenario(root: &Table<'_>, places: &Places, base: &Base, of_robot: &[Change]) -> Option<Scenario> {
    let robot = root.required("robot", "path of a robot file or name of a built-in robot");
    let robot = robot.and_then(|field| read_robot(&field, base, of_robot));
    let joints = links::per_joint(
        robot.as_ref().map_or("the robot", |robot| &robot.name),
        robot.as_ref().map(Robot::joint_count),
    );
    let times = times(root);
    let hold = root.optional("hold", |field| {
        field.choice(&[("zero-order", Hold::ZeroOrder), ("continuous", Hold::Continuous)])
    });
    let hold = hold.map(Option::unwrap_or_default);
    let integration = integration::read(root);
    let mut assumed = robot.as_ref().map(Robot::assumptions).unwrap_or_default();
    let reference_field = root.required("reference", "a table with the kind");
    let end = times.map_or(f64::NAN, |(duration, _)| duration);
    let timed = reference_field.as_ref().and_then(|field| reference::read(field, &joints, base, end));
    let controller = root.required("controller", "a table with the kind");
    let controller = controller.and_then(|field| controller::read(&field, &joints, robot.as_ref()));
    if let (Some(controller), Some(hold), Some(field)) = (&controller, hold, root.get("hold"))
        && let Some((message, help)) = agreement::against_hold(controller, hold)
    {
        field.error("contradiction", message, help);
    }
    let plant = plant::read(root, &joints, robot.as_ref());
    let context = Context { joints: &joints, robot: robot.as_ref(), times, base };
    let real = real_loop(root, &context, hold, plant.as_ref(), controller.as_ref());
    let imperfections = real.as_ref().map(|real| &*real.imperfections);
    let rest = Rest::of(robot.as_ref(), plant.as_ref(), imperfections, timed.as_ref());
    let initial = initial::read(root, &joints, places, rest.as_ref(), &mut assumed);
    let accept = accept::read(root, &joints, times);
    let own = provenance::assumptions(root, places);
    if let (Some(field), Some(timed), Some(initial)) = (reference_field, &timed, &initial)
        && timed.smooth_start.is_none()
    {
        check_start(&field, robot.as_ref(), &timed.reference, initial);
    }
    assumed.extend(own?);
    let ((duration, control_period), real, robot) = (times?, real?, robot?);
    let Timed { reference, smooth_start, time_scaling } = timed?;
    Some(Scenario {
        name: stem(places.file()),
        warnings: robot.warnings.clone(),
        robot,
        duration,
        control_period,
        hold: hold?,
        integration: integration?,
        initial: initial?,
        reference,
        time_scaling,
        smooth_start,
        plant: plant?,
        controller: controller?,
        imperfections: real.imperfections,
        estimator: real.estimator,
        disturbance_observer: real.disturbance_observer,
        guard: real.guard,
        accept: accept?,
        seed: real.seed,
        assumptions: assumed,
        places: places.clone(),
        decimals: root.decimals(),
        digest: normal(root).digest(),
    })
}

/// What a scenario file says of the loop: the robot is told apart, free texts are left out, and what is said anyway.
fn normal(root: &Table<'_>) -> Normal {
    let normal = integration::normal(root.normal().without(&["robot", "sources"]));
    normal
        .without_default("hold", &Normal::Text("zero-order".to_owned()))
        .without_default("seed", &Normal::number(0.0))
}

fn stem(file: &str) -> String {
    Path::new(file).file_stem().map_or_else(|| file.to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// Duration and control period.
fn times(root: &Table<'_>) -> Option<(f64, f64)> {
    let duration = root.number("duration", &quantity::DURATION);
    let period = root.number("control_period", &quantity::PERIOD);
    let (duration, period) = (duration?, period?);
    let field = root.get("control_period")?;
    if period > duration {
        let message = format!("control_period is {period} s, must be <= duration, {duration} s");
        field.error("range", message, "a usual one is 0.001 s");
        return None;
    }
    if duration / period > MOST_PERIODS {
        let message =
            format!("{:.4e} control periods in {duration} s, must be <= {MOST_PERIODS:e}", duration / period);
        let hint = format!(
            "with this period a run may take {} s, with this duration the period may be {} s",
            quantity::shortest(period * MOST_PERIODS),
            quantity::shortest(duration / MOST_PERIODS)
        );
        field.error("range", message, hint);
        return None;
    }
    let periods = (duration / period).round();
    if (duration / period - periods).abs() > UNEVEN {
        let message = format!("duration is {duration} s, is no multiple of control_period, {period} s");
        // Without the noise of the product.
        let whole = (1e9 * periods * period).round() / 1e9;
        let hint = format!("the run takes {periods} periods, {} s", quantity::shortest(whole));
        root.get("duration")?.warn("uneven", message, hint);
    }
    Some((duration, period))
}

/// The robot named or pointed at; problems with its file go to the scenario's log.
fn read_robot(field: &Field<'_>, base: &Base, changes: &[Change]) -> Option<Robot> {
    let name = field.text()?;
    field.absorb(robot::robot(name, base, changes))
}

/// What makes a loop a real one.
struct RealLoop {
    imperfections: Vec<Imperfection>,
    estimator: Option<Estimator>,
    disturbance_observer: Option<DisturbanceObserver>,
    guard: Option<GuardSettings>,
    seed: u64,
}

/// Reads imperfections and what the controller does about them.
fn real_loop(
    root: &Table<'_>,
    context: &Context<'_>,
    hold: Option<Hold>,
    plant: Option<&Plant>,
    controller: Option<&Controller>,
) -> Option<RealLoop> {
    let found = imperfection::read(root, context);
    let estimator = estimator::read(root, context.joints);
    let disturbance_observer = estimator::read_disturbance_observer(root, context.joints);
    let guard = guard::read(root, context);
    // What fits into the integers of the file format.
    let most = i64::MAX.unsigned_abs();
    let seed = root.optional("seed", |field| field.whole("seed of all random numbers", 0, most));
    let (found, estimator, disturbance_observer, guard) = (found?, estimator?, disturbance_observer?, guard?);
    let law_reads = controller.and_then(|controller| laws::about(controller.kind())).map(|about| about.reads);
    let reads_velocities = law_reads.is_none_or(|reads| reads.v_l || reads.v_m);
    agreement::agree(&agreement::Loop {
        reads_velocities: reads_velocities || disturbance_observer.is_some() || guard.is_some(),
        root,
        context,
        found: &found,
        hold: hold?,
        plant: plant?,
        estimator: estimator.as_ref(),
        guard: guard.as_ref(),
    });
    Some(RealLoop {
        imperfections: found.into_iter().map(|found| found.what).collect(),
        estimator,
        disturbance_observer,
        guard,
        seed: seed?.unwrap_or(0),
    })
}

/// Notes an error if the reference starts far from the robot.
fn check_start(field: &Field<'_>, robot: Option<&Robot>, reference: &Reference, initial: &Initial) {
    let start = reference.initial();
    let far = start.iter().zip(&initial.q_l).enumerate().find(|(_, (q_d, q))| (*q_d - *q).abs() > FAR);
    if let Some((i, (q_d, q))) = far {
        let distance = (q_d - q).abs();
        let name =
            robot.and_then(|robot| robot.joints.get(i)).map_or_else(String::new, |joint| joint.name.clone());
        let message = format!(
            "the reference of {name} starts at {q_d} rad and the robot at {q} rad: {distance:.3} rad apart, must be <= {FAR} rad"
        );
        field.error(
            "far",
            message,
            "add [reference.smooth_start] with duration = 2.0, or initial = \"at rest\", which is where the reference starts",
        );
    }
}
