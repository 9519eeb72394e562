//! A scenario with everything that comes out of it, and the experiments of the paper.

mod outputs;
mod practical;

use std::path::Path;

use rayon::prelude::*;

use crate::files::number::{engineering, small};
use crate::files::{Problem, Problems, Unfinished};
use crate::laws::VCBC;
use crate::progress::{PartProgress, Progress};
use crate::prove::question::{Direct, Proof, Question, Region, certified, prove};
use crate::prove::standing::is_about;
use crate::prove::summary::ProofSummary;
use crate::report::{
    CertificateReport, FigureOptions, Film, JointMarks, Practical, RunReport, RunsReport, Scene, Sketch,
    Ultimate, Verdict, Viewed, assumptions, comparison, pushes, run_figure, view,
};
use crate::sampled::{Sampled, probe};
use crate::scenario::{Hold, Scenario, load_scenario};
use crate::simulate::{Excerpt, LimitWatch, Run, Sink, Summary, TraceFile, run_into};

pub use outputs::{trace_file, write_certificates, write_experiment, write_report};
pub use practical::practical;

/// The experiments of the paper: each shaping function from rest off the reference, and from a smooth start; those that the paper
/// measured also with encoders and filtered velocities.
pub const REPRODUCED: [&str; 8] = [
    "two-link-tanh",
    "two-link-linear",
    "two-link-coupled-tanh",
    "two-link-tanh-smooth",
    "two-link-linear-smooth",
    "two-link-coupled-tanh-smooth",
    "two-link-tanh-sensors",
    "two-link-coupled-tanh-sensors",
];

/// A scenario that was run.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// The scenario that was run.
    pub scenario: Scenario,
    /// Its summary; the trace went elsewhere.
    pub run: Run,
    /// Whether the loop is stable that holds its torque for a control period; none for laws in continuous time.
    pub sampled: Option<Sampled>,
    /// Warnings of the limits of position, velocity and deflection that it exceeded.
    pub exceeded: Vec<Problem>,
    /// What figures show of it.
    pub sketch: Sketch,
    /// What its animation shows of it.
    pub film: Film,
    /// The figure.
    pub figure: Scene,
    /// Whether a proved bound of its errors is in the figure.
    pub proved: bool,
    /// What its errors come down to, if it has imperfections and came to its end.
    pub ultimate: Option<Ultimate>,
}

impl Experiment {
    /// Runs `scenario`, with the rows of its trace into `sinks`; `progress` is told the fraction done. Of a run that one of them breaks
    /// off nothing more is looked at.
    ///
    /// # Errors
    /// As [`run_into`].
    pub fn new(
        scenario: Scenario,
        sinks: &mut [&mut dyn Sink],
        progress: Progress<'_>,
    ) -> Result<Self, Problems> {
        let signals = scenario.signals()?;
        let (mut sketch, mut watch) = (Sketch::new(&signals), LimitWatch::new(&scenario.robot, &signals));
        let mut film = Film::new(&scenario, &signals);
        let mut all: Vec<&mut dyn Sink> = vec![&mut sketch, &mut watch, &mut film];
        for sink in sinks {
            all.push(&mut **sink);
        }
        let mut run = run_into(&scenario, &mut all, progress)?;
        let (exceeded, has_left_travel) = (watch.warnings(), watch.has_left_travel());
        let sampled = if run.broken_off.is_some() { None } else { probe(&scenario)? };
        let mut decay = None;
        if run.broken_off.is_none()
            && !has_left_travel
            && is_about(&scenario, sampled.as_ref())
            && let Some((certificate, proved)) = certified(&scenario)?
        {
            run.summary.rate_certified = certificate.contraction_rate.map(|rate| rate.approximate());
            decay = proved;
        }
        let ended = match (run.divergence, run.broken_off) {
            (Some(divergence), _) => format!("; diverged at t = {:.3} s", divergence.time),
            (None, Some(time)) => format!("; broken off at t = {time:.3} s"),
            (None, None) => String::new(),
        };
        let subtitle = describe(&scenario) + &ended;
        let proved = decay.is_some();
        let ultimate = Ultimate::of(&scenario, &run, &sketch);
        let options = FigureOptions {
            title: scenario.name.clone(),
            subtitle,
            joints: JointMarks::of(&scenario),
            happenings: pushes(&scenario),
            settled: run.summary.settling_time,
            decay,
            held: scenario.hold == Hold::ZeroOrder,
            ultimate: ultimate.clone(),
        };
        let figure = run_figure(&sketch, &options);
        Ok(Self { scenario, run, sampled, exceeded, sketch, film, figure, proved, ultimate })
    }
}

/// The experiments whose rates are proved in the report: one for each shaping function.
pub const CERTIFIED: [&str; 3] = ["two-link-tanh", "two-link-linear", "two-link-coupled-tanh"];

/// What is asked of them: position errors of up to 3 rad, as far as the arm turns, and both engines.
fn question(scenario: &Scenario) -> Question {
    let errors = vec![3.0; 2 * scenario.robot.joint_count()];
    Question { region: Region::Errors(errors), direct: Some(Direct { budget: 1000 }), ..Question::default() }
}

/// A proof, and what it is about.
#[derive(Clone, Debug)]
pub struct Certified {
    /// The scenario.
    pub scenario: Scenario,
    /// Rates, region and certificate.
    pub proof: Proof,
    /// Its sampled loop.
    pub sampled: Option<Sampled>,
}

impl Certified {
    /// The proof at a glance.
    pub fn summary(&self) -> ProofSummary {
        ProofSummary::new(&self.scenario, &self.proof, self.sampled.clone())
    }
}

/// Proves the rates of the paper's experiments.
///
/// # Errors
/// If a built-in file is broken.
pub fn certificates() -> Result<Vec<Certified>, Problems> {
    CERTIFIED
        .par_iter()
        .map(|name| {
            let scenario = load_scenario(name)?;
            let proof = prove(&scenario, &question(&scenario))?;
            let sampled = probe(&scenario)?;
            Ok(Certified { scenario, proof, sampled })
        })
        .collect()
}

/// One line about a scenario.
fn describe(scenario: &Scenario) -> String {
    let rise = scenario.time_scaling.and_then(|scaling| scaling.rise);
    let start = match (scenario.smooth_start, rise) {
        (Some(start), _) => format!("smooth start over {} s", start.duration),
        (None, Some(rise)) => format!("from rest, up to speed in {rise} s"),
        (None, None) => "no smooth start".to_owned(),
    };
    let hold = match scenario.hold {
        Hold::ZeroOrder => format!("torque held for {} ms", 1e3 * scenario.control_period),
        Hold::Continuous => "continuous control".to_owned(),
    };
    let conditions = scenario.conditions();
    let unknown =
        if conditions.is_empty() { String::new() } else { format!("; with {}", conditions.join(", ")) };
    let law = scenario.controller.in_words();
    format!("{} under {law}; {start}; {hold}{}", scenario.robot.name, unknown.replace('_', " "))
}

/// What the plant has that the law does not know, from the keys of `[plant]`.
fn unknown(options: &[&str]) -> Option<String> {
    (!options.is_empty()).then(|| format!("unknown to the law: {}", options.join(", ").replace('_', " ")))
}

/// Runs the experiments of the paper, on all cores, with their traces on the way into `folder`. `progress` is told the number of the
/// experiment and the fraction of it that is done; what it breaks off are runs that end there.
///
/// # Errors
/// If a built-in file is broken, or a trace cannot be written.
pub fn reproduce(
    folder: &Path,
    progress: PartProgress<'_>,
) -> Result<Vec<(Experiment, TraceFile)>, Unfinished> {
    REPRODUCED
        .par_iter()
        .enumerate()
        .map(|(i, name)| {
            let scenario = load_scenario(name)?;
            let mut trace = trace_file(folder, &scenario, Excerpt::whole(&scenario.signals()?))?;
            let experiment = Experiment::new(scenario, &mut [&mut trace], &|fraction| progress(i, fraction))?;
            Ok((experiment, trace.sound()?))
        })
        .collect()
}

/// The report of some experiments: those that join their reference smoothly first, with their rates; those from rest, and those with
/// imperfections, are warnings.
///
/// # Errors
/// As [`Scenario::open`].
pub fn report(
    experiments: &[Experiment],
    certificates: &[Certified],
    practical: &[Practical],
) -> Result<RunsReport, Problems> {
    let smooth = || experiments.iter().filter(|experiment| experiment.scenario.smooth_start.is_some());
    let sketches: Vec<_> = smooth().map(|e| (e.scenario.name.as_str(), &e.sketch)).collect();
    let verdict = verdict_of(experiments, certificates);
    let shown: Vec<(&Experiment, String)> = smooth()
        .filter(|e| SHOWN.contains(&e.scenario.name.as_str()))
        .map(|e| (e, e.run.summary.in_words()))
        .collect();
    let viewed: Vec<Viewed<'_>> = shown.iter().map(|(e, words)| e.viewed(Some(e.is_good()), words)).collect();
    Ok(RunsReport {
        title: "Virtual-contraction control of a flexible-joint robot".to_owned(),
        motion: if viewed.is_empty() { None } else { Some(view(&viewed)?.0) },
        verdict: Some(verdict),
        introduction: INTRODUCTION.to_owned(),
        runs: experiments.iter().map(run_report).collect(),
        comparison_svg: (!sketches.is_empty()).then(|| comparison(&sketches).svg()),
        certificates: certificates.iter().map(certificate_report).collect(),
        practical: practical.to_vec(),
        assumptions: assumptions(experiments.iter().map(|experiment| &experiment.scenario)),
        provenance: vec![
            format!("flexure {}", env!("CARGO_PKG_VERSION")),
            "No random numbers: the same build writes the same page, byte for byte, on any number of threads."
                .to_owned(),
        ],
    })
}

/// The run that moves in the report.
const SHOWN: [&str; 1] = ["two-link-tanh-smooth"];

/// What came of the runs that join their reference smoothly, what the others take, what those with imperfections come down to, and what
/// was proved of their laws.
fn verdict_of(experiments: &[Experiment], certificates: &[Certified]) -> Verdict {
    let (ideal, real): (Vec<&Experiment>, Vec<&Experiment>) =
        experiments.iter().partition(|experiment| experiment.scenario.imperfections.is_empty());
    let (smooth, from_rest): (Vec<&Experiment>, Vec<&Experiment>) =
        ideal.into_iter().partition(|experiment| experiment.scenario.smooth_start.is_some());
    let largest = |runs: &[&Experiment], of: fn(&Summary) -> f64| {
        runs.iter().map(|experiment| of(&experiment.run.summary)).fold(0.0, f64::max)
    };
    let follow = smooth.iter().filter(|experiment| experiment.is_good()).count();
    let rates = certificates.iter().filter_map(|certified| {
        let rate = certified.summary().contraction_rate?;
        Some(format!("{} {} 1/s", certified.scenario.controller.phi().unwrap_or_default(), engineering(rate)))
    });
    let rates: Vec<String> = rates.collect();
    let (error, prefix) = small(largest(&smooth, |summary| summary.max_abs_e_l));
    let bounds: Vec<String> = real.iter().filter_map(|experiment| experiment.comes_down_to()).collect();
    let practical = if bounds.is_empty() {
        String::new()
    } else {
        format!(
            " With encoders and filtered velocities link errors come down to a bound: {}.",
            bounds.join(", ")
        )
    };
    let words = format!(
        "{follow} of {} runs that join the reference smoothly follow it: link errors of {} {prefix}rad at most, torques of {} N m. The {} from rest \
         off it take up to {} N m.{practical} Proved contraction rates for position errors of up to 3 rad, in continuous time: {}.",
        smooth.len(),
        error,
        engineering(largest(&smooth, |summary| summary.max_abs_u_m)),
        from_rest.len(),
        engineering(largest(&from_rest, |summary| summary.max_abs_u_m)),
        if rates.is_empty() { "none".to_owned() } else { rates.join(", ") }
    );
    let good =
        follow == smooth.len() && rates.len() == certificates.len() && real.iter().all(|run| run.is_good());
    Verdict { good: Some(good), words }
}

impl Experiment {
    /// Whether it follows its reference, in a loop that is stable as it is sampled.
    pub fn is_good(&self) -> bool {
        let Run { summary, divergence, .. } = &self.run;
        divergence.is_none()
            && summary.following.follows
            && self.sampled.as_ref().is_none_or(|loop_| loop_.stable)
    }

    /// Its shaping function and its ultimate bound, if it has one.
    fn comes_down_to(&self) -> Option<String> {
        let links = self.ultimate.as_ref()?.links.iter().copied().fold(0.0, f64::max);
        let (error, prefix) = small(links);
        Some(format!("{} {error} {prefix}rad", self.scenario.controller.phi().unwrap_or_default()))
    }

    /// For its animation: whether it is good, if that is known, and what came of it in a sentence.
    pub fn viewed<'a>(&'a self, good: Option<bool>, words: &'a str) -> Viewed<'a> {
        Viewed {
            scenario: &self.scenario,
            run: &self.run,
            film: &self.film,
            sketch: &self.sketch,
            good,
            words,
        }
    }
}

const INTRODUCTION: &str = "The experiments of Reyes-Báez, van der Schaft, Jayawardhana and Pan, “A family of virtual \
    contraction based controllers for tracking of flexible-joints port-Hamiltonian robots: theory and experiments”, \
    in simulation: a planar two-link arm with elastic joints follows sin t on both joints under the three shaping \
    functions of the paper. Each runs twice: from rest at zero, where the reference already moves at 1 rad/s, and \
    with a reference that joins the sine smoothly from rest. The two that the paper measured on the arm run once more with \
    encoders and a velocity filter: there it found practical convergence.";

fn certificate_report(certified: &Certified) -> CertificateReport {
    let scenario = &certified.scenario;
    CertificateReport {
        summary: certified.summary(),
        phi: scenario.controller.phi().unwrap_or_default().to_owned(),
        file: Some(certificate_name(&scenario.name)),
    }
}

/// Name of the certificate file of a scenario.
pub fn certificate_name(scenario: &str) -> String {
    format!("{scenario}.certificate.json")
}

fn run_report(experiment: &Experiment) -> RunReport {
    RunReport {
        summary: experiment.run.summary.clone(),
        figure_svg: experiment.figure.svg(),
        description: outcome(&experiment.run.summary),
        warning: match (experiment.scenario.smooth_start, &experiment.ultimate) {
            (None, _) => Some(from_rest(experiment)),
            (Some(_), Some(_)) => Some(noisy(&experiment.run.summary)),
            (Some(_), None) => None,
        },
    }
}

/// What is to be minded of a run from rest off a reference that moves.
fn from_rest(Experiment { scenario, run, .. }: &Experiment) -> String {
    let is_limited = scenario.drive_limits().is_some() || scenario.guard.is_some();
    format!(
        "the arm starts at rest and its reference already moves. The law answers at once, with up to {} N m: {}.",
        engineering(run.summary.max_abs_u_m),
        if is_limited {
            "what its drives and its guard let through"
        } else {
            "nothing limits torques here, and such a start shows what the formulas do, not what a drive could"
        }
    )
}

/// What is to be minded of a run with imperfections.
fn noisy(summary: &Summary) -> String {
    format!(
        "the torque changes by {} N m from one control instant to the next, root mean square, and goes up to {} N m: nothing limits torques here, and \
         such noise shows what the gains make of the readings, not what a drive could. Nothing is proved of this loop.",
        engineering(summary.rms_torque_change),
        engineering(summary.max_abs_u_m)
    )
}

/// Whether a run follows, why not, and what it was held to.
fn verdict(summary: &Summary) -> String {
    let following = &summary.following;
    let reasons: Vec<&str> = following.reasons.iter().map(|reason| reason.words.as_str()).collect();
    let answer = match reasons.as_slice() {
        [] => "It follows its reference".to_owned(),
        reasons => format!("It does not follow its reference: {}", reasons.join("; ")),
    };
    format!("{answer}. Accepted are {}.", following.accepted.words(&summary.kinds).join("; "))
}

/// What a run came to, in a sentence.
fn outcome(summary: &Summary) -> String {
    let law = if summary.controller == VCBC { format!("φ = {}", summary.law()) } else { summary.law() };
    let unknown = unknown(&summary.plant).map(|unknown| format!("; {unknown}")).unwrap_or_default();
    format!("{law}: {}{unknown}. {}", summary.in_words(), verdict(summary))
}
