//! The experiments as the paper measured them: how far they converge, and why no farther.

use rayon::prelude::*;

use crate::files::Problems;
use crate::imperfections::{Imperfection, Side};
use crate::progress::unwatched;
use crate::report::{Practical, Sketch, Ultimate};
use crate::reproduce::Experiment;
use crate::scenario::Scenario;
use crate::simulate::run_into;

/// How far those of `experiments` converge that have imperfections; with each imperfection alone they run once more.
///
/// # Errors
/// As [`run_into`].
pub fn practical(experiments: &[Experiment]) -> Result<Vec<Practical>, Problems> {
    let of = |experiment: &Experiment| {
        let Experiment { scenario, ultimate, .. } = experiment;
        ultimate.clone().map(|ultimate| with_each(scenario, ultimate))
    };
    experiments.par_iter().filter_map(of).collect()
}

/// Of a scenario whose errors come down to `ultimate`.
fn with_each(scenario: &Scenario, ultimate: Ultimate) -> Result<Practical, Problems> {
    let steps = scenario.imperfections.iter().find_map(|imperfection| match imperfection {
        Imperfection::Encoder(encoder) => encoder.resolution(Side::Link),
        _ => None,
    });
    let alone = scenario
        .imperfections
        .iter()
        .map(|imperfection| Ok((imperfection.kind(), alone(scenario, imperfection)?)));
    let alone: Vec<_> = alone.collect::<Result<_, Problems>>()?;
    Ok(Practical {
        name: scenario.name.clone(),
        phi: scenario.controller.phi().unwrap_or_default().to_owned(),
        joints: scenario.robot.joints.iter().map(|joint| joint.name.clone()).collect(),
        steps: steps.unwrap_or_default().to_vec(),
        ultimate,
        alone: alone.into_iter().filter_map(|(kind, ultimate)| Some((kind, ultimate?))).collect(),
    })
}

/// What errors come down to with no other imperfection; none if the loop diverges.
fn alone(scenario: &Scenario, imperfection: &Imperfection) -> Result<Option<Ultimate>, Problems> {
    let mut scenario = scenario.clone();
    scenario.imperfections = vec![imperfection.clone()];
    let mut sketch = Sketch::new(&scenario.signals()?);
    let run = run_into(&scenario, &mut [&mut sketch], &unwatched)?;
    Ok(Ultimate::of(&scenario, &run, &sketch))
}
