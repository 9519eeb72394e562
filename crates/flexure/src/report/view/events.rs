//! What happens in a run, for its page.

use serde::Serialize;

use super::Viewed;
use crate::simulate::Stopped;

/// Something that happens at an instant.
#[derive(Serialize)]
pub(super) struct Event {
    t: f64,
    kind: &'static str,
    joint: Option<usize>,
    words: String,
}

/// Stops of the guard and how they end, torques that reach their limits, and where the loop ends before its time, in the order of time.
pub(super) fn events(viewed: &Viewed<'_>) -> Vec<Event> {
    let Viewed { scenario, run, sketch, film, .. } = *viewed;
    let name = |joint: usize| scenario.robot.joints.get(joint).map_or("the controller", |joint| &joint.name);
    let end = film.end();
    // The guard's own log has its last stops alone, with their causes.
    let cause_at = |t: f64| {
        let near = |stop: &&Stopped| (stop.time - t).abs() < 0.5 * scenario.control_period;
        run.faults.iter().flat_map(|faults| &faults.stops).find(near)
    };
    let stops = sketch.stops().map(|stop| {
        let why = cause_at(stop.low);
        let joint = why.and_then(|why| why.joint).map(|joint| joint as usize);
        let at = why
            .and_then(|why| why.side)
            .zip(joint)
            .map_or(String::new(), |(side, joint)| format!(", {side} side of {}", name(joint)));
        let why = why.map_or(String::new(), |why| format!(": {}", cause(why.cause)));
        Event { t: stop.low, kind: "stop", joint, words: format!("the guard stops the robot{why}{at}") }
    });
    let ended = sketch.stops().filter(|stop| stop.high < end).map(|stop| Event {
        t: stop.high,
        kind: "rejoin",
        joint: None,
        words: "the guard lets the robot go on".to_owned(),
    });
    let reached = film.at_limit().map(|(joint, t)| {
        let words = format!("the torque of {} is at its limit", name(joint));
        Event { t, kind: "limit", joint: Some(joint), words }
    });
    let diverged = run.divergence.map(|divergence| Event {
        t: divergence.time,
        kind: "diverged",
        joint: None,
        words: divergence.to_string(),
    });
    let broken_off = run.broken_off.map(|t| Event {
        t,
        kind: "fault",
        joint: None,
        words: "the run was broken off".to_owned(),
    });
    let all = stops.chain(ended).chain(reached).chain(diverged).chain(broken_off);
    // What ends a run comes after its last instant: it is shown there.
    let mut events: Vec<Event> = all.map(|event| Event { t: event.t.min(end), ..event }).collect();
    events.sort_by(|a, b| a.t.total_cmp(&b.t));
    events
}

/// Why a guard stops a robot, for who does not know its words.
fn cause(name: &str) -> String {
    if name == "not-finite" { "a reading is no number".to_owned() } else { name.replace('-', " ") }
}
