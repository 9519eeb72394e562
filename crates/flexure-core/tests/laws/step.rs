//! How memory moves from one control instant to the next.

use flexure_core::control::{Applied, ControlByInterconnection, ControlLaw, DynamicLaw, Running, Seen};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::reference::{Reference, Sine};
use flexure_core::scalar::{Dual, Jet};

use crate::all::{Visitor, every, link_position_feedback, position_feedback};
use crate::common::plant::{Arm, Push, advance, plausible_arm};
use crate::common::{Numbers, branched, flexible, serial};

/// A law that says that no joint moves another's memory tells the truth.
struct Jointwise<L, const N: usize> {
    robot: Fjr<f64, L, N>,
    x: Motion<f64, N>,
    q_ld: Vector<Jet<f64, 5>, N>,
    /// Laws that say so, and others.
    found: [usize; 2],
}

impl<L: Links<f64, N>, const N: usize> Visitor<N> for Jointwise<L, N> {
    fn fixed(&mut self, _: &str, _: &impl ControlLaw<f64, N>) {}

    fn dynamic<const K: usize>(&mut self, name: &str, law: &impl DynamicLaw<f64, N, K>) {
        let mut coupled = 0.0_f64;
        let x = self.x.map(Dual::<f64, 1>::constant);
        let q_ld = self.q_ld.map(|q| Jet::from_fn(|k| Dual::constant(q.coefficient(k))));
        let z = law.start(&self.robot, &x, &q_ld);
        for column in 0..K {
            for j in 0..N {
                let mut seeded = z;
                seeded[column][j].gradient = [1.0];
                let rate = law.rate(&self.robot, &x, &q_ld, &seeded, &Applied::NOTHING);
                for i in (0..N).filter(|&i| i != j) {
                    coupled = rate.iter().fold(coupled, |m, part| m.max(part[i].gradient[0].abs()));
                }
            }
        }
        let says = says(law);
        assert_eq!(coupled == 0.0, says, "{name}: {coupled}");
        self.found[usize::from(!says)] += 1;
    }
}

fn says<F: DynamicLaw<f64, N, K>, const N: usize, const K: usize>(_: &F) -> bool {
    F::JOINTWISE
}

#[test]
fn laws_that_say_so_couple_no_joints() {
    let r = &mut Numbers(9);
    let mut on = Jointwise {
        robot: flexible(branched::<5>(2), r),
        x: r.motion(1.0),
        q_ld: r.series(1.0),
        found: [0; 2],
    };
    every(&mut on, r);
    assert!(on.found.iter().all(|&count| count > 0));
}

/// Both ways of a step are the trapezoidal rule: z⁺ − z − T/2 (ż + ż⁺) is nothing.
struct Trapezoidal<L, const N: usize> {
    robot: Fjr<f64, L, N>,
    seen: [Seen<f64, N>; 2],
    applied: Applied<f64, N>,
}

impl<L: Links<f64, N>, const N: usize> Visitor<N> for Trapezoidal<L, N> {
    fn fixed(&mut self, _: &str, _: &impl ControlLaw<f64, N>) {}

    fn dynamic<const K: usize>(&mut self, name: &str, law: &impl DynamicLaw<f64, N, K>) {
        let (period, [before, now]) = (1e-3, &self.seen);
        let z = law.start(&self.robot, &before.x, &before.q_ld);
        let next = law.advanced(&self.robot, [before, now], &z, &self.applied, period);
        let rate = |seen: &Seen<f64, N>, z: &[Vector<f64, N>; K]| {
            law.rate(&self.robot, &seen.x, &seen.q_ld, z, &self.applied)
        };
        let (first, last) = (rate(before, &z), rate(now, &next));
        for k in 0..K {
            for i in 0..N {
                let step = 0.5 * period * (first[k][i] + last[k][i]);
                // What two Newton steps leave of mild nonlinearity, and rounding.
                let scale = 1.0 + step.abs() + next[k][i].abs();
                assert!((next[k][i] - z[k][i] - step).abs() < 1e-9 * scale, "{name}: part {k}");
            }
        }
    }
}

#[test]
fn steps_are_trapezoidal() {
    let r = &mut Numbers(10);
    let robot = flexible(serial::<7>(), r);
    let x = r.motion(0.5);
    let moved = |v: &Vector<f64, 7>, r: &mut Numbers| *v + r.vector(1e-3);
    let v_m = moved(&x.v_m, r);
    // Increments of motor positions are the trapezoidal rule of velocities: what one law takes instead.
    let q_m = x.q_m + (x.v_m + v_m).scaled(0.5e-3);
    let next = Motion { q_l: moved(&x.q_l, r), q_m, v_l: moved(&x.v_l, r), v_m };
    let q_ld = r.series(0.5);
    let seen = [Seen { x, q_ld }, Seen { x: next, q_ld }];
    every(&mut Trapezoidal { robot, seen, applied: Applied::fully(r.vector(5.0)) }, r);
}

fn reference() -> Sine<f64, 2> {
    Sine { amplitude: Vector([0.3; 2]), frequency: Vector([2.0; 2]), ..Sine::ZERO }
}

/// Where an arm is after half a second under a law with memory that acts so many times.
fn after<F: DynamicLaw<f64, 2, K>, const K: usize>(law: &F, steps: u32) -> Motion<f64, 2> {
    let period = 0.5 / f64::from(steps);
    let robot: Arm = plausible_arm();
    let mut x = Motion::at_rest(Vector::ZERO);
    let mut running = Running::start(law, &robot, &x, &reference().at(0.0));
    let mut applied = Applied::NOTHING;
    for k in 0..steps {
        let q_ld = reference().at(f64::from(k) * period);
        if k > 0 {
            running.advance(law, &robot, &x, &q_ld, &applied, period);
        }
        applied = Applied::fully(law.torque(&robot, &x, &q_ld, &running.memory));
        x = advance(&robot, &x, &applied.given, &Push::NONE, period, 25_000 / steps);
    }
    x
}

/// What the memory step alone adds to a loop whose torque is held is of second order: with the held torque's own first order taken out by Richardson
/// extrapolation, halving the period quarters what is left.
fn is_of_second_order<F: DynamicLaw<f64, 2, K>, const K: usize>(law: &F) {
    let [a, b, c, d] = [125, 250, 500, 1000].map(|steps| after(law, steps).q_l[0]);
    let extrapolated = [2.0 * b - a, 2.0 * c - b, 2.0 * d - c];
    let ratio = (extrapolated[0] - extrapolated[1]) / (extrapolated[1] - extrapolated[2]);
    assert!((3.0..5.5).contains(&ratio), "{ratio} of {extrapolated:?}");
}

#[test]
fn halving_the_period_quarters_the_error() {
    let r = &mut Numbers(12);
    is_of_second_order(&position_feedback::<2>(r));
    let mut observed = link_position_feedback::<2>(r);
    observed.observer = [90.0, 2700.0, 27000.0, 0.0].map(|l| Vector([l; 2]));
    is_of_second_order(&observed);
}

/// The Casimir x_1 − θ stays what it was over ten seconds, and where it is not 0 the loop rests beside the goal by it.
#[test]
fn the_casimir_stays_and_shifts_the_rest() {
    let robot: Arm = plausible_arm();
    let law = ControlByInterconnection {
        stiffness: Vector([12.0, 6.0]),
        elastic: Vector([120.0, 60.0]),
        viscous: Vector([4.0, 2.0]),
    };
    let (goal, off, period) = (Vector([0.5, -0.4]), Vector([0.1, -0.05]), 1e-3);
    let q_ld = goal.map(Jet::value);
    let mut x = Motion::at_rest(Vector::ZERO);
    let mut running = Running::start(&law, &robot, &x, &q_ld);
    running.memory[0] += off;
    let mut applied = Applied::NOTHING;
    for k in 0..10_000 {
        if k > 0 {
            running.advance(&law, &robot, &x, &q_ld, &applied, period);
        }
        let casimir = running.memory[0] - x.q_m - off;
        assert!(casimir.iter().all(|c| c.abs() < 1e-12), "{casimir:?}");
        applied = Applied::fully(law.torque(&robot, &x, &q_ld, &running.memory));
        x = advance(&robot, &x, &applied.given, &Push::NONE, period, 20);
    }
    // The arm lies flat: without gravity it rests where x_1 is at the goal.
    for i in 0..2 {
        assert!((x.q_m[i] - (goal[i] - off[i])).abs() < 1e-3, "{:?}", x.q_m);
    }
}
