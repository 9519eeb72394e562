//! What the robot may do in the tube over a slab of time, by the mean value theorem.
//!
//! On the way from the reference at the slab's middle to any time in it and any error x̃ in the tube, what is asked for
//! changes by ∂_t · (t − t_c) + g·x̃, with derivatives taken somewhere on the way: over the whole slab and tube.
//! Positions and velocities of the motors, which the law's derivatives depend on, are enclosed in the same manner first.

use flexure_core::scalar::{Dual, Interval, Scalar};

use super::closed_loop::{Answer, ClosedLoop, Place, Slope};
use super::tube::Tube;

/// Quantities per joint that are bounded, in the order of a slab's ranges: those of all joints, one quantity after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Link velocity q̇_l [rad/s].
    Velocity,
    /// Deflection of the spring q_m − q_l in rad.
    Deflection,
    /// Motor torque u_m [N m].
    Torque,
}

/// All of them.
pub const QUANTITIES: [Quantity; 3] = [Quantity::Velocity, Quantity::Deflection, Quantity::Torque];

/// The tube over a slab of time.
#[derive(Clone, Debug)]
pub struct Slab {
    /// Its times in s.
    pub time: Interval,
    /// The errors and the metric of W.
    pub tube: Tube,
    /// The quantities on the reference: at the middle, or over all times where the reference is not smooth.
    pub nominal: Vec<Interval>,
    /// Their derivatives by the errors q̃_l, q̃_m, s_l, s_m.
    pub gradients: Vec<Vec<Interval>>,
    /// The quantities.
    pub ranges: Vec<Interval>,
}

impl Slab {
    /// The tube of level `level` in J over the times `time` in s.
    pub fn new(system: &dyn ClosedLoop, level: f64, time: Interval) -> Self {
        let smooth = !system.breaks().iter().any(|at| at.intersection(time).is_some());
        let center = if smooth { Interval::point(time.midpoint()) } else { time };
        let jets = system.reference(time);
        let tube = Tube::new(system, level, &jets.iter().map(|jet| jet[0]).collect::<Vec<_>>());
        let still = vec![Interval::ZERO; 4 * system.joints()];
        let slab = Way {
            system,
            on: Seed { jets: &system.reference(center), errors: &still },
            around: Seed { jets: &jets, errors: &tube.errors() },
            offset: if smooth { time - center } else { Interval::ZERO },
            tube: &tube,
        };
        // The law wants motor positions and velocities where it tells what they should be: what it tells does not depend
        // on them, so that any will do.
        let nothing = vec![Slope::ZERO; system.joints()];
        let q_m = slab.along(&|seed| {
            let answer = seed.answer(system, &nothing, &nothing);
            sums(&answer.q_md, seed.part(1))
        });
        let v_m = slab.along(&|seed| {
            let answer = seed.answer(system, &q_m.at(seed), &nothing);
            sums(&differences(&nothing, &answer.s_m), seed.part(3))
        });
        let all = slab.along(&|seed| {
            let (q_m, v_m) = (q_m.at(seed), v_m.at(seed));
            let (q_l, v_l) = seed.links(system);
            [v_l, differences(&q_m, &q_l), seed.answer(system, &q_m, &v_m).u_m].concat()
        });
        let Spread { nominal, ranges, slopes } = all;
        let gradients = (0..nominal.len()).map(|k| slopes[1..].iter().map(|slope| slope[k]).collect());
        Self { time, gradients: gradients.collect(), nominal, ranges, tube }
    }

    /// Upper bound of the absolute value of quantity `k`.
    pub fn bound(&self, k: usize) -> f64 {
        self.ranges[k].magnitude()
    }

    /// About the largest absolute value that quantity `k` takes at the slab's middle, as far as its derivatives are known.
    pub fn seen(&self, k: usize) -> f64 {
        let near_zero = |g: &Interval| Interval::point(g.lo().max(0.0) + g.hi().min(0.0));
        let gradient: Vec<_> = self.gradients[k].iter().map(near_zero).collect();
        self.nominal[k].midpoint().abs() + self.tube.reach(&gradient).hi()
    }
}

/// Numbers at one direction: the reference over some times, the errors, and what is differentiated by.
struct Seeded {
    q_ld: Vec<[Slope; 5]>,
    errors: Vec<Slope>,
    /// 0 for time, 1 + i for error i; none on the reference.
    direction: Option<usize>,
}

/// Reference and errors without a direction.
struct Seed<'a> {
    jets: &'a [[Interval; 6]],
    errors: &'a [Interval],
}

impl Seed<'_> {
    fn towards(&self, direction: Option<usize>) -> Seeded {
        // d/dt of coefficient k is k + 1 times the next.
        let slope = |jet: &[Interval; 6], k: usize| match direction {
            Some(0) => jet[k + 1] * Interval::point((k + 1) as f64),
            _ => Interval::ZERO,
        };
        let q_ld = self.jets.iter().map(|jet| std::array::from_fn(|k| dual(jet[k], slope(jet, k))));
        let unit = |i: usize| if direction == Some(1 + i) { Interval::ONE } else { Interval::ZERO };
        let errors = self.errors.iter().enumerate().map(|(i, &error)| dual(error, unit(i)));
        Seeded { q_ld: q_ld.collect(), errors: errors.collect(), direction }
    }
}

impl Seeded {
    /// q̃_l, q̃_m, s_l or s_m.
    fn part(&self, which: usize) -> &[Slope] {
        let n = self.q_ld.len();
        &self.errors[which * n..(which + 1) * n]
    }

    /// q_l = q_ld + q̃_l and q̇_l = q̇_ld − φ_l(q̃_l) + s_l.
    fn links(&self, system: &dyn ClosedLoop) -> (Vec<Slope>, Vec<Slope>) {
        let order = |k: usize| self.q_ld.iter().map(|jet| jet[k]).collect::<Vec<_>>();
        let v_lr = differences(&order(1), &system.approach(self.part(0)));
        (sums(&order(0), self.part(0)), sums(&v_lr, self.part(2)))
    }

    fn answer(&self, system: &dyn ClosedLoop, q_m: &[Slope], v_m: &[Slope]) -> Answer {
        let (q_l, v_l) = self.links(system);
        system.command(&Place { q_l, q_m: q_m.to_vec(), v_l, v_m: v_m.to_vec() }, &self.q_ld)
    }
}

/// From the reference to everywhere in the slab's tube.
struct Way<'a> {
    system: &'a dyn ClosedLoop,
    on: Seed<'a>,
    around: Seed<'a>,
    /// t − t_c in s; zero where `on` has all times.
    offset: Interval,
    tube: &'a Tube,
}

/// Numbers on the reference, everywhere, and their derivatives by direction.
struct Spread {
    nominal: Vec<Interval>,
    ranges: Vec<Interval>,
    slopes: Vec<Vec<Interval>>,
}

impl Way<'_> {
    /// The numbers that `f` makes, over the tube and the slab.
    fn along(&self, f: &dyn Fn(&Seeded) -> Vec<Slope>) -> Spread {
        let nominal: Vec<_> = f(&self.on.towards(None)).iter().map(|x| x.value).collect();
        let passes: Vec<Vec<Slope>> =
            (0..=4 * self.system.joints()).map(|d| f(&self.around.towards(Some(d)))).collect();
        let slopes: Vec<Vec<_>> =
            passes.iter().map(|pass| pass.iter().map(|x| x.gradient[0]).collect()).collect();
        let range = |(i, &nominal): (usize, &Interval)| {
            let gradient: Vec<_> = slopes[1..].iter().map(|slope: &Vec<Interval>| slope[i]).collect();
            let mean = nominal + slopes[0][i] * self.offset + self.tube.reach(&gradient);
            // Both enclose it.
            mean.intersection(passes[0][i].value).unwrap_or(mean)
        };
        let ranges = nominal.iter().enumerate().map(range).collect();
        Spread { nominal, ranges, slopes }
    }
}

impl Spread {
    /// The numbers with their derivatives where `seed` looks.
    fn at(&self, seed: &Seeded) -> Vec<Slope> {
        match seed.direction {
            None => self.nominal.iter().map(|&x| Slope::constant(x)).collect(),
            Some(d) => self.ranges.iter().zip(&self.slopes[d]).map(|(&x, &slope)| dual(x, slope)).collect(),
        }
    }
}

fn dual(value: Interval, slope: Interval) -> Slope {
    Dual { value, gradient: [slope] }
}

fn sums(a: &[Slope], b: &[Slope]) -> Vec<Slope> {
    a.iter().zip(b).map(|(&a, &b)| a + b).collect()
}

fn differences(a: &[Slope], b: &[Slope]) -> Vec<Slope> {
    a.iter().zip(b).map(|(&a, &b)| a - b).collect()
}
