//! Single faults, and what the guard makes of them.

use flexure::scenario::Scenario;
use flexure::simulate::Run;

use super::{ideal, simulate, with, with_these};

/// The paper's arm and gains at 1 kHz.
fn paper(more: &str) -> Run {
    simulate(&with("two-link-tanh-smooth", 4.0, more))
}

/// The plausible arm, sampled at 2 ms, with a guard and imperfections.
fn plausible(duration: f64, more: &str) -> Scenario {
    let parts = with("two-link-hardware", 1.0, "");
    let text = format!("[guard]\nstop_damping = [1.0, 0.2]\n{more}");
    let guarded = with("two-link-tanh-smooth", 1.0, &text);
    let mut scenario = with_these(ideal(duration), guarded.imperfections);
    scenario.guard = guarded.guard;
    scenario.guard.as_mut().expect("given").torque_limit = parts.robot.limits.torque;
    scenario
}

/// Time, cause and joint of the first stop.
fn first_stop(run: &Run) -> Option<(f64, &'static str, Option<u32>)> {
    let log = run.faults.as_ref().expect("a guard");
    log.stops.first().map(|stop| (stop.time, stop.cause, stop.joint))
}

/// Twenty readings that are lost at speed cost nothing to speak of: the model goes on. 1 mrad is what may be asked; without the model the
/// held readings cost more than that.
#[test]
fn twenty_lost_readings_are_bridged() {
    let undisturbed = paper("").summary.rms_e_l;
    for mode in ["nan", "hold"] {
        let lost =
            format!("[[imperfection]]\nkind = \"dropout\"\nmode = \"{mode}\"\nfrom = 2.5\nuntil = 2.52\n");
        let run = paper(&format!("[guard]\nstop_damping = 4.0\nmax_age = 20\n{lost}"));
        let cost = run.summary.rms_e_l - undisturbed;
        assert!(cost < 1e-6 && run.summary.stops == 0, "{mode}: {cost} rad");
        let phase = run.trace.column("phase").unwrap();
        assert_eq!(phase.iter().filter(|phase| **phase == 1.0).count(), 20, "coasting");
        assert!(phase.iter().all(|phase| *phase < 2.0));
        // One more is one too many.
        let run = paper(&format!("[guard]\nstop_damping = 4.0\nmax_age = 19\n{lost}"));
        assert_eq!(run.summary.stops, 1);
        let (time, ..) = first_stop(&run).expect("a stop");
        assert!((time - 2.519).abs() < 1e-9, "{time}");
    }
}

/// With the paper's gains at 10 kHz the law takes over from a moving robot, with a rate limit that normal running never touches or with
/// none: torques stay of the size of the run without a fault, and so does the error.
#[test]
fn a_stop_at_speed_ends_well() {
    let plain = simulate(&with("two-link-tanh-10khz", 4.0, ""));
    let lost = "[[imperfection]]\nkind = \"dropout\"\nfrom = 2.5\nuntil = 2.5001\n";
    for (limit, speed) in [("", 0.5), ("torque_rate_limit = 50000.0\n", 0.5), ("", 5.0)] {
        let guard = format!("[guard]\nstop_damping = 4.0\nrejoin_speed = {speed}\n{limit}");
        let run = simulate(&with("two-link-tanh-10khz", 4.0, &format!("{guard}{lost}")));
        let (summary, plain) = (&run.summary, &plain.summary);
        assert_eq!(summary.stops, 1);
        assert!(summary.max_abs_u_m < 3.0 * plain.max_abs_u_m, "{} N m", summary.max_abs_u_m);
        assert!(summary.final_abs_e_l < 1e-6, "{} rad", summary.final_abs_e_l);
        let [phase, stopped] = ["phase", "stopped"].map(|name| run.trace.column(name).unwrap());
        let rejoined = phase.iter().position(|phase| *phase == 3.0).expect("the law takes over");
        let errors = run.trace.joints("e_l");
        let after = errors.iter().flat_map(|e| &e[rejoined + 1..]).fold(0.0, |m: f64, e| m.max(e.abs()));
        assert!(after < 3.0 * plain.max_abs_e_l + 0.01, "{after} rad after the stop");
        // No jump: in the first instant of the law a tenth of what it asks for may be new, and what the period brings.
        for u in run.trace.joints("u_command") {
            let jump = (u[rejoined + 1] - u[rejoined]).abs();
            assert!(jump < 0.05 * plain.max_abs_u_m, "{jump} N m");
        }
        assert!(stopped[rejoined] == 1.0 && stopped[rejoined + 1] == 0.0);
    }
}

/// Readings that lie are found by a guard of which nothing was asked but to stop: stuck encoders soon, a lost turn at once, and both are
/// over when the readings are right again.
#[test]
fn stuck_encoders_and_lost_turns_stop_the_robot() {
    let stuck = |side: &str, window: &str| {
        format!("[[imperfection]]\nkind = \"freeze\"\nside = \"{side}\"\nfrom = 5.0\n{window}")
    };
    for side in ["link", "motor", "both"] {
        let run = simulate(&plausible(9.0, &stuck(side, "until = 6.0\n")));
        let (time, cause, _) = first_stop(&run).expect("a stop");
        assert!(cause == "frozen" && (5.0..5.2).contains(&time), "{side}: {cause} at {time} s");
        assert!(run.summary.final_abs_e_l < 0.01, "{side}: {} rad", run.summary.final_abs_e_l);
        // For good it stays stopped.
        let run = simulate(&plausible(9.0, &stuck(side, "")));
        assert_eq!(run.trace.column("stopped").unwrap().last(), Some(&1.0), "{side}");
    }
    for side in ["link", "motor"] {
        let turn = format!(
            "[[imperfection]]\nkind = \"jump\"\nside = \"{side}\"\nsize = [0.0, 6.283]\nfrom = 5.0\nuntil = 6.0\n"
        );
        let run = simulate(&plausible(9.0, &turn));
        assert_eq!(first_stop(&run), Some((5.0, "jump", Some(1))), "{side}");
        assert_eq!(run.summary.stops, 1);
        assert!(run.summary.final_abs_e_l < 0.01, "{side}: {} rad", run.summary.final_abs_e_l);
    }
}

/// An encoder that is off winds the spring in the readings only: the motor's momentum tells. The link's residual alone would be taken for
/// a collision.
#[test]
fn encoders_that_contradict_each_other_stop_the_robot() {
    let limits = "motor_residual = [1.0, 0.2]\ncollision = [1.5, 0.3]\n";
    let fine = simulate(&plausible(6.0, limits));
    assert_eq!(first_stop(&fine), None);
    // 0.05 rad of 39.96 and 6.86 N m/rad.
    let bias = "[[imperfection]]\nkind = \"bias\"\nmotor = [0.05, 0.05]\n";
    let run = simulate(&plausible(6.0, &format!("{limits}{bias}")));
    let (time, cause, _) = first_stop(&run).expect("a stop");
    assert!(cause == "contradiction" && time < 0.2, "{cause} at {time} s");
}

/// Something pushes the second link: found within the time of the residual, answered, and forgotten when it has gone.
#[test]
fn a_collision_is_found_and_answered() {
    let push = "[[imperfection]]\nkind = \"push\"\ntorque = [0.0, 1.0]\nfrom = 5.0\nduration = 0.3\n";
    let courses = ["stop", "float", "retract"].map(|reaction| {
        let guard = format!("collision = [1.5, 0.3]\nreaction = \"{reaction}\"\nretract_duration = 0.1\n");
        let run = simulate(&plausible(9.0, &format!("{guard}{push}")));
        let (time, cause, joint) = first_stop(&run).expect("a stop");
        assert_eq!((cause, joint), ("collision", Some(1)), "{reaction}");
        // 0.3 of 1 N m at 50 rad/s: 7 ms, and the period of 2 ms.
        assert!((5.002..5.012).contains(&time), "{reaction}: found at {time} s");
        assert!(run.summary.final_abs_e_l < 0.01, "{reaction}: {} rad", run.summary.final_abs_e_l);
        run.trace.joints("q_l")[1][2600] - run.trace.joints("q_l")[1][2500]
    });
    let [stop, float, retract] = courses;
    assert!(stop < float && stop < retract, "giving way: {stop}, {float}, {retract} rad");
}

/// A computer that stands still for 50 ms at speed: the drives go on with the last command until their watchdog lets it fall; the
/// guard sees by its clock that it is late, stops the robot and lets the law take over.
#[test]
fn a_computer_that_stands_still_is_found_late() {
    let stall = "[[imperfection]]\nkind = \"stall\"\nfrom = 2.5\nuntil = 2.55\n";
    let guard = "[guard]\nstop_damping = 4.0\ntorque_rate_limit = 10000.0\nwatchdog = 3\n";
    let run = paper(&format!("{guard}{stall}"));
    let (time, cause, joint) = first_stop(&run).expect("a stop");
    assert!((time - 2.55).abs() < 1e-9 && (cause, joint) == ("late", None), "{cause} at {time} s");
    assert_eq!(run.summary.stops, 1);
    assert!(run.summary.final_abs_e_l < 1e-6, "{} rad", run.summary.final_abs_e_l);
    let [phase, certificate] = ["phase", "certificate"].map(|name| run.trace.column(name).unwrap());
    assert!(phase[2500..2550].iter().all(|phase| phase.is_nan()) && phase[2499] == 0.0);
    assert!(certificate[2500..2550].iter().all(|holds| *holds == 0.0));
    for u in run.trace.joints("u_m") {
        assert!(u[2500..2503].iter().all(|torque| *torque == u[2499]), "as old as it may be");
        // 10,000 N m/s are 10 N m a period.
        for (k, pair) in u[2502..2550].windows(2).enumerate() {
            let expected = pair[0] - pair[0].clamp(-10.0, 10.0);
            assert!((pair[1] - expected).abs() < 1e-12, "{} N m, {k} periods after", pair[1]);
        }
        assert_eq!(u[2549], 0.0);
    }
    // Without a watchdog the last command acts for all of that time; one instant that nobody needs is not late.
    let run = paper(&format!("{}max_age = 1\n{stall}", guard.replace("watchdog = 3\n", "")));
    for u in run.trace.joints("u_m") {
        assert!(u[2500..2550].iter().all(|torque| *torque == u[2499]));
    }
    let run = paper(&format!("{guard}max_age = 1\n{}", stall.replace("2.55", "2.501")));
    assert_eq!(first_stop(&run), None);
}
