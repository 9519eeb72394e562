//! What position errors come down to where they do not come down to zero.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::report::Sketch;
use crate::scenario::Scenario;
use crate::simulate::Run;

/// Ultimate bounds of a run: with encoders, filters and whatever else a loop has that its law does not know, errors converge practically, to a
/// bound instead of to zero. These are measured in one run, and nothing is proved of them.
///
/// ```
/// use flexure::report::{Sketch, Ultimate};
///
/// let scenario = flexure::Scenario::load("two-link-tanh-sensors")?;
/// let mut sketch = Sketch::new(&scenario.signals()?);
/// let run = flexure::simulate::run_into(&scenario, &mut [&mut sketch], &flexure::progress::unwatched)?;
/// let ultimate = Ultimate::of(&scenario, &run, &sketch).ok_or("it has imperfections")?;
/// assert!(ultimate.from == 5.0 && ultimate.links.iter().all(|error| *error < 1e-3)); // s, rad
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ultimate {
    /// When errors count from, as in [`Criteria::settling`](crate::simulate::Criteria::settling) \[s\].
    pub from: f64,
    /// Largest |q_l − q_ld| from then on, a joint each \[rad\].
    pub links: Vec<f64>,
    /// Largest |q_m − q_md|, the same; nothing for laws that have no q_md.
    pub motors: Vec<f64>,
    /// Largest |σ_l|, the same [kg m²/s]; nothing for laws that have none.
    pub link_momenta: Vec<f64>,
    /// Largest |σ_m|, the same.
    pub motor_momenta: Vec<f64>,
}

impl Ultimate {
    /// Of a run of `scenario` that is drawn in `sketch`; none without imperfections, and of a run that did not come to its end.
    pub fn of(scenario: &Scenario, run: &Run, sketch: &Sketch) -> Option<Self> {
        let is_over = run.divergence.is_none() && run.broken_off.is_none();
        let from = run.summary.following.accepted.settling;
        let [links, motors, link_momenta, motor_momenta] =
            ["e_l", "e_m", "sigma_l", "sigma_m"].map(|errors| sketch.largest(errors, from));
        (is_over && !scenario.imperfections.is_empty()).then_some(Self {
            from,
            links,
            motors,
            link_momenta,
            motor_momenta,
        })
    }
}

/// How far a loop converges, and which of its imperfections is why.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Practical {
    /// The scenario.
    pub name: String,
    /// Shaping function.
    pub phi: String,
    /// Names of the joints.
    pub joints: Vec<String>,
    /// A step of the encoders of the links, a joint each \[rad\]; nothing without them.
    pub steps: Vec<f64>,
    /// What errors come down to.
    #[serde(flatten)]
    pub ultimate: Ultimate,
    /// What they come down to with one imperfection and no other, by its kind. Velocities are true where no filter makes them.
    pub alone: BTreeMap<&'static str, Ultimate>,
}
