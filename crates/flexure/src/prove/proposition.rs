//! The closed loop of a scenario as the prover takes it: its numbers enclosed, its region chosen.

use flexure_core::scalar::Interval;

use crate::files::{Problem, Problems};
use crate::laws;
use crate::prove::along::uneven_metric;
use crate::prove::assumptions::beyond_the_model;
use crate::prove::decimals::{gains, robot};
use crate::prove::engine::certificate::{CertifiedPhi, DecimalLaw};
use crate::prove::engine::number::Number;
use crate::prove::engine::region::{RequestedRegion, level_that_holds, region};
use crate::prove::engine::structural;
use crate::prove::question::{Question, Region};
use crate::prove::subject::subject;
use crate::scenario::Scenario;

/// The closed loop of `scenario` as the prover takes it; `start` is W where the run begins, from above, if it is known.
///
/// # Errors
/// Where no certificate can speak of it: with the place and the reason.
pub fn proposition(
    scenario: &Scenario,
    question: &Question,
    start: Option<f64>,
) -> Result<structural::Proposition, Problems> {
    let laws::VcbcGains { phi, link, motor } = scenario.vcbc()?;
    let uneven = uneven_metric(scenario);
    if let Some(problem) = uneven.clone().filter(|_| question.velocity_error.is_none()) {
        return Err(problem.into());
    }
    let phi = CertifiedPhi::named(phi.name()).ok_or_else(|| uncertified(scenario, *phi))?;
    let controller = DecimalLaw { phi, link: gains(scenario, link), motor: gains(scenario, motor) };
    let mut assumptions: Vec<String> = scenario
        .assumptions
        .iter()
        .map(|assumed| format!("{}: {} = {}: {}", assumed.file, assumed.key, assumed.value, assumed.note))
        .chain(beyond_the_model(scenario))
        .collect();
    let errors = |errors: &[f64]| errors.iter().map(|&e| Number::decimal(e)).collect::<Vec<_>>();
    let stretches = phi == CertifiedPhi::Tanh || phi == CertifiedPhi::Linear && uneven.is_some();
    if question.velocity_error.is_some() && !stretches {
        return Err(unstretched(scenario, phi).into());
    }
    if uneven.is_some() {
        assumptions.push(UNEVEN.to_owned());
    }
    let metric: Vec<_> =
        controller.link.metric.iter().chain(&controller.motor.metric).map(Number::bounds).collect();
    let region = match &question.region {
        Region::Errors(largest) => RequestedRegion::Box(errors(largest)),
        Region::Start(start) => RequestedRegion::Level(level_that_holds(&errors(start), &metric)),
        Region::Chosen if !phi.certified().has_rate_everywhere() => {
            let (request, note) = chosen(&metric, start);
            let name = phi.certified().name();
            assumptions
                .push(format!("no region was named and {name} has no rate everywhere: {note} is taken"));
            request
        }
        Region::Chosen => RequestedRegion::Everywhere,
    };
    let disturbance =
        question.disturbance.as_ref().map(|torques| torques.iter().map(|&d| Number::decimal(d)).collect());
    Ok(structural::Proposition {
        name: scenario.name.clone(),
        subject: Some(subject(scenario)),
        assumptions,
        robot: robot(&scenario.robot),
        controller,
        region,
        disturbance,
        velocity_error: question.velocity_error.as_deref().map(errors),
    })
}

/// What to say of a shaping function that no certificate speaks of.
fn uncertified(scenario: &Scenario, phi: laws::Phi) -> Problem {
    let message = format!("controller.phi is '{}', of which no certificate speaks", phi.name());
    let help =
        format!("those are of phi = {}; `flexure run` simulates any", CertifiedPhi::names().join(", "));
    scenario.places.problem("controller.phi", "unsupported", message, help)
}

/// What is said of a loop whose metric depends on the error.
const UNEVEN: &str = "Π_l grows with the error: W has the integral of ∫Π_l in place of ½ Π_l q̃_l², two solutions come together as said under \
                      stretched, and bounds along the reference, robots within tolerances and the direct engine are left out";

/// What to say where a stretched metric is asked for of a shaping function that is not flat anywhere.
fn unstretched(scenario: &Scenario, phi: CertifiedPhi) -> Problem {
    let name = phi.certified().name();
    let message = format!("a rate in a stretched metric is asked for, and controller.phi is '{name}'");
    let help = "a metric is stretched where tanh is flat; without --velocity-error, linear and coupled-tanh have a contraction rate \
                whatever the errors are";
    scenario.places.problem("controller.phi", "unsupported", message, help)
}

/// Largest error where none is named and φ has no rate everywhere \[rad\].
const ASSUMED_ERROR: f64 = 1.0;

/// The smallest level of W that holds the start, or errors of up to [`ASSUMED_ERROR`] if that is more.
fn chosen(metric: &[Interval], start: Option<f64>) -> (RequestedRegion, String) {
    let errors = vec![Number::decimal(ASSUMED_ERROR); metric.len()];
    let inside =
        region(&RequestedRegion::Box(errors.clone()), metric).level.map_or(0.0, |level| level.bounds().lo());
    match start.filter(|&start| start > inside) {
        Some(start) => (RequestedRegion::Level(start), "the level of W at the scenario's start".to_owned()),
        None => (RequestedRegion::Box(errors), format!("|q̃_i| up to {ASSUMED_ERROR} rad")),
    }
}

#[cfg(test)]
mod tests {
    use super::uncertified;
    use crate::laws;
    use crate::scenario::load_scenario;

    /// What a shaping function without a file in `engine/shaping` is refused with.
    #[test]
    fn a_shaping_function_without_certificate_is_refused_by_name() {
        let scenario = load_scenario("two-link-tanh").expect("built in");
        let problem = uncertified(&scenario, laws::Phi::Tanh);
        assert!(problem.to_string().contains("controller.phi is 'tanh', of which no certificate speaks"));
        assert!(problem.hint().contains("phi = tanh, linear, coupled-tanh"), "{}", problem.hint());
    }
}
