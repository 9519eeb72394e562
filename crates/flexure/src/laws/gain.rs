//! Gains in files: their keys, what they are, what tuning starts from; and those that several laws have.

use crate::files::field::{Field, Joints};
use crate::files::quantity::Quantity;
use crate::laws::Drive;
use crate::laws::starting::Starting;
use crate::units;

/// A gain of a law: one number per joint at a key of `[controller]`.
#[derive(Clone, Copy, Debug)]
pub struct Gain {
    /// Its key.
    pub key: &'static str,
    quantity: Quantity,
    /// What to start tuning from, by what a joint has to move.
    pub start: fn(&Drive) -> f64,
}

impl Gain {
    pub(crate) const fn new(key: &'static str, quantity: Quantity, start: fn(&Drive) -> f64) -> Self {
        Self { key, quantity, start }
    }

    /// Reads its numbers from `field`.
    pub(crate) fn read(&self, field: &Field<'_>, joints: &Joints) -> Option<Vec<f64>> {
        field.per_joint(joints, &self.quantity)
    }

    /// By which power it grows with the speed of the loop.
    pub(crate) fn per_second(&self) -> i32 {
        self.quantity.per_second()
    }

    /// What it is, and in which unit.
    pub fn described(&self) -> String {
        self.quantity.described()
    }
}

/// K_P and K_D of the feedback of the motors.
pub(crate) const MOTOR: [Gain; 2] = [
    Gain::new(
        "stiffness",
        Quantity::positive("stiffness K_P of the feedback of motor positions", units::STIFFNESS),
        Drive::motor_stiffness,
    ),
    Gain::new(
        "damping",
        Quantity::non_negative("damping K_D of the feedback of motor velocities", units::DAMPING),
        Drive::motor_damping,
    ),
];

/// K_Pl and K_Dl of links under computed torque.
pub(crate) const LINK: [Gain; 2] = [
    Gain::new(
        "link_stiffness",
        Quantity::positive("stiffness K_Pl of the feedback of link positions", units::STIFFNESS),
        |drive| drive.free_inertia * drive.bandwidth().powi(2),
    ),
    Gain::new(
        "link_damping",
        Quantity::non_negative("damping K_Dl of the feedback of link velocities", units::DAMPING),
        |drive| 2.0 * drive.free_inertia * drive.bandwidth(),
    ),
];

/// K_Pm and K_Dm of motors that follow what the links want.
pub(crate) const INNER_MOTOR: [Gain; 2] = [
    Gain::new(
        "motor_stiffness",
        Quantity::positive("stiffness K_Pm of the feedback of motor positions", units::STIFFNESS),
        Drive::motor_stiffness,
    ),
    Gain::new(
        "motor_damping",
        Quantity::non_negative("damping K_Dm of the feedback of motor velocities", units::DAMPING),
        Drive::motor_damping,
    ),
];

pub(crate) const POSITION: Quantity = Quantity::positive("gain k_p of the position error", units::RATE_2);
pub(crate) const RATE: Quantity = Quantity::positive("gain k_v of the velocity error", units::RATE);

/// k_p and k_v of motors that are driven to a position.
pub(crate) const INNER: [Gain; 2] = [
    Gain::new("position", POSITION, |drive| drive.inner_bandwidth().powi(2)),
    Gain::new("velocity", RATE, |drive| 2.0 * drive.inner_bandwidth()),
];

/// B_θ.
pub(crate) const SHAPED_INERTIA: Gain = Gain::new(
    "inertia",
    Quantity::positive("motor inertia that feedback of the spring torque makes", units::INERTIA),
    |drive| 0.5 * drive.motor_inertia,
);

/// Rigid computed torque with (s + ω)² on the links, and damping of the springs.
pub(crate) const TWO_TIME_SCALES: [Gain; 3] = [
    Gain::new("position", POSITION, |drive| drive.bandwidth().powi(2)),
    Gain::new("velocity", RATE, |drive| 2.0 * drive.bandwidth()),
    Gain::new("damping", Quantity::non_negative("damping K_f of the springs", units::DAMPING), |drive| {
        (drive.stiffness * drive.motor_inertia).sqrt()
    }),
];

pub(crate) const METRIC: Quantity = Quantity::positive("metric Π, diagonal", units::STIFFNESS);
pub(crate) const LAMBDA: Quantity = Quantity::positive("gain Λ inside φ", units::RATE);
pub(crate) const INJECTED: Quantity = Quantity::positive("injected damping K_d", units::DAMPING);

/// λ, or Λ of a linear φ.
pub(crate) const SHAPING: Gain = Gain::new("shaping", LAMBDA, Drive::bandwidth);

/// γ_l, D_i.
pub(crate) const LINK_DAMPING: Gain = Gain::new(
    "link_damping",
    Quantity::non_negative("damping injected into the links", units::DAMPING),
    |drive| drive.free_inertia * drive.bandwidth(),
);

/// The gains of a law as data.
pub trait GainSet: Sized {
    /// What a kind of law says of them.
    type Shape;

    /// What tuning starts from, by what each joint has to move.
    fn start(shape: &Self::Shape, drives: &[Drive]) -> Self;

    /// The same of a law that has what these gains choose besides numbers.
    fn restart(&self, shape: &Self::Shape, drives: &[Drive]) -> Self {
        Self::start(shape, drives)
    }

    /// Every gain with its path below `[controller]`, one number per joint.
    fn named<'a>(&'a self, shape: &Self::Shape) -> Vec<(String, &'a [f64])>;

    /// The powers of 1/s in their units, in the order of [`named`](Self::named).
    fn speed_powers(&self, shape: &Self::Shape) -> Vec<i32>;

    /// The same gains in the same order, to be changed.
    fn slots(&mut self) -> Vec<&mut Vec<f64>>;

    /// Shaping function φ, as in files, if one can be chosen.
    fn phi(&self) -> Option<&'static str> {
        None
    }
}

/// Numbers per joint for each of `G` gains, which stand in `[controller]` itself.
impl<const G: usize> GainSet for [Vec<f64>; G] {
    type Shape = [Gain; G];

    fn start(shape: &[Gain; G], drives: &[Drive]) -> Self {
        shape.map(|gain| drives.iter().map(gain.start).collect())
    }

    fn named<'a>(&'a self, shape: &[Gain; G]) -> Vec<(String, &'a [f64])> {
        shape.iter().zip(self).map(|(gain, values)| (gain.key.to_owned(), values.as_slice())).collect()
    }

    fn speed_powers(&self, shape: &[Gain; G]) -> Vec<i32> {
        shape.iter().map(Gain::per_second).collect()
    }

    fn slots(&mut self) -> Vec<&mut Vec<f64>> {
        self.iter_mut().collect()
    }
}

/// Gains that can be read.
pub(crate) trait ReadGains: GainSet {
    /// Reads them from `[controller]`, which has none but the kind where all are to be `starting` ones.
    fn read(shape: &Self::Shape, field: &Field<'_>, joints: &Joints, starting: &Starting<'_>)
    -> Option<Self>;
}

impl<const G: usize> ReadGains for [Vec<f64>; G] {
    fn read(shape: &[Gain; G], field: &Field<'_>, joints: &Joints, starting: &Starting<'_>) -> Option<Self> {
        let known: Vec<_> = std::iter::once("kind").chain(shape.iter().map(|gain| gain.key)).collect();
        let table = field.table(&known)?;
        if table.fields().all(|(key, _)| key == "kind") {
            return Some(Self::start(shape, &starting.drives(field)?));
        }
        let gains: Vec<_> =
            shape.iter().map(|gain| table.per_joint(gain.key, joints, &gain.quantity)).collect();
        gains.into_iter().collect::<Option<Vec<_>>>()?.try_into().ok()
    }
}
