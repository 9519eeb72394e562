//! One control instant of a guard.

use super::clock::Clock;
use super::collision::Felt;
use super::faults::Faults;
use super::handover::Handover;
use super::limits::allowed;
use super::phases::State;
use super::plausibility::Watch;
use super::{Age, Entry, Fault, Log, Phase, Place, Rejoin, Settings, Status, Step};
use crate::estimate::Disturbance;
use crate::linalg::Vector;
use crate::memory::{Memory, Port};
use crate::model::Motion;
use crate::scalar::{Float, Piecewise};

/// What a guard is shown at a control instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen<C, const N: usize> {
    /// The estimated motion, NaN where there is none.
    pub x: Motion<C, N>,
    /// The positions of links and motors as they were read, in rad, before any estimator; NaN where nothing was.
    pub read: [Vector<C, N>; 2],
    /// How old these readings are.
    pub age: Age,
    /// Number of the control instant, by a clock that goes on when instants are missed; none for one instant after the other.
    pub stamp: Option<u64>,
    /// Where the links shall be in rad, if it is known.
    pub target: Option<Vector<C, N>>,
    /// Torques that the model does not explain [N m]; zero where nobody estimates them.
    pub residual: Disturbance<C, N>,
}

impl<C: Float, const N: usize> Seen<C, N> {
    /// The motion `x` from readings of this instant, and nothing else known.
    #[inline]
    pub fn fresh(x: &Motion<C, N>) -> Self {
        Self {
            x: *x,
            read: [x.q_l, x.q_m],
            age: Age::FRESH,
            stamp: None,
            target: None,
            residual: Disturbance::ZERO,
        }
    }
}

/// The torques [N m] that a guard chooses from. Each is asked for only when it is needed, and may be anything.
///
/// A pair of closures, the law and the holding torque, is enough where the reference is not to be joined.
pub trait Torques<C: Copy, const N: usize> {
    /// That of the law for a robot that moves as `x`; asked for only at good readings.
    fn law(&mut self, x: &Motion<C, N>) -> Vector<C, N>;

    /// That which holds the links at `q_l` in rad against gravity; asked for only during a stop.
    fn holding(&mut self, q_l: &Vector<C, N>) -> Vector<C, N>;

    /// That of the law if the reference were joined from how the robot moves now, as `x` with the motor torque `acting` [N m].
    /// The law takes over from what acts without a jump, and only if the rate limit lets it.
    #[inline]
    fn joining(&mut self, x: &Motion<C, N>, acting: &Vector<C, N>) -> Vector<C, N> {
        let _ = x;
        *acting
    }
}

impl<C, F, G, const N: usize> Torques<C, N> for (F, G)
where
    C: Copy,
    F: FnMut(&Motion<C, N>) -> Vector<C, N>,
    G: FnMut(&Vector<C, N>) -> Vector<C, N>,
{
    #[inline]
    fn law(&mut self, x: &Motion<C, N>) -> Vector<C, N> {
        self.0(x)
    }

    #[inline]
    fn holding(&mut self, q_l: &Vector<C, N>) -> Vector<C, N> {
        self.1(q_l)
    }
}

/// What a guard answers at a control instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision<C, const N: usize> {
    /// Motor torque [N m]: finite and inside the limits.
    pub torque: Vector<C, N>,
    /// Who decided it, which limits were active, and what was wrong.
    pub status: Status<N>,
}

/// Stands between a law and the motors.
///
/// The laws have no state, so that a limit that is hit winds nothing up: the torque is the law's again as soon as the
/// limits allow it, and it never jumps by more than the rate limit times the period, neither on release nor into a stop nor
/// out of it. Estimators are fed the torque that leaves here.
///
/// ```
/// use flexure_core::guard::{Guard, Phase, Rejoin, Seen, Settings};
/// use flexure_core::linalg::Vector;
/// use flexure_core::model::Motion;
///
/// let open = Settings::open(1e-3);
/// let mut guard = Guard::new(Settings {
///     torque_limit: Vector([5.0]),
///     stop_damping: Vector([1.0]),
///     rejoin: Rejoin { after: 10, speed: Vector([0.5]), error: Vector([0.5]) },
///     ..open
/// })
/// .unwrap();
/// let seen = Seen::fresh(&Motion::at_rest(Vector([0.1])));
/// let holding = |_: &Vector<f64, 1>| Vector([2.0]);
/// // The law asks for too much, then for nonsense: a limit, then a stop that holds the robot against gravity.
/// let mut asking = |torque| guard.step(&seen, &mut (|_: &Motion<f64, 1>| Vector([torque]), holding));
/// let limited = asking(100.0);
/// assert_eq!((limited.torque, limited.status.phase), (Vector([5.0]), Phase::Following));
/// let stopped = asking(f64::NAN);
/// assert_eq!((stopped.torque, stopped.status.phase), (Vector([2.0]), Phase::Stopped));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Guard<C, const N: usize> {
    settings: Settings<C, N>,
    /// The torque that left last [N m].
    last: Vector<C, N>,
    /// Link positions of the last good reading in rad.
    posture: Option<Vector<C, N>>,
    clock: Clock,
    state: State,
    watch: Watch<C, N>,
    /// The collision that this stop is about.
    felt: Option<Felt<C, N>>,
    handover: Handover<C, N>,
    log: Log<C, N>,
}

/// The last `torque` [N m]; `good`, whether there was a good reading; its link positions `posture` in rad; `clock`; `state`;
/// `watch`, what readings are doubted by; `felt`, the collision that a stop is about; `handover`; `log`. Whatever is restored, the torque is
/// brought inside the limits, and no more readings are awaited than the settings ask.
impl<C: Float, const N: usize> Memory<C> for Guard<C, N> {
    #[inline]
    fn memory(&mut self, port: &mut dyn Port<C>) {
        let Self { settings, last, posture, clock, state, watch, felt, handover, log } = self;
        port.joints("torque", "N m", &mut last.0);
        port.optional("good", posture, Vector::ZERO, |posture, port| {
            port.joints("posture", "rad", &mut posture.0);
        });
        clock.walk(port);
        state.walk(port, settings.rejoin.after);
        port.part("watch", watch);
        port.enter("felt");
        port.optional("there", felt, Felt::NOTHING, Felt::memory);
        port.leave();
        port.part("handover", handover);
        port.part("log", log);
        let last = *last;
        *self = self.applying(&last);
    }
}

impl<C: Float, const N: usize> Guard<C, N> {
    /// Following, at zero torque. `None` for settings that are not [sound](Settings::are_sound).
    pub fn new(settings: Settings<C, N>) -> Option<Self> {
        settings.are_sound().then(|| Self {
            settings,
            last: Vector::ZERO,
            posture: None,
            clock: Clock::START,
            state: State::FOLLOWING,
            watch: Watch::new(),
            felt: None,
            handover: Handover::NONE,
            log: Log::new(),
        })
    }

    /// As if `torque` [N m] were what left it last: the rate limit counts from there. What is not finite counts as zero, what is
    /// beyond the torque limit as the limit.
    #[must_use]
    pub fn applying(mut self, torque: &Vector<C, N>) -> Self {
        let limit = &self.settings.torque_limit;
        self.last = Vector::from_fn(|i| Piecewise::clamp(finite(torque[i]), -limit[i], limit[i]));
        self
    }

    /// The limits that it was made with.
    #[inline]
    pub fn settings(&self) -> &Settings<C, N> {
        &self.settings
    }

    /// What stopped it, and when.
    #[inline]
    pub fn log(&self) -> &Log<C, N> {
        &self.log
    }

    /// Somebody has looked: a stop that is latched, or torque that is off, is an ordinary stop again, which ends when the robot
    /// is fit for the law. The log starts over. Nothing happens while the law decides.
    pub fn reset(&mut self) {
        if self.state.stopped {
            self.state.reset(&self.settings);
            self.log = Log::new();
        }
    }

    /// One control instant.
    ///
    /// A reading that is bad, a law that fails or a time that is wrong stops the robot in the same instant: holding torque of the
    /// last good posture (none before the first), less damping on the motors whose velocity is still good, within the
    /// limits.
    #[inline]
    pub fn step(&mut self, seen: &Seen<C, N>, torques: &mut impl Torques<C, N>) -> Decision<C, N> {
        let mut faults = self.faults(seen);
        let is_law_s = !faults.any() && !self.state.stopped;
        let mut asked = is_law_s.then(|| torques.law(&seen.x));
        if asked.is_some_and(|torque| !torque.iter().all(C::is_finite)) {
            (asked, faults.controller) = (None, Some(Fault::Law));
        }
        let joining = self.handover.goes_on();
        let (phase, asked) = match asked {
            Some(torque) => {
                let phase = if seen.age == Age::FRESH { Phase::Following } else { Phase::Coasting };
                (phase, self.handover.next(torque))
            }
            None => self.stop(seen, &faults, torques),
        };
        let allowed = allowed(&self.settings, &self.last, &asked);
        self.last = allowed.torque;
        self.log.note(Step { time: self.clock.now(), phase, x: seen.x, torque: allowed.torque });
        let status = Status {
            phase,
            torque_limited: allowed.torque_limited,
            rate_limited: allowed.rate_limited,
            outside: self.outside(seen),
            link_fault: faults.link,
            motor_fault: faults.motor,
            controller_fault: faults.controller,
            joining,
            latched: self.state.latched,
        };
        Decision { torque: allowed.torque, status }
    }

    /// Which links are farther from the reference than what is proved speaks of, or may be.
    #[inline]
    fn outside(&self, seen: &Seen<C, N>) -> Vector<bool, N> {
        let region = &self.settings.region;
        let off = |target: Vector<C, N>, i: usize| Piecewise::abs(seen.x.q_l[i] - target[i]);
        Vector::from_fn(|i| {
            let is_inside = seen.target.is_none_or(|target| off(target, i) <= region[i]);
            region[i].is_finite() && !is_inside
        })
    }

    /// What is wrong, before the law is asked.
    #[inline]
    fn faults(&mut self, seen: &Seen<C, N>) -> Faults<N> {
        let settings = &self.settings;
        let mut faults = Faults::missing(settings, seen);
        let (passed, fault) = self.clock.tick(seen.stamp, settings.allowed_age);
        faults.controller = fault;
        let passed = C::from_f64(f64::from(u32::try_from(passed).unwrap_or(u32::MAX)));
        self.watch.doubt(
            &settings.plausible,
            settings.period * passed,
            seen,
            !self.state.stopped,
            &mut faults,
        );
        if !faults.any() {
            self.posture = Some(seen.x.q_l);
        }
        if let Some(collision) = &settings.collision {
            collision.find(seen, &mut faults);
        }
        faults
    }

    /// An instant of a stop: who decides, and the torque that is asked for [N m].
    #[inline]
    fn stop(
        &mut self,
        seen: &Seen<C, N>,
        faults: &Faults<N>,
        torques: &mut impl Torques<C, N>,
    ) -> (Phase, Vector<C, N>) {
        if self.state.stopped {
            self.felt = self.felt.map(Felt::later);
        } else {
            self.begin(seen, faults);
        }
        let is_ready = self.state.stop(&self.settings, !faults.any());
        if self.state.is_off(&self.settings) {
            self.state.latched = true;
            return (Phase::Off, Vector::ZERO);
        }
        let asked = self.stopping(&seen.x, faults, torques);
        if is_ready && self.is_fit(seen) {
            let acting = allowed(&self.settings, &self.last, &asked).torque;
            let joining = torques.joining(&seen.x, &acting);
            if let Some(handover) = Handover::between(&self.settings, &acting, &joining) {
                (self.state, self.felt, self.handover) = (State::FOLLOWING, None, handover);
                return (Phase::Rejoined, asked);
            }
        }
        (Phase::Stopped, asked)
    }

    /// The first instant of a stop.
    #[inline]
    fn begin(&mut self, seen: &Seen<C, N>, faults: &Faults<N>) {
        let (cause, place) = faults.first().unwrap_or((Fault::Law, Place::Controller));
        self.felt = (cause == Fault::Collision).then(|| Felt::now(seen));
        self.handover = Handover::NONE;
        let time = self.clock.now();
        self.log.enter(Entry { time, cause, place });
        let within = self.settings.latch.map_or(0, |latch| u64::from(latch.within));
        self.state.count(self.settings.latch, self.log.stops_since(time.saturating_sub(within)));
    }

    /// Whether the robot is slow enough and near enough for the law.
    #[inline]
    fn is_fit(&self, seen: &Seen<C, N>) -> bool {
        let Rejoin { speed, error, .. } = &self.settings.rejoin;
        let x = &seen.x;
        let within = |v: C, bound: C| Piecewise::abs(v) <= bound;
        (0..N).all(|i| {
            let near = seen.target.is_none_or(|target| within(x.q_l[i] - target[i], error[i]));
            near && within(x.v_l[i], speed[i]) && within(x.v_m[i], speed[i])
        })
    }

    /// Torque that brings the robot to rest, or answers a collision: whatever is not finite counts as 0.
    #[inline]
    fn stopping(
        &self,
        x: &Motion<C, N>,
        faults: &Faults<N>,
        torques: &mut impl Torques<C, N>,
    ) -> Vector<C, N> {
        let held = self.posture.map_or(Vector::ZERO, |q| torques.holding(&q)).map(finite);
        let (answer, brakes) = match (self.felt, self.settings.collision) {
            (Some(felt), Some(collision)) => felt.answer(collision.reaction),
            _ => (Vector::ZERO, true),
        };
        let believed = &self.settings.plausible.speed;
        Vector::from_fn(|i| {
            let held = held[i] + finite(answer[i]);
            if brakes && faults.motor[i].is_none_or(Fault::spares_velocity) {
                let speed = Piecewise::clamp(x.v_m[i], -believed[i], believed[i]);
                finite(held - self.settings.stop_damping[i] * speed)
            } else {
                held
            }
        })
    }
}

#[inline]
fn finite<C: Float>(x: C) -> C {
    if x.is_finite() { x } else { C::ZERO }
}
