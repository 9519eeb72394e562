//! The estimators by name.

use flexure_core::estimate::{Estimator, FilteredDifference, LowPass, MotorObserver, Observer};
use flexure_core::linalg::Vector;
use flexure_core::memory::{Memory, Port};
use flexure_core::model::{Fjr, Links, Motion};

use crate::estimators::{self, Encoders};
use crate::files::Entry;
use crate::robot::padded;

/// The registered estimators.
pub const ESTIMATORS: &[Entry] = &[
    Entry {
        name: "velocity-filter",
        summary: "filtered differences of both encoders; an imperfection in scenario files",
    },
    Entry {
        name: "observer",
        summary: "the model of the robot, corrected by both encoders or by those of the motors",
    },
];

/// Any registered estimator.
#[derive(Clone, Debug)]
pub enum AnyEstimator<const N: usize> {
    /// `velocity-filter`.
    FilteredDifference(FilteredDifference<f64, N>),
    /// `observer` with both encoders.
    Observer(Observer<f64, N>),
    /// `observer` with the encoders of the motors.
    MotorObserver(MotorObserver<f64, N>),
}

/// The estimator of a loop with control periods of `period` in s: the one that is asked for, else differences of positions through the
/// filter for `velocities`; none if the law sees the readings themselves.
///
/// # Panics
/// For bandwidths that the reader of scenarios refuses.
pub fn estimator<const N: usize>(
    estimator: Option<&estimators::Estimator>,
    velocities: Option<LowPass<f64>>,
    period: f64,
) -> Option<AnyEstimator<N>> {
    const CHECKED: &str = "the reader takes positive numbers only";
    if let Some(estimator) = estimator {
        return Some(match estimator {
            estimators::Estimator::Observer { encoders: Encoders::Both, bandwidth } => {
                AnyEstimator::Observer(Observer::new(&padded(bandwidth, 1.0), period).expect(CHECKED))
            }
            estimators::Estimator::Observer { encoders: Encoders::Motor, bandwidth } => {
                let bandwidth = padded(bandwidth, 1.0);
                AnyEstimator::MotorObserver(MotorObserver::new(&bandwidth, period).expect(CHECKED))
            }
        });
    }
    velocities.map(|filter| AnyEstimator::FilteredDifference(FilteredDifference::new(filter)))
}

impl<const N: usize> Estimator<f64, N> for AnyEstimator<N> {
    fn start(&mut self, x: &Motion<f64, N>) {
        match self {
            Self::FilteredDifference(estimator) => estimator.start(x),
            Self::Observer(estimator) => estimator.start(x),
            Self::MotorObserver(estimator) => estimator.start(x),
        }
    }

    fn update<L: Links<f64, N>>(
        &mut self,
        robot: &Fjr<f64, L, N>,
        q_l: &Vector<f64, N>,
        q_m: &Vector<f64, N>,
        u_m: &Vector<f64, N>,
    ) -> Motion<f64, N> {
        match self {
            Self::FilteredDifference(estimator) => estimator.update(robot, q_l, q_m, u_m),
            Self::Observer(estimator) => estimator.update(robot, q_l, q_m, u_m),
            Self::MotorObserver(estimator) => estimator.update(robot, q_l, q_m, u_m),
        }
    }
}

/// What the estimator remembers.
impl<const N: usize> Memory<f64> for AnyEstimator<N> {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        match self {
            Self::FilteredDifference(estimator) => estimator.memory(port),
            Self::Observer(estimator) => estimator.memory(port),
            Self::MotorObserver(estimator) => estimator.memory(port),
        }
    }
}
