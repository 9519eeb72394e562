//! Laws read what they say they read, no less and no more.

use flexure_core::control::{Applied, ControlLaw, DynamicLaw, Signals};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::Jet;

use crate::all::{Visitor, every};
use crate::common::{Numbers, branched, flexible, serial};

struct Poisoned<L, const N: usize> {
    robot: Fjr<f64, L, N>,
    x: Motion<f64, N>,
    q_ld: Vector<Jet<f64, 5>, N>,
}

/// The parts of a motion, each with whether it is read.
fn parts<const N: usize>(x: &mut Motion<f64, N>, reads: Signals) -> [(&mut Vector<f64, N>, bool); 4] {
    let Motion { q_l, q_m, v_l, v_m } = x;
    [(q_l, reads.q_l), (q_m, reads.q_m), (v_l, reads.v_l), (v_m, reads.v_m)]
}

impl<L, const N: usize> Poisoned<L, N> {
    /// `of` gives the same numbers where everything that is not read is no number, and none where something that is read is none.
    fn check(&self, name: &str, reads: Signals, of: impl Fn(&Motion<f64, N>) -> Vec<f64>) {
        let exact = of(&self.x);
        assert!(exact.iter().all(|x| x.is_finite()), "{name}");
        let mut unread = self.x;
        for (part, read) in parts(&mut unread, reads) {
            if !read {
                *part = Vector([f64::NAN; N]);
            }
        }
        assert_eq!(of(&unread), exact, "{name}");
        for k in 0..4 {
            let mut missing = self.x;
            let [(part, read), ..] = {
                let mut all = parts(&mut missing, reads);
                all.swap(0, k);
                all
            };
            *part = Vector([f64::NAN; N]);
            assert_eq!(of(&missing).iter().any(|x| x.is_nan()), read, "{name}: part {k}");
        }
    }
}

impl<L: Links<f64, N>, const N: usize> Visitor<N> for Poisoned<L, N> {
    fn fixed(&mut self, name: &str, law: &impl ControlLaw<f64, N>) {
        self.check(name, reads_of(law), |x| law.torque(&self.robot, x, &self.q_ld).iter().collect());
    }

    fn dynamic<const K: usize>(&mut self, name: &str, law: &impl DynamicLaw<f64, N, K>) {
        let z = law.start(&self.robot, &self.x, &self.q_ld);
        self.check(name, reads_of_dynamic(law), |x| {
            let torque = law.torque(&self.robot, x, &self.q_ld, &z);
            let rate = law.rate(&self.robot, x, &self.q_ld, &z, &Applied::NOTHING);
            let start = law.start(&self.robot, x, &self.q_ld);
            torque.iter().chain(rate.iter().chain(&start).flat_map(Vector::iter)).collect()
        });
    }
}

fn reads_of<F: ControlLaw<f64, N>, const N: usize>(_: &F) -> Signals {
    F::READS
}

fn reads_of_dynamic<F: DynamicLaw<f64, N, K>, const N: usize, const K: usize>(_: &F) -> Signals {
    F::READS
}

fn on<L: Links<f64, N>, const N: usize>(links: L, r: &mut Numbers) {
    let mut robot = flexible(links, r);
    robot.stiffness = robot.stiffness.scaled(20.0);
    every(&mut Poisoned { robot, x: r.motion(1.0), q_ld: r.series(1.0) }, r);
}

#[test]
fn laws_read_what_they_say() {
    let r = &mut Numbers(8);
    on(branched::<5>(2), r);
    on(serial::<7>(), r);
}
