//! How the errors move over a slab of time and a tube, whatever the robot's numbers are within their tolerances and whatever torque it
//! feels.
//!
//! Errors z = (q̃_l, q̃_m, s_l, s_m) are functions of the state and of time, made with the numbers of the model. Along a motion of
//! the robot that is there, exactly,
//!
//! q̃̇_l = −φ_l + s_l,
//! q̃̇_m = −φ_m − Π_m⁻¹ K s_l + s_m − (∂q_md/∂q̇_l) M'_l⁻¹ d_l,
//! M_l ṡ_l = −Π_l q̃_l − (C_l + D_l + K_ld) s_l + K q̃_m, and M'_l⁻¹ d_l beside it,
//! M_m ṡ_m = −Π_m q̃_m − (D_m + K_md) s_m, and M'_m⁻¹ d_m + (∂s_m/∂q̇_l) M'_l⁻¹ d_l beside it,
//!
//! where primes are the numbers of that robot and, with the accelerations that the model has at this state and torque,
//!
//! d_l = (K' − K) ζ − (D'_l − D_l) q̇_l − Σ μ_i (M_i q̈_l + C_i q̇_l + g_i) + unknown torque,
//! d_m = −(K' − K) ζ − (D'_m − D_m) q̇_m − (M'_m − M_m) q̈_m + unknown torque.
//!
//! for links i with masses that are by a part μ_i off: M'_l = M_l + Σ μ_i M_i. With |μ_i| ≤ μ all these are between (1 − μ) M_l and (1 + μ) M_l, so that
//! M'_l⁻¹ is M_l⁻¹ / (1 − μ²) and at most μ / (1 − μ²) times M_l⁻¹ either way.
//!
//! [`Flow`] has numbers for A, for the columns that torques enter by, and bounds for all that is left.

use flexure_core::scalar::{Interval, Jet, Over, Scalar};

use crate::linalg::{Dense, Symmetric};
use crate::prove::engine::envelope::closed_loop::{Place, Slope, TrackingLoop};
use crate::prove::engine::envelope::deviation::Spread;
use crate::prove::engine::envelope::response::responses;
use crate::prove::engine::envelope::slab::{Views, Way, differences};
use crate::prove::engine::envelope::tube::Tube;

/// ż = A z + Σ n w + δ at all times of a slab and all errors of a tube, one n for each [`Channel`].
#[derive(Clone, Debug, PartialEq)]
pub struct Flow {
    /// A.
    pub matrix: Dense<f64>,
    /// By what the errors are driven.
    pub channels: Vec<Channel>,
    /// Bounds of |δ_i|: what the numbers of A and of the columns leave open.
    pub rest: Vec<f64>,
}

/// n w, with |w| at most |w_0| + |c·z|.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// n.
    pub column: Vec<f64>,
    /// |w_0|, from above.
    pub size: f64,
    /// c; none if w does not depend on the errors.
    pub slope: Option<Vec<f64>>,
}

/// A column over slab and tube, and what goes through it.
struct Force {
    column: Vec<Interval>,
    size: Interval,
    slope: Option<Vec<Interval>>,
}

impl Flow {
    /// Over `tube` and the times `time` in s, with what `spread` leaves open; none if it no longer `goes_on`.
    pub fn over(
        system: &dyn TrackingLoop,
        spread: &Spread,
        tube: &dyn Tube,
        time: Interval,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<Self> {
        let way = Way::new(system, tube, &system.reference(time), time, goes_on);
        let seen = Seen::new(system, spread, &way)?;
        let errors = tube.errors();
        let mut flow = Self {
            matrix: Dense::zeros(errors.len(), errors.len()),
            channels: Vec::new(),
            rest: vec![0.0; errors.len()],
        };
        flow.take(&seen.matrix(system, &errors), &errors);
        for force in seen.forces(system, spread) {
            flow.add(&force, tube, &errors);
        }
        Some(flow)
    }

    /// A: the middles of `matrix`, and what they leave open of its product with `errors`.
    fn take(&mut self, matrix: &Dense<Interval>, errors: &[Interval]) {
        for (i, row) in matrix.rows().enumerate() {
            let mut left = Interval::ZERO;
            for (j, (entry, error)) in row.iter().zip(errors).enumerate() {
                self.matrix[(i, j)] = entry.midpoint();
                left += Interval::point(radius(*entry)) * Interval::point(error.magnitude());
            }
            self.rest[i] = left.hi();
        }
    }

    /// One more channel, if anything goes through it.
    fn add(&mut self, force: &Force, tube: &dyn Tube, errors: &[Interval]) {
        let point = |values: &[Interval]| values.iter().map(|x| x.midpoint()).collect::<Vec<f64>>();
        let mut size = Interval::point(force.size.magnitude());
        let mut all = size;
        if let Some(slope) = &force.slope {
            all += Interval::point(tube.reach(slope).magnitude());
            for (c, error) in slope.iter().zip(errors) {
                size += Interval::point(radius(*c)) * Interval::point(error.magnitude());
            }
        }
        if all.magnitude() == 0.0 {
            return;
        }
        for (rest, n) in self.rest.iter_mut().zip(&force.column) {
            *rest = (Interval::point(*rest) + Interval::point(radius(*n)) * all).hi();
        }
        self.channels.push(Channel {
            column: point(&force.column),
            size: size.hi(),
            slope: force.slope.as_deref().map(point).filter(|slope| slope.iter().any(|&c| c != 0.0)),
        });
    }
}

/// How far the ends of `x` are from its middle, from above.
fn radius(x: Interval) -> f64 {
    (x - Interval::point(x.midpoint())).magnitude()
}

/// What the loop does over a slab and a tube.
struct Seen {
    n: usize,
    /// Link velocities, deflections, motor velocities, torques that accelerate the motors, and the loads of each link if masses are not known.
    all: Views,
    /// M_l⁻¹.
    inverse_mass: Symmetric<Interval>,
    /// M'_l⁻¹.
    mobility: Symmetric<Interval>,
    /// With it.
    responses: [Dense<Interval>; 2],
    q_l: Vec<Interval>,
}

impl Seen {
    fn new(system: &dyn TrackingLoop, spread: &Spread, way: &Way<'_>) -> Option<Self> {
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
            let loads = if spread.has_masses() {
                system.loads(&Place { q_l, q_m: x_m, v_l: v_l.clone(), v_m: u_m.clone() }).concat()
            } else {
                Vec::new()
            };
            [v_l, deflection, u_m, accelerates, loads].concat()
        })?;
        let q_l = way.links(system);
        let inverse_mass = system.inverse_mass(&q_l);
        let mobility = mobility(&inverse_mass, &spread.link_mass);
        let ranges = |part: usize| &all.ranges[part * n..(part + 1) * n];
        let responses = responses(system, way, &mobility, [&q_m.ranges, ranges(0), ranges(2)]);
        Some(Self { n, all, inverse_mass, mobility, responses, q_l })
    }

    /// A over slab and tube; `errors` is the box of the tube.
    fn matrix(&self, system: &dyn TrackingLoop, errors: &[Interval]) -> Dense<Interval> {
        let n = self.n;
        let [metric_l, metric_m, inertia] = system.metrics();
        let ([damping_l, damping_m], drive) = (system.damping(), system.drive());
        let coriolis = system.coriolis(&self.q_l, &self.all.ranges[..n]);
        let approach_l = slopes(&errors[..n], &|e| system.approach(e));
        let approach_m = slopes(&errors[n..2 * n], &|e| system.approach_m(e));
        let diagonal = |i: usize, j: usize, x: Interval| if i == j { x } else { Interval::ZERO };
        // Torques on the links by the errors, before M⁻¹.
        let torque = |i: usize, block: usize, j: usize| match block {
            0 => diagonal(i, j, -metric_l[i]),
            1 => diagonal(i, j, drive.stiffness[i]),
            2 => -(coriolis[(i, j)] + diagonal(i, j, damping_l[i])),
            _ => Interval::ZERO,
        };
        Dense::from_fn(4 * n, 4 * n, |row, column| {
            let ((block, i), (of, j)) = ((row / n, row % n), (column / n, column % n));
            match (block, of) {
                (0, 0) => -approach_l[(i, j)],
                (0, 2) | (1, 3) => diagonal(i, j, Interval::ONE),
                (1, 1) => -approach_m[(i, j)],
                (1, 2) => diagonal(i, j, -drive.stiffness[i] / metric_m[i]),
                (2, _) => {
                    (0..n).fold(Interval::ZERO, |sum, k| sum + self.inverse_mass.at(i, k) * torque(k, of, j))
                }
                (3, 1) => diagonal(i, j, -metric_m[i] / inertia[i]),
                (3, 3) => diagonal(i, j, -damping_m[i] / inertia[i]),
                _ => Interval::ZERO,
            }
        })
    }

    /// What drives the errors.
    fn forces(&self, system: &dyn TrackingLoop, spread: &Spread) -> Vec<Force> {
        let (n, drive) = (self.n, system.drive());
        let on_link = |i: usize| self.link_column(i);
        let on_motor = |i: usize| {
            let inverse = (drive.motor_inertia[i] + both_ways(spread.motor_inertia[i])).recip();
            (0..4 * n)
                .map(move |row| if row == 3 * n + i { inverse } else { Interval::ZERO })
                .collect::<Vec<_>>()
        };
        let seen = |part: usize, i: usize, tolerance: Interval, column: Vec<Interval>| {
            let k = part * n + i;
            Force {
                column,
                size: self.all.track[k].coefficient(0) * tolerance,
                slope: Some(self.all.gradients.row(k).iter().map(|&g| g * tolerance).collect()),
            }
        };
        let unknown = |size: Interval, column: Vec<Interval>| Force { column, size, slope: None };
        let of_joint = |i: usize| {
            let between = on_link(i).iter().zip(on_motor(i)).map(|(&a, b)| a - b).collect();
            [
                unknown(spread.link_torque[i], on_link(i)),
                unknown(spread.motor_torque[i], on_motor(i)),
                seen(1, i, spread.stiffness[i], between),
                seen(0, i, spread.link_damping[i], on_link(i)),
                seen(2, i, spread.motor_damping[i], on_motor(i)),
                seen(3, i, spread.motor_inertia[i] / drive.motor_inertia[i], on_motor(i)),
            ]
        };
        let mut forces: Vec<_> = (0..n).flat_map(of_joint).collect();
        if spread.has_masses() {
            forces.extend(self.masses(spread));
        }
        forces
    }

    /// What masses that are off do: one number a link, which the load on the reference goes with, and how else it may be, joint by joint.
    fn masses(&self, spread: &Spread) -> Vec<Force> {
        let n = self.n;
        let load = |i: usize, j: usize| 4 * n + i * n + j;
        let middle =
            |i: usize, j: usize| Interval::point(self.all.track[load(i, j)].coefficient(0).midpoint());
        let columns: Vec<_> = (0..n).map(|j| self.link_column(j)).collect();
        let of_link = |i: usize| {
            let entry = |row| (0..n).fold(Interval::ZERO, |sum, j| sum + columns[j][row] * middle(i, j));
            Force { column: (0..4 * n).map(entry).collect(), size: spread.link_mass[i], slope: None }
        };
        let beside = |j: usize| {
            let left =
                |i: usize| (self.all.ranges[load(i, j)] - middle(i, j)) * both_ways(spread.link_mass[i]);
            let size = (0..n).map(left).fold(Interval::ZERO, |sum, left| sum + left);
            Force { column: columns[j].clone(), size, slope: None }
        };
        (0..n).map(of_link).chain((0..n).map(beside)).collect()
    }

    /// By what a torque on link `i` enters.
    fn link_column(&self, i: usize) -> Vec<Interval> {
        let n = self.n;
        let entry = |row: usize| match row / n {
            0 => Interval::ZERO,
            1 => -self.responses[0][(row % n, i)],
            2 => self.mobility.at(row % n, i),
            _ => self.responses[1][(row % n, i)],
        };
        (0..4 * n).map(entry).collect()
    }
}

/// M'_l⁻¹ from M_l⁻¹, masses being off by `parts` at most.
fn mobility(inverse_mass: &Symmetric<Interval>, parts: &[Interval]) -> Symmetric<Interval> {
    let most = Interval::point(parts.iter().map(|part| part.magnitude()).fold(0.0, f64::max));
    let middle = (Interval::ONE - most.square()).recip();
    Symmetric::from_fn(inverse_mass.size(), |i, j| {
        let size = if i == j {
            inverse_mass.at(i, i)
        } else {
            (inverse_mass.at(i, i) * inverse_mass.at(j, j)).sqrt()
        };
        middle * (inverse_mass.at(i, j) + both_ways(most) * Interval::point(size.magnitude()))
    })
}

/// From −`x` to `x`.
fn both_ways(x: Interval) -> Interval {
    (-x).hull(x)
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
