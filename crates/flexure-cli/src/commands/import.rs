//! `flexure import`: a robot file to complete, from a URDF.

use flexure::io;
use flexure::registry::MAX_JOINTS;
use serde::Serialize;

use super::print;
use crate::failure::{Failure, say};

/// The draft as a document.
#[derive(Serialize)]
struct Draft {
    joints: usize,
    toml: String,
}

pub fn import(urdf: &str, locks: &[(String, f64)], json: bool) -> Result<(), Failure> {
    let io::Import { toml, joints, warnings } = io::import(urdf, locks)?;
    say(&warnings);
    if joints > MAX_JOINTS {
        return Err(Failure::input(
            "joints",
            format!("{joints} joints move; this program is built for at most {MAX_JOINTS}"),
            "hold some of them still: --lock JOINT=POSITION, once for each",
        ));
    }
    if json { print::json(&Draft { joints, toml }) } else { print::text(&toml) }
}
