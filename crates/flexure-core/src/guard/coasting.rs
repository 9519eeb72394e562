//! Going on for a while without a reading.

use super::Age;
use crate::estimate::{ahead, positive};
use crate::linalg::Vector;
use crate::memory::{Memory, Port};
use crate::model::{Fjr, Links, Motion};
use crate::scalar::Float;

/// Puts what the model of the robot predicts in the place of readings that did not come: NaN, or an old one that is held.
///
/// It stands between the sensors and the estimator, which so goes on undisturbed: an observer sees its own prediction confirmed, a
/// filter of differences sees a motion without a gap. The prediction starts from the last motion that was estimated and goes one
/// control period at a time, driven by the torque that was applied; it is as good as the model, for as long as springs
/// and pushes leave it so.
///
/// ```
/// use flexure_core::guard::{Age, Coasting};
/// use flexure_core::linalg::Vector;
/// use flexure_core::model::{Fjr, Motion};
/// use flexure_core::robots::Pendulum;
///
/// let one = Vector([1.0]);
/// let links = Pendulum { inertia: 1.0, weight_moment: 0.0 };
/// let robot = Fjr { links, motor_inertia: one, stiffness: one, link_damping: Vector([0.0]), motor_damping: Vector([0.0]) };
/// let mut coasting = Coasting::new(5, 1e-3).unwrap();
/// // Link and motor drift at 2 rad/s, and the sensors fall silent.
/// let drifting = Motion { v_l: Vector([2.0]), v_m: Vector([2.0]), ..Motion::at_rest(Vector([0.1])) };
/// coasting.saw(&drifting);
/// let silence = Motion::at_rest(Vector([f64::NAN]));
/// let (x, age) = coasting.fill(&robot, &silence, Age::FRESH, [true; 2], &Vector([0.0]));
/// assert!((x.q_l[0] - 0.102).abs() < 1e-12 && age.oldest() == 1);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Coasting<C, const N: usize> {
    /// Control periods that it goes on for.
    allowed: u32,
    period: C,
    /// The motion that was estimated last.
    last: Option<Motion<C, N>>,
    /// Control instants in a row without a reading.
    lost: Age,
}

impl<C: Float, const N: usize> Coasting<C, N> {
    /// For at most `allowed` control periods of `period` in s. `None` unless that is positive.
    pub fn new(allowed: u32, period: C) -> Option<Self> {
        positive(period).then_some(Self { allowed, period, last: None, lost: Age::FRESH })
    }

    /// The `readings` of a control instant, with predictions where they did not come, and for how many control periods there was
    /// none. `age` says how old they are; of a side that has no sensors, that is not `placed`, nothing is expected. `u_m` is the
    /// motor torque that was applied since the last instant [N m].
    #[inline]
    pub fn fill<L: Links<C, N>>(
        &mut self,
        robot: &Fjr<C, L, N>,
        readings: &Motion<C, N>,
        age: Age,
        placed: [bool; 2],
        u_m: &Vector<C, N>,
    ) -> (Motion<C, N>, Age) {
        let [link, motor] = placed;
        let missing = |q: &Vector<C, N>| !q.iter().all(C::is_finite);
        let count = |lost: u32, age: u32, expected: bool, missing: bool| {
            let is_lost = expected && (age > 0 || missing);
            if is_lost { lost.saturating_add(1).max(age) } else { 0 }
        };
        self.lost = Age {
            link: count(self.lost.link, age.link, link, missing(&readings.q_l)),
            motor: count(self.lost.motor, age.motor, motor, missing(&readings.q_m)),
        };
        let bridged = |lost: u32| (1..=self.allowed).contains(&lost);
        let (link, motor) = (bridged(self.lost.link), bridged(self.lost.motor));
        let mut filled = *readings;
        if let Some(last) = self.last.filter(|_| link || motor) {
            let next = ahead(robot, &last, u_m, self.period);
            if link {
                (filled.q_l, filled.v_l) = (next.q_l, next.v_l);
            }
            if motor {
                (filled.q_m, filled.v_m) = (next.q_m, next.v_m);
            }
        }
        (filled, self.lost)
    }

    /// The motion that was estimated at this instant: what the next prediction starts from.
    #[inline]
    pub fn saw(&mut self, x: &Motion<C, N>) {
        let finite = [&x.q_l, &x.q_m, &x.v_l, &x.v_m].iter().all(|part| part.iter().all(C::is_finite));
        self.last = finite.then_some(*x);
    }
}

/// Whether there is a `last` motion, and that; `lost_link`, `lost_motor`, instants without a reading.
impl<C: Float, const N: usize> Memory<C> for Coasting<C, N> {
    #[inline]
    fn memory(&mut self, port: &mut dyn Port<C>) {
        port.optional("last", &mut self.last, Motion::at_rest(Vector::ZERO), Motion::memory);
        port.word("lost_link", &mut self.lost.link);
        port.word("lost_motor", &mut self.lost.motor);
    }
}
