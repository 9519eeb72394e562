//! The closed form that is proved about is what the code of the law gives.

use flexure::prove::engine::direct::law_agreement;
use flexure_core::control::{Shaping, Vcbc};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::{Interval, Jet};

use super::arm::{coupled_tanh, law, linear, robot, tanh};
use super::soundness::{around_links, tree};
use crate::common::Random;

fn vector<const N: usize>(r: &mut Random, scale: f64) -> Vector<Interval, N> {
    Vector::from_fn(|_| Interval::point(scale * r.next()))
}

/// Five states; the widest entry allowed, in units of the rate.
fn agrees<L, P, const N: usize>(robot: &Fjr<Interval, L, N>, law: &Vcbc<Interval, P, P, N>, width: f64)
where
    L: Links<Interval, N>,
    P: Shaping<Interval, N>,
{
    let mut r = Random(3);
    for _ in 0..5 {
        let mut motion = || Motion {
            q_l: vector(&mut r, 1.5),
            q_m: vector(&mut r, 1.5),
            v_l: vector(&mut r, 1.5),
            v_m: vector(&mut r, 1.5),
        };
        let (x_v, x) = (motion(), motion());
        let q_ld = Vector::from_fn(|_| Jet::from_fn(|_| Interval::point(0.5 * r.next())));
        let agreement = law_agreement(robot, law, &x_v, &x, &q_ld, &vector(&mut r, 20.0));
        println!("{agreement:?}");
        assert!(agreement.disjoint == 0 && agreement.width < width, "{agreement:?}");
    }
}

#[test]
fn law_and_closed_form() {
    agrees(&robot(), &law(tanh), 1e-5);
    agrees(&robot(), &law(linear), 1e-5);
    agrees(&robot(), &law(coupled_tanh), 1e-5);
    let tree = around_links::<Interval, _, 3>(tree::<3>().map(Interval::point), false);
    agrees(&tree.robot, &tree.law, 1e-5);
}
