//! Drives in numbers.

use flexure::core::linalg::Vector;
use flexure::imperfections::stages::Tick;
use flexure::imperfections::{CurrentQuantisation, Deadline, Delay, Imperfection, Saturation, TorqueRate};

use super::{PERIOD, actuator, driven, mean, torque, torques};

/// A step of the command at the control instant 10, of 1 and −2 N m.
fn step(t: f64) -> Vector<f64, 2> {
    if t > 9.5 * PERIOD { Vector([1.0, -2.0]) } else { Vector::ZERO }
}

fn delay(computation: f64, actuation: f64) -> Imperfection {
    Imperfection::Delay(Delay { computation, actuation })
}

fn rate(limit: Vec<f64>) -> Imperfection {
    Imperfection::TorqueRate(TorqueRate { limit })
}

fn saturation(limit: Vec<f64>) -> Imperfection {
    Imperfection::Saturation(Saturation { limit })
}

fn steps(step: Vec<f64>) -> Imperfection {
    Imperfection::CurrentQuantisation(CurrentQuantisation { step })
}

/// A step acts exactly `delay` later, whatever part of a control period that is.
#[test]
fn a_delay_moves_a_step_by_itself() {
    for (computation, actuation) in [
        (0.0, 0.0),
        (2.5e-4, 0.0),
        (0.0, 1e-3),
        (1e-3, 5e-4),
        (3e-3, 0.0),
        (2e-4, 5.7e-3),
        (9.99e-4, 0.0),
        (1e-7, 0.0),
    ] {
        let pieces = driven(&[delay(computation, actuation)], 0, 30, step);
        let changes: Vec<f64> = pieces
            .iter()
            .enumerate()
            .flat_map(|(k, pieces)| {
                pieces.spans(PERIOD).map(move |(begin, length, u)| (k as f64 * PERIOD + begin, length, u))
            })
            .filter(|(_, length, u)| {
                assert!(*length > 0.0 && (*u == Vector::ZERO || *u == Vector([1.0, -2.0])));
                *u != Vector::ZERO
            })
            .map(|(begin, ..)| begin)
            .collect();
        let expected = 10.0 * PERIOD + computation + actuation;
        // Rounding of sums of decimals.
        assert!((changes[0] - expected).abs() < 1e-15, "{} instead of {expected}", changes[0]);
        let total: f64 = pieces.iter().map(|pieces| PERIOD * pieces.mean(PERIOD)[0]).sum();
        assert!((total - (30.0 * PERIOD - expected)).abs() < 1e-12, "the torque stays");
    }
}

/// Whole control periods make one piece, others two, and the last of a period goes on in the next.
#[test]
fn pieces_follow_each_other() {
    let count =
        |actuation| driven(&[delay(0.0, actuation)], 0, 40, torque).iter().map(|p| p.iter().count()).max();
    assert_eq!([0.0, 3e-3, 7e-3, 2.5e-3].map(count), [Some(1), Some(1), Some(1), Some(2)]);
    let late = driven(&[delay(0.0, 2.5e-3)], 0, 40, torque);
    for (k, pair) in late.windows(2).enumerate() {
        assert_eq!(pair[0].last(), pair[1].iter().next().unwrap().1);
        let (offset, u) = pair[1].iter().last().unwrap();
        assert!((offset - 5e-4).abs() < 1e-15);
        assert_eq!(u, if k >= 1 { torque((k - 1) as f64 * PERIOD) } else { Vector::ZERO });
        assert!((pair[1].spans(PERIOD).map(|(_, length, _)| length).sum::<f64>() - PERIOD).abs() < 1e-18);
    }
}

/// A delay in a file that is a whole number of control periods is one, whatever floats make of quotients.
#[test]
fn whole_delays_are_whole() {
    for periods in 0..400_u32 {
        let given = driven(&[delay(0.0, f64::from(periods) / 1000.0)], 0, 420, step);
        assert!(given.iter().all(|pieces| pieces.iter().count() == 1), "{periods}");
        let first = given.iter().position(|pieces| pieces.last() != Vector::ZERO);
        assert_eq!(first, usize::try_from(periods + 10).ok());
    }
}

/// Torque from before the first command acts until that arrives, and rates count from it.
#[test]
fn the_torque_before_goes_on() {
    let before = Vector([5.0, -3.0]);
    let stages = [delay(0.0, 1.5e-3), rate(vec![1000.0; 2])];
    let mut late = actuator(&stages, 0, before);
    let given: Vec<_> = (0..4).map(|k| late.actuate(&Tick::new(k, PERIOD), Vector::ZERO)).collect();
    assert_eq!(given[0].last(), before);
    assert_eq!(given[1].iter().next().unwrap().1, before);
    for (k, expected) in [(1, [4.0, -2.0]), (2, [3.0, -1.0]), (3, [2.0, 0.0])] {
        assert_eq!(given[k].last(), Vector(expected));
    }
}

/// 1 N m at 250 N m/s takes four control periods of 1 ms, 2 N m eight.
#[test]
fn torque_rises_in_so_many_periods() {
    let rise: Vec<_> = driven(&[rate(vec![250.0; 2])], 0, 30, step)
        .iter()
        .map(flexure::imperfections::stages::Pieces::last)
        .collect();
    for (k, u) in rise.iter().enumerate() {
        let periods = k.saturating_sub(9) as f64;
        assert_eq!(*u, Vector([(0.25 * periods).min(1.0), -(0.25 * periods).min(2.0)]), "{k}");
    }
    // No two torques of a wild command are farther apart.
    let wild = torques(&[rate(vec![20.0, 35.0])], 0, 2000);
    for pair in wild.windows(2) {
        let change = pair[1].last() - pair[0].last();
        assert!(change[0].abs() <= 0.02 * (1.0 + 1e-12) && change[1].abs() <= 0.035 * (1.0 + 1e-12));
    }
}

#[test]
fn saturation_cuts_and_nothing_else() {
    for (k, pieces) in torques(&[saturation(vec![1.5, 0.5])], 0, 2000).iter().enumerate() {
        let u = torque(k as f64 * PERIOD);
        assert_eq!(pieces.last(), Vector([u[0].clamp(-1.5, 1.5), u[1].clamp(-0.5, 0.5)]));
    }
}

/// Steps of 0.3 N m: whole ones, the nearest, with errors of deviation 0.3/√12 N m.
#[test]
fn current_comes_in_steps() {
    let given = torques(&[steps(vec![0.3; 2])], 0, 20_000);
    let errors: Vec<f64> =
        given.iter().enumerate().map(|(k, pieces)| pieces.last()[0] - torque(k as f64 * PERIOD)[0]).collect();
    assert!(errors.iter().all(|error| error.abs() <= 0.15 + 1e-12));
    assert!(given.iter().all(|u| ((u.last()[0] / 0.3).round() * 0.3 - u.last()[0]).abs() < 1e-12));
    let deviation = mean(errors.iter().map(|error| error * error)).sqrt();
    assert!((deviation / (0.3 / 12.0_f64.sqrt()) - 1.0).abs() < 0.03, "{deviation}");
}

/// Each fifth instant is missed: the torque of the fourth stays.
#[test]
fn every_so_many_th_deadline_is_missed() {
    let given = torques(&[Imperfection::Deadline(Deadline::Every(5))], 0, 100);
    for (k, pieces) in given.iter().enumerate() {
        let from = if k % 5 == 4 { k - 1 } else { k };
        assert_eq!(pieces.last(), torque(from as f64 * PERIOD), "{k}");
    }
}

#[test]
fn deadlines_are_missed_with_their_probability() {
    let given = torques(&[Imperfection::Deadline(Deadline::Random { probability: 0.2 })], 4, 50_000);
    let missed: Vec<bool> =
        given.iter().enumerate().map(|(k, u)| u.last() != torque(k as f64 * PERIOD)).collect();
    let share = |missed: &[bool]| mean(missed.iter().map(|&missed| f64::from(u8::from(missed))));
    // Five standard deviations of the mean of 50000: 0.009.
    assert!((share(&missed) - 0.2).abs() < 0.009, "{}", share(&missed));
    // After a miss as likely as ever; and what is given then is what was given before.
    let after: Vec<bool> = missed.windows(2).filter(|pair| pair[0]).map(|pair| pair[1]).collect();
    assert!((share(&after) - 0.2).abs() < 0.02, "{}", share(&after));
    assert!((1..missed.len()).all(|k| !missed[k] || given[k].last() == given[k - 1].last()));
}

/// Steps, then the limit, then the rate: limits hold exactly at the motor, also for commands that are no numbers.
#[test]
fn stages_are_in_physical_order() {
    let limit = 1.0;
    let stages = [rate(vec![1e4; 2]), saturation(vec![limit; 2]), steps(vec![0.3; 2]), delay(4e-4, 0.0)];
    let given = torques(&stages, 0, 1000);
    let peak = given.iter().flat_map(|p| p.iter().map(|(_, u)| u[0])).fold(0.0, f64::max);
    assert!((peak - limit).abs() < 1e-15, "not the multiple of 0.3 below the limit: {peak}");
    let mut drive = actuator(&stages[..2], 0, Vector::ZERO);
    let nan = drive.actuate(&Tick::new(0, PERIOD), Vector([f64::NAN, 1.0]));
    assert!(nan.last()[0].is_nan(), "the drive invents nothing");
    assert_eq!(drive.actuate(&Tick::new(1, PERIOD), Vector([0.5, 1.0])).last(), Vector([0.5, 1.0]));
}
