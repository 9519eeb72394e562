//! Records a closed-loop run: its trace and its figures.

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};

use crate::sim::Instant;
use crate::trace::Trace;

/// Errors below this, in rad, count as settled.
pub const SETTLED: f64 = 1e-3;

/// Watches a run, instant by instant.
pub(super) struct Recorder<const N: usize> {
    trace: Trace,
    row: Vec<f64>,
    torque_limit: Vector<f64, N>,
    figures: Figures<N>,
}

/// Running figures of a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Figures<const N: usize> {
    pub(super) instants: u32,
    pub(super) max_abs_e_l: f64,
    pub(super) final_abs_e_l: f64,
    pub(super) settled_since: Option<f64>,
    pub(super) max_abs_u_m: f64,
    pub(super) at_limit: u32,
    pub(super) rate: f64,
    squared_e_l: Vector<f64, N>,
    squared_u_m: Vector<f64, N>,
}

impl<const N: usize> Figures<N> {
    pub(super) fn rms_e_l(&self) -> f64 {
        self.root_mean(&self.squared_e_l)
    }

    pub(super) fn rms_u_m(&self) -> f64 {
        self.root_mean(&self.squared_u_m)
    }

    pub(super) fn limited_fraction(&self) -> f64 {
        f64::from(self.at_limit) / f64::from(self.instants.max(1))
    }

    fn root_mean(&self, squared: &Vector<f64, N>) -> f64 {
        (largest(squared) / f64::from(self.instants)).sqrt()
    }
}

/// The columns of a trace, with units; vector signals have one column per joint.
const SIGNALS: [(&str, &str); 11] = [
    ("q_l", "rad"),
    ("q_m", "rad"),
    ("dq_l", "rad/s"),
    ("dq_m", "rad/s"),
    ("q_ld", "rad"),
    ("e_l", "rad"),
    ("e_m", "rad"),
    ("sigma_l", "kg m^2/s"),
    ("sigma_m", "kg m^2/s"),
    ("u_l", "N m"),
    ("u_m", "N m"),
];
const SCALARS: [(&str, &str); 5] =
    [("hamiltonian", "J"), ("supplied", "J"), ("dissipated", "J"), ("energy_residual", "J"), ("rate", "1/s")];

impl<const N: usize> Recorder<N> {
    pub(super) fn new(torque_limit: Vector<f64, N>) -> Self {
        let joints =
            |(name, unit): (&str, &'static str)| (1..=N).map(move |k| (format!("{name}{k}"), unit)).collect();
        let vectors: Vec<Vec<(String, &'static str)>> = SIGNALS.into_iter().map(joints).collect();
        let columns = std::iter::once(("t".to_owned(), "s"))
            .chain(vectors.into_iter().flatten())
            .chain(SCALARS.into_iter().map(|(name, unit)| (name.to_owned(), unit)));
        Self {
            trace: Trace::new(columns),
            row: Vec::with_capacity(1 + SIGNALS.len() * N + SCALARS.len()),
            torque_limit,
            figures: Figures {
                instants: 0,
                max_abs_e_l: 0.0,
                final_abs_e_l: 0.0,
                settled_since: None,
                max_abs_u_m: 0.0,
                at_limit: 0,
                rate: f64::INFINITY,
                squared_e_l: Vector::ZERO,
                squared_u_m: Vector::ZERO,
            },
        }
    }

    pub(super) fn record<L: Links<f64, N>>(
        &mut self,
        robot: &Fjr<f64, L, N>,
        instant: &Instant<'_, N>,
        rate: f64,
    ) {
        let Instant { t, motion, command, energy, residual, ledger } = *instant;
        let sigma = robot.state(&Motion { v_l: command.s_l, v_m: command.s_m, ..*motion });
        self.row.clear();
        self.row.push(t);
        let vectors = [
            &motion.q_l,
            &motion.q_m,
            &motion.v_l,
            &motion.v_m,
            &(motion.q_l - command.e_l),
            &command.e_l,
            &command.e_m,
            &sigma.p_l,
            &sigma.p_m,
            &command.u_l,
            &command.u_m,
        ];
        self.row.extend(vectors.iter().flat_map(|v| v.iter()));
        self.row.extend([energy, ledger.supplied, ledger.dissipated, residual, rate]);
        self.trace.push(&self.row);

        let figures = &mut self.figures;
        let (error, torque) = (largest(&command.e_l.map(f64::abs)), largest(&command.u_m.map(f64::abs)));
        let limited = (0..N).any(|k| command.u_m[k].abs() >= self.torque_limit[k]);
        figures.instants += 1;
        figures.max_abs_e_l = figures.max_abs_e_l.max(error);
        figures.final_abs_e_l = error;
        figures.settled_since = if error < SETTLED { figures.settled_since.or(Some(t)) } else { None };
        figures.max_abs_u_m = figures.max_abs_u_m.max(torque);
        figures.at_limit += u32::from(limited);
        figures.rate = figures.rate.min(rate);
        figures.squared_e_l += command.e_l.map(|x| x * x);
        figures.squared_u_m += command.u_m.map(|x| x * x);
    }

    /// Trace and figures; of a run that diverged before its first instant there are no figures.
    pub(super) fn finish(self) -> (Trace, Figures<N>) {
        let mut figures = self.figures;
        if figures.instants == 0 {
            for figure in [
                &mut figures.max_abs_e_l,
                &mut figures.final_abs_e_l,
                &mut figures.max_abs_u_m,
                &mut figures.rate,
            ] {
                *figure = f64::NAN;
            }
        }
        if figures.rate == f64::INFINITY {
            figures.rate = f64::NAN; // a law without rates
        }
        (self.trace, figures)
    }
}

fn largest<const N: usize>(v: &Vector<f64, N>) -> f64 {
    v.iter().fold(0.0, f64::max)
}
