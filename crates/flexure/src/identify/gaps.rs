//! Numbers that a robot file leaves open: `nan`.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::parameters::Parameter;

/// The parameters that stand in robot files.
pub(crate) const KEPT: [Parameter; 4] =
    [Parameter::Stiffness, Parameter::MotorInertia, Parameter::LinkDamping, Parameter::MotorDamping];

/// What a file has in the place of a number that is still to be supplied.
pub(crate) const GAP: &str = "nan";

/// Of which joints a `nan` is.
#[derive(Debug, PartialEq)]
enum Of {
    All,
    Number(usize),
    Named(String),
}

/// A `nan` in `[joints]`.
struct Found {
    parameter: Parameter,
    of: Of,
    span: Range<usize>,
}

/// A number of the right size for a robot's joint, as long as [`GAP`].
fn stand_in(parameter: Parameter) -> &'static str {
    match parameter {
        Parameter::Stiffness => "4e3",
        Parameter::MotorInertia => "0.3",
        _ => "0.5",
    }
}

/// The text of a robot file with something of the same length in the place of every gap.
pub(crate) fn filled(text: &str) -> String {
    let mut filled = text.to_owned();
    for Found { parameter, span, .. } in found(text) {
        filled.replace_range(span, stand_in(parameter));
    }
    filled
}

/// Which numbers of the joints called `joints` the text of a robot file leaves open, joint by joint.
pub(crate) fn gaps<'a>(text: &str, joints: impl Iterator<Item = &'a str>) -> Vec<(usize, Parameter)> {
    let found = found(text);
    let open = |(i, name): (usize, &str)| {
        let is_open = |parameter: Parameter| {
            let of_it = |gap: &Found| {
                gap.parameter == parameter
                    && match &gap.of {
                        Of::All => true,
                        Of::Number(number) => *number == i,
                        Of::Named(joint) => joint == name,
                    }
            };
            found.iter().any(of_it)
        };
        KEPT.into_iter()
            .filter(|parameter| is_open(*parameter))
            .map(|parameter| (i, parameter))
            .collect::<Vec<_>>()
    };
    joints.enumerate().flat_map(open).collect()
}

/// Every gap in the text of a robot file.
fn found(text: &str) -> Vec<Found> {
    let (root, _) = DeTable::parse_recoverable(text);
    let mut found = Vec::new();
    if let Some(joints) = root.get_ref().get("joints") {
        note(joints.get_ref(), None, &mut found);
    }
    found
}

/// Where in `[joints]`, or in the table of the joint `of` there, a parameter is [`GAP`], alone or in a list.
fn note(value: &DeValue<'_>, of: Option<&str>, found: &mut Vec<Found>) {
    let DeValue::Table(table) = value else { return };
    let is_gap =
        |value: &Spanned<DeValue<'_>>| matches!(value.get_ref(), DeValue::Float(x) if x.as_str() == GAP);
    for (key, value) in table {
        let key = key.get_ref().as_ref();
        let Some(parameter) = KEPT.into_iter().find(|parameter| parameter.name() == key) else {
            note(value.get_ref(), Some(key), found);
            continue;
        };
        let mut gap = |of: Of, value: &Spanned<DeValue<'_>>| {
            if is_gap(value) {
                found.push(Found { parameter, of, span: value.span() });
            }
        };
        match value.get_ref() {
            DeValue::Array(entries) => {
                entries.iter().enumerate().for_each(|(i, entry)| gap(Of::Number(i), entry));
            }
            _ => gap(of.map_or(Of::All, |joint| Of::Named(joint.to_owned())), value),
        }
    }
}
