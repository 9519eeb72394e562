//! What commands that read logs share.

use flexure::Robot;
use flexure::logs::Columns;

use crate::failure::{Failure, say};

/// What the columns of the logs are called: as the map at `path` says, or as in traces without one.
pub fn columns(path: Option<&str>, robot: &Robot) -> Result<Columns, Failure> {
    let Some(path) = path else { return Ok(Columns::default()) };
    let (columns, warnings) = Columns::read(path, robot)?;
    say(&warnings);
    Ok(columns)
}
