//! Verdicts on the limits of a robot.

use std::ops::ControlFlow;

use flexure::core::linalg::Vector;
use flexure::core::model::Motion;
use flexure::progress::unwatched;
use flexure::prove::along::{Limit, along};
use flexure::prove::engine::verdict::Verdict;
use flexure::scenario::load_scenario;

use super::{floats, level};

/// Verdicts on the second joint of the arm, under a limit that is `share` of the way from the largest torque on the
/// reference to the bound.
fn verdict(key: &str, share: f64) -> Limit {
    let mut scenario = load_scenario("two-link-coupled-tanh-smooth").unwrap();
    let level = level(&scenario, 0.01);
    let found = along(&scenario, &level, 600, &unwatched).unwrap().unwrap();
    assert!(found.limits.is_empty());
    let limits = &mut scenario.robot.limits;
    let (peaks, place) = match key {
        "torque_limit" => (&found.torque, &mut limits.torque),
        "deflection_limit" => (&found.deflection, &mut limits.deflection),
        _ => (&found.velocity, &mut limits.velocity),
    };
    place[1] = peaks.nominal[1] + share * (peaks.bound[1] - peaks.nominal[1]);
    let found = along(&scenario, &level, 600, &unwatched).unwrap().unwrap();
    let [limit] = &found.limits[..] else { panic!("{:?}", found.limits) };
    assert_eq!((limit.joint, limit.key), (1, key));
    if let Verdict::Refuted(witness) = &limit.verdict {
        // What plain floats say of it.
        let vector = |x: &[f64]| Vector([x[0], x[1]]);
        let (q_l, q_m) = (vector(&witness.q_l), vector(&witness.q_m));
        let x = Motion { q_l, q_m, v_l: vector(&witness.dq_l), v_m: vector(&witness.dq_m) };
        let values = floats::arm(&scenario).values(witness.t, &x);
        let value = values.quantities[["velocity_limit", "deflection_limit", "torque_limit"]
            .iter()
            .position(|&k| k == key)
            .unwrap()
            * 2
            + 1];
        assert!(value.abs() > limit.limit && values.level <= found.level, "{witness:?}");
    }
    limit.clone()
}

#[test]
fn limits_above_the_bound_are_kept() {
    for key in ["torque_limit", "deflection_limit", "velocity_limit"] {
        let limit = verdict(key, 1.001);
        let Verdict::Proved(bound) = limit.verdict else { panic!("{limit:?}") };
        assert!(bound <= limit.limit);
    }
}

#[test]
fn limits_below_the_reference_are_not() {
    let limit = verdict("torque_limit", -0.001);
    let Verdict::Refuted(witness) = &limit.verdict else { panic!("{limit:?}") };
    assert!(witness.level < 1e-9, "on the reference: {witness:?}");
}

/// A limit that some errors in the tube exceed: the witness is on its surface.
#[test]
fn limits_inside_the_tube_are_refuted_at_its_surface() {
    for (key, share) in [("torque_limit", 0.8), ("deflection_limit", 0.8), ("velocity_limit", 0.8)] {
        let limit = verdict(key, share);
        let Verdict::Refuted(witness) = &limit.verdict else { panic!("{limit:?}") };
        assert!(witness.level > 1e-9, "{witness:?}");
    }
}

/// Just below the bound: proved or not, never wrong.
#[test]
fn limits_near_the_bound_are_not_wrongly_proved() {
    let limit = verdict("torque_limit", 0.999);
    println!("{limit:?}");
    if let Verdict::Proved(bound) = limit.verdict {
        assert!(bound <= limit.limit);
    }
}

/// Bounds that are broken off hold: they are those of fewer slabs, and never below what goes on finds.
#[test]
fn bounds_that_are_broken_off_are_wider() {
    let scenario = load_scenario("two-link-coupled-tanh-smooth").unwrap();
    let level = level(&scenario, 0.01);
    let until = |limit: f64| {
        let watched = |fraction: f64| {
            if fraction < limit { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        along(&scenario, &level, 600, &watched).unwrap()
    };
    assert!(until(0.0).is_none() && until(0.03).is_none(), "the run is not covered");
    let whole = along(&scenario, &level, 600, &unwatched).unwrap().unwrap();
    for part in [0.1, 0.3].map(|limit| until(limit).expect("covered")) {
        let pairs = [(&part.velocity, &whole.velocity), (&part.torque, &whole.torque)];
        for (part, whole) in pairs {
            assert!(
                part.bound.iter().zip(&whole.bound).all(|(part, whole)| part >= whole),
                "{part:?} {whole:?}"
            );
        }
        assert!(part.torque.bound[1] > whole.torque.bound[1], "the rest was worth while");
    }
}
