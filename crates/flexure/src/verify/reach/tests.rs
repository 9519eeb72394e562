//! M̄ against the mass matrix of random trees at random configurations.

use flexure_core::linalg::Vector;
use flexure_core::model::Links as _;
use flexure_core::robots::{self, JointKind, Tree};

use crate::verify::number::Number;
use crate::verify::reach::{mass_bound, own_inertia};
use crate::verify::robot::Body;

const N: usize = 5;

/// Splitmix64: the same trees on every run.
struct Noise(u64);

impl Noise {
    /// Between −1 and 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> [f64; 3] {
        [self.next(), self.next(), self.next()]
    }

    fn unit(&mut self) -> [f64; 3] {
        let v = self.vector();
        // Now and then along a coordinate axis, as in real robots: parallel and crossing axes.
        if self.next() < 0.0 {
            return if v[0] < 0.0 { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] };
        }
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        v.map(|x| x / length)
    }

    /// A product of turns about x and z, in rows.
    fn rotation(&mut self) -> [[f64; 3]; 3] {
        if self.next() < 0.0 {
            return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        }
        let ((s, c), (t, d)) = ((3.0 * self.next()).sin_cos(), (3.0 * self.next()).sin_cos());
        [[c, -s * d, s * t], [s, c * d, -c * t], [0.0, t, d]]
    }
}

fn number(x: f64) -> Number {
    Number::decimal(&format!("{x}")).unwrap()
}

/// The same body as core and as this checker have it.
fn body(noise: &mut Noise, k: usize) -> (robots::Body, Body) {
    // Mostly chains, and now and then a branch.
    let parent = k.checked_sub(if k > 1 && noise.next() > 0.0 { 2 } else { 1 });
    let prismatic = noise.next() > 0.5;
    let (axis, rotation, translation) = (noise.unit(), noise.rotation(), noise.vector());
    let (mass, com) = (noise.next().abs(), noise.vector().map(|x| 0.3 * x));
    // A a positive definite matrix: diagonally dominant.
    let [a, b, c] = noise.vector().map(|x| 0.01 * x);
    let diagonal = noise.vector().map(|x| 0.02 + 0.01 * x.abs());
    let inertia = [[diagonal[0], a, b], [a, diagonal[1], c], [b, c, diagonal[2]]];
    let kind = if prismatic { JointKind::Prismatic } else { JointKind::Revolute };
    let numbers = |v: [f64; 3]| v.map(number);
    let own = Body {
        parent,
        travel: prismatic.then(|| [number(-0.25), number(0.5)]),
        axis: numbers(axis),
        rotation: rotation.map(numbers),
        translation: numbers(translation),
        mass: number(mass),
        com: numbers(com),
        inertia: [diagonal[0], a, b, diagonal[1], c, diagonal[2]].map(number),
    };
    (robots::Body { parent, kind, axis, rotation, translation, mass, com, inertia }, own)
}

#[test]
fn rods_and_points_have_an_inertia() {
    let is_one = |inertia: [f64; 6]| {
        let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let body = Body {
            parent: None,
            travel: None,
            axis: unit[2].map(number),
            rotation: unit.map(|row| row.map(number)),
            translation: [0.0; 3].map(number),
            mass: number(1.0),
            com: [0.5, 0.0, 0.0].map(number),
            inertia: inertia.map(number),
        };
        own_inertia(0, &body).is_ok()
    };
    for inertia in [
        [0.0; 6],
        [0.0, 0.0, 0.0, 0.83, 0.0, 0.83],
        [0.83, 0.0, 0.0, 0.0, 0.0, 0.83],
        [0.02, 0.001, -0.002, 0.03, 0.0005, 0.025],
    ] {
        assert!(is_one(inertia), "{inertia:?}");
    }
    for inertia in [
        [0.0, 0.1, 0.0, 0.8, 0.0, 0.8],
        [0.0, 0.0, 0.0, 0.8, 0.9, 0.8],
        [0.0, 0.0, 0.0, 0.0, 0.1, 0.0],
        [0.0, 0.0, 0.0, -0.8, 0.0, 0.8],
    ] {
        assert!(!is_one(inertia), "{inertia:?}");
    }
}

/// What a slider carries is as far out as the slider goes: here the bound is reached.
#[test]
fn the_travel_of_a_joint_on_the_way_counts() {
    let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let body = |parent, axis: [f64; 3], slides: bool, mass| Body {
        parent,
        travel: slides.then(|| [number(-0.25), number(0.5)]),
        axis: axis.map(number),
        rotation: unit.map(|row| row.map(number)),
        translation: [0.0; 3].map(number),
        mass: number(mass),
        com: [0.125, 0.0, 0.0].map(number),
        inertia: [0.0; 6].map(number),
    };
    let (x, z) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    let bound =
        mass_bound(&[body(None, z, false, 0.0), body(Some(0), x, true, 0.0), body(Some(1), z, false, 2.0)]);
    let reached = 2.0 * 0.625 * 0.625;
    let bound = bound.unwrap()[0][0].hi();
    assert!(reached <= bound && bound < reached + 1e-12, "{bound}, reached {reached}");
}

#[test]
fn the_bound_holds_at_random_configurations_and_is_of_the_right_size() {
    let mut noise = Noise(3);
    // Largest ratio of |M| to M̄, over all trees, for the entries on the diagonal and off it.
    let (mut tightest, mut loosest) = (0.0_f64, f64::INFINITY);
    for _ in 0..60 {
        let (theirs, own): (Vec<_>, Vec<_>) = (0..N).map(|k| body(&mut noise, k)).unzip();
        let theirs: [_; N] = theirs.try_into().unwrap();
        let tree = Tree::<f64, N>::new(&theirs, [0.0; 3]).unwrap();
        let bound = mass_bound(&own).unwrap();
        let mut reached = [[0.0_f64; N]; N];
        for _ in 0..400 {
            let q = Vector::<f64, N>::from_fn(|j| match own[j].travel {
                None => 4.0 * noise.next(),
                // The ends are reached.
                Some(_) => (0.125 + 0.5 * noise.next()).clamp(-0.25, 0.5),
            });
            let mass = tree.mass_matrix(&q);
            for (i, row) in reached.iter_mut().enumerate() {
                for (j, largest) in row.iter_mut().enumerate() {
                    let (found, bound) = (mass.0[i][j].abs(), bound[i][j].hi());
                    assert!(found <= bound + 1e-12, "M[{i}][{j}] = {found}, bound {bound}");
                    *largest = largest.max(found);
                }
            }
        }
        for i in 0..N {
            let ratio = reached[i][i] / bound[i][i].hi();
            tightest = tightest.max(ratio);
            loosest = loosest.min(ratio);
        }
    }
    println!("|M_ii| reaches {loosest:.3} to {tightest:.6} of the bound");
    assert!(tightest > 0.999 && loosest > 0.1, "{loosest} to {tightest}");
}
