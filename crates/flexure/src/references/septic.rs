//! Septic spline interpolation: least ∫ |q⁗|² dt through given positions, at rest at both ends.
//!
//! Unknown are the first three derivatives at the inner knots. The integral is a quadratic form in them, block
//! tridiagonal and positive definite; its gradient vanishes exactly where derivatives 4, 5 and 6 are continuous. One
//! block L D Lᵀ solves it for all joints.

use flexure_core::linalg::{Ldl, Matrix, Vector};
use flexure_core::scalar::{Dual, Over, Scalar};

/// Taylor coefficients q, q̇, q̈ / 2, q⃛ / 6 at a knot, time in s.
type Knot<T> = [T; 4];

/// A polynomial of degree 7 in τ = (t − start) / width, with constants of type `C`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Segment<C, const N: usize> {
    /// Its first instant in s.
    pub(crate) start: C,
    /// 1 / width in 1/s.
    rate: C,
    /// By powers of τ in rad.
    coefficients: [Vector<C, N>; 8],
}

impl<C: Scalar, const N: usize> Segment<C, N> {
    /// Position in rad at time `t` in s, by Horner's rule.
    #[inline]
    pub(crate) fn on<T: Over<C>>(&self, t: T) -> Vector<T, N> {
        let tau = (t - T::constant(self.start)).scale(self.rate);
        let mut q_d = Vector::ZERO;
        for c in self.coefficients.iter().rev() {
            q_d = q_d.scaled(tau) + c.lift();
        }
        q_d
    }

    pub(crate) fn map<D: Copy>(&self, f: impl Fn(C) -> D) -> Segment<D, N> {
        Segment {
            start: f(self.start),
            rate: f(self.rate),
            coefficients: self.coefficients.each_ref().map(|c| c.map(&f)),
        }
    }
}

impl<const N: usize> Segment<f64, N> {
    pub(crate) fn is_finite(&self) -> bool {
        self.rate.is_finite() && self.coefficients.iter().all(|c| c.iter().all(f64::is_finite))
    }
}

/// The segments of the spline through at least two samples (t_i, q_i), t_i increasing.
pub(crate) fn interpolate<const N: usize>(samples: &[(f64, Vector<f64, N>)]) -> Vec<Segment<f64, N>> {
    let slopes = slopes(samples);
    let knot = |i: usize, joint: usize| {
        let [d1, d2, d3] = slopes[i][joint].0;
        [samples[i].1[joint], d1, d2, d3]
    };
    let segment = |i: usize| {
        let (start, width) = (samples[i].0, samples[i + 1].0 - samples[i].0);
        let joints: Vector<_, N> =
            Vector::from_fn(|joint| polynomial(width, &knot(i, joint), &knot(i + 1, joint)));
        let coefficients = core::array::from_fn(|k| joints.map(|c| c[k]));
        Segment { start, rate: width.recip(), coefficients }
    };
    (1..samples.len()).map(|i| segment(i - 1)).collect()
}

/// One block row of the elimination: knot i in terms of knot i + 1.
struct Row<const N: usize> {
    pivot: Ldl<f64, 3>,
    /// Coupling of knot i to knot i + 1.
    next: Matrix<f64, 3, 3>,
    /// Right-hand side of each joint.
    load: [Vector<f64, 3>; N],
}

/// The Taylor coefficients q̇, q̈ / 2, q⃛ / 6 of each joint at every knot.
fn slopes<const N: usize>(samples: &[(f64, Vector<f64, N>)]) -> Vec<[Vector<f64, 3>; N]> {
    let spans: Vec<Span<N>> = samples.windows(2).map(|pair| Span::new(&pair[0], &pair[1])).collect();
    let mut rows: Vec<Row<N>> = Vec::with_capacity(spans.len());
    for pair in spans.windows(2) {
        let (before, after) = (&pair[0], &pair[1]);
        let mut matrix = before.end + after.start;
        let mut load = core::array::from_fn(|joint| -(before.end_pull[joint] + after.start_pull[joint]));
        if let Some(row) = rows.last() {
            let back = row.next.transpose();
            let eliminated = back * columns(|j| row.pivot.solve(&row.next.column(j)));
            matrix = matrix + -eliminated;
            for (load, previous) in load.iter_mut().zip(&row.load) {
                *load -= back * row.pivot.solve(previous);
            }
        }
        rows.push(Row { pivot: matrix.ldl(), next: after.coupling, load });
    }
    let mut slopes = vec![[Vector::ZERO; N]; samples.len()];
    for (i, row) in rows.iter().enumerate().rev() {
        // Row i is that of knot i + 1: the ends are at rest.
        let next = slopes[i + 2];
        slopes[i + 1] =
            core::array::from_fn(|joint| row.pivot.solve(&(row.load[joint] - row.next * next[joint])));
    }
    slopes
}

/// What one segment contributes: the gradient of its integral at zero slopes, and its second derivatives.
struct Span<const N: usize> {
    start: Matrix<f64, 3, 3>,
    coupling: Matrix<f64, 3, 3>,
    end: Matrix<f64, 3, 3>,
    start_pull: [Vector<f64, 3>; N],
    end_pull: [Vector<f64, 3>; N],
}

impl<const N: usize> Span<N> {
    fn new(from: &(f64, Vector<f64, N>), to: &(f64, Vector<f64, N>)) -> Self {
        let width = to.0 - from.0;
        let slope = |i: usize| Dual::<f64, 6>::variable(0.0, i);
        let (start, end) = pull(
            width,
            &[Dual::ZERO, slope(0), slope(1), slope(2)],
            &[Dual::ZERO, slope(3), slope(4), slope(5)],
        );
        let pulls: [_; N] =
            core::array::from_fn(|joint| pull(width, &at_rest(from.1[joint]), &at_rest(to.1[joint])));
        Self {
            start: Matrix::from_fn(|i, j| start[i].gradient[j]),
            coupling: Matrix::from_fn(|i, j| start[i].gradient[j + 3]),
            end: Matrix::from_fn(|i, j| end[i].gradient[j + 3]),
            start_pull: pulls.map(|(start, _)| start),
            end_pull: pulls.map(|(_, end)| end),
        }
    }
}

fn at_rest(q: f64) -> Knot<f64> {
    [q, 0.0, 0.0, 0.0]
}

fn columns(column: impl Fn(usize) -> Vector<f64, 3>) -> Matrix<f64, 3, 3> {
    let columns: [_; 3] = core::array::from_fn(column);
    Matrix::from_fn(|i, j| columns[j][i])
}

/// The coefficients in τ of the polynomial on a segment `width` long with the given knots.
fn polynomial<T: Over<f64>>(width: f64, left: &Knot<T>, right: &Knot<T>) -> [T; 8] {
    let [l0, l1, l2, l3] = in_tau(width, left);
    let [r0, r1, r2, r3] = in_tau(width, right);
    let n = |c: f64, x: T| x.scale(c);
    // What the cubic part leaves to the rest at τ = 1, by Taylor coefficient.
    let e0 = (r0 - l0) - (l1 + l2 + l3);
    let e1 = r1 - (l1 + n(2.0, l2) + n(3.0, l3));
    let e2 = r2 - (l2 + n(3.0, l3));
    let e3 = r3 - l3;
    // Inverse of the matrix of binomials C(4 + k, j).
    let c4 = n(35.0, e0) - n(15.0, e1) + n(5.0, e2) - e3;
    let c5 = n(-84.0, e0) + n(39.0, e1) - n(14.0, e2) + n(3.0, e3);
    let c6 = n(70.0, e0) - n(34.0, e1) + n(13.0, e2) - n(3.0, e3);
    let c7 = n(-20.0, e0) + n(10.0, e1) - n(4.0, e2) + e3;
    [l0, l1, l2, l3, c4, c5, c6, c7]
}

/// Taylor coefficients in τ from those in t.
fn in_tau<T: Over<f64>>(width: f64, knot: &Knot<T>) -> Knot<T> {
    let mut unit = 1.0;
    knot.map(|x| {
        let scaled = x.scale(unit);
        unit *= width;
        scaled
    })
}

/// The gradient of ½ ∫ |q⁗|² dt / 48 over a segment with respect to q̇, q̈ / 2 and q⃛ / 6, at its start and at its end.
///
/// Integration by parts turns it into Taylor coefficients c_k = q⁽ᵏ⁾ / k! at that end: (15 c_6, −5 c_5, 3 c_4) at the
/// end, the negative at the start. The sum over two segments that meet is therefore the jump of derivatives 6, 5, 4.
fn pull<T: Over<f64>>(width: f64, left: &Knot<T>, right: &Knot<T>) -> (Vector<T, 3>, Vector<T, 3>) {
    let [_, _, _, _, c4, c5, c6, c7] = polynomial(width, left, right);
    let n = |c: f64, x: T| x.scale(c);
    let shifted =
        [c4 + n(5.0, c5) + n(15.0, c6) + n(35.0, c7), c5 + n(6.0, c6) + n(21.0, c7), c6 + n(7.0, c7)];
    let rate = width.recip();
    let rate4 = rate.square().square();
    let weighted = |[c4, c5, c6]: [T; 3]| {
        Vector([n(15.0 * rate4 * rate.square(), c6), n(-5.0 * rate4 * rate, c5), n(3.0 * rate4, c4)])
    };
    (-weighted([c4, c5, c6]), weighted(shifted))
}
