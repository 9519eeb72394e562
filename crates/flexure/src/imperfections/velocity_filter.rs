//! Velocities that are filtered differences of positions.

use flexure_core::estimate::LowPass;

use crate::files::quantity;
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::kind::{Kind, Overlap, Place, Setup, Strengths};

/// Velocities are filtered differences of measured positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VelocityFilter {
    /// ω/(s + ω).
    First {
        /// ω/2π > 0 \[Hz\].
        cutoff: f64,
    },
    /// ω²/(s² + 2 d ω s + ω²).
    Second {
        /// ω/2π > 0 \[Hz\].
        cutoff: f64,
        /// d > 0.
        damping: f64,
    },
}

impl Kind for VelocityFilter {
    const NAME: &'static str = "velocity-filter";
    const SUMMARY: &'static str = "velocities as filtered differences of positions";
    const KEYS: &'static [&'static str] = &["order", "cutoff", "damping"];
    const PLACE: Place = Place::Devices;
    const STRENGTHS: Strengths = Strengths {
        none: None,
        little: "order = 2\ncutoff = 40.0\ndamping = 0.9",
        much: "order = 1\ncutoff = 4.0",
    };

    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self> {
        let order =
            table.required("order", "1 or 2").and_then(|field| field.whole("order of the filter", 1, 2));
        let cutoff = table.number("cutoff", &quantity::CUTOFF);
        let (order, cutoff) = (order?, cutoff?);
        if let Some((_, period)) = context.times
            && cutoff >= 0.5 / period
        {
            let field = table.get("cutoff")?;
            let message = format!(
                "{} is {cutoff} Hz, must be < {} Hz, half the control rate",
                field.path,
                0.5 / period
            );
            field.error("range", message, "remove the filter's entry for none, or shorten control_period");
            return None;
        }
        if order != 1 {
            return Some(Self::Second {
                cutoff,
                damping: table.number("damping", &quantity::DAMPING_RATIO)?,
            });
        }
        if let Some(field) = table.get("damping") {
            let message = format!("{} is given, but the order is 1, which has no damping", field.path);
            field.error("unused", message, "remove it, or choose order = 2");
            return None;
        }
        Some(Self::First { cutoff })
    }

    fn overlap(&self, _: &Self) -> Option<Overlap> {
        Some(Overlap::Whole)
    }

    fn effect(&self, setup: Setup) -> Effect<'_> {
        Effect::Velocities(self.low_pass(setup.period))
    }
}

impl VelocityFilter {
    /// The filter at control periods of `period` in s.
    pub(crate) fn low_pass(&self, period: f64) -> LowPass<f64> {
        let filter = match *self {
            Self::First { cutoff } => LowPass::first_order(cutoff, period),
            Self::Second { cutoff, damping } => LowPass::second_order(cutoff, damping, period),
        };
        filter.expect("the reader takes positive numbers only")
    }
}
