//! All logs laid over the model.

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links};
use rayon::prelude::*;

use super::parameters::{Parameter, Values};
use super::predictor::{Piece, Sums, Weighing, predict};
use crate::files::Problems;
use crate::linalg::Symmetric;
use crate::logs::Log;
use crate::robot::Robot;
use crate::robot::links::FromFile;
use crate::robot::sized::{OF_THE_KIND, fjr, sized};

/// A robot whose links are known, of a size known to the compiler.
pub(crate) trait Layer: Send + Sync {
    /// Sums over the innovations of a piece of `log`; informed about the unknowns if asked to be.
    fn lay(&self, log: &Log, piece: &Piece, values: &Values, weighing: &Weighing, informed: bool) -> Sums;

    /// Mass matrix of the links at the positions `q_l` [kg m²].
    fn mass(&self, q_l: &[f64]) -> Symmetric<f64>;
}

/// The links of `robot`.
///
/// # Errors
/// If it has more joints than this program is built for.
pub(crate) fn layer(robot: &Robot) -> Result<Box<dyn Layer>, Problems> {
    Ok(sized!(robot, L, N => {
        let known: Fjr<f64, L<f64>, N> = fjr(robot, &robot.links, |x| x, &|x| x).expect(OF_THE_KIND);
        hold::<L<f64>, N>(known.links)
    }))
}

fn hold<L, const N: usize>(links: L) -> Box<dyn Layer>
where
    L: FromFile<f64, N> + Send + Sync + 'static,
{
    Box::new(Sized(links))
}

struct Sized<L, const N: usize>(L);

impl<L, const N: usize> Layer for Sized<L, N>
where
    L: Links<f64, N> + Send + Sync,
{
    fn lay(&self, log: &Log, piece: &Piece, values: &Values, weighing: &Weighing, informed: bool) -> Sums {
        predict::<L, N>(&self.0, log, piece, values, weighing, informed)
    }

    fn mass(&self, q_l: &[f64]) -> Symmetric<f64> {
        let q: Vector<f64, N> = Vector::from_fn(|i| q_l.get(i).copied().unwrap_or(0.0));
        let mass = self.0.mass_matrix(&q);
        Symmetric::from_fn(self.0.joints(), |i, j| mass[(i, j)])
    }
}

/// Sums over all pieces.
pub(crate) struct Total {
    pub samples: usize,
    /// Per joint of e_l², e_l e_m, e_m² [rad²].
    pub squares: Vec<[f64; 3]>,
    /// Information by all unknowns, row by row, a full square.
    pub information: Vec<f64>,
    /// −gradients of the cost, batch after batch.
    pub scores: Vec<Vec<f64>>,
}

impl Total {
    /// −gradient of the cost.
    pub fn score(&self) -> Vec<f64> {
        let mut score = vec![0.0; self.scores.first().map_or(0, Vec::len)];
        for batch in &self.scores {
            score.iter_mut().zip(batch).for_each(|(sum, x)| *sum += x);
        }
        score
    }

    /// Covariance of the innovations of joint `i`: of e_l², e_l e_m, e_m² [rad²].
    pub fn covariance(&self, i: usize) -> [f64; 3] {
        self.squares[i].map(|sum| sum / self.samples.max(1) as f64)
    }
}

/// Lays `logs` over the model, piece by piece side by side; sums are in the order of the pieces, whatever the threads do.
pub(crate) fn total<'p>(
    layer: &dyn Layer,
    logs: &[Log],
    pieces: impl IntoIterator<Item = &'p Piece>,
    values: &Values,
    weighing: &Weighing,
    informed: bool,
) -> Total {
    let pieces: Vec<&Piece> = pieces.into_iter().collect();
    let sums: Vec<Sums> = pieces
        .par_iter()
        .map(|piece| layer.lay(&logs[piece.log], piece, values, weighing, informed))
        .collect();
    let (joints, unknowns) = (values.joints.len(), values.unknowns());
    let mut total = Total {
        samples: 0,
        squares: vec![[0.0; 3]; joints],
        information: vec![0.0; if informed { unknowns * unknowns } else { 0 }],
        scores: Vec::new(),
    };
    for (piece, sums) in pieces.iter().zip(sums) {
        total.samples += sums.samples;
        for (all, own) in total.squares.iter_mut().zip(&sums.squares) {
            all.iter_mut().zip(own).for_each(|(all, own)| *all += own);
        }
        let Some(information) = sums.information else { continue };
        // A piece knows the offset of its own log.
        let of_joints = joints * Parameter::COUNT;
        let place = |i: usize| if i < of_joints { i } else { of_joints + piece.log };
        let width = of_joints + 1;
        for i in 0..width {
            for j in 0..=i {
                let (row, column) = (place(i), place(j));
                let x = information.matrix[i * width + j];
                total.information[row * unknowns + column] += x;
                if row != column {
                    total.information[column * unknowns + row] += x;
                }
            }
        }
        total.scores.extend(information.scores.into_iter().map(|batch| {
            let mut all = vec![0.0; unknowns];
            batch.into_iter().enumerate().for_each(|(i, x)| all[place(i)] = x);
            all
        }));
    }
    total
}
