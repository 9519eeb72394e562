//! How the motion of smooth plants is computed.

use crate::files::field::Field;
use crate::files::normal::Normal;
use crate::files::quantity;
use crate::files::table::Table;

/// How the motion of smooth plants is computed. Those with dry friction, play or hysteresis are stepped by the midpoint rule at 0.1 ms whatever
/// it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integration {
    /// Collocation of order 4 or 8, in steps as long as their error allows.
    Collocation {
        /// Tolerated local error of a step, relative to the speeds of the joints.
        tolerance: f64,
    },
    /// The midpoint rule in steps of at most 1 ms: always the same work, whatever the error.
    Midpoint,
}

impl Default for Integration {
    fn default() -> Self {
        Self::Collocation { tolerance: TOLERANCE }
    }
}

/// Tolerated local error of integration steps, relative to the speeds of the joints, where the file has none: links and motors of the
/// built-in arms under given torques are then within 2e-10 rad of their motion after a second, and the built-in loops, over all of their
/// time, within 6e-9 rad of what they are with 1e-12.
pub(crate) const TOLERANCE: f64 = 1e-7;

/// The smallest and the largest that a file may have.
const TOLERANCES: (f64, f64) = (1e-13, 1e-3);

/// The key of the method, and its values.
const METHOD: &str = "integration";
const COLLOCATION: &str = "collocation";
const MIDPOINT: &str = "midpoint";

/// The key of the tolerance.
const OF_STEPS: &str = "integration_tolerance";

/// The keys of a scenario file that say it.
pub(crate) const KEYS: [&str; 2] = [METHOD, OF_STEPS];

/// Reads it. A tolerance without effect is warned of with what makes it so.
pub(crate) fn read(root: &Table<'_>) -> Option<Integration> {
    let is_midpoint = root.optional(METHOD, |field| field.choice(&[(COLLOCATION, false), (MIDPOINT, true)]));
    let tolerance = root.optional(OF_STEPS, tolerance);
    let (is_midpoint, tolerance) = (is_midpoint?.unwrap_or(false), tolerance?.unwrap_or(TOLERANCE));
    Some(if is_midpoint { Integration::Midpoint } else { Integration::Collocation { tolerance } })
}

/// Where the file asks for steps of one length, if it does.
pub(crate) fn midpoint<'a>(root: &Table<'a>) -> Option<Field<'a>> {
    root.get(METHOD).filter(|field| field.text() == Some(MIDPOINT))
}

/// What a file says, without what is said anyway.
pub(crate) fn normal(said: Normal) -> Normal {
    said.without_default(METHOD, &Normal::Text(COLLOCATION.to_owned()))
        .without_default(OF_STEPS, &Normal::number(TOLERANCE))
}

/// A tolerance that steps can keep and that keeps them to the motion.
fn tolerance(field: &Field<'_>) -> Option<f64> {
    let tolerance = field.number(&quantity::INTEGRATION_TOLERANCE)?;
    let (least, most) = TOLERANCES;
    if (least..=most).contains(&tolerance) {
        return Some(tolerance);
    }
    let message =
        format!("{} is {}, must be from {least:e} to {most:e}", field.path, quantity::shortest(tolerance));
    let hint = format!(
        "smaller errors are lost in rounding, larger ones lose the motion; without the key it is {TOLERANCE:e}"
    );
    field.error("range", message, hint);
    None
}
