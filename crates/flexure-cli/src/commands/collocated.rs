//! A loop that was moved by steps of the midpoint rule, beside what it is by collocation: nobody estimates the errors of those steps, and their
//! energy balance is exact however large they are.

use flexure::files::number::engineering;
use flexure::files::{Problem, Problems};
use flexure::progress::Progress;
use flexure::scenario::{Integration, Scenario};
use flexure::simulate::{Criteria, Summary, measure_watched};
use flexure::units::{ANGLE, TORQUE, of_joints};
use serde::Serialize;

/// What collocation makes of a loop.
#[derive(Serialize)]
pub struct Collocated {
    /// Whether it follows its reference.
    pub follows: bool,
    /// Largest |q_l − q_ld| in rad.
    pub max_abs_e_l: f64,
    /// Largest |u_m| [N m].
    pub max_abs_u_m: f64,
}

impl Collocated {
    /// Of `scenario`, if it asks for midpoint steps where it need not.
    ///
    /// # Errors
    /// As [`measure_watched`], and of criteria that cannot be made.
    pub fn of(scenario: &Scenario, progress: Progress<'_>) -> Result<Option<Self>, Problems> {
        if scenario.integration != Integration::Midpoint || scenario.is_rough() {
            return Ok(None);
        }
        let scenario = scenario.by_collocation();
        let Summary { following, max_abs_e_l, max_abs_u_m, .. } =
            measure_watched(&scenario, &Criteria::of(&scenario)?, progress)?.summary;
        Ok(Some(Self { follows: following.follows, max_abs_e_l, max_abs_u_m }))
    }

    /// What it says beside `summary`, of the run by midpoint steps.
    pub fn line(&self, summary: &Summary) -> String {
        let answer = if self.follows { "yes" } else { "no" };
        let [angle, torque] = [ANGLE, TORQUE].map(|unit| of_joints(unit, "", &summary.kinds));
        format!(
            "by collocation, midpoint steps in brackets: max |e_l| {} ({}) {angle}, max |u_m| {} ({}) {torque}; follows its reference: {answer}",
            engineering(self.max_abs_e_l),
            engineering(summary.max_abs_e_l),
            engineering(self.max_abs_u_m),
            engineering(summary.max_abs_u_m)
        )
    }

    /// That the two disagree on whether `scenario` follows, if they do.
    pub fn disagreement(&self, scenario: &Scenario, summary: &Summary) -> Option<Problem> {
        let does = |follows: bool| if follows { "follows" } else { "does not follow" };
        let message = format!(
            "{}: the loop {} by midpoint steps and {} by collocation: the steps are too long for it",
            scenario.name,
            does(summary.following.follows),
            does(self.follows)
        );
        let help = "remove integration = \"midpoint\": numbers of this run are not to be relied on";
        (self.follows != summary.following.follows)
            .then(|| scenario.places.problem("integration", "midpoint", message, help))
    }
}
