//! Numbers of several things of one structure side by side, one to a SIMD lane: robots, laws, motions.

use std::cell::{Cell, RefCell};

use flexure_core::linalg::Vector;
use flexure_core::model::Motion;
use flexure_core::scalar::{Jet, Lanes};

/// How many numbers fit a register of the processor that this is compiled for: x86-64 has at least SSE2, aarch64 NEON.
pub(crate) const WIDTH: usize = if cfg!(target_feature = "avx512f") {
    8
} else if cfg!(target_feature = "avx") {
    4
} else {
    2
};

/// As many numbers as fit a register.
pub(crate) type Several = Lanes<f64, WIDTH>;

/// Something for each lane.
pub(crate) type Each<T> = [T; WIDTH];

/// The numbers of something, in the order in which `made` asks for each of them.
pub(crate) fn numbers<R>(made: impl FnOnce(&dyn Fn(f64) -> f64) -> R) -> Vec<f64> {
    let asked = RefCell::new(Vec::new());
    made(&|number| {
        asked.borrow_mut().push(number);
        number
    });
    asked.into_inner()
}

/// What `made` makes of the [`numbers`] of something for each lane, which it asks for in the same order; none if some have more of
/// them than others.
pub(crate) fn together<R>(
    numbers: &Each<Vec<f64>>,
    made: impl FnOnce(&dyn Fn(f64) -> Several) -> R,
) -> Option<R> {
    let alike = numbers.iter().all(|list| list.len() == numbers[0].len());
    let next = Cell::new(0);
    let number = |_| {
        let i = next.replace(next.get() + 1);
        Several::from_array(numbers.each_ref().map(|list| list[i]))
    };
    alike.then(|| made(&number))
}

/// Vectors side by side.
pub(crate) fn vector<const N: usize>(vectors: &Each<&Vector<f64, N>>) -> Vector<Several, N> {
    Vector::from_fn(|i| Several::from_array(vectors.map(|vector| vector[i])))
}

/// Motions side by side.
pub(crate) fn motion<const N: usize>(motions: &Each<&Motion<f64, N>>) -> Motion<Several, N> {
    Motion {
        q_l: vector(&motions.map(|x| &x.q_l)),
        q_m: vector(&motions.map(|x| &x.q_m)),
        v_l: vector(&motions.map(|x| &x.v_l)),
        v_m: vector(&motions.map(|x| &x.v_m)),
    }
}

/// Series side by side.
pub(crate) fn series<const K: usize, const N: usize>(
    series: &Each<&Vector<Jet<f64, K>, N>>,
) -> Vector<Jet<Several, K>, N> {
    let number = |i: usize, k: usize| Several::from_array(series.map(|series| series[i].coefficient(k)));
    Vector::from_fn(|i| Jet::from_fn(|k| number(i, k)))
}

/// The vector of each lane.
pub(crate) fn apart<const N: usize>(vector: &Vector<Several, N>) -> Each<Vector<f64, N>> {
    let rows = vector.0.map(Several::to_array);
    std::array::from_fn(|lane| Vector::from_fn(|i| rows[i][lane]))
}
