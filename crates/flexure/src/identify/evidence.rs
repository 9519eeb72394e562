//! How well the unknowns are known: error bars, and what is known least.

use super::layer::Total;
use super::parameters::{Parameter, Values};
use super::prior::Prior;
use crate::files::number::short;
use crate::linalg::{Dense, Leading, Symmetric, cholesky, eigenvectors, lower_inverse};

/// What data and prior say together, in logarithms of parameters and s of offsets.
pub(crate) struct Evidence {
    /// Standard deviations of the unknowns.
    pub deviations: Vec<f64>,
    /// Ratio of the best to the worst known direction of the parameters, each measured in its own error bar: 1 if none hides
    /// behind another.
    pub condition: f64,
    /// The worst known direction of the parameters' logarithms, of length 1, and its standard deviation.
    pub weakest: (Vec<f64>, f64),
}

impl Evidence {
    /// From the sums at the estimate; none where the information is not positive definite.
    ///
    /// The covariance is that of estimates under innovations of any kind (Huber's sandwich: White, *Econometrica* 50, 1982), by
    /// batches of scores that are too far apart to know of each other; where innovations are white it is the Cramér–Rao bound,
    /// which is never undercut.
    pub fn new(information: &Symmetric<f64>, total: &Total, prior: &Prior) -> Option<Self> {
        let size = information.size();
        let covariance = inverse(information)?;
        let batches = total.scores.len() as f64;
        let mean: Vec<f64> = total.score().iter().map(|x| x / batches).collect();
        let mut scatter = Dense::zeros(size, size);
        for batch in &total.scores {
            let apart: Vec<f64> = batch.iter().zip(&mean).map(|(x, mean)| x - mean).collect();
            for i in 0..size {
                for j in 0..size {
                    scatter[(i, j)] += apart[i] * apart[j];
                }
            }
        }
        // As many batches as there are make the scatter too small by this, on average.
        let scatter = scatter.scaled(batches / (batches - 1.0).max(1.0));
        let of_the_prior = Dense::from_fn(size, size, |i, j| {
            if i == j { (prior.spread[i] * prior.spread[i]).recip() } else { 0.0 }
        });
        let robust = &(&covariance * &(&scatter + &of_the_prior)) * &covariance;
        let deviations: Vec<f64> =
            (0..size).map(|i| robust[(i, i)].max(covariance[(i, i)]).max(0.0).sqrt()).collect();
        let parameters = size - prior.mean.offsets.len();
        let mut correlation = Dense::from_fn(parameters, parameters, |i, j| {
            covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt()
        });
        let (least, most, _) = extremes(&mut correlation);
        let mut logarithms = Dense::from_fn(parameters, parameters, |i, j| covariance[(i, j)]);
        let (_, variance, direction) = extremes(&mut logarithms);
        Some(Self {
            deviations,
            condition: (most / least.max(f64::MIN_POSITIVE)).sqrt(),
            weakest: (direction, variance.max(0.0).sqrt()),
        })
    }
}

impl Evidence {
    /// No unknown is known better than to the distance of two estimates of it, both of which would be right if the model were
    /// (Hausman, *Econometrica* 46, 1978).
    pub fn doubted(&mut self, apart: &[f64]) {
        self.deviations
            .iter_mut()
            .zip(apart)
            .for_each(|(deviation, apart)| *deviation = deviation.max(*apart));
    }

    /// An unknown is known no better than to `deviation`.
    pub fn no_better(&mut self, unknown: usize, deviation: f64) {
        self.deviations[unknown] = self.deviations[unknown].max(deviation);
    }
}

/// Least and largest eigenvalue, and the vector of the largest.
fn extremes(a: &mut Dense<f64>) -> (f64, f64, Vec<f64>) {
    let size = a.columns();
    let vectors = eigenvectors(Leading::whole(a));
    let order = |i: &usize, j: &usize| a[(*i, *i)].total_cmp(&a[(*j, *j)]);
    let least = (0..size).min_by(order).unwrap_or(0);
    let most = (0..size).max_by(order).unwrap_or(0);
    (a[(least, least)], a[(most, most)], (0..size).map(|i| vectors[(i, most)]).collect())
}

/// The inverse of a positive definite matrix, whose entries may be of very different sizes.
fn inverse(a: &Symmetric<f64>) -> Option<Dense<f64>> {
    let n = a.size();
    let scale: Vec<f64> = (0..n).map(|i| a.at(i, i).sqrt().recip()).collect();
    let lower = lower_inverse(&cholesky(&Symmetric::from_fn(n, |i, j| a.at(i, j) * scale[i] * scale[j]))?);
    Some(Dense::from_fn(n, n, |i, j| {
        let product: f64 = (i.max(j)..n).map(|k| lower[(k, i)] * lower[(k, j)]).sum();
        product * scale[i] * scale[j]
    }))
}

/// A direction in words: what of which joints is not told apart.
pub(crate) fn in_words(direction: &[f64], deviation: f64, values: &Values, joints: &[String]) -> String {
    let strongest = direction.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let part = |i: usize| {
        let parameter = Parameter::ALL[i % Parameter::COUNT];
        format!("{} of {}", parameter.name(), joints[i / Parameter::COUNT])
    };
    let chief: Vec<usize> = (0..direction.len()).filter(|&i| direction[i].abs() > 0.3 * strongest).collect();
    let percent = 100.0 * deviation;
    match chief[..] {
        [one] => format!("{}, to {} % (one standard deviation)", part(one), short(percent, 2)),
        [a, b] if direction[a] * direction[b] < 0.0 => {
            let value = |i: usize| values.joints[i / Parameter::COUNT][i % Parameter::COUNT];
            let same_kind = (value(a) * direction[a] + value(b) * direction[b]).abs()
                < 0.3 * (value(a) * direction[a]).abs();
            let what = if same_kind { "sum" } else { "product" };
            format!("{} and {}: their {what} is known better than each", part(a), part(b))
        }
        [a, b] => format!("{} and {}: their ratio is known better than each", part(a), part(b)),
        _ => {
            let names: Vec<_> = chief.iter().take(4).map(|&i| part(i)).collect();
            let more = if chief.len() > 4 { ", …" } else { "" };
            format!("{}{more}: a combination of them, to {} %", names.join(", "), short(percent, 2))
        }
    }
}
