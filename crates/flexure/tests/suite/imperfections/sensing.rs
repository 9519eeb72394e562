//! Sensors in numbers.

use flexure::core::linalg::Vector;
use flexure::core::model::Motion;
use flexure::imperfections::stages::{Measured, Tick};
use flexure::imperfections::{
    Dropout, DropoutMode, Encoder, Imperfection, Noise, Outage, Sampling, Side, Sides,
};

use super::{PERIOD, mean, motion, readings, sensors};

const LINK: usize = 0;
const MOTOR: usize = 1;

fn encoder(link: Option<f64>, motor: Option<f64>, dither: bool) -> Imperfection {
    let same = |resolution: Option<f64>| resolution.map(|resolution| vec![resolution; 2]);
    Imperfection::Encoder(Encoder { link: same(link), motor: same(motor), dither })
}

/// Readings of a robot that stands at `q` rad.
fn standing(imperfections: &[Imperfection], q: f64, count: u64) -> Vec<Measured<2>> {
    let mut sensors = sensors(imperfections, 5);
    let rest = Motion::at_rest(Vector([q; 2]));
    (0..count).map(|k| sensors.sense(&Tick::new(k, PERIOD), &rest)).collect()
}

/// Errors are uniform in a count: at most half, of mean 0 and standard deviation q/√12.
#[test]
fn rounding_errors_are_uniform() {
    let count = 1e-3;
    let read = readings(&[encoder(Some(count), Some(2.0 * count), false)], 0, 20_000);
    for (side, count) in [(LINK, count), (MOTOR, 2.0 * count)] {
        let pick = |x: &Motion<f64, 2>| [x.q_l, x.q_m][side][0];
        let errors: Vec<f64> = read
            .iter()
            .enumerate()
            .map(|(k, measured)| pick(&measured.motion) - pick(&motion(k as f64 * PERIOD)))
            .collect();
        assert!(errors.iter().all(|error| error.abs() <= 0.5 * count * (1.0 + 1e-9)));
        let deviation = mean(errors.iter().map(|error| error * error)).sqrt();
        // 20000 errors that are independent but for the slow turning points.
        assert!((deviation / (count / 12.0_f64.sqrt()) - 1.0).abs() < 0.02, "{deviation}");
        assert!(mean(errors.iter().copied()).abs() < 0.02 * count);
        assert!(
            read.iter().all(|x| (pick(&x.motion) / count - (pick(&x.motion) / count).round()).abs() < 1e-9)
        );
    }
}

/// A standing robot reads the same count for ever; with dither the mean of many readings is where it stands.
#[test]
fn dither_makes_the_mean_exact() {
    let (count, q) = (0.01, 0.0437);
    let read = |dither| standing(&[encoder(Some(count), Some(count), dither)], q, 40_000);
    let link = |read: &[Measured<2>]| mean(read.iter().map(|measured| measured.motion.q_l[0]));
    assert!((link(&read(false)) - 0.04).abs() < 1e-12);
    // 4.37 counts are 5 in 37 of 100 readings: the mean of 40000 is within 0.0024 counts, one standard deviation.
    assert!((link(&read(true)) - q).abs() < 0.01 * count, "{}", link(&read(true)));
}

#[test]
fn sides_without_encoders_read_nothing() {
    for (placement, missing) in [
        (vec![encoder(None, Some(1e-3), false)], [true, false]),
        (vec![encoder(Some(1e-3), None, false)], [false, true]),
        (vec![encoder(None, Some(1e-3), false), encoder(Some(0.5), None, false)], [false, false]),
        (Vec::new(), [false, false]),
    ] {
        let read = readings(&placement, 0, 3)[2];
        assert_eq!(read.placed, missing.map(|missing| !missing));
        let nan = |vector: Vector<f64, 2>| vector.iter().all(f64::is_nan);
        assert_eq!([nan(read.motion.q_l), nan(read.motion.q_m)], missing);
        assert_eq!([nan(read.motion.v_l), nan(read.motion.v_m)], missing);
    }
}

/// Mean, deviation and the share beyond one deviation of what is added, on each side, of positions and velocities.
#[test]
fn noise_is_normal() {
    let deviations = [1e-3, 2e-3, 0.5, 0.25];
    let [link, motor, link_velocity, motor_velocity] = deviations.map(|deviation| vec![0.0, deviation]);
    let noise = Imperfection::Noise(Noise { link, motor, link_velocity, motor_velocity });
    let read = readings(&[noise], 3, 40_000);
    let parts = |x: &Motion<f64, 2>| [x.q_l, x.q_m, x.v_l, x.v_m];
    for (part, deviation) in deviations.into_iter().enumerate() {
        let added = |joint: usize| -> Vec<f64> {
            let difference = |(k, measured): (usize, &Measured<2>)| {
                parts(&measured.motion)[part][joint] - parts(&motion(k as f64 * PERIOD))[part][joint]
            };
            read.iter().enumerate().map(difference).collect()
        };
        assert!(added(0).iter().all(|x| *x == 0.0));
        let added = added(1);
        // Five standard deviations of estimates from 40000 numbers: of the mean 1/200, of the deviation 1/283.
        assert!(mean(added.iter().copied()).abs() < 0.025 * deviation);
        let found = mean(added.iter().map(|x| x * x)).sqrt();
        assert!((found / deviation - 1.0).abs() < 0.018, "{found} for {deviation}");
        let beyond = mean(added.iter().map(|x| f64::from(u8::from(x.abs() > deviation))));
        assert!((beyond - 0.3173).abs() < 0.012, "{beyond}");
        // White: a number says nothing of the next.
        let next = mean(added.windows(2).map(|pair| pair[0] * pair[1]));
        assert!((next / (deviation * deviation)).abs() < 0.025);
    }
}

#[test]
fn slow_sensors_hold_and_grow_old() {
    let slow = Imperfection::Sampling(Sampling { sides: Sides::One(Side::Motor), periods: 4 });
    for (k, measured) in readings(&[slow], 0, 50).into_iter().enumerate() {
        let (now, then) = (motion(k as f64 * PERIOD), motion((k - k % 4) as f64 * PERIOD));
        assert_eq!((measured.motion.q_l, measured.motion.v_l), (now.q_l, now.v_l));
        assert_eq!((measured.motion.q_m, measured.motion.v_m), (then.q_m, then.v_m));
        assert_eq!(measured.age, [0, u32::try_from(k % 4).unwrap()]);
    }
}

/// Nothing comes in [from, until) although 0.03 and 30 times 0.001 are not the same float.
#[test]
fn windows_are_exact() {
    for mode in [DropoutMode::Hold, DropoutMode::Nan] {
        let outage = Outage::Window { from: 0.003, until: 0.03 };
        let dropout = Imperfection::Dropout(Dropout { sides: Sides::One(Side::Link), mode, outage });
        for (k, measured) in readings(&[dropout], 0, 40).into_iter().enumerate() {
            let (now, last) = (motion(k as f64 * PERIOD), motion(2.0 * PERIOD));
            assert_eq!(measured.motion.q_m, now.q_m);
            let is_out = (3..30).contains(&k);
            let age = if is_out { k - 2 } else { 0 };
            assert_eq!(measured.age, [u32::try_from(age).unwrap(), 0], "{k}");
            match (is_out, mode) {
                (false, _) => assert_eq!(measured.motion, now),
                (true, DropoutMode::Hold) => {
                    assert_eq!((measured.motion.q_l, measured.motion.v_l), (last.q_l, last.v_l));
                }
                (true, DropoutMode::Nan) => {
                    assert!(measured.motion.q_l.iter().chain(measured.motion.v_l.iter()).all(f64::is_nan));
                }
            }
        }
    }
}

/// A time in a file is the control instant that it names, also where products of floats fall short of it.
#[test]
fn windows_begin_where_the_file_says() {
    let period = 0.0007;
    let mut short = 0;
    for first in 1..400_u32 {
        let from = f64::from(7 * first) / 10_000.0;
        short += u32::from(f64::from(first) * period < from);
        let outage = Outage::Window { from, until: from + 10.0 };
        let dropout = Imperfection::Dropout(Dropout { sides: Sides::Both, mode: DropoutMode::Nan, outage });
        let mut sensors = sensors(&[dropout], 0);
        let rest = Motion::<f64, 2>::at_rest(Vector::ZERO);
        let begin = (0..401_u64).find(|&k| sensors.sense(&Tick::new(k, period), &rest).age[LINK] > 0);
        assert_eq!(begin, Some(u64::from(first)));
    }
    assert!(short > 0, "no product falls short of a decimal");
}

/// Who holds before anything came holds nothing.
#[test]
fn a_sensor_that_is_dead_from_the_start_reads_nothing() {
    let outage = Outage::Window { from: 0.0, until: 0.002 };
    let dropout = Imperfection::Dropout(Dropout { sides: Sides::Both, mode: DropoutMode::Hold, outage });
    let read = readings(&[dropout], 0, 3);
    assert!(read[0].motion.q_l[0].is_nan() && read[1].motion.q_m[1].is_nan());
    assert_eq!((read[0].age, read[1].age), ([1; 2], [2; 2]));
    assert_eq!(read[2], Measured::exactly(motion(2.0 * PERIOD)));
}

/// Outages of mean length m begin after 1/p sound instants on average; lengths are geometric.
#[test]
fn outages_have_their_probability_and_length() {
    let (probability, mean_length) = (0.02, 5.0);
    let outage = Outage::Random { probability, mean_length };
    let dropout = Imperfection::Dropout(Dropout { sides: Sides::Both, mode: DropoutMode::Nan, outage });
    let silent: Vec<bool> =
        readings(&[dropout], 11, 200_000).iter().map(|measured| measured.motion.q_l[0].is_nan()).collect();
    let share = mean(silent.iter().map(|&silent| f64::from(u8::from(silent))));
    let expected = mean_length / (mean_length + 1.0 / probability);
    let lengths: Vec<f64> =
        silent.split(|silent| !silent).map(<[bool]>::len).filter(|&n| n > 0).map(|n| n as f64).collect();
    // 3600 outages: 3 % are two standard deviations of the mean length, four percent bound both.
    assert!((share / expected - 1.0).abs() < 0.06, "{share} instead of {expected}");
    assert!((mean(lengths.iter().copied()) / mean_length - 1.0).abs() < 0.06);
    let single = mean(lengths.iter().map(|&n| f64::from(u8::from(n < 1.5))));
    assert!((single - 1.0 / mean_length).abs() < 0.03, "{single}");
}

/// What drops out is what an encoder delivers: counts, after noise.
#[test]
fn stages_are_in_physical_order() {
    let noise = Imperfection::Noise(Noise {
        link: vec![0.1; 2],
        motor: vec![0.1; 2],
        link_velocity: vec![0.0; 2],
        motor_velocity: vec![0.0; 2],
    });
    for measured in readings(&[encoder(Some(0.25), Some(0.25), false), noise], 2, 100) {
        assert!(measured.motion.q_l.iter().all(|q| (4.0 * q).fract() == 0.0));
    }
}
