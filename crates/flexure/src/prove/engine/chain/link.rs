//! The matrices of a link in Featherstone's spatial coordinates: velocities are (ω, v) of the frame's origin.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::{Interval, Scalar};

use super::bodies::{Body, cross};

pub type Square<T> = Matrix<T, 6, 6>;

/// A link over floats, to suggest, or over intervals, to prove.
pub struct Link<T> {
    pub parent: Option<usize>,
    axis: Vector<T, 3>,
    travel: Option<[T; 2]>,
    /// From the parent's velocity to that of the link while its joint is at 0 and rests.
    pub placement: Square<T>,
    /// Twice the kinetic energy of the link alone, of its velocity.
    pub inertia: Square<T>,
}

impl Link<Interval> {
    /// The link of a body.
    pub fn new(body: &Body) -> Self {
        let c = cross(body.com);
        let steiner = (c * c.transpose()).scaled(body.mass);
        let product = c.scaled(body.mass);
        Self {
            parent: body.parent,
            axis: body.axis,
            travel: body.travel,
            placement: motion(&body.rotation.transpose(), body.translation),
            inertia: blocks(
                &(body.inertia + steiner),
                &product,
                &product.transpose(),
                &Matrix::diagonal(&Vector([body.mass; 3])),
            ),
        }
    }

    /// The same with floats in the middle.
    pub fn midpoint(&self) -> Link<f64> {
        Link {
            parent: self.parent,
            axis: self.axis.map(Interval::midpoint),
            travel: self.travel.map(|ends| ends.map(Interval::midpoint)),
            placement: self.placement.map(Interval::midpoint),
            inertia: self.inertia.map(Interval::midpoint),
        }
    }
}

impl<T: Scalar> Link<T> {
    /// How many numbers a form has that the joint's motion does not change: a joint that turns leaves seven free, one that
    /// slides is asked at both ends of its travel instead and leaves all of the lower triangle free.
    pub fn parameters(&self) -> usize {
        if self.travel.is_some() { 21 } else { 7 }
    }

    /// The form of these parameters: with A = e eᵀ and P = 1 − A the blocks y₀ P + y₁ A of ω, y₂ P + y₃ A of v and
    /// y₄ P + y₅ A + y₆ [e]× between them; of a sliding joint the lower triangle row by row.
    pub fn form(&self, y: &[T]) -> Square<T> {
        if self.travel.is_some() {
            return Matrix::from_fn(|i, j| {
                let (i, j) = (i.max(j), i.min(j));
                y[i * (i + 1) / 2 + j]
            });
        }
        let along = Matrix::<T, 3, 3>::from_fn(|i, j| {
            if i == j { self.axis[i].square() } else { self.axis[i] * self.axis[j] }
        });
        let across = Matrix::identity() - along;
        let block = |across_part: T, along_part: T| across.scaled(across_part) + along.scaled(along_part);
        let between = block(y[4], y[5]) + cross(self.axis).scaled(y[6]);
        blocks(&block(y[0], y[1]), &between, &between.transpose(), &block(y[2], y[3]))
    }

    /// The joint's own velocity at unit rate.
    pub fn twist(&self) -> Matrix<T, 6, 1> {
        Matrix::from_fn(|i, _| if (i < 3) == self.travel.is_some() { T::ZERO } else { self.axis[i % 3] })
    }

    /// [X, S] with S the [`twist`](Self::twist): from the velocity where the joint is at 0, and its rate, to the link's. One
    /// for a joint that turns, with X = 1; of one that slides, at both ends of its travel.
    pub fn lifts(&self) -> Vec<Matrix<T, 6, 7>> {
        let twist = self.twist();
        let lift = |x: &Square<T>| Matrix::from_fn(|i, j| if j < 6 { x[(i, j)] } else { twist[(i, 0)] });
        match self.travel {
            None => vec![lift(&Matrix::identity())],
            Some(ends) => ends.map(|q| lift(&motion(&Matrix::identity(), self.axis.scaled(q)))).to_vec(),
        }
    }
}

/// Velocities in a frame that is turned by the transpose of `back` and shifted by `offset`.
fn motion<T: Scalar>(back: &Matrix<T, 3, 3>, offset: Vector<T, 3>) -> Square<T> {
    blocks(back, &Matrix::ZERO, &-(*back * cross(offset)), back)
}

/// [[a, b], [c, d]].
fn blocks<T: Copy>(
    a: &Matrix<T, 3, 3>,
    b: &Matrix<T, 3, 3>,
    c: &Matrix<T, 3, 3>,
    d: &Matrix<T, 3, 3>,
) -> Square<T> {
    Matrix::from_fn(|i, j| [[a, b], [c, d]][i / 3][j / 3].0[i % 3][j % 3])
}
