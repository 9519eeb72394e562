//! What a number in a file stands for: its unit, its allowed range, and what would be plausible.

use crate::files::diagnostic::Problem;
use crate::units::{self, Unit};

/// Largest magnitude of any number; together with its reciprocal it keeps every product of a few numbers finite.
const LARGEST: f64 = 1e30;

/// Its reciprocal.
const TINY: f64 = 1e-30;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Sign {
    Any,
    Positive,
    NonNegative,
    NonZero,
    AtLeastOne,
    Probability,
}

/// A kind of number in a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quantity {
    /// Name of the quantity in hints.
    pub what: &'static str,
    /// Unit in messages.
    unit: Unit,
    sign: Sign,
    /// Magnitudes of nonzero numbers that raise no doubt, and the doubt.
    plausible: (f64, f64, &'static str),
}

impl Quantity {
    pub const fn any(what: &'static str, unit: Unit) -> Self {
        Self { what, unit, sign: Sign::Any, plausible: (TINY, LARGEST, "") }
    }
    pub const fn positive(what: &'static str, unit: Unit) -> Self {
        Self { sign: Sign::Positive, ..Self::any(what, unit) }
    }
    pub const fn non_negative(what: &'static str, unit: Unit) -> Self {
        Self { sign: Sign::NonNegative, ..Self::any(what, unit) }
    }
    const fn nonzero(what: &'static str, unit: Unit) -> Self {
        Self { sign: Sign::NonZero, ..Self::any(what, unit) }
    }
    pub const fn at_least_one(what: &'static str, unit: Unit) -> Self {
        Self { sign: Sign::AtLeastOne, ..Self::any(what, unit) }
    }
    const fn probability(what: &'static str) -> Self {
        Self { sign: Sign::Probability, ..Self::any(what, units::NONE) }
    }
    const fn plausible(self, low: f64, high: f64, doubt: &'static str) -> Self {
        Self { plausible: (low, high, doubt), ..self }
    }

    /// What and in which unit, for hints.
    pub fn described(&self) -> String {
        let unit = self.unit.plain;
        if unit.is_empty() { self.what.to_owned() } else { format!("{} in {unit}", self.what) }
    }

    /// How often 1/s is in the unit: [`Unit::per_second`].
    pub fn per_second(&self) -> i32 {
        self.unit.per_second
    }

    /// What speaks against the number `x` called `name`, if anything; a warning if it can be used all the same.
    pub fn objection(&self, name: &str, x: f64) -> Option<Problem> {
        let (low, high, doubt) = self.plausible;
        let unit = if self.unit.plain.is_empty() { String::new() } else { format!(" {}", self.unit.plain) };
        let problem = |code, objection: &str, hint: String| {
            Problem::new(code, format!("{name} is {}{unit}, {objection}", shortest(x)), hint)
        };
        let size = x.abs();
        let required = if x.is_nan() {
            let hint = format!("{}; nan stands where it is still to be supplied", self.described());
            return Some(problem("missing-number", "must be a number", hint));
        } else if !x.is_finite() {
            return Some(problem("not-finite", "must be a finite number", self.described()));
        } else if self.sign == Sign::Positive && x <= 0.0 {
            "must be > 0"
        } else if self.sign == Sign::NonNegative && x < 0.0 {
            "must be >= 0"
        } else if self.sign == Sign::NonZero && x == 0.0 {
            "must not be 0"
        } else if self.sign == Sign::AtLeastOne && x < 1.0 {
            "must be >= 1"
        } else if self.sign == Sign::Probability && !(0.0..=1.0).contains(&x) {
            "must be from 0 to 1"
        } else if x == 0.0 || (low..=high).contains(&size) {
            return None;
        } else if !(TINY..=LARGEST).contains(&size) {
            "must be of a magnitude between 1e-30 and 1e30"
        } else {
            return Some(
                problem("suspicious", "is suspicious", format!("{}: {doubt}", self.described())).warning(),
            );
        };
        Some(problem("range", required, self.described()))
    }
}

/// `x` in the shorter of its two notations.
pub(crate) fn shortest(x: f64) -> String {
    let (plain, scientific) = (format!("{x}"), format!("{x:e}"));
    if x.is_nan() {
        "nan".to_owned()
    } else if plain.len() <= scientific.len() + 2 {
        plain
    } else {
        scientific
    }
}

/// Four turns: nobody writes larger joint angles in radians.
const FOUR_TURNS: f64 = 8.0 * std::f64::consts::PI;
const DEGREES: &str = "it looks like degrees";
const MILLIMETRES: &str = "is it in millimetres?";

pub(crate) const GRAVITY: Quantity =
    Quantity::any("acceleration of gravity", units::ACCELERATION).plausible(1e-6, 100.0, "9.81 on Earth");
pub(crate) const MASS: Quantity =
    Quantity::positive("mass", units::MASS).plausible(1e-7, 1e5, "is it in grams?");
pub(crate) const BODY_MASS: Quantity =
    Quantity::non_negative("mass of the body", units::MASS).plausible(1e-7, 1e5, "is it in grams?");
pub(crate) const LENGTH: Quantity =
    Quantity::positive("length", units::LENGTH).plausible(1e-5, 50.0, MILLIMETRES);
pub(crate) const POSITION: Quantity =
    Quantity::any("position", units::LENGTH).plausible(TINY, 50.0, MILLIMETRES);
pub(crate) const INERTIA: Quantity =
    Quantity::positive("inertia", units::INERTIA).plausible(1e-12, 1e5, "is it in kg mm^2 or kg cm^2?");
pub(crate) const BODY_INERTIA: Quantity = Quantity::any("inertia about the centre of mass", units::INERTIA)
    .plausible(TINY, 1e5, "is it in kg mm^2 or kg cm^2?");
pub(crate) const AXIS: Quantity = Quantity::any("component of the joint axis", units::NONE);
pub(crate) const ORIENTATION: Quantity =
    Quantity::any("roll, pitch or yaw", units::ANGLE).plausible(TINY, 6.4, DEGREES);
pub(crate) const STIFFNESS: Quantity = Quantity::positive(
    "joint stiffness K, link side of the gear",
    units::STIFFNESS,
)
.plausible(1e-3, 1e7, "joints lie between 1 and 1e6 N m/rad; is it in N m/degree or on the motor side?");
pub(crate) const SPRING_HARDENING: Quantity = Quantity::non_negative(
    "growth k of the joint springs, torque K ζ + k ζ³, link side of the gear",
    units::HARDENING,
);
pub(crate) const MOTOR_INERTIA: Quantity = Quantity::positive(
    "motor inertia, link side of the gear",
    units::INERTIA,
)
.plausible(1e-9, 1e5, "multiply the rotor's by the square of the gear ratio");
pub(crate) const DAMPING: Quantity = Quantity::non_negative(
    "viscous damping, link side of the gear",
    units::DAMPING,
)
.plausible(TINY, 1e7, "is it on the motor side, or per rev/min?");
pub(crate) const STIFFNESS_TOLERANCE: Quantity =
    Quantity::non_negative("largest difference of the joint stiffness, either way", units::STIFFNESS);
pub(crate) const INERTIA_TOLERANCE: Quantity =
    Quantity::non_negative("largest difference of the motor inertia, either way", units::INERTIA);
pub(crate) const DAMPING_TOLERANCE: Quantity =
    Quantity::non_negative("largest difference of the damping, either way", units::DAMPING);
pub(crate) const MASS_TOLERANCE: Quantity = Quantity::non_negative(
    "largest difference of the mass that the joint carries up to the next ones, either way, as a part of it",
    units::NONE,
);
pub(crate) const GEAR_RATIO: Quantity = Quantity::nonzero(
    "gear ratio, motor turns per joint turn; negative if they turn in opposite senses",
    units::NONE,
)
.plausible(0.1, 1e5, "gears of arms lie between 1 and 500");
pub(crate) const TORQUE_LIMIT: Quantity =
    Quantity::positive("largest motor torque, link side of the gear", units::TORQUE);
pub(crate) const VELOCITY_LIMIT: Quantity = Quantity::positive("largest joint velocity", units::SPEED);
pub(crate) const DEFLECTION_LIMIT: Quantity =
    Quantity::positive("largest deflection of the joint's spring", units::ANGLE)
        .plausible(TINY, FOUR_TURNS, DEGREES);
pub(crate) const FRICTION: Quantity = Quantity::non_negative("Coulomb friction", units::TORQUE);
pub(crate) const EFFORT: Quantity = Quantity::any("largest torque of the joint", units::TORQUE);
pub(crate) const SPEED: Quantity = Quantity::any("largest velocity of the joint", units::SPEED);
pub(crate) const STOP: Quantity = Quantity::any("limit of the joint position", units::ANGLE);
pub(crate) const MULTIPLIER: Quantity =
    Quantity::any("multiplier of a joint that mimics another", units::NONE);
pub(crate) const DURATION: Quantity =
    Quantity::positive("duration", units::TIME).plausible(1e-6, 1e6, "is it in milliseconds?");
pub(crate) const PERIOD: Quantity = Quantity::positive("control period", units::TIME).plausible(
    1e-7,
    0.1,
    "is it in milliseconds, or the rate in Hz?",
);
pub(crate) const SPEED_OF_TIME: Quantity = Quantity::positive(
    "seconds of the reference per second of the run",
    units::NONE,
)
.plausible(1e-3, 100.0, "1 is the reference's own speed");
pub(crate) const INTEGRATION_TOLERANCE: Quantity = Quantity::positive(
    "tolerated local error of an integration step relative to the joint's speed",
    units::NONE,
);
pub(crate) const MARGIN: Quantity = Quantity::positive(
    "largest share of a limit, 0.9 for nine tenths",
    units::NONE,
)
.plausible(0.01, 1.0, "1 is the limit itself: is it in percent?");
pub(crate) const TIME: Quantity = Quantity::any("time", units::TIME);
pub(crate) const START: Quantity = Quantity::non_negative("time of departure", units::TIME);
pub(crate) const ANGLE: Quantity =
    Quantity::any("joint position", units::ANGLE).plausible(TINY, FOUR_TURNS, DEGREES);
pub(crate) const AMPLITUDE: Quantity =
    Quantity::any("amplitude", units::ANGLE).plausible(TINY, FOUR_TURNS, DEGREES);
pub(crate) const PHASE: Quantity = Quantity::any("phase", units::ANGLE).plausible(TINY, FOUR_TURNS, DEGREES);
pub(crate) const FREQUENCY: Quantity = Quantity::any(
    "angular frequency, 2π times the one in Hz",
    units::SPEED,
)
.plausible(TINY, 1e4, "that is beyond any joint");
pub(crate) const VELOCITY: Quantity =
    Quantity::any("joint velocity", units::SPEED).plausible(TINY, 1e3, "is it in degrees/s or rev/min?");
pub(crate) const TORQUE_RATE_LIMIT: Quantity =
    Quantity::positive("largest rate of the motor torque, link side of the gear", units::TORQUE_RATE)
        .plausible(1e-1, 1e9, "is it in N m/ms?");
pub(crate) const ACCEPTED_ERROR: Quantity =
    Quantity::positive("largest position error that still counts as following", units::ANGLE)
        .plausible(TINY, FOUR_TURNS, DEGREES);
pub(crate) const ACCEPTED_CHANGE: Quantity = Quantity::positive(
    "largest root mean square change of the motor torque from one control instant to the next",
    units::TORQUE,
);
pub(crate) const ACCEPTED_SHARE: Quantity =
    Quantity::probability("part of the control instants at which the drive is at its torque limit");
pub(crate) const SETTLING: Quantity = Quantity::non_negative("time from which errors count", units::TIME);
pub(crate) const TORQUE_STEP: Quantity =
    Quantity::non_negative("step that the motor torque comes in, link side of the gear", units::TORQUE);
pub(crate) const COUNTS: Quantity = Quantity::positive("counts per turn of the encoder's shaft", units::NONE)
    .plausible(10.0, 1e9, "encoders have between 100 and 1e7");
pub(crate) const RESOLUTION: Quantity =
    Quantity::non_negative("one count of the encoder, link side of the gear", units::ANGLE)
        .plausible(TINY, 0.3, DEGREES);
pub(crate) const NOISE: Quantity =
    Quantity::non_negative("standard deviation of measured positions", units::ANGLE)
        .plausible(TINY, 0.3, DEGREES);
pub(crate) const VELOCITY_NOISE: Quantity = Quantity::non_negative(
    "standard deviation of measured velocities",
    units::SPEED,
)
.plausible(TINY, 30.0, "is it in degrees/s or rev/min?");
pub(crate) const SENSOR_PERIOD: Quantity = Quantity::positive("time between two readings", units::TIME)
    .plausible(1e-7, 1.0, "is it in milliseconds, or the rate in Hz?");
pub(crate) const PROBABILITY: Quantity = Quantity::probability("probability per control period");
pub(crate) const MEAN_LENGTH: Quantity =
    Quantity::at_least_one("mean length of an outage", units::CONTROL_PERIODS);
pub(crate) const FROM: Quantity = Quantity::non_negative("time of the beginning", units::TIME);
pub(crate) const UNTIL: Quantity = Quantity::positive("time of the end", units::TIME);
pub(crate) const CUTOFF: Quantity = Quantity::positive(
    "cut-off frequency, the one in rad/s divided by 2π",
    units::FREQUENCY,
)
.plausible(0.1, 1e5, "filters of velocities lie between 10 and 1000 Hz");
pub(crate) const DAMPING_RATIO: Quantity =
    Quantity::positive("damping ratio", units::NONE).plausible(0.05, 20.0, "0.7 to 1 is usual");
pub(crate) const DELAY: Quantity =
    Quantity::non_negative("delay", units::TIME).plausible(1e-9, 0.5, "is it in milliseconds?");
pub(crate) const STATIC_FRICTION: Quantity =
    Quantity::non_negative("torque that breaks the joint loose, link side of the gear", units::TORQUE);
pub(crate) const STRIBECK_VELOCITY: Quantity = Quantity::positive(
    "speed at which 1/e of the rise of friction is left",
    units::SPEED,
)
.plausible(1e-6, 100.0, "is it in degrees/s or rev/min?");
pub(crate) const DEAD_ZONE: Quantity =
    Quantity::non_negative("deflection to either side without torque", units::ANGLE)
        .plausible(TINY, 0.5, DEGREES);
pub(crate) const HYSTERESIS_STIFFNESS: Quantity =
    Quantity::non_negative("stiffness of the element that slips", units::STIFFNESS);
pub(crate) const HYSTERESIS_TORQUE: Quantity =
    Quantity::non_negative("torque at which the element slips", units::TORQUE);
pub(crate) const FACTOR: Quantity =
    Quantity::positive("the simulated robot's number divided by the one that the law knows", units::NONE)
        .plausible(0.01, 100.0, "1 leaves it as it is; is it in percent?");
pub(crate) const TORQUE_FACTOR: Quantity = Quantity::positive(
    "torque of the drive divided by what is asked of it",
    units::NONE,
)
.plausible(0.01, 100.0, "1 leaves it as it is; is it in percent?");
pub(crate) const PAYLOAD: Quantity =
    Quantity::non_negative("mass of the payload", units::MASS).plausible(1e-7, 1e5, "is it in grams?");
pub(crate) const PUSH: Quantity = Quantity::any("torque from outside on the link", units::TORQUE);
pub(crate) const BANDWIDTH: Quantity = Quantity::positive("bandwidth, 2π times the one in Hz", units::SPEED)
    .plausible(0.1, 1e5, "observers lie between 10 and 10000 rad/s");
pub(crate) const STOP_DAMPING: Quantity =
    Quantity::non_negative("damping of the motor while stopped, link side of the gear", units::DAMPING);
pub(crate) const DISTANCE: Quantity =
    Quantity::positive("distance of two joint positions", units::ANGLE).plausible(TINY, FOUR_TURNS, DEGREES);
pub(crate) const RESIDUAL: Quantity =
    Quantity::positive("torque that the model does not know", units::TORQUE);
pub(crate) const OFFSET: Quantity =
    Quantity::any("what is added to measured positions", units::ANGLE).plausible(TINY, FOUR_TURNS, DEGREES);
pub(crate) const MOTOR_TORQUE: Quantity = Quantity::any("motor torque, link side of the gear", units::TORQUE);
pub(crate) const SCALE: Quantity =
    Quantity::nonzero("what the numbers of a column are multiplied by, beside their unit", units::NONE);
