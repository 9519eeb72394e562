//! What is to be said against a run: that it diverged, is not stable as it is sampled, or does not follow.

use flexure::files::Problem;
use flexure::files::number::short;
use flexure::imperfections::Imperfection;
use flexure::reproduce::Experiment;
use flexure::sampled::Sampled;
use flexure::simulate::Cause;

/// What to say of a loop that diverged, that is not stable as it is sampled, or that does not follow its reference.
pub fn objections(experiment: &Experiment) -> Vec<Problem> {
    if let Some(problem) = diverged(experiment) {
        return vec![problem];
    }
    let Experiment { scenario, sampled, .. } = experiment;
    // Why comes before what.
    let unstable = sampled.as_ref().and_then(|sampled| sampled.problem(scenario));
    unstable.into_iter().chain(lost(experiment)).collect()
}

/// Reasons that are told; the others are in the JSON.
const TOLD: usize = 4;

/// What to say of a loop that does not follow its reference.
fn lost(experiment: &Experiment) -> Option<Problem> {
    let Experiment { scenario, run, .. } = experiment;
    let reasons = &run.summary.following.reasons;
    let told: Vec<_> = reasons.iter().take(TOLD).map(|reason| reason.words.as_str()).collect();
    let more = match reasons.len().saturating_sub(TOLD) {
        0 => String::new(),
        more => format!(";\nand {more} more: `flexure run --json` has all of them"),
    };
    let message = format!("{}: the loop does not follow: {}{more}", scenario.name, told.join(";\n"));
    (!told.is_empty()).then(|| scenario.places.problem("reference", "lost", message, of_lost(experiment)))
}

/// What a loop may be lost by.
fn of_lost(Experiment { scenario, run, .. }: &Experiment) -> String {
    let lies = |imperfection: &Imperfection| ["dropout", "freeze", "jump"].contains(&imperfection.kind());
    if let Some(first) = run.faults.as_ref().and_then(|faults| faults.stops.first()) {
        let joint = first.joint.and_then(|joint| scenario.robot.joints.get(joint as usize));
        let at = match (first.side, joint) {
            (Some(side), Some(joint)) => format!(", {side} side of joint {}", joint.name),
            _ => String::new(),
        };
        return format!(
            "the guard stopped the robot at t = {} s: {}{at}; the columns `phase` and `fault` of the trace and `faults` of \
             `flexure run --json` tell the rest",
            short(first.time, 4),
            first.cause
        );
    }
    if scenario.guard.is_none() && scenario.imperfections.iter().any(lies) {
        return "readings fail in this loop and nothing looks at them: add [guard]".to_owned();
    }
    "what is accepted stands in [accept], or follows from the robot's limits and the reference; slower references and smooth starts \
     take less"
        .to_owned()
}

/// What to say of a loop that diverged.
fn diverged(experiment: &Experiment) -> Option<Problem> {
    let Experiment { scenario, run, sampled, .. } = experiment;
    run.divergence.map(|divergence| {
        let code = match divergence.cause {
            Cause::Unbounded => "diverged",
            Cause::Torque => "no-torque",
            Cause::Unsolvable => "unsolvable",
        };
        let unstable = sampled.as_ref().filter(|sampled| !sampled.stable);
        let hint = unstable
            .and_then(Sampled::help)
            .unwrap_or_else(|| of_large_signals(experiment, divergence.cause));
        let message = match unstable {
            Some(sampled) => format!("{}: {divergence}; {}", scenario.name, sampled.line()),
            None => format!("{}: {divergence}", scenario.name),
        };
        scenario.places.problem("control_period", code, message, hint + "; outputs end where the loop does")
    })
}

/// What may be wrong where small errors shrink.
fn of_large_signals(Experiment { scenario, sampled, .. }: &Experiment, cause: Cause) -> String {
    let small = match sampled {
        Some(_) => {
            "small errors shrink where the loop was looked at: it is the large ones, or what stands between law and robot; "
        }
        None => "",
    };
    let join = match scenario.smooth_start {
        Some(_) => "",
        None => "join the reference smoothly with [reference.smooth_start]; ",
    };
    let look = match cause {
        Cause::Unbounded => "look at limits, delays and noise",
        Cause::Torque => return "a sensor that drops out reads NaN: add [guard]".to_owned(),
        Cause::Unsolvable => {
            "check that the reference has four continuous derivatives; a shorter control_period, slower gains"
        }
    };
    format!("{small}{join}{look}")
}
