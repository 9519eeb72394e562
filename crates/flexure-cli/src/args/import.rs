//! Arguments of `import`.

use std::path::PathBuf;

use clap::Args;
use flexure::robot::DriveClass;

#[derive(Debug, Args)]
pub struct Import {
    /// URDF file.
    pub urdf: String,
    /// Hold a joint still at a position, rad or m; may be given several times.
    #[arg(long, value_name = "JOINT=POSITION", value_parser = lock)]
    pub lock: Vec<(String, f64)>,
    /// Class of drives, of `flexure list drives`, that stands in for what a URDF does not say; listed as assumed.
    #[arg(long, value_name = "DRIVES", value_parser = drives)]
    pub assume: Option<&'static DriveClass>,
    /// Limits of zero, and ranges without width, stand for what nobody knew: take them as none instead of refusing them.
    #[arg(long)]
    pub unknown_limits: bool,
    /// Draft a scenario, too: files instead of standard output.
    #[arg(long)]
    pub scenario: bool,
    /// Folder for NAME.toml and NAME-scenario.toml, or the robot file, PATH.toml; default with --scenario: the current folder.
    #[arg(long, value_name = "PATH")]
    pub out: Option<PathBuf>,
    /// Replace files that exist.
    #[arg(long)]
    pub force: bool,
}

/// The name of a class of drives.
fn drives(name: &str) -> Result<&'static DriveClass, String> {
    DriveClass::named(name).map_err(|problem| format!("{problem}; {}", problem.hint()))
}

/// `JOINT=POSITION`.
fn lock(text: &str) -> Result<(String, f64), String> {
    let (name, position) =
        text.rsplit_once('=').ok_or("write it as JOINT=POSITION, for instance finger=0.0")?;
    match position.trim().parse() {
        Ok(position) if f64::is_finite(position) => Ok((name.trim().to_owned(), position)),
        _ => Err(format!("the position is '{position}', must be a number in rad or m")),
    }
}
