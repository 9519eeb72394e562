//! Time stepping for plants that are not smooth: dry friction, play, hysteresis.
//!
//! The midpoint rule in velocities, linearly implicit. Over a step of h the acceleration a = (v⁺ − v)/h is constant and
//! torques are those at the middle, q + h/2 v + h²/4 a and v + h/2 a: dampers and springs there implicitly, the springs by
//! their slope; mass matrix, gravity and velocity products where the last acceleration would lead to. Dry friction acts
//! against the speed v⁺ at the end, so that what comes to rest is at rest; a step in which a joint turns back ends there first. Of order 2 where nothing sticks or yields;
//! with linear springs and a constant mass matrix the energy balance is exact whatever the step.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Links, Motion};

use crate::plant::{Friction, Plant, Sides};
use crate::simulate::collocation::is_finite;
use crate::simulate::gauss::{StepFailure, steps_in};
use crate::simulate::ledger::Ledger;
use crate::simulate::midpoint::middle;
use crate::simulate::stiction::{Slid, Stiction};

/// Times that joints turn back within a step, at most; what turns later in it rubs as it does at the end.
const TURNS: usize = 4;

/// Moves a plant in short equal steps; remembers what its hysteresis remembers.
#[derive(Clone, Debug)]
pub struct Stepping<const N: usize> {
    /// Longest step in s.
    pub(crate) longest: f64,
    /// Torque of the hysteresis on the links [N m].
    pub(crate) hysteresis: Vector<f64, N>,
    /// Accelerations of the last step [rad/s²].
    pub(crate) last: Sides<N>,
    pub(crate) steps: u64,
}

/// Spring torque over a step: `load` − `slope` (a_l − a_m).
struct Spring<const N: usize> {
    /// [N m].
    load: Vector<f64, N>,
    /// [kg m²].
    slope: Vector<f64, N>,
}

impl<const N: usize> Stepping<N> {
    /// Longest step in s that is good for robots: the inertia of a motor comes out of a log as it is to a thousandth. With 0.25 ms it is
    /// 0.2 % too large.
    pub const STEP: f64 = 0.1e-3;

    /// With steps of at most `longest` s, hysteresis relaxed.
    pub fn new(longest: f64) -> Self {
        Self { longest, hysteresis: Vector::ZERO, last: [Vector::ZERO; 2], steps: 0 }
    }

    /// Steps taken so far.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Torque of the hysteresis on the links [N m].
    pub fn hysteresis_torque(&self) -> &Vector<f64, N> {
        &self.hysteresis
    }

    /// Moves `x` over `[t, t + interval]` under the torque `u_m(t, x)`, which is asked for in the middle of a step and of what is left of it;
    /// books the work in `ledger`.
    ///
    /// # Errors
    /// [`StepFailure`] if the motion leaves the finite numbers.
    pub fn advance<L: Links<f64, N>>(
        &mut self,
        plant: &Plant<L, N>,
        mut x: Motion<f64, N>,
        t: f64,
        interval: f64,
        torque: &dyn Fn(f64, &Motion<f64, N>) -> Vector<f64, N>,
        ledger: &mut Ledger,
    ) -> Result<Motion<f64, N>, StepFailure> {
        let count = steps_in(interval, self.longest);
        let h = interval / f64::from(count);
        for i in 0..count {
            let after = h * f64::from(i);
            x = self.over(plant, &x, t + after, h, torque, ledger);
            if !is_finite(&x) {
                return Err(StepFailure { after });
            }
        }
        Ok(x)
    }

    /// A step of `h` s from `x` at `t`. Where a joint turns back in it, friction acts one way until then and the other way after: a step up
    /// to there, and one for what is left.
    #[inline(never)]
    fn over<L: Links<f64, N>>(
        &mut self,
        plant: &Plant<L, N>,
        x: &Motion<f64, N>,
        t: f64,
        h: f64,
        torque: &dyn Fn(f64, &Motion<f64, N>) -> Vector<f64, N>,
        ledger: &mut Ledger,
    ) -> Motion<f64, N> {
        let (mut x, mut done, mut turns) = (*x, 0.0, 0);
        loop {
            let left = h - done;
            let ahead = middle(&x, &self.last, left);
            let u_m = torque(t + done + 0.5 * left, &ahead);
            let stiction = self.stiction(plant, &x, &ahead, &u_m, left);
            let solved = stiction.solve();
            let Some(part) = stiction.first_turn(&solved).filter(|_| turns < TURNS) else {
                return self.moved(plant, &x, &u_m, left, &solved, ledger);
            };
            let until = part * left;
            let ahead = middle(&x, &self.last, until);
            let solved = self.stiction(plant, &x, &ahead, &u_m, until).solve();
            x = self.moved(plant, &x, &u_m, until, &solved, ledger);
            done += until;
            turns += 1;
        }
    }

    /// Where `solved` leads to from `x` in `h` s.
    fn moved<L: Links<f64, N>>(
        &mut self,
        plant: &Plant<L, N>,
        x: &Motion<f64, N>,
        u_m: &Vector<f64, N>,
        h: f64,
        solved: &Slid<N>,
        ledger: &mut Ledger,
    ) -> Motion<f64, N> {
        self.steps += 1;
        let moved = |v: &Vector<f64, N>, side: usize| -> Vector<f64, N> {
            let a = &solved.accelerations[side];
            Vector::from_fn(|i| solved.slides[side][i].map_or(0.0, |_| v[i] + h * a[i]))
        };
        let (v_l, v_m) = (moved(&x.v_l, 0), moved(&x.v_m, 1));
        let mean = [(x.v_l + v_l).scaled(0.5), (x.v_m + v_m).scaled(0.5)];
        let turned = mean.map(|v| v.scaled(h));
        let end = Motion { q_l: x.q_l + turned[0], q_m: x.q_m + turned[1], v_l, v_m };

        let yielded = self.remember(plant, &(turned[1] - turned[0]));
        let supplied = turned[1].dot(u_m) + turned[0].dot(&plant.external);
        let slid = turned[0].dot(&solved.friction[0]) + turned[1].dot(&solved.friction[1]);
        let damped = turned[0].dot(&plant.robot.link_damping.diag_mul(&mean[0]))
            + turned[1].dot(&plant.robot.motor_damping.diag_mul(&mean[1]));
        ledger.add(&Ledger { supplied, dissipated: damped + slid + yielded, throughput: supplied.abs() });
        self.expect(solved);
        end
    }

    /// The equations of the step.
    fn stiction<L: Links<f64, N>>(
        &self,
        plant: &Plant<L, N>,
        x: &Motion<f64, N>,
        middle: &Motion<f64, N>,
        u_m: &Vector<f64, N>,
        h: f64,
    ) -> Stiction<N> {
        let robot = &plant.robot;
        let spring = self.spring(plant, x, middle, h);
        let mut link = robot.links.mass_matrix(&middle.q_l);
        let bias = robot.links.inverse_dynamics(&middle.q_l, &middle.v_l, &middle.v_l, &Vector::ZERO);
        for k in 0..N {
            link[(k, k)] += 0.5 * h * robot.link_damping[k] + spring.slope[k];
        }
        let motor =
            Vector::from_fn(|k| robot.motor_inertia[k] + 0.5 * h * robot.motor_damping[k] + spring.slope[k]);
        let mut between = Matrix::diagonal(&-spring.slope);
        let mut load = [
            spring.load - bias - robot.link_damping.diag_mul(&x.v_l) + plant.external,
            *u_m - spring.load - robot.motor_damping.diag_mul(&x.v_m),
        ];
        if let Some(coupling) = &plant.rotor_coupling {
            between = between + coupling.matrix(&robot.links, &middle.q_l);
            let [of_links, of_motors] = plant.coupling_torques(coupling, middle, [Vector::ZERO; 2]);
            load[0] -= of_links;
            load[1] -= of_motors;
        }
        let friction = [
            sliding(&plant.link_friction, &x.v_l, &middle.v_l),
            sliding(&plant.motor_friction, &x.v_m, &middle.v_m),
        ];
        let joints = robot.links.joints();
        Stiction { link, between, motor, load, friction, speed: [x.v_l, x.v_m], h, joints }
    }

    /// Mean torque of springs and hysteresis over a step from `x`, linear about `middle`.
    fn spring<L: Links<f64, N>>(
        &self,
        plant: &Plant<L, N>,
        x: &Motion<f64, N>,
        middle: &Motion<f64, N>,
        h: f64,
    ) -> Spring<N> {
        let (torque, tangent) = (plant.spring_torque(middle), plant.tangent_stiffness(middle));
        let rate = x.v_m - x.v_l;
        // The deflection in the middle without acceleration, and where it is expected.
        let (ahead, expected) = (x.deflection() + rate.scaled(0.5 * h), middle.deflection());
        let mut load = Vector::from_fn(|k| torque[k] + tangent[k] * (ahead[k] - expected[k]));
        let mut stiffness = tangent;
        for k in 0..N {
            let (z, inside) = (self.hysteresis[k], &plant.hysteresis);
            let elastic = inside.elastic(k, z, 2.0 * (expected[k] - x.deflection()[k]));
            if elastic.abs() <= inside.yield_torque[k] {
                load[k] += inside.elastic(k, z, 0.5 * h * rate[k]);
                stiffness[k] += inside.stiffness[k];
            } else {
                load[k] += 0.5 * (z + inside.yielded(k, elastic));
            }
        }
        Spring { load, slope: stiffness.scaled(0.25 * h * h) }
    }

    /// Updates the hysteresis after a further `deflection` in rad; the work in J that its slipping took.
    fn remember<L>(&mut self, plant: &Plant<L, N>, deflection: &Vector<f64, N>) -> f64 {
        let mut work = 0.0;
        for k in 0..N {
            let (torque, slipped) = plant.hysteresis.after(k, self.hysteresis[k], deflection[k]);
            self.hysteresis[k] = torque;
            work += slipped;
        }
        work
    }

    /// What friction has stopped is not expected to move.
    fn expect(&mut self, solved: &Slid<N>) {
        for (last, (a, slides)) in self.last.iter_mut().zip(solved.accelerations.iter().zip(&solved.slides)) {
            *last = Vector::from_fn(|i| slides[i].map_or(0.0, |_| a[i]));
        }
    }
}

/// Friction torques [N m] at the speeds expected in the middle of a step; those at rest for what may stop in it.
fn sliding<const N: usize>(
    friction: &Friction<N>,
    v: &Vector<f64, N>,
    middle: &Vector<f64, N>,
) -> Vector<f64, N> {
    Vector::from_fn(|i| friction.torque(i, (middle[i] * v[i].signum()).max(0.0) * f64::from(v[i] != 0.0)))
}
