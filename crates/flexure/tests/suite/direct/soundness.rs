//! Interval matrices contain those of points, and what was not shown is not claimed.

use flexure::linalg::Symmetric;
use flexure::prove::engine::direct::Balance;
use flexure::prove::engine::direct::{Coordinate, Flow, System, Twins, best_rate, prove, vcbc};
use flexure::prove::engine::direct::{StateBox, VcbcLoop};
use flexure::prove::engine::verdict::Verdict;
use flexure_core::control::{LinkGains, Metric, MotorGains, Tanh, Vcbc};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links};
use flexure_core::robots::{Body, JointKind, Tree};
use flexure_core::scalar::{Interval, Over, Scalar};

use super::arm::{around, coupled_tanh, flow, linear, region, tanh};
use crate::common::Random;

/// A chain of unlike joints about unlike axes.
pub fn tree<const N: usize>() -> Tree<f64, N> {
    let bodies = std::array::from_fn(|i| Body {
        parent: i.checked_sub(if i == 2 { 2 } else { 1 }),
        kind: if i == 1 { JointKind::Prismatic } else { JointKind::Revolute },
        axis: [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]][i % 3],
        rotation: [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        translation: [0.25, 0.125, 0.0625],
        mass: 2.0,
        com: [0.0625, 0.03125, 0.125],
        inertia: [[0.25, 0.0, 0.03125], [0.0, 0.125, 0.0], [0.03125, 0.0, 0.25]],
    });
    Tree::new(&bodies, [0.0, 0.0, -9.75]).expect("parents come first")
}

/// `links` with motors and a tanh law, all constants floats.
pub fn around_links<C: Scalar + Over<C>, L: Links<C, N>, const N: usize>(
    links: L,
    hardening: bool,
) -> VcbcLoop<C, L, Tanh<C, N>, Tanh<C, N>, N> {
    let all = |x: f64| Vector::from_fn(|i| C::from_f64(x * (1.0 + 0.125 * i as f64)));
    let metric = if hardening {
        Metric::Hardening { base: all(32.0), hardening: all(4.0) }
    } else {
        Metric::Constant(all(32.0))
    };
    VcbcLoop {
        robot: Fjr {
            links,
            motor_inertia: all(0.25),
            stiffness: all(64.0),
            link_damping: all(0.5),
            motor_damping: all(0.75),
        },
        law: Vcbc {
            link: LinkGains { metric, shaping: Tanh { gain: all(8.0) }, damping: all(16.0) },
            motor: MotorGains { metric: all(64.0), shaping: Tanh { gain: all(10.0) }, damping: all(4.0) },
        },
    }
}

/// Entries of `point` lie in those of `bounds`, up to rounding in `f64` of a few hundred operations.
fn inside(bounds: &Balance<Interval>, point: &Balance<f64>) {
    for (bounds, point) in [(&bounds.dissipation, &point.dissipation), (&bounds.weight, &point.weight)] {
        for i in 0..point.size() {
            for j in 0..=i {
                let (x, entry) = (point.at(i, j), bounds.at(i, j));
                let slack = 1e-12 * (1.0 + x.abs());
                assert!(
                    entry.lo() - slack <= x && x <= entry.hi() + slack,
                    "({i}, {j}): {x} outside {entry:?}"
                );
            }
        }
    }
}

/// Random boxes in ±2, points at random inside.
fn encloses(flow: &dyn Flow, radius: f64) {
    let mut r = Random(5);
    let size = flow.coordinates().len();
    for _ in 0..40 {
        let radii: Vec<f64> = (0..size).map(|_| radius * r.next().abs()).collect();
        let at: Vec<Interval> = radii.iter().map(|&radius| around(2.0 * r.next(), radius)).collect();
        let bounds = flow.enclosure(&at);
        let widest = (0..bounds.dissipation.size()).map(|i| bounds.dissipation.at(i, i).width());
        assert!(widest.fold(0.0, f64::max).is_finite(), "a bound that says nothing");
        for _ in 0..20 {
            let point: Vec<f64> = at
                .iter()
                .zip(&radii)
                .map(|(x, radius)| (x.midpoint() + radius * r.next()).clamp(x.lo(), x.hi()))
                .collect();
            inside(&bounds, &flow.value(&point));
        }
    }
}

#[test]
fn matrices_of_boxes_contain_those_of_points() {
    for radius in [1.0, 0.1, 1e-6] {
        encloses(&flow(tanh, tanh, &region()), radius);
        encloses(&flow(linear, linear, &region()), radius);
        encloses(&flow(coupled_tanh, coupled_tanh, &region()), radius);
        let links = tree::<3>();
        let region = StateBox::within(1.0);
        for hardening in [false, true] {
            let bounds = around_links(links.map(Interval::point), hardening);
            encloses(&vcbc(bounds, around_links(links, hardening), &region), radius);
        }
    }
}

/// Ẇ in closed form and by finite differences of W along the motion: an error in any term of the balance shows, and so would a rate that depends
/// on how fast the links move, which the balance does not know. The metric hardens and the mass matrix moves.
#[test]
fn the_balance_is_the_rate_of_the_storage() {
    let links = tree::<3>();
    let system = around_links::<f64, _, 3>(links, true);
    let flow = vcbc(around_links(links.map(Interval::point), true), system.clone(), &StateBox::within(1.0));
    let mut r = Random(9);
    for _ in 0..20 {
        let at: Vec<f64> = (0..15).map(|_| r.next()).collect();
        let v_l = Vector::from_fn(|_| 3.0 * r.next());
        let delta: Vec<f64> = (0..12).map(|_| r.next()).collect();
        let exact = -flow.value(&at).dissipation.value(&delta);
        let got = numerical::storage_rate(&system, &at, &v_l, &delta);
        assert!((exact - got).abs() < 1e-6 * (1.0 + exact.abs()), "{exact} against {got}");
    }
}

/// Ẇ without the engine: the core's closed loop in momenta, stepped in time.
mod numerical {
    use flexure::prove::engine::direct::VcbcLoop;
    use flexure_core::control::{Input, Shaping};
    use flexure_core::linalg::Vector;
    use flexure_core::model::{Links, MassFactor, Motion};
    use flexure_core::virtual_system::{ErrorState, closed_loop};

    fn blocks<const N: usize>(x: &[f64], k: usize) -> Vector<f64, N> {
        Vector::from_fn(|i| x[k * N + i])
    }

    fn plus<const N: usize>(x: &ErrorState<f64, N>, d: &ErrorState<f64, N>, h: f64) -> ErrorState<f64, N> {
        ErrorState {
            e_l: x.e_l + d.e_l.scaled(h),
            e_m: x.e_m + d.e_m.scaled(h),
            sigma_l: x.sigma_l + d.sigma_l.scaled(h),
            sigma_m: x.sigma_m + d.sigma_m.scaled(h),
        }
    }

    pub fn storage_rate<L: Links<f64, N>, P: Shaping<f64, N>, const N: usize>(
        system: &VcbcLoop<f64, L, P, P, N>,
        at: &[f64],
        v_l: &Vector<f64, N>,
        delta: &[f64],
    ) -> f64 {
        let VcbcLoop { robot, law } = system;
        let (q_l, v_l) = (blocks::<N>(at, 4), *v_l);
        let momenta = |x: &[f64]| ErrorState {
            e_l: blocks(x, 0),
            e_m: blocks(x, 1),
            sigma_l: robot.links.mass_mul(&q_l, &blocks(x, 2)),
            sigma_m: robot.motor_inertia.diag_mul(&blocks(x, 3)),
        };
        let (error, delta) = (momenta(at), momenta(delta));
        let motion = Motion { q_l, q_m: q_l, v_l, v_m: v_l };
        let rate = |error: &ErrorState<f64, N>| closed_loop(robot, law, error, &motion, &Input::ZERO);
        let h = 1e-5;
        let (ahead, behind) = (rate(&plus(&error, &delta, h)), rate(&plus(&error, &delta, -h)));
        let delta_rate = plus(&ahead, &behind, -1.0);
        let error_rate = rate(&error);
        let storage = |t: f64| {
            let error = plus(&error, &error_rate, t);
            let delta = plus(&delta, &delta_rate, t / (2.0 * h));
            let s_l = robot.links.factor(&(q_l + v_l.scaled(t))).solve(&delta.sigma_l);
            let s_m = Vector::from_fn(|i| delta.sigma_m[i] / robot.motor_inertia[i]);
            let metric = law.link.metric.at(&error.e_l);
            0.5 * (delta.e_l.dot(&metric.diag_mul(&delta.e_l))
                + delta.e_m.dot(&law.motor.metric.diag_mul(&delta.e_m))
                + delta.sigma_l.dot(&s_l)
                + delta.sigma_m.dot(&s_m))
        };
        (storage(h) - storage(-h)) / (2.0 * h)
    }
}

/// A metric that moves with the error needs bounds of the velocity error, and is proved with them.
#[test]
fn hardening_metric() {
    let links = tree::<2>();
    let flow = |region: &StateBox<2>| {
        vcbc(around_links(links.map(Interval::point), true), around_links(links, true), region)
    };
    let small = StateBox::<2> { velocity_error_l: [around(0.0, 0.125); 2], ..StateBox::within(0.125) };
    let small = StateBox { position: [around(0.5, 0.0625); 2], ..small };
    let verdict = best_rate(&flow(&small), 5_000);
    println!("hardening: {verdict:?}");
    let best = verdict.proved().expect("a small region");
    assert!(best.rate > 0.98 * best.upper, "{best:?}");
    let unbounded = StateBox { velocity_error_l: [Interval::ENTIRE; 2], ..small };
    let verdict = prove(&flow(&unbounded), 0.1, 500);
    assert!(verdict.proved().is_none(), "{verdict:?}");
}

/// One variable whose rate is 1 but for a dip of width 1e-4 at `place`, where W grows.
struct Dip {
    place: f64,
}

impl<C: Scalar> System<C> for Dip {
    fn balance(&self, at: &[C]) -> Balance<C> {
        let far = (at[0] - C::from_f64(self.place)) * C::from_f64(1e4);
        let dip = C::from_f64(1.5) * (-far.square()).exp();
        Balance {
            dissipation: Symmetric::from_fn(1, |_, _| C::ONE - dip),
            weight: Symmetric::from_fn(1, |_, _| C::ONE),
        }
    }
}

/// What no sample sees, the boxes do, wherever it is.
#[test]
fn a_dip_between_the_samples() {
    let mut r = Random(21);
    for _ in 0..50 {
        let place = 0.999 * r.next();
        let coordinates = vec![Coordinate { name: "x".to_owned(), unit: "rad", range: around(0.0, 1.0) }];
        let flow = Twins { bounds: Dip { place }, point: Dip { place }, coordinates };
        for beta in [0.5, 0.01] {
            let Verdict::Refuted(witness) = prove(&flow, beta, 1_000) else { panic!("{place}") };
            assert!((witness.at.get("x").expect("one coordinate") - place).abs() < 2e-4, "{witness:?}");
        }
        // The true rate at the bottom of the dip.
        let best = best_rate(&flow, 1_000);
        assert_eq!(best.word(), "refuted", "{best:?}");
    }
}

/// Seven joints: whatever the verdict, it comes within the budget.
#[test]
fn seven_joints() {
    let links = tree::<7>();
    let tiny = StateBox::<7> { position: [around(0.3, 1e-3); 7], ..StateBox::within(0.1) };
    let flow = |region: &StateBox<7>| {
        vcbc(around_links(links.map(Interval::point), false), around_links(links, false), region)
    };
    let start = std::time::Instant::now();
    let verdict = prove(&flow(&tiny), 1.0, 20);
    println!("seven joints, tiny: {verdict:?} in {:?}", start.elapsed());
    assert!(matches!(&verdict, Verdict::Proved(proved) if proved.boxes <= 20), "{verdict:?}");
    let verdict = prove(&flow(&StateBox::within(3.0)), 1e-3, 3);
    assert!(matches!(&verdict, Verdict::Undecided(undecided) if undecided.spent == 3), "{verdict:?}");
    println!("seven joints, all: {verdict:?} in {:?}", start.elapsed());
}

/// Nothing is claimed of no budget, nor of rates that are none.
#[test]
fn nothing_for_nothing() {
    let flow = flow(tanh, tanh, &region());
    assert_eq!(prove(&flow, 0.1, 0).word(), "undecided");
    assert_eq!(best_rate(&flow, 0).word(), "undecided");
    for rate in [f64::NAN, f64::INFINITY] {
        assert!(prove(&flow, rate, 10).proved().is_none());
    }
}
