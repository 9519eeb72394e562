//! How position errors shrink, as a certificate says.

use crate::prove::engine::certificate::Certificate;
use crate::prove::engine::number::Number;
use crate::prove::question::inside;

/// W up to here is the rounding of a start on the reference, in J: nothing shrinks from there.
pub(crate) const ROUNDING: f64 = 1e-15;

/// Bounds of the position errors of the law in continuous time: |q̃_i(t)| ≤ √(2 W(0) / π_i) e^(−rate t) with the diagonal π of the metric, because
/// W is a sum of squares that has ½ π_i q̃_i² in it, and √W decays at the convergence rate.
#[derive(Clone, Debug, PartialEq)]
pub struct Decay {
    /// At the start, of the links in rad.
    pub links: Vec<f64>,
    /// At the start, of the motors in rad.
    pub motors: Vec<f64>,
    /// Proved convergence rate [1/s].
    pub rate: f64,
}

impl Decay {
    /// From a start with W ≤ `start` J; none from the reference itself, from outside of the invariant set, or where nothing decays.
    pub(crate) fn of(certificate: &Certificate, start: f64) -> Option<Self> {
        let rate = certificate.convergence_rate.approximate();
        let decays = start > ROUNDING && rate > 0.0 && inside(certificate, start);
        let largest =
            |metric: &[Number]| metric.iter().map(|pi| (2.0 * start / pi.approximate()).sqrt()).collect();
        let law = &certificate.controller;
        decays.then(|| Self { links: largest(&law.link.metric), motors: largest(&law.motor.metric), rate })
    }
}

#[cfg(test)]
mod tests {
    use crate::progress::unwatched;
    use crate::prove::question::certified;
    use crate::scenario::{Hold, load_scenario};
    use crate::simulate::run;

    /// Errors of the law in continuous time stay under what is proved of them, and under nothing that is twenty times faster.
    #[test]
    fn errors_stay_under_their_bounds() {
        for name in ["two-link-tanh", "two-link-linear", "two-link-coupled-tanh"] {
            let mut scenario = load_scenario(name).expect("built in");
            scenario.hold = Hold::Continuous;
            let (_, decay) = certified(&scenario).expect("a level set").expect("proved");
            let decay = decay.expect("off the reference, and inside");
            let trace = run(&scenario, &unwatched).expect("runs").trace;
            let t = trace.column("t").expect("always there");
            let stays = |factor: f64| {
                [("e_l", &decay.links), ("e_m", &decay.motors)].into_iter().all(|(prefix, starts)| {
                    trace.joints(prefix).into_iter().zip(starts).all(|(errors, start)| {
                        // Further down the integrator's tolerance is what is left.
                        let mut above = t.iter().zip(errors).filter(|(_, e)| e.abs() > 1e-7 * start);
                        above.all(|(t, e)| e.abs() <= start * (-factor * decay.rate * t).exp() * (1.0 + 1e-9))
                    })
                })
            };
            assert!(stays(1.0), "{name}");
            assert!(!stays(20.0), "{name}: a rate that nobody proved");
        }
    }

    #[test]
    fn nothing_decays_from_the_reference_itself() {
        let scenario = load_scenario("two-link-tanh-smooth").expect("built in");
        let proved = certified(&scenario).expect("a level set");
        assert!(proved.is_some_and(|(_, decay)| decay.is_none()));
    }
}
