//! What a difference of the numbers adds to Ẇ, against its bound in intervals.

use flexure::core::linalg::Vector;
use flexure::core::model::{Links as _, Motion};
use flexure::core::scalar::Interval;
use flexure::prove::engine::envelope::deviation::Deviation;

use super::{Arm, UNKNOWN, difference, drawn, scenario, spread, tolerant};
use crate::along::floats;
use crate::along::slabs::enclosed;
use crate::common::Random;

/// √(2 W_b) of the four blocks.
fn lengths(arm: &Arm, x: &Motion<f64, 2>, t: f64) -> [f64; 4] {
    let command = arm.command(t, x);
    let flexure::core::control::Metric::Constant(metric) = &arm.law.link.metric else { panic!("constant") };
    let form = |d: &Vector<f64, 2>, e: &Vector<f64, 2>| e.dot(&d.diag_mul(e)).sqrt();
    [
        form(metric, &command.e_l),
        form(&arm.law.motor.metric, &command.e_m),
        command.s_l.dot(&arm.robot.links.mass_mul(&x.q_l, &command.s_l)).sqrt(),
        form(&arm.robot.motor_inertia, &command.s_m),
    ]
}

/// `x` with the errors of one block alone: q̃_m, s_l or s_m.
fn alone(arm: &Arm, x: &Motion<f64, 2>, t: f64, block: usize) -> Motion<f64, 2> {
    let command = arm.command(t, x);
    let mut errors = [Vector::ZERO; 4];
    errors[block] = [command.e_l, command.e_m, command.s_l, command.s_m][block];
    arm.motion(t, errors)
}

/// What a difference of the numbers adds to Ẇ: by differences of W where the accelerations lead. Its bound in intervals is never
/// below it, and not far above: a term that is missing, or has the wrong sign or corner, does not pass. Each kind of number alone,
/// where the reference decides (a narrow tube) and where the errors do.
#[test]
fn what_differences_add_is_bounded_and_tight() {
    let mut r = Random(11);
    for kind in 0..6 {
        let of_kind = |k: usize| k == kind || kind == 5;
        // Inertias by so much that a lighter motor and a heavier one are far apart.
        let parts = [0.02, 0.2, 0.02, 0.02];
        let parts = std::array::from_fn(|k| if of_kind(k) { parts[k] } else { 0.0 });
        let torque = if of_kind(4) { UNKNOWN } else { [0.0; 2] };
        let scenario = tolerant(scenario(), parts);
        let (arm, system) = (floats::arm(&scenario), enclosed(&scenario));
        let tolerances = &scenario.robot.tolerances;
        let spread = spread(tolerances, [torque, [0.0; 2]]);
        for (level, start) in [(1e-9, 4.5), (1e-4, 0.0)] {
            // Of errors in all blocks, and in one alone.
            let mut tightest = [0.0_f64; 4];
            for _ in 0..12 {
                // At the very start the reference stands still: all there is comes from the errors.
                let t = if start == 0.0 { 0.0 } else { start + 1.5 * (1.0 + r.next()) };
                let deviation =
                    Deviation::watched(&system, &spread, level, Interval::point(t), &|| true).unwrap();
                for k in 0..400 {
                    let mut x = arm.sample(t, level * (1.0 - 1e-6), &mut r);
                    let only = k % 4;
                    if only > 0 {
                        x = alone(&arm, &x, t, only);
                    }
                    let off = drawn(tolerances, torque, &mut r);
                    let [a_l, a_m] = difference(&arm, &off, &x, &arm.command(t, &x).u_m);
                    let size = a_l.dot(&a_l).sqrt() + a_m.dot(&a_m).sqrt();
                    let h = 1e-3 * level.sqrt() / size.max(1e-9);
                    let storage = |h: f64| {
                        let x = Motion { v_l: x.v_l + a_l.scaled(h), v_m: x.v_m + a_m.scaled(h), ..x };
                        arm.level(&x, &arm.command(t, &x))
                    };
                    let added = (storage(h) - storage(-h)) / (2.0 * h);
                    let lengths = lengths(&arm, &x, t);
                    let slope =
                        |b: usize| -> f64 { (0..4).map(|c| deviation.slopes[b][c] * lengths[c]).sum() };
                    let bound: f64 = (0..4).map(|b| lengths[b] * (deviation.steady[b] + slope(b))).sum();
                    assert!(added <= bound * (1.0 + 1e-6), "kind {kind} at {t} s: {added} beyond {bound}");
                    if bound > 0.0 {
                        tightest[only] = tightest[only].max(added / bound);
                    }
                }
            }
            println!("kind {kind}, level {level}: {tightest:.3?} of the bound");
            // Inertia, damping and torque of the motors act on the motors' velocities alone.
            let acted_on = if matches!(kind, 1 | 3 | 4) { [0, 3].as_slice() } else { &[0, 1, 2, 3] };
            let least = if start == 0.0 { &acted_on[..1] } else { acted_on };
            assert!(least.iter().all(|&b| tightest[b] > 0.25), "kind {kind}, level {level}: {tightest:?}");
        }
    }
}
