//! A law of the caller's in the place of the scenario's: for experiments, with everything else of the loop as it is.

use std::fmt;
use std::sync::Arc;

use flexure_core::control::{self, Applied, Input, LinkGains, MotorGains, OddSeries, Seen, TERMS};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::Jet;

use crate::laws::{self, AnyLaw, Law, LawMemory, PARTS, VcbcGains};
use crate::robot::slices::{read, write, write_motion};
use crate::robot::{MAX_JOINTS, vector};
use crate::simulate::feedback::Feedback;

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

/// A shaping function of one's own, for [`Scenario::open_shaped`](crate::Scenario::open_shaped): [`OddSeries`] in the place of that of a
/// v-CBC law, on both sides, with its Λ, metrics and damping.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnShaping {
    /// The error at which x = 1/√2 \[rad\].
    pub scale: f64,
    /// Of the series, at most [`TERMS`].
    pub coefficients: Vec<f64>,
}

/// A v-CBC law with a shaping function of one's own.
pub(crate) type Shaped<const N: usize> = control::Vcbc<f64, OddSeries<f64, N>, OddSeries<f64, N>, N>;

impl OwnShaping {
    /// The law of `gains` with it.
    pub(crate) fn law<const N: usize>(&self, gains: &VcbcGains) -> Shaped<N> {
        let law: Law<f64, N> = laws::law(gains);
        let mut coefficients = [0.0; TERMS];
        coefficients.iter_mut().zip(&self.coefficients).for_each(|(all, own)| *all = *own);
        let series = |gain: &[f64]| OddSeries { gain: vector(gain), scale: self.scale, coefficients };
        control::Vcbc {
            link: LinkGains {
                metric: law.link.metric,
                shaping: series(&gains.link.shaping),
                damping: law.link.damping,
            },
            motor: MotorGains {
                metric: law.motor.metric,
                shaping: series(&gains.motor.shaping),
                damping: law.motor.damping,
            },
        }
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
    /// That of the scenario with the caller's shaping function.
    Shaped(Box<Shaped<N>>),
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
        z: Option<&LawMemory<f64, N>>,
    ) -> Vector<f64, N> {
        let law = match self {
            Self::Registered(law) => return Feedback::torque(law, robot, t, x, q_ld, z),
            Self::Shaped(law) => return law.command(robot, x, q_ld, &Input::ZERO).u_m,
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

    fn memory(&self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Registered(law) => law.memory(),
            Self::Shaped(_) | Self::Own(_) => &[],
        }
    }

    fn start(
        &self,
        robot: &Fjr<f64, L, N>,
        x: &Motion<f64, N>,
        q_ld: &Vector<Jet<f64, 5>, N>,
    ) -> LawMemory<f64, N> {
        match self {
            Self::Registered(law) => laws::start(law, robot, x, q_ld),
            Self::Shaped(_) | Self::Own(_) => [Vector::ZERO; PARTS],
        }
    }

    fn advanced(
        &self,
        robot: &Fjr<f64, L, N>,
        seen: [&Seen<f64, N>; 2],
        z: &LawMemory<f64, N>,
        applied: &Applied<f64, N>,
        period: f64,
    ) -> LawMemory<f64, N> {
        match self {
            Self::Registered(law) => laws::advanced(law, robot, seen, z, applied, period),
            Self::Shaped(_) | Self::Own(_) => *z,
        }
    }
}
