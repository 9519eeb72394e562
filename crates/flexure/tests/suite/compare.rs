//! Control laws on the same bench: ranks, what a comparison depends on, what becomes of laws that diverge.
#![expect(clippy::float_cmp, reason = "ranks are halves, and made-up errors have exact quotients")]

use flexure::compare::Entrant;
use flexure::compare::Leaderboard;
use flexure::compare::Score;
use flexure::compare::Search;
use flexure::compare::SeedScore;
use flexure::compare::Spread;
use flexure::compare::TIE;
use flexure::compare::Task;
use flexure::compare::TaskScores;
use flexure::compare::entrants;
use flexure::compare::tasks;
use flexure::compare::{check_budget, compare};
use flexure::files::{Outside, TASKS};
use flexure::imperfections::Imperfection;
use flexure::report::cost_figure;
use flexure::report::score_map;
use flexure::report::{WIDTH, leaderboard_page, leaderboard_table};
use flexure::scenario::load_scenario;

fn named(names: &[&str]) -> Vec<Entrant> {
    entrants(&names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>()).expect("known laws")
}

/// The first second of some built-in scenarios.
fn short(names: &[&str]) -> Vec<Task> {
    let cut = |name: &&str| {
        let mut scenario = load_scenario(name).expect("built in");
        scenario.duration = 1.0;
        Task::new(&scenario).expect("a good task")
    };
    names.iter().map(cut).collect()
}

/// A score that was never measured.
fn score(law: &str, error: f64) -> Score {
    let mut score = Score::failed(law, "");
    score.failure = None;
    score.diverged_at = error.is_nan().then_some(0.5);
    score.follows = !error.is_nan();
    score.seeds = vec![seed(0, error)];
    (score.penalised_error, score.rms_error, score.rms_torque, score.chatter) = (error, error, 1.0, 0.01);
    score
}

fn seed(seed: u64, error: f64) -> SeedScore {
    SeedScore { seed, penalised_error: error, rms_error: error, follows: !error.is_nan() }
}

/// A score with made-up errors of some seeds.
fn seeded(law: &str, errors: &[f64]) -> Score {
    let mut score = score(law, Spread::of(errors).median);
    score.seeds = (0..).zip(errors).map(|(k, error)| seed(k, *error)).collect();
    score.follows = errors.iter().all(|error| error.is_finite());
    score
}

fn task(name: &str, scores: Vec<Score>) -> TaskScores {
    TaskScores {
        task: name.to_owned(),
        scenario: name.to_owned(),
        random: false,
        seeds: scores.iter().map(|score| score.seeds.len()).max().unwrap_or(0),
        conditions: String::new(),
        needed_torque: 1.0,
        scores,
    }
    .ranked()
}

/// A task with made-up errors of the laws `vcbc`, `pd` and `cascade`.
fn made_up(name: &str, errors: [f64; 3]) -> TaskScores {
    task(name, ["vcbc", "pd", "cascade"].into_iter().zip(errors).map(|(law, e)| score(law, e)).collect())
}

/// Of one seed.
fn ranks(errors: &[f64]) -> Vec<f64> {
    flexure::compare::ranks(&errors.iter().map(|error| Spread::of(&[*error])).collect::<Vec<_>>())
}

#[test]
fn ranks_order_errors_and_share_ties() {
    assert_eq!(ranks(&[3.0, 1.0, 2.0]), [3.0, 1.0, 2.0]);
    // The first two are within 1 %, and so are none of the others.
    assert_eq!(ranks(&[1.0, 1.009, 1.011, 5.0]), [1.5, 1.5, 3.0, 4.0]);
    // A chain of ties ends where it leaves the first of its group.
    assert_eq!(ranks(&[1.0, 1.008, 1.016]), [1.5, 1.5, 3.0]);
    // What has no number shares the last ranks.
    assert_eq!(ranks(&[f64::NAN, 0.1, f64::NAN, f64::INFINITY]), [3.0, 1.0, 3.0, 3.0]);
    assert_eq!(ranks(&[]), [0.0; 0]);
}

/// Whatever the errors, ranks add up to n (n + 1) / 2.
#[test]
fn ranks_keep_their_sum() {
    for k in 0..50 {
        let errors: Vec<f64> = (0..9).map(|i| (f64::from(k * i) * 1.7).sin().abs().powi(k)).collect();
        let sum: f64 = ranks(&errors).iter().sum();
        assert!((sum - 45.0).abs() < 1e-12, "{errors:?}");
    }
}

#[test]
fn standings_are_means_of_ranks() {
    let tasks = vec![
        made_up("a", [1.0, 2.0, 4.0]),
        made_up("b", [4.0, 2.0, 1.0]),
        made_up("c", [f64::NAN, 2.0, 3.0]),
        made_up("d", [f64::NAN, 1.0, 1.005]),
    ];
    let board = Leaderboard::new(1, 0, tasks);
    let standing = |law: &str| board.ranking.iter().find(|standing| standing.law == law).expect("took part");
    let [pd, cascade, vcbc] = ["pd", "cascade", "vcbc"].map(standing);
    assert_eq!([pd.mean_rank, cascade.mean_rank, vcbc.mean_rank], [1.625, 1.875, 2.5]);
    assert_eq!([pd.place, cascade.place, vcbc.place], [1, 2, 3]);
    assert_eq!([pd.wins, cascade.wins, vcbc.wins], [2, 2, 1]);
    assert_eq!([pd.unfinished, cascade.unfinished, vcbc.unfinished], [0, 0, 2]);
    // Factors of pd: 2, 2, 1, 1. Those of v-CBC: 1, 4, and twice infinite.
    assert_eq!([pd.median_factor, vcbc.median_factor], [1.5, f64::INFINITY]);
    assert_eq!(board.ranking.iter().map(|s| s.law.as_str()).collect::<Vec<_>>(), ["pd", "cascade", "vcbc"]);
    let losses: Vec<_> =
        board.losses().iter().map(|l| (l.task.task.as_str(), l.factor(), l.better)).collect();
    assert_eq!(losses, [("b", 4.0, 2), ("c", f64::INFINITY, 2), ("d", f64::INFINITY, 2)]);
    assert_eq!(board.hopeless().count(), 0);
}

/// What overlaps with the best over the seeds is not worse; a law that does not follow with one of them is not ranked.
#[test]
fn errors_that_overlap_over_the_seeds_are_ties() {
    let [lucky, steady, apart, lost] = [
        seeded("lucky", &[3.0, 1.0, 2.0, 1.5, 9.0]),
        seeded("steady", &[4.0, 4.1, 4.2, 4.3, 4.4]),
        seeded("apart", &[10.0, 11.0, 12.0, 13.0, 14.0]),
        seeded("lost", &[0.1, 0.1, 0.1, 0.1, f64::NAN]),
    ];
    assert_eq!(lucky.error(), Spread { low: 1.0, median: 2.0, high: 9.0 });
    let board = Leaderboard::new(1, 0, vec![task("a", vec![apart, lost, steady, lucky])]);
    let rank = |law: &str| board.tasks[0].scores.iter().find(|score| score.law == law).expect("there").rank;
    assert_eq!(["lucky", "steady", "apart", "lost"].map(rank), [1.5, 1.5, 3.0, 4.0]);
    let standing = |law: &str| board.ranking.iter().find(|standing| standing.law == law).expect("there");
    // With the last seed alone steady is ahead: the two share the first place.
    assert_eq!((standing("lucky").mean_rank_low, standing("lucky").mean_rank_high), (1.0, 2.0));
    assert_eq!(["lucky", "steady", "apart", "lost"].map(|law| standing(law).place), [1, 1, 3, 4]);
    assert_eq!(["lucky", "steady", "lost"].map(|law| standing(law).wins), [1, 1, 0]);
    assert_eq!(standing("lost").unfinished, 1);
    let table = leaderboard_table(&board, WIDTH);
    assert!(table.contains("1000…9000") && table.contains("5 seeds"), "{table}");
    assert!(leaderboard_page(&board, &[]).contains("1000…9000"));
}

/// Where nothing draws a number every seed is the same, and one is enough; where only the search does, it begins with the same
/// runs; noise is another with every seed.
#[test]
fn seeds_matter_where_numbers_are_drawn() {
    let laws = named(&["vcbc", "pd"]);
    let of = |names: &[&str], budget: usize| {
        let search = Search { budget, seed: 3, seeds: 5 };
        let board = compare(&short(names), &laws, search, &|_, _| std::ops::ControlFlow::Continue(()));
        board.expect("good tasks").tasks.remove(0)
    };
    let seeds = |task: &TaskScores| task.scores[0].seeds.iter().map(|seed| seed.seed).collect::<Vec<_>>();
    let start = of(&["task-ideal-tracking"], 1);
    assert_eq!((seeds(&start), start.seeds, start.random), (vec![3], 1, false));
    let searched = of(&["task-ideal-tracking"], 8);
    assert_eq!((seeds(&searched), searched.random), (vec![3, 4, 5, 6, 7], false));
    let noisy = of(&["two-link-everything"], 1);
    assert_eq!((seeds(&noisy), noisy.random), (vec![3, 4, 5, 6, 7], true));
    let errors = noisy.scores[0].seeds.iter().map(|seed| seed.penalised_error.to_bits());
    assert_eq!(errors.collect::<std::collections::HashSet<_>>().len(), 5);
    // A search alone is the search among five.
    let search = Search { budget: 8, seed: 5, seeds: 1 };
    let alone =
        compare(&short(&["task-ideal-tracking"]), &laws, search, &|_, _| std::ops::ControlFlow::Continue(()))
            .expect("a good task");
    let (one, third) = (&alone.tasks[0].scores[0].seeds[0], &searched.scores[0].seeds[2]);
    assert_eq!(one.penalised_error.to_bits(), third.penalised_error.to_bits());
}

#[test]
fn equal_mean_ranks_share_a_place() {
    let board = Leaderboard::new(1, 0, vec![made_up("a", [1.0, 2.0, 4.0]), made_up("b", [2.0, 1.0, 4.0])]);
    assert_eq!(board.ranking.iter().map(|standing| standing.place).collect::<Vec<_>>(), [1, 1, 3]);
    let lost = Leaderboard::new(1, 0, vec![made_up("a", [f64::NAN; 3])]);
    assert_eq!(lost.hopeless().count(), 1);
    assert!(lost.losses().is_empty(), "nobody won");
}

/// Names are what makes a law; v-CBC with φ linear has two.
#[test]
fn laws_are_named_once() {
    assert_eq!(entrants(&[]).expect("all laws").len(), flexure::laws::CONTROLLERS.len() + 1);
    for entrant in entrants(&[]).expect("all laws") {
        assert_eq!(Entrant::named(&entrant.name()).expect("its own name"), entrant);
    }
    let refused = |names: &[&str]| {
        let names: Vec<_> = names.iter().map(|name| (*name).to_owned()).collect();
        let problem = entrants(&names).expect_err("refused");
        format!("{problem}: {}", problem.hint())
    };
    assert!(refused(&["pd", "vcbc:than"]).contains("did you mean 'vcbc:tanh'?"));
    assert!(refused(&["pd", "vcbc", "pd"]).contains("pd takes part twice"));
    assert!(check_budget(0).is_err() && check_budget(1).is_ok());
    let twice = tasks(&["two-link-tanh".to_owned(), "two-link-tanh".to_owned()], Outside::Refused)
        .expect_err("refused");
    assert!(twice.to_string().contains("two scenarios are called two-link-tanh"));
}

/// Every task of the suite loads, and says what is assumed about it; no two differ in their name alone.
#[test]
fn the_suite_has_tasks_of_every_sort() {
    let suite = tasks(&[], Outside::Refused).expect("built in");
    assert_eq!(suite.len(), TASKS.len());
    assert!(suite.len() >= 9);
    let kinds: Vec<_> =
        suite.iter().flat_map(|task| &task.scenario.imperfections).map(Imperfection::kind).collect();
    for kind in ["encoder", "velocity-filter", "saturation", "model-error", "delay", "push", "friction"] {
        assert!(kinds.contains(&kind), "{kind}");
    }
    for task in &suite {
        assert!(task.scenario.assumptions.iter().any(|a| a.file == task.scenario.name), "{}", task.name());
        assert!(
            task.needed_torque > 0.0 && task.needed_torque < 200.0,
            "{}: {}",
            task.name(),
            task.needed_torque
        );
        let usage = flexure::feasible::usage(&task.scenario).expect("a path");
        assert!(usage.iter().all(|usage| usage.share < 1.0), "{}: {usage:?}", task.name());
    }
}

/// In a pool of `threads` threads.
fn compared(threads: usize, tasks: &[Task], laws: &[Entrant], budget: usize) -> Leaderboard {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    pool.install(|| {
        let search = Search { budget, seed: 5, seeds: 2 };
        compare(tasks, laws, search, &|_, _| std::ops::ControlFlow::Continue(())).expect("good tasks")
    })
}

/// The whole contract of `--json`, and with it every number, is the same to the bit on one thread and on two, whatever
/// finishes first; and nothing depends on what else is compared.
#[test]
fn results_depend_on_task_law_budget_and_seed_alone() {
    let tasks = short(&["two-link-tanh-smooth", "task-delay-1ms"]);
    let laws = named(&["vcbc", "pd", "feedforward-pd"]);
    let board = compared(1, &tasks, &laws, 6);
    let text = |board: &Leaderboard| serde_json::to_string(board).expect("JSON");
    assert_eq!(text(&board), text(&compared(2, &tasks, &laws, 6)));
    let alone = compared(1, &tasks[1..], &laws[1..2], 6);
    let (a, b) = (&alone.tasks[0].scores[0], &board.tasks[1].scores[1]);
    assert_eq!((a.penalised_error.to_bits(), &a.gains), (b.penalised_error.to_bits(), &b.gains));

    let page = |board: &Leaderboard| leaderboard_page(board, &[]);
    assert_eq!(page(&board), page(&compared(2, &tasks, &laws, 6)));
    assert!(leaderboard_table(&board, WIDTH).lines().all(|line| line.chars().count() <= 100));
}

/// The budget is kept, the search never makes a law worse, and what ranks is the error it reports.
#[test]
fn scores_are_what_they_say() {
    let tasks = short(&["two-link-tanh-smooth"]);
    let search = Search { budget: 8, seed: 1, seeds: 1 };
    let board = compare(&tasks, &named(&["pd", "vcbc", "vcbc:tanh"]), search, &|_, _| {
        std::ops::ControlFlow::Continue(())
    })
    .expect("good tasks");
    for score in &board.tasks[0].scores {
        assert!(score.evaluations <= 8, "{score:?}");
        assert!(score.penalised_error <= score.penalised_error_at_start, "{score:?}");
        let penalty = (1.0 + (score.chatter / 0.05).powi(2)).sqrt();
        // Two ways to the same number: logarithm and exponential cost a few roundings of an exponent of about 20.
        assert!((score.penalised_error / (score.rms_error * penalty) - 1.0).abs() < 1e-12, "{score:?}");
        assert!(score.max_error >= score.rms_error && !score.gains.is_empty());
        assert_eq!(score.chatters(), score.chatter > 0.05);
    }
    let best = board.tasks[0].scores.iter().min_by(|a, b| a.penalised_error.total_cmp(&b.penalised_error));
    assert!(best.is_some_and(|best| board.tasks[0].is_best(best) && best.rank < 2.0 + TIE));
}

/// Torque that acts a tenth of a second late throws v-CBC off, with drives without limits beyond all bounds and with those of the
/// arm to and fro between them; springs on the motors stay.
#[test]
fn laws_that_do_not_follow_come_last() {
    for unlimited in [false, true] {
        laws_that_are_late(unlimited);
    }
}

fn laws_that_are_late(unlimited: bool) {
    let mut scenario = load_scenario("task-delay-4ms").expect("built in");
    scenario.duration = 6.0;
    scenario.plant.unlimited = unlimited;
    scenario.accept.error = Some(vec![0.6; 2]);
    for imperfection in &mut scenario.imperfections {
        if let Imperfection::Delay(delay) = imperfection {
            delay.computation = 0.1;
        }
    }
    let tasks = [Task::new(&scenario).expect("a good task")];
    let search = Search { budget: 1, ..Search::default() };
    let board = compare(&tasks, &named(&["vcbc", "pd"]), search, &|_, _| std::ops::ControlFlow::Continue(()))
        .expect("a good task");
    let [vcbc, pd] = &board.tasks[0].scores[..] else { panic!("{board:?}") };
    assert!(!vcbc.finished() && pd.finished(), "{board:?}");
    assert_eq!(vcbc.diverged_at.is_some_and(|t| t < 6.0), unlimited, "{vcbc:?}");
    assert!(!vcbc.reasons.is_empty() && vcbc.error().median.is_infinite());
    assert_eq!([vcbc.rank, pd.rank], [2.0, 1.0]);
    assert_eq!(board.ranking[1].law, "vcbc");
    let json = serde_json::to_value(&board).expect("JSON");
    assert_eq!(json["tasks"][0]["scores"][0]["rms_error"].is_null(), unlimited);
    assert!(
        leaderboard_table(&board, WIDTH).contains('—')
            && cost_figure(&board).svg().contains("follow nowhere:")
    );
}

/// Numbers that there are not leave no trace in figures.
#[test]
fn figures_are_drawings_with_finite_numbers() {
    let tasks =
        vec![made_up("a", [1e-3, f64::NAN, 2e-3]), made_up("b", [f64::NAN; 3]), made_up("c", [1e-3; 3])];
    let board = Leaderboard::new(1, 0, tasks);
    // Circles are the first law's: in the legend and among the points.
    for (figure, circles) in [(cost_figure(&board), 2), (score_map(&board), 0)] {
        let svg = figure.svg();
        let document = roxmltree::Document::parse(&svg).expect("well-formed");
        assert_eq!(document.descendants().filter(|node| node.has_tag_name("circle")).count(), circles);
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        for law in board.laws() {
            assert!(document.descendants().any(|node| node.text() == Some(law)), "{law} in the legend");
        }
        assert!(figure.png().is_ok());
    }
}
