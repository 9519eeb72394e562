//! A tree with room for more joints than it has is the tree of exact size, to the last bit, next to phantom joints.
//!
//! A program of its own: every recursion and law on every number in many sizes is, with the other tests, more than LLVM 22 compiles.

#![cfg(feature = "interval")]

use std::fmt::Debug;

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links, MassFactor, Motion};
use flexure_core::robots::{Body, JointKind, Tree};
use flexure_core::scalar::{Dual, Interval, Jet, Scalar};

/// `check::<constants, numbers, joints, capacity>(constant, float, number)` on five kinds of numbers.
macro_rules! on_numbers {
    ($check:ident::<$joints:literal, $capacity:literal>) => {{
        $check::<f64, f64, $joints, $capacity>($crate::FLOAT, $crate::number_f64);
        $check::<f32, f32, $joints, $capacity>($crate::NARROW, $crate::number_f32);
        $check::<f64, $crate::Jet<f64, 3>, $joints, $capacity>($crate::FLOAT, $crate::number_jet);
        $check::<f64, $crate::Dual<f64, 2>, $joints, $capacity>($crate::FLOAT, $crate::number_dual);
        $check::<$crate::Interval, $crate::Interval, $joints, $capacity>(
            $crate::ENCLOSED,
            $crate::number_interval,
        );
    }};
}

#[path = "../suite/common/mod.rs"]
#[allow(dead_code, unused_macros, unused_imports, reason = "shared with the suite, which uses all of it")]
mod common;
mod dynamics;
mod laws;
mod loops;

use crate::common::{GRAVITY, IDENTITY, Numbers, branched_bodies};

/// The constant of a float, and a float near a constant.
type Constants<C> = (fn(f64) -> C, fn(C) -> f64);
/// A number near a float.
type Random<T> = fn(&mut Numbers, f64) -> T;

const FLOAT: Constants<f64> = (|x| x, |x| x);
const NARROW: Constants<f32> = (f32::from_f64, f64::from);
const ENCLOSED: Constants<Interval> =
    (|x| Interval::new(x, x.next_up()).expect("ordered"), Interval::midpoint);

fn number_f64(_: &mut Numbers, x: f64) -> f64 {
    x
}
fn number_f32(_: &mut Numbers, x: f64) -> f32 {
    f32::from_f64(x)
}
fn number_jet(r: &mut Numbers, x: f64) -> Jet<f64, 3> {
    Jet::new([x, r.next(), r.next()])
}
fn number_dual(r: &mut Numbers, x: f64) -> Dual<f64, 2> {
    Dual { value: x, gradient: [r.next(), r.next()] }
}
fn number_interval(_: &mut Numbers, x: f64) -> Interval {
    Interval::new(x, x + 1e-9).expect("ordered")
}

/// The first `N` joints' numbers, `fill` for joints beyond.
fn fit<T: Copy, const K: usize, const N: usize>(v: &Vector<T, K>, fill: T) -> Vector<T, N> {
    Vector::from_fn(|i| v.0.get(i).copied().unwrap_or(fill))
}

fn fit_motion<T: Scalar, const K: usize, const N: usize>(x: &Motion<T, K>) -> Motion<T, N> {
    Motion {
        q_l: fit(&x.q_l, T::ZERO),
        q_m: fit(&x.q_m, T::ZERO),
        v_l: fit(&x.v_l, T::ZERO),
        v_m: fit(&x.v_m, T::ZERO),
    }
}

fn random<T: Copy, const N: usize>(r: &mut Numbers, number: Random<T>, scale: f64) -> Vector<T, N> {
    Vector::from_fn(|_| {
        let x = scale * r.next();
        number(r, x)
    })
}

/// The same to the last bit: floats print to be read back, with the sign of zero.
#[track_caller]
fn same(a: &impl Debug, b: &impl Debug) {
    assert_eq!(format!("{a:?}"), format!("{b:?}"));
}

/// What a tree with room gives: the exact one's numbers, then `phantom` ones.
#[track_caller]
fn same_joints<T: Scalar, const K: usize, const N: usize>(
    exact: &Vector<T, K>,
    roomy: &Vector<T, N>,
    phantom: &Vector<T, N>,
) {
    same(exact, &fit::<T, N, K>(roomy, T::ZERO));
    same(&&roomy.0[K..], &&phantom.0[K..]);
}

/// A branched tree with revolute and prismatic joints, of `K` joints, where `N` fit.
fn tree<C: Scalar + PartialEq, const K: usize, const N: usize>(
    seed: u64,
    (number, float): Constants<C>,
) -> Tree<C, N> {
    let bodies = branched_bodies::<K>(seed).map(|body| body.map(number));
    Tree::from_bodies(&bodies, GRAVITY.map(number), float).expect("they fit")
}

/// Springs, motors and dampers of `data` around that tree, padded by 1.
fn robot<C: Scalar + PartialEq, const K: usize, const N: usize>(
    seed: u64,
    data: &Fjr<f64, Tree<f64, K>, K>,
    constants: Constants<C>,
) -> Fjr<C, Tree<C, N>, N> {
    let padded = |v: &Vector<f64, K>| fit(v, 1.0).map(constants.0);
    Fjr {
        links: tree::<C, K, N>(seed, constants),
        motor_inertia: padded(&data.motor_inertia),
        stiffness: padded(&data.stiffness),
        link_damping: padded(&data.link_damping),
        motor_damping: padded(&data.motor_damping),
    }
}

#[test]
fn a_tree_knows_its_joints() {
    let bodies = branched_bodies::<5>(1);
    assert_eq!(Tree::new(&bodies, GRAVITY).expect("ordered").joints(), 5);
    let roomy: Tree<f64, 8> = Tree::from_bodies(&bodies, GRAVITY, |x| x).expect("ordered");
    assert_eq!(roomy.joints(), 5);
    assert_eq!(roomy.map(Interval::point).joints(), 5);
    assert!(Tree::<f64, 4>::from_bodies(&bodies, GRAVITY, |x| x).is_none(), "five do not fit into four");
    let unordered = bodies.map(|body| Body { parent: Some(4), ..body });
    assert!(Tree::<f64, 8>::from_bodies(&unordered, GRAVITY, |x| x).is_none());
    let none: Tree<f64, 2> = Tree::from_bodies(&[], GRAVITY, |x| x).expect("a tree without joints");
    same(&none.mass_matrix(&Vector([1.0, 2.0])), &Matrix([[1.0, 0.0], [0.0, 1.0]]));
}

/// A phantom is a massless body of unit inertia on the base: a tree that has it as a real joint says the same.
#[test]
fn a_phantom_is_a_body_of_unit_inertia_on_the_base() {
    let real = branched_bodies::<3>(7);
    let phantom = Body {
        parent: None,
        kind: JointKind::Revolute,
        axis: [0.0, 0.0, 1.0],
        rotation: IDENTITY,
        translation: [0.0; 3],
        mass: 0.0,
        com: [0.0; 3],
        inertia: IDENTITY,
    };
    let [a, b, c] = real;
    let spelt_out = Tree::new(&[a, b, c, phantom, phantom], GRAVITY).expect("ordered");
    let roomy: Tree<f64, 5> = Tree::from_bodies(&real, GRAVITY, |x| x).expect("they fit");
    let mut r = Numbers(3);
    let x = r.motion::<5>(1.0);
    let a = r.vector::<5>(1.0);
    let (q, v, v_r) = (&x.q_l, &x.v_l, &x.v_m);
    assert_eq!(roomy.mass_matrix(q), spelt_out.mass_matrix(q));
    assert_eq!(roomy.inverse_dynamics(q, v, v_r, &a), spelt_out.inverse_dynamics(q, v, v_r, &a));
    assert_eq!(roomy.factor(q).solve(&a), spelt_out.factor(q).solve(&a));
    same(&roomy.potential_energy(q), &spelt_out.potential_energy(q));
    assert_eq!(roomy.carrier_rates(q, v), spelt_out.carrier_rates(q, v));
}
