//! The coefficients of four-point Gauss–Legendre collocation.

use flexure_core::linalg::{Matrix, Vector};

/// Number of collocation points; the order is twice that.
pub(crate) const STAGES: usize = 4;

/// One number per stage.
pub(crate) type Stages = Vector<f64, STAGES>;

/// The collocation scheme on [0, 1].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scheme {
    /// Nodes c.
    pub nodes: Stages,
    /// Weights b.
    pub weights: Stages,
    /// A: integrates stage values once.
    pub once: Matrix<f64, STAGES, STAGES>,
    /// A²: integrates them twice.
    pub twice: Matrix<f64, STAGES, STAGES>,
    /// bᵀA, which integrates twice up to the end of the step.
    pub end_twice: Stages,
    /// Value at 0 of the polynomial through the stage values.
    pub start: Stages,
}

impl Scheme {
    /// Four-point Gauss–Legendre.
    pub(crate) fn gauss() -> Self {
        let inner = (3.0 / 7.0 - 2.0 / 7.0 * (6.0_f64 / 5.0).sqrt()).sqrt();
        let outer = (3.0 / 7.0 + 2.0 / 7.0 * (6.0_f64 / 5.0).sqrt()).sqrt();
        let nodes = Vector([-outer, -inner, inner, outer]).map(|x| 0.5 * (1.0 + x));
        let heavy = (18.0 + 30.0_f64.sqrt()) / 72.0;
        let light = (18.0 - 30.0_f64.sqrt()) / 72.0;
        let weights = Vector([light, heavy, heavy, light]);
        let polynomials: [[f64; STAGES]; STAGES] = std::array::from_fn(|j| lagrange(&nodes, j));
        let once = Matrix::from_fn(|i, j| integral(&polynomials[j], nodes[i]));
        let twice = once * once;
        Self {
            nodes,
            weights,
            once,
            twice,
            end_twice: once.transpose() * weights,
            start: Vector::from_fn(|j| polynomials[j][0]),
        }
    }
}

/// Coefficients, constant term first, of the Lagrange polynomial that is 1 at node `j`.
fn lagrange(nodes: &Stages, j: usize) -> [f64; STAGES] {
    let mut coefficients = [0.0; STAGES];
    coefficients[0] = 1.0;
    for (k, node) in nodes.iter().enumerate().filter(|&(k, _)| k != j) {
        let scale = 1.0 / (nodes[j] - nodes[k]);
        for power in (0..STAGES).rev() {
            let lower = if power == 0 { 0.0 } else { coefficients[power - 1] };
            coefficients[power] = (lower - node * coefficients[power]) * scale;
        }
    }
    coefficients
}

/// ∫₀ˣ of a polynomial.
fn integral(coefficients: &[f64; STAGES], x: f64) -> f64 {
    coefficients.iter().enumerate().rev().fold(0.0, |sum, (k, c)| (sum + c / (k + 1) as f64) * x)
}
