//! Following the file of a tube: is it about this loop, and does every section hold for a period of it?

use crate::files::Problems;
use crate::linalg::Dense;
use crate::progress::Progress;
use crate::prove::documents::{
    Checked, TUBE, bounds_hold, every, malformed, of_lower, rate_holds, refuted, triangle, unpacked,
};
use crate::prove::engine::sampled_data::section::Section;
use crate::prove::engine::sampled_data::tube::Sections;
use crate::prove::sampled_data::file::{AskedTexts, Claims, Document, Own, about};
use crate::prove::sampled_data::spoken_of::{sensors, suitable_when_sampled};
use crate::prove::sampled_data::{Asked, NoTube, SampledTube, followed, late};
use crate::prove::subject::Difference;
use crate::scenario::Scenario;
use crate::verify::{Rejected, is_decimal};

/// Follows every section of the file whose text is `text` for a period of the loop of `scenario`.
///
/// # Errors
/// If tubes do not speak of such a loop.
pub fn check(
    text: &str,
    scenario: &Scenario,
    progress: Progress<'_>,
) -> Result<Checked<SampledTube>, Problems> {
    suitable_when_sampled(scenario)?;
    let document = match document(text) {
        Ok(document) => document,
        Err(rejected) => return Ok(Checked::Rejected(rejected)),
    };
    let differences = differences(&document, &about(scenario)?);
    if !differences.is_empty() {
        return Ok(Checked::Differs(differences));
    }
    let given = match given(&document, scenario) {
        Ok(given) => given,
        Err(rejected) => return Ok(Checked::Rejected(rejected)),
    };
    let sections = Sections::Given(&given.sections, &document.own.kept);
    Ok(match followed(scenario, given.asked, sections, progress)? {
        None => Checked::BrokenOff,
        Some(Err(NoTube { not_shown, .. })) => Checked::Rejected(refuted("sections", not_shown)),
        Some(Ok(tube)) => match compared(&document.own.claims, &tube) {
            Ok(()) => Checked::Holds(Box::new(tube)),
            Err(rejected) => Checked::Rejected(rejected),
        },
    })
}

/// What the file says.
pub(super) fn document(text: &str) -> Result<Document, Rejected> {
    TUBE.read(text, &["asked", "claims"])
}

/// Where what the file says of its loop is not what the scenario's is.
pub(super) fn differences(ours: &Document, theirs: &Document) -> Vec<Difference> {
    let (of_ours, of_theirs) = (&ours.own, &theirs.own);
    ours.told.differences(
        &theirs.told,
        &[
            ("loop", of_ours.sampled.clone(), of_theirs.sampled.clone()),
            ("periods", of_ours.periods.into(), of_theirs.periods.into()),
        ],
    )
}

/// What a file gives of its tube.
pub(super) struct Given {
    asked: Asked,
    pub(super) sections: Vec<Section>,
}

/// What `document`, which is about `scenario`, gives of its tube, if it has as much as it must.
pub(super) fn given(document: &Document, scenario: &Scenario) -> Result<Given, Rejected> {
    let Own { asked, claims, kept, sections, periods, .. } = &document.own;
    let n = scenario.robot.joint_count();
    let Claims { rate, error, torque } = claims;
    if [asked.extents.len(), torque.len()] != [n; 2] || error.len() != 2 * n {
        return Err(malformed("claims", format!("must be of {n} joints, and asked.extents too")));
    }
    let asked = asked.read().ok_or_else(|| malformed("asked", "must be positive numbers"))?;
    for (what, all) in [("rate", std::slice::from_ref(rate)), ("error", error), ("torque", torque)] {
        if let Some(text) = all.iter().find(|text| !is_decimal(text)) {
            return Err(malformed(format!("claims.{what}"), format!("'{text}' is no number")));
        }
    }
    let instants = periods.saturating_add(1);
    if sections.len() != instants {
        return Err(malformed("sections", format!("are {}, must be {instants}", sections.len())));
    }
    let sensors = sensors(scenario);
    let most = sensors.off.len();
    let is_kept = kept.first() == Some(&0) && kept.windows(2).all(|two| two[1] <= two[0] + most);
    if kept.len() != sections.len() || !is_kept {
        let reason = format!("must be {instants} numbers from 0, each at most {most} more than the last");
        return Err(malformed("kept", reason));
    }
    let size = 4 * n + sensors.remembered(n) + late(scenario).waiting * n;
    let section = |(k, text): (usize, &String)| {
        read(text, size).map_err(|reason| malformed(format!("sections[{k}]"), reason))
    };
    Ok(Given { asked, sections: sections.iter().enumerate().map(section).collect::<Result<_, _>>()? })
}

impl AskedTexts {
    /// The floats that they restore, if all of them are positive.
    fn read(&self) -> Option<Asked> {
        let positive = |text: &String| text.parse().ok().filter(|x: &f64| *x > 0.0 && x.is_finite());
        let extents = self.extents.iter().map(positive).collect::<Option<_>>()?;
        Some(Asked { extents, rate: positive(&self.rate)? })
    }
}

/// The section of `size` numbers that `text` is, without P; or what is wrong with it.
fn read(text: &str, size: usize) -> Result<Section, String> {
    let all = unpacked(text)?;
    let own = size + triangle(size);
    if all.len() != own {
        return Err(format!("has {} numbers, must have {own}", all.len()));
    }
    Ok(Section {
        center: all[..size].to_vec(),
        lower: of_lower(size, &all[size..])?,
        past: Dense::zeros(size, 0),
    })
}

/// Whether what is claimed, in decimals, is not more than what was found.
fn compared(Claims { rate, error, torque }: &Claims, tube: &SampledTube) -> Result<(), Rejected> {
    rate_holds(rate, tube.rate)?;
    bounds_hold("error", &every(error), &tube.error)?;
    bounds_hold("torque", &every(torque), &tube.torque)
}
