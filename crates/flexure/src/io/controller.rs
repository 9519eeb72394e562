//! `[controller]`: the law and its gains.

use super::field::{Field, Joints};
use super::quantity;

/// A control law with its gains, as data.
#[derive(Clone, Debug, PartialEq)]
pub enum Controller {
    /// Virtual-contraction based control: kind `vcbc`.
    Vcbc {
        /// Shaping function φ of both sides.
        phi: Phi,
        /// Link side.
        link: SideGains,
        /// Motor side.
        motor: SideGains,
    },
}

impl Controller {
    /// The name in files.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Vcbc { .. } => "vcbc",
        }
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

/// Reads `[controller]`.
pub(super) fn read(field: &Field<'_>, joints: &Joints) -> Option<Controller> {
    let table = field.table(&["kind", "phi", "link", "motor"])?;
    table.choice("kind", &[("vcbc", ())])?;
    let phi = table.choice("phi", PHIS);
    let link = table.required("link", "gains of the link side").and_then(|field| side(&field, phi, joints));
    let motor = table.required("motor", "gains of the motor side").and_then(|field| {
        refuse_hardening(&field)?;
        side(&field, phi, joints)
    });
    Some(Controller::Vcbc { phi: phi?, link: link?, motor: motor? })
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
