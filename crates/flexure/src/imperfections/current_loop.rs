//! Drives whose torque follows the command with a lag.

use std::f64::consts::TAU;

use flexure_core::memory::{Memory, Port};

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};
use crate::imperfections::stages::{Actuating, Tick};

/// Motor torque follows the command as ω/(s + ω) does.
#[derive(Clone, Debug, PartialEq)]
pub struct CurrentLoop {
    /// ω/2π > 0 \[Hz\].
    pub cutoff: Vec<f64>,
}

impl Kind for CurrentLoop {
    const NAME: &'static str = "current-loop";
    const SUMMARY: &'static str = "torque that follows the command with a lag";
    const KEYS: &'static [&'static str] = &["cutoff"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths = Strengths { none: None, little: "cutoff = 200.0", much: "cutoff = 10.0" };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        let cutoff = table.per_joint("cutoff", context.joints, &quantity::CUTOFF)?;
        Some(Self { cutoff })
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        Some(Overlap::Whole)
    }

    fn effect(&self, setup: Setup) -> Effect<'_> {
        let left = self.cutoff.iter().map(|cutoff| (-TAU * cutoff * setup.period).exp()).collect();
        Effect::Actuating(Box::new(Lag { left, torque: vec![0.0; setup.joints] }))
    }
}

/// The torque, and the part of a step that is still to come a control period later.
struct Lag {
    left: Vec<f64>,
    torque: Vec<f64>,
}

impl Actuating for Lag {
    fn start(&mut self, torque: &[f64]) {
        self.torque.copy_from_slice(torque);
    }

    fn actuate(&mut self, _: &Tick, torque: &mut [f64]) {
        for ((command, last), left) in torque.iter_mut().zip(&mut self.torque).zip(&self.left) {
            *last = *command + (*last - *command) * left;
            *command = *last;
        }
    }
}

/// The last `torque` [N m].
impl Memory<f64> for Lag {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        port.joints("torque", "N m", &mut self.torque);
    }
}
