//! A trace like that of a closed loop: a torque peak of a few milliseconds, then decaying errors on a sine.

use flexure::robot::JointKind;
use flexure::simulate::Following;
use flexure::simulate::Summary;
use flexure::simulate::Trace;

const PERIOD: f64 = 1e-3;

/// `samples` at 1 kHz of a run with `joints` joints whose errors decay at `rate` [1/s].
pub fn trace(joints: usize, samples: u32, rate: f64) -> Trace {
    let signals = [("q_l", "rad"), ("q_m", "rad"), ("q_ld", "rad"), ("e_l", "rad"), ("e_m", "rad")];
    let signals =
        signals.into_iter().chain([("sigma_l", "kg m^2/s"), ("sigma_m", "kg m^2/s"), ("u_m", "N m")]);
    let columns =
        signals.flat_map(|(name, unit)| (1..=joints).map(move |joint| (format!("{name}{joint}"), unit)));
    let mut trace = Trace::new(std::iter::once(("t".to_owned(), "s")).chain(columns));
    for sample in 0..samples {
        let t = f64::from(sample) * PERIOD;
        let row: Vec<f64> = std::iter::once(t)
            .chain(
                (0..8).flat_map(|signal| (0..joints).map(move |joint| value(signal, joint as f64, t, rate))),
            )
            .collect();
        trace.push(&row);
    }
    trace
}

/// The same run, with its last fifth not a number after growing without bound.
pub fn diverged(joints: usize, samples: u32) -> Trace {
    let whole = trace(joints, samples, 3.0);
    let mut cut = Trace::new(whole.columns().iter().map(|column| (column.name.clone(), column.unit)));
    let end = 4 * whole.len() / 5;
    for sample in 0..whole.len() {
        let growth = (0.2 * sample as f64 - 0.18 * end as f64).min(700.0).exp();
        let spoil = |value: f64| if sample < end { value + 1e-6 * growth } else { f64::NAN };
        let row: Vec<f64> = whole.columns().iter().map(|column| column.values[sample]).collect();
        cut.push(
            &row.iter()
                .enumerate()
                .map(|(k, &value)| if k == 0 { value } else { spoil(value) })
                .collect::<Vec<_>>(),
        );
    }
    cut
}

/// Plausible figures of merit.
pub fn summary(name: &str) -> Summary {
    Summary {
        name: name.to_owned(),
        controller: "vcbc".to_owned(),
        phi: Some("tanh".to_owned()),
        plant: Vec::new(),
        imperfections: vec![],
        following: Following::default(),
        max_abs_e_l: 0.0312,
        rms_e_l: 1.234e-3,
        final_abs_e_l: 1.23e-7,
        settling_time: Some(0.412),
        max_abs_u_m: 5787.3,
        rms_u_m: 63.2,
        rms_torque_change: 0.1,
        saturated_fraction: 0.0,
        suspended_fraction: 0.0,
        stops: 0,
        rate_pointwise: 9.95,
        rate_certified: None,
        energy_drift: 3.2e-9,
        steps: 10_000,
        wall_seconds: 0.123,
        kinds: vec![JointKind::Revolute; 2],
    }
}

fn value(signal: usize, joint: f64, t: f64, rate: f64) -> f64 {
    let phase = 0.4 * joint;
    let reference = (1.0 - 0.08 * joint) * (t + phase).sin();
    let decay = |rate: f64, floor: f64| (-rate * t).exp() + floor * (313.0 * t + 7.0 * joint).sin();
    let e_l = 0.3 * decay(rate, 3e-7) * (1.0 + joint).cos();
    let e_m = 11.0 * decay(1.7 * rate, 1e-7) * (1.0 + 0.3 * joint).sin();
    match signal {
        0 => reference + e_l,
        1 => reference + e_l + 0.2 * (1.3 * t + phase).cos() + 0.5 * (-20.0 * t).exp(),
        2 => reference,
        3 => e_l,
        4 => e_m,
        5 => 0.2 * e_l * (1.0 + 3.0 * (20.0 * t).sin() * (-4.0 * t).exp()),
        6 => 0.05 * e_m * (1.0 - 0.4 * (9.0 * t).cos()),
        _ => {
            (90.0 / (1.0 + joint)) * (t + phase).cos()
                - 5787.0 / (1.0 + 3.0 * joint) * (-t / 0.002).exp() * (1500.0 * t).cos()
        }
    }
}
