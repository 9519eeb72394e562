//! `[guard]`: what a controller refuses to do.

use crate::files::field::Field;
use crate::files::quantity::{self, Quantity};
use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::robot::Limits;

/// Limits that commands are kept to, what is believed of readings, and what happens when either fails. Vectors have one entry per
/// joint; infinite limits are none.
#[derive(Clone, Debug, PartialEq)]
pub struct GuardSettings {
    /// Largest torque > 0 [N m].
    pub torque_limit: Vec<f64>,
    /// Largest torque rate > 0 [N m/s].
    pub torque_rate_limit: Vec<f64>,
    /// Oldest reading that is good [control periods].
    pub max_age: u32,
    /// Damping of the motors while stopped ≥ 0 [N m s/rad].
    pub stop_damping: Vec<f64>,
    /// How far the links may be from the reference > 0 for what is proved to hold \[rad\].
    pub region: Vec<f64>,
    /// When and how the law takes over again.
    pub rejoin: Rejoin,
    /// Time of a stop after which no torque is given any more > 0 \[s\]; none to hold for ever.
    pub off_after: Option<f64>,
    /// So many stops ≥ 1 within so many seconds > 0 last until the guard is reset.
    pub latch: Option<(u32, f64)>,
    /// Control periods ≥ 1 that a drive goes on with a command; none for ever. Then its torque falls, no faster than the rate limit.
    pub watchdog: Option<u32>,
    /// What is believed.
    pub believed: Believed,
    /// What is done when something pushes a link.
    pub collision: Option<Collision>,
    /// How fast torques that the model does not know are estimated > 0 [rad/s].
    pub residual_bandwidth: f64,
}

/// When and how the law takes over from a stop.
#[derive(Clone, Debug, PartialEq)]
pub struct Rejoin {
    /// Good readings in a row before ≥ 1 [control periods].
    pub after: u32,
    /// Largest speed of links and motors > 0 [rad/s].
    pub speed: Vec<f64>,
    /// Largest distance of the links from the reference > 0 \[rad\].
    pub error: Vec<f64>,
    /// Time in which the reference is joined > 0 \[s\].
    pub duration: f64,
    /// Time in which the robot's own motion comes to rest meanwhile > 0 \[s\].
    pub settle: f64,
}

/// What is believed of readings.
#[derive(Clone, Debug, PartialEq)]
pub struct Believed {
    /// Least and largest position \[rad\].
    pub position: [Vec<f64>; 2],
    /// Largest speed > 0 [rad/s].
    pub speed: Vec<f64>,
    /// Largest deflection of the springs > 0 \[rad\].
    pub deflection: Vec<f64>,
    /// Largest change of a position from one control instant to the next > 0 \[rad\].
    pub jump: Vec<f64>,
    /// Control periods ≥ 1 after which a reading that does not change is frozen, if the other side or the reference has moved meanwhile
    /// by more than so much > 0 \[rad\].
    pub frozen: (u32, f64),
    /// Largest difference of a velocity from the rate of its position > 0 [rad/s].
    pub velocity_gap: Vec<f64>,
    /// Largest torque on the motors that the model does not know > 0 [N m].
    pub motor_residual: Vec<f64>,
}

/// What is done when something pushes a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Collision {
    /// Torque on a link that the model does not know, from which on it is a collision > 0 [N m].
    pub threshold: Vec<f64>,
    /// What is done.
    pub reaction: Reaction,
    /// How long a robot that retracts does so > 0 \[s\].
    pub retract: f64,
}

/// How a robot answers a collision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reaction {
    /// It stops.
    Stop,
    /// It is held against gravity and gives way.
    Float,
    /// It moves back with the torque that it felt, then it stops.
    Retract,
}

/// Most control periods that a count in `[guard]` may be.
const MOST: u64 = 1_000_000;

/// How far beyond the robot's own limits readings are believed, if nothing is said: limits may be touched, readings are noisy.
const BEYOND: f64 = 1.5;

/// What a reading may jump by in a control period, if nothing is said: as at this speed [rad/s], far above that of arms, but at least
/// what coarse encoders do and at most what no arm does \[rad\].
const JUMP_SPEED: f64 = 50.0;
const JUMP: (f64, f64) = (0.05, 0.5);

impl GuardSettings {
    /// What is not said in a file, for a robot with these limits and a control period in s: no damping.
    pub fn usual(limits: &Limits, period: f64) -> Self {
        let n = limits.torque.len();
        let jump = (JUMP_SPEED * period).clamp(JUMP.0, JUMP.1);
        let beyond = |limit: &[f64]| limit.iter().map(|x| BEYOND * x).collect();
        let margin = |i: usize| 0.5 * (BEYOND - 1.0) * (limits.upper[i] - limits.lower[i]);
        let position = |limit: &[f64], sign: f64| (0..n).map(|i| limit[i] + sign * margin(i)).collect();
        Self {
            torque_limit: limits.torque.clone(),
            torque_rate_limit: limits.torque_rate.clone(),
            max_age: 0,
            stop_damping: vec![0.0; n],
            region: vec![f64::INFINITY; n],
            rejoin: Rejoin {
                after: 10,
                speed: vec![0.5; n],
                error: vec![1.0; n],
                duration: 1.0,
                settle: 0.25,
            },
            off_after: None,
            latch: None,
            watchdog: None,
            believed: Believed {
                position: [position(&limits.lower, -1.0), position(&limits.upper, 1.0)],
                speed: beyond(&limits.velocity),
                deflection: beyond(&limits.deflection),
                jump: vec![jump; n],
                frozen: (10, 0.05),
                velocity_gap: vec![f64::INFINITY; n],
                motor_residual: vec![f64::INFINITY; n],
            },
            collision: None,
            residual_bandwidth: 50.0,
        }
    }
}

const KEYS: &[&str] = &[
    "torque_limit",
    "torque_rate_limit",
    "max_age",
    "stop_damping",
    "region",
    "rejoin_after",
    "rejoin_speed",
    "rejoin_error",
    "rejoin_duration",
    "rejoin_settle",
    "off_after",
    "latch_stops",
    "latch_within",
    "watchdog",
    "position",
    "speed",
    "deflection",
    "jump",
    "frozen_after",
    "frozen_travel",
    "velocity_gap",
    "motor_residual",
    "collision",
    "reaction",
    "retract_duration",
    "residual_bandwidth",
];

/// Reads `[guard]`.
#[expect(clippy::option_option, reason = "bad, absent and good are three cases")]
pub(crate) fn read(root: &Table<'_>, context: &Context<'_>) -> Option<Option<GuardSettings>> {
    root.optional("guard", |field| {
        let table = Keys { table: field.table(KEYS)?, context };
        let damping = table.table.per_joint("stop_damping", context.joints, &quantity::STOP_DAMPING);
        // Without a robot there is nothing to compare with, and the file is bad already.
        let (_, period) = context.times?;
        let mut guard = GuardSettings::usual(&context.robot?.limits, period);
        let read = [
            table.per_joint("torque_limit", &quantity::TORQUE_LIMIT, &mut guard.torque_limit),
            table.per_joint("torque_rate_limit", &quantity::TORQUE_RATE_LIMIT, &mut guard.torque_rate_limit),
            table.count("max_age", "age in control periods", 0, &mut guard.max_age),
            table.per_joint("region", &quantity::DISTANCE, &mut guard.region),
            table.rejoin(&mut guard.rejoin),
            table.ends(&mut guard),
            table.believed(&mut guard.believed),
            table.collision(&mut guard),
            table.number("residual_bandwidth", &quantity::BANDWIDTH, &mut guard.residual_bandwidth),
        ];
        guard.stop_damping = damping?;
        read.into_iter().collect::<Option<()>>().map(|()| guard)
    })
}

/// Each reader puts what is there in the place of what is usual; none after it has noted what is wrong.
struct Keys<'a> {
    table: Table<'a>,
    context: &'a Context<'a>,
}

impl<'a> Keys<'a> {
    fn put<T>(&self, key: &str, read: impl FnOnce(&Field<'a>) -> Option<T>, to: &mut T) -> Option<()> {
        if let Some(found) = self.table.optional(key, read)? {
            *to = found;
        }
        Some(())
    }

    fn per_joint(&self, key: &str, quantity: &Quantity, to: &mut Vec<f64>) -> Option<()> {
        self.put(key, |field| field.per_joint(self.context.joints, quantity), to)
    }

    fn number(&self, key: &str, quantity: &Quantity, to: &mut f64) -> Option<()> {
        self.put(key, |field| field.number(quantity), to)
    }

    fn count(&self, key: &str, what: &str, least: u64, to: &mut u32) -> Option<()> {
        self.put(key, |field| u32::try_from(field.whole(what, least, MOST)?).ok(), to)
    }

    fn rejoin(&self, rejoin: &mut Rejoin) -> Option<()> {
        let settle = rejoin.settle;
        let read = [
            self.count("rejoin_after", "control periods", 1, &mut rejoin.after),
            self.per_joint("rejoin_speed", &quantity::VELOCITY_LIMIT, &mut rejoin.speed),
            self.per_joint("rejoin_error", &quantity::DISTANCE, &mut rejoin.error),
            self.number("rejoin_duration", &quantity::DURATION, &mut rejoin.duration),
        ];
        rejoin.settle = settle.min(rejoin.duration);
        let settle = self.number("rejoin_settle", &quantity::DURATION, &mut rejoin.settle);
        read.into_iter().chain([settle]).collect()
    }

    /// What ends a stop that does not end well.
    fn ends(&self, guard: &mut GuardSettings) -> Option<()> {
        let off = self.table.optional("off_after", |field| field.number(&quantity::DURATION));
        let stops = self.table.optional("latch_stops", |field| {
            field.whole("stops after which somebody must look", 1, LATCH_MOST)
        });
        let within = self.table.optional("latch_within", |field| field.number(&quantity::DURATION));
        let watchdog = self
            .table
            .optional("watchdog", |field| field.whole("age of commands in control periods", 1, MOST));
        let (off, stops, within) = (off?, stops?, within?);
        guard.off_after = off;
        guard.watchdog = watchdog?.and_then(|periods| u32::try_from(periods).ok());
        guard.latch = match (stops, within) {
            (Some(stops), Some(within)) => Some((u32::try_from(stops).ok()?, within)),
            (None, None) => None,
            _ => {
                self.table.error(
                    "missing-key",
                    "guard: latch_stops and latch_within must both be given",
                    "latch_stops = 3 and latch_within = 10.0: the third stop in ten seconds lasts",
                );
                return None;
            }
        };
        Some(())
    }

    fn believed(&self, believed: &mut Believed) -> Option<()> {
        let mut position = Vec::new();
        let read = [
            self.per_joint("position", &quantity::DISTANCE, &mut position),
            self.per_joint("speed", &quantity::VELOCITY_LIMIT, &mut believed.speed),
            self.per_joint("deflection", &quantity::DEFLECTION_LIMIT, &mut believed.deflection),
            self.per_joint("jump", &quantity::DISTANCE, &mut believed.jump),
            self.count("frozen_after", "control periods", 1, &mut believed.frozen.0),
            self.number("frozen_travel", &quantity::DISTANCE, &mut believed.frozen.1),
            self.per_joint("velocity_gap", &quantity::VELOCITY_LIMIT, &mut believed.velocity_gap),
            self.per_joint("motor_residual", &quantity::RESIDUAL, &mut believed.motor_residual),
        ];
        if !position.is_empty() {
            believed.position = [position.iter().map(|x| -x).collect(), position];
        }
        read.into_iter().collect()
    }

    fn collision(&self, guard: &mut GuardSettings) -> Option<()> {
        let threshold = self
            .table
            .optional("collision", |field| field.per_joint(self.context.joints, &quantity::RESIDUAL));
        let (mut reaction, mut retract) = (Reaction::Stop, 0.2);
        let reactions =
            [("stop", Reaction::Stop), ("float", Reaction::Float), ("retract", Reaction::Retract)];
        let read = [
            self.put("reaction", |field| field.choice(&reactions), &mut reaction),
            self.number("retract_duration", &quantity::DURATION, &mut retract),
        ];
        guard.collision = threshold?.map(|threshold| Collision { threshold, reaction, retract });
        read.into_iter().collect()
    }
}

/// Most stops that a latch can count.
const LATCH_MOST: u64 = flexure_core::guard::Log::<f64, 1>::CAPACITY as u64;
