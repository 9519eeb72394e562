//! One step of collocation as far as it is the same for one robot and for several in lanes: motions at the stages, what is unbalanced
//! there, the end of the step, its work.

use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion, Power};
use flexure_core::scalar::{Lane, Lanes, Over, Piecewise, Scalar};

use crate::plant::{Plant, Sides};
use crate::simulate::damped::{Damped, Reach, WITHIN};
use crate::simulate::ledger::Ledger;
use crate::simulate::newton::{StageSolver, StepSolution};
use crate::simulate::scheme::{Scheme, Stages};

/// Speed [rad/s] below which errors count as absolute.
const SLOW: f64 = 1e-3;

/// Numbers of each joint at the stages.
pub(super) type EachAtStages<const S: usize, const N: usize, T = f64> = [Stages<S, T>; N];

/// A step of length `h` in s from `x`, and the iteration matrix for it. Of several robots, if `T` is lanes.
pub(super) struct Span<'a, L, const S: usize, const N: usize, T = f64> {
    pub scheme: &'a Scheme<S>,
    pub plant: &'a Plant<L, N, T>,
    pub x: &'a Motion<T, N>,
    pub h: f64,
    pub solver: &'a StageSolver<S, N, T>,
    /// λ = D_m / M_m per motor [1/s].
    pub rate: &'a Vector<T, N>,
}

impl<L, const S: usize, const N: usize, T> Span<'_, L, S, N, T>
where
    T: Piecewise + Over<T> + Over<f64>,
    L: Links<T, N>,
{
    /// What accelerates links and motors at the start under the torque `u` [N m]: `guess`, corrected once by the mass matrix of the
    /// iteration, which is exact where that was made here.
    #[inline]
    pub fn start(&self, u: &Vector<T, N>, guess: Sides<N, T>) -> Sides<N, T> {
        let [a_l, f] = guess;
        let of_damper = self.rate.diag_mul(&self.x.v_m);
        let [link, motor] = self.plant.unbalanced(self.x, u, [a_l, f - of_damper]);
        let inertia = &self.plant.robot.motor_inertia;
        [a_l + self.solver.mass.solve(&link), Vector::from_fn(|k| f[k] + motor[k] / inertia[k])]
    }

    /// What errors of links and motors count by [rad/s].
    #[inline]
    pub fn speeds(&self, start: &Sides<N, T>) -> Sides<N, T> {
        let Self { x, h, solver, .. } = self;
        let slow = T::from_f64(SLOW);
        let link = Vector::from_fn(|k| x.v_l[k].abs().max(start[0][k].abs().scale(*h)) + slow);
        let gained = |k: usize| solver.damped[k].end.drift.scale(*h) * start[1][k].abs();
        [link, Vector::from_fn(|k| x.v_m[k].abs().max(gained(k)) + slow)]
    }

    /// What springs feel of the motors at the stages beside their positions there: speeds that are damped within the step, in the mean.
    #[inline]
    pub fn felt(&self, start: &Sides<N, T>) -> EachAtStages<S, N, T> {
        let mut felt = [Stages::ZERO; N];
        for (k, Damped { excess, .. }) in self.solver.damped.iter().enumerate() {
            // Without such a speed nothing is divided by, and nothing comes of it.
            let within = self.rate[k].scale(self.h) - T::from_f64(WITHIN);
            let rate = within.select(self.rate[k], T::ONE);
            // Of q_m(t), −e^(−λ t) times this.
            let faded = (self.x.v_m[k] - start[1][k] / rate) / rate;
            for (felt, excess) in felt[k].0.iter_mut().zip(excess.iter()) {
                *felt = -faded * excess;
            }
        }
        felt
    }

    /// Torques that `solution` leaves unbalanced at stage `i` under the torque `u` [N m].
    #[inline]
    pub fn unbalanced(
        &self,
        solution: &StepSolution<S, N, T>,
        i: usize,
        felt: &EachAtStages<S, N, T>,
        u: &Vector<T, N>,
    ) -> Sides<N, T> {
        let Self { x, h, .. } = *self;
        let Scheme { nodes, maps: [once, twice], .. } = self.scheme;
        let (mut motion, mut a_l, mut a_m) = (*x, Vector::ZERO, Vector::ZERO);
        for (k, damped) in self.solver.damped.iter().enumerate() {
            let (link, motor) = (&solution.link[k], &solution.motor[k]);
            motion.v_l[k] = x.v_l[k] + once.at(i, link).scale(h);
            motion.q_l[k] = x.q_l[k] + (x.v_l[k].scale(nodes[i]) + twice.at(i, link).scale(h)).scale(h);
            motion.v_m[k] = damped.decay[i] * x.v_m[k] + damped.once.at(i, motor).scale(h);
            let carried = damped.drift[i] * x.v_m[k] + damped.twice.at(i, motor).scale(h);
            motion.q_m[k] = x.q_m[k] + carried.scale(h) + felt[k][i];
            (a_l[k], a_m[k]) = (link[i], motor[i] - self.rate[k] * motion.v_m[k]);
        }
        self.plant.unbalanced(&motion, u, [a_l, a_m])
    }

    /// Where the step ends: links by quadrature weights for velocity and position, motors under their dampers.
    #[inline]
    pub fn end(&self, StepSolution { link, motor }: &StepSolution<S, N, T>) -> Motion<T, N> {
        let Self { x, h, .. } = *self;
        let Scheme { weights, end_twice, .. } = self.scheme;
        let mut end = *x;
        for (k, Damped { end: Reach { decay, drift, once, twice }, .. }) in
            self.solver.damped.iter().enumerate()
        {
            end.v_l[k] = x.v_l[k] + weighted(weights, &link[k]).scale(h);
            end.q_l[k] = x.q_l[k] + (x.v_l[k] + weighted(end_twice, &link[k]).scale(h)).scale(h);
            end.v_m[k] = *decay * x.v_m[k] + once.dot(&motor[k]).scale(h);
            end.q_m[k] = x.q_m[k] + (*drift * x.v_m[k] + twice.dot(&motor[k]).scale(h)).scale(h);
        }
        end
    }

    /// The work of the step under `torques` at the stages [N m]. What dampers of motors take is what their torques give and their kinetic
    /// energy does not keep: exactly what it is for speeds that are exponentials.
    #[inline]
    pub fn work(
        &self,
        solution: &StepSolution<S, N, T>,
        end: &Motion<T, N>,
        torques: &EachAtStages<S, N, T>,
    ) -> Ledger<T> {
        let Self { plant, x, h, .. } = *self;
        let robot = &plant.robot;
        let mut work = Ledger::ZERO;
        let [mut supplied, mut pushed, mut dissipated] = [Stages::<S, T>::ZERO; 3];
        for (k, damped) in self.solver.damped.iter().enumerate().take(robot.links.joints()) {
            let Damped { work: of_f, work_of_speed, .. } = damped;
            let f = solution.motor[k];
            let of_f = of_f.of(&f);
            let mut turned = Stages::ZERO;
            for i in 0..S {
                turned[i] = (work_of_speed[i] * x.v_m[k] + of_f[i].scale(h)).scale(h);
                supplied[i] += torques[k][i] * turned[i];
            }
            let kept = (end.v_m[k] - x.v_m[k]).scale(0.5) * (end.v_m[k] + x.v_m[k]);
            let lost = robot.motor_inertia[k] * (f.dot(&turned) - kept);
            work.dissipated += (-robot.motor_damping[k]).select(T::ZERO, lost);
            let speed = self.scheme.maps[0].of(&solution.link[k]);
            for i in 0..S {
                let v_l = x.v_l[k] + speed[i].scale(h);
                pushed[i] += v_l * plant.external[k];
                dissipated[i] += v_l * (robot.link_damping[k] * v_l);
            }
        }
        for i in 0..S {
            let seconds = h * self.scheme.weights[i];
            let supplied = supplied[i] + pushed[i].scale(seconds);
            work.book(1.0, &Power { supplied, dissipated: dissipated[i].scale(seconds) });
        }
        work
    }
}

impl<L, const S: usize, const N: usize> Span<'_, L, S, N>
where
    L: Links<f64, N>,
    f64: Lane<S>,
{
    /// Positions and velocities at the stages, a lane each: to lanes one robot at several instants is several robots.
    #[inline]
    pub fn lanes(&self, [link, motor]: &[[Lanes<f64, S>; N]; 2]) -> Motion<Lanes<f64, S>, N> {
        let Self { x, h, .. } = *self;
        let Scheme { nodes, maps: [once, twice], .. } = self.scheme;
        let nodes = Lanes::from_array(nodes.0);
        let mut motion =
            Motion { q_l: Vector::ZERO, q_m: Vector::ZERO, v_l: Vector::ZERO, v_m: Vector::ZERO };
        for (k, damped) in self.solver.damped.iter().enumerate() {
            let [q_l, q_m, v_l, v_m] = [x.q_l[k], x.q_m[k], x.v_l[k], x.v_m[k]];
            let at = |value: f64| Lanes::splat(value);
            motion.v_l[k] = at(v_l) + once.of(&link[k]).scale(h);
            motion.q_l[k] = at(q_l) + (nodes.scale(v_l) + twice.of(&link[k]).scale(h)).scale(h);
            let [decay, drift] = [damped.decay, damped.drift].map(|each| Lanes::from_array(each.0));
            motion.v_m[k] = decay.scale(v_m) + damped.once.of(&motor[k]).scale(h);
            motion.q_m[k] = at(q_m) + (drift.scale(v_m) + damped.twice.of(&motor[k]).scale(h)).scale(h);
        }
        motion
    }

    /// [`unbalanced`](Self::unbalanced) at all stages at once under the torques `u` there [N m].
    #[inline]
    pub fn unbalanced_at_once(
        &self,
        [link, motor]: &[[Lanes<f64, S>; N]; 2],
        motion: &Motion<Lanes<f64, S>, N>,
        felt: &EachAtStages<S, N>,
        u: &Vector<Lanes<f64, S>, N>,
    ) -> Sides<N, Lanes<f64, S>> {
        let (mut x, mut a_m) = (*motion, Vector(*motor));
        for k in 0..N {
            x.q_m[k] += Lanes::from_array(felt[k].0);
            a_m[k] -= motion.v_m[k].scale(self.rate[k]);
        }
        self.plant.unbalanced(&x, u, [Vector(*link), a_m])
    }
}

/// λ = D_m / M_m per motor [1/s].
#[inline]
pub(super) fn damping_rate<L, const N: usize, C: Scalar>(plant: &Plant<L, N, C>) -> Vector<C, N> {
    Vector::from_fn(|k| plant.robot.motor_damping[k] / plant.robot.motor_inertia[k])
}

/// What stage values are multiplied by to have the value at 0 of the polynomial through their polynomial at the points of half as many
/// stages.
pub(super) fn half<const S: usize>(scheme: &Scheme<S>) -> Stages<S> {
    if S < 4 {
        return scheme.at(0.5);
    }
    let coarse = Scheme::<2>::gauss();
    let nodes = coarse.nodes.iter().zip(coarse.start.iter());
    nodes.fold(Stages::ZERO, |sum, (node, weight)| sum + scheme.at(node).scaled(weight))
}

/// What stage values are multiplied by to have their polynomial at the stages of the next step, `ratio` times longer, less its end.
pub(super) fn ahead<const S: usize>(scheme: &Scheme<S>, ratio: f64) -> [Stages<S>; S] {
    std::array::from_fn(|i| scheme.at(1.0 + ratio * scheme.nodes[i]) - scheme.at(1.0))
}

/// The sum of stage values with these weights.
#[inline]
pub(super) fn weighted<const S: usize, T: Over<f64>>(weights: &Stages<S>, values: &Stages<S, T>) -> T {
    let mut sum = T::ZERO;
    for (weight, value) in weights.iter().zip(values.iter()) {
        sum += value.scale(weight);
    }
    sum
}
