//! The estimators by name.

use flexure_core::estimate::{Estimator, FilteredDifference, LowPass, MotorObserver, Observer};
use flexure_core::linalg::Vector;
use flexure_core::memory::{Memory, Port};
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::{Float, Over};

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
pub enum AnyEstimator<C, const N: usize> {
    /// `velocity-filter`.
    FilteredDifference(FilteredDifference<C, N>),
    /// `observer` with both encoders.
    Observer(Observer<C, N>),
    /// `observer` with the encoders of the motors.
    MotorObserver(MotorObserver<C, N>),
}

/// The estimator of a loop with control periods of `period` in s: the one that is asked for, else differences of positions through the
/// filter for `velocities`; none if the law sees the readings themselves.
///
/// # Panics
/// For bandwidths that the reader of scenarios refuses.
pub fn estimator<C: Float + Over<f64>, const N: usize>(
    estimator: Option<&estimators::Estimator>,
    velocities: Option<LowPass<f64>>,
    period: f64,
) -> Option<AnyEstimator<C, N>> {
    const CHECKED: &str = "the reader takes positive numbers only";
    let period = C::constant(period);
    if let Some(estimator) = estimator {
        return Some(match estimator {
            estimators::Estimator::Observer { encoders: Encoders::Both, bandwidth } => {
                let bandwidth = padded(bandwidth, 1.0).map(C::constant);
                AnyEstimator::Observer(Observer::new(&bandwidth, period).expect(CHECKED))
            }
            estimators::Estimator::Observer { encoders: Encoders::Motor, bandwidth } => {
                let bandwidth = padded(bandwidth, 1.0).map(C::constant);
                AnyEstimator::MotorObserver(MotorObserver::new(&bandwidth, period).expect(CHECKED))
            }
        });
    }
    velocities.map(|filter| AnyEstimator::FilteredDifference(FilteredDifference::new(filter.over())))
}

impl<C: Float, const N: usize> Estimator<C, N> for AnyEstimator<C, N> {
    fn start(&mut self, x: &Motion<C, N>) {
        match self {
            Self::FilteredDifference(estimator) => estimator.start(x),
            Self::Observer(estimator) => estimator.start(x),
            Self::MotorObserver(estimator) => estimator.start(x),
        }
    }

    fn update<L: Links<C, N>>(
        &mut self,
        robot: &Fjr<C, L, N>,
        q_l: &Vector<C, N>,
        q_m: &Vector<C, N>,
        u_m: &Vector<C, N>,
    ) -> Motion<C, N> {
        match self {
            Self::FilteredDifference(estimator) => estimator.update(robot, q_l, q_m, u_m),
            Self::Observer(estimator) => estimator.update(robot, q_l, q_m, u_m),
            Self::MotorObserver(estimator) => estimator.update(robot, q_l, q_m, u_m),
        }
    }
}

/// What the estimator remembers.
impl<C: Float, const N: usize> Memory<C> for AnyEstimator<C, N> {
    fn memory(&mut self, port: &mut dyn Port<C>) {
        match self {
            Self::FilteredDifference(estimator) => estimator.memory(port),
            Self::Observer(estimator) => estimator.memory(port),
            Self::MotorObserver(estimator) => estimator.memory(port),
        }
    }
}
