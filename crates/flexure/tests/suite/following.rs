//! Runs that say no: what follows a reference, what does not and why; torque limits that act; what a certificate is about.
#![expect(
    clippy::float_cmp,
    reason = "limits of files come back as they are, and a drive that gives what is asked gives its bits"
)]

use flexure::files::{SCENARIOS, TASKS};
use flexure::scenario::{Scenario, load_scenario, scenario_from_text};
use flexure::simulate::{Criteria, Following, Measure, Run};
use flexure::tune::cost;

/// A built-in scenario with other words and tables added to its text.
fn with(name: &str, changes: &[(&str, &str)], more: &str) -> Scenario {
    let all = [SCENARIOS, TASKS].concat();
    let mut text = all.iter().find(|(known, _)| *known == name).expect("built in").1.to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from} in {name}");
        text = text.replacen(from, to, 1);
    }
    let text = format!("{text}\n{more}\n");
    scenario_from_text(name, &text, ".".as_ref()).unwrap_or_else(|problems| panic!("{problems}\n{text}"))
}

/// Runs to its end, and does not follow: the verdict.
#[track_caller]
fn lost(scenario: &Scenario) -> Following {
    let run = scenario.simulate().expect("a good scenario");
    assert!(run.divergence.is_none(), "{:?}: not today's case of a loop that diverged", run.divergence);
    let following = run.summary.following;
    assert!(!following.follows && !following.reasons.is_empty(), "{:?}", following.accepted);
    for reason in &following.reasons {
        assert!(reason.measure.is_none() || reason.value > reason.limit, "{reason:?}");
        assert!(reason.time.is_none_or(|t| t >= 0.0 && t <= scenario.duration), "{reason:?}");
    }
    following
}

fn has(following: &Following, measure: Measure, joint: usize, scenario: &Scenario) -> f64 {
    let name = &scenario.robot.joints[joint].name;
    let found = following.reasons.iter().find(|reason| {
        reason.measure == Some(measure) && reason.joint.as_ref() == Some(name) && reason.words.contains(name)
    });
    found.unwrap_or_else(|| panic!("{measure:?} of {name} in {:?}", following.reasons)).value
}

const SHORT: (&str, &str) = ("duration = 20.0", "duration = 8.0");

/// A push that the drives cannot answer carries the arm away: far, and far from 10⁶ rad.
#[test]
fn a_loop_far_away_does_not_follow() {
    let push = "[[imperfection]]\nkind = \"push\"\ntorque = [60.0, 0.0]\nfrom = 1.0\nduration = 19.0\n";
    let scenario = with("two-link-hardware", &[], push);
    let following = lost(&scenario);
    assert!(has(&following, Measure::Error, 0, &scenario) > 58.0, "{:?}", following.reasons);
}

/// A guard holds the robot where it is from the first instant on, as it should: that is no following, whatever the reference.
#[test]
fn a_loop_that_never_saw_a_reading_does_not_follow() {
    let dark = "[[imperfection]]\nkind = \"dropout\"\nfrom = 0.0\nuntil = 8.0\n";
    let scenario = with("two-link-hardware", &[SHORT], dark);
    let following = lost(&scenario);
    has(&following, Measure::Error, 0, &scenario);
    assert_eq!(
        following.reasons[0].time,
        Some(0.0),
        "stopped from the beginning: {:?}",
        following.reasons[0]
    );

    // Nor where the reference stays where the robot is.
    let still =
        with("two-link-hardware", &[SHORT, ("amplitude = [1.0, 1.0]", "amplitude = [0.0, 0.0]")], dark);
    let following = lost(&still);
    assert!(following.reasons[0].words.contains("the guard has stopped the robot since"), "{following:?}");
}

#[test]
fn a_loop_that_missed_every_deadline_does_not_follow() {
    let late = "[[imperfection]]\nkind = \"deadline\"\nprobability = 1.0\n";
    let scenario = with("two-link-hardware", &[SHORT], late);
    let following = lost(&scenario);
    assert!(has(&following, Measure::Error, 1, &scenario) > 0.5);
    let run = scenario.simulate().expect("good");
    // But for the first instant, at which the law asks for what held the robot before.
    assert!(run.summary.suspended_fraction > 0.999, "{}", run.summary.suspended_fraction);
}

/// Torque that comes too late swings to and fro between the limits of the drives.
#[test]
fn a_limit_cycle_at_the_torque_limit_does_not_follow() {
    let late = "[[imperfection]]\nkind = \"delay\"\nactuation = 0.1\n";
    let scenario = with("task-ideal-tracking", &[], late);
    let following = lost(&scenario);
    has(&following, Measure::AtLimit, 1, &scenario);

    // Though the error be accepted: the torque is not.
    let lenient = with("task-ideal-tracking", &[], &format!("[accept]\nerror = 6.0\n{late}"));
    let following = lost(&lenient);
    assert!(following.reasons.iter().all(|reason| reason.measure != Some(Measure::Error)), "{following:?}");
}

/// It is on its reference soon after, but was 29 times as fast as the joint may be.
#[test]
fn a_wrist_beyond_its_speed_limit_does_not_follow() {
    let mut scenario = load_scenario("task-panda").expect("built in");
    let fast = 29.0 * scenario.robot.limits.velocity[6];
    (scenario.initial.dq_l[6], scenario.initial.dq_m[6]) = (fast, fast);
    scenario.plant.unlimited = true;
    scenario.duration = 0.5;
    scenario.accept.torque = Some(vec![1e6; 7]);
    let run = scenario.simulate().expect("good");
    let following = run.summary.following;
    let wrist = Some(&scenario.robot.joints[6].name);
    let speeds = following.reasons.iter().filter(|reason| reason.measure == Some(Measure::Speed));
    let speed = speeds.into_iter().find(|reason| reason.joint.as_ref() == wrist);
    let speed = speed.unwrap_or_else(|| panic!("{:?} {:?}", following.reasons, run.divergence));
    assert!(speed.value >= fast && speed.limit == scenario.robot.limits.velocity[6], "{speed:?}");
}

#[test]
fn every_built_in_scenario_follows() {
    for (name, _) in SCENARIOS.iter().chain(TASKS) {
        let run = load_scenario(name).expect("built in").simulate().expect("good");
        assert!(run.summary.following.follows, "{name}: {:?}", run.summary.following.reasons);
    }
}

/// What a scenario says is what it is held to, and what it does not say follows from the robot and the reference.
#[test]
fn accepted_is_what_the_file_says_or_the_robot_can() {
    let limits = |scenario: &Scenario, measure: Measure| {
        let bounds = Criteria::of(scenario).expect("good").bounds(&[1.0, 0.2]);
        bounds.into_iter().find(|bound| bound.measure == measure).expect("all of them").limit
    };
    let plain = load_scenario("task-ideal-tracking").expect("built in");
    assert_eq!(limits(&plain, Measure::Torque), plain.robot.limits.torque);
    assert_eq!(limits(&plain, Measure::Error), [0.1, 0.1]);
    let text = "[accept]\nerror = [0.2, 0.3]\nsettling = 1.5\ntorque = 3.0\nspeed = 2.0\ndeflection = 0.4\n\
                torque_change = 0.7\nat_limit = 0.25";
    let told = with("task-ideal-tracking", &[], text);
    let all = Measure::ALL.map(|measure| limits(&told, measure)[1]);
    assert_eq!(all, [0.3, 3.0, 2.0, 0.4, 0.7, 0.25]);
    assert_eq!(Criteria::of(&told).expect("good").settling, 1.5);
    // Too little is accepted: the same run does not follow.
    let strict = with("task-ideal-tracking", &[], "[accept]\nspeed = 0.1");
    has(&lost(&strict), Measure::Speed, 0, &strict);
}

/// Every loop that diverged costs more than every one that did not, however long the runs are and however bad the other is; and
/// every loop that does not follow more than every one that does.
#[test]
fn costs_put_diverged_behind_lost_behind_following() {
    let mut short = load_scenario("two-link-tanh").expect("built in");
    (short.control_period, short.duration) = (0.002, 1.0);
    let diverged = short.simulate().expect("good");
    let made_up = |follows: bool, error: f64, torque: f64, change: f64| {
        let mut run = Run { divergence: None, ..diverged.clone() };
        (run.summary.rms_e_l, run.summary.rms_u_m, run.summary.rms_torque_change) = (error, torque, change);
        run.summary.following.follows = follows;
        cost(&run)
    };
    let at = |time: f64| {
        let mut run = diverged.clone();
        run.divergence.as_mut().expect("at 500 Hz").time = time;
        cost(&run)
    };
    let times = (-9..=9).map(|k| at(10_f64.powi(k)));
    let least = times.clone().fold(f64::INFINITY, f64::min);
    assert!(times.clone().zip(times.skip(1)).all(|(early, late)| early >= late), "the later the better");
    // Whatever stays below 10⁶ rad, with torques from next to nothing to 10³⁰ N m that all change sign at every instant.
    for error in (-14..=6).map(|k| 10_f64.powi(k)) {
        for torque in (-30..=30).map(|k| 10_f64.powi(k)) {
            for change in [0.0, 1e-3 * torque, 2.0 * torque] {
                let [lost, following] = [false, true].map(|follows| made_up(follows, error, torque, change));
                assert!(lost < least, "{error} {torque} {change}");
                for (other, much) in [(1e6, 2.0), (1.0, 2.0), (1e-14, 0.0)] {
                    assert!(lost > made_up(true, other, 1.0, much), "{error} {torque} {change} {other}");
                }
                assert!(following < lost);
            }
        }
    }
}

/// From 0.4 rad off its reference, without a smooth start.
const OFF: [(&str, &str); 3] = [
    ("q_l = [0.0, 0.0]", "q_l = [0.4, 0.4]"),
    ("q_m = [0.0, 0.0]", "q_m = [0.4, 0.4]"),
    (
        "[reference.smooth_start]           # from rest at the initial position\nduration = 3.5                     # s\n",
        "",
    ),
];

fn peaks(run: &Run) -> Vec<f64> {
    run.trace.joints("u_m").iter().map(|u| u.iter().fold(0.0, |m: f64, u| m.max(u.abs()))).collect()
}

#[test]
fn torque_limits_of_the_robot_act_unless_switched_off() {
    let text = |more: &str| with("task-ideal-tracking", &OFF, more);
    let limited = text("");
    let limits = limited.robot.limits.torque.clone();
    assert_eq!(limited.drive_limits(), Some(limits.clone()));
    let run = limited.simulate().expect("good");
    assert_eq!(peaks(&run), limits, "the law asks for more than both drives give");
    assert!(run.summary.saturated_fraction > 0.0 && run.summary.suspended_fraction > 0.0);
    assert!(limited.conditions().is_empty());

    let off = text("[plant]\ntorque_limits = false");
    assert_eq!(off.drive_limits(), None);
    assert_eq!(off.conditions(), ["torque limits off"]);
    let free = off.simulate().expect("good");
    assert!(peaks(&free).iter().zip(&limits).all(|(peak, limit)| peak > limit), "{:?}", peaks(&free));
    assert!(!free.summary.following.follows, "which is said");

    // What the scenario says of the drives beats the robot.
    let own = text("[[imperfection]]\nkind = \"saturation\"\nlimit = [5.0, 1.0]");
    assert_eq!(peaks(&own.simulate().expect("good")), [5.0, 1.0]);
}

/// Where the certificate column is 1 the motors give the law's torque, to the bit; where the drive is at its limit, late, coarse or
/// off in gain it is 0, with a guard and without.
#[test]
fn certificates_hold_where_the_drive_gives_what_the_law_asks() {
    let guard = "[guard]\nstop_damping = 1.0\n";
    let slow = "[[imperfection]]\nkind = \"torque-rate\"\nlimit = 20.0\n";
    let cases = [
        ("saturated", String::new(), false),
        ("saturated, guarded", guard.to_owned(), false),
        ("slow drive", slow.to_owned(), false),
        ("slow drive, guarded", format!("{slow}{guard}"), false),
        ("deadlines", "[[imperfection]]\nkind = \"deadline\"\nevery = 3\n".to_owned(), false),
        ("late", "[[imperfection]]\nkind = \"delay\"\nactuation = 0.0004\n".to_owned(), true),
        ("gain", "[[imperfection]]\nkind = \"torque-gain\"\nfactor = 0.97\n".to_owned(), true),
        ("coarse", "[[imperfection]]\nkind = \"current-quantisation\"\nstep = 0.01\n".to_owned(), true),
        ("compensated", "[disturbance_observer]\nbandwidth = 20.0\ncompensate = true\n".to_owned(), true),
    ];
    for (name, text, hardly) in cases {
        let mut scenario = with("task-ideal-tracking", &OFF, &text);
        scenario.duration = 1.5;
        let limits = scenario.robot.limits.torque.clone();
        let mut held = scenario.open().expect("good");
        let at =
            |column: &str| held.signals().iter().position(|signal| signal.name == column).expect("there");
        let (certificate, u_m, command) = (at("certificate"), at("u_m1"), at("u_command1"));
        let seen = at("q_l_seen1");
        let (mut values, mut law) = (vec![0.0; held.signals().len()], [0.0; 2]);
        let (mut holds, mut limited) = (0, 0);
        let instants = 1500;
        for k in 0..instants {
            held.step().expect("bounded");
            held.read(&mut values).expect("as many");
            held.torque(values[0], &values[seen..seen + 8], &mut law).expect("two joints");
            let given = &values[u_m..u_m + 2];
            let at_limit =
                values[command..command + 2].iter().zip(&limits).any(|(u, limit)| u.abs() > *limit);
            limited += usize::from(at_limit);
            if values[certificate] == 1.0 {
                holds += 1;
                assert!(given == law && !at_limit, "{name} {k}: {given:?} and {law:?}");
            }
        }
        // Not idly: it holds where nothing is in the way, and never where the drive is always off.
        assert!(if hardly { holds <= 2 } else { holds > 100 && holds < instants }, "{name}: {holds}");
        let asks_for_more = name == "saturated" || name == "deadlines";
        assert!(!asks_for_more || limited > 0, "{name}");
        let mut short = scenario.clone();
        short.duration = f64::from(instants - 1) * scenario.control_period;
        let run = short.simulate().expect("good");
        let suspended = 1.0 - f64::from(holds) / f64::from(instants);
        assert!((run.summary.suspended_fraction - suspended).abs() < 1e-12, "{name}: the column's share");
    }
}

/// A guard stops the arm for a while: what it is late by counts, though the law follows the reference that it joins again.
#[test]
fn errors_count_from_the_reference_of_the_scenario() {
    let lost = "[guard]\nstop_damping = 4.0\n[[imperfection]]\nkind = \"dropout\"\nfrom = 2.5\nuntil = 2.6\n";
    let run = with("two-link-tanh-smooth", &[("duration = 10.0", "duration = 5.0")], lost)
        .simulate()
        .expect("good");
    let followed = run.trace.joints("e_l");
    let largest = followed.iter().flat_map(|e| e.iter()).fold(0.0, |most: f64, e| most.max(e.abs()));
    assert!(run.summary.max_abs_e_l > largest + 0.05, "{} and {largest} rad", run.summary.max_abs_e_l);
    let reason = run.summary.following.reasons.first().expect("it is late");
    assert_eq!(reason.measure, Some(Measure::Error));
    assert!(run.summary.final_abs_e_l < 1e-6, "joined again: {} rad", run.summary.final_abs_e_l);
}
