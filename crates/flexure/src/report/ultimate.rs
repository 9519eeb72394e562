//! What position errors come down to where they do not come down to zero.

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
/// let mut scenario = flexure::Scenario::load("two-link-tanh-practical")?;
/// scenario.duration = 4.5; // s
/// let mut sketch = Sketch::new(&scenario.signals()?);
/// let run = flexure::simulate::run_into(&scenario, &mut [&mut sketch], &flexure::progress::unwatched)?;
/// let ultimate = Ultimate::of(&scenario, &run, &sketch).ok_or("it has imperfections")?;
/// assert!(ultimate.from == 3.7 && ultimate.links.iter().all(|error| *error < 1e-3)); // s, rad
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
}

impl Ultimate {
    /// Of a run of `scenario` that is drawn in `sketch`; none without imperfections, and of a run that did not come to its end.
    pub fn of(scenario: &Scenario, run: &Run, sketch: &Sketch) -> Option<Self> {
        let is_over = run.divergence.is_none() && run.broken_off.is_none();
        (is_over && !scenario.imperfections.is_empty())
            .then(|| Self::from(run.summary.following.accepted.settling, sketch))
    }

    /// Of whatever is drawn in `sketch`, `from` this time on \[s\].
    pub(crate) fn from(from: f64, sketch: &Sketch) -> Self {
        let [links, motors] = ["e_l", "e_m"].map(|errors| sketch.largest(errors, from));
        Self { from, links, motors }
    }
}
