//! Imperfections: what sensors, computers, drives and joints do that the ideal loop does not.
//!
//! A kind is a file with its documentation, keys, reader, strengths and effect, and a line in the list below. Everything else
//! follows from the list; what a kind's file forgets does not compile.

#[macro_use]
mod registry;

pub(crate) mod document;
mod effect;
mod kind;
#[cfg(test)]
mod recipe;
mod side;
pub mod stages;

use std::any::Any;

use crate::files::Entry;
use crate::imperfections::document::{Reader, entry};
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Place, Setup};

pub use effect::Effects;
pub use kind::Strengths;
pub(crate) use kind::{Kind, Overlap};
pub use side::{Side, Sides};

// In the order of things in a loop: sensors, what is made of them, computer, drives, joints, the world.
imperfections! {
    bias::Bias,
    noise::Noise,
    encoder::Encoder,
    jump::Jump,
    freeze::Freeze,
    sampling::Sampling,
    dropout::Dropout,
    velocity_filter::VelocityFilter,
    stall::Stall,
    deadline::Deadline,
    torque_gain::TorqueGain,
    current_quantisation::CurrentQuantisation,
    saturation::Saturation,
    torque_rate::TorqueRate,
    delay::Delay,
    friction::Friction,
    spring::Spring,
    model_error::ModelError,
    push::Push,
    // The example of CONTRIBUTING.md.
    #[cfg(test)]
    current_loop::CurrentLoop,
}

impl Imperfection {
    /// Whether it is in sensors, computer or drives rather than in the mechanics: what makes the loop a sampled one.
    pub fn is_of_devices(&self) -> bool {
        self.place() == Place::Devices
    }

    /// Whether it makes the simulated robot one that is not smooth: dry friction, play or hysteresis.
    pub fn is_rough(&self) -> bool {
        let any = |numbers: &[f64]| numbers.iter().any(|number| *number > 0.0);
        let rubs = |friction: &Friction| {
            any(&friction.coulomb) || friction.stribeck.as_ref().is_some_and(|rise| any(&rise.breakaway))
        };
        let plays = |spring: &Spring| any(&spring.dead_zone) || any(&spring.hysteresis_stiffness);
        self.of().is_some_and(rubs) || self.of().is_some_and(plays)
    }

    /// The data, if this is of kind `K`.
    pub(crate) fn of<K: Kind>(&self) -> Option<&K> {
        self.data().downcast_ref()
    }

    /// The data to be changed, if this is of kind `K`.
    pub(crate) fn of_mut<K: Kind>(&mut self) -> Option<&mut K> {
        self.data_mut().downcast_mut()
    }
}
