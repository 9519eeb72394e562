//! A robot file to complete, from a URDF.

use std::fmt::Write;
use std::path::Path;

use crate::files::document::Log;
use crate::files::number::short;
use crate::files::site::Site;
use crate::files::source::{self, Source};
use crate::files::suggest::{key, text};
use crate::files::{Problem, Problems};
use crate::robot::DriveClass;
use crate::robot::document::DAMPING;
use crate::robot::drives::rounded;
use crate::robot::joints::wanted;
use crate::robot::links::{Assembled, DriveDefaults, JointKind, MovingJoint};
use crate::robot::urdf::drive_table::Drafted;
use crate::robot::urdf::{LIMIT, Locks, Urdf, effort};

/// A robot file that lacks what a URDF does not say.
#[derive(Clone, Debug)]
pub struct Import {
    /// The file; numbers still to be supplied are `nan`, which every reader refuses.
    pub toml: String,
    /// The text of the URDF.
    pub urdf: String,
    /// What the robot is called.
    pub name: String,
    /// The moving joints with what is known of their drives: what the URDF says, and torque limits that were assumed.
    pub joints: Vec<MovingJoint>,
    /// The class of drives that stands in for what a URDF does not say, if one does.
    pub class: Option<&'static DriveClass>,
    /// Keys of numbers that are still to be supplied, for each joint that lacks some.
    pub missing: Vec<(String, Vec<&'static str>)>,
    /// What is suspicious in the URDF.
    pub warnings: Vec<Problem>,
}

impl Import {
    /// A warning that lists the numbers which are still to be supplied, if there are any.
    pub fn still_missing(&self) -> Option<Problem> {
        let lacking: Vec<_> = self.missing.iter().map(|(name, keys)| (name.as_str(), keys.clone())).collect();
        (!lacking.is_empty()).then(|| wanted(&lacking).warning())
    }
}

/// What is wanted of a draft.
#[derive(Clone, Copy, Debug, Default)]
pub struct ImportOptions<'a> {
    /// Joints that are held still, with their positions [rad or m].
    pub locks: &'a [(String, f64)],
    /// Drives of this class stand in for what a URDF does not say.
    pub assume: Option<&'static DriveClass>,
    /// Limits of zero, and ranges without width, stand for what nobody knew: no limits. They are refused otherwise.
    pub unknown_limits: bool,
    /// The path of the URDF as the draft names it, relative to the draft; as it was read if none is given.
    pub file: Option<&'a str>,
}

/// Drafts a robot file from the URDF at `path`. Joints that others mimic are held still too.
///
/// # Errors
/// With everything that is wrong with the URDF or the locks.
pub fn import(path: &str, options: &ImportOptions<'_>) -> Result<Import, Problems> {
    drafted(path, &source::read(Path::new(path), LIMIT)?, options)
}

/// As [`import`], from the `text` of the URDF; `path` stands for it in messages and in the draft.
///
/// # Errors
/// With everything that is wrong with the URDF or the locks.
pub fn import_text(path: &str, text: &str, options: &ImportOptions<'_>) -> Result<Import, Problems> {
    drafted(path, &Source::new(path, text), options)
}

fn drafted(path: &str, source: &Source, options: &ImportOptions<'_>) -> Result<Import, Problems> {
    let log = Log::new(source);
    let locks = options.locks;
    let draft = super::with(&log, |urdf| {
        let site = Site { path: "lock".to_owned(), ..urdf.site.clone() };
        let sound: Vec<_> = locks.iter().map(|(name, q)| urdf.can_hold(name, *q, &site)).collect();
        sound.into_iter().collect::<Option<()>>()?;
        let locks: Locks<'_> = locks.iter().map(|(name, q)| (&**name, *q)).collect();
        draft(urdf, path, locks, options)
    });
    let (draft, warnings) = log.finish(draft)?;
    Ok(Import { warnings, urdf: source.text.to_string(), ..draft })
}

fn draft<'a>(
    urdf: Urdf<'a>,
    path: &str,
    mut locks: Locks<'a>,
    options: &ImportOptions<'_>,
) -> Option<Import> {
    let class = options.assume;
    let mimicked: Locks<'_> =
        urdf.mimicked(&locks).into_iter().map(|(name, drive)| (name, drive.nearest(0.0))).collect();
    locks.extend(&mimicked);
    let stem = Path::new(path).file_stem().map_or("robot".into(), |stem| stem.to_string_lossy());
    let is_name = |name: &&str| !name.trim().is_empty() && !name.contains(char::is_control);
    let name = urdf.name.filter(is_name).map_or_else(|| stem.into_owned(), str::to_owned);
    let (decimals, site) = (urdf.site.log.decimals(), urdf.site.clone());
    let Assembled { mut joints, links, .. } = urdf.assemble(&locks, options.unknown_limits, decimals)?;

    let (mut toml, mut missing) = (String::new(), Vec::new());
    head(&mut toml, options.file.unwrap_or(path), &name, &locks, &mimicked, options);
    let mut noted = Noted::default();
    for (i, joint) in joints.iter_mut().enumerate() {
        let known = joint.drive.torque_limit;
        let torque = class.map(|_| known.unwrap_or_else(|| rounded(effort::assumed(links.tree(), i))));
        let typical = class.zip(torque).map(|(class, torque)| class.drive(joint.kind, torque));
        let drafted = Drafted { joint, typical, torque_limit: torque.filter(|_| known.is_none()) };
        let lacking = drafted.write(&mut toml);
        noted.damping |= drafted.damping_of_urdf().is_some();
        noted.typical_damping |= class.is_some() && drafted.damping_of_urdf().is_none();
        noted.effort |= drafted.torque_limit.is_some();
        if !lacking.is_empty() {
            missing.push((joint.name.clone(), lacking));
        }
        joint.drive.torque_limit = known.or(torque);
    }
    if let Some(class) = class {
        for (message, help) in doubts(class, &joints) {
            site.warn("limits", message, help);
        }
    }
    sources(&mut toml, path, class, &noted);
    Some(Import { toml, urdf: String::new(), name, joints, class, missing, warnings: Vec::new() })
}

/// Torque limits that are written where nobody knows them [N m].
const PLACEHOLDERS: [f64; 7] = [1.0, 10.0, 100.0, 300.0, 500.0, 1000.0, 10_000.0];

/// Joints with the same one of these make it likely that it is none.
const SUSPICIOUS: usize = 3;

/// Why the numbers of `class` may be far off for `joints`, which follow from their torque limits: message and help.
fn doubts(class: &DriveClass, joints: &[MovingJoint]) -> Vec<(String, &'static str)> {
    const HELP: &str = "what is assumed follows from the torque limit: write the drive's own into the URDF's effort, then import again";
    let torque = |joint: &MovingJoint| joint.drive.torque_limit.unwrap_or_default();
    let unit = |joint: &MovingJoint| if joint.kind == JointKind::Prismatic { "N" } else { "N m" };
    let said = |joint: &&MovingJoint| format!("{} ({} {})", joint.name, short(torque(joint), 4), unit(joint));
    let odd: Vec<_> = joints.iter().filter(|joint| !class.is_made_for(joint.kind, torque(joint))).collect();
    let mut doubts = Vec::new();
    if !odd.is_empty() {
        let [least, most] = class.torques;
        let named: Vec<_> = odd.iter().map(said).collect();
        doubts.push((
            format!(
                "{} drives are made for {least} to {most} N m; these torque limits are outside: {}",
                class.entry.name,
                named.join(", ")
            ),
            HELP,
        ));
    }
    let same = |x: f64| joints.iter().filter(|joint| torque(joint).to_bits() == x.to_bits()).count();
    let placeholder = PLACEHOLDERS.iter().find(|&&x| same(x) >= SUSPICIOUS && same(x) == joints.len());
    if let (Some(x), Some(first)) = (placeholder, joints.first()) {
        doubts.push((
            format!(
                "all {} joints have a torque limit of {x} {}: it may stand for one that nobody knew",
                joints.len(),
                unit(first)
            ),
            HELP,
        ));
    }
    doubts
}

/// What `[sources]` has to say.
#[derive(Default)]
struct Noted {
    /// The URDF's damping is some link's.
    damping: bool,
    /// Damping of the class is some link's.
    typical_damping: bool,
    /// Some torque limit is assumed.
    effort: bool,
}

/// Everything above the joints. Writing to a string cannot fail.
fn head(
    toml: &mut String,
    path: &str,
    name: &str,
    locks: &Locks<'_>,
    mimicked: &Locks<'_>,
    options: &ImportOptions<'_>,
) {
    let _ = match options.assume {
        None => write!(
            toml,
            "# A robot file to complete. Every nan stands for a number that a URDF does not hold and that is still to be\n\
             # supplied; `flexure check` refuses the file until all of them are. Everything is on the link side of the gear.\n"
        ),
        Some(class) => write!(
            toml,
            "# A robot file whose joints are taken to be {}: numbers that a URDF does not hold are\n\
             # typical of such drives, not measured, and listed as assumed. Everything is on the link side of the gear.\n",
            class.entry.summary
        ),
    };
    let _ = write!(
        toml,
        "\nname = {}\n\
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
    if options.unknown_limits {
        toml.push_str("unknown_limits = true  # limits of zero in the URDF are none\n");
    }
    for name in mimicked.keys() {
        let _ = writeln!(toml, "# {} is locked because joints that mimic it cannot move with it", key(name));
    }
}

/// `[sources]`, as far as they are known.
fn sources(toml: &mut String, path: &str, class: Option<&DriveClass>, noted: &Noted) {
    let file = Path::new(path).file_name().unwrap_or_default().to_string_lossy();
    let _ = write!(
        toml,
        "\n[sources]  # where numbers come from; begin with \"assumed: \" what nothing vouches for\nlinks = {}\n",
        text(&format!("{file} as it was imported"))
    );
    let mut assumed = |key: &str, note: &str| {
        let _ = writeln!(toml, "{key} = {}", text(&format!("assumed: {note}")));
    };
    let own = class.map(|class| class.link_damping.source).filter(|_| noted.typical_damping);
    match (noted.damping, own) {
        (true, Some(own)) => assumed("link_damping", &format!("{DAMPING}; where it has none, {own}")),
        (true, None) => assumed("link_damping", DAMPING),
        (false, Some(own)) => assumed("link_damping", own),
        (false, None) => {}
    }
    if noted.effort {
        assumed("torque_limit", effort::SOURCE);
    }
    let Some(class) = class else {
        let _ = writeln!(toml, "# stiffness = \"data sheet of …\"");
        return;
    };
    for (key, typical) in [
        ("stiffness", class.stiffness),
        ("motor_inertia", class.motor_inertia),
        ("motor_damping", class.motor_damping),
        ("torque_rate_limit", class.torque_rate),
        ("gear_ratio", class.gear_ratio),
    ] {
        assumed(key, typical.source);
    }
}

impl DriveDefaults {
    /// `q` or the limit next to it.
    fn nearest(&self, q: f64) -> f64 {
        q.max(self.position_lower.unwrap_or(q)).min(self.position_upper.unwrap_or(f64::INFINITY))
    }
}
