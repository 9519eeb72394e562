//! Rest to rest.

use flexure_core::reference::{self, Smoothstep};
use flexure_core::scalar::Interval;

use crate::files::quantity;
use crate::files::table::Table;
use crate::files::{Entry, Places, Problem};
use crate::references::Reference;
use crate::references::registry::{Context, Instant, Jump, Name, Named, ReferenceKind};
use crate::robot::vector;

/// From rest to rest along a straight line in joint space: the kinds `quintic`, `septic` and `nonic`.
#[derive(Clone, Debug, PartialEq)]
pub struct PointToPoint {
    /// Degree of the polynomial in time.
    pub profile: Profile,
    /// Position before the motion \[rad\].
    pub from: Vec<f64>,
    /// Position after the motion \[rad\].
    pub to: Vec<f64>,
    /// Time of departure, ≥ 0 \[s\].
    pub start: f64,
    /// Time that the motion takes \[s\].
    pub duration: f64,
}

/// How a point-to-point motion goes: the polynomial of this degree whose end derivatives vanish.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Profile {
    /// Degree 5: two derivatives vanish at the ends.
    Quintic,
    /// Degree 7: three.
    Septic,
    /// Degree 9: four, which is what a law on flexible joints needs for continuous torque.
    Nonic,
}

impl Profile {
    /// The name in files.
    const fn name(self) -> &'static str {
        match self {
            Self::Quintic => "quintic",
            Self::Septic => "septic",
            Self::Nonic => "nonic",
        }
    }

    fn step(self) -> Smoothstep {
        match self {
            Self::Quintic => Smoothstep::Quintic,
            Self::Septic => Smoothstep::Septic,
            Self::Nonic => Smoothstep::Nonic,
        }
    }
}

const KEYS: &[&str] = &["from", "to", "start", "duration"];

impl Named for PointToPoint {
    const NAMES: &'static [Name] = &[
        Name {
            entry: Entry {
                name: Profile::Quintic.name(),
                summary: "rest to rest, continuous up to the acceleration",
            },
            keys: KEYS,
            read: |table, context| read(table, context, Profile::Quintic),
        },
        Name {
            entry: Entry { name: Profile::Septic.name(), summary: "rest to rest, continuous up to the jerk" },
            keys: KEYS,
            read: |table, context| read(table, context, Profile::Septic),
        },
        Name {
            entry: Entry {
                name: Profile::Nonic.name(),
                summary: "rest to rest, continuous up to the fourth derivative",
            },
            keys: KEYS,
            read: |table, context| read(table, context, Profile::Nonic),
        },
    ];
}

fn read(table: &Table<'_>, Context { joints, .. }: &Context<'_>, profile: Profile) -> Option<Reference> {
    let from = table.per_joint("from", joints, &quantity::ANGLE);
    let to = table.per_joint("to", joints, &quantity::ANGLE);
    let start = table.optional("start", |field| field.number(&quantity::START));
    let duration = table.number("duration", &quantity::DURATION);
    Some(Reference::PointToPoint(PointToPoint {
        profile,
        from: from?,
        to: to?,
        start: start?.unwrap_or(0.0),
        duration: duration?,
    }))
}

impl ReferenceKind for PointToPoint {
    type Core<C: Instant, const N: usize> = reference::PointToPoint<C, N>;

    fn core<C: Instant, const N: usize>(
        &self,
        number: &dyn Fn(f64) -> C,
        _: &Places,
    ) -> Result<Self::Core<C, N>, Problem> {
        Ok(reference::PointToPoint {
            from: vector(&self.from).map(number),
            to: vector(&self.to).map(number),
            start: number(self.start),
            duration: number(self.duration),
            step: self.profile.step(),
        })
    }

    fn initial(&self) -> Vec<f64> {
        self.from.clone()
    }

    fn jump(&self) -> Option<Jump> {
        let derivative = self.profile.step().smoothness() + 1;
        (derivative <= 4).then_some(Jump { of: self.profile.name(), derivative, time: self.start })
    }

    fn breaks<const N: usize>(motion: &Self::Core<Interval, N>) -> Vec<Interval> {
        if motion.step.smoothness() < 4 { Self::kinks(motion) } else { Vec::new() }
    }

    fn kinks<const N: usize>(motion: &Self::Core<Interval, N>) -> Vec<Interval> {
        vec![motion.start, motion.start + motion.duration]
    }
}
