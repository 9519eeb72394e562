//! A law of the caller's in the place of the scenario's: for experiments, with everything else of the loop as it is.

use std::fmt;
use std::sync::Arc;

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::Jet;

use crate::laws::{self, AnyLaw};
use crate::robot::MAX_JOINTS;
use crate::robot::slices::{read, write, write_motion};
use crate::simulate::controller::Feedback;

/// What a law is as a function on slices: of the time in s, the motion that it sees (4n numbers in rad and rad/s) and Taylor
/// coefficients of the reference (n arrays, the position first), into motor torques (n numbers [N m]).
type Function = dyn Fn(f64, &[f64], &[[f64; 5]], &mut [f64]) + Send + Sync;

/// A law of one's own with the joint count hidden, for [`Scenario::open_with`](crate::Scenario::open_with).
///
/// ```
/// use flexure::simulate::OwnLaw;
///
/// // Springs to the reference, dampers at the motors.
/// let law = OwnLaw::new(|_, motion, reference, u_m| {
///     for (i, u) in u_m.iter_mut().enumerate() {
///         *u = 20.0 * (reference[i][0] - motion[i]) - 2.0 * motion[3 + i];
///     }
/// });
/// let mut held = flexure::Scenario::load("pendulum-tanh")?.open_with(law)?;
/// held.step()?;
/// let mut u_m = [0.0];
/// held.torque(0.0, &[0.1, 0.1, 0.0, 0.5], &mut u_m)?;
/// assert_eq!(u_m, [20.0 * -0.1 - 2.0 * 0.5]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct OwnLaw(Arc<Function>);

impl OwnLaw {
    /// Of a function of the time in s, the motion that is seen, the reference, and the torques that it gives.
    pub fn new(law: impl Fn(f64, &[f64], &[[f64; 5]], &mut [f64]) + Send + Sync + 'static) -> Self {
        Self(Arc::new(law))
    }
}

impl fmt::Debug for OwnLaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("OwnLaw")
    }
}

/// The law of a loop that is held.
#[derive(Clone, Debug)]
pub(crate) enum HeldLaw<const N: usize> {
    /// That of the scenario.
    Registered(AnyLaw<f64, N>),
    /// The caller's.
    Own(OwnLaw),
}

impl<L: Links<f64, N>, const N: usize> Feedback<L, N> for HeldLaw<N> {
    fn torque(
        &self,
        robot: &Fjr<f64, L, N>,
        t: f64,
        x: &Motion<f64, N>,
        q_ld: &Vector<Jet<f64, 5>, N>,
    ) -> Vector<f64, N> {
        let law = match self {
            Self::Registered(law) => return laws::torque(law, robot, x, q_ld),
            Self::Own(OwnLaw(law)) => law,
        };
        let n = robot.links.joints();
        let (mut motion, mut series) = ([0.0; 4 * MAX_JOINTS], [[0.0; 5]; MAX_JOINTS]);
        let mut u_m = [0.0; MAX_JOINTS];
        write_motion(x, n, &mut motion[..4 * n]);
        write(&q_ld.map(|jet| std::array::from_fn(|k| jet.coefficient(k))), &mut series[..n]);
        law(t, &motion[..4 * n], &series[..n], &mut u_m[..n]);
        read("u_m", &u_m[..n], n).unwrap_or(Vector([f64::NAN; N]))
    }
}
