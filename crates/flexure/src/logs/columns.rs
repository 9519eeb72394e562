//! Which column of a file is what: a small TOML file, or the same on one line.
//!
//! ```toml
//! t = { column = "stamp", unit = "ms" }
//! q_l = "link_pos_{}"                       # {} is the number of the joint, from 1
//! q_m = { columns = ["m_a", "m_b"], unit = "deg", motor_side = true, sign = [1, -1] }
//! u_m = { columns = "current_{}", scale = 0.085 }
//! ```

use std::fmt::Write;
use std::path::Path;

use toml::de::DeValue;

use crate::files::document::{Form, parse};
use crate::files::field::{Field, Joints};
use crate::files::source::{self, Source};
use crate::files::table::Table;
use crate::files::{Problem, Problems, bounds, quantity, suggest};
use crate::logs::channel::{Channel, TIMES};
use crate::robot::Robot;

/// Which columns a log is read from, and what their numbers are in SI units. The default reads Flexure's own traces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    /// What is said of the time.
    pub(super) time: Option<Time>,
    /// What is said of each channel, in the order of [`Channel::ALL`].
    pub(super) channels: [Option<Signal>; 5],
}

/// The column of the time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Time {
    pub column: String,
    /// Seconds in one unit of it.
    pub scale: f64,
    /// Whether the unit was said.
    pub unit: bool,
}

/// The columns of one channel, one per joint.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Signal {
    pub columns: Vec<String>,
    /// What a number in the file is multiplied by, per joint.
    pub scale: Vec<f64>,
}

/// A map of columns in messages.
const FORM: Form = Form {
    what: "map of columns",
    required: &["u_m"],
    optional: &["t", "q_l", "q_m", "dq_l", "dq_m"],
    other: ("links", "robot file", "a map of columns has lines like q_l = \"link_pos_{}\""),
};

impl Columns {
    /// The map at the path `said`, or in `said` itself if there is a `=` in it: `q_l=link_pos_{},q_l.unit=deg,u_m=tau_{}`.
    ///
    /// # Errors
    /// With everything that is wrong with it, for a log of `robot`.
    pub fn read(said: &str, robot: &Robot) -> Result<(Self, Vec<Problem>), Problems> {
        let source = if said.contains('=') {
            Source::new("--columns", &as_toml(said)?)
        } else {
            source::read(Path::new(said), bounds::LIMIT)?
        };
        parse(&source, &[], &FORM, |table, _| columns(table, robot))
    }
}

/// `key=value,…` as TOML, a line each.
fn as_toml(said: &str) -> Result<String, Problem> {
    let mut toml = String::new();
    for part in said.split(',').map(str::trim).filter(|part| !part.is_empty()) {
        let Some((key, value)) = part.split_once('=') else {
            let message = format!("--columns has {}, must be KEY=VALUE", suggest::quoted(part));
            let help =
                "write it like q_l=link_pos_{},q_l.unit=deg,u_m=tau_{}, or give a file with more in it";
            return Err(Problem::new("usage", message, help));
        };
        let (key, value) = (key.trim(), value.trim());
        let key = match key.split_once('.') {
            Some((channel, key)) => format!("{}.{}", suggest::key(channel), suggest::key(key)),
            None if key == "t" => "t.column".to_owned(),
            None => format!("{}.columns", suggest::key(key)),
        };
        let bare = value.parse::<f64>().is_ok_and(f64::is_finite) || matches!(value, "true" | "false");
        let value = if bare { value.to_owned() } else { suggest::text(value) };
        let _ = writeln!(toml, "{key} = {value}");
    }
    Ok(toml)
}

fn columns(table: &Table<'_>, robot: &Robot) -> Option<Columns> {
    let time = table.optional("t", time);
    let signal = |channel: Channel| table.optional(channel.key(), |field| signal(field, channel, robot));
    let [q_l, q_m, dq_l, dq_m, u_m] = Channel::ALL.map(signal);
    table.required("u_m", "the columns of the motor torques");
    let channels = [q_l?, q_m?, dq_l?, dq_m?, u_m?];
    channels[4].as_ref()?;
    Some(Columns { time: time?, channels })
}

fn time(field: &Field<'_>) -> Option<Time> {
    if !field.value.is_table() {
        return Some(Time { column: field.text()?.to_owned(), scale: 1.0, unit: false });
    }
    let table = field.table(&["column", "unit"])?;
    let column = table.optional("column", Field::text);
    let unit = table.optional("unit", |field| field.choice(&TIMES));
    let (column, unit) = (column?.unwrap_or("t"), unit?);
    Some(Time { column: column.to_owned(), scale: unit.unwrap_or(1.0), unit: unit.is_some() })
}

fn signal(field: &Field<'_>, channel: Channel, robot: &Robot) -> Option<Signal> {
    let joints = robot.joint_count();
    if !field.value.is_table() {
        return Some(Signal { columns: names(field, joints)?, scale: vec![1.0; joints] });
    }
    let mut keys = vec!["columns", "unit", "scale", "sign"];
    if channel.is_of_the_motor() {
        keys.push("motor_side");
    }
    let table = field.table(&keys)?;
    let per_joint = Joints { count: Some(joints), robot: robot.name.clone() };
    let columns = table
        .required("columns", "a name with {} for the number of the joint")
        .and_then(|field| names(&field, joints));
    let unit = table.optional("unit", |field| field.choice(channel.units()));
    let scale = table.optional("scale", |field| field.per_joint(&per_joint, &quantity::SCALE));
    let sign = table.optional("sign", |field| signs(field, &per_joint));
    let gears = table.optional("motor_side", |field| gears(field, channel, robot));
    let unit = unit?.unwrap_or(1.0);
    let factors = [scale?, sign?, gears?.flatten()];
    let of_joint = |i: usize| factors.iter().flatten().fold(unit, |product, factor| product * factor[i]);
    Some(Signal { columns: columns?, scale: (0..joints).map(of_joint).collect() })
}

/// One name per joint: from a pattern, or all of them.
fn names(field: &Field<'_>, joints: usize) -> Option<Vec<String>> {
    if !matches!(field.value, DeValue::Array(_)) {
        let pattern = field.text()?;
        if !pattern.contains("{}") && joints > 1 {
            let message = format!("{} is {}, which is one column", field.path, suggest::quoted(pattern));
            field.error(
                "length",
                message,
                "write {} where the number of the joint stands, or an array of names",
            );
            return None;
        }
        return Some(expanded(pattern, joints));
    }
    let names = field.texts()?;
    if names.len() != joints {
        let message = format!("{} has {} names, must be one per joint: {joints}", field.path, names.len());
        field.error("length", message, "in the order of the joints of the robot file");
        return None;
    }
    Some(names)
}

/// The names that `pattern` stands for.
pub(super) fn expanded(pattern: &str, joints: usize) -> Vec<String> {
    (1..=joints).map(|joint| pattern.replace("{}", &joint.to_string())).collect()
}

fn signs(field: &Field<'_>, joints: &Joints) -> Option<Vec<f64>> {
    let signs = field.per_joint(joints, &quantity::SCALE)?;
    if !signs.iter().all(|sign| [1.0, -1.0].contains(sign)) {
        field.error(
            "range",
            format!("{} must be 1 or -1 for each joint", field.path),
            "anything else is a scale",
        );
        return None;
    }
    Some(signs)
}

/// What turns numbers on the motors' shafts into those on the link side, if `motor_side` is true.
#[expect(clippy::option_option, reason = "bad, absent and good are three cases")]
fn gears(field: &Field<'_>, channel: Channel, robot: &Robot) -> Option<Option<Vec<f64>>> {
    if !field.boolean()? {
        return Some(None);
    }
    let Some(gears) = &robot.gear_ratio else {
        let message = format!("{} is true, but robot {} has no gear ratios", field.path, robot.name);
        field.error("missing-key", message, "add gear_ratio to [joints] of the robot file, or give scale");
        return None;
    };
    Some(Some(gears.iter().map(|gear| channel.behind_gear(*gear)).collect()))
}
