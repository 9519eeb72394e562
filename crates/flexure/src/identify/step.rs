//! One sampling period of the robot, with its exact derivatives by what is identified.
//!
//! Rigid-body terms change with the posture, slowly; springs swing within a few periods. So the mass matrix and the torque of
//! weight and velocities are taken once, in the middle of the period, and what is left is linear: its Taylor series in time is
//! summed to rounding (Moler & Van Loan, *SIAM Review* 45, 2003, method 1), which no stiff spring of a robot disturbs. The
//! derivatives of the rigid-body terms are those of the same dynamics on dual numbers.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Links, Motion};
use flexure_core::scalar::Dual;

use super::parameters::{Parameter, Values, unknown};
use super::rubbing::Rubbing;
use super::tangents::{Tangents, add};
use super::torque::Held;
use crate::plant::Sides;

/// What moves a robot in a period, with the numbers that are identified as vectors.
pub(crate) struct Step<'a, L, const N: usize> {
    links: &'a L,
    /// Joints of the robot, at most `N`.
    joints: usize,
    /// Sampling period \[s\].
    h: f64,
    pace: Pace,
    stiffness: Vector<f64, N>,
    motor_inertia: Vector<f64, N>,
    damping: Sides<N>,
    coulomb: Sides<N>,
}

/// How the series is summed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pace {
    /// Parts of a period.
    pub parts: usize,
    /// Terms of the series in each.
    pub terms: usize,
}

impl Pace {
    /// For rates up to `rate` [1/s]: what is cut off is below 1e-6 of the fastest swing.
    pub fn of(rate: f64, h: f64) -> Self {
        let parts = (rate * h / 3.0).ceil().clamp(1.0, 64.0);
        let x = rate * h / parts;
        let (mut term, mut terms) = (1.0, 0_usize);
        while term > 1e-6 && terms < 20 {
            terms += 1;
            term *= x / terms as f64;
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 64")]
        Self { parts: parts as usize, terms: terms.max(2) }
    }
}

/// What a period is made of, apart from the motion at its start.
struct Frozen<const N: usize> {
    /// Inverse of the mass matrix in the middle.
    mobility: Matrix<f64, N, N>,
    /// Torques that are the same all the while [N m].
    load: Sides<N>,
    rubbing: [[Rubbing; N]; 2],
}

/// A motion and the mean acceleration of the links that led to it, which tells where the middle of the next period is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moving<const N: usize> {
    pub x: Motion<f64, N>,
    pub acceleration: Vector<f64, N>,
}

impl<'a, L: Links<f64, N>, const N: usize> Step<'a, L, N> {
    pub fn new(links: &'a L, values: &Values, h: f64, pace: Pace) -> Self {
        let vector = |parameter: Parameter, pad: f64| {
            let values = values.of(parameter);
            Vector::from_fn(|i| values.get(i).copied().unwrap_or(pad))
        };
        Self {
            links,
            joints: links.joints(),
            h,
            pace,
            stiffness: vector(Parameter::Stiffness, 1.0),
            motor_inertia: vector(Parameter::MotorInertia, 1.0),
            damping: [vector(Parameter::LinkDamping, 0.0), vector(Parameter::MotorDamping, 0.0)],
            coulomb: [vector(Parameter::LinkFriction, 0.0), vector(Parameter::MotorFriction, 0.0)],
        }
    }

    /// The motion a period later, under `torques` per joint; `tangents` move with it.
    pub fn after(
        &self,
        before: &Moving<N>,
        torques: &[Held],
        tangents: Option<(&mut Tangents, &mut Workspace)>,
    ) -> Moving<N> {
        let x = &before.x;
        let middle = x.q_l + x.v_l.scaled(0.5 * self.h);
        let speed = x.v_l + before.acceleration.scaled(0.5 * self.h);
        let frozen = self.frozen(x, &middle, &speed, torques);
        let mut end = self.swung(x, &frozen);
        let acceleration = (end.v_l - x.v_l).scaled(1.0 / self.h);
        if let Some((tangents, workspace)) = tangents {
            let rigid = self.rigid(&middle, &speed, &acceleration);
            self.carry(tangents, workspace, x, &frozen, &rigid, torques);
        }
        for (i, held) in torques.iter().enumerate() {
            end.q_m[i] += held.moment / self.motor_inertia[i];
        }
        Moving { x: end, acceleration }
    }

    fn frozen(
        &self,
        x: &Motion<f64, N>,
        middle: &Vector<f64, N>,
        speed: &Vector<f64, N>,
        torques: &[Held],
    ) -> Frozen<N> {
        let factor = self.links.mass_matrix(middle).ldl();
        let columns: [Vector<f64, N>; N] =
            std::array::from_fn(|j| factor.solve(&Vector::from_fn(|i| f64::from(i == j))));
        let mobility = Matrix::from_fn(|i, j| columns[j][i]);
        let bias = self.links.inverse_dynamics(middle, speed, speed, &Vector::ZERO);
        let rubbing = [&x.v_l, &x.v_m].map(|v| std::array::from_fn(|i| Rubbing::sliding(v[i])));
        let mean = Vector::from_fn(|i| torques.get(i).map_or(0.0, |held| held.mean));
        let mut frozen = Frozen { mobility, load: [-bias, mean], rubbing };
        let sliding = self.with_friction(&frozen.load, &frozen.rubbing);
        let end = self.swung(x, &Frozen { load: sliding, ..frozen });
        for i in 0..self.joints {
            let ends = [
                (x.v_l[i], end.v_l[i], 1.0 / frozen.mobility[(i, i)]),
                (x.v_m[i], end.v_m[i], self.motor_inertia[i]),
            ];
            for (side, (v, end, inertia)) in ends.into_iter().enumerate() {
                frozen.rubbing[side][i] = Rubbing::over(v, end, inertia, self.coulomb[side][i], self.h);
            }
        }
        frozen.load = self.with_friction(&frozen.load, &frozen.rubbing);
        frozen
    }

    fn with_friction(&self, load: &Sides<N>, rubbing: &[[Rubbing; N]; 2]) -> Sides<N> {
        std::array::from_fn(|side| {
            Vector::from_fn(|i| load[side][i] - self.coulomb[side][i] * rubbing[side][i].share)
        })
    }

    /// The linear motion over a period.
    fn swung(&self, x: &Motion<f64, N>, frozen: &Frozen<N>) -> Motion<f64, N> {
        let mut x = *x;
        let part = self.h / self.pace.parts as f64;
        for _ in 0..self.pace.parts {
            let mut term = x;
            for k in 1..=self.pace.terms {
                term = self.term(&term, frozen, k, part).0;
                x = Motion {
                    q_l: x.q_l + term.q_l,
                    q_m: x.q_m + term.q_m,
                    v_l: x.v_l + term.v_l,
                    v_m: x.v_m + term.v_m,
                };
            }
        }
        x
    }

    /// The `k`-th term of the series from the one before, and the torques that it comes from.
    #[inline]
    fn term(
        &self,
        before: &Motion<f64, N>,
        frozen: &Frozen<N>,
        k: usize,
        part: f64,
    ) -> (Motion<f64, N>, Sides<N>) {
        let spring = self.stiffness.diag_mul(&before.deflection());
        let mut link = spring - self.damping[0].diag_mul(&before.v_l);
        let mut motor = -spring - self.damping[1].diag_mul(&before.v_m);
        if k == 1 {
            link += frozen.load[0];
            motor += frozen.load[1];
        }
        let by = part / k as f64;
        let term = Motion {
            q_l: before.v_l.scaled(by),
            q_m: before.v_m.scaled(by),
            v_l: (frozen.mobility * link).scaled(by),
            v_m: Vector::from_fn(|i| motor[i] / self.motor_inertia[i] * by),
        };
        (term, [link, motor])
    }

    /// Derivatives of the links' inverse dynamics by positions and velocities.
    fn rigid(&self, q: &Vector<f64, N>, v: &Vector<f64, N>, a: &Vector<f64, N>) -> [Matrix<f64, N, N>; 2] {
        let fixed = |x: &Vector<f64, N>| x.map(Dual::<f64, N>::constant);
        let varied = |x: &Vector<f64, N>| Vector::from_fn(|i| Dual::<f64, N>::variable(x[i], i));
        let (v_fixed, a) = (fixed(v), fixed(a));
        let by_q = self.links.inverse_dynamics(&varied(q), &v_fixed, &v_fixed, &a);
        let v_varied = varied(v);
        let by_v = self.links.inverse_dynamics(&fixed(q), &v_varied, &v_varied, &a);
        [by_q, by_v].map(|torque| Matrix::from_fn(|i, j| torque[i].gradient[j]))
    }

    /// Moves `tangents` over the period.
    fn carry(
        &self,
        tangents: &mut Tangents,
        Workspace { term, next, torque, constant, start, .. }: &mut Workspace,
        x: &Motion<f64, N>,
        frozen: &Frozen<N>,
        rigid: &[Matrix<f64, N, N>; 2],
        torques: &[Held],
    ) {
        let n = self.joints;
        let rests = |side: usize, i: usize| frozen.rubbing[side][i].rests;
        start.copy(tangents);
        for i in 0..n {
            for side in 0..2 {
                if rests(side, i) {
                    tangents.row_mut((2 + side) * n + i).fill(0.0);
                }
            }
        }
        self.constant_torques(tangents, constant, frozen, rigid, torques);
        let part = self.h / self.pace.parts as f64;
        let mut x = *x;
        for _ in 0..self.pace.parts {
            let mut of_x = x;
            term.copy(tangents);
            for k in 1..=self.pace.terms {
                let by = part / k as f64;
                let (following, [_, motor]) = self.term(&of_x, frozen, k, part);
                let deflection = of_x.deflection();
                for i in 0..n {
                    // Torques of springs and dampers, into the rows of links and motors.
                    let (to_link, to_motor) = torque.two_rows(i, n + i);
                    let (q_l, q_m, v_l, v_m) =
                        (term.row(i), term.row(n + i), term.row(2 * n + i), term.row(3 * n + i));
                    let (K, D_l, D_m) = (self.stiffness[i], self.damping[0][i], self.damping[1][i]);
                    let positions = q_l.iter().zip(q_m);
                    let motions = positions.zip(v_l.iter().zip(v_m));
                    for ((to_link, to_motor), ((q_l, q_m), (v_l, v_m))) in
                        to_link.iter_mut().zip(to_motor.iter_mut()).zip(motions)
                    {
                        let spring = K * (q_m - q_l);
                        *to_link = spring - D_l * v_l;
                        *to_motor = -spring - D_m * v_m;
                    }
                    let spring = K * deflection[i];
                    to_link[unknown(i, Parameter::Stiffness)] += spring;
                    to_motor[unknown(i, Parameter::Stiffness)] -= spring;
                    to_link[unknown(i, Parameter::LinkDamping)] -= D_l * of_x.v_l[i];
                    to_motor[unknown(i, Parameter::MotorDamping)] -= D_m * of_x.v_m[i];
                    to_motor[unknown(i, Parameter::MotorInertia)] -= motor[i];
                    if k == 1 {
                        add(to_link, 1.0, constant.row(i));
                        add(to_motor, 1.0, constant.row(n + i));
                    }
                }
                for i in 0..n {
                    for (to, from) in [(i, 2 * n + i), (n + i, 3 * n + i)] {
                        for (to, x) in next.row_mut(to).iter_mut().zip(term.row(from)) {
                            *to = by * x;
                        }
                    }
                    let acceleration = next.row_mut(2 * n + i);
                    acceleration.fill(0.0);
                    if !rests(0, i) {
                        for j in 0..n {
                            add(acceleration, by * frozen.mobility[(i, j)], torque.row(j));
                        }
                    }
                    let acceleration = next.row_mut(3 * n + i);
                    acceleration.fill(0.0);
                    if !rests(1, i) {
                        add(acceleration, by / self.motor_inertia[i], torque.row(n + i));
                    }
                }
                add(tangents.entries_mut(), 1.0, next.entries());
                std::mem::swap(term, next);
                of_x = following;
                x = Motion {
                    q_l: x.q_l + following.q_l,
                    q_m: x.q_m + following.q_m,
                    v_l: x.v_l + following.v_l,
                    v_m: x.v_m + following.v_m,
                };
            }
        }
        for i in 0..n {
            for side in 0..2 {
                if rests(side, i) {
                    // It moves on until it rests.
                    add(tangents.row_mut(side * n + i), 0.5 * self.h, start.row((2 + side) * n + i));
                }
            }
            let held = &torques[i];
            let row = tangents.row_mut(n + i);
            row[unknown(i, Parameter::MotorInertia)] -= held.moment / self.motor_inertia[i];
            row[n * Parameter::COUNT] += held.moment_slope / self.motor_inertia[i];
        }
    }

    /// Derivatives of the torques that are the same all the while.
    fn constant_torques(
        &self,
        tangents: &Tangents,
        constant: &mut Tangents,
        frozen: &Frozen<N>,
        [by_q, by_v]: &[Matrix<f64, N, N>; 2],
        torques: &[Held],
    ) {
        let n = self.joints;
        for i in 0..n {
            let link = constant.row_mut(i);
            link.fill(0.0);
            for j in 0..n {
                add(link, -by_q[(i, j)], tangents.row(j));
                add(link, -0.5 * self.h * by_q[(i, j)] - by_v[(i, j)], tangents.row(2 * n + j));
            }
            let [of_link, of_motor] = [frozen.rubbing[0][i], frozen.rubbing[1][i]];
            add(link, -of_link.slope, tangents.row(2 * n + i));
            link[unknown(i, Parameter::LinkFriction)] -= self.coulomb[0][i] * of_link.share;
            let motor = constant.row_mut(n + i);
            motor.fill(0.0);
            add(motor, -of_motor.slope, tangents.row(3 * n + i));
            motor[unknown(i, Parameter::MotorFriction)] -= self.coulomb[1][i] * of_motor.share;
            motor[n * Parameter::COUNT] += torques[i].mean_slope;
        }
    }
}

/// Room for [`Step::after`], used again and again.
#[derive(Clone, Debug)]
pub(crate) struct Workspace {
    term: Tangents,
    next: Tangents,
    torque: Tangents,
    constant: Tangents,
    start: Tangents,
    /// Rows of the positions that are measured.
    pub seen: Tangents,
}

impl Workspace {
    /// For `joints` joints and `width` unknowns.
    pub fn new(joints: usize, width: usize) -> Self {
        let states = Tangents::zeros(4 * joints, width);
        let torques = Tangents::zeros(2 * joints, width);
        Self {
            term: states.clone(),
            next: states.clone(),
            torque: torques.clone(),
            constant: torques.clone(),
            start: states,
            seen: torques,
        }
    }
}
