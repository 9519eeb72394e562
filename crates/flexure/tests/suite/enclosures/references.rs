//! References of scenarios, with four derivatives.

use flexure::core::reference::Reference as _;
use flexure::core::scalar::{Interval, Jet};
use flexure::feasible;
use flexure::files::SCENARIOS;
use flexure::references::{AnyPath, AnyReference};
use flexure::references::{
    PointToPoint, Profile, Reference, Sampled, Sines, SmoothStart, Speed, Term, TimeScaling,
};
use flexure::scenario::Scenario;
use flexure::scenario::load_scenario;

use super::encloses;

/// Times before, in and after smooth starts and motions \[s\].
const TIMES: [f64; 6] = [0.0, 0.3, 1.0, 1.9, 2.5, 7.3];

/// The reference and four derivatives at some times. Derivatives of a start in 2 s grow by 15 an order and round alike;
/// its first accelerations are those of springs of 14000 N m/rad on 0.0065 kg m², where an ulp of a position is 1e-10 rad/s².
fn check<const N: usize>(scenario: &Scenario) {
    let name = &scenario.name;
    let floats = feasible::reference::<N>(scenario).expect("a path");
    let enclosed = feasible::enclosed_reference::<N>(scenario).expect("a path");
    for t in TIMES {
        let (jets, bounds) = (floats.at::<5>(t), enclosed.at::<5>(Interval::point(t)));
        for (jet, bounds) in jets.iter().zip(bounds.iter()) {
            for k in 0..5 {
                let (x, scale) = (jet.derivative(k), 15_f64.powi(i32::try_from(k).expect("small")));
                encloses(
                    bounds.derivative(k),
                    x,
                    1e-14 * scale,
                    1e-10 * scale,
                    &format!("{name}, order {k} at {t} s"),
                );
            }
        }
    }
}

#[test]
fn references_of_all_scenarios_are_enclosed() {
    for (name, _) in SCENARIOS {
        let scenario = load_scenario(name).expect("built in");
        match scenario.robot.joint_count() {
            1 => check::<1>(&scenario),
            2 => check::<2>(&scenario),
            3 => check::<3>(&scenario),
            7 => check::<7>(&scenario),
            n => panic!("{name} has {n} joints"),
        }
    }
}

#[test]
fn motions_from_rest_to_rest_are_enclosed() {
    for profile in [Profile::Quintic, Profile::Septic, Profile::Nonic] {
        let mut scenario = load_scenario("pendulum-tanh").expect("built in");
        scenario.smooth_start = None;
        scenario.reference = Reference::PointToPoint(PointToPoint {
            profile,
            from: vec![0.1],
            to: vec![1.1],
            start: 0.7,
            duration: 2.3,
        });
        check::<1>(&scenario);
    }
}

/// Paths along other clocks, and starts from a robot in motion.
#[test]
fn other_clocks_and_moving_starts_are_enclosed() {
    let mut scenario = load_scenario("two-link-tanh").expect("built in");
    for rise in [None, Some(1.5)] {
        scenario.time_scaling = Some(TimeScaling { speed: Speed::Given(0.3), rise });
        check::<2>(&scenario);
    }
    scenario.smooth_start = Some(SmoothStart { duration: 2.0, settle: 0.2 });
    (scenario.initial.q_m, scenario.initial.dq_l) = (vec![0.02, -0.01], vec![0.3, -0.2]);
    check::<2>(&scenario);
}

/// Every number of the scenario is a tenth, and so is every number of its reference: the interval below the float.
#[test]
fn every_number_of_a_reference_is_its_decimal() {
    let mut scenario = load_scenario("pendulum-tanh").expect("built in");
    let tenth = || vec![0.1];
    let term = || Term { amplitude: tenth(), frequency: tenth(), phase: tenth() };
    (scenario.smooth_start, scenario.initial.q_l) = (Some(SmoothStart::within(0.1)), tenth());
    let mut numbers = Vec::new();
    for terms in [vec![term()], vec![term(), term()]] {
        scenario.reference = Reference::Sines(Sines { offset: tenth(), terms });
        let Ok(AnyReference::<Interval, 1>::SmoothStart(start)) = feasible::enclosed_reference(&scenario)
        else {
            panic!()
        };
        numbers.extend([start.from.from[0].coefficient(0), start.from.duration, start.duration]);
        match start.then {
            AnyReference::Path(AnyPath::Sines(sines)) => {
                let terms = sines.terms.iter().flat_map(|term| [term.amplitude, term.frequency, term.phase]);
                numbers.extend(terms.chain([sines.offset]).map(|x| x[0]));
            }
            other => panic!("{other:?}"),
        }
    }
    let (from, to, profile) = (tenth(), tenth(), Profile::Nonic);
    scenario.reference =
        Reference::PointToPoint(PointToPoint { profile, from, to, start: 0.1, duration: 0.1 });
    scenario.smooth_start = None;
    let Ok(AnyReference::<Interval, 1>::Path(AnyPath::PointToPoint(motion))) =
        feasible::enclosed_reference(&scenario)
    else {
        panic!()
    };
    numbers.extend([motion.from[0], motion.to[0], motion.start, motion.duration]);
    assert_eq!(numbers.len(), 7 + 10 + 4);
    for x in numbers {
        assert_eq!((x.lo(), x.hi()), (0.1_f64.next_down(), 0.1));
    }
}

/// A path of ten samples, 0.4 s apart.
fn sampled() -> Scenario {
    let mut scenario = load_scenario("pendulum-tanh").expect("built in");
    scenario.smooth_start = None;
    let t: Vec<f64> = (0..10).map(|i| 0.4 * f64::from(i)).collect();
    let q = t.iter().map(|t| vec![0.1 + (1.3 * t).sin()]).collect();
    scenario.reference = Reference::Sampled(Sampled { t, q });
    scenario
}

/// The path is the spline of floats: only evaluating it rounds.
#[test]
fn a_sampled_path_is_enclosed_at_instants_and_on_knots() {
    let scenario = sampled();
    let floats = feasible::reference::<1>(&scenario).expect("a path");
    let enclosed = feasible::enclosed_reference::<1>(&scenario).expect("a path");
    for i in -2..24_i32 {
        let t = 0.2 * f64::from(i);
        let ([jet], [bounds]) = (floats.at::<5>(t).0, enclosed.at::<5>(Interval::point(t)).0);
        for k in 0..5 {
            encloses(bounds.derivative(k), jet.derivative(k), 1e-10, 1e-9, &format!("order {k} at {t} s"));
        }
    }
}

/// Over a span of time that meets several segments, every instant is enclosed, by `at` as by `on`.
#[test]
fn a_sampled_path_is_enclosed_over_spans() {
    let scenario = sampled();
    let floats = feasible::reference::<1>(&scenario).expect("a path");
    let enclosed = feasible::enclosed_reference::<1>(&scenario).expect("a path");
    for (from, to) in [(-0.5, 0.1), (0.35, 0.45), (0.4, 0.8), (0.3, 1.3), (3.5, 4.5), (5.0, 6.0), (-1.0, 9.0)]
    {
        let span = Interval::new(from, to).expect("ordered");
        let ([at], [on]) = (enclosed.at::<5>(span).0, enclosed.on(span).0);
        assert_eq!([at], enclosed.on(Jet::variable(span)).0, "the segments that are left out play no part");
        for i in 0..=20 {
            let [jet] = floats.at::<5>(from + (to - from) * f64::from(i) / 20.0).0;
            assert!(on.contains(jet.derivative(0)), "{from} to {to}: {on:?}");
            for k in 0..5 {
                assert!(at.derivative(k).contains(jet.derivative(k)), "order {k}, {from} to {to}: {at:?}");
            }
        }
    }
}
