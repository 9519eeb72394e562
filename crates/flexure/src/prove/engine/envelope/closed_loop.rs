//! A robot under its law along a reference, over intervals with derivatives, for callers that know its size only when
//! they run.

use flexure_core::control::{Command, Input, Metric, Shaping, Vcbc};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, MassFactor, Motion};
use flexure_core::reference::Reference;
use flexure_core::scalar::{Dual, Interval, Jet, Over, Scalar};

use crate::linalg::Symmetric;

/// A number over a box as a series in one direction: its value, its first derivative and half its second.
pub type Slope = Jet<Interval, 3>;

/// Such a series, and its derivative in a second direction.
pub type Tilt = Dual<Slope, 1>;

/// A motion, one number per joint each: positions in rad, velocities [rad/s].
#[derive(Clone, Debug)]
pub struct Place<S = Slope> {
    /// Link positions.
    pub q_l: Vec<S>,
    /// Motor positions.
    pub q_m: Vec<S>,
    /// Link velocities.
    pub v_l: Vec<S>,
    /// Motor velocities.
    pub v_m: Vec<S>,
}

/// What the law says at a place; see [`Command`].
#[derive(Clone, Debug)]
pub struct Answer {
    /// Motor torque [N m].
    pub u_m: Vec<Slope>,
    /// Desired motor position in rad.
    pub q_md: Vec<Slope>,
    /// Link position error in rad.
    pub e_l: Vec<Slope>,
    /// Motor position error in rad.
    pub e_m: Vec<Slope>,
    /// Link velocity error [rad/s].
    pub s_l: Vec<Slope>,
    /// Motor velocity error [rad/s].
    pub s_m: Vec<Slope>,
}

/// The numbers of springs, motors and dampers, one per joint.
#[derive(Clone, Debug)]
pub struct Drive {
    /// K [N m/rad].
    pub stiffness: Vec<Interval>,
    /// M_m [kg m²].
    pub motor_inertia: Vec<Interval>,
    /// D_m [N m s/rad].
    pub motor_damping: Vec<Interval>,
}

/// A robot under its law along a reference.
pub trait TrackingLoop: Sync {
    /// Number of joints.
    fn joints(&self) -> usize;
    /// Taylor coefficients of the reference in rad/sᵏ over the times `t` in s.
    fn reference(&self, t: Interval) -> Vec<[Interval; 7]>;
    /// Times in s at which the reference's fourth derivative may jump.
    fn breaks(&self) -> &[Interval];
    /// Times in s at which its fifth derivative may jump, beside those.
    fn kinks(&self) -> &[Interval];
    /// φ_l [rad/s] at the link position errors `e_l` in rad.
    fn approach(&self, e_l: &[Slope]) -> Vec<Slope>;
    /// φ_m [rad/s] at the motor position errors `e_m` in rad.
    fn approach_m(&self, e_m: &[Slope]) -> Vec<Slope>;
    /// What the law says at `x`, with the Taylor coefficients `q_ld` of the reference in rad/sᵏ.
    fn command(&self, x: &Place, q_ld: &[[Slope; 5]]) -> Answer;
    /// The motor torques [N m] that the law says there, by two directions.
    fn torques(&self, x: &Place<Tilt>, q_ld: &[[Slope; 5]]) -> Vec<Tilt>;
    /// M_l `a_l` + (C_l + D_l) `v_l` + g_l [N m]: what the springs have to give where the links are at `q_l` in rad, move at `v_l` [rad/s] and speed
    /// up by `a_l` [rad/s²].
    fn link_load(&self, q_l: &[Slope], v_l: &[Slope], a_l: &[Slope]) -> Vec<Slope>;
    /// M_l⁻¹ [1/(kg m²)] at `q_l` in rad.
    fn inverse_mass(&self, q_l: &[Interval]) -> Symmetric<Interval>;
    /// The lower triangle of M_l⁻¹ [1/(kg m²)], row by row, with its derivatives at `q_l` in rad.
    fn mobility(&self, q_l: &[Slope]) -> Vec<Slope>;
    /// C_l [N m s/rad], of Christoffel symbols, row by row, with its derivatives at `q_l` in rad and `v_l` [rad/s].
    fn coriolis(&self, q_l: &[Slope], v_l: &[Slope]) -> Vec<Slope>;
    /// The torque [N m] that each link alone, all others massless, takes where the links are at `q_l` in rad, move at `v_l` [rad/s] and speed up as the
    /// errors ask for, q̇_lr = q̇_ld − φ_l: M_i q̈_lr + C_i q̇_l + g_i, a list for each link i. `q_ld` are Taylor coefficients of the
    /// reference in rad/sᵏ.
    fn loads(&self, q_l: &[Slope], v_l: &[Slope], q_ld: &[[Slope; 5]]) -> Vec<Vec<Slope>>;
    /// s_lᵀ M_l s_l in J at `q_l` in rad.
    fn link_energy(&self, q_l: &[Interval], s_l: &[Interval]) -> Interval;
    /// The diagonals of Π_l, Π_m [N m/rad] and M_m [kg m²].
    fn metrics(&self) -> [Vec<Interval>; 3];
    /// The diagonals of D_l + K_ld and D_m + K_md [N m s/rad].
    fn damping(&self) -> [Vec<Interval>; 2];
    /// What the law takes springs, motors and dampers to be.
    fn drive(&self) -> Drive;
}

/// A robot, its law with a constant Π_l, a reference and the times where its derivatives may jump.
#[derive(Clone, Debug)]
pub struct Enclosed<L, Pl, Pm, R, const N: usize> {
    /// The robot.
    pub robot: Fjr<Interval, L, N>,
    /// The links of the robot, each with all others massless.
    pub alone: Vec<L>,
    /// The law.
    pub law: Vcbc<Interval, Pl, Pm, N>,
    /// The reference in rad.
    pub reference: R,
    /// Times in s at which its fourth derivative may jump.
    pub breaks: Vec<Interval>,
    /// Times in s at which its fifth derivative may.
    pub kinks: Vec<Interval>,
}

impl<L, Pl, Pm, R, const N: usize> TrackingLoop for Enclosed<L, Pl, Pm, R, N>
where
    L: Links<Interval, N> + Sync,
    Pl: Shaping<Interval, N> + Sync,
    Pm: Shaping<Interval, N> + Sync,
    R: Reference<Interval, N> + Sync,
{
    fn joints(&self) -> usize {
        self.robot.links.joints()
    }

    fn reference(&self, t: Interval) -> Vec<[Interval; 7]> {
        let jets: Vector<Jet<Interval, 7>, N> = self.reference.at(t);
        jets.iter().take(self.joints()).map(|jet| std::array::from_fn(|k| jet.coefficient(k))).collect()
    }

    fn breaks(&self) -> &[Interval] {
        &self.breaks
    }

    fn kinks(&self) -> &[Interval] {
        &self.kinks
    }

    fn approach(&self, e_l: &[Slope]) -> Vec<Slope> {
        self.list(&self.law.link.shaping.eval(&vector(e_l)))
    }

    fn approach_m(&self, e_m: &[Slope]) -> Vec<Slope> {
        self.list(&self.law.motor.shaping.eval(&vector(e_m)))
    }

    fn command(&self, x: &Place, q_ld: &[[Slope; 5]]) -> Answer {
        let q_ld = Vector::from_fn(|i| q_ld.get(i).map_or(Jet::ZERO, |q| Jet::new(*q)));
        let Command { u_m, q_md, e_l, e_m, s_l, s_m, .. } = command(&self.law, &self.robot, x, &q_ld);
        let [u_m, q_md, e_l, e_m, s_l, s_m] = [u_m, q_md, e_l, e_m, s_l, s_m].map(|v| self.list(&v));
        Answer { u_m, q_md, e_l, e_m, s_l, s_m }
    }

    fn torques(&self, x: &Place<Tilt>, q_ld: &[[Slope; 5]]) -> Vec<Tilt> {
        let lifted = |q: &[Slope; 5]| Jet::new(q.map(Tilt::constant));
        let q_ld = Vector::from_fn(|i| q_ld.get(i).map_or(Jet::ZERO, lifted));
        self.list(&command(&self.law, &self.robot, x, &q_ld).u_m)
    }

    fn link_load(&self, q_l: &[Slope], v_l: &[Slope], a_l: &[Slope]) -> Vec<Slope> {
        let [q_l, v_l, a_l] = [q_l, v_l, a_l].map(vector::<Slope, N>);
        let load = self.robot.links.inverse_dynamics(&q_l, &v_l, &v_l, &a_l);
        self.list(&(load + self.robot.link_damping.diag_mul(&v_l)))
    }

    fn inverse_mass(&self, q_l: &[Interval]) -> Symmetric<Interval> {
        let factor = self.robot.links.factor(&vector(q_l));
        let columns: Vec<Vector<Interval, N>> = (0..self.joints()).map(|j| factor.solve(&unit(j))).collect();
        // Entry and mirror image enclose the same number.
        Symmetric::from_fn(self.joints(), |i, j| {
            columns[j][i].intersection(columns[i][j]).unwrap_or(columns[j][i])
        })
    }

    fn mobility(&self, q_l: &[Slope]) -> Vec<Slope> {
        let factor = self.robot.links.factor(&vector::<Slope, N>(q_l));
        let columns: Vec<Vector<Slope, N>> = (0..self.joints()).map(|j| factor.solve(&unit(j))).collect();
        (0..self.joints()).flat_map(|i| columns.iter().take(i + 1).map(move |column| column[i])).collect()
    }

    fn coriolis(&self, q_l: &[Slope], v_l: &[Slope]) -> Vec<Slope> {
        let ([q, v], n) = ([q_l, v_l].map(vector::<Slope, N>), self.joints());
        let column = |j| self.robot.links.inertial_torque(&q, &v, &unit(j), &Vector::ZERO);
        let columns: Vec<Vector<Slope, N>> = (0..n).map(column).collect();
        (0..n).flat_map(|i| columns.iter().map(move |column| column[i])).collect()
    }

    fn loads(&self, q_l: &[Slope], v_l: &[Slope], q_ld: &[[Slope; 5]]) -> Vec<Vec<Slope>> {
        let error = |i: usize| match q_ld.get(i) {
            Some(jet) => Jet::new([q_l[i] - jet[0], v_l[i] - jet[1]]),
            None => Jet::<Slope, 2>::ZERO,
        };
        let approach = self.law.link.shaping.eval(&Vector::from_fn(error));
        let asked = |i: usize| {
            let desired = q_ld.get(i).map_or(Slope::ZERO, |jet| jet[2].scale(Interval::from_f64(2.0)));
            desired - approach[i].coefficient(1)
        };
        let ([q_l, v_l], a_lr) = ([q_l, v_l].map(vector), Vector::from_fn(asked));
        self.alone.iter().map(|link| self.list(&link.inverse_dynamics(&q_l, &v_l, &v_l, &a_lr))).collect()
    }

    fn link_energy(&self, q_l: &[Interval], s_l: &[Interval]) -> Interval {
        let s_l = vector(s_l);
        s_l.dot(&self.robot.links.mass_mul(&vector(q_l), &s_l))
    }

    fn metrics(&self) -> [Vec<Interval>; 3] {
        let (Metric::Constant(link) | Metric::Hardening { base: link, .. }) = &self.law.link.metric;
        [self.list(link), self.list(&self.law.motor.metric), self.list(&self.robot.motor_inertia)]
    }

    fn damping(&self) -> [Vec<Interval>; 2] {
        [
            self.list(&(self.robot.link_damping + self.law.link.damping)),
            self.list(&(self.robot.motor_damping + self.law.motor.damping)),
        ]
    }

    fn drive(&self) -> Drive {
        Drive {
            stiffness: self.list(&self.robot.stiffness),
            motor_inertia: self.list(&self.robot.motor_inertia),
            motor_damping: self.list(&self.robot.motor_damping),
        }
    }
}

/// The law over intervals with derivatives. Compiled once per robot and number, out of line: it is much code.
#[inline(never)]
fn command<S: Over<Interval>, L, Pl, Pm, const N: usize>(
    law: &Vcbc<Interval, Pl, Pm, N>,
    robot: &Fjr<Interval, L, N>,
    x: &Place<S>,
    q_ld: &Vector<Jet<S, 5>, N>,
) -> Command<S, N>
where
    L: Links<Interval, N>,
    Pl: Shaping<Interval, N>,
    Pm: Shaping<Interval, N>,
{
    let motion =
        Motion { q_l: vector(&x.q_l), q_m: vector(&x.q_m), v_l: vector(&x.v_l), v_m: vector(&x.v_m) };
    law.command(robot, &motion, q_ld, &Input::ZERO)
}

/// The unit vector of joint `j`.
fn unit<T: Scalar, const N: usize>(j: usize) -> Vector<T, N> {
    Vector::from_fn(|i| if i == j { T::ONE } else { T::ZERO })
}

/// Per-joint numbers as a vector; zero for joints that only fill the capacity.
fn vector<T: Scalar, const N: usize>(values: &[T]) -> Vector<T, N> {
    Vector::from_fn(|i| values.get(i).copied().unwrap_or(T::ZERO))
}

impl<L: Links<Interval, N>, Pl, Pm, R, const N: usize> Enclosed<L, Pl, Pm, R, N> {
    /// The numbers of the robot's own joints.
    fn list<T: Copy>(&self, values: &Vector<T, N>) -> Vec<T> {
        values.iter().take(self.robot.links.joints()).collect()
    }
}
