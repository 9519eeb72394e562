//! From `[guard]` of a scenario to the guard of the core.

use flexure_core::estimate::DisturbanceObserver;
use flexure_core::guard::{self, Coasting, Frozen, Guard, Latch, Plausible, Settings, Watchdog};
use flexure_core::linalg::Vector;

use crate::robot::{padded, vector};
use crate::scenario::{Believed, GuardSettings, Reaction};
use crate::simulate::guarded::Guarded;

/// Of a loop with control periods of `period` in s, whose motors gave `applied` [N m] until now.
pub(crate) fn guarded<const N: usize>(
    settings: &GuardSettings,
    period: f64,
    applied: Vector<f64, N>,
) -> Guarded<N> {
    const SOUND: &str = "the reader takes sound settings only";
    let guard = Guard::new(core(settings, period)).expect(SOUND).applying(&applied);
    let finite = |bounds: &[f64]| bounds.iter().any(|bound| bound.is_finite());
    let asked = settings.collision.is_some() || finite(&settings.believed.motor_residual);
    let residual = asked.then(|| {
        let bandwidth = Vector([settings.residual_bandwidth; N]);
        DisturbanceObserver::new(&bandwidth, period).expect(SOUND)
    });
    Guarded {
        guard,
        coasting: Coasting::new(settings.max_age, period).expect(SOUND),
        residual,
        rejoin: settings.rejoin.duration,
        settle: settings.rejoin.settle,
    }
}

/// What the drives do while no command comes, in a loop with control periods of `period` in s; they give `applied` [N m] before the
/// first one.
pub(crate) fn watchdog<const N: usize>(
    settings: Option<&GuardSettings>,
    period: f64,
    applied: Vector<f64, N>,
) -> Watchdog<f64, N> {
    let allowed = settings.and_then(|settings| settings.watchdog).unwrap_or(u32::MAX);
    let fall = settings.map_or(Vector([f64::INFINITY; N]), |settings| {
        padded(&settings.torque_rate_limit, f64::INFINITY).map(|rate: f64| rate * period)
    });
    let mut watchdog = Watchdog::new(allowed, fall).expect("rates are above 0");
    watchdog.step(Some(applied));
    watchdog
}

fn core<const N: usize>(settings: &GuardSettings, period: f64) -> Settings<f64, N> {
    let bound = |bounds: &[f64]| padded(bounds, f64::INFINITY);
    let GuardSettings { rejoin, .. } = settings;
    Settings {
        period,
        torque_limit: bound(&settings.torque_limit),
        torque_rate_limit: bound(&settings.torque_rate_limit),
        stop_damping: vector(&settings.stop_damping),
        allowed_age: settings.max_age,
        plausible: plausible(&settings.believed),
        collision: settings.collision.as_ref().map(|collision| guard::Collision {
            threshold: bound(&collision.threshold),
            reaction: match collision.reaction {
                Reaction::Stop => guard::Reaction::Stop,
                Reaction::Float => guard::Reaction::Float,
                Reaction::Retract => guard::Reaction::Retract(periods(collision.retract, period)),
            },
        }),
        region: bound(&settings.region),
        rejoin: guard::Rejoin {
            after: rejoin.after,
            speed: bound(&rejoin.speed),
            error: bound(&rejoin.error),
        },
        off_after: settings.off_after.map(|time| periods(time, period)),
        latch: settings.latch.map(|(stops, within)| Latch { stops, within: periods(within, period) }),
    }
}

fn plausible<const N: usize>(believed: &Believed) -> Plausible<f64, N> {
    let bound = |bounds: &[f64]| padded(bounds, f64::INFINITY);
    let [lower, upper] = &believed.position;
    let (periods, travel) = believed.frozen;
    Plausible {
        position: [padded(lower, f64::NEG_INFINITY), bound(upper)],
        speed: bound(&believed.speed),
        deflection: bound(&believed.deflection),
        jump: bound(&believed.jump),
        frozen: Some(Frozen { periods, travel }),
        velocity: bound(&believed.velocity_gap),
        motor_torque: bound(&believed.motor_residual),
    }
}

/// A time in whole control periods, at least one.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [1, 4e9]")]
fn periods(time: f64, period: f64) -> u32 {
    (time / period).round().clamp(1.0, 4e9) as u32
}
