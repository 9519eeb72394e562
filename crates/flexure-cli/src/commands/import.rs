//! `flexure import`: a robot file to complete, from a URDF.

use flexure::robot::{self, MAX_JOINTS};
use serde::Serialize;

use super::print;
use crate::failure::{Failure, say};

/// The draft as a document.
#[derive(Serialize)]
struct Draft {
    joints: Vec<String>,
    toml: String,
}

pub fn import(urdf: &str, locks: &[(String, f64)], json: bool) -> Result<(), Failure> {
    let robot::Import { toml, joints, warnings } = robot::import(urdf, locks)?;
    say(&warnings);
    if let Some((name, _)) =
        locks.iter().enumerate().find_map(|(i, lock)| locks[..i].iter().find(|earlier| earlier.0 == lock.0))
    {
        let message = format!("joint {name:?} is locked twice");
        return Err(Failure::input("lock", message, "give each joint one position"));
    }
    if joints.len() > MAX_JOINTS {
        let message =
            format!("{} joints of {urdf} move; this program is built for at most {MAX_JOINTS}", joints.len());
        let hint = format!("hold some still, --lock JOINT=POSITION once for each: {}", joints.join(", "));
        return Err(Failure::input("joints", message, &hint));
    }
    if json { print::json(&Draft { joints, toml }) } else { print::text(&toml) }
}
