//! Running figures of a closed loop.

use flexure_core::guard::{Certificate, Phase};
use flexure_core::linalg::Vector;

use crate::simulate::Instant;

/// Errors below this, in rad, count as settled.
pub const SETTLED: f64 = 1e-3;

/// What a run is judged by, instant by instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Figures<const N: usize> {
    torque_limit: Vector<f64, N>,
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
    squared_e_l: Vector<f64, N>,
    squared_u_m: Vector<f64, N>,
    squared_change: Vector<f64, N>,
    last: Option<Vector<f64, N>>,
}

impl<const N: usize> Figures<N> {
    /// Of nothing yet; `torque_limit` is the smallest of the limits that are known per joint [N m].
    pub(crate) fn new(torque_limit: Vector<f64, N>) -> Self {
        Self {
            torque_limit,
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
            squared_e_l: Vector::ZERO,
            squared_u_m: Vector::ZERO,
            squared_change: Vector::ZERO,
            last: None,
        }
    }

    /// Takes in an instant; `rate` is the contraction rate there [1/s], NaN for none.
    pub(crate) fn record(&mut self, instant: &Instant<'_, N>, rate: f64) {
        let (action, u_m) = (instant.action, instant.action.applied.last());
        let e_l = instant.motion.q_l - action.reference.map(|jet| jet.coefficient(0));
        let (error, torque) = (largest(&e_l.map(f64::abs)), largest(&u_m.map(f64::abs)));
        self.instants += 1;
        self.max_abs_e_l = self.max_abs_e_l.max(error);
        self.final_abs_e_l = error;
        self.settled_since = if error < SETTLED { self.settled_since.or(Some(instant.t)) } else { None };
        self.max_abs_u_m = self.max_abs_u_m.max(torque);
        self.rate = self.rate.min(rate);
        let limited = (0..N).any(|k| action.u_m[k].abs() >= self.torque_limit[k]);
        self.at_limit += u32::from(limited);
        let held = action.status.is_none_or(|status| status.certificate() == Certificate::Holds);
        self.suspended += u32::from(limited || !held);
        let stopped = action.status.is_some_and(|status| status.phase != Phase::Following);
        self.stops += u32::from(stopped && !self.stopped);
        self.stopped = stopped;
        let change = self.last.map_or(Vector::ZERO, |last| u_m - last);
        self.last = Some(u_m);
        for (sum, x) in
            [(&mut self.squared_e_l, e_l), (&mut self.squared_u_m, u_m), (&mut self.squared_change, change)]
        {
            *sum += x.map(|x| x * x);
        }
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

    fn root_mean(&self, squared: &Vector<f64, N>) -> f64 {
        (largest(squared) / f64::from(self.instants)).sqrt()
    }
}

fn largest<const N: usize>(v: &Vector<f64, N>) -> f64 {
    v.iter().fold(0.0, f64::max)
}
