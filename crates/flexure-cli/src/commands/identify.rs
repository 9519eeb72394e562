//! `flexure identify`: the numbers of the joints from logs.

use std::path::{Path, PathBuf};

use flexure::files::number::significant;
use flexure::files::{Outside, Problem, folder_of, prepare, spare, write_atomic};
use flexure::identify::{Identified, RobotFile, Settings, identify as identified};
use flexure::logs::read_log;
use flexure::report::{identified_table, write_identified};
use serde::Serialize;

use super::{log, print};
use crate::args::Identify;
use crate::failure::{Failure, say};
use crate::progress::Progress;

#[derive(Serialize)]
struct Outcome<'a> {
    #[serde(flatten)]
    found: &'a Identified,
    /// The robot file; none if none was asked for, or the logs know nothing.
    file: Option<&'a Path>,
    /// Its page and figure; not there without `--page`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pages: Vec<PathBuf>,
}

pub fn identify(options: &Identify, outside: Outside, json: bool) -> Result<(), Failure> {
    let file = RobotFile::load(&options.robot, outside)?;
    say(&file.robot.warnings);
    let columns = log::columns(options.columns.as_deref(), &file.robot)?;
    let mut logs = Vec::new();
    for path in &options.logs {
        let (mut log, warnings) = read_log(path, &columns, &file.robot)?;
        say(&warnings);
        if options.motor_only {
            (log.q_l, log.dq_l) = (None, None);
        }
        logs.push(log);
    }
    if let Some(out) = &options.out {
        spare_out(out, &options.robot)?;
        prepare(folder_of(out))?;
        file.fits(out, outside)?;
    }
    options.paged.prepare(&file.robot.name, "identify", 1, options.out.as_slice())?;
    let settings =
        Settings { hold_out: options.hold_out, accuracy: options.accuracy, gaps: file.gaps.clone() };
    let found = {
        let progress = Progress::of_one(&file.robot.name);
        identified(&file.robot, &logs, &settings, &|fraction| progress.set(0, fraction))?
    };
    // A file with nothing new in it is not written.
    let out = options.out.as_ref().filter(|_| found.knows_something());
    if let Some(out) = out {
        let names: Vec<_> = options.logs.iter().map(|path| name(path)).collect();
        let text = file.completed(&found, &names, out, outside)?;
        write_atomic(out, |to| to.write_all(text.as_bytes()))?;
    }
    let objection = found.objection();
    let pages = match &options.paged.page {
        Some(folder) => write_identified(folder, &found, objection.as_ref(), out.map(PathBuf::as_path))?,
        None => Vec::new(),
    };
    if json {
        print::json(&Outcome { found: &found, file: out.map(PathBuf::as_path), pages })?;
    } else {
        tell(&found, out)?;
        print::wrote(&pages)?;
    }
    objection.map_or(Ok(()), |problem| Err(Failure::No(vec![problem.into()])))
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// That the result for `robot` may be written to `out`: over the file of that robot, or over one that was identified before.
fn spare_out(out: &Path, robot: &str) -> Result<(), Problem> {
    let place = |path: &Path| path.canonicalize().ok();
    if out.is_file() && place(out) == place(Path::new(robot)) {
        return Ok(());
    }
    let is_identified = |text: &str| text.contains("[links]") && text.contains("identified: ");
    spare(out, "robot file that was identified", is_identified, &[])
}

fn tell(found: &Identified, out: Option<&PathBuf>) -> Result<(), Failure> {
    print::line(&identified_table(found))?;
    print::line(
        "± three standard deviations; numbers in brackets are as they were: the log does not know them",
    )?;
    for offset in &found.offsets {
        print::line(&format!(
            "{}: torques act {:.4} ± {:.4} ms after they are logged",
            offset.log,
            1e3 * offset.value,
            1e3 * offset.error
        ))?;
    }
    for joint in &found.joints {
        let number = |x: f64| significant(x, 3);
        let link = joint.noise_ratio.link.map_or(String::new(), |link| format!("{} (link), ", number(link)));
        let held = joint.held_out.map_or(String::new(), |held| {
            format!("; held-out part of the log: {} times the squares of the fitted", number(held))
        });
        print::line(&format!(
            "{}: prediction errors {link}{} (motor) times the noise of the encoders{held}",
            joint.name,
            number(joint.noise_ratio.motor)
        ))?;
        if let Some(doubt) = &joint.doubt {
            print::line(&format!("{}: nothing of it counts as known: {doubt}", joint.name))?;
        }
    }
    print::line(&format!(
        "known least: {}; condition {} (1: nothing hides behind anything else)",
        found.weakest,
        significant(found.condition, 3)
    ))?;
    match out {
        Some(out) => print::wrote(&[out]),
        None => Ok(()),
    }
}
