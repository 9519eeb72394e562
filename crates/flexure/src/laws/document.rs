//! `[controller]`: the law and its gains.

use crate::files::field::{Field, Joints};
use crate::files::suggest;
use crate::laws::{BASELINES, Baseline, VcbcGains, baseline, vcbc};

/// A control law with its gains, as data.
#[derive(Clone, Debug, PartialEq)]
pub enum Controller {
    /// Virtual-contraction based control: kind `vcbc`.
    Vcbc(Box<VcbcGains>),
    /// One of the laws that it is compared with.
    Baseline(Baseline),
}

/// The name of [`Controller::Vcbc`] in files.
const VCBC: &str = "vcbc";

impl Controller {
    /// The name in files.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Vcbc(_) => VCBC,
            Self::Baseline(law) => law.kind,
        }
    }

    /// Shaping function φ of laws that let one choose it, as in files.
    pub fn phi(&self) -> Option<&'static str> {
        match self {
            Self::Vcbc(gains) => Some(gains.phi.name()),
            Self::Baseline(_) => None,
        }
    }

    /// Every gain with its path below `[controller]`, one number per joint: `link.metric`, `stiffness`.
    pub fn gains(&self) -> Vec<(String, &[f64])> {
        match self {
            Self::Vcbc(gains) => gains.named(),
            Self::Baseline(law) => {
                law.gains.iter().map(|(key, x)| ((*key).to_owned(), x.as_slice())).collect()
            }
        }
    }

    /// By which power each gain grows with the speed of the loop, from its unit, in the order of [`gains`](Self::gains): a law
    /// that is to be twice as fast has its stiffnesses four times and its dampings twice as large.
    pub fn speed_powers(&self) -> Vec<i32> {
        match self {
            Self::Vcbc(gains) => gains.speed_powers(),
            Self::Baseline(law) => law.speed_powers(),
        }
    }

    /// The same law with other gains, in the order of [`gains`](Self::gains); gains beyond the end of `values` stay.
    pub fn with_gains(&self, values: &[Vec<f64>]) -> Self {
        let mut changed = self.clone();
        let slots: Vec<&mut Vec<f64>> = match &mut changed {
            Self::Vcbc(gains) => gains.slots(),
            Self::Baseline(law) => law.gains.iter_mut().map(|(_, x)| x).collect(),
        };
        for (slot, value) in slots.into_iter().zip(values) {
            slot.clone_from(value);
        }
        changed
    }
}

/// Reads `[controller]`.
pub(crate) fn read(field: &Field<'_>, joints: &Joints) -> Option<Controller> {
    let table = field.any_table()?;
    let names = std::iter::once(VCBC).chain(BASELINES.iter().map(|shape| shape.kind));
    let listed = names.clone().collect::<Vec<_>>().join(", ");
    let kind = table.required("kind", &format!("one of {listed}"))?;
    let text = kind.text()?;
    if text == VCBC {
        return vcbc::read(field, joints).map(|gains| Controller::Vcbc(Box::new(gains)));
    }
    let Some(shape) = BASELINES.iter().find(|shape| shape.kind == text) else {
        let message = format!("{} is {}, which is not known", kind.path, suggest::quoted(text));
        kind.error("unknown-name", message, suggest::hint(text, names));
        return None;
    };
    baseline::read(field, shape, joints).map(Controller::Baseline)
}
