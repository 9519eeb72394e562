//! The gains of one side of `vcbc`: `[controller.link]` or `[controller.motor]`.

use crate::files::field::{Field, Joints};
use crate::files::quantity::Quantity;
use crate::laws::gain::{INJECTED, LAMBDA, METRIC};
use crate::laws::starting::Starting;
use crate::laws::{Drive, Phi};
use crate::units;

/// Growth of Π_l.
const HARDENING: Quantity = Quantity::non_negative("growth of Π_l with the error squared", units::HARDENING);

/// The key of it.
const METRIC_HARDENING: &str = "metric_hardening";

/// The gains of one side, one number per joint.
#[derive(Clone, Debug, PartialEq)]
pub struct SideGains {
    /// Metric Π, diagonal, > 0 [N m/rad].
    pub metric: Vec<f64>,
    /// Gain Λ inside φ, > 0 [1/s; rad/s for `tanh`].
    pub shaping: Vec<f64>,
    /// Injected damping K_d, > 0 [N m s/rad].
    pub damping: Vec<f64>,
    /// What φ has beside Λ, by key: `kappa`, κ > 0 of `coupled-tanh` [1/s].
    pub extra: Vec<(&'static str, Vec<f64>)>,
    /// h ≥ 0 in Π_l(q̃) = metric + h q̃², link side only [N m/rad³].
    pub metric_hardening: Option<Vec<f64>>,
}

impl SideGains {
    /// What φ has beside Λ at `key`, if it has that.
    pub fn extra(&self, key: &str) -> Option<&Vec<f64>> {
        self.extra.iter().find(|(own, _)| *own == key).map(|(_, values)| values)
    }

    /// Growth of Π_l with the error squared [N m/rad³], if that is not 0.
    pub fn hardens(&self) -> Option<&[f64]> {
        self.metric_hardening.as_deref().filter(|hardening| hardening.iter().any(|&h| h != 0.0))
    }

    /// Gives the side the gains that `phi` has beside Λ, each where tuning starts from.
    pub(super) fn start_extra(&mut self, phi: Phi) {
        let start = |start: fn(f64) -> f64| self.shaping.iter().map(|&gain| start(gain)).collect();
        self.extra = phi.extra().iter().map(|extra| (extra.key, start(extra.start))).collect();
    }

    /// Key, quantity and values of every gain that is there.
    pub(super) fn entries(&self, phi: Phi) -> Vec<(&'static str, Quantity, &Vec<f64>)> {
        let Self { metric, shaping, damping, extra: _, metric_hardening } = self;
        let extra = phi.extra().iter();
        let extra = extra.filter_map(|extra| Some((extra.key, extra.quantity, self.extra(extra.key)?)));
        let hardening = metric_hardening.iter().map(|values| (METRIC_HARDENING, HARDENING, values));
        [("metric", METRIC, metric), ("shaping", LAMBDA, shaping), ("damping", INJECTED, damping)]
            .into_iter()
            .chain(extra)
            .chain(hardening)
            .collect()
    }

    /// The values in the same order, to be changed.
    pub(super) fn slots(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        let Self { metric, shaping, damping, extra, metric_hardening } = self;
        let extra = extra.iter_mut().map(|(_, values)| values);
        [metric, shaping, damping].into_iter().chain(extra).chain(metric_hardening)
    }
}

/// Reads a side of a law with `phi`; none if that could not be read. Λ is the `starting` one unless it is given.
pub(super) fn read(
    field: &Field<'_>,
    phi: Option<Phi>,
    joints: &Joints,
    starting: &Starting<'_>,
) -> Option<SideGains> {
    let mut known = vec!["metric", "shaping", "damping"];
    known.extend(extra_keys());
    known.push(METRIC_HARDENING);
    let table = field.table(&known)?;
    let metric = table.per_joint("metric", joints, &METRIC);
    let shaping = table.optional("shaping", |field| field.per_joint(joints, &LAMBDA));
    let damping = table.per_joint("damping", joints, &INJECTED);
    let hardening = table.optional(METRIC_HARDENING, |field| field.per_joint(joints, &HARDENING));
    let extra = phi.map_or(Some(Vec::new()), |phi| {
        let foreign = extra_keys().into_iter().filter(|key| phi.extra().iter().all(|own| own.key != *key));
        let unused: Vec<_> = foreign.filter_map(|key| Some((key, table.get(key)?))).collect();
        for (key, field) in &unused {
            refuse(field, key, phi);
        }
        let own: Vec<_> = phi
            .extra()
            .iter()
            .map(|extra| Some((extra.key, table.per_joint(extra.key, joints, &extra.quantity)?)))
            .collect();
        own.into_iter().collect::<Option<Vec<_>>>().filter(|_| unused.is_empty())
    });
    let starting = || Some(starting.drives(field)?.iter().map(Drive::bandwidth).collect());
    Some(SideGains {
        metric: metric?,
        shaping: shaping?.or_else(starting)?,
        damping: damping?,
        extra: extra?,
        metric_hardening: hardening?,
    })
}

/// The keys that some shaping function has beside Λ, each once.
fn extra_keys() -> Vec<&'static str> {
    let mut keys: Vec<&str> = Vec::new();
    for extra in Phi::ALL.iter().flat_map(|phi| phi.extra()) {
        if !keys.contains(&extra.key) {
            keys.push(extra.key);
        }
    }
    keys
}

/// Notes that `phi` has nothing at `key`.
fn refuse(field: &Field<'_>, key: &str, phi: Phi) {
    let message = format!("{} is given, but phi is '{}', which has no {key}", field.path, phi.name());
    let having: Vec<_> = Phi::ALL
        .iter()
        .filter(|phi| phi.extra().iter().any(|extra| extra.key == key))
        .map(|phi| format!("phi = \"{}\"", phi.name()))
        .collect();
    field.error("unused", message, format!("remove it, or choose {}", having.join(" or ")));
}
