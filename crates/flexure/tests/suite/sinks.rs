//! Rows of a run as they are made: into memory, into a file, into what breaks off.

use std::fs;
use std::num::NonZeroU32;
use std::ops::ControlFlow;
use std::path::Path;

use flexure::files::WriteError;
use flexure::progress::unwatched;
use flexure::scenario::{Scenario, load_scenario};
use flexure::simulate::{Excerpt, LimitWatch, Sink, Trace, TraceFile, exceeded, run, run_into, write_trace};

fn short(name: &str, duration: f64) -> Scenario {
    let mut scenario = load_scenario(name).expect("built in");
    scenario.duration = duration;
    scenario
}

fn every(rows: u32) -> NonZeroU32 {
    NonZeroU32::new(rows).expect("not zero")
}

/// What a run writes on its way.
fn streamed(scenario: &Scenario, path: &Path, excerpt: Excerpt) -> String {
    let mut file = TraceFile::create(path, excerpt).expect("a folder");
    run_into(scenario, &mut [&mut file], &unwatched).expect("good");
    assert!(!path.exists(), "it has no name before it is kept");
    file.keep().expect("written");
    fs::read_to_string(path).expect("there")
}

#[test]
fn the_file_of_a_run_is_that_of_its_trace() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    for name in ["pendulum-tanh", "two-link-everything", "task-panda"] {
        let scenario = short(name, 0.3);
        let kept = run(&scenario, &unwatched).expect("good");
        write_trace(&at("kept.csv"), &kept.trace).expect("written");
        let whole = fs::read_to_string(at("kept.csv")).expect("there");
        let signals = scenario.signals().expect("good");
        assert!(streamed(&scenario, &at(name), Excerpt::whole(&signals)) == whole, "{name}");
        assert_eq!(whole.lines().count(), kept.trace.len() + 1);

        let patterns = ["u_m*", "q_l1", "u_m1"].map(str::to_owned);
        let part = Excerpt::new(&signals, &patterns, every(7)).expect("there are such columns");
        let names: Vec<String> = part.names().map(str::to_owned).collect();
        let part = streamed(&scenario, &at("part.csv"), part);
        fs::remove_file(at("part.csv")).expect("there");
        let mut rows = csv::Reader::from_reader(part.as_bytes());
        assert_eq!(rows.headers().expect("a header").iter().collect::<Vec<_>>(), names);
        let rows: Vec<Vec<f64>> = rows
            .records()
            .map(|row| row.expect("a row").iter().map(|cell| cell.parse().expect("a number")).collect())
            .collect();
        assert_eq!(rows.len(), kept.trace.len().div_ceil(7));
        for (column, name) in names.iter().enumerate() {
            let wanted = kept.trace.column(name).expect("there").iter().step_by(7);
            // Bit by bit, NaN too.
            let found = rows.iter().map(|row| row[column].to_bits());
            assert!(found.eq(wanted.map(|value| value.to_bits())), "{name}");
        }
    }
}

/// Breaks off after so many rows.
struct Short(usize);

impl Sink for Short {
    fn take(&mut self, _: &[f64]) -> ControlFlow<()> {
        self.0 -= 1;
        if self.0 == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

#[test]
fn a_sink_that_breaks_off_ends_the_run_for_all() {
    let scenario = short("pendulum-tanh", 0.1);
    let signals = scenario.signals().expect("good");
    let names = || signals.iter().map(|signal| (signal.name.clone(), signal.unit));
    let (mut before, mut after) = (Trace::new(names()), Trace::new(names()));
    let found =
        run_into(&scenario, &mut [&mut before, &mut Short(5), &mut after], &unwatched).expect("a part");
    assert_eq!((before.len(), after.len(), found.trace.len()), (5, 5, 0));
    assert!((found.broken_off.expect("broken off") - 4.0 * scenario.control_period).abs() < 1e-12);
    // At the last instant there is nothing left to break off.
    let whole = run_into(&scenario, &mut [&mut Short(101)], &unwatched).expect("all of it");
    assert!(whole.broken_off.is_none() && whole.summary.following.follows, "{:?}", whole.summary.following);
}

#[test]
fn a_file_that_is_not_kept_leaves_what_was_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("trace.csv");
    fs::write(&path, "old").expect("written");
    let scenario = short("pendulum-tanh", 0.05);
    let excerpt = Excerpt::whole(&scenario.signals().expect("good"));
    let mut file = TraceFile::create(&path, excerpt.clone()).expect("a folder");
    run_into(&scenario, &mut [&mut file], &unwatched).expect("good");
    assert_eq!(fs::read_dir(folder.path()).expect("there").count(), 2);
    drop(file);
    assert_eq!(fs::read_dir(folder.path()).expect("there").count(), 1);
    assert_eq!(fs::read_to_string(&path).expect("there"), "old");
    assert!(matches!(TraceFile::create(folder.path(), excerpt), Err(WriteError::NotAFile { .. })));
}

/// What is said of a recorded run is said of one that was watched.
#[test]
fn limits_are_watched_on_the_way() {
    let scenario = short("two-link-everything", 2.0);
    let mut robot = scenario.robot.clone();
    let limits = &mut robot.limits;
    (limits.upper[0], limits.lower[1], limits.velocity[0], limits.deflection[1]) = (0.01, 0.1, 0.05, 1e-4);
    let mut watch = LimitWatch::new(&robot, &scenario.signals().expect("good"));
    let mut trace = Trace::from(&scenario.signals().expect("good")[..]);
    run_into(&scenario, &mut [&mut watch, &mut trace], &unwatched).expect("good");
    let words =
        |problems: Vec<flexure::files::Problem>| problems.iter().map(ToString::to_string).collect::<Vec<_>>();
    let watched = words(watch.warnings());
    assert_eq!(watched, words(exceeded(&robot, &trace)));
    let keys = ["position_upper", "velocity_limit", "position_lower", "deflection_limit"];
    assert_eq!(watched.len(), keys.len(), "{watched:?}");
    assert!(watched.iter().zip(keys).all(|(words, key)| words.contains(key)), "{watched:?}");
}
