//! What can be wrong at a control instant.

use super::{Seen, Settings};
use crate::linalg::Vector;
use crate::memory::Port;
use crate::scalar::Float;

/// Control periods since the encoders of either side last delivered: 0 for a reading of this instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Age {
    /// Of the link encoders; 0 where an estimator stands in for them.
    pub link: u32,
    /// Of the motor encoders, in control periods too.
    pub motor: u32,
}

impl Age {
    /// Everything was read at this instant.
    pub const FRESH: Self = Self { link: 0, motor: 0 };

    /// The older of both.
    #[inline]
    pub fn oldest(self) -> u32 {
        self.link.max(self.motor)
    }
}

/// Something that stops the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Position or velocity is NaN or infinite.
    NotFinite,
    /// The encoder has not delivered for longer than allowed.
    Stale,
    /// The position is beyond what is believable.
    Position,
    /// The speed is beyond what is believable.
    Speed,
    /// The spring would be wound farther than it can be.
    Deflection,
    /// The reading is farther from the last one that was believed than a joint moves in a period.
    Jump,
    /// The reading has not changed by a bit although the robot moves.
    Frozen,
    /// The velocity is not the rate of the position.
    Velocity,
    /// Motor and link contradict each other: the motor's momentum does not go with the spring that is read.
    Contradiction,
    /// Something pushes the link.
    Collision,
    /// The law gave a torque that is not finite.
    Law,
    /// More control instants were missed than readings may be old.
    Late,
    /// The time stamp is not after the last one.
    Backwards,
}

impl Fault {
    /// All of them, in the order of their codes: the first has 1, as 0 stands for none.
    pub const ALL: [Self; 13] = [
        Self::NotFinite,
        Self::Stale,
        Self::Position,
        Self::Speed,
        Self::Deflection,
        Self::Jump,
        Self::Frozen,
        Self::Velocity,
        Self::Contradiction,
        Self::Collision,
        Self::Law,
        Self::Late,
        Self::Backwards,
    ];

    /// In a word, as traces and logs write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::NotFinite => "not-finite",
            Self::Stale => "stale",
            Self::Position => "position",
            Self::Speed => "speed",
            Self::Deflection => "deflection",
            Self::Jump => "jump",
            Self::Frozen => "frozen",
            Self::Velocity => "velocity",
            Self::Contradiction => "contradiction",
            Self::Collision => "collision",
            Self::Law => "law",
            Self::Late => "late",
            Self::Backwards => "backwards",
        }
    }

    /// Whether the velocity can still be braked by.
    #[inline]
    pub(super) fn spares_velocity(self) -> bool {
        matches!(
            self,
            Self::Position | Self::Speed | Self::Deflection | Self::Contradiction | Self::Collision
        )
    }

    /// Whether it is between the readings of both sides.
    #[inline]
    fn is_of_both_sides(self) -> bool {
        matches!(self, Self::Deflection | Self::Contradiction)
    }

    /// Its number, from 1.
    #[inline]
    pub fn code(self) -> u32 {
        self as u32 + 1
    }

    /// The fault of a number; none for 0 and what is no number of one.
    #[inline]
    pub fn of_code(code: u32) -> Option<Self> {
        Self::ALL.get(usize::try_from(code).ok()?.checked_sub(1)?).copied()
    }
}

/// Where a fault is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// On the link side of the joint with this index.
    Link(u32),
    /// On the motor side of the joint with this index.
    Motor(u32),
    /// In the controller: no joint's.
    Controller,
}

impl Place {
    /// Shows a fault and its place to `port`: the number of the `cause`, 0 for none, and that of the `place`: 0 for the controller,
    /// then joint by joint its link and its motor.
    #[inline]
    pub fn walk<S>(fault: &mut Option<(Fault, Self)>, port: &mut dyn Port<S>) {
        let (mut cause, place) = fault.map_or((0, Self::Controller), |(cause, place)| (cause.code(), place));
        let mut code = match place {
            Self::Controller => 0,
            Self::Link(joint) => joint.saturating_mul(2).saturating_add(1),
            Self::Motor(joint) => joint.saturating_mul(2).saturating_add(2),
        };
        port.word("cause", &mut cause);
        port.word("place", &mut code);
        let place = match code.checked_sub(1) {
            None => Self::Controller,
            Some(code) if code % 2 == 0 => Self::Link(code / 2),
            Some(code) => Self::Motor(code / 2),
        };
        *fault = Fault::of_code(cause).map(|cause| (cause, place));
    }
}

/// Faults of all joints on both sides, and those of no joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Faults<const N: usize> {
    pub link: Vector<Option<Fault>, N>,
    pub motor: Vector<Option<Fault>, N>,
    pub controller: Option<Fault>,
}

impl<const N: usize> Faults<N> {
    /// What the readings themselves show: not there, or too old.
    #[inline]
    pub fn missing<C: Float>(settings: &Settings<C, N>, seen: &Seen<C, N>) -> Self {
        let side = |q: &Vector<C, N>, v: &Vector<C, N>, age: u32| {
            Vector::from_fn(|i| {
                if !(q[i].is_finite() && v[i].is_finite()) {
                    Some(Fault::NotFinite)
                } else if age > settings.allowed_age {
                    Some(Fault::Stale)
                } else {
                    None
                }
            })
        };
        let Seen { x, age, .. } = seen;
        Self {
            link: side(&x.q_l, &x.v_l, age.link),
            motor: side(&x.q_m, &x.v_m, age.motor),
            controller: None,
        }
    }

    #[inline]
    pub fn any(&self) -> bool {
        self.first().is_some()
    }

    /// The first of them: the controller's, then joint by joint those of one side, then those that either side may be to blame for.
    #[inline]
    pub fn first(&self) -> Option<(Fault, Place)> {
        let Self { link, motor, controller } = self;
        let find = |wanted: fn(Fault) -> bool| {
            let wanted = |fault: Option<Fault>| fault.filter(|fault| wanted(*fault));
            (0_u32..).zip(link.iter().zip(motor.iter())).find_map(|(i, (link, motor))| {
                let link = wanted(link).map(|fault| (fault, Place::Link(i)));
                link.or(wanted(motor).map(|fault| (fault, Place::Motor(i))))
            })
        };
        let controller = controller.map(|fault| (fault, Place::Controller));
        controller
            .or_else(|| find(|fault| !fault.is_of_both_sides()))
            .or_else(|| find(Fault::is_of_both_sides))
    }
}
