//! `flexure run`: one closed loop and its files.

use serde_json::Value;

use crate::command::{Outcome, Place, ROBOT, assert_summary};

const SHORT: (&str, &str) = ("duration = 10.0", "duration = 0.05");

#[test]
fn text_names_the_files_and_json_has_the_summary() {
    let place = Place::new();
    place.scenario("short.toml", &[SHORT]);
    let text = place.run(&["run", "short.toml"]).done();
    assert_eq!(text.stderr, "");
    let files = ["out/short.csv", "out/short.svg", "out/short.png"];
    for file in files {
        assert!(text.stdout.contains(&format!("wrote {file}")), "{}", text.stdout);
    }
    let trace = place.read("out/short.csv");

    let summary = place.run(&["run", "short.toml", "--json", "--out", "other/place"]).done().json();
    assert_summary(&summary);
    assert_eq!(summary["name"], "short");
    assert_eq!((&summary["controller"], &summary["phi"]), (&"vcbc".into(), &"tanh".into()));
    assert_eq!(summary["diverged_at"], Value::Null);
    assert_eq!(summary["files"][0], "other/place/short.csv");
    assert_eq!(place.names("other/place"), ["short.csv", "short.png", "short.svg"]);
    assert_eq!(place.read("other/place/short.csv"), trace);
}

#[test]
fn the_trace_has_a_row_an_instant_and_numbers_everywhere() {
    let place = Place::new();
    place.scenario("short.toml", &[SHORT]);
    place.run(&["run", "short.toml"]).done();
    let trace = place.read("out/short.csv");
    let mut lines = trace.lines();
    let header: Vec<_> = lines.next().unwrap().split(',').collect();
    let vectors = ["q_l", "q_m", "dq_l", "dq_m", "q_ld", "e_l", "e_m", "sigma_l", "sigma_m", "u_l", "u_m"];
    for column in vectors.iter().flat_map(|name| [format!("{name}1"), format!("{name}2")]) {
        assert!(header.contains(&&*column), "{column} in {header:?}");
    }
    assert_eq!(header[0], "t");
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 51, "both ends are recorded");
    assert!(rows.iter().all(|row| row.len() == header.len() && row.iter().all(|x| x.is_finite())));
    for (k, row) in (0_u32..).zip(&rows) {
        assert!((row[0] - 1e-3 * f64::from(k)).abs() < 1e-12, "row {k} is at {} s", row[0]);
    }
}

/// The files are those of the built-in scenario under another name: so are the numbers.
#[test]
fn a_scenario_elsewhere_names_its_robot_by_a_relative_path() {
    let place = Place::new();
    place.write("data/robots/arm.toml", ROBOT);
    place.scenario("data/scenarios/mine.toml", &[("\"quanser-2dof\"", "\"../robots/arm.toml\""), SHORT]);
    place.scenario("built-in.toml", &[SHORT]);
    place.run(&["run", "data/scenarios/mine.toml"]).refused(&["mine.toml:3:9", "--allow-outside"]);
    place.run(&["run", "data/scenarios/mine.toml", "--allow-outside"]).done();
    place.run(&["run", "built-in.toml"]).done();
    assert_eq!(place.read("out/mine.csv"), place.read("out/built-in.csv"));
    let absolute = place.path().join("data/scenarios/mine.toml");
    let elsewhere = Place::new();
    elsewhere.run(&["--allow-outside", "run", absolute.to_str().unwrap()]).done();
    assert_eq!(elsewhere.read("out/mine.csv"), place.read("out/mine.csv"));
}

#[test]
fn an_uneven_duration_is_said_and_rounded_to_whole_periods() {
    let place = Place::new();
    place.scenario("uneven.toml", &[("duration = 10.0", "duration = 0.0124")]);
    let outcome = place.run(&["run", "uneven.toml"]).done();
    for fragment in ["uneven.toml:4:", "no multiple of control_period", "12 periods, 0.012 s"] {
        assert!(outcome.stderr.contains(fragment), "{}", outcome.stderr);
    }
    assert_eq!(outcome.stderr.matches("warning[").count(), 1, "{}", outcome.stderr);
    assert_eq!(place.read("out/uneven.csv").lines().count(), 14);
}

#[test]
fn a_later_run_replaces_the_files_of_an_earlier_one() {
    let place = Place::new();
    place.write("out/short.csv", "old").scenario("short.toml", &[SHORT]);
    place.run(&["run", "short.toml"]).done();
    assert!(place.read("out/short.csv").starts_with("t,"));
    assert_eq!(place.names("out").len(), 3);
}

/// A loop that misses every deadline stays where it is, bounded and lost: the answer is no, with joint, value, limit and time.
#[test]
fn a_loop_that_does_not_follow_is_an_answer() {
    let place = Place::new();
    let late = "[[imperfection]]\nkind = \"deadline\"\nprobability = 1.0\n\n[sources]";
    place.scenario("late.toml", &[("duration = 10.0", "duration = 2.0"), ("[sources]", late)]);
    let outcome = place.run(&["run", "late.toml"]);
    assert_eq!(outcome.code, Some(1), "{outcome:?}");
    outcome.said(&[
        "error[lost]",
        "late: the loop does not follow: joint joint1: position error of",
        "[accept]",
    ]);
    assert!(outcome.stdout.contains("follows its reference: no; accepted are"), "{}", outcome.stdout);
    assert!(outcome.stdout.contains("from t = 1 s on (half of the run)"), "{}", outcome.stdout);

    let outcome = place.run(&["run", "late.toml", "--json"]);
    assert_eq!(outcome.code, Some(1));
    let summary = outcome.json();
    assert_summary(&summary);
    assert_eq!((&summary["follows"], &summary["diverged_at"]), (&false.into(), &Value::Null));
    let reason = &summary["reasons"][0];
    assert_eq!((&reason["joint"], &reason["measure"]), (&"joint1".into(), &"error".into()));
    assert_eq!(reason["limit"], 0.05);
    assert!(reason["value"].as_f64().unwrap() > 0.8 && reason["time"].as_f64().unwrap() >= 1.0, "{reason}");
    assert_eq!(summary["accepted"]["bounds"].as_array().unwrap().len(), 6);

    place.scenario("sound.toml", &[("duration = 10.0", "duration = 0.5")]);
    let outcome = place.run(&["run", "sound.toml", "--json"]).done();
    assert_eq!(
        (&outcome.json()["follows"], &outcome.json()["reasons"]),
        (&true.into(), &Value::Array(vec![]))
    );
}

/// Some columns and rows: those of the whole trace, and nothing else of the answer changes.
#[test]
fn a_trace_has_the_columns_and_rows_that_are_asked_for() {
    let place = Place::new();
    place.scenario("short.toml", &[SHORT]);
    let cells = |args: &[&str]| {
        place.run(&[&["run", "short.toml", "--out", "part"], args].concat()).done();
        let table = |path: &str| -> Vec<Vec<String>> {
            place.read(path).lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
        };
        table("part/short.csv")
    };
    let whole = cells(&[]);
    let figure = place.read("part/short.svg");
    for (args, names, every) in [
        (&["--columns", "u_m?,q_l1,t,u_m1"][..], "t q_l1 u_m1 u_m2", 1),
        (&["--columns", "e_l*", "--columns", "rate", "--every", "7"], "t e_l1 e_l2 rate", 7),
        (&["--columns", "t", "--every", "50"], "t", 50),
        (&["--columns", "t", "--every", "4294967295"], "t", 4_294_967_295),
        (&["--every", "1"], &whole[0].join(" "), 1),
    ] {
        let part = cells(args);
        assert_eq!(part[0].join(" "), names, "{args:?}");
        let columns: Vec<usize> =
            part[0].iter().map(|name| whole[0].iter().position(|other| other == name).unwrap()).collect();
        let wanted: Vec<Vec<String>> = whole[1..]
            .iter()
            .step_by(every)
            .map(|row| columns.iter().map(|&column| row[column].clone()).collect())
            .collect();
        assert_eq!(part[1..], wanted, "{args:?}");
        assert_eq!(place.read("part/short.svg"), figure, "{args:?}");
    }
}

#[test]
fn columns_and_rows_that_there_are_not_are_refused_before_the_run() {
    let place = Place::new();
    place.scenario("short.toml", &[SHORT]);
    for (args, fragments) in [
        (&["--columns", "q_l3"][..], &["error[unknown-name]", "is 'q_l3'", "did you mean 'q_l1'?"][..]),
        (&["--columns", "Q-L1"], &["did you mean 'q_l1'?"]),
        (&["--columns", "q_l"], &["is 'q_l'", "q_l* is all that begin with q_l"]),
        (&["--columns", "x*"], &["matches 'x*'", "known: t, q_l1"]),
        (&["--columns", "q_l1,,u_m1"], &["is ''"]),
        (&["--columns", ""], &["is ''"]),
        (&["--columns", "q_l1", "--columns", "u_l1,phase"], &["is 'phase'"]),
    ] {
        place.run(&[&["run", "short.toml"], args].concat()).refused(fragments);
        let json = place.run(&[&["run", "short.toml", "--json"], args].concat());
        assert_eq!(json.json()["error"]["code"], "unknown-name");
    }
    for number in ["0", "-1", "0.01", "ten", "", "4294967296", "nan", "1e3"] {
        let args = ["run", "short.toml", "--json", "--every", number];
        let outcome = place.run(&args);
        assert_eq!((outcome.code, &outcome.json()["error"]["code"]), (Some(2), &"usage".into()), "{number}");
        assert!(outcome.stderr.contains("whole number of control periods from 1"), "{outcome:?}");
    }
    assert_eq!(place.run(&["run", "short.toml", "--every", "2", "--every", "3"]).code, Some(2));
    assert!(!place.path().join("out").exists(), "nothing was begun");
}

/// What cannot be written ends the run, says so, and leaves what was there.
#[test]
#[cfg(unix)]
fn a_trace_that_cannot_be_written_ends_the_run() {
    let place = Place::new();
    place.write("out/long.csv", "old").scenario("long.toml", &[("duration = 10.0", "duration = 900.0")]);
    let limited = |args: &[&str]| {
        // As a full disk: no file may grow beyond some kilobytes.
        let script = "ulimit -f 64; trap '' XFSZ; exec \"$0\" \"$@\"";
        let mut command = std::process::Command::new("sh");
        command.args(["-c", script, env!("CARGO_BIN_EXE_flexure")]).args(args).current_dir(place.path());
        Outcome::from(command.env("NO_COLOR", "1").output().unwrap())
    };
    limited(&["run", "long.toml"]).refused(&["error[write]", "cannot write out/long.csv"]);
    assert_eq!(limited(&["run", "long.toml", "--json"]).json()["error"]["code"], "write");
    limited(&["reproduce", "--out", "out"]).refused(&["error[write]", "cannot write out/two-link-"]);
    assert_eq!(place.names("out"), ["long.csv"]);
    assert_eq!(place.read("out/long.csv"), "old");
}

/// Ten minutes take no more memory than the program, a figure and a bound: with every row kept it was twice as much.
#[test]
#[cfg(target_os = "linux")]
fn memory_does_not_grow_with_the_duration() {
    let place = Place::new();
    let args = ["run", "pendulum-tanh", "--set", "duration=600", "--every", "1000"];
    let mut child = place.command(&args).stdout(std::process::Stdio::null()).spawn().unwrap();
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0_u64;
    while child.try_wait().unwrap().is_none() {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let now = line.and_then(|line| line.trim().strip_suffix(" kB")?.parse().ok());
        peak = peak.max(now.unwrap_or(0));
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    assert!((1_000..80_000).contains(&peak), "{peak} kB");
    assert_eq!(place.read("out/pendulum-tanh.csv").lines().count(), 602);
}

#[test]
fn what_is_accepted_is_checked() {
    let place = Place::new();
    for (line, fragments) in [
        ("error = -0.1", ["accept.error", "must be > 0"]),
        ("settling = 20.0", ["accept.settling is 20 s", "must be < duration, 10 s"]),
        ("at_limit = 2.0", ["accept.at_limit", "2"]),
        ("errors = 0.1", ["unknown key 'errors' in [accept]", "did you mean 'error'?"]),
        ("speed = [1.0, 2.0, 3.0]", ["accept.speed: 2 numbers expected", "got 3"]),
    ] {
        place.scenario("bad.toml", &[("error = 0.05", line)]);
        place.run(&["run", "bad.toml"]).refused(&fragments);
    }
}

/// What the page shows is tested in a browser, `npm test` in `viewer`.
#[test]
fn a_page_with_the_robot_in_motion_is_one_file() {
    let place = Place::new();
    place.scenario("short.toml", &[SHORT]);
    let text = place.run(&["run", "short.toml", "--view"]).done().stdout;
    assert!(text.ends_with("wrote out/short.view.html\n"), "{text}");
    let page = place.read("out/short.view.html");
    assert!(page.contains("\"name\":\"short\"") && page.len() < 1_500_000, "{}", page.len());
    let summary = place.run(&["run", "short.toml", "--view", "--json"]).done().json();
    assert_eq!(summary["files"][3], "out/short.view.html");
    assert_eq!(place.read("out/short.view.html"), page);
}

#[test]
fn two_runs_share_a_page() {
    let place = Place::new();
    place.scenario("short.toml", &[SHORT]);
    place.scenario("longer.toml", &[("duration = 10.0", "duration = 0.06")]);
    let found = place.run(&["run", "--view", "short.toml", "longer.toml", "--json"]).done().json();
    assert_eq!(found["files"][0], "out/short-and-longer.view.html");
    assert_eq!((&found["runs"][0]["name"], &found["runs"][1]["name"]), (&"short".into(), &"longer".into()));
    let page = place.read("out/short-and-longer.view.html");
    assert!(page.contains("\"name\":\"short\"") && page.contains("\"name\":\"longer\""));
}

#[test]
fn a_second_run_wants_a_page_and_a_name_of_its_own() {
    let place = Place::new();
    place.scenario("short.toml", &[SHORT]);
    place.scenario("elsewhere/short.toml", &[SHORT]);
    place.run(&["run", "short.toml", "two-link-tanh"]).refused(&["--view"]);
    place
        .run(&["run", "--view", "short.toml", "elsewhere/short.toml"])
        .refused(&["both scenarios are called short"]);
    place.run(&["run", "--view", "short.toml", "nowhere"]).refused(&["nowhere"]);
    assert!(!place.path().join("out").exists(), "nothing was run");
}

/// A run may take an hour: what cannot be written is found before it.
#[test]
fn names_that_are_taken_or_too_long_are_found_before_the_run() {
    let place = Place::new();
    place.scenario("short.toml", &[SHORT]);
    std::fs::create_dir_all(place.path().join("out/short.view.html")).unwrap();
    place.run(&["run", "short.toml", "--view"]).refused(&["short.view.html is not a regular file"]);
    assert_eq!(place.names("out"), ["short.view.html"]);
    place.run(&["run", "short.toml"]).done();
    let long = format!("{}.toml", "n".repeat(248));
    place.scenario(&long, &[SHORT]);
    place.run(&["run", &long, "--view", "--out", "there"]).refused(&["has a name that is too long"]);
    assert!(!place.path().join("there").exists());
}

/// Errors of midpoint steps are not estimated, so the run is told beside collocation: where both agree, and where they do not, which no
/// answer of either hides. From rest off its reference the arm takes torques of thousands of N m in its first milliseconds.
#[test]
fn midpoint_steps_are_told_beside_collocation() {
    let place = Place::new();
    let by = ["--set", "integration=midpoint"];
    let near =
        place.run(&[&["run", "two-link-tanh-smooth", "--set", "duration=0.5"][..], &by].concat()).done();
    assert!(near.stderr.contains("whose errors are not estimated"), "{}", near.stderr);
    let line =
        near.stdout.lines().find(|line| line.starts_with("by collocation, midpoint steps in brackets"));
    assert!(line.is_some_and(|line| line.ends_with("follows its reference: yes")), "{}", near.stdout);

    let off = place.run(&[&["run", "two-link-tanh", "--json"][..], &by].concat());
    assert_eq!(off.code, Some(1));
    let words = "does not follow by midpoint steps and follows by collocation: the steps are too long for it";
    assert!(off.stderr.contains(words), "{}", off.stderr);
    let summary = off.json();
    assert_eq!((&summary["follows"], &summary["collocated"]["follows"]), (&false.into(), &true.into()));

    let rough = ["--set", "imperfection=[{ kind = 'friction', side = 'link', coulomb = 0.1 }]"];
    let same =
        place.run(&[&["run", "two-link-tanh-smooth", "--set", "duration=0.5"][..], &by, &rough].concat());
    assert!(!same.stdout.contains("by collocation"), "{}", same.stdout);
    assert!(same.stderr.contains("stepped at 0.1 ms, whatever integration is"), "{}", same.stderr);
}
