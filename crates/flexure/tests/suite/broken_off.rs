//! Long jobs that are broken off: they end soon, and what they found until then holds.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use flexure::compare::{Leaderboard, Search, Task, compare, entrants};
use flexure::margins::{Edge, margins};
use flexure::progress::unwatched;
use flexure::prove::question::{Direct, Question, Region, prove, prove_watched};
use flexure::reproduce::reproduce;
use flexure::scenario::load_scenario;
use flexure::simulate::{Run, run};
use flexure::tune::tune;

/// Long jobs end soon after their watcher says so, and say that they were broken off.
#[test]
fn long_jobs_can_be_broken_off() {
    let calls = AtomicUsize::new(0);
    let after = |limit: usize| {
        calls.store(0, Ordering::Relaxed);
        let calls = &calls;
        move |_: f64| match calls.fetch_add(1, Ordering::Relaxed) {
            seen if seen >= limit => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    };
    let scenario = load_scenario("two-link-hardware").expect("built in");
    let broken = run(&scenario, &after(10)).expect("a part of a run");
    let (time, following) = (broken.broken_off.expect("broken off"), &broken.summary.following);
    assert_eq!((calls.load(Ordering::Relaxed), broken.trace.len()), (11, 11));
    assert!((time - 10.0 * scenario.control_period).abs() < 1e-12, "{time}");
    assert!(!following.follows && following.reasons[0].words.contains("broken off"), "{following:?}");
    // What was simulated is what a run that goes on begins with.
    let whole = run(&scenario, &unwatched).expect("good");
    let errors = |run: &Run| run.trace.column("e_l1").map(|errors| errors[..11].to_vec());
    assert!(errors(&whole).is_some());
    assert_eq!((errors(&broken), whole.broken_off), (errors(&whole), None));
    assert!(tune(&scenario, 1000, 0, &after(3)).expect_err("broken off").is_interrupted());
    assert!(margins(&scenario, &after(2)).expect_err("broken off").is_interrupted());
    let open = margins(&scenario, &after(3 * whole.trace.len())).expect("open margins");
    let whole = margins(&scenario, &unwatched).expect("good");
    assert!(open.broken_off && !whole.broken_off);
    let pairs =
        [(&open.delay, &whole.delay), (&open.gain_high, &whole.gain_high), (&open.noise, &whole.noise)];
    assert!(pairs.iter().any(|(open, _)| matches!(open, Edge::Open { .. })), "{open:?}");
    for (open, whole) in pairs {
        match open {
            // It holds less far than the search would have come.
            Edge::Open { holds } => {
                assert!(Some(*holds) <= whole.holds().or(Some(0.0)), "{open:?} {whole:?}");
            }
            found => assert_eq!(found, whole),
        }
    }
    let folder = tempfile::tempdir().expect("a folder");
    let parts = reproduce(folder.path(), &|_, _| ControlFlow::Break(())).expect("parts of runs");
    assert!(parts.iter().all(|(part, _)| part.run.broken_off == Some(0.0) && part.sampled.is_none()));
    drop(parts);
    assert_eq!(std::fs::read_dir(folder.path()).expect("there").count(), 0, "traces that nobody keeps go");
}

/// Tasks that every law was finished on are ranked as alone; of others there is what was finished.
#[test]
fn comparisons_have_whole_tasks() {
    let short = |name: &str| {
        let mut scenario = load_scenario(name).expect("built in");
        scenario.duration = 0.5;
        Task::new(&scenario).expect("good")
    };
    let tasks = ["task-soft", "task-stiff"].map(short);
    let laws = entrants(&["pd", "vcbc"].map(str::to_owned)).expect("laws");
    let search = Search { budget: 3, seeds: 1, ..Search::default() };
    let until = |tasks: &[Task], first: usize| {
        compare(tasks, &laws, search, &|pair, _| {
            if pair < first { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        })
    };
    assert!(until(&tasks, 0).expect_err("nothing").is_interrupted());
    let json = |board: &Leaderboard| serde_json::to_string(board).expect("JSON");
    let alone = json(&until(&tasks[..1], 2).expect("a whole task"));
    assert_eq!(json(&until(&tasks, 2).expect("a whole task")), alone);
    let board = until(&tasks, 3).expect("a task and a half");
    assert_eq!((board.tasks.len(), board.unfinished.len(), board.ranking.len()), (1, 1, 2));
    let laws: Vec<&str> = board.unfinished[0].scores.iter().map(|score| score.law.as_str()).collect();
    assert_eq!(laws, ["pd"]);
    let half = until(&tasks, 1).expect("half a task");
    assert_eq!((half.tasks.len(), half.unfinished.len(), half.ranking.len()), (0, 1, 0));
    assert!(json(&half).contains("\"unfinished\"") && !alone.contains("\"unfinished\":["), "{alone}");
}

/// The rates are proved or nothing is, and what was not looked at is told.
#[test]
fn proofs_keep_what_is_proved() {
    let scenario = load_scenario("two-link-tanh").expect("built in");
    let question = Question {
        region: Region::Errors(vec![3.0; 4]),
        direct: Some(Direct { budget: 1000 }),
        ..Question::default()
    };
    let until = |limit: f64| {
        prove_watched(&scenario, &question, &|fraction| {
            if fraction < limit { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        })
    };
    assert!(until(0.0).expect_err("nothing").is_interrupted());
    let (part, whole) = (until(0.03).expect("rates"), prove(&scenario, &question).expect("all"));
    assert!(part.broken_off && part.confirmation.is_none() && !whole.broken_off);
    assert_eq!(part.verdict.proved(), whole.verdict.proved());
    let (problem, is_wrong) = part.complaint(&scenario).expect("not all that was asked");
    assert_eq!((problem.code_word(), is_wrong), ("interrupted", false));
    assert!(whole.complaint(&scenario).is_none());
}
