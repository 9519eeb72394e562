//! What stages remember, saved and restored; and robots with fewer joints than there is room for.

use std::slice;

use flexure::core::estimate::Estimator;
use flexure::core::linalg::Vector;
use flexure::core::memory::{Memory, length, restore, save};
use flexure::core::model::{Fjr, Motion};
use flexure::core::robots::PlanarTwoLink;
use flexure::estimators::{AnyEstimator, estimator};
use flexure::imperfections::stages::{Actuator, Computer, Sensors, Tick};
use flexure::imperfections::{Effects, Imperfection};

use super::{PERIOD, motion, registered, torque};

/// Everything between motion and torque that remembers.
struct Devices {
    sensors: Sensors,
    estimator: Option<AnyEstimator<f64, 2>>,
    computer: Computer,
    actuator: Actuator,
}

impl Devices {
    fn new(imperfections: &[Imperfection], seed: u64) -> Self {
        let Effects { sensors, computer, mut actuator, velocities, .. } =
            Effects::of(imperfections, 2, PERIOD, seed);
        actuator.start(&Vector([0.5, -0.25]));
        Self { sensors, estimator: estimator(None, velocities, PERIOD), computer, actuator }
    }

    /// All that is read, estimated and given in the control instants `range`.
    fn run(&mut self, range: std::ops::Range<u64>) -> Vec<u64> {
        range.flat_map(|k| self.step(&Tick::new(k, PERIOD))).map(f64::to_bits).collect()
    }

    fn step(&mut self, tick: &Tick) -> Vec<f64> {
        let one = Vector([1.0; 2]);
        let links = PlanarTwoLink::new([1.0; 2], 1.0, [0.5; 2], [1.0; 2]);
        let robot = Fjr { links, motor_inertia: one, stiffness: one, link_damping: one, motor_damping: one };
        let measured = self.sensors.sense(tick, &motion(tick.t));
        let x = measured.motion;
        let seen = self.estimator.as_mut().map_or(x, |filter| filter.update(&robot, &x.q_l, &x.q_m, &one));
        let command = if self.computer.misses(tick) { Vector::ZERO } else { torque(tick.t) };
        let given = self.actuator.actuate(tick, command);
        let parts = [seen.q_l, seen.q_m, seen.v_l, seen.v_m].into_iter().chain(given.iter().map(|(_, u)| u));
        parts.flat_map(|vector| vector.0).chain(measured.age.map(f64::from)).collect()
    }

    fn parts(&mut self) -> impl Iterator<Item = &mut dyn Memory<f64>> {
        let estimator = self.estimator.as_mut().map(|estimator| estimator as &mut dyn Memory<f64>);
        [&mut self.sensors as &mut dyn Memory<f64>, &mut self.computer, &mut self.actuator]
            .into_iter()
            .chain(estimator)
    }

    fn save(&mut self) -> Vec<Vec<f64>> {
        let saved = |part: &mut dyn Memory<f64>| {
            let mut saved = vec![0.0; length(part, 2)];
            save(part, 2, &mut saved).expect("as long as it says");
            saved
        };
        self.parts().map(saved).collect()
    }

    fn restore(&mut self, saved: &[Vec<f64>]) {
        for (part, saved) in self.parts().zip(saved) {
            restore(part, 2, saved).expect("saved of something made alike");
        }
    }
}

fn bits(saved: &[Vec<f64>]) -> Vec<u64> {
    saved.iter().flatten().map(|x| x.to_bits()).collect()
}

/// Run, save, run on, restore, run again: the same bits. Others of the same kinds, with another seed and another past, go on like
/// it, too.
fn survives(imperfections: &[Imperfection]) {
    let kinds: Vec<_> = imperfections.iter().map(Imperfection::kind).collect();
    for split in [0, 1, 7, 100] {
        let mut devices = Devices::new(imperfections, 7);
        devices.run(0..split);
        let saved = devices.save();
        let first = devices.run(split..split + 200);
        devices.restore(&saved);
        assert_eq!(bits(&devices.save()), bits(&saved), "{kinds:?}");
        assert!(devices.run(split..split + 200) == first, "{kinds:?} after {split} instants");
        let mut others = Devices::new(imperfections, 8);
        others.run(0..33);
        others.restore(&saved);
        assert!(others.run(split..split + 200) == first, "others of {kinds:?} after {split} instants");
    }
}

#[test]
fn every_kind_can_be_saved_and_restored() {
    let mut remembering = 0;
    for (_, strengths) in registered() {
        strengths.iter().flatten().for_each(|imperfection| survives(slice::from_ref(imperfection)));
        let [.., much] = strengths;
        remembering +=
            usize::from(Devices::new(&[much.unwrap()], 7).save().iter().any(|part| !part.is_empty()));
    }
    assert!(remembering >= 8, "four sensors, a filter, three of drives");
    let all: Vec<_> = registered().filter_map(|(_, [.., much])| much).collect();
    survives(&all);
}

/// In vectors with room for four joints a robot of two has the same bits, and nothing happens to the others.
#[test]
fn joints_that_are_none_are_left_alone() {
    let wide = |x: Vector<f64, 2>| Vector([x[0], x[1], 0.0, 0.0]);
    let narrow = |x: Vector<f64, 4>| {
        assert_eq!([x[2], x[3]].map(f64::to_bits), [0; 2]);
        [x[0], x[1]].map(f64::to_bits)
    };
    let exactly = |x: Vector<f64, 2>| x.0.map(f64::to_bits);
    for (kind, strengths) in registered() {
        for imperfections in strengths.into_iter().flatten().map(|imperfection| [imperfection]) {
            let [mut exact, mut padded] = [(); 2].map(|()| Devices::new(&imperfections, 7));
            exact.actuator.start(&Vector([1.0, 2.0]));
            padded.actuator.start(&Vector([1.0, 2.0, 0.0, 0.0]));
            for tick in (0..100).map(|k| Tick::new(k, PERIOD)) {
                let Motion { q_l, q_m, v_l, v_m } = motion(tick.t);
                let x = Motion { q_l: wide(q_l), q_m: wide(q_m), v_l: wide(v_l), v_m: wide(v_m) };
                let (a, b) = (exact.sensors.sense(&tick, &motion(tick.t)), padded.sensors.sense(&tick, &x));
                assert_eq!((a.age, a.placed), (b.age, b.placed), "{kind}");
                let (x, y) = (a.motion, b.motion);
                let pairs = [(x.q_l, y.q_l), (x.q_m, y.q_m), (x.v_l, y.v_l), (x.v_m, y.v_m)];
                assert!(pairs.into_iter().all(|(x, y)| exactly(x) == narrow(y)), "{kind}");
                let command = torque(tick.t);
                let a = exact.actuator.actuate(&tick, command);
                let b = padded.actuator.actuate(&tick, wide(command));
                let pairs = a.iter().zip(b.iter());
                assert!(a.iter().count() == b.iter().count());
                assert!(
                    pairs
                        .into_iter()
                        .all(|((s, a), (t, b))| s.to_bits() == t.to_bits() && exactly(a) == narrow(b)),
                    "{kind}"
                );
            }
        }
    }
}
