//! Springs that harden, have play or lose energy.

use crate::files::quantity::{self, Quantity};
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};

/// What springs do beside K ζ.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// k ≥ 0 in K ζ + k ζ³ [N m/rad³].
    pub hardening: Vec<f64>,
    /// Deflection ≥ 0 to either side in which the spring gives no torque \[rad\].
    pub dead_zone: Vec<f64>,
    /// Stiffness ≥ 0 of the element that slips [N m/rad].
    pub hysteresis_stiffness: Vec<f64>,
    /// Torque ≥ 0 at which it slips [N m].
    pub hysteresis_torque: Vec<f64>,
}

impl Kind for Spring {
    const NAME: &'static str = "spring";
    const SUMMARY: &'static str = "springs that harden, have play or lose energy";
    const KEYS: &'static [&'static str] =
        &["hardening", "dead_zone", "hysteresis_stiffness", "hysteresis_torque"];
    const PLACE: Place = Place::Mechanics;
    const STRENGTHS: Strengths = Strengths {
        none: Some("hardening = 0.0\ndead_zone = 0.0\nhysteresis_stiffness = 0.0\nhysteresis_torque = 0.0"),
        little: "dead_zone = 0.004",
        much: "hardening = 100.0\ndead_zone = 0.016\nhysteresis_stiffness = 0.5\nhysteresis_torque = 0.01",
    };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        if Self::KEYS.iter().all(|key| table.get(key).is_none()) {
            let hint = "give at least one of hardening in N m/rad^3, dead_zone in rad, hysteresis_stiffness in N m/rad \
                        with hysteresis_torque in N m";
            table.error("missing-key", "spring: nothing is given", hint);
            return None;
        }
        let read = |key, quantity: &Quantity| table.per_joint_or_zero(key, context.joints, quantity);
        let hardening = read("hardening", &quantity::SPRING_HARDENING);
        let dead_zone = read("dead_zone", &quantity::DEAD_ZONE);
        let hysteresis = ["hysteresis_stiffness", "hysteresis_torque"];
        if let [Some(field), None] | [None, Some(field)] = hysteresis.map(|key| table.get(key)) {
            let message = format!("{} is given alone", field.path);
            field.error(
                "missing-key",
                message,
                "hysteresis needs hysteresis_stiffness in N m/rad and hysteresis_torque in N m",
            );
            return None;
        }
        let stiffness = read("hysteresis_stiffness", &quantity::HYSTERESIS_STIFFNESS);
        let torque = read("hysteresis_torque", &quantity::HYSTERESIS_TORQUE);
        Some(Self {
            hardening: hardening?,
            dead_zone: dead_zone?,
            hysteresis_stiffness: stiffness?,
            hysteresis_torque: torque?,
        })
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        Some(Overlap::Whole)
    }

    fn effect(&self, _: Setup) -> Effect<'_> {
        Effect::Joints(Box::new(|joints| {
            for (all, more) in joints.spring_hardening.iter_mut().zip(&self.hardening) {
                *all += more;
            }
            for (gap, dead_zone) in joints.spring_gap.iter_mut().zip(&self.dead_zone) {
                // The file gives it to either side.
                *gap = 2.0 * dead_zone;
            }
            joints.hysteresis_stiffness.copy_from_slice(&self.hysteresis_stiffness);
            joints.yield_torque.copy_from_slice(&self.hysteresis_torque);
        }))
    }
}
