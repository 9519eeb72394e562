//! The midpoint rule for smooth plants: steps of the same work whatever the motion, of one plant or of several in lanes.

use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};
use flexure_core::scalar::{Over, Piecewise};

use crate::plant::{Plant, Sides};
use crate::simulate::gauss::steps_in;
use crate::simulate::ledger::Ledger;

/// Longest step in s of a plant that is moved by the midpoint rule whatever the error. At 1 ms the paper's arm is off by 5e-6 rad a second after
/// its torques jumped, a cobot by 3e-4 rad.
pub(crate) const LONGEST: f64 = 1e-3;

/// Moves smooth plants without coupled rotors as [`Stepping`](super::Stepping) does, which is the oracle: linearly implicit in dampers and
/// springs, mass matrix, gravity and velocity products where the last acceleration leads to. Without dry friction nothing has to be decided,
/// so that lanes can do it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Midpoint<const N: usize, T> {
    /// Accelerations of the last step [rad/s²].
    pub(crate) last: Sides<N, T>,
    /// The same before the last interval: what is left of a lane that did not come through it.
    pub(crate) before: Sides<N, T>,
}

impl<const N: usize, T: Piecewise + Over<T> + Over<f64>> Midpoint<N, T> {
    /// From rest.
    pub(crate) fn new() -> Self {
        Self { last: [Vector::ZERO; 2], before: [Vector::ZERO; 2] }
    }

    /// Moves `x` over `interval` s under the constant torque `u_m` [N m]; with the work on the way.
    pub(crate) fn advance<L: Links<T, N>>(
        &mut self,
        plant: &Plant<L, N, T>,
        x: &Motion<T, N>,
        u_m: &Vector<T, N>,
        interval: f64,
    ) -> (Motion<T, N>, Ledger<T>) {
        let count = steps_in(interval, LONGEST);
        let h = interval / f64::from(count);
        let (mut x, mut work) = (*x, Ledger::ZERO);
        self.before = self.last;
        for _ in 0..count {
            x = self.step(plant, &x, u_m, h, &mut work);
        }
        (x, work)
    }

    #[inline]
    fn step<L: Links<T, N>>(
        &mut self,
        plant: &Plant<L, N, T>,
        x: &Motion<T, N>,
        u_m: &Vector<T, N>,
        h: f64,
        work: &mut Ledger<T>,
    ) -> Motion<T, N> {
        let (robot, half) = (&plant.robot, 0.5 * h);
        let part = |v: &Vector<T, N>, seconds: f64| v.map(|v| v.scale(seconds));
        let middle = middle(x, &self.last, h);
        // The springs by their slope about the middle, where they would be there without acceleration.
        let tangent = plant.tangent_stiffness(&middle);
        let ahead = x.deflection() + part(&(x.v_m - x.v_l), half) - middle.deflection();
        let spring = plant.spring_torque(&middle) + tangent.diag_mul(&ahead);
        let slope = part(&tangent, half * half);
        let bias = robot.links.inverse_dynamics(&middle.q_l, &middle.v_l, &middle.v_l, &Vector::ZERO);
        let mut load_l = spring - bias - robot.link_damping.diag_mul(&x.v_l) + plant.external;
        let load_m = *u_m - spring - robot.motor_damping.diag_mul(&x.v_m);
        // (m_m + h/2 d_m + s) a_m = load_m + s a_l, put into the equations of the links.
        let yields = Vector::from_fn(|k| {
            (robot.motor_inertia[k] + robot.motor_damping[k].scale(half) + slope[k]).recip()
        });
        let mut inertia = robot.links.mass_matrix(&middle.q_l);
        for k in 0..N {
            load_l[k] += slope[k] * yields[k] * load_m[k];
            inertia[(k, k)] += robot.link_damping[k].scale(half) + slope[k] - slope[k].square() * yields[k];
        }
        let a_l = inertia.ldl().solve(&load_l);
        let a_m = yields.diag_mul(&(load_m + slope.diag_mul(&a_l)));
        self.last = [a_l, a_m];

        let (mean_l, mean_m) = (x.v_l + part(&a_l, half), x.v_m + part(&a_m, half));
        let supplied = mean_m.dot(u_m) + mean_l.dot(&plant.external);
        let dissipated = mean_l.dot(&robot.link_damping.diag_mul(&mean_l))
            + mean_m.dot(&robot.motor_damping.diag_mul(&mean_m));
        work.supplied += supplied.scale(h);
        work.dissipated += dissipated.scale(h);
        work.throughput += supplied.abs().scale(h);
        Motion {
            q_l: x.q_l + part(&mean_l, h),
            q_m: x.q_m + part(&mean_m, h),
            v_l: x.v_l + part(&a_l, h),
            v_m: x.v_m + part(&a_m, h),
        }
    }
}

/// Where the accelerations `last` lead to from `x` in half a step of `h` s; the position that of the mean velocity.
#[inline]
pub(super) fn middle<const N: usize, T: Over<f64>>(
    x: &Motion<T, N>,
    last: &Sides<N, T>,
    h: f64,
) -> Motion<T, N> {
    let half = |v: &Vector<T, N>| v.map(|v| v.scale(0.5 * h));
    let (v_l, v_m) = (x.v_l + half(&last[0]), x.v_m + half(&last[1]));
    Motion { q_l: x.q_l + half(&v_l), q_m: x.q_m + half(&v_m), v_l, v_m }
}

#[cfg(test)]
mod tests {
    use flexure_core::linalg::Vector;
    use flexure_core::model::{Fjr, Motion};
    use flexure_core::robots::PlanarTwoLink;
    use flexure_core::scalar::Lanes;

    use super::Midpoint;
    use crate::lanes::{self, WIDTH};
    use crate::plant::Plant;
    use crate::robot::links::SideBySide;
    use crate::simulate::ledger::Ledger;
    use crate::simulate::stepping::Stepping;
    use crate::simulate::strides::taken;

    /// Two links with a damper of 9000 1/s and springs that harden, and something that pulls.
    fn arm() -> Plant<PlanarTwoLink<f64>, 2> {
        let robot = Fjr {
            links: PlanarTwoLink::new([1.51, 0.873], 0.343, [0.159, 0.055], [0.0392, 0.00808]),
            motor_inertia: Vector([0.23, 0.01]),
            stiffness: Vector([9.0, 4.0]),
            link_damping: Vector([0.8, 0.55]),
            motor_damping: Vector([0.2, 90.0]),
        };
        Plant { spring_hardening: Vector([90.0, 40.0]), external: Vector([0.5, -0.2]), ..Plant::from(robot) }
    }

    /// The steps that decide about friction, of which there is none here: two seconds under torques that jump, in one and in four periods of a
    /// millisecond at once. Sines of lanes differ by units in the last place, which the damped arm does not make more of than 10⁻¹².
    #[test]
    fn it_is_the_stepping_of_rough_plants_in_lanes() {
        let plant = arm();
        let links = PlanarTwoLink::side_by_side(&[&plant.robot.links; WIDTH]).expect("alike");
        let plants = Plant::together(links, [&plant; WIDTH]).expect("smooth");
        for interval in [1e-3, 4e-3] {
            let (mut one, mut stepping) = (Motion::at_rest(Vector([0.3, -1.2])), Stepping::new(1e-3));
            let mut several = lanes::motion(&[&one; WIDTH]);
            let (mut midpoint, mut ledger, mut booked) = (Midpoint::new(), Ledger::default(), Ledger::ZERO);
            for t in (0..).map(|k| interval * f64::from(k)).take_while(|t| *t < 2.0) {
                let u_m = Vector([3.0 * (9.0 * t).sin(), (5.0 * t).cos()]);
                let torque = |_: f64, _: &Motion<f64, 2>| u_m;
                one = stepping.advance(&plant, one, t, interval, &torque, &mut ledger).expect("it moves");
                let (end, work) = midpoint.advance(&plants, &several, &u_m.map(Lanes::splat), interval);
                booked.add(&work);
                several = end;
            }
            let lane = WIDTH - 1;
            let apart = taken(&several, lane);
            let size = |v: Vector<f64, 2>| v.iter().fold(0.0, |sum: f64, x| sum + x.abs());
            let off = size(apart.q_l - one.q_l) + size(apart.v_m - one.v_m);
            assert!(size(one.q_l) > 0.5 && off < 1e-12, "{off:e} rad and rad/s apart at {one:?}");
            let booked = booked.of(lane);
            let off =
                (booked.supplied - ledger.supplied).abs() + (booked.dissipated - ledger.dissipated).abs();
            assert!(ledger.dissipated > 0.1 && off < 1e-12, "{booked:?}, {ledger:?}");
        }
    }
}
