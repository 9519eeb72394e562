//! With which delay motions near the run are proved to come closer.

use serde::Serialize;

use crate::files::Problems;
use crate::files::number::rounded_down;
use crate::margins::{Change, Margins, edge};
use crate::progress::Progress;
use crate::prove::fitting::tube_extents;
use crate::prove::sampled_data::{sampled_tube, suitable_when_sampled};
use crate::scenario::Scenario;

/// The largest delay of a bisection with which there is a tube of the sampled loop. Of delays between those that were tried nothing is proved.
#[derive(Clone, Debug, Serialize)]
pub struct ProvedDelay {
    /// How far links reach in the tube at the start, in rad.
    pub error: Vec<f64>,
    /// The largest delay added, of those that were tried, with which there is one, in s, of four digits; none if there is no tube of the loop as it is.
    pub holds: Option<f64>,
    /// It as a part of that which the loop bears in simulation.
    pub part: Option<f64>,
    /// How fast motions come closer with it, in every control period [1/s].
    pub rate: Option<f64>,
    /// Why there is none with the next one that was tried, or at all.
    pub at: Option<String>,
    /// Delays that were tried.
    pub tried: usize,
}

/// Whether a tube that links reach so many rad in, one number or one per link, may be asked for: before minutes of search, not after.
///
/// # Errors
/// If `error` does not fit, or tubes do not speak of such a loop.
pub fn check_tube(scenario: &Scenario, error: &[f64]) -> Result<(), Problems> {
    tube_extents(error.to_vec(), scenario.robot.joint_count())?;
    suitable_when_sampled(scenario)
}

impl Margins {
    /// Looks for the largest delay, up to that which the loop of `scenario` bears in simulation, with which motions that start in a tube around the run stay there and come
    /// closer; links reach so many rad in it, one number, or one per link.
    ///
    /// # Errors
    /// As [`sampled_tube`], and if `error` does not fit.
    pub fn prove_delay(
        &mut self,
        scenario: &Scenario,
        error: &[f64],
        progress: Progress<'_>,
    ) -> Result<(), Problems> {
        let error = tube_extents(error.to_vec(), scenario.robot.joint_count())?;
        let mut found = ProvedDelay { error, holds: None, part: None, rate: None, at: None, tried: 1 };
        let Some(as_it_is) = sampled_tube(scenario, &found.error, progress)? else {
            self.broken_off = true;
            return Ok(());
        };
        match as_it_is {
            Err(none) => found.at = Some(none.at),
            Ok(tube) => {
                (found.holds, found.rate) = (Some(0.0), Some(tube.rate));
                let first = 0.125 * scenario.control_period;
                let last = match self.delay {
                    edge::Edge::Between { fails, .. } => fails,
                    edge::Edge::Beyond { holds } | edge::Edge::Open { holds } => holds,
                    edge::Edge::Nowhere => 0.0,
                };
                let mut search = edge::Way::outward(0.0, first.min(last), last).search();
                while let Some((delay, stage)) = search.next().filter(|_| last > 0.0) {
                    let delay = rounded_down(delay, 4);
                    let later = Change::Delay(delay).of(scenario);
                    let told = |fraction| progress(stage.fraction(fraction));
                    let Some(tube) = sampled_tube(&later, &found.error, &told)? else {
                        self.broken_off = true;
                        break;
                    };
                    found.tried += 1;
                    search.tell(tube.is_ok());
                    match tube {
                        Ok(tube) => (found.holds, found.rate) = (Some(delay), Some(tube.rate)),
                        Err(none) => found.at = Some(none.at),
                    }
                }
            }
        }
        found.part = found.holds.zip(self.delay.holds()).map(|(proved, borne)| proved / borne);
        self.delay_proved = Some(found);
        Ok(())
    }
}
