//! Many runs for their figures alone, side by side.

use rayon::prelude::*;

use crate::files::Problems;
use crate::lanes::WIDTH;
use crate::progress::PartProgress;
use crate::scenario::Scenario;
use crate::simulate::course::Course;
use crate::simulate::criteria::Criteria;
use crate::simulate::held::opened_together;
use crate::simulate::in_step::{self, InStep};
use crate::simulate::run::{Run, measure_watched};

/// A scenario to run, and what its run is held to.
pub type Job<'a> = (&'a Scenario, &'a Criteria);

/// Simulates scenarios for their figures alone, as [`measure_watched`] each, those that are alike several to a SIMD register
/// ([`SIDE_BY_SIDE`]). What comes of one does not depend on the others. `progress` is told the fraction done of each by its place.
///
/// Beside [`measure_watched`] numbers differ by what sines and tanh in lanes differ by, some units in the last place
/// ([`Lanes`](flexure_core::scalar::Lanes)), and by what a loop makes of that: where it is stable, by less than the integrator's tolerance.
///
/// # Errors
/// For each scenario those of [`measure_watched`].
pub fn measure_together(jobs: &[Job<'_>], progress: PartProgress<'_>) -> Vec<Result<Run, Problems>> {
    let mut done: Vec<Option<Result<Run, Problems>>> = jobs.iter().map(|_| None).collect();
    let scenarios: Vec<&Scenario> = jobs.iter().map(|(scenario, _)| *scenario).collect();
    let groups = in_step::groups(&scenarios);
    let found: Vec<_> =
        groups.into_par_iter().flat_map_iter(|group| of_group(&group, jobs, progress)).collect();
    for (place, run) in found {
        done[place] = Some(run);
    }
    let alone = |(place, (scenario, criteria)): (usize, &Job<'_>)| {
        measure_watched(scenario, criteria, &|fraction| progress(place, fraction))
    };
    let rest = done.into_par_iter().zip(jobs.par_iter().enumerate());
    rest.map(|(done, job)| done.unwrap_or_else(|| alone(job))).collect()
}

/// The runs of the jobs at the places of a group, with their places.
fn of_group(
    group: &[usize],
    jobs: &[Job<'_>],
    progress: PartProgress<'_>,
) -> Vec<(usize, Result<Run, Problems>)> {
    let opened = match opened_together(group.iter().map(|&place| (place, jobs[place].0)).collect()) {
        Ok(opened) => opened,
        Err(problems) => return group.iter().map(|&place| (place, Err(problems.clone()))).collect(),
    };
    let refused = opened.refused.into_iter().map(|(place, problems)| (place, Err(problems)));
    let run = opened.groups.into_iter().flat_map(|(places, mut loops)| {
        let runs = moved(&places, &mut *loops, jobs, progress);
        places.into_iter().zip(runs)
    });
    refused.chain(run).collect()
}

/// How many runs go side by side at most: numbers to a register of the processor that this is compiled for.
pub const SIDE_BY_SIDE: usize = WIDTH;

/// Moves the loops of the jobs at `places` from beginning to end.
fn moved(
    places: &[usize],
    loops: &mut dyn InStep,
    jobs: &[Job<'_>],
    progress: PartProgress<'_>,
) -> Vec<Result<Run, Problems>> {
    let course = |(lane, &place): (usize, &usize)| {
        let (scenario, criteria) = jobs[place];
        Course::new(scenario, loops.lane(lane), criteria)
    };
    let mut courses: Vec<Course<'_>> = places.iter().enumerate().map(course).collect();
    loop {
        let going = std::array::from_fn(|lane| courses.get(lane).is_some_and(Course::goes_on));
        if !going.contains(&true) {
            break;
        }
        loops.step(going);
        for (lane, course) in courses.iter_mut().enumerate().filter(|(lane, _)| going[*lane]) {
            if let Some(divergence) = loops.divergence(lane) {
                course.diverge(divergence);
            } else if progress(
                places[lane],
                course.record(|observed| loops.observe(lane, observed), f64::NAN),
            )
            .is_break()
            {
                course.break_off();
            }
        }
    }
    loops.settle();
    let finished = |(lane, course): (usize, Course<'_>)| {
        let run = course.run(loops.lane(lane));
        if run.broken_off.is_some() { Err(Problems::interrupted()) } else { Ok(run) }
    };
    courses.into_iter().enumerate().map(finished).collect()
}
