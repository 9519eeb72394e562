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
    pub asked: Vector<f64, N>,
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
    /// the motors were `given` since [N m]. It starts again where it would become no number.
    pub fn at<L: Links<f64, N>, F: Feedback<L, N>>(
        law: &F,
        robot: &Fjr<f64, L, N>,
        before: Option<&Self>,
        t: f64,
        (x, q_ld): (&Motion<f64, N>, &Vector<Jet<f64, 5>, N>),
        given: Vector<f64, N>,
    ) -> Self {
        let seen = Seen { x: *x, q_ld: *q_ld };
        let z = match before {
            None => law.start(robot, x, q_ld),
            Some(before) => {
                let applied = Applied { asked: before.asked, given };
                law.advanced(robot, [&before.seen, &seen], &before.z, &applied, t - before.t)
            }
        };
        match before {
            // A reading that is no number: the memory waits.
            Some(before) if !z.iter().all(|part| part.iter().all(f64::is_finite)) => *before,
            _ => Self { z, seen, t, asked: given },
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
