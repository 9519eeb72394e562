//! What to say of a proof that is none, or not of everything that was asked.

use crate::files::number::{engineering, short};
use crate::files::{INTERRUPTED, Problem};
use crate::prove::along::Limit;
use crate::prove::engine::verdict::Verdict;
use crate::prove::question::Proof;
use crate::prove::within::Closer;
use crate::scenario::Scenario;

/// What may bring a proof about tolerances about.
const ASK_LESS: &str = "take gains that ask less of the model, a slower reference, or a smooth start";

/// Why none can be had.
const MANY_JOINTS: &str = "bounds over a time and all joints at once are too wide where joints are many: `flexure margins` measures what the loop bears";

impl Proof {
    /// What to say where not everything that was asked was proved, and whether that is because it is wrong.
    pub fn complaint(&self, scenario: &Scenario) -> Option<(Problem, bool)> {
        match self.found(scenario) {
            Some((problem, true)) => Some((problem, true)),
            _ if self.broken_off => {
                let message =
                    format!("{}: broken off before all that was asked was looked at", scenario.name);
                let help = "what was proved until then stands; no certificate is written";
                Some((Problem::new(INTERRUPTED, message, help), false))
            }
            found => found,
        }
    }

    /// What there is to say of what was looked at.
    fn found(&self, scenario: &Scenario) -> Option<(Problem, bool)> {
        let problem =
            |code, message: String, help: &str| scenario.places.problem("controller", code, message, help);
        match &self.verdict {
            Verdict::Proved(_) => match &self.confirmation {
                Some(Verdict::Refuted(witness)) => {
                    let message = format!(
                        "{}: the direct engine finds {:.6e} 1/s at {}, below the certified rate: one of both is wrong",
                        scenario.name, witness.rate, witness.at
                    );
                    Some((problem("contradiction", message, "do not trust the certificate; report it"), true))
                }
                Some(Verdict::Undecided(undecided))
                    if self.limits(scenario).is_none_or(|(_, wrong)| !wrong) =>
                {
                    let message = format!(
                        "{}: the direct engine did not decide within {} boxes; the certificate of the structural engine \
                         stands without it",
                        scenario.name, undecided.spent
                    );
                    Some((
                        problem(
                            "undecided",
                            message,
                            "raise --budget: built-in arms of three joints take 6000 to 36000 boxes, and each further joint multiplies that",
                        ),
                        false,
                    ))
                }
                _ => self
                    .limits(scenario)
                    .or_else(|| self.no_funnel(scenario))
                    .or_else(|| self.no_sampled_tube(scenario))
                    .or_else(|| self.tolerances(scenario)),
            },
            Verdict::Refuted(witness) => {
                let message = format!(
                    "{}: the closed loop does not contract fast enough: {} has {} 1/s in one direction",
                    scenario.name,
                    witness.block.name(),
                    engineering(witness.rate)
                );
                Some((
                    problem("refuted", message, "ask for less, raise the gains, or name a smaller region"),
                    true,
                ))
            }
            Verdict::Undecided(undecided) => {
                let message = format!("{}: not decided: {}", scenario.name, undecided.at);
                Some((problem("undecided", message, "name a smaller region, or ask for less"), false))
            }
        }
    }

    /// What to say where nothing was shown of the robots within the tolerances.
    fn tolerances(&self, scenario: &Scenario) -> Option<(Problem, bool)> {
        if matches!(self.robust, Some(Ok(_))) {
            return None;
        }
        let Some(Err(open)) = &self.within else { return None };
        let message =
            format!("{}: the robots within its tolerances are not decided: {}", scenario.name, open.at);
        let (place, way_out) = match &open.closer {
            Some(Closer { factor, key, joint, share, .. }) => (
                format!("tolerances.{key}"),
                format!(
                    "with all tolerances times {} it is proved; most of that is {key} of {}, which alone makes {:.0} % of the errors \
                     there: identify it more closely; {ASK_LESS}",
                    short(*factor, 4),
                    scenario.robot.joints[*joint].name,
                    100.0 * share
                ),
            ),
            None if open.unbounded => {
                let funnel = self.robust.as_ref().and_then(|found| found.as_ref().err());
                let funnel = funnel.map_or_else(String::new, |none| format!("; of a funnel: {}", none.at));
                ("tolerances".to_owned(), format!("{MANY_JOINTS}{funnel}"))
            }
            // Smaller ones do not help, or the start is what is wrong.
            None => ("tolerances".to_owned(), ASK_LESS.to_owned()),
        };
        let help = format!("the certificate is about the numbers of the file; {way_out}");
        Some((scenario.robot.places.problem(&place, "undecided", message, help), false))
    }

    /// What to say where a funnel was asked for and none was found.
    fn no_funnel(&self, scenario: &Scenario) -> Option<(Problem, bool)> {
        let Some(Err(open)) = self.robust.as_ref().filter(|_| self.needs_funnel) else { return None };
        let message = format!(
            "{}: nothing is decided of errors under these torques and tolerances: {}",
            scenario.name, open.at
        );
        let help = format!(
            "the rates hold without torques, of the numbers of the file; {ASK_LESS}, or ask about smaller torques or tolerances"
        );
        Some((scenario.places.problem("controller", "undecided", message, help), false))
    }

    /// What to say where a tube of the sampled loop was asked for and none was found.
    fn no_sampled_tube(&self, scenario: &Scenario) -> Option<(Problem, bool)> {
        let open = self.sampled_tube.as_ref().filter(|_| !self.climbed)?.as_ref().err()?;
        let message = format!("{}: nothing is decided of the sampled loop: {}", scenario.name, open.at);
        let help = "the rates hold in continuous time; --strongest looks for the widest that there is; `flexure margins` measures what the sampled loop bears";
        Some((scenario.places.problem("controller", "undecided", message, help), false))
    }

    /// What to say of the robot's limits where the tube may exceed them; one that it does exceed comes first.
    fn limits(&self, scenario: &Scenario) -> Option<(Problem, bool)> {
        let limits = match (&self.robust, &self.along) {
            (Some(Ok(robust)), _) => &robust.limits,
            (_, along) => &along.as_ref()?.limits,
        };
        let refuted = limits.iter().find(|limit| matches!(limit.verdict, Verdict::Refuted(_)));
        let limit = refuted.or_else(|| limits.iter().find(|limit| limit.verdict.proved().is_none()))?;
        let Limit { joint, key, limit, verdict } = limit;
        let name = &scenario.robot.joints[*joint].name;
        let (code, message) = match verdict {
            Verdict::Proved(_) => return None,
            Verdict::Refuted(state) => (
                "limit",
                format!(
                    "{key} of {name} is {limit}; at t = {:.4} s a state in the tube has {:.4}",
                    state.t, state.value
                ),
            ),
            Verdict::Undecided(undecided) => {
                ("limit", format!("{key} of {name} is not decided: {}", undecided.at))
            }
        };
        let help = "take a slower or smoother reference, lower gains, or a smaller disturbance";
        let at = format!("joints.{key}");
        Some((scenario.robot.places.problem(&at, code, message, help), refuted.is_some()))
    }
}
