//! The law on intervals encloses the law on every point inside; the law on lanes is the law lane by lane.

use flexure_core::control::{Input, Linear, LinkGains, Metric, MotorGains, Shaping, Tanh, Vcbc};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::robots::PlanarTwoLink;
use flexure_core::scalar::{Interval, Jet, Lanes, Over, Scalar};

use crate::common::{Numbers, branched};

/// A robot and a tanh law with the same constants in any leaf type.
fn robot<C: Scalar, L: Links<C, N>, const N: usize>(links: L) -> Fjr<C, L, N> {
    let all = |x: f64| Vector::from_fn(|i| C::from_f64(x * (1.0 + 0.25 * i as f64)));
    Fjr {
        links,
        motor_inertia: all(0.25),
        stiffness: all(512.0),
        link_damping: all(0.5),
        motor_damping: all(0.75),
    }
}

fn law<C: Scalar, P, const N: usize>(shaping: impl Fn(Vector<C, N>) -> P) -> Vcbc<C, P, P, N> {
    let all = |x: f64| Vector::from_fn(|i| C::from_f64(x * (1.0 + 0.125 * i as f64)));
    Vcbc {
        link: LinkGains {
            metric: Metric::Constant(all(32.0)),
            shaping: shaping(all(8.0)),
            damping: all(16.0),
        },
        motor: MotorGains { metric: all(64.0), shaping: shaping(all(10.0)), damping: all(4.0) },
    }
}

fn reference<T: Over<C>, C, const N: usize>(t: T) -> Vector<Jet<T, 5>, N> {
    Vector([Jet::variable(t).sin(); N])
}

/// The torque for a box of states of half-width `radius`, and for random points inside it.
fn encloses<L, LI, P, PI, const N: usize>(
    links: L,
    bounds: LI,
    phi: impl Fn(Vector<f64, N>) -> P,
    phi_i: impl Fn(Vector<Interval, N>) -> PI,
    radius: f64,
) where
    L: Links<f64, N>,
    LI: Links<Interval, N>,
    P: Shaping<f64, N>,
    PI: Shaping<Interval, N>,
{
    let mut r = Numbers(11);
    let (point_robot, point_law) = (robot::<f64, _, N>(links), law(phi));
    let (box_robot, box_law) = (robot::<Interval, _, N>(bounds), law(phi_i));
    for _ in 0..20 {
        let centre = r.motion::<N>(1.0);
        let region = centre.map(|x| Interval::new(x - radius, x + radius).expect("ordered"));
        let bound = box_law.command(
            &box_robot,
            &region,
            &reference::<Interval, Interval, N>(Interval::point(0.3)),
            &Input::ZERO,
        );
        for _ in 0..20 {
            let x = Motion {
                q_l: centre.q_l + r.vector(radius),
                q_m: centre.q_m + r.vector(radius),
                v_l: centre.v_l + r.vector(radius),
                v_m: centre.v_m + r.vector(radius),
            };
            let command = point_law.command(&point_robot, &x, &reference::<f64, f64, N>(0.3), &Input::ZERO);
            for k in 0..N {
                assert!(
                    bound.u_m[k].contains(command.u_m[k]),
                    "{} outside {:?}",
                    command.u_m[k],
                    bound.u_m[k]
                );
                // A bound that says nothing would pass the line above.
                assert!(bound.u_m[k].width().is_finite(), "{:?}", bound.u_m[k]);
            }
        }
    }
}

#[test]
fn intervals_enclose_the_law() {
    let (m, l, c, i) = ([1.5, 0.875], 0.34375, [0.15625, 0.0625], [0.0390625, 0.0078125]);
    let point = Interval::point;
    let closed = PlanarTwoLink::new(m, l, c, i);
    let bounds = PlanarTwoLink::new(m.map(point), point(l), c.map(point), i.map(point));
    encloses(closed, bounds, |gain| Tanh { gain }, |gain| Tanh { gain }, 1e-3);
    let tree = branched::<3>(5);
    encloses(tree, tree.map(point), |gain| Linear { gain }, |gain| Linear { gain }, 1e-6);
}

#[test]
fn lanes_are_four_robots_side_by_side() {
    let tree = branched::<4>(7);
    let (robot, law) = (robot::<f64, _, 4>(tree), law(|gain| Tanh { gain }));
    let mut r = Numbers(12);
    for _ in 0..50 {
        let states: [Motion<f64, 4>; 4] = std::array::from_fn(|_| r.motion(1.0));
        let pack = |part: fn(&Motion<f64, 4>) -> Vector<f64, 4>| {
            Vector::from_fn(|i| Lanes::<f64, 4>::from_array(states.each_ref().map(|x| part(x)[i])))
        };
        let batch =
            Motion { q_l: pack(|x| x.q_l), q_m: pack(|x| x.q_m), v_l: pack(|x| x.v_l), v_m: pack(|x| x.v_m) };
        let t = Lanes::splat(0.3);
        let together = law.command(&robot, &batch, &reference::<_, f64, 4>(t), &Input::ZERO);
        for (lane, x) in states.iter().enumerate() {
            let alone = law.command(&robot, x, &reference::<f64, f64, 4>(0.3), &Input::ZERO);
            let scale = alone.u_m.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
            for k in 0..4 {
                let got = together.u_m[k].to_array()[lane];
                // Sines differ by 2 ulp and tanh by 6; torques amplify that by gains over compliance, about 1e3.
                assert!((got - alone.u_m[k]).abs() < 1e-11 * scale, "{got} against {}", alone.u_m[k]);
            }
        }
    }
}
