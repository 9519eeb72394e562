//! The cost of dynamics and law is proportional to the number of joints: operations, counted exactly, on chains of
//! 16 to 128 links (shorter ones take less: their mass matrix is factorised as a matrix). Time says so too (`cargo bench -p flexure-core --bench scaling`), but never twice the same.

use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use flexure_core::control::Input;
use flexure_core::linalg::Vector;
use flexure_core::model::{FeedForward, Links, MassFactor, Motion};
use flexure_core::scalar::{Jet, Over, Scalar};

use crate::common::{Numbers, coupled_tanh, flexible, gains, serial};

/// Arithmetic and elementary functions so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Count {
    /// Additions, subtractions, changes of sign.
    sums: u64,
    products: u64,
    quotients: u64,
    /// Square roots, exponentials, sines with cosines, …
    functions: u64,
}

thread_local! {
    static COUNT: Cell<Count> = const { Cell::new(Count { sums: 0, products: 0, quotients: 0, functions: 0 }) };
}

fn counted(add: impl Fn(&mut Count)) {
    let mut count = COUNT.get();
    add(&mut count);
    COUNT.set(count);
}

/// What `f` takes.
fn count<R>(f: impl FnOnce() -> R) -> Count {
    COUNT.set(Count::default());
    f();
    COUNT.get()
}

/// A number that counts what is done with it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Counted(f64);

macro_rules! operator {
    ($trait:ident $method:ident, $assign:ident $assign_method:ident, $field:ident) => {
        impl $trait for Counted {
            type Output = Self;
            fn $method(self, rhs: Self) -> Self {
                counted(|count| count.$field += 1);
                Self(self.0.$method(rhs.0))
            }
        }
        impl $assign for Counted {
            fn $assign_method(&mut self, rhs: Self) {
                *self = $trait::$method(*self, rhs);
            }
        }
    };
}
operator!(Add add, AddAssign add_assign, sums);
operator!(Sub sub, SubAssign sub_assign, sums);
operator!(Mul mul, MulAssign mul_assign, products);

impl Div for Counted {
    type Output = Self;
    fn div(self, rhs: Self) -> Self {
        counted(|count| count.quotients += 1);
        Self(self.0 / rhs.0)
    }
}

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        counted(|count| count.sums += 1);
        Self(-self.0)
    }
}

fn function<R>(x: Counted, f: impl Fn(f64) -> R) -> R {
    counted(|count| count.functions += 1);
    f(x.0)
}

impl Scalar for Counted {
    const ZERO: Self = Self(0.0);
    const ONE: Self = Self(1.0);
    fn from_f64(x: f64) -> Self {
        Self(x)
    }
    /// A constant, not a quotient.
    fn from_ratio(numerator: i32, denominator: i32) -> Self {
        Self(f64::from(numerator) / f64::from(denominator))
    }
    fn sqrt(self) -> Self {
        Self(function(self, Scalar::sqrt))
    }
    fn exp(self) -> Self {
        Self(function(self, Scalar::exp))
    }
    fn ln(self) -> Self {
        Self(function(self, Scalar::ln))
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = function(self, Scalar::sin_cos);
        (Self(sin), Self(cos))
    }
    fn tanh(self) -> Self {
        Self(function(self, Scalar::tanh))
    }
    fn ln_cosh(self) -> Self {
        Self(function(self, Scalar::ln_cosh))
    }
    fn atan(self) -> Self {
        Self(function(self, Scalar::atan))
    }
}

impl Over<f64> for Counted {
    fn constant(c: f64) -> Self {
        Self(c)
    }
    fn scale(self, c: f64) -> Self {
        self * Self(c)
    }
}

fn series<const K: usize, const N: usize>(r: &mut Numbers) -> Vector<Jet<Counted, K>, N> {
    Vector::from_fn(|_| Jet::from_fn(|_| Counted(r.next())))
}

/// What must be O(n), on a chain of `N` links.
fn linear<const N: usize>() -> Vec<(&'static str, Count)> {
    let mut r = Numbers(1);
    let robot = flexible(serial::<N>(), &mut r);
    let law = gains(coupled_tanh, true, &mut r);
    let links = &robot.links;
    let x: Motion<Counted, N> = r.motion(1.0).map(Counted);
    let (x_v, a) = (r.motion(1.0).map(Counted), r.vector(1.0).map(Counted));
    let (q, v, v_r) = (x.q_l, x.v_l, x.v_m);
    let (q_2, q_4, q_ld) = (series::<5, N>(&mut r), series::<7, N>(&mut r), series::<5, N>(&mut r));
    vec![
        ("inverse dynamics", count(|| links.inverse_dynamics(&q, &v, &v, &a))),
        ("modified Newton–Euler", count(|| links.inertial_torque(&q, &v, &v_r, &a))),
        ("gravity torque", count(|| links.gravity_torque(&q))),
        ("potential energy", count(|| links.potential_energy(&q))),
        ("mass matrix times vector", count(|| links.mass_mul(&q, &a))),
        ("factor and solve", count(|| links.factor(&q).solve(&a))),
        ("forward dynamics", count(|| links.forward_dynamics(&q, &v, &a))),
        ("torque with two derivatives", count(|| links.torque_along::<_, 3, 5>(&q_2))),
        (
            "flexible inverse dynamics",
            count(|| -> FeedForward<Counted, N, 3, 5> { robot.inverse_dynamics(&q_4) }),
        ),
        ("total energy", count(|| robot.total_energy(&x))),
        ("motion from momenta", count(|| robot.motion(&robot.state(&x)))),
        ("law", count(|| law.command(&robot, &x, &q_ld, &Input::ZERO))),
        ("law of the virtual system", count(|| law.virtual_command(&robot, &x_v, &x, &q_ld, &Input::ZERO))),
    ]
}

/// Whether the counts at 16, 32, 64 and 128 joints lie on a straight line.
fn is_affine(counts: [Count; 4]) -> bool {
    let kinds: [fn(&Count) -> u64; 4] = [|c| c.sums, |c| c.products, |c| c.quotients, |c| c.functions];
    kinds.iter().all(|kind| {
        let [at_16, at_32, at_64, at_128] = counts.each_ref().map(kind);
        at_64 == at_32 + 2 * (at_32 - at_16) && at_128 == at_64 + 4 * (at_32 - at_16)
    })
}

#[test]
fn dynamics_and_law_are_linear_in_the_number_of_joints() {
    let all = [linear::<16>(), linear::<32>(), linear::<64>(), linear::<128>()];
    for (i, (name, _)) in all[0].iter().enumerate() {
        let counts = all.each_ref().map(|of_a_chain| of_a_chain[i].1);
        println!("{name}: {:?} at 16 joints, {:?} at 128", counts[0], counts[3]);
        assert!(counts[0].sums > 0, "{name} counts nothing");
        assert!(is_affine(counts), "{name}: {counts:#?}");
    }
}

/// The dense mass matrix has n² entries: the test above can fail.
#[test]
fn the_dense_mass_matrix_is_not_linear() {
    fn dense<const N: usize>() -> Count {
        let q = Numbers(1).vector::<N>(1.0).map(Counted);
        count(|| serial::<N>().mass_matrix(&q) * q)
    }
    assert!(!is_affine([dense::<16>(), dense::<32>(), dense::<64>(), dense::<128>()]));
}
