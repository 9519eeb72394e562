//! `flexure excite`: the motion that tells most about a robot's joints.

use std::path::PathBuf;

use flexure::excite::{Excitation, Settings, excite as designed, spare_out};
use flexure::files::number::duration;
use flexure::files::{Outside, folder_of, prepare, write_atomic};
use flexure::report::excitation_table;
use serde::Serialize;

use super::print;
use crate::args::Excite;
use crate::failure::Failure;
use crate::progress::Progress;

#[derive(Serialize)]
struct Outcome<'a> {
    #[serde(flatten)]
    found: &'a Excitation,
    file: &'a PathBuf,
}

pub fn excite(options: &Excite, outside: Outside, json: bool) -> Result<(), Failure> {
    let settings = Settings {
        duration: options.duration,
        control_period: options.control_period,
        budget: options.budget,
        seed: options.seed,
        posture: options.posture.clone(),
        link_resolution: (!options.motor_only).then_some(options.link_resolution),
        motor_resolution: options.motor_resolution,
    };
    let stem = PathBuf::from(&options.robot).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let beside =
        || PathBuf::from(&options.robot).with_file_name(format!("{}-excite.toml", stem.unwrap_or_default()));
    let out = options.out.clone().unwrap_or_else(beside);
    spare_out(&out, &options.robot)?;
    prepare(folder_of(&out))?;
    let found = {
        let progress = Progress::of_one(&options.robot);
        designed(&options.robot, &out, outside, &settings, &|fraction| progress.set(0, fraction))?
    };
    write_atomic(&out, |file| file.write_all(found.toml.as_bytes()))?;
    if json {
        print::json(&Outcome { found: &found, file: &out })?;
    } else {
        print::line(&excitation_table(&found))?;
        print::line(&format!(
            "error bars: three standard deviations that the Cramér–Rao bound leaves from a log of two periods of {}, if the robot\n\
             is as its file says: linear joints, one by one, the others held; encoder steps as white noise, torque known to\n\
             0.1 % of its limit; no gravity, no coupling, friction at the lines alone. A model that misses something has more",
            duration(found.period)
        ))?;
        if let Some(most) = found.usage.iter().max_by(|a, b| a.share.total_cmp(&b.share)) {
            print::line(&format!(
                "the whole arm takes {:.0} % of {} of {}, of no other limit more",
                100.0 * most.share,
                most.key,
                found.joints[most.joint].name
            ))?;
        }
        print::line(
            "simulated with these encoders and exact torques, without delay and without friction: the loop that moves the robot may need\n\
             other gains",
        )?;
        print::wrote(&[out])?;
    }
    if found.objections.is_empty() {
        return Ok(());
    }
    Err(Failure::No(found.objections.into_iter().map(Into::into).collect()))
}
