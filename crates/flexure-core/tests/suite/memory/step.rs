//! What has a memory, gone on with.

use flexure_core::estimate::{Disturbance, DisturbanceObserver, Estimator};
use flexure_core::guard::{Age, Coasting, Guard, Seen, Torques, Watchdog};
use flexure_core::linalg::Vector;
use flexure_core::memory::{Memory, Port};
use flexure_core::model::{Links, Motion};

use super::{N, Robot, robot};
use crate::common::Numbers;

/// One control instant of something that remembers: what it says of `x`, in numbers.
pub trait Step {
    fn step(&mut self, robot: &Robot, x: &Motion<f64, N>, u: &Vector<f64, N>, k: u32) -> Vec<f64>;
}

/// Estimators as they are.
pub struct Estimating<E>(pub E);

impl<E: Memory<f64>> Memory<f64> for Estimating<E> {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        self.0.memory(port);
    }
}

impl<E: Estimator<f64, N>> Step for Estimating<E> {
    fn step(&mut self, robot: &Robot, x: &Motion<f64, N>, u: &Vector<f64, N>, _: u32) -> Vec<f64> {
        let seen = self.0.update(robot, &x.q_l, &x.q_m, u);
        [seen.q_l, seen.q_m, seen.v_l, seen.v_m].iter().flat_map(|v| v.0).collect()
    }
}

impl Step for DisturbanceObserver<f64, N> {
    fn step(&mut self, robot: &Robot, x: &Motion<f64, N>, u: &Vector<f64, N>, _: u32) -> Vec<f64> {
        let found = self.update(robot, x, u);
        [found.link, found.motor].iter().flat_map(|v| v.0).collect()
    }
}

/// A law that takes over with a jump, if it is let.
struct Jumping<'a>(&'a Robot, Vector<f64, N>);

impl Torques<f64, N> for Jumping<'_> {
    fn law(&mut self, _: &Motion<f64, N>) -> Vector<f64, N> {
        self.1
    }
    fn holding(&mut self, q_l: &Vector<f64, N>) -> Vector<f64, N> {
        self.0.links.gravity_torque(q_l)
    }
    fn joining(&mut self, _: &Motion<f64, N>, acting: &Vector<f64, N>) -> Vector<f64, N> {
        acting.scaled(0.9)
    }
}

/// Stops now and then, so that postures and waits matter: readings are stale every 17 instants and for good from 115 on, time jumps at
/// 26, something collides at 59, and velocities are not those of the readings from 36 to 40. Readings move slowly, and not
/// at all from 52 to 74, where nothing else does either, and from 80 to 97, where they freeze; they are off at 28, which cannot
/// be, at 33, which can at the speed of the instant before, and at 112, after some that did not come.
impl Step for Guard<f64, N> {
    fn step(&mut self, robot: &Robot, x: &Motion<f64, N>, u: &Vector<f64, N>, k: u32) -> Vec<f64> {
        let still = match k {
            52..75 => 52,
            80..98 => 80,
            k => k,
        };
        let off = match k {
            28 => 0.01,
            33 => 0.006,
            105..112 => f64::NAN,
            112 => 0.025,
            _ => 0.0,
        };
        let at = Vector([1e-4 * f64::from(still) + off; N]);
        let more = match k {
            27 | 31..34 | 104 => 3.0,
            36..41 => 10.0,
            _ => 0.0,
        };
        let faster = |v: Vector<f64, N>| v.map(|v| v + more);
        let x = &Motion { v_l: faster(x.v_l), v_m: faster(x.v_m), ..*x };
        let pushed = if k == 59 { Vector([60.0; N]) } else { Vector::ZERO };
        let seen = Seen {
            read: [at; 2],
            age: Age { link: u32::from(k % 17 == 9 || k >= 115), motor: 0 },
            stamp: Some(u64::from(k + u32::from(k >= 26))),
            target: Some(Vector([f64::from(k.min(40) + k.saturating_sub(80)); N])),
            residual: Disturbance { link: pushed, motor: Vector::ZERO },
            ..Seen::fresh(x)
        };
        let decision = Guard::step(self, &seen, &mut Jumping(robot, u.scaled(20.0)));
        let mut numbers = decision.torque.0.to_vec();
        let log = self.log();
        let stops = log.entries().map(|entry| {
            let cause = f64::from(entry.cause.code());
            let place = match entry.place {
                flexure_core::guard::Place::Controller => 0,
                flexure_core::guard::Place::Link(joint) => 1 + joint,
                flexure_core::guard::Place::Motor(joint) => 101 + joint,
            };
            vec![entry.time as f64, cause, f64::from(place)]
        });
        let steps = log.steps().map(|step| {
            let x = step.x;
            let motion = [x.q_l, x.q_m, x.v_l, x.v_m, step.torque].into_iter().flat_map(|v| v.0);
            [step.time as f64, f64::from(step.phase.code())].into_iter().chain(motion).collect()
        });
        numbers.extend(stops.chain(steps).flatten());
        let status = decision.status;
        let faults = status.link_fault.iter().chain(status.motor_fault.iter());
        numbers.extend(faults.map(|fault| f64::from(fault.map_or(0, flexure_core::guard::Fault::code))));
        numbers.extend([f64::from(status.phase.code()), f64::from(u8::from(status.latched))]);
        numbers
    }
}

/// Silent for three instants of seven.
impl Step for Coasting<f64, N> {
    fn step(&mut self, robot: &Robot, x: &Motion<f64, N>, u: &Vector<f64, N>, k: u32) -> Vec<f64> {
        let age = if k % 7 > 3 { Age { link: 1, motor: 1 } } else { Age::FRESH };
        let (seen, lost) = self.fill(robot, x, age, [true; 2], u);
        self.saw(&seen);
        let motion = [seen.q_l, seen.q_m, seen.v_l, seen.v_m].into_iter().flat_map(|v| v.0);
        motion.chain([lost.link, lost.motor].map(f64::from)).collect()
    }
}

/// Without a command in three periods of seven.
impl Step for Watchdog<f64, N> {
    fn step(&mut self, _: &Robot, _: &Motion<f64, N>, u: &Vector<f64, N>, k: u32) -> Vec<f64> {
        Watchdog::step(self, (k % 7 < 4).then_some(*u)).0.to_vec()
    }
}

/// Steps from instant `from` on.
pub fn run(it: &mut impl Step, from: u32, steps: u32) -> Vec<u64> {
    let robot = robot();
    let place = |k: u32| {
        let mut r = Numbers(u64::from(k));
        (r.motion(1.0), r.vector(1.0))
    };
    (from..from + steps)
        .flat_map(|k| {
            let (x, u) = place(k);
            it.step(&robot, &x, &u, k)
        })
        .map(f64::to_bits)
        .collect()
}
