//! The memory of a law in a loop.

use flexure_core::control::{Applied, Seen};
use flexure_core::linalg::Vector;
use flexure_core::memory::Port;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::Jet;

use crate::laws::{LawMemory, PARTS};
use crate::simulate::feedback::Feedback;
use crate::simulate::memory::series;

/// What a law with memory knows of the instants before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Remembered<const N: usize> {
    /// Its memory at the last instant.
    pub z: LawMemory<f64, N>,
    seen: Seen<f64, N>,
    /// When that was, in s.
    t: f64,
    /// What left the controller then [N m].
    asked: Vector<f64, N>,
}

impl<const N: usize> Remembered<N> {
    /// Nothing: what stands for it where it is absent.
    pub const NONE: Self = Self {
        z: [Vector::ZERO; PARTS],
        seen: Seen {
            x: Motion { q_l: Vector::ZERO, q_m: Vector::ZERO, v_l: Vector::ZERO, v_m: Vector::ZERO },
            q_ld: Vector::ZERO,
        },
        t: 0.0,
        asked: Vector::ZERO,
    };

    /// The memory at the time `t` in s at which the robot moves as `x` and shall be at `q_ld`: from that `before`, if there is one, and the mean torque that
    /// the motors were `given` since [N m]. While a reading or that torque is no number it stays as it was and waits. A memory that becomes no number
    /// although all of them are numbers is kept as that: the torque is none either, and the loop says so.
    pub fn at<L: Links<f64, N>, F: Feedback<L, N>>(
        law: &F,
        robot: &Fjr<f64, L, N>,
        before: Option<&Self>,
        t: f64,
        (x, q_ld): (&Motion<f64, N>, &Vector<Jet<f64, 5>, N>),
        given: Vector<f64, N>,
    ) -> Option<Self> {
        let seen = Seen { x: *x, q_ld: *q_ld };
        let z = match before {
            None => law.start(robot, x, q_ld),
            Some(before) => {
                let applied = Applied { asked: before.asked, given };
                law.advanced(robot, [&before.seen, &seen], &before.z, &applied, t - before.t)
            }
        };
        let Motion { q_l, q_m, v_l, v_m } = x;
        let heard = [q_l, q_m, v_l, v_m, &given].into_iter().all(is_number);
        let counts = heard || z.iter().all(is_number);
        counts.then_some(Self { z, seen, t, asked: given }).or_else(|| before.copied())
    }

    /// Takes note of what left the controller [N m], if it is a number.
    pub fn ask(&mut self, torque: Vector<f64, N>) {
        if is_number(&torque) {
            self.asked = torque;
        }
    }

    /// Walks over the parts that are used, named in `parts`.
    pub fn walk(&mut self, parts: &[(&'static str, &'static str)], port: &mut dyn Port<f64>) {
        let Self { z, seen: Seen { x, q_ld }, t, asked } = self;
        for ((name, unit), part) in parts.iter().zip(z) {
            port.joints(name, unit, &mut part.0);
        }
        port.part("seen", x);
        series("q_ld", q_ld, port);
        port.number("time", "s", t);
        port.joints("u_asked", "N m", &mut asked.0);
    }
}

fn is_number<const N: usize>(part: &Vector<f64, N>) -> bool {
    part.iter().all(f64::is_finite)
}

#[cfg(test)]
mod tests {
    use flexure_core::robots::PlanarTwoLink;
    use flexure_core::scalar::Scalar as _;

    use super::*;
    use crate::laws::{Controller, any_law};
    use crate::robot::load_robot;
    use crate::robot::sized::{OF_THE_KIND, fjr};

    /// A reading that is no number, the first or a later one, leaves a memory as it was, absent or with its numbers; so does a torque that is none.
    #[test]
    fn memories_wait_for_numbers() {
        let robot = load_robot("quanser-2dof").expect("built in");
        let arm: Fjr<_, PlanarTwoLink<f64>, 2> = fjr(&robot, &robot.links, |x| x, &|x| x).expect(OF_THE_KIND);
        let controller = Controller::default_for("disturbance-rejecting", &robot).expect("registered");
        let law = any_law(&controller, &robot, &|x| x);
        let at = |before: Option<&Remembered<2>>, t: f64, q: f64, given: f64| {
            let (x, q_ld) = (Motion::at_rest(Vector([q; 2])), Vector([Jet::ZERO; 2]));
            Remembered::at(&law, &arm, before, t, (&x, &q_ld), Vector([given; 2]))
        };
        assert!(at(None, 0.0, f64::NAN, 0.0).is_none());
        let mut first = at(None, 0.001, 0.1, 0.0).expect("a number now");
        first.ask(Vector([f64::NAN; 2]));
        for (q, given) in [(f64::NAN, 0.0), (0.1, f64::NAN)] {
            let waiting = at(Some(&first), 0.002, q, given).expect("what it was");
            assert_eq!((waiting.z, waiting.t), (first.z, first.t));
            let later = at(Some(&waiting), 0.003, 0.1, 0.0).expect("a number again");
            assert!(later.t > first.t && later.z.iter().all(is_number));
        }
    }
}
