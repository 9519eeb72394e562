//! Running figures of a closed loop.

use crate::simulate::interface::Observed;

/// Errors below this, in rad, count as settled.
pub const SETTLED: f64 = 1e-3;

/// What a run is judged by, instant by instant.
#[derive(Clone, Debug)]
pub(crate) struct Figures {
    torque_limit: Vec<f64>,
    pub(crate) instants: u32,
    pub(crate) max_abs_e_l: f64,
    pub(crate) final_abs_e_l: f64,
    pub(crate) settled_since: Option<f64>,
    pub(crate) max_abs_u_m: f64,
    pub(crate) rate: f64,
    pub(crate) stops: u32,
    stopped: bool,
    at_limit: u32,
    suspended: u32,
    squared_e_l: Vec<f64>,
    squared_u_m: Vec<f64>,
    squared_change: Vec<f64>,
    last: Vec<f64>,
}

impl Figures {
    /// Of nothing yet; `torque_limit` is the smallest of the limits that act, per joint [N m].
    pub(crate) fn new(torque_limit: Vec<f64>) -> Self {
        let zeros = || vec![0.0; torque_limit.len()];
        Self {
            instants: 0,
            max_abs_e_l: 0.0,
            final_abs_e_l: 0.0,
            settled_since: None,
            max_abs_u_m: 0.0,
            rate: f64::INFINITY,
            stops: 0,
            stopped: false,
            at_limit: 0,
            suspended: 0,
            squared_e_l: zeros(),
            squared_u_m: zeros(),
            squared_change: zeros(),
            last: Vec::with_capacity(torque_limit.len()),
            torque_limit,
        }
    }

    /// Takes in an instant; `rate` is the contraction rate there [1/s], NaN for none.
    pub(crate) fn record(&mut self, instant: &Observed, rate: f64) {
        let (mut error, mut torque) = (0.0_f64, 0.0_f64);
        let links = instant.motion.iter().zip(&instant.reference);
        for (sum, (q_l, q_ld)) in self.squared_e_l.iter_mut().zip(links) {
            let e_l = q_l - q_ld;
            error = error.max(e_l.abs());
            *sum += e_l * e_l;
        }
        for (sum, u_m) in self.squared_u_m.iter_mut().zip(&instant.applied) {
            torque = torque.max(u_m.abs());
            *sum += u_m * u_m;
        }
        let changes = instant.applied.iter().zip(&self.last).map(|(u_m, last)| u_m - last);
        for (sum, change) in self.squared_change.iter_mut().zip(changes) {
            *sum += change * change;
        }
        self.last.clone_from(&instant.applied);
        self.instants += 1;
        self.max_abs_e_l = self.max_abs_e_l.max(error);
        self.final_abs_e_l = error;
        self.settled_since = if error < SETTLED { self.settled_since.or(Some(instant.t)) } else { None };
        self.max_abs_u_m = self.max_abs_u_m.max(torque);
        self.rate = self.rate.min(rate);
        let limited = instant.command.iter().zip(&self.torque_limit).any(|(u, limit)| u.abs() >= *limit);
        self.at_limit += u32::from(limited);
        self.suspended += u32::from(!instant.certificate);
        self.stops += u32::from(instant.stopped && !self.stopped);
        self.stopped = instant.stopped;
    }

    pub(crate) fn rms_e_l(&self) -> f64 {
        self.root_mean(&self.squared_e_l)
    }

    pub(crate) fn rms_u_m(&self) -> f64 {
        self.root_mean(&self.squared_u_m)
    }

    pub(crate) fn rms_torque_change(&self) -> f64 {
        self.root_mean(&self.squared_change)
    }

    pub(crate) fn limited_fraction(&self) -> f64 {
        self.fraction(self.at_limit)
    }

    pub(crate) fn suspended_fraction(&self) -> f64 {
        self.fraction(self.suspended)
    }

    /// Largest error and torque; not numbers for a run that diverged before its first instant.
    pub(crate) fn seen(&self, figure: f64) -> f64 {
        if self.instants == 0 { f64::NAN } else { figure }
    }

    fn fraction(&self, count: u32) -> f64 {
        f64::from(count) / f64::from(self.instants.max(1))
    }

    fn root_mean(&self, squared: &[f64]) -> f64 {
        (squared.iter().copied().fold(0.0, f64::max) / f64::from(self.instants)).sqrt()
    }
}
