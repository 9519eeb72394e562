//! What a loop does over a slab of time and a tube, as [`Flow`] has numbers for: A, and all that drives the errors beside it.
//!
//! [`Flow`]: super::flow::Flow

use flexure_core::scalar::{Interval, Jet, Over, Scalar};

use crate::linalg::{Dense, Symmetric};
use crate::prove::engine::envelope::closed_loop::{Slope, TrackingLoop};
use crate::prove::engine::envelope::deviation::Spread;
use crate::prove::engine::envelope::masses::Masses;
use crate::prove::engine::envelope::response::responses;
use crate::prove::engine::envelope::slab::{Views, Way, differences};

/// Columns over slab and tube, and what goes through them.
pub(super) struct Force {
    /// n_k.
    pub columns: Vec<Vec<Interval>>,
    /// ṅ_k; none if they do not change.
    pub drifts: Vec<Vec<Interval>>,
    /// |w_0|.
    pub size: Interval,
    /// Rows of C.
    pub slopes: Vec<Vec<Interval>>,
    /// Whether numbers leave it open, and not the robot.
    pub is_open: bool,
}

/// What the loop does over a slab and a tube.
pub(super) struct Seen {
    n: usize,
    /// Link velocities, deflections, motor velocities, torques that accelerate the motors, the lower triangle of M_l⁻¹, C_l, and the loads of each
    /// link if masses are not known.
    all: Views,
    masses: Masses,
    /// F: torques on the links by the errors, before M_l⁻¹.
    torques: Torques,
    /// t − t_c in s.
    offset: Interval,
    /// B, column by column.
    through: Vec<Vec<Interval>>,
    /// B L, column by column.
    rooted: Vec<Vec<Interval>>,
}

/// F(t) + what it is beside that, F(t) = F + (t − t_c) Ḟ.
struct Torques {
    middle: Dense<Interval>,
    drift: Dense<Interval>,
    beside: Dense<Interval>,
    /// All of it, over slab and tube.
    whole: Dense<Interval>,
}

impl Seen {
    /// Over slab and tube; none if it no longer goes on.
    pub fn new(system: &dyn TrackingLoop, spread: &Spread, way: &Way<'_>) -> Option<Self> {
        let n = system.joints();
        let (q_m, v_m) = way.motors(system)?;
        let drive = system.drive();
        let all = way.along(&|seed| {
            let (x_m, u_m) = (q_m.at(seed), v_m.at(seed));
            let (q_l, v_l) = seed.links(system);
            let deflection = differences(&x_m, &q_l);
            let torque = seed.answer(system, &x_m, &u_m).u_m;
            let accelerates = (0..n).map(|i| {
                torque[i] - deflection[i].scale(drive.stiffness[i]) - u_m[i].scale(drive.motor_damping[i])
            });
            let accelerates = accelerates.collect();
            let [mobility, coriolis] = [system.mobility(&q_l), system.coriolis(&q_l, &v_l)];
            let loads =
                if spread.has_masses() { system.loads(&q_l, &v_l, &seed.q_ld).concat() } else { Vec::new() };
            [v_l, deflection, u_m, accelerates, mobility, coriolis, loads].concat()
        })?;
        let q_l = way.links(system);
        let ranges = |part: usize| &all.ranges[part * n..(part + 1) * n];
        let natural = system.inverse_mass(&q_l);
        let first = 4 * n;
        let inverse_mass = Symmetric::from_fn(n, |i, j| {
            let (x, natural) = (all.ranges[first + entry(i, j)], natural.at(i, j));
            x.intersection(natural).unwrap_or(natural)
        });
        let on_lines = Symmetric::from_fn(n, |i, j| all.line(first + entry(i, j)));
        let beside = Symmetric::from_fn(n, |i, j| all.beside[first + entry(i, j)]);
        let masses = Masses::new(&inverse_mass, &on_lines, &beside, &spread.link_mass);
        let unit = |i: usize, k: usize| if i == k { Interval::ONE } else { Interval::ZERO };
        let [desired, asked] = responses(system, way, &unit, [&q_m.ranges, ranges(0), ranges(2)]);
        let through = |k: usize| {
            let entry = |row: usize| match row / n {
                0 => Interval::ZERO,
                1 => -desired[(row % n, k)],
                2 => unit(row % n, k),
                _ => asked[(row % n, k)],
            };
            (0..4 * n).map(entry).collect()
        };
        let through: Vec<_> = (0..n).map(through).collect();
        let rooted = (0..n).map(|k| combined(&through, |m| Interval::point(masses.root[(m, k)]))).collect();
        let torques = Torques::new(system, &all);
        Some(Self { n, all, masses, torques, offset: way.offset, through, rooted })
    }

    /// A at the middle of the slab and Ȧ, over slab and tube, but for what inverse masses leave open; `errors` is the box of the tube.
    pub fn matrices(&self, system: &dyn TrackingLoop, errors: &[Interval]) -> [Dense<Interval>; 2] {
        let (n, masses, torques) = (self.n, &self.masses, &self.torques);
        let number = Dense::from(&masses.number);
        let rate = Dense::from(&masses.rate.map(Interval::point));
        let moved = &number + &rate.map(|x| x * self.offset);
        let beside =
            &(&moved * &torques.beside) + &(&rate * &torques.drift).map(|x| x * self.offset.square());
        let accelerations = [
            &(&number * &torques.middle) + &beside,
            &(&number * &torques.drift) + &(&rate * &torques.middle),
        ];
        let robot = [&number * &torques.whole, &rate * &torques.whole];
        let [itself, none] =
            [self.itself(system, errors), Dense::from_fn(4 * n, 4 * n, |_, _| Interval::ZERO)];
        let [a, drift] = [(itself, 0), (none, 1)].map(|(beside, order)| {
            Dense::from_fn(4 * n, 4 * n, |row, column| {
                let more = masses.more.middle;
                let links =
                    if row / n == 2 { accelerations[order][(row % n, column)] } else { Interval::ZERO };
                let robot = if more.magnitude() == 0.0 {
                    Interval::ZERO
                } else {
                    (0..n).fold(Interval::ZERO, |sum, k| {
                        sum + more * self.through[k][row] * robot[order][(k, column)]
                    })
                };
                beside[(row, column)] + links + robot
            })
        });
        [a, drift]
    }

    /// A without accelerations of the links.
    fn itself(&self, system: &dyn TrackingLoop, errors: &[Interval]) -> Dense<Interval> {
        let n = self.n;
        let [_, metric_m, inertia] = system.metrics();
        let ([_, damping_m], drive) = (system.damping(), system.drive());
        let approach_l = slopes(&errors[..n], &|e| system.approach(e));
        let approach_m = slopes(&errors[n..2 * n], &|e| system.approach_m(e));
        let diagonal = |i: usize, j: usize, x: Interval| if i == j { x } else { Interval::ZERO };
        Dense::from_fn(4 * n, 4 * n, |row, column| {
            let ((block, i), (of, j)) = ((row / n, row % n), (column / n, column % n));
            match (block, of) {
                (0, 0) => -approach_l[(i, j)],
                (0, 2) | (1, 3) => diagonal(i, j, Interval::ONE),
                (1, 1) => -approach_m[(i, j)],
                (1, 2) => diagonal(i, j, -drive.stiffness[i] / metric_m[i]),
                (3, 1) => diagonal(i, j, -metric_m[i] / inertia[i]),
                (3, 3) => diagonal(i, j, -damping_m[i] / inertia[i]),
                _ => Interval::ZERO,
            }
        })
    }

    /// What drives the errors: joint by joint, then what masses that are off do, then what inverse masses leave open.
    pub fn forces(&self, system: &dyn TrackingLoop, spread: &Spread) -> Vec<Force> {
        let (n, drive) = (self.n, system.drive());
        let on_link = |i: usize| self.link_column(i);
        let on_motor = |i: usize| {
            let inverse = (drive.motor_inertia[i] + both_ways(spread.motor_inertia[i])).recip();
            let column = |row: usize| if row == 3 * n + i { inverse } else { Interval::ZERO };
            [(0..4 * n).map(column).collect(), vec![Interval::ZERO; 4 * n]]
        };
        let seen = |part: usize, i: usize, tolerance: Interval, [column, drift]: [Vec<Interval>; 2]| {
            let k = part * n + i;
            Force {
                columns: vec![column],
                drifts: vec![drift],
                size: self.all.track[k].coefficient(0) * tolerance,
                slopes: vec![self.all.gradients.row(k).iter().map(|&g| g * tolerance).collect()],
                is_open: false,
            }
        };
        let of_joint = |i: usize| {
            let [[link, drift], [motor, _]] = [on_link(i), on_motor(i)];
            let between = [link.iter().zip(&motor).map(|(&a, &b)| a - b).collect(), drift];
            [
                Force::unknown(spread.link_torque[i], on_link(i)),
                Force::unknown(spread.motor_torque[i], on_motor(i)),
                seen(1, i, spread.stiffness[i], between),
                seen(0, i, spread.link_damping[i], on_link(i)),
                seen(2, i, spread.motor_damping[i], on_motor(i)),
                seen(3, i, spread.motor_inertia[i] / drive.motor_inertia[i], on_motor(i)),
            ]
        };
        let mut forces: Vec<_> = (0..n).flat_map(of_joint).collect();
        if spread.has_masses() {
            forces.extend(self.loads(spread));
        }
        forces.extend(self.open_masses(spread));
        forces
    }

    /// The load of link `i` on joint `j`, among all.
    fn load(&self, i: usize, j: usize) -> usize {
        coriolis(self.n, self.n, 0) + i * self.n + j
    }

    /// What masses that are off do: one number a link, which the load on the reference goes with, and how else it may be, joint by joint.
    fn loads(&self, spread: &Spread) -> Vec<Force> {
        let n = self.n;
        let middle =
            |i: usize, j: usize| Interval::point(self.all.track[self.load(i, j)].coefficient(0).midpoint());
        let columns: Vec<_> = (0..n).map(|j| self.link_column(j)).collect();
        let of_link = |i: usize| {
            let of = |order: usize| {
                let columns: Vec<_> = columns.iter().map(|column| column[order].clone()).collect();
                combined(&columns, |j| middle(i, j))
            };
            Force::unknown(spread.link_mass[i], [of(0), of(1)])
        };
        let beside = |j: usize| {
            let left =
                |i: usize| (self.all.ranges[self.load(i, j)] - middle(i, j)) * both_ways(spread.link_mass[i]);
            let size = (0..n).map(left).fold(Interval::ZERO, |sum, left| sum + left);
            Force::unknown(size, columns[j].clone())
        };
        (0..n).map(of_link).chain((0..n).map(beside)).collect()
    }

    /// What numbers for the inverse masses leave open: of the model's, in the rows of s_l, and of the robot's, over the model's.
    fn open_masses(&self, spread: &Spread) -> [Force; 2] {
        let n = self.n;
        let root = |i: usize, k: usize| Interval::point(self.masses.root[(i, k)]);
        // Rows of Lᵀ F.
        let rows: Vec<_> = (0..n).map(|i| self.torques.whole.row(i).to_vec()).collect();
        let times = |factor: Interval| {
            let row = |k: usize| combined(&rows, |i| root(i, k) * factor);
            (0..n).map(row).collect::<Vec<_>>()
        };
        let in_place = |k: usize| {
            let entry = |row: usize| if row / n == 2 { root(row % n, k) } else { Interval::ZERO };
            (0..4 * n).map(entry).collect()
        };
        // |d'_l|, joint by joint.
        let felt = |j: usize| {
            let of = |part: usize, tolerance: Interval| {
                Interval::point(self.all.ranges[part * n + j].magnitude()) * tolerance
            };
            let heavy = |i: usize| {
                Interval::point(self.all.ranges[self.load(i, j)].magnitude()) * spread.link_mass[i]
            };
            let loads = if spread.has_masses() { n } else { 0 };
            (0..loads).map(heavy).fold(
                spread.link_torque[j] + of(1, spread.stiffness[j]) + of(0, spread.link_damping[j]),
                |sum, load| sum + load,
            )
        };
        let rooted = |k: usize| {
            (k..n).fold(Interval::ZERO, |sum, j| sum + Interval::point(root(j, k).magnitude()) * felt(j))
        };
        [
            Force {
                columns: (0..n).map(in_place).collect(),
                drifts: Vec::new(),
                size: Interval::ZERO,
                slopes: times(self.masses.model),
                is_open: true,
            },
            Force {
                columns: self.rooted.clone(),
                drifts: Vec::new(),
                size: self.masses.robot.radius * norm((0..n).map(rooted)),
                slopes: times(self.masses.more.radius),
                is_open: !spread.has_masses(),
            },
        ]
    }

    /// By what a torque on link `j` enters, and the rate of that: c B N(t).
    fn link_column(&self, j: usize) -> [Vec<Interval>; 2] {
        let (masses, times) = (&self.masses, self.masses.robot.middle);
        [
            combined(&self.through, |m| times * masses.number.at(m, j)),
            combined(&self.through, |m| times * Interval::point(masses.rate.at(m, j))),
        ]
    }
}

impl Force {
    /// Of at most `size`, whatever the errors.
    fn unknown(size: Interval, [column, drift]: [Vec<Interval>; 2]) -> Self {
        Self { columns: vec![column], drifts: vec![drift], size, slopes: Vec::new(), is_open: false }
    }
}

/// Where entry (i, j) of a lower triangle is, row by row, `j` ≤ `i`.
fn entry(i: usize, j: usize) -> usize {
    i * (i + 1) / 2 + j
}

/// Where entry (i, j) of C_l of `n` joints is, among all.
fn coriolis(n: usize, i: usize, j: usize) -> usize {
    4 * n + entry(n, 0) + i * n + j
}

impl Torques {
    fn new(system: &dyn TrackingLoop, all: &Views) -> Self {
        let n = system.joints();
        let [metric, ..] = system.metrics();
        let ([damping, _], drive) = (system.damping(), system.drive());
        let diagonal = |i: usize, j: usize, x: Interval| if i == j { x } else { Interval::ZERO };
        let made = |constant: bool, c: &dyn Fn(usize) -> Interval| {
            let times = if constant { Interval::ONE } else { Interval::ZERO };
            Dense::from_fn(n, 4 * n, |i, column| match (column / n, column % n) {
                (0, j) => diagonal(i, j, -metric[i] * times),
                (1, j) => diagonal(i, j, drive.stiffness[i] * times),
                (2, j) => -(c(coriolis(n, i, j)) + diagonal(i, j, damping[i] * times)),
                _ => Interval::ZERO,
            })
        };
        Self {
            middle: made(true, &|k| Interval::point(all.line(k)[0])),
            drift: made(false, &|k| Interval::point(all.line(k)[1])),
            beside: made(false, &|k| all.beside[k]),
            whole: made(true, &|k| all.ranges[k]),
        }
    }
}

/// Σ_k factor(k) v_k.
fn combined(vectors: &[Vec<Interval>], factor: impl Fn(usize) -> Interval) -> Vec<Interval> {
    let size = vectors.first().map_or(0, Vec::len);
    let factors: Vec<_> = (0..vectors.len()).map(factor).collect();
    let entry = |i: usize| {
        vectors.iter().zip(&factors).fold(Interval::ZERO, |sum, (vector, &factor)| sum + factor * vector[i])
    };
    (0..size).map(entry).collect()
}

/// From −`x` to `x`.
fn both_ways(x: Interval) -> Interval {
    (-x).hull(x)
}

/// The length of a vector.
pub(super) fn norm(entries: impl Iterator<Item = Interval>) -> Interval {
    entries.fold(Interval::ZERO, |sum, x| sum + x.square()).sqrt()
}

/// The slopes of `f` between 0 and any point of the box `e`: by the mean value theorem.
fn slopes(e: &[Interval], f: &dyn Fn(&[Slope]) -> Vec<Slope>) -> Dense<Interval> {
    let column = |j: usize| {
        let seeded = |(i, &e): (usize, &Interval)| {
            Jet::new([e, if i == j { Interval::ONE } else { Interval::ZERO }, Interval::ZERO])
        };
        let e: Vec<_> = e.iter().enumerate().map(seeded).collect();
        f(&e).iter().map(|x| x.coefficient(1)).collect::<Vec<_>>()
    };
    Dense::from_columns(&(0..e.len()).map(column).collect::<Vec<_>>())
}
