//! A log laid over the model: innovations, and what they say of the unknowns.

use std::ops::Range;

use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};

use super::parameters::{Parameter, Values};
use super::step::{Moving, Pace, Step, Workspace};
use super::tangents::{Tangents, add};
use super::torque::{Held, held};
use crate::linalg::Dense;
use crate::logs::Log;

/// A piece of a log that is predicted by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Piece {
    /// Its own number.
    pub number: usize,
    /// Number of the log.
    pub log: usize,
    /// First sample; it and those up to `counted` only let the predictor forget where it began.
    pub first: usize,
    pub counted: usize,
    /// One beyond the last sample.
    pub end: usize,
    /// Whether it is kept from the fit.
    pub held_out: bool,
}

/// How innovations are formed and weighed.
#[derive(Clone, Debug)]
pub(crate) struct Weighing {
    /// Per piece, by its number, what corrects the states: a row a state, a column a link position or a motor position.
    pub gains: Vec<Dense<f64>>,
    /// Per joint the inverse covariance of the innovations of link and motor: (1,1), (1,2), (2,2) [1/rad²].
    pub weights: Vec<[f64; 3]>,
    pub pace: Pace,
}

/// Sums over the innovations of a piece.
#[derive(Clone, Debug)]
pub(crate) struct Sums {
    pub samples: usize,
    /// Per joint of e_l², e_l e_m, e_m² [rad²].
    pub squares: Vec<[f64; 3]>,
    /// Information and scores by the unknowns of the joints and the log's offset; none if not asked for.
    pub information: Option<Information>,
}

/// Second and first derivatives of half the weighed sum of squares.
#[derive(Clone, Debug)]
pub(crate) struct Information {
    /// Lower triangle, row by row, of a full square.
    pub matrix: Vec<f64>,
    /// −gradient, batch after batch of [`BATCH`] s.
    pub scores: Vec<Vec<f64>>,
}

/// Length of a batch of scores \[s\]: innovations that far apart have forgotten each other.
const BATCH: f64 = 0.2;

#[cfg(test)]
impl Sums {
    /// Half the weighed sum of squares.
    pub fn cost(&self, weights: &[[f64; 3]]) -> f64 {
        let of = |(s, w): (&[f64; 3], &[f64; 3])| 0.5 * (w[0] * s[0] + 2.0 * w[1] * s[1] + w[2] * s[2]);
        self.squares.iter().zip(weights).map(of).sum()
    }
}

/// Lays `piece` of `log` over `links` with `values`; with `informed` it says what the innovations say of the unknowns.
pub(crate) fn predict<L: Links<f64, N>, const N: usize>(
    links: &L,
    log: &Log,
    piece: &Piece,
    values: &Values,
    weighing: &Weighing,
    informed: bool,
) -> Sums {
    let n = log.joints;
    let step = Step::new(links, values, log.period, weighing.pace);
    let width = n * Parameter::COUNT + 1;
    let mut tangents = informed.then(|| (Tangents::zeros(4 * n, width), Workspace::new(n, width)));
    let mut gathered = Gathered::new(n, width, informed);
    let mut moving = start(links, log, piece.first, values);
    let offset = values.offsets[piece.log];
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few hundred")]
    let batch = (BATCH / log.period).ceil() as usize;
    let mut torques = vec![Held { mean: 0.0, mean_slope: 0.0, moment: 0.0, moment_slope: 0.0 }; n];
    let mut errors = vec![0.0; 2 * n];
    let gain = &weighing.gains[piece.number];
    let measured = if log.q_l.is_some() { 0..2 * n } else { n..2 * n };
    for k in piece.first..piece.end {
        // From the sample before to this one.
        if k > piece.first {
            for (i, torque) in torques.iter_mut().enumerate() {
                *torque = held(&log.u_m, n, i, k - 1, offset, log.period);
            }
            moving = step.after(&moving, &torques, tangents.as_mut().map(|(t, w)| (t, w)));
        }
        let counts = k >= piece.counted;
        if counts && (k - piece.counted).is_multiple_of(batch) {
            gathered.begin_batch();
        }
        for i in 0..n {
            let of =
                |measured: &Option<Vec<f64>>, q: f64| measured.as_ref().map_or(0.0, |y| y[k * n + i] - q);
            errors[i] = of(&log.q_l, moving.x.q_l[i]);
            errors[n + i] = of(&log.q_m, moving.x.q_m[i]);
            if counts {
                let (e, weights) = ([errors[i], errors[n + i]], &weighing.weights[i]);
                gathered.add(i, e, weights, tangents.as_ref().map(|(t, _)| t));
            }
        }
        correct(&mut moving.x, gain, &errors);
        if counts {
            gathered.sums.samples += 1;
        }
        if let Some((tangents, workspace)) = &mut tangents {
            forget(tangents, workspace, gain, measured.clone());
        }
    }
    gathered.sums
}

fn correct<const N: usize>(x: &mut Motion<f64, N>, gain: &Dense<f64>, errors: &[f64]) {
    let n = errors.len() / 2;
    let by = |row: usize| gain.row(row).iter().zip(errors).map(|(gain, e)| gain * e).sum::<f64>();
    for i in 0..n {
        x.q_l[i] += by(i);
        x.q_m[i] += by(n + i);
        x.v_l[i] += by(2 * n + i);
        x.v_m[i] += by(3 * n + i);
    }
}

/// What corrections by the `measured` positions do to the tangents.
fn forget(tangents: &mut Tangents, workspace: &mut Workspace, gain: &Dense<f64>, measured: Range<usize>) {
    for column in measured.clone() {
        workspace.seen.row_mut(column).copy_from_slice(tangents.row(column));
    }
    for (state, row) in gain.rows().enumerate() {
        let to = tangents.row_mut(state);
        for column in measured.clone() {
            add(to, -row[column], workspace.seen.row(column));
        }
    }
}

/// Samples to either side from which the first velocity is told.
const AROUND: usize = 8;

/// The motion at sample `k`, as well as it can be told from its neighbours.
fn start<L: Links<f64, N>, const N: usize>(links: &L, log: &Log, k: usize, values: &Values) -> Moving<N> {
    let n = log.joints;
    let (low, high) = (k.saturating_sub(AROUND), (k + AROUND).min(log.samples() - 1));
    let over = (high - low).max(1) as f64 * log.period;
    let read = |y: &Vec<f64>| -> (Vector<f64, N>, Vector<f64, N>) {
        let at = |k: usize| Vector::from_fn(|i| if i < n { y[k * n + i] } else { 0.0 });
        (at(k), (at(high) - at(low)).scaled(1.0 / over))
    };
    let motors = log.q_m.as_ref().map(read);
    let (q_l, v_l) = match (log.q_l.as_ref().map(read), motors) {
        (Some(links), _) => links,
        (None, Some((q_m, v_m))) => {
            let weight = links.inverse_dynamics(&q_m, &v_m, &v_m, &Vector::ZERO);
            let stiffness = values.of(Parameter::Stiffness);
            (Vector::from_fn(|i| if i < n { q_m[i] - weight[i] / stiffness[i] } else { 0.0 }), v_m)
        }
        (None, None) => (Vector::ZERO, Vector::ZERO),
    };
    let (q_m, v_m) = motors.unwrap_or((q_l, v_l));
    Moving { x: Motion { q_l, q_m, v_l, v_m }, acceleration: Vector::ZERO }
}

/// Sums while they are gathered.
struct Gathered {
    joints: usize,
    width: usize,
    sums: Sums,
}

impl Gathered {
    fn new(joints: usize, width: usize, informed: bool) -> Self {
        let information =
            informed.then(|| Information { matrix: vec![0.0; width * width], scores: Vec::new() });
        Self { joints, width, sums: Sums { samples: 0, squares: vec![[0.0; 3]; joints], information } }
    }

    fn begin_batch(&mut self) {
        if let Some(information) = &mut self.sums.information {
            information.scores.push(vec![0.0; self.width]);
        }
    }

    fn add(&mut self, i: usize, e: [f64; 2], w: &[f64; 3], tangents: Option<&Tangents>) {
        let squares = &mut self.sums.squares[i];
        squares[0] += e[0] * e[0];
        squares[1] += e[0] * e[1];
        squares[2] += e[1] * e[1];
        let (Some(information), Some(tangents)) = (&mut self.sums.information, tangents) else { return };
        let (link, motor) = (tangents.row(i), tangents.row(self.joints + i));
        // The weight's square root: w = Lᵀ L with L = [[r, s], [0, t]].
        let r = w[0].sqrt();
        let s = if r > 0.0 { w[1] / r } else { 0.0 };
        let t = (w[2] - s * s).max(0.0).sqrt();
        let errors = [r * e[0] + s * e[1], t * e[1]];
        let Some(score) = information.scores.last_mut() else { return };
        let mut row = [0.0; MOST];
        for (error, [a, b]) in errors.into_iter().zip([[r, s], [0.0, t]]) {
            if a == 0.0 && b == 0.0 {
                continue;
            }
            let row = &mut row[..self.width];
            for ((row, l), m) in row.iter_mut().zip(link).zip(motor) {
                *row = a * l + b * m;
            }
            add(score, error, row);
            for (p, to) in information.matrix.chunks_exact_mut(self.width).enumerate() {
                add(&mut to[..=p], row[p], &row[..=p]);
            }
        }
    }
}

/// Most unknowns of a log: those of sixteen joints and an offset.
const MOST: usize = crate::robot::MAX_JOINTS * Parameter::COUNT + 1;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::gain::{Noise, Posture};
    use crate::identify::layer::{Layer, layer};
    use crate::robot::Robot;

    /// An arm that moves on and swings on its springs; no joint turns back.
    fn log(robot: &Robot) -> Log {
        let n = robot.joint_count();
        let (mut q_l, mut q_m, mut u_m) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..300 {
            let t = 1e-3 * f64::from(k);
            for i in 0..n {
                let swing = 1e-4 * (60.0 * t + i as f64).sin();
                let q = -1.0 + 0.2 * i as f64 + 0.5 * t;
                q_l.push(q + swing);
                q_m.push(q - 2.0 * swing + 1e-3);
                u_m.push(3.0 * (25.0 * t + i as f64).cos());
            }
        }
        let (q_l, q_m) = (Some(q_l), Some(q_m));
        Log { name: "swing".to_owned(), period: 1e-3, joints: n, q_l, q_m, dq_l: None, dq_m: None, u_m }
    }

    fn weighing(layer: &dyn Layer, log: &Log, values: &Values) -> Weighing {
        let n = log.joints;
        let posture = Posture {
            mass: layer.mass(&log.q_l.as_ref().unwrap()[..n]),
            motor_inertia: values.of(Parameter::MotorInertia),
            stiffness: values.of(Parameter::Stiffness),
            link_damping: values.of(Parameter::LinkDamping),
            motor_damping: values.of(Parameter::MotorDamping),
        };
        let noise = vec![Noise { torque: 0.05, position: [1e-5, 5e-6] }; n];
        Weighing {
            gains: vec![posture.gain(&noise, log.period).unwrap()],
            weights: vec![[1e8, -2e7, 3e8]; n],
            pace: Pace::of(1.3 * posture.rate().unwrap(), log.period),
        }
    }

    /// Scores are what differences of the cost say, for every unknown; the derivatives leave out how rigid-body torques change
    /// within a period, a part in a thousand.
    #[test]
    fn scores_are_slopes_of_the_cost() {
        let robot = Robot::load("panda").unwrap();
        let (layer, log) = (layer(&robot).unwrap(), log(&robot));
        let joint = |i: usize| [robot.stiffness[i], robot.motor_inertia[i], 0.4, 0.8, 0.3, 0.9];
        let values = Values { joints: (0..7).map(joint).collect(), offsets: vec![0.37e-3] };
        let weighing = weighing(&*layer, &log, &values);
        let piece = Piece { number: 0, log: 0, first: 0, counted: 50, end: 300, held_out: false };
        let sums = layer.lay(&log, &piece, &values, &weighing, true);
        let scores = &sums.information.as_ref().unwrap().scores;
        for i in 0..values.unknowns() {
            let score: f64 = scores.iter().map(|batch| batch[i]).sum();
            let small = if i == 42 { 1e-7 } else { 1e-4 };
            let at = |step: f64| {
                let mut all = vec![0.0; 43];
                all[i] = step;
                layer.lay(&log, &piece, &values.moved(&all), &weighing, false).cost(&weighing.weights)
            };
            let slope = (at(small) - at(-small)) / (2.0 * small);
            let information = sums.information.as_ref().unwrap().matrix[i * 43 + i];
            // What a score could be at most, by Cauchy and Schwarz: signs cancel in the sum.
            let scale = (information * 2.0 * sums.cost(&weighing.weights)).sqrt();
            assert!(
                (slope + score).abs() < 0.003 * scale,
                "unknown {i}: slope {slope}, score {score}, of {scale}"
            );
        }
    }
}
