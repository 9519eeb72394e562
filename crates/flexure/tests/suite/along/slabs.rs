//! Slabs one by one: signed ranges, whatever their width.

use flexure::core::linalg::Vector;
use flexure::core::model::{Fjr, Links as _};
use flexure::core::robots::PlanarTwoLink;
use flexure::core::scalar::{Interval, Scalar as _};
use flexure::feasible;
use flexure::laws::{AnyShaping, law_over};
use flexure::prove::engine::envelope::closed_loop::Enclosed;
use flexure::prove::engine::envelope::slab::Slab;
use flexure::prove::engine::envelope::tube::{ErrorTube, Tube};
use flexure::references::{AnyReference, PointToPoint, Profile, Reference};
use flexure::robot::Links;
use flexure::scenario::{Scenario, load_scenario};

use super::floats;
use crate::common::Random;

pub type Arm = Enclosed<
    PlanarTwoLink<Interval>,
    AnyShaping<Interval, 2>,
    AnyShaping<Interval, 2>,
    AnyReference<Interval, 2>,
    2,
>;

/// The two-link arm, without the visitor, which would compile the law ten times.
pub fn enclosed(scenario: &Scenario) -> Arm {
    let data = &scenario.robot;
    let Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { mass, length, com, inertia }) = data.enclosed
    else {
        panic!("two links")
    };
    let drive = |values: &[f64]| Vector([values[0], values[1]].map(|x| data.bounds(x)));
    let robot = Fjr {
        links: PlanarTwoLink::new(mass, length[0], com, inertia),
        motor_inertia: drive(&data.motor_inertia),
        stiffness: drive(&data.stiffness),
        link_damping: drive(&data.link_damping),
        motor_damping: drive(&data.motor_damping),
    };
    let reference = feasible::enclosed_reference(scenario).unwrap();
    let [breaks, kinks] = [reference.breaks(), reference.kinks()];
    let alone = |link: usize| {
        let only = |values: [Interval; 2]| {
            std::array::from_fn(|i| if i == link { values[i] } else { Interval::ZERO })
        };
        PlanarTwoLink::new(only(mass), length[0], com, only(inertia))
    };
    Enclosed {
        robot,
        alone: vec![alone(0), alone(1)],
        law: law_over(scenario.vcbc().unwrap(), |x| scenario.bounds(x)),
        reference,
        breaks,
        kinks,
    }
}

/// Random slabs of `scenario`: what the law says on the reference at their ends, within, and around it.
fn contained(scenario: &Scenario, widths: &[f64]) {
    let (system, floats) = (enclosed(scenario), floats::arm(scenario));
    let mut r = Random(3);
    for &width in widths {
        for level in [1e-18, 1e-8] {
            for _ in 0..60 {
                let from = 0.5 * (scenario.duration - width) * (1.0 + r.next());
                let slab = Slab::new(&system, level, Interval::new(from, from + width).unwrap());
                for k in 0..12 {
                    let t = match k {
                        0 => from,
                        1 => from + width,
                        _ => (from + 0.5 * width * (1.0 + r.next())).clamp(from, from + width),
                    };
                    let x = floats.sample(t, level * (1.0 - 1e-9), &mut r);
                    let values = floats.values(t, &x).quantities;
                    for (range, value) in slab.ranges.iter().zip(values) {
                        // Rounding of the law in floats: 1e-16 of terms of 1e4 and more.
                        let slack = 1e-9 * value.abs().max(1.0);
                        let inside = range.lo() - slack <= value && value <= range.hi() + slack;
                        assert!(inside, "{value} not in {range:?} at {t} of {:?}", slab.time);
                    }
                }
            }
        }
    }
}

#[test]
fn slabs_contain_what_the_law_says() {
    contained(&load_scenario("two-link-tanh-smooth").unwrap(), &[0.3, 0.03, 0.003]);
    contained(&load_scenario("two-link-coupled-tanh-smooth").unwrap(), &[0.03]);
}

#[test]
fn slabs_with_jumps_contain_both_sides() {
    let mut scenario = load_scenario("two-link-tanh-smooth").unwrap();
    (scenario.smooth_start, scenario.duration) = (None, 1.0);
    let (from, to) = (vec![0.0, 0.0], vec![1.0, -0.5]);
    scenario.reference = Reference::PointToPoint(PointToPoint {
        profile: Profile::Septic,
        from,
        to,
        start: 0.3,
        duration: 0.4,
    });
    contained(&scenario, &[0.2, 0.02]);
    // However short: Taylor's theorem does not lead across.
    let (system, floats) = (enclosed(&scenario), floats::arm(&scenario));
    for half in [1e-3, 1e-6] {
        let slab = Slab::new(&system, 1e-18, Interval::new(0.3 - half, 0.3 + half).unwrap());
        for t in [0.3 - half, 0.3 + half] {
            let values = floats.values(t, &floats.motion(t, [Vector::ZERO; 4])).quantities;
            assert!(
                slab.ranges.iter().zip(&values).all(|(range, &value)| range.contains(value)),
                "{half} {t}"
            );
        }
    }
}

/// √(2c gᵀ P⁻¹ g) with the mass matrix in floats: the box of a thin tube is all but a point.
#[test]
fn reaches_are_the_dual_norm() {
    let scenario = load_scenario("two-link-tanh-smooth").unwrap();
    let (system, floats) = (enclosed(&scenario), floats::arm(&scenario));
    let mut r = Random(9);
    for _ in 0..100 {
        let q = Vector([3.0 * r.next(), 3.0 * r.next()]);
        let g: [f64; 8] = std::array::from_fn(|_| r.next());
        let tube = ErrorTube::new(&system, 1e-16, &q.0.map(Interval::point));
        let reach = tube.reach(&g.map(Interval::point)).hi();
        let g_l = Vector([g[4], g[5]]);
        let links = g_l.dot(&floats.robot.links.mass_matrix(&q).ldl().solve(&g_l));
        let diagonals = [55.0, 30.0, 70.0, 60.0, f64::INFINITY, f64::INFINITY, 0.23, 0.01];
        let others: f64 = g.iter().zip(diagonals).map(|(g, metric)| g * g / metric).sum();
        let exact = (2e-16 * (links + others)).sqrt();
        assert!((reach / exact - 1.0).abs() < 1e-6 && reach >= exact * (1.0 - 1e-12), "{reach} {exact}");
    }
}
