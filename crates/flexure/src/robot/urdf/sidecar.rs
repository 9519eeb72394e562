//! A robot file to complete, from a URDF.

use std::fmt::Write;
use std::path::Path;

use crate::files::document::Log;
use crate::files::site::Site;
use crate::files::source::{self, Source};
use crate::files::suggest::{key, text};
use crate::files::{Problem, Problems};
use crate::robot::document::DAMPING;
use crate::robot::links::{Assembled, DriveDefaults, JointKind, MovingJoint};
use crate::robot::urdf::{LIMIT, Locks, Urdf};
use crate::units;

/// A robot file that lacks what a URDF does not say.
#[derive(Clone, Debug)]
pub struct Import {
    /// The file; numbers still to be supplied are `nan`, which every reader refuses.
    pub toml: String,
    /// Names of the moving joints.
    pub joints: Vec<String>,
    /// What is suspicious in the URDF.
    pub warnings: Vec<Problem>,
}

/// Drafts a robot file from the URDF at `path`, with some joints held still at a position [rad or m]. Joints that others
/// mimic are held still too.
///
/// # Errors
/// With everything that is wrong with the URDF or the locks.
pub fn import(path: &str, locks: &[(String, f64)]) -> Result<Import, Problems> {
    drafted(path, &source::read(Path::new(path), LIMIT)?, locks)
}

/// As [`import`], from the `text` of the URDF; `path` stands for it in messages and in the draft.
///
/// # Errors
/// With everything that is wrong with the URDF or the locks.
pub fn import_text(path: &str, text: &str, locks: &[(String, f64)]) -> Result<Import, Problems> {
    drafted(path, &Source::new(path, text), locks)
}

fn drafted(path: &str, source: &Source, locks: &[(String, f64)]) -> Result<Import, Problems> {
    let log = Log::new(source);
    let draft = super::with(&log, |urdf| {
        let site = Site { path: "lock".to_owned(), ..urdf.site.clone() };
        let sound: Vec<_> = locks.iter().map(|(name, q)| urdf.can_hold(name, *q, &site)).collect();
        sound.into_iter().collect::<Option<()>>()?;
        let locks: Locks<'_> = locks.iter().map(|(name, q)| (&**name, *q)).collect();
        draft(urdf, path, locks)
    });
    let ((toml, joints), warnings) = log.finish(draft)?;
    Ok(Import { toml, joints, warnings })
}

fn draft<'a>(urdf: Urdf<'a>, path: &str, mut locks: Locks<'a>) -> Option<(String, Vec<String>)> {
    let mimicked: Locks<'_> =
        urdf.mimicked(&locks).into_iter().map(|(name, drive)| (name, drive.nearest(0.0))).collect();
    locks.extend(&mimicked);
    let stem = Path::new(path).file_stem().map_or("robot".into(), |stem| stem.to_string_lossy());
    let is_name = |name: &&str| !name.trim().is_empty() && !name.contains(char::is_control);
    let name = urdf.name.filter(is_name).map_or_else(|| stem.into_owned(), str::to_owned);
    let decimals = urdf.site.log.decimals();
    let Assembled { joints, .. } = urdf.assemble(&locks, decimals)?;

    let mut toml = String::new();
    head(&mut toml, path, &name, &locks, &mimicked);
    for joint in &joints {
        drive(&mut toml, joint);
    }
    sources(&mut toml, path, joints.iter().any(|joint| joint.drive.damping.is_some()));
    Some((toml, joints.into_iter().map(|joint| joint.name).collect()))
}

/// Everything above the joints. Writing to a string cannot fail.
fn head(toml: &mut String, path: &str, name: &str, locks: &Locks<'_>, mimicked: &Locks<'_>) {
    let _ = write!(
        toml,
        "# A robot file to complete. Every nan stands for a number that a URDF does not hold and that is still to be\n\
         # supplied; `flexure check` refuses the file until all of them are. Everything is on the link side of the gear.\n\n\
         name = {}\n\
         gravity = [0.0, 0.0, -9.81]        # m/s², in the base frame of the URDF\n\n\
         [links]\n\
         kind = \"urdf\"\n\
         file = {}  # relative to this file: change it if this file goes elsewhere\n",
        text(name),
        text(path)
    );
    if !locks.is_empty() {
        let entries: Vec<_> = locks.iter().map(|(name, q)| format!("{} = {q:?}", key(name))).collect();
        let _ = writeln!(toml, "locked = {{ {} }}  # rad, or m for a prismatic joint", entries.join(", "));
    }
    for name in mimicked.keys() {
        let _ = writeln!(toml, "# {} is locked because joints that mimic it cannot move with it", key(name));
    }
}

/// `[sources]`, as far as they are known.
fn sources(toml: &mut String, path: &str, damping: bool) {
    let file = Path::new(path).file_name().unwrap_or_default().to_string_lossy();
    let _ = write!(
        toml,
        "\n[sources]  # where numbers come from; begin with \"assumed: \" what nothing vouches for\nlinks = {}\n",
        text(&format!("{file} as it was imported"))
    );
    if damping {
        let _ = writeln!(toml, "link_damping = {}", text(&format!("assumed: {DAMPING}")));
    }
    let _ = writeln!(toml, "# stiffness = \"data sheet of …\"");
}

/// The table of one joint.
fn drive(toml: &mut String, MovingJoint { name, kind, drive }: &MovingJoint) {
    let (word, gear) = match kind {
        JointKind::Revolute => ("revolute", "the rotor's times the gear ratio squared"),
        JointKind::Prismatic => {
            ("prismatic", "the rotor's inertia in kg m² times the gear ratio in rad/m squared")
        }
    };
    let [stiffness, inertia, damping, torque, velocity, position] =
        [units::STIFFNESS, units::INERTIA, units::DAMPING, units::TORQUE, units::SPEED, units::ANGLE]
            .map(|unit| unit.of(*kind).raised);
    let _ = writeln!(toml, "\n[joints.{}]  # {word}", key(name));
    let mut line = |key: &str, value: String, comment: String| {
        let _ = writeln!(toml, "{:<34} # {comment}", format!("{key} = {value}"));
    };
    let wanted = || "nan".to_owned();
    line("stiffness", wanted(), format!("SUPPLY: spring constant, {stiffness}"));
    line("motor_inertia", wanted(), format!("SUPPLY: {inertia}, {gear}"));
    line("motor_damping", wanted(), format!("SUPPLY: {damping}"));
    match drive.damping {
        Some(damping_l) => {
            line("link_damping", format!("{damping_l:?}"), format!("{damping}, the URDF's damping"));
        }
        None => line("link_damping", wanted(), format!("SUPPLY: {damping}")),
    }
    let mut given = |key: &str, value: Option<f64>, unit: &str| {
        if let Some(value) = value {
            line(
                &format!("# {key}"),
                format!("{value:?}"),
                format!("{unit}, holds as it stands in the URDF"),
            );
        }
    };
    given("torque_limit", drive.torque_limit, torque);
    given("velocity_limit", drive.velocity_limit, velocity);
    given("position_lower", drive.position_lower, position);
    given("position_upper", drive.position_upper, position);
}

impl DriveDefaults {
    /// `q` or the limit next to it.
    fn nearest(&self, q: f64) -> f64 {
        q.max(self.position_lower.unwrap_or(q)).min(self.position_upper.unwrap_or(f64::INFINITY))
    }
}
