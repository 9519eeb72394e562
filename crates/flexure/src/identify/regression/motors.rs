//! A start where only the motors are seen: below the frequencies at which springs swing, links move almost as their motors do.
//!
//! u = M_m q̈_m + (D_l + D_m) q̇_m + (F_l + F_m) sign q̇_m + τ, with the links' inverse dynamics τ at q_l = q_m − C τ. That is linear in
//! the motor inertia and in the sums of both sides, of which each side gets half, and nearly so in the compliances C. A joint
//! feels those of all others, so that all equations are solved at once, by Gauss and Newton from the compliances of the robot file.

use super::{
    APART, Equation, Smooth, Started, delayed, least_squares, likeliest, residual, rows, sampled, torques_of,
};
use crate::logs::Log;
use crate::logs::smooth::{rms, smoothed, window};
use crate::robot::Arm;

/// Reach of the window, through which signals go twice \[s\]: near 10 Hz springs swing, and links do not follow their motors.
const REACH: f64 = 0.1;

/// Steps of Gauss and Newton, and how often each weighs the equations by what they leave.
const STEPS: usize = 6;
const WEIGHED: usize = 3;

/// Standard deviation of a compliance from that of the file, as a part of it; and the largest change in a step.
const SPREAD: f64 = 0.3;

/// Unknowns of a joint that only its own equation has: motor inertia, damping, friction.
const OWN: usize = 3;

/// A log in rows, smoothed.
struct Rows<'a> {
    arm: &'a dyn Arm,
    period: f64,
    motors: Vec<Smooth>,
    at: Vec<usize>,
    /// q̈_m, q̇_m, sign q̇_m at the rows.
    own: Vec<[Vec<f64>; OWN]>,
    inputs: Vec<Vec<f64>>,
}

/// Torques of the links of some compliances at the rows, joint by joint, and what each changes by per part of each compliance.
struct Linear {
    torques: Vec<Vec<f64>>,
    slopes: Vec<Vec<Vec<f64>>>,
}

/// Starts from `log`, which has the positions `q_m` of the motors, with springs of about `stiffness` [N m/rad].
pub(crate) fn start(arm: &dyn Arm, log: &Log, q_m: &[f64], stiffness: &[f64]) -> Started {
    let n = log.joints;
    let rows = Rows::new(arm, log, q_m);
    let scales: Vec<_> = (0..n).map(|i| rms(&log.u_m, n, i).max(f64::MIN_POSITIVE)).collect();
    let mut compliance: Vec<f64> = stiffness.iter().map(|K| K.recip()).collect();
    let (mut x, mut misfits, mut halves) = (vec![0.0; (OWN + 1) * n], vec![0.0; n], 0);
    for _ in 0..STEPS {
        let linear = rows.linear(&compliance);
        halves = likeliest(n, |i, halves| rows.alone(i, &rows.left(&linear, i, halves)));
        (x, misfits) = rows.solved(&linear, halves, &compliance, stiffness);
        for (compliance, softer) in compliance.iter_mut().zip(&x[OWN * n..]) {
            *compliance *= 1.0 + softer.clamp(-SPREAD, SPREAD);
        }
    }
    let of_joint = |i: usize| {
        let (damping, friction) = (0.5 * x[OWN * i + 1], 0.5 * x[OWN * i + 2]);
        [compliance[i].recip(), x[OWN * i], damping, damping, friction, friction]
    };
    Started {
        joints: (0..n).map(of_joint).collect(),
        offset: f64::from(halves) * 0.5 * log.period,
        unexplained: misfits.iter().zip(&scales).map(|(misfit, scale)| [0.0, misfit / scale]).collect(),
    }
}

impl<'a> Rows<'a> {
    fn new(arm: &'a dyn Arm, log: &Log, q_m: &[f64]) -> Self {
        let (n, period) = (log.joints, log.period);
        let window = window(REACH, period);
        let twice = |signal: &[f64], i: usize| smoothed(&smoothed(signal, n, i, &window), 1, 0, &window);
        let motors: Vec<_> = (0..n).map(|i| Smooth::new(twice(q_m, i), period)).collect();
        let at = rows(log, 4 * window.len());
        let own = |motor: &Smooth| {
            let sign = smoothed(&motor.sign(&window), 1, 0, &window);
            [&motor.a, &motor.v, &sign].map(|signal| sampled(signal, &at))
        };
        let own = motors.iter().map(own).collect();
        Self { arm, period, own, at, inputs: (0..n).map(|i| twice(&log.u_m, i)).collect(), motors }
    }

    /// The link of joint `i` behind a spring of `compliance` that carries `torque`.
    fn link(&self, i: usize, compliance: f64, torque: &[f64]) -> Smooth {
        let lagging = self.motors[i].q.iter().zip(torque).map(|(q, torque)| q - compliance * torque);
        Smooth::new(lagging.collect(), self.period)
    }

    /// The links behind springs of `compliance`, and what they ask for.
    fn linear(&self, compliance: &[f64]) -> Linear {
        let behind = |torques: &[Vec<f64>]| -> Vec<_> {
            (0..compliance.len()).map(|i| self.link(i, compliance[i], &torques[i])).collect()
        };
        // Springs bend by what links ask for that bend by what motors would ask for. Once more would be closer where links follow
        // their motors, and wild where they swing.
        let every: Vec<usize> = (0..self.motors[0].q.len()).collect();
        let bending = torques_of(self.arm, &behind(&torques_of(self.arm, &self.motors, &every)), &every);
        let mut links = behind(&bending);
        let torques = torques_of(self.arm, &links, &self.at);
        let slope = |j: usize| {
            let softer = self.link(j, (1.0 + STEP) * compliance[j], &bending[j]);
            let link = std::mem::replace(&mut links[j], softer);
            let mut slope = torques_of(self.arm, &links, &self.at);
            links[j] = link;
            for (slope, torque) in slope.iter_mut().flatten().zip(torques.iter().flatten()) {
                *slope = (*slope - torque) / STEP;
            }
            slope
        };
        let slopes = (0..compliance.len()).map(slope).collect();
        Linear { torques, slopes }
    }

    /// What the motor of joint `i` has beside what its link asks for.
    fn left(&self, linear: &Linear, i: usize, halves: i32) -> Vec<f64> {
        let rows = self.at.iter().zip(&linear.torques[i]);
        rows.map(|(&k, torque)| delayed(&self.inputs[i], k, halves) - torque).collect()
    }

    /// What the numbers of joint `i` alone leave unexplained of `left` [N m].
    fn alone(&self, i: usize, left: &[f64]) -> f64 {
        let columns = self.own[i].each_ref().map(|column| Some(&**column));
        residual(&columns, left, &least_squares(&[(&columns, left, 1.0)], OWN))
    }

    /// The numbers of all joints, then parts by which the compliances grow; and what they leave unexplained of each joint [N m].
    fn solved(
        &self,
        linear: &Linear,
        halves: i32,
        compliance: &[f64],
        stiffness: &[f64],
    ) -> (Vec<f64>, Vec<f64>) {
        let n = compliance.len();
        let unknowns = (OWN + 1) * n;
        let left: Vec<_> = (0..n).map(|i| self.left(linear, i, halves)).collect();
        let columns = |i: usize| {
            let mut columns = vec![None; unknowns];
            for (column, own) in columns[OWN * i..].iter_mut().zip(&self.own[i]) {
                *column = Some(&**own);
            }
            for (column, slopes) in columns[OWN * n..].iter_mut().zip(&linear.slopes) {
                *column = Some(&*slopes[i]);
            }
            columns
        };
        let columns: Vec<_> = (0..n).map(columns).collect();
        // What the file says of a compliance is a row of its own.
        let prior = |j: usize| {
            let mut columns = vec![None; unknowns];
            columns[OWN * n + j] = Some(&[1.0][..]);
            (columns, [(compliance[j] * stiffness[j]).recip() - 1.0])
        };
        let priors: Vec<_> = (0..n).map(prior).collect();
        let mut misfits: Vec<_> = (0..n).map(|i| self.alone(i, &left[i])).collect();
        let mut x = Vec::new();
        for _ in 0..WEIGHED {
            // Rows that a window spans are one measurement.
            let weight = |misfit: f64| 0.5 * APART / REACH / misfit.max(1e-12).powi(2);
            let equations = (0..n).map(|i| (&*columns[i], &*left[i], weight(misfits[i])));
            let priors = priors.iter().map(|(columns, right)| (&**columns, &right[..], SPREAD.powi(-2)));
            x = least_squares(&equations.chain(priors).collect::<Vec<Equation<'_>>>(), unknowns);
            misfits = (0..n).map(|i| residual(&columns[i], &left[i], &x)).collect();
        }
        (x, misfits)
    }
}

/// Part of a compliance over which slopes are taken: links that turn by a few mrad are linear over that.
const STEP: f64 = 0.01;

#[cfg(test)]
mod tests {
    use super::{Log, start};
    use crate::robot::Robot;

    /// Stiffness, motor inertia, damping of the motor.
    const TRUE: [[f64; 3]; 2] = [[200.0, 0.1, 0.4], [30.0, 0.02, 0.1]];

    /// Links on slow sines; torques that bend the springs by what they ask for, and turn the motors behind them.
    fn log(robot: &Robot) -> Log {
        let (arm, period, samples) = (robot.arm().unwrap(), 1e-3, 12_000);
        let motion = |i: usize, t: f64, rates: i32| -> f64 {
            let line = |k: usize| {
                let (omega, phase) = ([3.0, 5.0, 8.0][k] * [1.0, 1.13][i], [0.3, 1.1, 2.0][k]);
                let wave = if rates == 1 { f64::cos } else { f64::sin }(omega * t + phase);
                0.05 * omega.powi(rates) * wave * if rates == 2 { -1.0 } else { 1.0 }
            };
            (0..3).map(line).sum()
        };
        let motors = |t: f64| {
            let at = |rates| [0, 1].map(|i| motion(i, t, rates));
            let mut torque = [0.0; 2];
            arm.inverse_dynamics(&at(0), &at(1), &at(2), &mut torque).unwrap();
            let q = [0, 1].map(|i| at(0)[i] + torque[i] / TRUE[i][0]);
            (q, torque)
        };
        let (mut q_m, mut u_m) = (Vec::new(), Vec::new());
        for k in 0..samples {
            q_m.extend(motors(period * f64::from(k)).0);
            // Torques are held over a period.
            let t = period * (f64::from(k) + 0.5);
            let [(before, _), (q, torque), (after, _)] = [-1e-3, 0.0, 1e-3].map(|step| motors(t + step));
            for i in 0..2 {
                let [_, inertia, damping] = TRUE[i];
                let (v, a) = ((after[i] - before[i]) / 2e-3, (after[i] - 2.0 * q[i] + before[i]) / 1e-6);
                u_m.push(inertia * a + damping * v + torque[i]);
            }
        }
        let name = "made".to_owned();
        Log { name, period, joints: 2, q_l: None, q_m: Some(q_m), dq_l: None, dq_m: None, u_m }
    }

    /// What is known exactly is found from guesses that are off by 30 %, to what springs that bend by the torque of springs
    /// that bend leave out.
    #[test]
    fn compliances_of_coupled_joints_are_found() {
        let robot = Robot::load("two-link-plausible").unwrap();
        let log = log(&robot);
        let guess = [TRUE[0][0] * 1.3, TRUE[1][0] * 0.75];
        let started = start(&*robot.arm().unwrap(), &log, log.q_m.as_ref().unwrap(), &guess);
        println!("{:?} {:?} {}", started.joints, started.unexplained, started.offset);
        for ([stiffness, inertia, damping, ..], exact) in started.joints.iter().zip(TRUE) {
            assert!((stiffness / exact[0] - 1.0).abs() < 0.02, "{stiffness} for {}", exact[0]);
            assert!((inertia / exact[1] - 1.0).abs() < 0.01, "{inertia} for {}", exact[1]);
            assert!((2.0 * damping / exact[2] - 1.0).abs() < 0.02, "{damping} for half of {}", exact[2]);
        }
        assert!(started.offset.abs() < 1e-9, "{}", started.offset);
    }
}
