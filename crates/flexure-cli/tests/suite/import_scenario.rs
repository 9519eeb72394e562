//! `flexure import --assume --scenario`: from a URDF to files that run, and what is in the way of them.

use crate::command::Place;

const PANDA: &str = include_str!("../../../../robots/panda.urdf");

/// An arm of one link that swings under gravity: enough for files that run, and quick.
const SWING: &str = r#"<robot name="swing"><link name="base"/>
<link name="arm"><inertial><origin xyz="0 0 -0.3"/><mass value="2"/>
<inertia ixx="0.06" ixy="0" ixz="0" iyy="0.06" iyz="0" izz="0.001"/></inertial></link>
<joint name="pivot" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
<limit effort="30" velocity="3" lower="-0.4" upper="2.0"/></joint></robot>"#;

const BOTH: [&str; 4] = ["--assume", "harmonic-drive", "--scenario", "--force"];

fn import<'a>(urdf: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&["import", urdf], more].concat()
}

/// Two commands from a URDF to a loop that follows, with sensors, delay, friction and limits.
#[test]
fn a_urdf_becomes_a_loop_that_follows() {
    let place = Place::new();
    place.write("swing.urdf", SWING);
    let drafted = place.run(&import("swing.urdf", &["--assume", "harmonic-drive", "--scenario"])).done();
    assert_eq!(drafted.stdout, "wrote swing.toml\nwrote swing-scenario.toml\n");
    assert_eq!(place.names("."), ["swing-scenario.toml", "swing.toml", "swing.urdf"]);
    let checked = place.run(&["check", "swing.toml", "swing-scenario.toml"]).done();
    assert!(checked.stdout.contains("assumed: joints.stiffness"), "{}", checked.stdout);
    let run = place.run(&["run", "swing-scenario.toml", "--json"]).done().json();
    assert_eq!(run["follows"], true, "{run}");
    assert!(run["rms_e_l"].as_f64().unwrap() < 5e-3, "{run}");
    assert_eq!(run["saturated_fraction"], 0.0, "{run}");
    let kinds: Vec<_> =
        run["imperfections"].as_array().unwrap().iter().map(|kind| kind.as_str().unwrap()).collect();
    for kind in ["encoder", "velocity-filter", "saturation", "delay", "friction"] {
        assert!(kinds.contains(&kind), "{kinds:?}");
    }
    // The motion stays inside the range, about its middle.
    let text = place.read("swing-scenario.toml");
    assert!(text.contains("offset = [0.8]") && text.contains("amplitude = [0.3]"), "{text}");
}

/// Files that belong together come together, with the URDF, and replace nothing unasked.
#[test]
fn drafts_come_whole_and_replace_nothing() {
    let place = Place::new();
    place.write("urdf/panda.urdf", PANDA);
    let out = ["--assume", "series-elastic", "--scenario", "--out", "arms/p.toml"];
    let done = place.run(&import("urdf/panda.urdf", &out)).done();
    assert_eq!(done.stdout, "wrote arms/p.toml\nwrote arms/p-scenario.toml\nwrote arms/panda.urdf\n");
    assert_eq!(place.read("arms/panda.urdf"), PANDA);
    assert!(place.read("arms/p.toml").contains("file = \"panda.urdf\""));
    place.run(&["check", "arms/p.toml"]).done();
    // Again: nothing is replaced, with --force everything is; the URDF is there already.
    place.write("arms/p.toml", "mine");
    place.run(&import("urdf/panda.urdf", &out)).refused(&["arms/p.toml exists", "--force", "error[exists]"]);
    assert_eq!(place.read("arms/p.toml"), "mine");
    std::fs::remove_file(place.path().join("arms/p.toml")).unwrap();
    place.run(&import("urdf/panda.urdf", &out)).refused(&["arms/p-scenario.toml exists"]);
    assert_eq!(place.names("arms"), ["p-scenario.toml", "panda.urdf"]);
    let forced = place.run(&import("urdf/panda.urdf", &[&out[..], &["--force"]].concat())).done();
    assert_eq!(forced.stdout, "wrote arms/p.toml\nwrote arms/p-scenario.toml\n");
    // A URDF below the folder is named where it is; another one in its place is somebody's.
    place.run(&import("urdf/panda.urdf", &["--out", "."])).done();
    assert!(place.read("panda.toml").contains("file = \"urdf/panda.urdf\""));
    place.write("other/panda.urdf", "<robot/>");
    place.run(&import("urdf/panda.urdf", &["--out", "other"])).refused(&["other/panda.urdf exists"]);
    assert_eq!(place.names("other"), ["panda.urdf"]);
}

#[test]
fn what_is_missing_is_listed_once() {
    let place = Place::new();
    place.write("panda.urdf", PANDA);
    let drafted = place.run(&import("panda.urdf", &["--scenario", "--json"])).done();
    let document = drafted.json();
    assert_eq!(document["missing"]["panda_joint7"].as_array().unwrap().len(), 3, "{document}");
    assert_eq!(document["files"].as_array().unwrap().len(), 2);
    assert!(document["scenario"].as_str().unwrap().contains("stop_damping = nan"));
    assert!(drafted.stderr.contains("21 numbers are still to be supplied (nan):"), "{}", drafted.stderr);
    for command in ["check", "run"] {
        let refused = place.run(&[command, "panda-scenario.toml"]);
        refused.refused(&[
            "21 numbers are still to be supplied",
            "each of 7 joints, panda_joint1 to panda_joint7",
        ]);
        assert!(refused.stderr.lines().count() < 30, "{}", refused.stderr);
    }
    // Locked joints lack nothing.
    let lock = ["--lock", "panda_joint3=0.2", "--assume", "belt", "--json"];
    let locked = place.run(&import("panda.urdf", &lock)).done().json();
    assert_eq!(
        (locked["joints"].as_array().unwrap().len(), locked["missing"].as_object().unwrap().len()),
        (6, 0)
    );
    assert_eq!(locked["files"].as_array().unwrap().len(), 0);
    assert!(locked.get("scenario").is_none());
}

/// Limits that are not there, ranges without end, joints that slide, efforts that are none: drafts that can be checked, or a clear no.
#[test]
fn strange_joints_make_sound_drafts() {
    let place = Place::new();
    for (from, to) in [
        ("effort=\"30\" ", ""),
        ("velocity=\"3\"", ""),
        ("<limit effort=\"30\" velocity=\"3\" lower=\"-0.4\" upper=\"2.0\"/>", ""),
        ("type=\"revolute\"", "type=\"continuous\""),
        ("type=\"revolute\"", "type=\"prismatic\""),
        ("lower=\"-0.4\" upper=\"2.0\"", "lower=\"100\" upper=\"100.001\""),
        ("name=\"pivot\"", "name=\"joint with spaces, \u{3c0}\""),
        ("effort=\"30\"", "effort=\"1e9\""),
    ] {
        assert!(SWING.contains(from), "{from}");
        place.write("swing.urdf", SWING.replace(from, to));
        place.run(&import("swing.urdf", &BOTH)).done();
        for file in ["swing.toml", "swing-scenario.toml"] {
            let checked = place.run(&["check", file, "--json"]);
            assert!(checked.code != Some(2), "{from} -> {to}: {}{}", checked.stdout, checked.stderr);
        }
    }
    // What is refused writes nothing.
    for (from, to, said) in [
        ("effort=\"30\"", "effort=\"nan\"", "must be a finite number"),
        ("effort=\"30\"", "effort=\"many\"", "many"),
        ("<mass value=\"2\"/>", "<mass value=\"-2\"/>", "must be >= 0"),
    ] {
        place.write("bad/swing.urdf", SWING.replace(from, to));
        place
            .run(&import("bad/swing.urdf", &["--assume", "belt", "--scenario", "--out", "none"]))
            .refused(&[said]);
        assert!(place.names("none").is_empty());
    }
}

/// A limit of zero is refused whatever is asked for, and nothing is written; said to be unknown, it is none in draft and run.
#[test]
fn limits_of_zero_are_refused_unless_they_are_unknown() {
    let place = Place::new();
    for (from, to, said) in [
        ("effort=\"30\"", "effort=\"0\"", "joint 'pivot': effort 0"),
        ("effort=\"30\"", "effort=\"-5\"", "effort -5"),
        ("velocity=\"3\"", "velocity=\"0.0\"", "velocity 0"),
        ("lower=\"-0.4\" upper=\"2.0\"", "lower=\"0\" upper=\"0\"", "lower 0 with upper 0"),
        ("lower=\"-0.4\" upper=\"2.0\"", "lower=\"1\" upper=\"-1\"", "lower 1 with upper -1"),
        ("lower=\"-0.4\" upper=\"2.0\"", "lower=\"0.5\"", "lower 0.5 with upper 0"),
    ] {
        assert!(SWING.contains(from), "{from}");
        place.write("zero.urdf", SWING.replace(from, to));
        for more in [&["--out", "none"] as &[_], &["--assume", "belt", "--scenario", "--out", "none"], &[]] {
            place.run(&import("zero.urdf", more)).refused(&["limits", "1 joint cannot move", said]);
        }
        assert!(place.names("none").is_empty());
        let known = ["--assume", "belt", "--scenario", "--unknown-limits", "--force"];
        place.run(&import("zero.urdf", &known)).done();
        place.run(&["check", "zero.toml", "zero-scenario.toml"]).done();
        let toml = place.read("zero.toml");
        assert_eq!(toml.matches("unknown_limits = true").count(), 1, "{toml}");
        place.write("zero.toml", toml.replace("unknown_limits = true", "unknown_limits = false"));
        place.run(&["check", "zero.toml"]).refused(&["zero.urdf", said]);
    }
}

#[test]
fn options_that_are_none_are_refused() {
    let place = Place::new();
    place.write("swing.urdf", SWING).write("file", "mine");
    for (more, said) in [
        (&["--assume", "harmonic"][..], "no class of drives is called 'harmonic'"),
        (&["--assume", "belts"], "did you mean 'belt'"),
        (&["--out", "file"], "cannot create files in file"),
        (&["--set", "duration=3", "--scenario"], "--set changes a scenario; import takes none"),
    ] {
        let outcome = place.run(&import("swing.urdf", more));
        assert_eq!(outcome.code, Some(2), "{outcome:?}");
        assert!(outcome.stderr.contains(said), "{outcome:?}");
        assert_eq!(place.names("."), ["file", "swing.urdf"]);
    }
}
