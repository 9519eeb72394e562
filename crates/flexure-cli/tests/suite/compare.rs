//! `flexure compare`.

use crate::command::{Place, SCENARIO, altered};

/// A second of the paper's arm, joined smoothly.
fn short() -> String {
    let smooth = "[reference.smooth_start]\nduration = 0.5\n[controller]";
    altered(SCENARIO, &[("duration = 10.0", "duration = 1.0"), ("[controller]", smooth)])
}

#[test]
fn a_comparison_leaves_a_table_a_page_and_figures() {
    let place = Place::new();
    place.write("short.toml", short());
    let args = ["compare", "short.toml", "--controllers", "vcbc,pd", "--budget", "2"];
    let outcome = place.run(&args).done();
    for fragment in ["vcbc", "pd", "place", "compare.html"] {
        assert!(outcome.stdout.contains(fragment), "no {fragment} in\n{}", outcome.stdout);
    }
    assert!(outcome.stdout.lines().all(|line| line.chars().count() <= 100), "{}", outcome.stdout);
    let names = [
        "compare-cost.png",
        "compare-cost.svg",
        "compare-map.png",
        "compare-map.svg",
        "compare.csv",
        "compare.html",
    ];
    assert_eq!(place.names("out"), names);
    let rows = place.read("out/compare.csv");
    assert_eq!(rows.lines().count(), 3);
    assert!(rows.lines().next().unwrap().ends_with(",measures,proved"), "{rows}");
    for (law, about) in [(",vcbc,", ",all,tracking"), (",pd,", ",q_m dq_m,regulation")] {
        assert!(rows.lines().any(|row| row.contains(law) && row.ends_with(about)), "{rows}");
    }
    assert!(place.read("out/compare.html").contains("Where v-CBC is not the best"));

    let json = place.run(&[&args[..], &["--json", "--out", "other"]].concat()).done().json();
    assert_eq!((&json["budget"], &json["seed"]), (&2.into(), &0.into()));
    assert_eq!(json["ranking"].as_array().unwrap().len(), 2);
    assert_eq!(json["files"].as_array().unwrap().len(), names.len());
    let scores = json["tasks"][0]["scores"].as_array().unwrap();
    for score in scores {
        for key in ["law", "rank", "rms_error", "max_error", "rms_torque", "chatter", "saturated_fraction"] {
            assert!(!score[key].is_null(), "{key} in {score}");
        }
        assert!(score["gains"].as_array().is_some_and(|gains| !gains.is_empty()));
        assert_eq!((&score["evaluations"], &score["diverged_at"]), (&2.into(), &serde_json::Value::Null));
    }
    assert_eq!(place.read("out/compare.csv"), place.read("other/compare.csv"), "to the last digit");
}

/// What `run` refuses of a law takes no part, and it is said why: a memory moves from instant to instant.
#[test]
fn laws_with_memory_have_instants() {
    let place = Place::new();
    place.write("short.toml", short());
    let compare = |laws: &str| {
        let with = ["--controllers", laws, "--budget", "1", "--set", "hold=continuous"];
        place.run(&[&["compare", "short.toml"], &with[..]].concat())
    };
    let said = compare("vcbc,pid").done().stdout;
    assert!(said.contains("pid could not run on short: ") && said.contains("the memory of 'pid'"), "{said}");
    compare("adaptive-vcbc,pid").refused(&["contradiction", "moves from instant to instant"]);
}

#[test]
fn bad_questions_are_refused() {
    let place = Place::new();
    place.write("short.toml", short()).scenario("bad.toml", &[("duration = 10.0", "duration = -1")]);
    place.write("folder/short.toml", short());
    let refused = |args: &[&str], fragments: &[&str]| {
        place.run(&[&["compare"], args].concat()).refused(fragments);
        assert_eq!(place.names("out"), [""; 0]);
    };
    refused(
        &["short.toml", "--controllers", "vcbc,pdd"],
        &["no controller is called 'pdd'", "did you mean 'pd'?"],
    );
    refused(&["short.toml", "--controllers", "pd,vcbc,pd"], &["pd takes part twice"]);
    refused(
        &["short.toml", "--controllers", "vcbc,vcbc:linear"],
        &["'vcbc:linear'", "known: vcbc, vcbc:tanh"],
    );
    refused(&["short.toml", "--controllers", ""], &["no controller is called ''"]);
    refused(&["short.toml", "--budget", "0"], &["budget is 0 runs"]);
    refused(&["short.toml", "--seeds", "0"], &["number of seeds is 0"]);
    refused(&["short.toml", "bad.toml"], &["bad.toml:4:12", "duration is -1 s"]);
    refused(&["short.toml", "folder/short.toml"], &["two scenarios are called short"]);
    refused(&["task-ideal-trackin"], &["did you mean 'task-ideal-tracking'?"]);
    let outcome = place.run(&["compare", "--budget", "-3"]);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
}

/// Nothing holds an arm whose torque comes half a second late: the answer is no, and the table is there.
#[test]
fn a_task_that_no_law_survives_is_an_answer() {
    let place = Place::new();
    let late = "[[imperfection]]\nkind = \"delay\"\ncomputation = 0.3\n\n[controller]";
    place.write(
        "late.toml",
        altered(&short(), &[("duration = 1.0", "duration = 4.0"), ("[controller]", late)]),
    );
    let outcome =
        place.run(&["compare", "late.toml", "--controllers", "backstepping,cascade", "--budget", "1"]);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    outcome.said(&["no law follows the reference on late"]);
    assert!(outcome.stdout.contains('—'));
    assert!(place.names("out").contains(&"compare.html".to_owned()));
}
