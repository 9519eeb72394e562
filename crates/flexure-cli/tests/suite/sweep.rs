//! Sweeps: rows that depend on their index alone, folders that survive whatever ends the command, nasty input.

use std::collections::BTreeMap;
use std::fs;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Duration;

use crate::command::{Outcome, Place, altered};

/// Short runs of the simplest robot: 40 rows in 8 shards.
const SWEEP: &str = "scenario = \"pendulum-tanh\"
design = \"latin-hypercube\"
points = 20
seeds = 2
shard = 5
metrics = [\"rms_e_l\", \"max_abs_u_m\", \"sampled_rate\"]
[set]
duration = 0.05
[parameters]
\"robot.joints.stiffness\" = { from = 0.5, to = 2.0, scale = \"log\", relative = true }
\"imperfection.noise.motor\" = { from = 0.0, to = 1e-4 }
";

fn place() -> Place {
    let place = Place::new();
    place.write("sweep.toml", SWEEP);
    place
}

/// Names and contents of a folder.
fn content(place: &Place, folder: &str) -> BTreeMap<String, Vec<u8>> {
    let read = |name: &String| fs::read(place.path().join(folder).join(name)).unwrap();
    place.names(folder).into_iter().map(|name| (name.clone(), read(&name))).collect()
}

/// The same bytes from one thread, two and sixteen, from the last shard to the first, from another folder, through `--set`.
#[test]
fn rows_depend_on_their_index_alone() {
    let place = place();
    for threads in ["1", "2", "16"] {
        let mut command = place.command(&["sweep", "sweep.toml", "--out", threads]);
        Outcome::from(command.env("RAYON_NUM_THREADS", threads).output().unwrap()).done();
    }
    for shard in ["7", "5..7", "3", "4", "..3"] {
        place.run(&["sweep", "sweep.toml", "--out", "parts", "--shards", shard]).done();
    }
    let whole = content(&place, "1");
    assert_eq!(whole.len(), 9, "eight shards and what they are of");
    for other in ["2", "16", "parts"] {
        assert!(content(&place, other) == whole, "{other}");
    }
    // Each seed and each value matters.
    let other = altered(SWEEP, &[("points = 20", "points = 20\nseed = 1")]);
    place.write("other.toml", other).run(&["sweep", "other.toml", "--out", "other"]).done();
    assert!(content(&place, "other").iter().all(|(name, bytes)| whole[name] != *bytes));
}

/// What is there stays, and is not computed again; the summary is that of all rows, and a row that is run again is the row.
#[test]
fn a_sweep_goes_on_and_is_told() {
    let place = place();
    let first = place.run(&["sweep", "sweep.toml", "--out", "o", "--shards", "..3", "--json"]).done().json();
    assert_eq!((&first["computed"], &first["shards_there"]), (&3.into(), &3.into()), "{first}");
    let rest = place.run(&["sweep", "sweep.toml", "--out", "o", "--json"]).done().json();
    assert_eq!((&rest["computed"], &rest["rows_there"]), (&5.into(), &40.into()), "{rest}");
    // Elsewhere, without any of the files.
    place.write("sweep.toml", "gone");
    let shown = place.run(&["sweep", "show", "o", "--json"]).done().json();
    assert_eq!(shown["metrics"], rest["metrics"]);
    assert_eq!(
        shown["statuses"]["follows"].as_u64().unwrap() + shown["statuses"]["strays"].as_u64().unwrap(),
        40
    );
    let errors = &shown["metrics"]["rms_e_l"];
    let [least, largest] = ["least", "largest"].map(|key| errors[key].as_f64().unwrap());
    let row = place.run(&["sweep", "replay", "o", "--row", "17", "--json"]).json();
    assert!((least..=largest).contains(&row["rms_e_l"].as_f64().unwrap()), "{row}");
    assert_eq!(place.names("out"), ["sweep-row-17.csv", "sweep-row-17.png", "sweep-row-17.svg"]);
    let told = place.run(&["sweep", "show", "o"]).done().stdout;
    assert!(told.contains("40 of 40 runs are there") && told.contains("sampled_rate"), "{told}");
}

/// Comments and blanks are nothing; everything else is another sweep.
#[test]
fn a_folder_of_another_sweep_is_refused() {
    let place = place();
    place.run(&["sweep", "sweep.toml", "--out", "o", "--shards", "0"]).done();
    let before = content(&place, "o");
    let commented = format!("# once more\n{}", SWEEP.replace(" = ", "="));
    place.write("sweep.toml", commented).run(&["sweep", "sweep.toml", "--out", "o", "--shards", "0"]).done();
    for change in [("points = 20", "points = 21"), ("to = 2.0", "to = 2.5"), ("shard = 5", "shard = 4")] {
        place.write("sweep.toml", altered(SWEEP, &[change]));
        place.run(&["sweep", "sweep.toml", "--out", "o"]).refused(&["o is of another sweep", "--out"]);
    }
    place.write("sweep.toml", SWEEP);
    let set = ["sweep", "sweep.toml", "--out", "o", "--set", "control_period=0.002"];
    place.run(&set).refused(&["o is of another sweep"]);
    assert!(content(&place, "o") == before, "nothing was written");
}

/// `count` times killed, without a warning, at moments spread over the work: what was there at a kill is the same at the end, and the
/// end is that of a sweep that nobody disturbed.
#[cfg(unix)]
fn killed(count: usize) {
    let place = place();
    let text = altered(SWEEP, &[("points = 20", "points = 600"), ("duration = 0.05", "duration = 0.02")]);
    place.write("sweep.toml", text).run(&["sweep", "sweep.toml", "--out", "whole"]).done();
    let mut acknowledged = BTreeMap::new();
    let (mut times, mut round) = (0, 0);
    while times < count {
        let folder = format!("killed-{round}");
        for pause in (0..40_u64).map(|i| i * 7919 % 37) {
            let mut child = place
                .command(&["sweep", "sweep.toml", "--out", &folder])
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
                .unwrap();
            sleep(Duration::from_millis(pause));
            child.kill().unwrap();
            child.wait().unwrap();
            times += 1;
            let there = content(&place, &folder).into_iter().filter(|(name, _)| name.starts_with("part-"));
            let there: BTreeMap<_, _> = there.collect();
            assert!(
                acknowledged.iter().all(|(name, bytes)| there.get(name) == Some(bytes)),
                "rows were lost"
            );
            acknowledged = there;
        }
        place.run(&["sweep", "sweep.toml", "--out", &folder]).done();
        assert!(content(&place, &folder) == content(&place, "whole"), "not the same rows, or leftovers");
        acknowledged = BTreeMap::new();
        round += 1;
    }
    println!("killed {times} times in {round} sweeps of 240 shards: nothing lost, nothing doubled");
}

#[test]
#[cfg(unix)]
fn nothing_is_lost_or_doubled_by_kill_9() {
    killed(40);
}

#[test]
#[cfg(unix)]
#[ignore = "a minute: cargo test --release -p flexure-cli --test suite -- --ignored kill_9 --nocapture"]
fn nothing_is_lost_or_doubled_by_a_thousand_kill_9() {
    killed(1000);
}

#[test]
#[cfg(unix)]
fn a_full_disk_is_said_and_leaves_nothing() {
    let place = place();
    // Files of at most a block: the description of the sweep does not fit.
    let program = env!("CARGO_BIN_EXE_flexure");
    let script = format!("trap '' XFSZ; ulimit -f 1; exec {program} sweep sweep.toml --out o");
    let output =
        std::process::Command::new("sh").args(["-c", &script]).current_dir(place.path()).output().unwrap();
    Outcome::from(output).refused(&["cannot write o/sweep.json", "is the disk full"]);
    assert_eq!(place.names("o"), [] as [&str; 0]);
}

#[test]
fn nasty_sweeps() {
    let place = place();
    place.write("o/part-00000.parquet", "").write("file", "");
    let refuse = |text: String, fragments: &[&str]| {
        place.write("bad.toml", text).run(&["sweep", "bad.toml", "--out", "new"]).refused(fragments);
    };
    for (from, to, said) in [
        ("design = \"latin-hypercube\"", "design = \"sobl\"", "did you mean 'sobol'?"),
        ("points = 20", "", "missing key points"),
        ("points = 20", "points = 0", "from 1"),
        ("design = \"latin-hypercube\"", "", "a grid has as many points"),
        ("seeds = 2", "seeds = []", "seeds is empty"),
        ("seeds = 2", "seeds = [1, 1]", "more than once"),
        ("seeds = 2", "seeds = -1", "seeds is -1"),
        ("shard = 5", "shard = 1.5", "must be a whole number"),
        ("\"rms_e_l\"", "\"rms\"", "metrics[0] is 'rms', which is not known"),
        ("shard = 5", "shard = 1e3", "shard is a number, must be a whole number"),
        ("relative = true", "relative = true, points = 7", "has points, and the design is no grid"),
        ("from = 0.5", "from = -0.5", "scale is log"),
        ("from = 0.5", "from = nan", "must be a number"),
        ("to = 2.0", "too = 2.0", "unknown key 'too'"),
        ("robot.joints.stiffness", "robot.joints.stifness", "'robot.joints.stifness' is relative"),
        ("robot.joints.stiffness", "seed", "seed is no parameter"),
        ("imperfection.noise.motor", "imperfection.noice.motor", "noice"),
        ("to = 1e-4", "to = -1e-4", "must be >= 0"),
        ("from = 0.0, to = 1e-4", "values = []", "has no values"),
        ("from = 0.0, to = 1e-4", "values = [0.0, 0.0]", "more than once"),
        ("from = 0.0, to = 1e-4", "values = [0.0], points = 2", "has values and points"),
        ("duration = 0.05", "duration = \"soon\"", "must be a number"),
        ("duration = 0.05", "seed = 3", "seed is set, and every row has one of its own"),
        (
            "duration = 0.05",
            "imperfection.noise.motor = 1e-5",
            "'imperfection.noise.motor' is set, and a parameter",
        ),
        ("pendulum-tanh", "pendulum-tan", "did you mean 'pendulum-tanh'?"),
        ("pendulum-tanh", "../../etc/passwd", "outside"),
    ] {
        refuse(altered(SWEEP, &[(from, to)]), &[said]);
    }
    refuse(String::new(), &["missing keys scenario, parameters"]);
    refuse("[parameters]\n".to_owned() + SWEEP, &["error["]);
    refuse(crate::command::SCENARIO.to_owned(), &["this is a scenario file, must be a sweep file"]);
    assert_eq!(place.names("new"), [] as [&str; 0], "nothing was made");
    for (arguments, said) in [
        (&["sweep", "sweep.toml", "--out", "o"][..], "o has part-00000.parquet and no sweep.json"),
        (&["sweep", "sweep.toml", "--out", "file"], "file"),
        (&["sweep", "sweep.toml", "--shards", "8"], "--shards is '8', must be shards from 0 to 7"),
        (&["sweep", "sweep.toml", "--shards", "5..5"], "--shards is '5..5'"),
        (&["sweep", "sweep.toml", "--shards", "a..b"], "--shards is 'a..b'"),
        (&["sweep", "none.toml"], "cannot read none.toml"),
        (&["sweep", "show", "o"], "o has no sweep.json"),
        (&["sweep", "replay", "none", "--row", "0"], "none has no sweep.json"),
    ] {
        place.run(arguments).refused(&[said]);
    }
    place.run(&["sweep", "sweep.toml", "--out", "good", "--shards", "0"]).done();
    place.run(&["sweep", "replay", "good", "--row", "40"]).refused(&["row 40: 'sweep' has 40 rows"]);
    let set = ["sweep", "replay", "good", "--row", "1", "--set", "duration=1"];
    place.run(&set).refused(&["that of a folder stands"]);
    let part = fs::read(place.path().join("good/part-00000.parquet")).unwrap();
    place.write("good/part-00001.parquet", &part[..part.len() / 2]);
    place.run(&["sweep", "show", "good"]).refused(&["good/part-00001.parquet", "remove the file"]);
    place.write("good/part-00001.parquet", &part);
    place.run(&["sweep", "show", "good"]).refused(&["good/part-00001.parquet: it has the rows of shard 0"]);
    let manifest = altered(&place.read("good/sweep.json"), &[("points = 20", "points = 30")]);
    place.write("good/sweep.json", manifest);
    place.run(&["sweep", "show", "good"]).refused(&["sweep.json was changed"]);
    place.write("good/sweep.json", "{}");
    place.run(&["sweep", "show", "good"]).refused(&["sweep.json is no description of a sweep"]);
}

/// Ctrl-C leaves the shards that are written, and says how to go on.
#[test]
#[cfg(unix)]
fn a_sweep_that_is_broken_off_goes_on() {
    let place = place();
    let text = altered(SWEEP, &[("points = 20", "points = 4000"), ("duration = 0.05", "duration = 1.0")]);
    place.write("sweep.toml", text);
    let mut command = place.command(&["sweep", "sweep.toml", "--out", "o"]);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    while place.names("o").len() < 4 {
        sleep(Duration::from_millis(5));
    }
    let pid = child.id().to_string();
    assert!(
        std::process::Command::new("sh").args(["-c", "kill -INT \"$0\"", &pid]).status().unwrap().success()
    );
    let outcome = Outcome::from(child.wait_with_output().unwrap());
    assert_eq!(outcome.code, Some(130), "{outcome:?}");
    outcome.said(&["error[interrupted]", "of 1600 shards are there", "the same command goes on"]);
    assert!(place.names("o").iter().all(|name| name == "sweep.json" || name.ends_with(".parquet")));
}

/// Rows by midpoint steps, whose errors nobody estimates, are told beside some by collocation: where they agree, and where they do not, which is
/// an answer of no, whenever it is asked for. The same loops as of a run by such steps.
#[test]
fn midpoint_rows_are_told_beside_collocation() {
    let place = Place::new();
    for (scenario, code, status) in
        [("two-link-tanh-smooth", 0, "in status 0 times"), ("two-link-tanh", 1, "")]
    {
        let text = format!(
            "scenario = \"{scenario}\"\npoints = 4\ndesign = \"sobol\"\n[set]\nduration = 0.5\nintegration = \"midpoint\"\n[parameters]\n\
             \"robot.joints.stiffness\" = {{ from = 0.9, to = 1.1, relative = true }}\n"
        );
        place.write("m.toml", text);
        let out = ["--out", scenario];
        let swept = place.run(&[&["sweep", "m.toml"][..], &out].concat());
        let shown = place.run(&["sweep", "show", scenario]);
        for told in [&swept, &shown] {
            assert_eq!(told.code, Some(code), "{}", told.stderr);
            let line = told.stdout.lines().find(|line| line.starts_with("by midpoint steps, whose errors"));
            assert!(line.is_some_and(|line| line.contains(status)), "{}", told.stdout);
            assert_eq!(
                code == 1,
                told.stderr.contains("have another status by collocation"),
                "{}",
                told.stderr
            );
        }
        let json = place.run(&["sweep", "show", scenario, "--json"]).json();
        assert_eq!(json["collocated"]["rows"], 4, "{json}");
        assert_eq!(json["collocated"]["other_status"].as_u64() > Some(0), code == 1, "{json}");
    }
    // Rows by midpoint steps that begin with the second are found as well.
    let mixed = "scenario = \"two-link-tanh\"\n[set]\nduration = 0.5\n[parameters]\n\"robot.joints.stiffness\" = { from = 0.9, to = 1.1, points = 8, relative = true }\n\
                 integration = { values = [\"collocation\", \"midpoint\"] }\n";
    let mixed = place.write("mixed.toml", mixed).run(&["sweep", "mixed.toml", "--out", "mixed", "--json"]);
    assert_eq!(mixed.code, Some(1), "{}", mixed.stderr);
    assert!(mixed.json()["collocated"]["rows"].as_u64() >= Some(4), "{}", mixed.stdout);
    let plain = place.write("sweep.toml", SWEEP).run(&["sweep", "sweep.toml", "--out", "plain", "--json"]);
    assert_eq!(plain.done().json()["collocated"], serde_json::Value::Null);
}
