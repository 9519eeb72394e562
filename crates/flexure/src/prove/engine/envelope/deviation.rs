//! What becomes of the errors when the robot is not the one that the law knows: other springs, motors and dampers, each within its
//! tolerance.
//!
//! Errors and W are functions of the true state and of time, made with the numbers of the model: q̃, s and W do not depend on
//! accelerations. So along a motion of the robot that is there
//!
//! Ẇ = (Ẇ of the model at this state and time) + x̃ᵀ P w,      w = ∂x̃/∂q̇_l Δq̈_l + ∂x̃/∂q̇_m Δq̈_m,
//!
//! exactly, where Δq̈ is by how much the robot's accelerations differ from the model's at the same state and torque,
//!
//! M_l Δq̈_l = (K' − K) ζ − (D_l' − D_l) q̇_l,
//! M_m' Δq̈_m = −(M_m' − M_m) q̈_m − (D_m' − D_m) q̇_m − (K' − K) ζ,
//!
//! q̈_m that of the model. w is affine in the absolute values of ζ, q̇_l, q̇_m, q̈_m, and those are at most what they are on the
//! reference plus a multiple of the errors. With r_b = √(2 W_b) for the four blocks b of W, Σ r_b² = 2 W, this makes
//!
//! Ẇ ≤ −rᵀ A r + ηᵀ r,      A = diag(β) − (Γ + Γᵀ)/2.
//!
//! With ρ = √(2 W) = |r|, μ the smallest eigenvalue of A and ν² = ηᵀ (A − λ)⁻¹ η / (4 λ) for some λ between 0 and μ it follows that
//! ηᵀ r ≤ rᵀ (A − λ) r + λ ν² for all r, so ηᵀ u ≤ ν uᵀ A u for all |u| = 1, and so, where ρ ≥ ν,
//!
//! ρ̇ ≤ −μ (ρ − ν):
//!
//! √(2 W) comes down to ν at the rate μ, and stays there.
//!
//! Nothing of the coupling cancels here: q_md = q_l + K⁻¹ u_l is made with the model's K, and its derivatives with the model's
//! accelerations.

use flexure_core::scalar::{Interval, Over, Scalar};

use crate::linalg::{Dense, Symmetric, cholesky, solved, weakest};
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::envelope::response::responses;
use crate::prove::engine::envelope::slab::{Way, differences};
use crate::prove::engine::envelope::tube::ErrorTube;

/// Blocks of W: q̃_l, q̃_m, s_l, s_m.
const BLOCKS: usize = 4;

/// How far the robot's numbers may be from the model's, either way, and the torque that the motors may feel beside that: one
/// entry per joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Spread {
    /// Of K [N m/rad].
    pub stiffness: Vec<Interval>,
    /// Of M_m, less than that [kg m²].
    pub motor_inertia: Vec<Interval>,
    /// Of D_l [N m s/rad].
    pub link_damping: Vec<Interval>,
    /// Of D_m [N m s/rad].
    pub motor_damping: Vec<Interval>,
    /// Of mass and inertia of each link, as a part of both, less than 1.
    pub link_mass: Vec<Interval>,
    /// Unknown torque on the motors [N m].
    pub motor_torque: Vec<Interval>,
    /// Unknown torque on the links [N m].
    pub link_torque: Vec<Interval>,
}

impl Spread {
    /// All tolerances times `factor`, the torque as it is.
    pub fn times(&self, factor: f64) -> Self {
        let times = |values: &[Interval]| values.iter().map(|&x| x * Interval::point(factor)).collect();
        Self {
            stiffness: times(&self.stiffness),
            motor_inertia: times(&self.motor_inertia),
            link_damping: times(&self.link_damping),
            motor_damping: times(&self.motor_damping),
            link_mass: times(&self.link_mass),
            motor_torque: self.motor_torque.clone(),
            link_torque: self.link_torque.clone(),
        }
    }

    /// Whether the links may be heavier or lighter than the model's.
    pub fn has_masses(&self) -> bool {
        self.link_mass.iter().any(|part| part.magnitude() > 0.0)
    }

    /// Whether the robot may be another than the model at all.
    pub fn has_tolerances(&self) -> bool {
        !self.one_by_one().is_empty()
    }

    /// All torques times `factor`, the tolerances as they are.
    pub fn with_torques_times(&self, factor: f64) -> Self {
        let times = |values: &[Interval]| values.iter().map(|&x| x * Interval::point(factor)).collect();
        Self {
            motor_torque: times(&self.motor_torque),
            link_torque: times(&self.link_torque),
            ..self.clone()
        }
    }

    /// Every tolerance that is not 0, with its key in robot files and its joint, from 0, and nothing beside it.
    pub fn one_by_one(&self) -> Vec<(&'static str, usize, Self)> {
        let zero = || vec![Interval::ZERO; self.motor_torque.len()];
        let none = Self { motor_torque: zero(), link_torque: zero(), ..self.times(0.0) };
        let of = |key, values: fn(&mut Self) -> &mut Vec<Interval>| {
            let all = values(&mut self.clone()).clone();
            let none = none.clone();
            all.into_iter().enumerate().filter(|(_, x)| x.magnitude() > 0.0).map(move |(joint, x)| {
                let mut one = none.clone();
                values(&mut one)[joint] = x;
                (key, joint, one)
            })
        };
        of("stiffness", |one| &mut one.stiffness)
            .chain(of("motor_inertia", |one| &mut one.motor_inertia))
            .chain(of("link_damping", |one| &mut one.link_damping))
            .chain(of("motor_damping", |one| &mut one.motor_damping))
            .chain(of("link_mass", |one| &mut one.link_mass))
            .collect()
    }
}

/// An upper bound that is affine in the r_b: its value where all are 0, and its slopes.
#[derive(Clone, Copy, Debug)]
struct Affine([Interval; 1 + BLOCKS]);

/// ρ̇ ≤ −μ (ρ − ν) where ρ = √(2 W) ≥ ν.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// μ > 0 [1/s].
    pub rate: f64,
    /// ν in √J.
    pub length: f64,
}

/// λ is taken from so many parts of μ.
const SHARES: u32 = 32;

/// What the difference does to W over a slab of time and the tube {W ≤ c}.
#[derive(Clone, Debug)]
pub struct Deviation {
    /// Times that it is about in s.
    pub time: Interval,
    /// η_b in √W, per s.
    pub steady: [f64; BLOCKS],
    /// Γ_bc [1/s].
    pub slopes: [[f64; BLOCKS]; BLOCKS],
}

impl Affine {
    const ZERO: Self = Self([Interval::ZERO; 1 + BLOCKS]);

    fn plus(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }

    /// Times the largest absolute value of `factor`.
    fn times(self, factor: Interval) -> Self {
        let factor = Interval::point(factor.magnitude());
        Self(self.0.map(|x| x * factor))
    }

    /// An upper bound of √(Σ `weights_i` x_i²), by the triangle inequality in the space of the x.
    fn norm(all: &[Self], weights: &[Interval]) -> Self {
        let part = |k: usize| {
            let sum = all.iter().zip(weights).fold(Interval::ZERO, |sum, (x, &w)| sum + w * x.0[k].square());
            Interval::point(sum.sqrt().hi())
        };
        Self(std::array::from_fn(part))
    }

    fn highs(self) -> [f64; 1 + BLOCKS] {
        self.0.map(Interval::hi)
    }
}

impl Deviation {
    /// Over the tube of level `level` in J and the times `time` in s; none if it no longer `goes_on`.
    pub fn watched(
        system: &dyn TrackingLoop,
        spread: &Spread,
        level: f64,
        time: Interval,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<Self> {
        let n = system.joints();
        let jets = system.reference(time);
        let tube = ErrorTube::new(system, level, &jets.iter().map(|jet| jet[0]).collect::<Vec<_>>());
        let way = Way::new(system, &tube, &jets, time, goes_on);
        let (q_m, v_m) = way.motors(system)?;
        let drive = system.drive();
        let all = way.along(&|seed| {
            let (x_m, u_m) = (q_m.at(seed), v_m.at(seed));
            let (q_l, v_l) = seed.links(system);
            let deflection = differences(&x_m, &q_l);
            let torque = seed.answer(system, &x_m, &u_m).u_m;
            let drive_torque = (0..n).map(|i| {
                torque[i] - deflection[i].scale(drive.stiffness[i]) - u_m[i].scale(drive.motor_damping[i])
            });
            let drive_torque = drive_torque.collect();
            [v_l, deflection, u_m, drive_torque].concat()
        })?;
        let affine = |k: usize| {
            let gradient = all.gradients.row(k);
            let block = |b: usize| {
                let of_block = |(i, &g): (usize, &Interval)| if i / n == b { g } else { Interval::ZERO };
                tube.dual(&gradient.iter().enumerate().map(of_block).collect::<Vec<_>>())
            };
            let at_rest = Interval::point(all.track[k].coefficient(0).magnitude());
            Affine(std::array::from_fn(|i| if i == 0 { at_rest } else { block(i - 1) }))
        };
        let [velocity, deflection, motor_velocity, drive_torque] =
            [0, 1, 2, 3].map(|q| (q * n..(q + 1) * n).map(affine).collect::<Vec<_>>());
        // Torque on the links, acceleration of the motors.
        let on_link = |i: usize| {
            deflection[i].times(spread.stiffness[i]).plus(velocity[i].times(spread.link_damping[i]))
        };
        let of_motor = |i: usize| {
            let inertia = drive.motor_inertia[i];
            let least = inertia - spread.motor_inertia[i];
            let unknown = Affine(std::array::from_fn(|k| {
                if k == 0 { Interval::point(spread.motor_torque[i].magnitude()) } else { Interval::ZERO }
            }));
            let torques = drive_torque[i]
                .times(spread.motor_inertia[i] / inertia)
                .plus(motor_velocity[i].times(spread.motor_damping[i]))
                .plus(deflection[i].times(spread.stiffness[i]))
                .plus(unknown);
            torques.times(least.recip())
        };
        let on_links: Vec<_> = (0..n).map(on_link).collect();
        let of_motors: Vec<_> = (0..n).map(of_motor).collect();
        let ranges = |part: usize| all.ranges[part * n..(part + 1) * n].to_vec();
        let inverse_mass = |j: usize, i: usize| tube.inverse_mass().at(j, i);
        let responses = responses(system, &way, &inverse_mass, [&q_m.ranges, &ranges(0), &ranges(2)]);
        let through = |response: &Dense<Interval>, j: usize| {
            (0..n).fold(Affine::ZERO, |sum, i| sum.plus(on_links[i].times(response[(j, i)])))
        };
        let desired: Vec<_> = (0..n).map(|j| through(&responses[0], j)).collect();
        let asked: Vec<_> = (0..n).map(|j| of_motors[j].plus(through(&responses[1], j))).collect();
        let [_, metric, inertia] = system.metrics();
        let blocks = [
            Affine::ZERO,
            Affine::norm(&desired, &metric),
            Affine::norm(&on_links, &tube.above_inverse_mass()),
            Affine::norm(&asked, &inertia),
        ]
        .map(Affine::highs);
        Some(Self {
            time,
            steady: blocks.map(|block| block[0]),
            slopes: blocks.map(|block| std::array::from_fn(|c| block[1 + c])),
        })
    }

    /// Whether the differences have finite bounds over the slab.
    pub fn is_bounded(&self) -> bool {
        self.steady.iter().chain(self.slopes.as_flattened()).all(|x| x.is_finite())
    }

    /// A, `rates` the β_b [1/s].
    fn decay(&self, rates: &[Interval; BLOCKS]) -> Symmetric<Interval> {
        let half = Interval::point(0.5);
        Symmetric::from_fn(BLOCKS, |i, j| {
            let coupling = (Interval::point(self.slopes[i][j]) + Interval::point(self.slopes[j][i])) * half;
            if i == j { rates[i] - coupling } else { -coupling }
        })
    }

    /// μ [1/s] and ν in √J, `rates` the β_b [1/s]; none where μ is not above 0 or nothing is bounded.
    pub fn bound(&self, rates: &[Interval; BLOCKS]) -> Option<Bound> {
        let decay = self.decay(rates);
        let lows = decay.map(Interval::lo);
        let (about, _) = weakest(&lows, &Symmetric::diagonal(&[1.0; BLOCKS]))?;
        let lowered = |rate: f64| {
            let rate = Interval::point(rate);
            Symmetric::from_fn(BLOCKS, |i, j| decay.at(i, j) - if i == j { rate } else { Interval::ZERO })
        };
        let less = [1e-12, 1e-9, 1e-6, 1e-3].map(|less| about * (1.0 - less));
        let rate = less.into_iter().find(|&rate| rate > 0.0 && lowered(rate).smallest_pivot() > 0.0)?;
        let length = (1..SHARES).map(|k| rate * f64::from(k) / f64::from(SHARES));
        let length = length.map(|lambda| self.length(&lowered(lambda), lambda)).fold(f64::INFINITY, f64::min);
        length.is_finite().then_some(Bound { rate, length })
    }

    /// ν from above for the λ [1/s] that `lowered` is A less of; infinite if it is not found.
    fn length(&self, lowered: &Symmetric<Interval>, lambda: f64) -> f64 {
        // ηᵀ (A − λ)⁻¹ η: in floats, a little more, and then by intervals that this is enough.
        let Some(lower) = cholesky(&lowered.map(Interval::lo)) else { return f64::INFINITY };
        let solved = solved(&lower, &self.steady);
        let product: f64 = self.steady.iter().zip(&solved).map(|(a, b)| a * b).sum();
        if product == 0.0 && self.steady.iter().all(|&x| x == 0.0) {
            return 0.0;
        }
        let enough = product * (1.0 + 1e-6);
        let bordered = Symmetric::from_fn(BLOCKS + 1, |i, j| match (i, j) {
            (BLOCKS, BLOCKS) => Interval::point(enough),
            (BLOCKS, j) => Interval::point(self.steady[j]),
            _ => lowered.at(i, j),
        });
        // Its last pivot is what `enough` is more.
        if bordered.smallest_pivot() > 0.0 {
            (Interval::point(enough) / (Interval::point(4.0) * Interval::point(lambda))).sqrt().hi()
        } else {
            f64::INFINITY
        }
    }
}
