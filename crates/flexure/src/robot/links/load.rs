//! Links with other masses than their file says.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::Scalar;

use crate::robot::links::rigid::{Rigid, Weight};
use crate::robot::links::{Bodies, LineBody, Links};

impl<C: Scalar> Links<C> {
    /// Multiplies mass and rotational inertia of what joint i carries by `factors[i]`.
    pub(crate) fn multiply_masses(&mut self, factors: &[f64]) {
        let scale = |x: &mut C, factor: &f64| *x *= C::from_f64(*factor);
        match self.bodies() {
            Bodies::Line(bodies) => {
                for (body, factor) in bodies.into_iter().zip(factors) {
                    scale(body.mass, factor);
                    scale(body.inertia, factor);
                }
            }
            Bodies::Tree(bodies) => {
                for (body, factor) in bodies.iter_mut().zip(factors) {
                    scale(&mut body.mass, factor);
                    body.inertia.as_flattened_mut().iter_mut().for_each(|x| scale(x, factor));
                }
            }
        }
    }

    /// Puts a point of `extra` kg at `position` \[m\] in the frame of the last joint; in closed forms at x along the link.
    pub(crate) fn load(&mut self, extra: f64, position: [f64; 3]) {
        if extra == 0.0 {
            return;
        }
        let point = Rigid {
            weight: Some(Weight { mass: C::from_f64(extra), com: Vector(position.map(C::from_f64)) }),
            inertia: Matrix::ZERO,
        };
        match self.bodies() {
            Bodies::Line(mut bodies) => {
                let Some(LineBody { mass, com, inertia }) = bodies.pop() else { return };
                let at = C::from_f64(position[0]);
                let total = *mass + C::from_f64(extra);
                let reduced = *mass * C::from_f64(extra) / total;
                *inertia += reduced * (at - *com).square();
                *com = (*mass * *com + C::from_f64(extra) * at) / total;
                *mass = total;
            }
            Bodies::Tree(bodies) => {
                let Some(body) = bodies.last_mut() else { return };
                let own = Rigid {
                    weight: Some(Weight { mass: body.mass, com: Vector(body.com) }),
                    inertia: Matrix(body.inertia),
                };
                let joined = own.joined(&point);
                body.mass = joined.mass();
                body.com = joined.weight.map_or(body.com, |weight| weight.com.0);
                body.inertia = joined.inertia.0;
            }
        }
    }

    /// Whether [`load`](Self::load) can put something at `position` \[m\].
    pub(crate) fn takes_load_at(&self, [_, y, z]: &[f64; 3]) -> bool {
        !self.tree().is_empty() || (*y == 0.0 && *z == 0.0)
    }
}
