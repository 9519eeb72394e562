//! The gains of `vcbc`.

use crate::files::field::{Field, Joints};
use crate::files::quantity;

/// The gains of virtual-contraction based control.
#[derive(Clone, Debug, PartialEq)]
pub struct VcbcGains {
    /// Shaping function φ of both sides.
    pub phi: Phi,
    /// Link side.
    pub link: SideGains,
    /// Motor side.
    pub motor: SideGains,
}

impl VcbcGains {
    /// Every gain with its path.
    pub(crate) fn named(&self) -> Vec<(String, &[f64])> {
        let side = |name: &'static str, gains: &SideGains| {
            gains.keys().map(move |key| format!("{name}.{key}")).collect::<Vec<_>>()
        };
        let names = side("link", &self.link).into_iter().chain(side("motor", &self.motor));
        names.zip(self.link.values().chain(self.motor.values()).map(Vec::as_slice)).collect()
    }

    /// The powers of 1/s in their units.
    pub(crate) fn speed_powers(&self) -> Vec<i32> {
        let power = |key: &str| match key {
            "metric" => quantity::GAIN_METRIC.per_second(),
            "shaping" => quantity::GAIN_SHAPING.per_second(),
            "damping" => quantity::GAIN_DAMPING.per_second(),
            "kappa" => quantity::GAIN_KAPPA.per_second(),
            _ => quantity::GAIN_HARDENING.per_second(),
        };
        self.link.keys().chain(self.motor.keys()).map(power).collect()
    }

    /// The same gains, to be changed.
    pub(crate) fn slots(&mut self) -> Vec<&mut Vec<f64>> {
        self.link.slots().chain(self.motor.slots()).collect()
    }
}

/// A shaping function φ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phi {
    /// φ_1 = Λ tanh q̃.
    Tanh,
    /// φ_2 = Λ q̃.
    Linear,
    /// φ_3, with κ.
    CoupledTanh,
}

const PHIS: &[(&str, Phi)] =
    &[("tanh", Phi::Tanh), ("linear", Phi::Linear), ("coupled-tanh", Phi::CoupledTanh)];

impl Phi {
    /// The name in files.
    pub fn name(self) -> &'static str {
        PHIS.iter().find(|(_, phi)| *phi == self).map_or("", |(name, _)| name)
    }
}

/// The gains of one side, one number per joint.
#[derive(Clone, Debug, PartialEq)]
pub struct SideGains {
    /// Metric Π, diagonal, > 0 [N m/rad].
    pub metric: Vec<f64>,
    /// Gain Λ inside φ, > 0 [1/s; rad/s for `tanh`].
    pub shaping: Vec<f64>,
    /// Injected damping K_d, > 0 [N m s/rad].
    pub damping: Vec<f64>,
    /// κ > 0 of `coupled-tanh` [1/s].
    pub kappa: Option<Vec<f64>>,
    /// h ≥ 0 in Π_l(q̃) = metric + h q̃², link side only [N m/rad³].
    pub metric_hardening: Option<Vec<f64>>,
}

impl SideGains {
    /// Keys of the gains that are there.
    fn keys(&self) -> impl Iterator<Item = &'static str> + use<> {
        let kappa = self.kappa.is_some().then_some("kappa");
        let hardening = self.metric_hardening.is_some().then_some("metric_hardening");
        ["metric", "shaping", "damping"].into_iter().chain(kappa).chain(hardening)
    }

    /// Their values, in the order of [`keys`](Self::keys).
    fn values(&self) -> impl Iterator<Item = &Vec<f64>> {
        [&self.metric, &self.shaping, &self.damping]
            .into_iter()
            .chain(&self.kappa)
            .chain(&self.metric_hardening)
    }

    fn slots(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        let Self { metric, shaping, damping, kappa, metric_hardening } = self;
        [metric, shaping, damping].into_iter().chain(kappa).chain(metric_hardening)
    }
}

/// Reads the gains of `vcbc`.
pub(crate) fn read(field: &Field<'_>, joints: &Joints) -> Option<VcbcGains> {
    let table = field.table(&["kind", "phi", "link", "motor"])?;
    let phi = table.choice("phi", PHIS);
    let link = table.required("link", "gains of the link side").and_then(|field| side(&field, phi, joints));
    let motor = table.required("motor", "gains of the motor side").and_then(|field| {
        refuse_hardening(&field)?;
        side(&field, phi, joints)
    });
    Some(VcbcGains { phi: phi?, link: link?, motor: motor? })
}

fn side(field: &Field<'_>, phi: Option<Phi>, joints: &Joints) -> Option<SideGains> {
    let table = field.table(&["metric", "shaping", "damping", "kappa", "metric_hardening"])?;
    let metric = table.per_joint("metric", joints, &quantity::GAIN_METRIC);
    let shaping = table.optional("shaping", |field| field.per_joint(joints, &quantity::GAIN_SHAPING));
    let damping = table.per_joint("damping", joints, &quantity::GAIN_DAMPING);
    let hardening =
        table.optional("metric_hardening", |field| field.per_joint(joints, &quantity::GAIN_HARDENING));
    let kappa = match (phi, table.get("kappa")) {
        (Some(Phi::CoupledTanh), _) => table.per_joint("kappa", joints, &quantity::GAIN_KAPPA).map(Some),
        (Some(phi), Some(field)) => {
            let message = format!("{} is given, but phi is '{}', which has no kappa", field.path, phi.name());
            field.error("unused", message, "remove it, or choose phi = \"coupled-tanh\"");
            None
        }
        _ => Some(None),
    };
    let metric = metric?;
    Some(SideGains {
        shaping: shaping?.unwrap_or_else(|| metric.clone()),
        metric,
        damping: damping?,
        kappa: kappa?,
        metric_hardening: hardening?,
    })
}

fn refuse_hardening(motor: &Field<'_>) -> Option<()> {
    let Some(field) = motor.any_table()?.get("metric_hardening") else { return Some(()) };
    field.error(
        "motor-metric",
        format!("{} is given, but Π_m must be constant", field.path),
        "the term −Π_m⁻¹KᵀM_l⁻¹σ_l of the motor's reference velocity is not integrable otherwise; \
         only the link side may have it",
    );
    None
}
