//! What a certificate says that it is about. Nothing of it can be checked without the files themselves: hashes are of the right
//! form, and all of it is told as the file's own words.

use crate::verify::document::{Certificate, Phi, SIDES};
use crate::verify::field::Field;
use crate::verify::number::Number;
use crate::verify::robot::{Body, Links};
use crate::verify::verdict::{Claim, Rejected};

/// SHA-256 of what the robot's and the scenario's files say, in hexadecimal.
pub(super) struct Subject {
    robot: String,
    scenario: String,
}

pub(super) fn read(field: &Field<'_>) -> Result<Subject, Rejected> {
    let [robot, scenario] = field.object(["robot", "scenario"])?;
    Ok(Subject { robot: digest(&robot)?, scenario: digest(&scenario)? })
}

/// 64 hexadecimal digits.
fn digest(field: &Field<'_>) -> Result<String, Rejected> {
    let text = field.text()?;
    let is_digit = |byte: u8| matches!(byte, b'0'..=b'9' | b'a'..=b'f');
    if text.len() != 64 || !text.bytes().all(is_digit) {
        return Err(field.bad("must be 64 digits out of 0123456789abcdef"));
    }
    Ok(text.to_owned())
}

/// A text of the file in quotes and in one line: what could command a terminal, or change the order or the look of what
/// stands beside it, is escaped.
pub fn quoted(text: &str) -> String {
    let mut quoted = String::from('"');
    for c in text.chars() {
        // Marks of direction and joining, separators, tags: seen by nobody.
        let unseen = matches!(
            c,
            '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}'
                | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}'
        );
        if c.is_control() || unseen || matches!(c, '"' | '\\') {
            quoted.extend(c.escape_debug());
        } else {
            quoted.push(c);
        }
    }
    quoted.push('"');
    quoted
}

/// The file's own words, by path; texts of its maker in quotes, with everything escaped that could command a terminal.
pub(super) fn stated(certificate: &Certificate) -> Vec<Claim> {
    let mut about = vec![
        Claim::new("name", quoted(&certificate.name)),
        Claim::new("made_by", quoted(&certificate.made_by)),
    ];
    if let Some(subject) = &certificate.subject {
        about.push(Claim::new("subject.robot", format!("SHA-256 {}", subject.robot)));
        about.push(Claim::new("subject.scenario", format!("SHA-256 {}", subject.scenario)));
    }
    let robot = &certificate.robot;
    about.push(Claim::new("robot.name", quoted(&robot.name)));
    about.push(Claim::new("robot.joints", robot.joints.to_string()));
    about.extend(links(&robot.links));
    about.extend(
        [
            ("robot.stiffness", &robot.stiffness, "N m/rad"),
            ("robot.motor_inertia", &robot.motor_inertia, "kg m^2"),
            ("robot.link_damping", &robot.link_damping, "N m s/rad"),
            ("robot.motor_damping", &robot.motor_damping, "N m s/rad"),
        ]
        .map(|(name, numbers, unit)| Claim::new(name, format!("{} {unit}", listed(numbers)))),
    );
    let phi = match certificate.controller.phi {
        Phi::Tanh => "tanh",
        Phi::Linear => "linear",
        Phi::CoupledTanh => "coupled-tanh",
    };
    about.push(Claim::new("controller.phi", phi));
    for (name, side) in SIDES {
        let gains = certificate.controller.gains(side);
        let lists = [
            ("metric", &gains.metric, "N m/rad"),
            ("shaping", &gains.shaping, "1/s"),
            ("damping", &gains.damping, "N m s/rad"),
            ("kappa", &gains.kappa, "1/s"),
            ("hardening", &gains.hardening, "N m/rad^3"),
        ];
        let claim = |(key, numbers, unit): (&str, &Vec<Number>, &str)| {
            Claim::new(format!("controller.{name}.{key}"), format!("{} {unit}", listed(numbers)))
        };
        about.extend(lists.into_iter().filter(|(_, numbers, _)| !numbers.is_empty()).map(claim));
    }
    about
}

fn links(links: &Links) -> Vec<Claim> {
    let claim = |key: &str, value: String| Claim::new(format!("robot.links.{key}"), value);
    match links {
        Links::PlanarTwoLink(arm) => vec![
            claim("kind", "planar-two-link".to_owned()),
            claim("mass", format!("{} kg", listed(&arm.mass))),
            claim("length", format!("{} m", arm.length)),
            claim("com", format!("{} m", listed(&arm.com))),
            claim("inertia", format!("{} kg m^2", listed(&arm.inertia))),
        ],
        Links::Pendulum(body) => {
            let [mass, com, inertia] = body.as_ref();
            vec![
                claim("kind", "pendulum".to_owned()),
                claim("mass", format!("{mass} kg")),
                claim("com", format!("{com} m")),
                claim("inertia", format!("{inertia} kg m^2")),
            ]
        }
        Links::Tree(bodies) => {
            let bodies = bodies.iter().enumerate();
            let bodies = bodies.map(|(k, body)| claim(&format!("bodies[{k}]"), self::body(body)));
            std::iter::once(claim("kind", "tree".to_owned())).chain(bodies).collect()
        }
    }
}

fn body(body: &Body) -> String {
    let motion = match &body.travel {
        None => "revolute".to_owned(),
        Some(travel) => format!("prismatic, travel {} m", listed(travel)),
    };
    let parent = body.parent.map_or_else(|| "the base".to_owned(), |parent| format!("body {parent}"));
    let rows: Vec<_> = body.rotation.iter().map(|row| listed(row)).collect();
    format!(
        "{motion}, on {parent}, axis {}, rotation {}, translation {} m, mass {} kg, com {} m, inertia {} kg m^2",
        listed(&body.axis),
        rows.join("; "),
        listed(&body.translation),
        body.mass,
        listed(&body.com),
        listed(&body.inertia)
    )
}

fn listed(numbers: &[Number]) -> String {
    numbers.iter().map(Number::to_string).collect::<Vec<_>>().join(", ")
}
