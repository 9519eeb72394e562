//! `flexure import`: a robot file to complete, from a URDF.

use std::collections::BTreeMap;

use flexure::robot::{self, DriveClass, MAX_JOINTS};
use serde::Serialize;

use super::print;
use crate::failure::{Failure, say};

/// The draft as a document.
#[derive(Serialize)]
struct Draft {
    joints: Vec<String>,
    toml: String,
    /// Keys of the numbers that are still to be supplied, for each joint that lacks some.
    missing: BTreeMap<String, Vec<&'static str>>,
}

pub fn import(
    urdf: &str,
    locks: &[(String, f64)],
    assume: Option<&'static DriveClass>,
    json: bool,
) -> Result<(), Failure> {
    let draft = robot::import(urdf, locks, assume)?;
    say(&draft.warnings);
    if let Some((name, _)) =
        locks.iter().enumerate().find_map(|(i, lock)| locks[..i].iter().find(|earlier| earlier.0 == lock.0))
    {
        let message = format!("joint {name:?} is locked twice");
        return Err(Failure::input("lock", message, "give each joint one position"));
    }
    let joints: Vec<_> = draft.joints.iter().map(|joint| joint.name.clone()).collect();
    if joints.len() > MAX_JOINTS {
        let message =
            format!("{} joints of {urdf} move; this program is built for at most {MAX_JOINTS}", joints.len());
        let hint = format!("hold some still, --lock JOINT=POSITION once for each: {}", joints.join(", "));
        return Err(Failure::input("joints", message, &hint));
    }
    say(draft.still_missing().as_ref());
    let robot::Import { toml, missing, .. } = draft;
    if json {
        print::json(&Draft { joints, toml, missing: missing.into_iter().collect() })
    } else {
        print::text(&toml)
    }
}
