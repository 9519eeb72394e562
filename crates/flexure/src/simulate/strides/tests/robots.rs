//! Robots for the tests, another in each lane.

use std::cell::{Cell, RefCell};
use std::{array, iter};

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::robots::{Body, JointKind, Pendulum, PlanarTwoLink, Tree};
use flexure_core::scalar::{Lane, Lanes, Scalar};

use crate::plant::Plant;
use crate::robot::links::FromFile;
use crate::robot::sized::fjr;
use crate::robot::{self, load_robot};

/// Robots of one kind of links.
pub(super) trait Kind<const N: usize> {
    type Of<C: Scalar>: Links<C, N>;

    fn plant(lane: usize) -> Plant<Self::Of<f64>, N>;

    fn links<const W: usize>(numbers: [usize; W]) -> Self::Of<Lanes<f64, W>>
    where
        f64: Lane<W>;

    fn start(lane: usize) -> Motion<f64, N>;

    /// How large torques are beside those that hold the links at the start [N m].
    fn torque() -> Vector<f64, N>;

    /// By which part of that they jump now and then.
    const JUMP: f64 = 0.3;
}

/// By how much heavier a robot is than the first.
fn heavier(number: usize) -> f64 {
    1.0 + 0.03 * number as f64
}

pub(super) struct TwoLink;

impl TwoLink {
    fn of<C: Scalar>(number: impl Fn(f64) -> C) -> PlanarTwoLink<C> {
        let fixed = C::from_f64;
        let [m1, m2, i1, i2] = [1.510, 0.873, 0.0392, 0.00808].map(number);
        PlanarTwoLink::new([m1, m2], fixed(0.343), [fixed(0.159), fixed(0.055)], [i1, i2])
    }
}

impl Kind<2> for TwoLink {
    type Of<C: Scalar> = PlanarTwoLink<C>;

    fn plant(number: usize) -> Plant<PlanarTwoLink<f64>, 2> {
        Plant::from(Fjr {
            links: Self::of(|x| x * heavier(number)),
            motor_inertia: Vector([0.23, 0.01]).scaled(heavier(number)),
            stiffness: Vector([9.0, 4.0]),
            link_damping: Vector([0.8, 0.55]),
            motor_damping: Vector([0.2, 90.0]),
        })
    }

    fn links<const W: usize>(numbers: [usize; W]) -> PlanarTwoLink<Lanes<f64, W>>
    where
        f64: Lane<W>,
    {
        Self::of(|x| Lanes::from_array(numbers.map(|number| x * heavier(number))))
    }

    fn start(number: usize) -> Motion<f64, 2> {
        let x = 0.1 * number as f64;
        Motion { v_l: Vector([0.5, -0.5 + x]), v_m: Vector([0.4, -0.5]), ..Motion::at_rest(Vector([x, 0.4])) }
    }

    fn torque() -> Vector<f64, 2> {
        Vector([1.0, 5.0])
    }
}

pub(super) struct OneLink;

impl Kind<1> for OneLink {
    type Of<C: Scalar> = Pendulum<C>;

    fn plant(number: usize) -> Plant<Pendulum<f64>, 1> {
        let robot = Fjr {
            links: Pendulum { inertia: 0.0059 * heavier(number), weight_moment: 0.237 },
            motor_inertia: Vector([0.0021]),
            stiffness: Vector([1.61 * heavier(number)]),
            link_damping: Vector([0.001]),
            motor_damping: Vector([0.001]),
        };
        // Some springs harden.
        let spring_hardening = Vector([if number % 2 == 1 { 4.0 } else { 0.0 }]);
        Plant { spring_hardening, ..Plant::from(robot) }
    }

    fn links<const W: usize>(numbers: [usize; W]) -> Pendulum<Lanes<f64, W>>
    where
        f64: Lane<W>,
    {
        let inertia = Lanes::from_array(numbers.map(|number| 0.0059 * heavier(number)));
        Pendulum { inertia, weight_moment: Lanes::splat(0.237) }
    }

    fn start(number: usize) -> Motion<f64, 1> {
        Motion { v_l: Vector([1.0]), v_m: Vector([0.5]), ..Motion::at_rest(Vector([0.2 * number as f64])) }
    }

    fn torque() -> Vector<f64, 1> {
        Vector([0.2])
    }
}

/// The tree whose number in each lane is that of one of the trees `each`, which have the same structure.
fn trees<const N: usize, const W: usize>(each: &[Tree<f64, N>; W]) -> Tree<Lanes<f64, W>, N>
where
    f64: Lane<W>,
{
    let numbers = each.each_ref().map(|tree| {
        let numbers = RefCell::new(Vec::new());
        let _ = tree.map(|x: f64| {
            numbers.borrow_mut().push(x);
            x
        });
        numbers.into_inner()
    });
    let next = Cell::new(0);
    each[0].map(|_: f64| {
        let i = next.replace(next.get() + 1);
        Lanes::from_array(array::from_fn(|lane| numbers[lane][i]))
    })
}

fn from_file<L: FromFile<f64, N>, const N: usize>(data: &robot::Robot) -> Plant<L, N> {
    Plant::from(fjr(data, &data.links, |x| x, &|x| x).expect("of that kind"))
}

pub(super) struct Panda;

impl Kind<8> for Panda {
    type Of<C: Scalar> = Tree<C, 8>;

    fn plant(number: usize) -> Plant<Tree<f64, 8>, 8> {
        let mut file = load_robot("panda").expect("built in");
        let robot::Links::Tree(bodies) = &mut file.links else { panic!("a tree") };
        for body in bodies {
            body.mass *= heavier(number);
        }
        from_file(&file)
    }

    fn links<const W: usize>(numbers: [usize; W]) -> Tree<Lanes<f64, W>, 8>
    where
        f64: Lane<W>,
    {
        trees(&numbers.map(|number| Self::plant(number).robot.links))
    }

    fn start(number: usize) -> Motion<f64, 8> {
        let x = 0.02 * number as f64;
        let q_l = Vector([x, -0.6, 0.0, -1.8 + x, 0.0, 1.5, 0.5, 0.0]);
        let Plant { robot, .. } = Self::plant(number);
        Motion { q_m: robot.motors_at_rest(&q_l), ..Motion::at_rest(q_l) }
    }

    /// What jumps has fast springs swing for seconds.
    const JUMP: f64 = 0.0;

    fn torque() -> Vector<f64, 8> {
        Vector([3.0, 3.0, 3.0, 3.0, 1.0, 1.0, 1.0, 0.0])
    }
}

/// Five joints that branch, one of them sliding.
pub(super) struct Branches;

impl Branches {
    fn bodies(number: usize) -> [Body; 5] {
        let mut random = Random(7);
        [None, Some(0), Some(1), Some(0), Some(3)].map(|parent| {
            let mut any = |size: f64| array::from_fn::<f64, 3, _>(|_| size * random.next());
            let [axis, translation, com, inertia] = [any(1.0), any(0.3), any(0.1), any(0.01)];
            let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
            Body {
                parent,
                kind: if parent == Some(3) { JointKind::Prismatic } else { JointKind::Revolute },
                axis: axis.map(|x| x / length),
                rotation: [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
                translation,
                mass: heavier(number),
                com,
                inertia: array::from_fn(|i| array::from_fn(|j| if i == j { 0.02 + inertia[i] } else { 0.0 })),
            }
        })
    }
}

impl Kind<8> for Branches {
    type Of<C: Scalar> = Tree<C, 8>;

    fn plant(number: usize) -> Plant<Tree<f64, 8>, 8> {
        let links = Tree::from_bodies(&Self::bodies(number), [0.0, 0.0, -9.81], |x| x).expect("ordered");
        let own = |x: f64, pad: f64| Vector::from_fn(|k| if k < 5 { x } else { pad });
        Plant::from(Fjr {
            links,
            motor_inertia: own(0.1, 1.0),
            stiffness: own(200.0, 1.0),
            link_damping: own(0.1, 0.0),
            motor_damping: own(2.0, 0.0),
        })
    }

    fn links<const W: usize>(numbers: [usize; W]) -> Tree<Lanes<f64, W>, 8>
    where
        f64: Lane<W>,
    {
        trees(&numbers.map(|number| Self::plant(number).robot.links))
    }

    fn start(number: usize) -> Motion<f64, 8> {
        let own = |x: f64| Vector::from_fn(|k| if k < 5 { x } else { 0.0 });
        Motion { v_l: own(0.3), v_m: own(0.2), ..Motion::at_rest(own(0.1 * number as f64)) }
    }

    fn torque() -> Vector<f64, 8> {
        Vector::from_fn(|k| if k < 5 { 2.0 } else { 0.0 })
    }
}

/// Sebastiano Vigna's splitmix64.
pub(super) struct Random(pub u64);

impl Random {
    /// Uniform in [−1, 1).
    pub(super) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Torques at random, held for a period each, those of a robot by its number. They wander; every fiftieth jumps.
pub(super) fn torques<K: Kind<N>, const N: usize, const W: usize>(
    numbers: [usize; W],
    periods: usize,
) -> Vec<[Vector<f64, N>; W]> {
    let hold = numbers.map(|number| K::plant(number).robot.links.gravity_torque(&K::start(number).q_l));
    let mut each = numbers.map(|number| (Random(number as u64), [Vector::ZERO; 2]));
    let mut period = 0;
    let next = || {
        period += 1;
        for (random, [u, rate]) in &mut each {
            for k in 0..N {
                rate[k] = 0.98 * rate[k] + 0.002 * random.next();
                u[k] = 0.99 * u[k] + rate[k];
                if period % 50 == 0 {
                    u[k] += K::JUMP * random.next();
                }
            }
        }
        array::from_fn(|lane| hold[lane] + K::torque().diag_mul(&each[lane].1[0]))
    };
    iter::repeat_with(next).take(periods).collect()
}
