//! Laws that every reference obeys, and what each promises besides.
#![expect(clippy::float_cmp, reason = "exactness at the ends is the promise under test")]

mod smooth_start;
mod smoothstep;

use flexure_core::linalg::Vector;
use flexure_core::reference::{
    Clock, Multisine, PointToPoint, Reference, Retimed, Sine, SmoothStart, Smoothstep, Stop, Term,
};
use flexure_core::scalar::{Dual, Interval, Jet};

const STEPS: [Smoothstep; 3] = [Smoothstep::Quintic, Smoothstep::Septic, Smoothstep::Nonic];

const SINE: Sine<f64, 2> = Sine {
    offset: Vector([0.3, -1.2]),
    amplitude: Vector([1.0, 0.4]),
    frequency: Vector([1.7, 3.1]),
    phase: Vector([0.2, -0.9]),
};

const TERMS: [Term<f64, 2>; 2] = [
    Term { amplitude: Vector([0.7, 0.2]), frequency: Vector([0.9, 2.0]), phase: Vector([0.0, 1.0]) },
    Term { amplitude: Vector([-0.3, 0.5]), frequency: Vector([2.3, 1.1]), phase: Vector([-2.0, 0.4]) },
];

const MULTISINE: Multisine<f64, [Term<f64, 2>; 2], 2> =
    Multisine { offset: Vector([0.1, 0.9]), terms: TERMS };

/// Departure and duration are dyadic, so that instants on either side of its ends are too.
const fn point_to_point(step: Smoothstep) -> PointToPoint<f64, 2> {
    PointToPoint { from: Vector([0.3, -0.8]), to: Vector([-1.1, 0.7]), start: 0.5, duration: 2.0, step }
}

const FROM: Vector<f64, 2> = Vector([-0.4, 0.6]);

const SMOOTH_START: SmoothStart<f64, Sine<f64, 2>, 2> = SmoothStart {
    from: Stop {
        from: Vector([Jet::new([-0.4, 0.0, 0.0, 0.0]), Jet::new([0.6, 0.0, 0.0, 0.0])]),
        start: 0.0,
        duration: 2.0,
    },
    duration: 2.0,
    then: SINE,
};

/// From a motion with velocity, acceleration and jerk.
const STOP: Stop<f64, 2> = Stop {
    from: Vector([Jet::new([0.3, 1.5, 2.0, 1.5]), Jet::new([-0.6, -1.2, -3.0, -2.0])]),
    start: 0.0,
    duration: 2.0,
};

const MOVING_START: SmoothStart<f64, Sine<f64, 2>, 2> = SmoothStart { from: STOP, duration: 2.5, then: SINE };

const fn retimed<R>(clock: Clock<f64>, path: R) -> Retimed<f64, R> {
    Retimed { clock, path }
}

const FROM_REST: Clock<f64> = Clock::FromRest { speed: 0.7, rise: 2.0 };

/// Where two pieces meet: the time [s] and the last derivative that they share.
type Joint = (f64, usize);

/// A statement about every reference. Methods of `Reference` are generic, so the sweep is a visitor.
trait Law {
    fn check<R: Reference<f64, 2>>(&self, name: &str, q_d: &R, joints: &[Joint]);
}

/// Every reference of the library: one line each.
fn sweep(law: &impl Law) {
    law.check("set point", &Vector([0.3, -0.7]), &[]);
    law.check("sine", &SINE, &[]);
    law.check("multisine", &MULTISINE, &[]);
    law.check("borrowed", &&SINE, &[]);
    for step in STEPS {
        let m = step.smoothness();
        law.check(&format!("point to point, {step:?}"), &point_to_point(step), &[(0.5, m), (2.5, m)]);
    }
    law.check("smooth start", &SMOOTH_START, &[(0.0, 4), (2.0, 4)]);
    law.check("stop", &STOP, &[(0.0, 0), (2.0, 4)]);
    law.check("smooth start in motion", &MOVING_START, &[(0.0, 0), (2.0, 4), (2.5, 4)]);
    law.check("slow sine", &retimed(Clock::Steady { speed: 0.7 }, SINE), &[]);
    law.check("slow start", &retimed(Clock::Steady { speed: 0.5 }, SMOOTH_START), &[(0.0, 4), (4.0, 4)]);
    law.check("sine from rest", &retimed(FROM_REST, SINE), &[(0.0, 4), (2.0, 4)]);
}

/// On either side of all joints and in between, never within 0.03 s of one.
fn instants() -> impl Iterator<Item = f64> {
    (-9..40)
        .map(|i| 0.1 * f64::from(i) + 0.04)
        .filter(|t| [0.0, 0.5, 2.0, 2.5].iter().all(|j| (t - j).abs() > 0.03))
}

fn assert_close(a: f64, b: f64, tolerance: f64, what: &str) {
    assert!((a - b).abs() <= tolerance, "{what}: {a:e} and {b:e} differ by {:e}", (a - b).abs());
}

struct PositionIsTheHeadOfTheJet;

impl Law for PositionIsTheHeadOfTheJet {
    fn check<R: Reference<f64, 2>>(&self, name: &str, q_d: &R, _: &[Joint]) {
        for t in instants() {
            let (jet, longer, position) = (q_d.at::<5>(t), q_d.at::<9>(t), q_d.on(t));
            for i in 0..2 {
                // The same operations in the same order: equal to the bit.
                assert_eq!(jet[i].coefficient(0).to_bits(), position[i].to_bits(), "{name} at {t} s");
                assert_eq!(
                    jet[i],
                    longer[i].truncate(),
                    "{name} at {t} s: more coefficients change the first"
                );
            }
        }
    }
}

#[test]
fn position_is_the_head_of_the_jet() {
    sweep(&PositionIsTheHeadOfTheJet);
}

/// The jet predicts positions nearby, computed without any derivative.
struct JetIsTheTaylorSeries;

impl Law for JetIsTheTaylorSeries {
    fn check<R: Reference<f64, 2>>(&self, name: &str, q_d: &R, joints: &[Joint]) {
        for t in instants() {
            for h in [-0.02, 0.015, 0.03] {
                assert!(joints.iter().all(|(joint, _)| (t - joint) * (t + h - joint) > 0.0));
                let (jet, position) = (q_d.at::<16>(t), q_d.on(t + h));
                for i in 0..2 {
                    let series = (0..16).rev().fold(0.0, |sum, k| sum * h + jet[i].coefficient(k));
                    // Polynomials end before order 16; for sines the remainder is (3.1 h)¹⁶ / 16! < 1e-28. Left is
                    // rounding of t + h and of some 30 operations on numbers below 4: 100 ε.
                    assert_close(series, position[i], 2.5e-14, &format!("{name} at {t} + {h} s, joint {i}"));
                }
            }
        }
    }
}

#[test]
fn jet_is_the_taylor_series() {
    sweep(&JetIsTheTaylorSeries);
}

/// d/dt by dual time, whose rules share nothing with those of jets, is the shifted jet.
struct DualTimeDifferentiatesJets;

impl Law for DualTimeDifferentiatesJets {
    fn check<R: Reference<f64, 2>>(&self, name: &str, q_d: &R, joints: &[Joint]) {
        for t in instants().chain(joints.iter().map(|joint| joint.0)) {
            let dual = q_d.on(Dual::<Jet<f64, 6>, 1>::variable(Jet::variable(t), 0));
            for i in 0..2 {
                let [velocity] = dual[i].gradient;
                for k in 0..5 {
                    let derivative = dual[i].value.derivative(k + 1);
                    // Derivatives of smooth steps reach 3e4 from summands some ten times larger: 100 ε of that.
                    let tolerance = 100.0 * f64::EPSILON * derivative.abs().max(100.0);
                    let what = format!("{name} at {t} s, joint {i}, derivative {}", k + 1);
                    assert_close(velocity.derivative(k), derivative, tolerance, &what);
                }
            }
        }
    }
}

#[test]
fn dual_time_differentiates_jets() {
    sweep(&DualTimeDifferentiatesJets);
}

/// Left and right limits agree up to the promised derivative, and no further.
struct PiecesMeetAsPromised;

impl Law for PiecesMeetAsPromised {
    fn check<R: Reference<f64, 2>>(&self, name: &str, q_d: &R, joints: &[Joint]) {
        for &(t, smoothness) in joints {
            // Two ulps at 2.5 s, exact at every joint.
            let step = 2.0f64.powi(-50);
            let (left, right) = (q_d.at::<9>(t - step), q_d.at::<9>(t + step));
            for i in 0..2 {
                for k in 0..=smoothness {
                    let what = format!("{name} at {t} s, joint {i}, derivative {k}");
                    // The next derivative is at most 1e3 here: it changes this one by 2e-12.
                    assert_close(left[i].derivative(k), right[i].derivative(k), 1e-11, &what);
                }
                let jump = left[i].derivative(smoothness + 1) - right[i].derivative(smoothness + 1);
                assert!(jump.abs() > 1.0, "{name} at {t} s is smoother than promised");
            }
        }
    }
}

#[test]
fn pieces_meet_as_promised() {
    sweep(&PiecesMeetAsPromised);
}

struct NotANumberStaysOne;

impl Law for NotANumberStaysOne {
    fn check<R: Reference<f64, 2>>(&self, name: &str, q_d: &R, _: &[Joint]) {
        let moves = q_d.on(0.0) != q_d.on(1.0);
        assert_eq!(q_d.on(f64::NAN).iter().all(f64::is_nan), moves, "{name}: a time that is not a number");
    }
}

#[test]
fn not_a_number_stays_one() {
    sweep(&NotANumberStaysOne);
}

/// Polynomials evaluated at a straight line in time take no products of jets: they are those of any jet but for rounding.
#[test]
fn straight_lines_are_jets_like_any_other() {
    for t in instants().chain([0.0, 0.5, 2.0, 2.5]) {
        let check = |name: &str, [line, jet]: [Vector<Jet<f64, 6>, 2>; 2]| {
            for (line, jet) in line.iter().zip(jet.iter()) {
                for k in 0..6 {
                    // Derivatives of these polynomials reach 5e3, from summands some ten times larger: 20 ε of those.
                    let what = format!("{name} at {t} s, derivative {k}");
                    assert_close(line.derivative(k), jet.derivative(k), 2e-10, &what);
                }
            }
        };
        for step in STEPS {
            let q_d = point_to_point(step);
            check("point to point", [q_d.at(t), q_d.on(Jet::variable(t))]);
        }
        check("stop", [STOP.at(t), STOP.on(Jet::variable(t))]);
        check("smooth start in motion", [MOVING_START.at(t), MOVING_START.on(Jet::variable(t))]);
    }
}

/// On intervals of time they enclose every derivative in them, and hardly anything else than those of any jet do.
#[test]
fn straight_lines_enclose_as_jets_do() {
    let point = |x: f64| Interval::point(x);
    let stop = Stop {
        from: STOP.from.map(|jet| Jet::from_fn(|k| point(jet.coefficient(k)))),
        start: point(STOP.start),
        duration: point(STOP.duration),
    };
    // On either side of an end, across it, and of no width.
    for (lo, hi) in [(-0.1, 0.1), (0.2, 0.3), (0.9, 1.1), (1.9, 2.1), (3.0, 3.5), (0.7, 0.7)] {
        let t = Interval::new(lo, hi).expect("in order");
        let (line, jet) = (stop.at::<5>(t), stop.on(Jet::<_, 5>::variable(t)));
        for i in 0..2 {
            for k in 0..5 {
                let what = format!("joint {i}, derivative {k} on [{lo}, {hi}] s");
                let [line, jet] = [&line, &jet].map(|q_d| q_d[i].coefficient(k));
                assert_close(line.lo(), jet.lo(), 1e-12 * (1.0 + jet.width()), &what);
                assert_close(line.hi(), jet.hi(), 1e-12 * (1.0 + jet.width()), &what);
                for part in 0..=10 {
                    let inside = lo + (hi - lo) * 0.1 * f64::from(part);
                    // Of points an interval of no width, which rounding does not leave.
                    let there = stop.at::<5>(point(inside.clamp(lo, hi)))[i].coefficient(k);
                    assert!(
                        line.lo() <= there.hi() && there.lo() <= line.hi(),
                        "{what}: not that at {inside} s"
                    );
                }
            }
        }
    }
}

#[test]
fn sine_has_its_closed_form() {
    for t in instants() {
        let jet = SINE.at::<8>(t);
        for i in 0..2 {
            let (amplitude, omega) = (SINE.amplitude[i], SINE.frequency[i]);
            for k in 0..8 {
                let quarter_turns = f64::from(k) * core::f64::consts::FRAC_PI_2;
                let wave = amplitude * omega.powi(k) * f64::sin(omega * t + SINE.phase[i] + quarter_turns);
                let expected = if k == 0 { SINE.offset[i] + wave } else { wave };
                let k = usize::try_from(k).unwrap();
                // The oracle rounds its angle, below 25 rad, by 4e-15; the jet a few times an order.
                let tolerance = 2e-14 * omega.powf(k as f64).max(1.0);
                assert_close(jet[i].derivative(k), expected, tolerance, &format!("derivative {k} at {t} s"));
            }
        }
    }
}

#[test]
fn multisine_is_the_sum_of_its_sines() {
    let sines = TERMS.map(|term| Sine {
        offset: Vector::ZERO,
        amplitude: term.amplitude,
        frequency: term.frequency,
        phase: term.phase,
    });
    let owned = Multisine { offset: MULTISINE.offset, terms: TERMS.to_vec() };
    let borrowed = Multisine { offset: MULTISINE.offset, terms: &TERMS[..] };
    let none = Multisine { offset: MULTISINE.offset, terms: &TERMS[..0] };
    for t in instants() {
        let expected = MULTISINE.offset.lift() + sines[0].at::<6>(t) + sines[1].at::<6>(t);
        // The same additions in the same order.
        assert_eq!(MULTISINE.at(t), expected);
        assert_eq!(owned.at(t), expected);
        assert_eq!(borrowed.at(t), expected);
        assert_eq!(none.at::<6>(t), MULTISINE.offset.lift());
    }
}

#[test]
fn point_to_point_rests_exactly_at_both_postures() {
    for step in STEPS {
        // 0.1 and 0.7 are not dyadic, the postures far apart in size: rounding would show.
        let q_d = PointToPoint {
            from: Vector([1e-3, 0.1]),
            to: Vector([1e3, 0.1]),
            start: 0.1,
            duration: 0.7,
            step,
        };
        for t in [-5.0, 0.0, 0.1] {
            assert_eq!(q_d.at::<3>(t), q_d.from.lift(), "{step:?} at {t} s");
        }
        for t in [0.8 + 1e-15, 1.0, 50.0] {
            assert_eq!(q_d.at::<3>(t), q_d.to.lift(), "{step:?} at {t} s");
        }
        // A joint that has nowhere to go does not move at all.
        for t in instants() {
            assert_eq!(q_d.at::<6>(t)[1], Jet::value(0.1), "{step:?} at {t} s");
        }
        let halfway = q_d.on(0.1 + 0.7 / 2.0)[0];
        // Slope 2.5 × 1e3 / 0.7 times a few ulp of time.
        assert_close(halfway, 500.0005, 1e-11, "halfway");
    }
}

#[test]
fn single_precision_follows() {
    let narrow = Sine::<f32, 1> {
        offset: Vector([0.25]),
        amplitude: Vector([0.5]),
        frequency: Vector([2.0]),
        phase: Vector([0.5]),
    };
    let wide = Sine::<f64, 1> {
        offset: Vector([0.25]),
        amplitude: Vector([0.5]),
        frequency: Vector([2.0]),
        phase: Vector([0.5]),
    };
    let narrow = SmoothStart::from_rest(Vector([0.0]), 4.0, narrow);
    let wide = SmoothStart::from_rest(Vector([0.0]), 4.0, wide);
    for i in 0..48 {
        let (f32_jet, f64_jet) = (narrow.at::<5>(i as f32 / 8.0), wide.at::<5>(f64::from(i) / 8.0));
        for k in 0..5 {
            // 100 ε of f32 on derivatives below 10, whose summands are.
            let (a, b) = (f64::from(f32_jet[0].derivative(k)), f64_jet[0].derivative(k));
            assert_close(
                a,
                b,
                100.0 * f64::from(f32::EPSILON) * b.abs().max(10.0),
                &format!("derivative {k}"),
            );
        }
    }
}
