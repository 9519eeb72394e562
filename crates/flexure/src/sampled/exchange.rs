//! What is exchanged in a loop, and how fast, by the closed forms of the v-CBC loop in its error coordinates.

use std::fmt;

use crate::laws::{Controller, Drive};

/// Something that goes back and forth between two errors, or that is damped.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Exchange {
    /// Between which errors.
    pub what: &'static str,
    /// Its formula.
    pub formula: &'static str,
    /// Frequency [rad/s], or rate of decay [1/s].
    pub speed: f64,
}

impl fmt::Display for Exchange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at {} = {:.3e} 1/s", self.what, self.formula, self.speed)
    }
}

/// The fastest exchange of a joint under `law`; none if no closed form of its loop is known.
pub(super) fn fastest(law: &Controller, joint: usize, drive: &Drive) -> Option<Exchange> {
    let Controller::Vcbc(gains) = law else { return None };
    let (link, motor) = (&gains.link, &gains.motor);
    let Drive { stiffness: K, motor_inertia: M_m, free_inertia: M, .. } = *drive;
    let exchange = |what, formula, speed| Exchange { what, formula, speed };
    let all = [
        exchange("link error ↔ link momentum", "√(Π_l/M)", (link.metric[joint] / M).sqrt()),
        exchange("motor error ↔ motor momentum", "√(Π_m/M_m)", (motor.metric[joint] / M_m).sqrt()),
        exchange("motor error ↔ link momentum", "√(K²/(Π_m M))", K / (motor.metric[joint] * M).sqrt()),
        exchange("damping of the link momentum", "K_ld/M", link.damping[joint] / M),
        exchange("damping of the motor momentum", "K_md/M_m", motor.damping[joint] / M_m),
        exchange("decay of the link error", "Λ_l", link.shaping[joint]),
        exchange("decay of the motor error", "Λ_m", motor.shaping[joint]),
    ];
    all.into_iter().max_by(|x, y| x.speed.total_cmp(&y.speed))
}
