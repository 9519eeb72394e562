//! What happens while a limit is hit, and after.

use super::{ideal, simulate, with, with_these};

/// A push that the drives cannot answer: the torque stays at its limit, the certificate is suspended in the same step, and when
/// the push is over the loop goes where a loop without limits goes. Nothing winds up: there is nothing that could.
#[test]
fn a_limit_that_was_hit_leaves_nothing_behind() {
    let push = "[[imperfection]]\nkind = \"push\"\ntorque = [0.0, 1.2]\nfrom = 5.0\nduration = 0.5\n";
    let guard = "[guard]\ntorque_limit = [8.39, 1.5]\nstop_damping = 1.0\n";
    let parts = with("two-link-tanh-smooth", 1.0, &format!("{push}{guard}"));
    let free = with_these(ideal(12.0), parts.imperfections);
    let mut guarded = free.clone();
    guarded.guard = parts.guard;
    let guarded = simulate(&guarded);
    let free = simulate(&free);
    let (t, certificate) = (guarded.trace.column("t").unwrap(), guarded.trace.column("certificate").unwrap());
    let u = guarded.trace.column("u_command2").unwrap();
    let at_limit: Vec<f64> = (0..t.len()).filter(|&k| u[k].abs() >= 1.5).map(|k| t[k]).collect();
    assert!(!at_limit.is_empty(), "the push is strong enough");
    for k in 0..t.len() {
        assert_eq!(certificate[k] == 0.0, u[k].abs() >= 1.5, "at {} s", t[k]);
        assert!(u[k].abs() <= 1.5);
    }
    // Three seconds after the last touch the loops agree but for what the gains, of rates above 3 1/s, leave of the error.
    let after = at_limit.last().unwrap() + 3.0;
    let (a, b) = (guarded.trace.column("e_l2").unwrap(), free.trace.column("e_l2").unwrap());
    let late = (0..t.len()).filter(|&k| t[k] > after);
    let apart = late.map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-4, "{apart} after {after} s");
}

/// After a stop the reference starts where the robot stands, wherever the path has got to meanwhile.
#[test]
fn the_reference_is_joined_from_where_the_robot_stands() {
    let text = "[[imperfection]]\nkind = \"dropout\"\nfrom = 6.0\nuntil = 6.3\n[guard]\nstop_damping = 1.0\n";
    let parts = with("two-link-tanh-smooth", 1.0, text);
    let mut scenario = with_these(ideal(9.0), parts.imperfections);
    let undisturbed = simulate(&ideal(9.0));
    scenario.guard = parts.guard;
    let run = simulate(&scenario);
    let stopped = run.trace.column("stopped").unwrap();
    let last = (0..stopped.len()).rev().find(|&k| stopped[k] == 1.0).expect("a stop");
    for joint in 0..2 {
        let [q_ld, q_l] = ["q_ld", "q_l"].map(|name| run.trace.joints(name)[joint][last + 1]);
        let path = undisturbed.trace.joints("q_ld")[joint][last + 1];
        assert!((q_ld - q_l).abs() < 5e-3, "joined at {q_ld}, the robot is at {q_l}");
        assert!((path - q_l).abs() > 0.02, "the path is at {path}, the robot at {q_l}: nothing to join");
    }
    assert!(run.summary.final_abs_e_l < 1e-2, "{:?}", run.summary);
}
