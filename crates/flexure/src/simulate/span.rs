//! One step of collocation as far as it is the same for one robot and for several in lanes: motions at the stages, what is unbalanced
//! there, the end of the step, its work.

use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion, Power};
use flexure_core::scalar::{Over, Piecewise, Scalar};

use crate::plant::{Plant, Sides};
use crate::simulate::damped::{Damped, Reach, WITHIN};
use crate::simulate::ledger::Ledger;
use crate::simulate::newton::{StageSolver, StepSolution};
use crate::simulate::scheme::{Scheme, Stages};

/// Speed [rad/s] below which errors count as absolute.
const SLOW: f64 = 1e-3;

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
    pub fn felt(&self, start: &Sides<N, T>) -> [Vector<T, N>; S] {
        let mut felt = [Vector::ZERO; S];
        for (k, Damped { excess, .. }) in self.solver.damped.iter().enumerate() {
            // Without such a speed nothing is divided by, and nothing comes of it.
            let within = self.rate[k].scale(self.h) - T::from_f64(WITHIN);
            let rate = within.select(self.rate[k], T::ONE);
            // Of q_m(t), −e^(−λ t) times this.
            let faded = (self.x.v_m[k] - start[1][k] / rate) / rate;
            for (felt, excess) in felt.iter_mut().zip(excess.iter()) {
                felt[k] = -faded * excess;
            }
        }
        felt
    }

    /// Position and velocity at stage `i`.
    #[inline]
    pub fn stage(&self, solution: &StepSolution<S, N, T>, i: usize) -> Motion<T, N> {
        let Scheme { nodes, once, twice, .. } = self.scheme;
        let damped = &self.solver.damped;
        self.moved(nodes[i], &once.row(i), &twice.row(i), |k| &damped[k].stages[i], solution)
    }

    /// Torques that `solution` leaves unbalanced at stage `i`, where it has the robot at `motion`, under the torque `u` [N m].
    #[inline]
    pub fn unbalanced(
        &self,
        solution: &StepSolution<S, N, T>,
        i: usize,
        motion: &Motion<T, N>,
        felt: &Vector<T, N>,
        u: &Vector<T, N>,
    ) -> Sides<N, T> {
        let a_m = solution.motor[i] - self.rate.diag_mul(&motion.v_m);
        let motion = Motion { q_m: motion.q_m + *felt, ..*motion };
        self.plant.unbalanced(&motion, u, [solution.link[i], a_m])
    }

    /// Where the step ends.
    #[inline]
    pub fn end(&self, solution: &StepSolution<S, N, T>) -> Motion<T, N> {
        let Scheme { weights, end_twice, .. } = self.scheme;
        let damped = &self.solver.damped;
        self.moved(1.0, weights, end_twice, |k| &damped[k].end, solution)
    }

    /// `x` moved to the instant `at` of the step: links by quadrature weights for velocity and position, motors under their dampers.
    #[inline]
    fn moved<'b>(
        &self,
        at: f64,
        once: &Stages<S>,
        twice: &Stages<S>,
        reach: impl Fn(usize) -> &'b Reach<S, T>,
        StepSolution { link, motor }: &StepSolution<S, N, T>,
    ) -> Motion<T, N>
    where
        T: 'b,
    {
        let Self { x, h, .. } = *self;
        let times = |v: Vector<T, N>, c: f64| v.map(|x| x.scale(c));
        let mut end = Motion {
            q_l: x.q_l + times(times(x.v_l, at) + times(sum(twice, link), h), h),
            q_m: x.q_m,
            v_l: x.v_l + times(sum(once, link), h),
            v_m: x.v_m,
        };
        for k in 0..N {
            let Reach { decay, drift, once, twice } = reach(k);
            let (mut speed, mut position) = (T::ZERO, T::ZERO);
            for (f, (once, twice)) in motor.iter().zip(once.iter().zip(twice.iter())) {
                speed += once * f[k];
                position += twice * f[k];
            }
            end.v_m[k] = *decay * x.v_m[k] + speed.scale(h);
            end.q_m[k] = x.q_m[k] + (*drift * x.v_m[k] + position.scale(h)).scale(h);
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
        torques: &[Vector<T, N>; S],
    ) -> Ledger<T> {
        let Self { plant, x, h, .. } = *self;
        let robot = &plant.robot;
        let mut work = Ledger::ZERO;
        let mut supplied = Stages::<S, T>::ZERO;
        for (k, damped) in self.solver.damped.iter().enumerate().take(robot.links.joints()) {
            let Damped { work: of_f, work_of_speed, .. } = damped;
            let f = Vector::from_fn(|i| solution.motor[i][k]);
            let of_f = (*of_f * f).map(|x| x.scale(h));
            let turned = (work_of_speed.scaled(x.v_m[k]) + of_f).map(|x| x.scale(h));
            supplied += Vector::from_fn(|i| torques[i][k] * turned[i]);
            let kept = (end.v_m[k] - x.v_m[k]).scale(0.5) * (end.v_m[k] + x.v_m[k]);
            let lost = robot.motor_inertia[k] * (f.dot(&turned) - kept);
            work.dissipated += (-robot.motor_damping[k]).select(T::ZERO, lost);
        }
        for i in 0..S {
            let mut v_l = x.v_l;
            for (a, weight) in solution.link.iter().zip(self.scheme.once.row(i).iter()) {
                v_l += a.map(|a| a.scale(h * weight));
            }
            let seconds = h * self.scheme.weights[i];
            let pushed = supplied[i] + v_l.dot(&plant.external).scale(seconds);
            let dissipated = v_l.dot(&robot.link_damping.diag_mul(&v_l)).scale(seconds);
            work.book(1.0, &Power { supplied: pushed, dissipated });
        }
        work
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

#[inline]
pub(super) fn sum<const S: usize, const N: usize, T: Over<f64>>(
    weights: &Stages<S>,
    values: &[Vector<T, N>],
) -> Vector<T, N> {
    let mut total = Vector::ZERO;
    for (w, value) in weights.iter().zip(values) {
        total += value.map(|x| x.scale(w));
    }
    total
}
