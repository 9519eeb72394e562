//! The law at many states in one call: what a map of torques or a check against recorded data asks for.

use std::error::Error;
use std::f64::consts::PI;

use flexure::Scenario;

/// A map of torques over the angles of a two-link arm, at once and one by one.
pub fn main() -> Result<(), Box<dyn Error>> {
    let held = Scenario::load("two-link-tanh")?.open()?;
    let n = held.joints();
    let t = 0.5; // s

    // A map over both joint angles: rows of (q_l, q_m, dq_l, dq_m), one after the other, at rest with slack springs.
    let side = 41;
    let angle = |k: usize| PI * (2.0 * k as f64 / (side - 1) as f64 - 1.0); // rad
    let mut motions = Vec::new();
    for row in 0..side {
        for column in 0..side {
            let q = [angle(row), angle(column)];
            motions.extend([q, q, [0.0; 2], [0.0; 2]].concat());
        }
    }
    let states = motions.len() / (4 * n);

    let mut u_m = vec![0.0; states * n];
    held.torque(t, &motions, &mut u_m)?;

    // One by one it is the same, but for rounding: several states go through the law in SIMD lanes.
    let largest = u_m.chunks(n).map(|u| u[0].abs()).fold(0.0, f64::max);
    for (motion, torque) in motions.chunks(4 * n).zip(u_m.chunks(n)) {
        let mut alone = vec![0.0; n];
        held.torque(t, motion, &mut alone)?;
        assert!(alone.iter().zip(torque).all(|(a, b)| (a - b).abs() <= 1e-12 * largest));
    }
    println!("{states} states, largest torque of the first motor {largest:.0} N m");

    // Lengths that do not fit are refused, and the message says which.
    let wrong = held.torque(t, &motions, &mut u_m[1..]).unwrap_err();
    println!("refused: {wrong}");
    assert_eq!(wrong.expected, states * n);
    Ok(())
}
