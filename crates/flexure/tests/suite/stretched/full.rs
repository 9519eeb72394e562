//! The whole inequality of a stretched metric at one state, in plain floats: all joints and both sides at once, nothing eliminated.

use flexure::linalg::{Dense, Symmetric, exponential, spectral_radius, weakest};
use flexure::prove::engine::Certificate;
use flexure::prove::engine::certificate::{CertifiedPhi, DecimalGains};
use flexure::prove::engine::number::Number;

pub fn floats(numbers: &[Number]) -> Vec<f64> {
    numbers.iter().map(Number::approximate).collect()
}

/// The numbers of a loop.
pub struct Loop {
    pub n: usize,
    stiffness: Vec<f64>,
    inertia: Vec<f64>,
    /// D + K_d, links and motors.
    damping: [Vec<f64>; 2],
    /// Π and Λ, links then motors.
    metric: Vec<f64>,
    shaping: Vec<f64>,
    /// Growth of Π with the squared error, links then motors.
    hardening: Vec<f64>,
    /// Whether φ is tanh.
    flattens: bool,
    /// Largest errors in rad, links then motors.
    largest: Vec<f64>,
}

/// A state of two neighbouring solutions: position errors and velocity errors, links then motors.
pub struct State {
    pub error: Vec<f64>,
    pub speed: Vec<f64>,
}

impl Loop {
    pub fn of(certificate: &Certificate) -> Self {
        let (robot, law) = (&certificate.robot, &certificate.controller);
        let both =
            |of: fn(&DecimalGains) -> &Vec<Number>| [floats(of(&law.link)), floats(of(&law.motor))].concat();
        let plus =
            |a: &[Number], b: &[Number]| floats(a).into_iter().zip(floats(b)).map(|(a, b)| a + b).collect();
        let n = robot.joints;
        Self {
            n,
            stiffness: floats(&robot.stiffness),
            inertia: floats(&robot.motor_inertia),
            damping: [
                plus(&robot.link_damping, &law.link.damping),
                plus(&robot.motor_damping, &law.motor.damping),
            ],
            metric: both(|gains| &gains.metric),
            shaping: both(|gains| &gains.shaping),
            hardening: [law.link.hardening.as_ref().map_or(vec![0.0; n], |h| floats(h)), vec![0.0; n]]
                .concat(),
            flattens: law.phi == CertifiedPhi::Tanh,
            largest: certificate.region.error.iter().flatten().map(Number::approximate).collect(),
        }
    }

    /// The slowest rate of a variation at `state`, of links with this mass matrix, where b of the errors are `exponents`: the least
    /// eigenvalue of −sym(G) relative to W [1/s].
    pub fn rate(&self, exponents: &[Option<f64>], state: &State, mass: &[f64]) -> f64 {
        let n = self.n;
        let mut form = vec![0.0; 16 * n * n];
        let mut weight = vec![0.0; 16 * n * n];
        let mut add = |i: usize, j: usize, value: f64| {
            form[4 * n * i + j] += 0.5 * value;
            form[4 * n * j + i] += 0.5 * value;
        };
        for k in 0..2 * n {
            let (i, x) = (k % n, state.error[k]);
            let (phi, slope) = if self.flattens {
                (self.shaping[k] * x.tanh(), self.shaping[k] / x.cosh().powi(2))
            } else {
                (self.shaping[k] * x, self.shaping[k])
            };
            let coupling = self.stiffness[i] / self.metric[n + i];
            let drift = if k < n { state.speed[k] } else { state.speed[k] - coupling * state.speed[i] };
            let own = self.metric[k] + self.hardening[k] * x * x;
            let (r, growth) = stretch(exponents[k], x, self.largest[k]);
            let metric = own * r * r;
            let relative = growth + self.hardening[k] * x / own;
            add(k, k, metric * (slope - relative * (drift - phi)));
            weight[4 * n * k + k] = metric;
            if k < n {
                // δq̃_l' = … + δs_l; δσ_l' = −Π_l δq̃_l …
                add(k, 2 * n + i, -metric);
                add(2 * n + i, k, own);
            } else {
                // δq̃_m' = … − Π_m⁻¹ K δs_l + δs_m; δσ_l' = K δq̃_m …; δσ_m' = −Π_m δq̃_m …
                add(k, 2 * n + i, metric * coupling);
                add(2 * n + i, k, -self.stiffness[i]);
                add(k, 3 * n + i, -metric);
                add(3 * n + i, k, own);
            }
        }
        for i in 0..n {
            add(2 * n + i, 2 * n + i, self.damping[0][i]);
            add(3 * n + i, 3 * n + i, self.damping[1][i]);
            weight[4 * n * (3 * n + i) + 3 * n + i] = self.inertia[i];
            for j in 0..n {
                weight[4 * n * (2 * n + i) + 2 * n + j] = mass[i * n + j];
            }
        }
        // Units in which the weight has ones on its diagonal.
        let unit: Vec<f64> = (0..4 * n).map(|k| weight[4 * n * k + k].sqrt()).collect();
        let scaled =
            |matrix: &[f64]| Symmetric::from_fn(4 * n, |i, j| matrix[4 * n * i + j] / (unit[i] * unit[j]));
        weakest(&scaled(&form), &scaled(&weight)).map_or(f64::NAN, |(least, _)| least)
    }

    /// The largest real part of the eigenvalues of the loop that stands on its reference with links of this mass matrix [1/s]: from the growth of
    /// its exponential.
    pub fn abscissa(&self, mass: &[f64]) -> f64 {
        let n = self.n;
        let [damping_l, damping_m] = &self.damping;
        let forces = Dense::from_fn(n, 4 * n, |i, j| match j / n {
            _ if j % n != i => 0.0,
            0 => -self.metric[i],
            1 => self.stiffness[i],
            2 => -damping_l[i],
            _ => 0.0,
        });
        let accelerations = Dense::from_fn(n, n, |i, j| mass[i * n + j]).solved(forces);
        let jacobian = Dense::from_fn(4 * n, 4 * n, |row, column| {
            let (i, block) = (row % n, column / n);
            match (row / n, block) {
                (2, _) => accelerations[(i, column)],
                _ if column % n != i => 0.0,
                (0, 0) | (1, 1) => -self.shaping[row],
                (0, 2) | (1, 3) => 1.0,
                (1, 2) => -self.stiffness[i] / self.metric[n + i],
                (3, 1) => -self.metric[n + i] / self.inertia[i],
                (3, 3) => -damping_m[i] / self.inertia[i],
                _ => 0.0,
            }
        });
        let seconds = 0.02;
        spectral_radius(&exponential(&jacobian.scaled(seconds))).ln() / seconds
    }
}

/// r and r'/r at `x`, of errors up to `largest`, where r is one over what it is at 0.
fn stretch(exponent: Option<f64>, x: f64, largest: f64) -> (f64, f64) {
    let Some(b) = exponent else { return (1.0, 0.0) };
    let knee = (1.0 - b).sqrt().atanh();
    let f = |y: f64| y.sinh().powf(b) / y.tanh();
    let middle = (f(knee) * f(largest.max(knee))).sqrt();
    let far = x.abs();
    if far <= knee {
        return (f(knee) / middle, 0.0);
    }
    (f(far) / middle, x.signum() * (b / far.tanh() - 2.0 / (2.0 * far).sinh()))
}
