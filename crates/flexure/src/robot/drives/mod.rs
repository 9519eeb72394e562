//! What drives of a kind are like: numbers that a URDF does not hold, from the torque that a joint gives.
//!
//! Gears, motors and springs of one family are scaled copies of each other, so that what they are like goes with their torque: a
//! family has a deflection at its largest torque, a time in which that torque brings its motor to speed, and so on. That is rough:
//! stiffness keeps to it within a factor of two, motor inertia grows faster than the torque (five times as much for each N m from
//! 5 to 700 N m in the FHA series). The numbers are typical, not those of a robot: what is made of them is marked as assumed, with
//! its source, and `flexure identify` finds the robot's own.

mod belt;
mod cycloidal;
mod harmonic_drive;
mod series_elastic;

use crate::files::{Entry, Problem, suggest};
use crate::robot::JointKind;

/// The registered classes of drives: one line a file.
pub const DRIVES: &[DriveClass] =
    &[harmonic_drive::HARMONIC_DRIVE, series_elastic::SERIES_ELASTIC, cycloidal::CYCLOIDAL, belt::BELT];

/// A family of drives. Numbers are those of the link side of the gear, for each N m of the largest torque τ.
#[derive(Debug)]
pub struct DriveClass {
    /// The name on the command line, and what it stands for.
    pub entry: Entry,
    /// Smallest and largest torque that such drives are made for [N m]: what is outside is likely no torque limit.
    pub torques: [f64; 2],
    /// Stiffness K = this · τ [1/rad].
    pub stiffness: Typical,
    /// Motor inertia M_m = this · τ \[s²\].
    pub motor_inertia: Typical,
    /// Damping of the link D_l = this · τ \[s\].
    pub link_damping: Typical,
    /// Damping of the motor D_m = this · τ \[s\].
    pub motor_damping: Typical,
    /// Coulomb friction of the motor = this · τ.
    pub friction: Typical,
    /// Largest rate of the torque = this · τ [1/s].
    pub torque_rate: Typical,
    /// Motor turns per turn of the joint.
    pub gear_ratio: Typical,
}

/// A typical number.
#[derive(Clone, Copy, Debug)]
pub struct Typical {
    /// The number.
    pub value: f64,
    /// Where it is from, in words.
    pub source: &'static str,
}

/// A drive of a class. For one that slides read m for rad, N for N m and kg for kg m².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TypicalDrive {
    /// Stiffness K [N m/rad].
    pub stiffness: f64,
    /// Motor inertia M_m [kg m²].
    pub motor_inertia: f64,
    /// Damping of the link D_l [N m s/rad].
    pub link_damping: f64,
    /// Damping of the motor D_m [N m s/rad].
    pub motor_damping: f64,
    /// Coulomb friction of the motor [N m].
    pub friction: f64,
    /// Largest rate of the torque [N m/s].
    pub torque_rate: f64,
    /// Motor turns per turn of the joint; radians of the motor per metre for one that slides.
    pub gear_ratio: f64,
}

/// Radius in m of the pinion by which a drive that turns is taken to move a joint that slides.
const PINION: f64 = 0.05;

/// Significant digits of what is assumed: more would look measured.
const DIGITS: usize = 3;

impl DriveClass {
    /// The class called `name`.
    ///
    /// # Errors
    /// `unknown-name` if there is none.
    pub fn named(name: &str) -> Result<&'static Self, Problem> {
        DRIVES.iter().find(|class| class.entry.name == name).ok_or_else(|| {
            let message = format!("no class of drives is called {}", suggest::quoted(name));
            let known = suggest::hint(name, DRIVES.iter().map(|class| class.entry.name));
            Problem::new("unknown-name", message, known)
        })
    }

    /// A drive of this class with the largest torque `torque` > 0 [N m], or force \[N\] on a joint that slides: the drive that
    /// turns then has a pinion of 50 mm radius on it.
    ///
    /// ```
    /// use flexure::robot::{DriveClass, JointKind};
    /// let drive = DriveClass::named("harmonic-drive")?.drive(JointKind::Revolute, 100.0);
    /// assert_eq!((drive.stiffness, drive.motor_inertia), (15_000.0, 1.0)); // N m/rad, kg m²
    /// # Ok::<(), flexure::files::Problem>(())
    /// ```
    pub fn drive(&self, kind: JointKind, torque: f64) -> TypicalDrive {
        // Forces are torques by the radius, positions angles times the radius.
        let radius = radius(kind);
        let of_motion = |typical: Typical| rounded(typical.value * torque / radius);
        let of_torque = |typical: Typical| rounded(typical.value * torque);
        TypicalDrive {
            stiffness: of_motion(self.stiffness),
            motor_inertia: of_motion(self.motor_inertia),
            link_damping: of_motion(self.link_damping),
            motor_damping: of_motion(self.motor_damping),
            friction: of_torque(self.friction),
            torque_rate: of_torque(self.torque_rate),
            gear_ratio: rounded(self.gear_ratio.value / radius),
        }
    }

    /// Whether such drives are made for a joint with the largest torque `torque` [N m], or force \[N\] where it slides.
    pub fn is_made_for(&self, kind: JointKind, torque: f64) -> bool {
        let [least, most] = self.torques;
        (least..=most).contains(&(torque * radius(kind)))
    }
}

/// By which a drive that turns moves a joint, in m; 1 for joints that turn themselves.
fn radius(kind: JointKind) -> f64 {
    match kind {
        JointKind::Revolute => 1.0,
        JointKind::Prismatic => PINION,
    }
}

/// `x` to a few digits.
pub(crate) fn rounded(x: f64) -> f64 {
    format!("{x:.*e}", DIGITS - 1).parse().unwrap_or(x)
}
