//! Gains to start from, for any robot and any law.

use crate::io::{
    BASELINES, Baseline, Controller, Drive, Phi, Problem, Problems, Robot, SideGains, VcbcGains,
};
use crate::overview::overview;

impl Controller {
    /// The law of this kind with gains made from stiffness, motor inertia and link inertia at q = 0 of each joint: sensible
    /// on any robot, and where tuning starts. All laws are to make errors decay at the same
    /// [rate](Drive::bandwidth); [`BASELINES`] says for each gain how. For `vcbc` with φ linear: Π_l = M_ii ω², Π_m = K,
    /// Λ = ω, K_d = J ω with J the inertia of that side.
    ///
    /// # Errors
    /// For an unknown kind, and if the robot has more joints than this program was built for.
    pub fn default_for(kind: &str, robot: &Robot) -> Result<Self, Problems> {
        let drives: Vec<_> = overview(robot)?
            .iter()
            .map(|joint| Drive {
                stiffness: joint.stiffness,
                motor_inertia: joint.motor_inertia,
                link_inertia: joint.link_inertia,
            })
            .collect();
        let of = |start: &dyn Fn(&Drive) -> f64| drives.iter().map(start).collect::<Vec<_>>();
        if kind == "vcbc" {
            let side = |inertia: fn(&Drive) -> f64, metric: &dyn Fn(&Drive) -> f64| SideGains {
                metric: of(metric),
                shaping: of(&Drive::bandwidth),
                damping: of(&|drive| inertia(drive) * drive.bandwidth()),
                kappa: None,
                metric_hardening: None,
            };
            let link =
                side(|drive| drive.link_inertia, &|drive| drive.link_inertia * drive.bandwidth().powi(2));
            let motor = side(|drive| drive.motor_inertia, &|drive| drive.stiffness);
            return Ok(Self::Vcbc(VcbcGains { phi: Phi::Linear, link, motor }));
        }
        let Some(shape) = BASELINES.iter().find(|shape| shape.kind == kind) else {
            let hint = "`flexure list controllers` shows them";
            return Err(
                Problem::new("unknown-name", format!("no controller is called '{kind}'"), hint).into()
            );
        };
        let gains = shape.gains.iter().map(|gain| (gain.key, of(&gain.start))).collect();
        Ok(Self::Baseline(Baseline { kind: shape.kind, gains }))
    }
}
