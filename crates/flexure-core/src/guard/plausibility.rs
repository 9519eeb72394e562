//! Readings that are numbers and yet cannot be true.

use super::faults::Faults;
use super::{Fault, Seen};
use crate::linalg::Vector;
use crate::memory::{Memory, Port};
use crate::scalar::{Float, Piecewise};

/// What is believed of readings; infinite bounds believe everything. Positions in rad, speeds in rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plausible<C, const N: usize> {
    /// Least and largest position of links and motors.
    pub position: [Vector<C, N>; 2],
    /// Largest speed of links and motors.
    pub speed: Vector<C, N>,
    /// Largest deflection of the springs.
    pub deflection: Vector<C, N>,
    /// Farthest that a reading may be from the last one of its joint and side that was believed, beside what the robot has gone on
    /// since: at the speed that it had then, for a quarter of a second at most.
    pub jump: Vector<C, N>,
    /// When a reading that stays the same to the bit is no reading.
    pub frozen: Option<Frozen<C>>,
    /// Largest difference of the velocity from the rate of the position, through a low pass of ten control periods.
    pub velocity: Vector<C, N>,
    /// Largest torque on the motors that their momenta show and the model does not [N m]: from outside nothing turns a motor,
    /// so that it is the spring between the readings of both sides that is wrong.
    pub motor_torque: Vector<C, N>,
}

/// A reading is frozen that does not change for `periods` control periods while the other side of the joint, or where the
/// links shall be, moves by more than `travel`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frozen<C> {
    /// Control periods.
    pub periods: u32,
    /// In rad.
    pub travel: C,
}

/// Longest time in s for which a robot is thought to go on as fast as when it was last believed.
const GOING_ON: (i32, i32) = (1, 4);

/// Share of the difference of velocities that a period brings in.
const SHARE: (i32, i32) = (1, 10);

impl<C: Float, const N: usize> Plausible<C, N> {
    /// Believes every number.
    pub const ANYTHING: Self = {
        let any = Vector([C::INFINITY; N]);
        Self {
            position: [Vector([C::NEG_INFINITY; N]), any],
            speed: any,
            deflection: any,
            jump: any,
            frozen: None,
            velocity: any,
            motor_torque: any,
        }
    };

    pub(super) fn is_sound(&self) -> bool {
        let Self { position: [least, most], speed, deflection, jump, frozen, velocity, motor_torque } = self;
        let bounds = [speed, deflection, jump, velocity, motor_torque];
        bounds.iter().all(|bound| bound.iter().all(|x| x > C::ZERO))
            && least.iter().zip(most.iter()).all(|(least, most)| least < most)
            && frozen.is_none_or(|frozen| frozen.periods > 0 && frozen.travel > C::ZERO)
    }
}

/// What has to be remembered of the readings to doubt them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watch<C, const N: usize> {
    link: Side<C, N>,
    motor: Side<C, N>,
}

/// Of the encoders of one side; NaN where there was no reading yet.
#[derive(Clone, Copy, Debug)]
struct Side<C, const N: usize> {
    /// The last position that was believed in rad, the speed then [rad/s], and the time since in s.
    believed: Vector<C, N>,
    speed: Vector<C, N>,
    since: Vector<C, N>,
    /// The last position in rad.
    last: Vector<C, N>,
    /// Control periods since it changed.
    same: Vector<C, N>,
    /// Where the other side was then, and where the links should have been, in rad.
    other: Vector<C, N>,
    target: Vector<C, N>,
    /// 1 while the reading is frozen.
    frozen: Vector<C, N>,
    /// Velocity minus rate of the position, filtered [rad/s].
    gap: Vector<C, N>,
}

impl<C: Float, const N: usize> Watch<C, N> {
    pub fn new() -> Self {
        let none = Vector([C::NAN; N]);
        let zero = Vector::ZERO;
        let side = Side {
            believed: none,
            speed: zero,
            since: zero,
            last: none,
            same: zero,
            other: none,
            target: none,
            frozen: zero,
            gap: zero,
        };
        Self { link: side, motor: side }
    }

    /// Adds what is not to be believed to the `faults` of readings that are there, a time of `elapsed` in s after those before. `moving`
    /// says that the robot is to follow where it shall be.
    #[inline]
    pub fn doubt(
        &mut self,
        plausible: &Plausible<C, N>,
        elapsed: C,
        seen: &Seen<C, N>,
        moving: bool,
        faults: &mut Faults<N>,
    ) {
        let Seen { x, read: [q_l, q_m], target, residual, .. } = seen;
        let target = target.unwrap_or(Vector::ZERO);
        let wound: Vector<bool, N> =
            Vector::from_fn(|i| Piecewise::abs(q_m[i] - q_l[i]) > plausible.deflection[i]);
        let torn: Vector<bool, N> =
            Vector::from_fn(|i| Piecewise::abs(residual.motor[i]) > plausible.motor_torque[i]);
        let sides = [
            (&mut self.link, &mut faults.link, q_l, q_m, &x.v_l),
            (&mut self.motor, &mut faults.motor, q_m, q_l, &x.v_m),
        ];
        for (side, faults, q, other, v) in sides {
            for i in 0..N {
                let now = Now { q: q[i], v: v[i], other: other[i], target: target[i], moving };
                let doubt = side.doubt(plausible, elapsed, i, &now);
                let both = if wound[i] {
                    Some(Fault::Deflection)
                } else if torn[i] {
                    Some(Fault::Contradiction)
                } else {
                    None
                };
                faults[i] = faults[i].or(doubt).or(both);
                if faults[i].is_none() && now.q.is_finite() {
                    (side.believed[i], side.speed[i], side.since[i]) =
                        (now.q, Piecewise::abs(now.v), C::ZERO);
                }
            }
        }
    }
}

/// A joint on one side.
struct Now<C> {
    q: C,
    v: C,
    other: C,
    target: C,
    moving: bool,
}

impl<C: Float, const N: usize> Side<C, N> {
    #[inline]
    fn doubt(&mut self, plausible: &Plausible<C, N>, elapsed: C, i: usize, now: &Now<C>) -> Option<Fault> {
        let &Now { q, v, .. } = now;
        let rate = (q - self.last[i]) / elapsed;
        let difference = v - rate;
        self.gap[i] = if difference.is_finite() {
            self.gap[i] + (difference - self.gap[i]) * C::from_ratio(SHARE.0, SHARE.1)
        } else {
            C::ZERO
        };
        self.since[i] += elapsed;
        let passed = Piecewise::min(self.since[i], C::from_ratio(GOING_ON.0, GOING_ON.1));
        let far = plausible.jump[i] + self.speed[i] * passed;
        let frozen = self.is_frozen(plausible.frozen, i, now);
        self.last[i] = q;
        let [least, most] = plausible.position.map(|bound| bound[i]);
        // Comparisons with what is not a number are false.
        if q < least || q > most {
            Some(Fault::Position)
        } else if Piecewise::abs(v) > plausible.speed[i] {
            Some(Fault::Speed)
        } else if Piecewise::abs(q - self.believed[i]) > far {
            Some(Fault::Jump)
        } else if frozen {
            Some(Fault::Frozen)
        } else if Piecewise::abs(self.gap[i]) > plausible.velocity[i] {
            Some(Fault::Velocity)
        } else {
            None
        }
    }

    /// Once frozen, a reading is so until it changes.
    #[inline]
    fn is_frozen(&mut self, frozen: Option<Frozen<C>>, i: usize, now: &Now<C>) -> bool {
        let Some(Frozen { periods, travel }) = frozen else { return false };
        if now.q != self.last[i] {
            (self.same[i], self.frozen[i]) = (C::ZERO, C::ZERO);
            (self.other[i], self.target[i]) = (now.other, now.target);
            return false;
        }
        self.same[i] += C::ONE;
        let far = |now: C, then: C| Piecewise::abs(now - then) > travel;
        let moved = far(now.other, self.other[i]) || now.moving && far(now.target, self.target[i]);
        if moved && self.same[i] >= C::from_f64(f64::from(periods)) {
            self.frozen[i] = C::ONE;
        }
        self.frozen[i] > C::ZERO
    }
}

/// `link` and `motor`.
impl<C: Float, const N: usize> Memory<C> for Watch<C, N> {
    #[inline]
    fn memory(&mut self, port: &mut dyn Port<C>) {
        port.part("link", &mut self.link);
        port.part("motor", &mut self.motor);
    }
}

/// `believed` in rad, the `speed` then [rad/s] and the time `since` in s, `last`, of the last change `other` and `target` in rad and `same`, the control periods since; whether it is
/// `frozen`, 0 or 1; `gap` [rad/s].
impl<C: Float, const N: usize> Memory<C> for Side<C, N> {
    #[inline]
    fn memory(&mut self, port: &mut dyn Port<C>) {
        let Self { believed, speed, since, last, same, other, target, frozen, gap } = self;
        port.joints("believed", "rad", &mut believed.0);
        port.joints("speed", "rad/s", &mut speed.0);
        port.joints("since", "s", &mut since.0);
        port.joints("last", "rad", &mut last.0);
        port.joints("same", "control periods", &mut same.0);
        port.joints("other", "rad", &mut other.0);
        port.joints("target", "rad", &mut target.0);
        port.joints("frozen", "0 or 1", &mut frozen.0);
        port.joints("gap", "rad/s", &mut gap.0);
    }
}
