//! Trees whose constants are intervals: they enclose the tree of floats, and round nothing where nothing need be rounded.

use flexure_core::linalg::Vector;
use flexure_core::model::Links;
use flexure_core::robots::{Body, JointKind, Tree};
use flexure_core::scalar::Interval;

use crate::common::{GRAVITY, IDENTITY, Numbers, branched, branched_bodies};

fn enclosed<const N: usize>(bodies: &[Body; N]) -> Tree<Interval, N> {
    let points = bodies.each_ref().map(|body| body.map(Interval::point));
    Tree::from_bodies(&points, GRAVITY.map(Interval::point), Interval::midpoint).expect("parents come first")
}

/// Every product and sum of these numbers is a float, and so are sine and cosine of zero: only frames could round.
#[test]
fn coordinate_axes_turn_frames_without_rounding() {
    let axes = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let bodies: [Body; 5] = core::array::from_fn(|i| Body {
        parent: i.checked_sub(1),
        kind: if i == 3 { JointKind::Prismatic } else { JointKind::Revolute },
        axis: axes[i],
        rotation: IDENTITY,
        translation: [0.5, -0.25, 0.125],
        mass: 2.0,
        com: [0.125, 0.25, -0.5],
        inertia: [[0.5, 0.125, 0.0], [0.125, 0.75, 0.25], [0.0, 0.25, 1.0]],
    });
    let mass = enclosed(&bodies).mass_matrix(&Vector([Interval::point(0.0); 5]));
    let floats = Tree::new(&bodies, GRAVITY).expect("a chain").mass_matrix(&Vector([0.0; 5]));
    for (bounds, x) in mass.0.iter().flatten().zip(floats.0.iter().flatten()) {
        assert_eq!((bounds.lo(), bounds.hi()), (*x, *x));
    }
}

/// Which coordinate axis a frame starts from is no physics: one chosen by rough numbers gives the same mass matrix.
#[test]
fn the_choice_of_frames_does_not_show() {
    let bodies: [Body; 6] = branched_bodies(21);
    let rough = Tree::from_bodies(&bodies, GRAVITY, |x| (2.0 * x).round()).expect("ordered");
    let q = Numbers(22).vector(2.0);
    let (a, b) = (branched::<6>(21).mass_matrix(&q), rough.mass_matrix(&q));
    for (a, b) in a.0.iter().flatten().zip(b.0.iter().flatten()) {
        assert!((a - b).abs() < 1e-12, "{a} against {b}");
    }
}

/// Interval constants enclose what is exact, from which the floats are some hundred roundings away.
#[test]
fn intervals_enclose_the_tree_of_floats() {
    let tree = enclosed(&branched_bodies::<6>(23));
    let mut r = Numbers(24);
    for _ in 0..20 {
        let q: Vector<f64, 6> = r.vector(2.0);
        let (bounds, floats) = (tree.mass_matrix(&q.map(Interval::point)), branched::<6>(23).mass_matrix(&q));
        for (bounds, x) in bounds.0.iter().flatten().zip(floats.0.iter().flatten()) {
            assert!(bounds.width() < 1e-11, "{bounds:?}");
            assert!(bounds.lo() - 1e-13 <= *x && *x <= bounds.hi() + 1e-13, "{x} outside {bounds:?}");
        }
    }
}
