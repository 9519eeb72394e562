//! Changes of documents from outside: what `--set` does.

use flexure::Scenario;
use flexure::files::{Change, Problems, Reading};
use flexure::robot::robot_from_text;
use flexure::scenario::{load_scenario_with, scenario_from_text};

const TEXT: &str = include_str!("../../../../scenarios/two-link-hardware.toml");

fn changed(changes: &[&str]) -> Result<Scenario, Problems> {
    let changes: Result<Vec<_>, _> = changes.iter().map(|change| Change::parse(change)).collect();
    load_scenario_with("two-link-hardware", Reading::changed(&changes?))
}

/// The file with `from` replaced by `to`.
fn edited(from: &str, to: &str) -> Scenario {
    assert!(TEXT.contains(from), "{from}");
    let text = TEXT.replacen(from, to, 1);
    scenario_from_text("two-link-hardware", &text, "robots".as_ref())
        .unwrap_or_else(|problems| panic!("{problems}"))
}

/// A change means what the same edit of the file means.
#[test]
fn changes_are_edits() {
    for (change, from, to) in [
        ("duration=3.0", "duration = 20.0", "duration = 3.0"),
        (" control_period = 0.001 ", "control_period = 0.002", "control_period = 0.001"),
        ("controller.link.metric=[1.5, 0.2]", "metric = [1.9, 0.11]", "metric = [1.5, 0.2]"),
        ("controller.link.metric[1]=0.2", "metric = [1.9, 0.11]", "metric = [1.9, 0.2]"),
        ("controller.phi=linear", "phi = \"tanh\"", "phi = \"linear\""),
        ("controller.\"phi\" = 'linear'", "phi = \"tanh\"", "phi = \"linear\""),
        ("imperfection.velocity-filter.cutoff=50", "cutoff = 40.0", "cutoff = 50.0"),
        ("imperfection[1].cutoff=50", "cutoff = 40.0", "cutoff = 50.0"),
        ("imperfection.1.cutoff=50", "cutoff = 40.0", "cutoff = 50.0"),
        (
            "imperfection.delay.computation=1e-3",
            "[sources]",
            "[[imperfection]]\nkind = 'delay'\ncomputation = 1e-3\n[sources]",
        ),
        ("guard.rejoin_error=[0.5, 0.4]", "[[imperfection]]", "rejoin_error = [0.5, 0.4]\n[[imperfection]]"),
        ("accept.error=0.02", "[sources]", "[accept]\nerror = 0.02\n[sources]"),
        ("initial=at rest", "seed = 1", "seed = 1\ninitial = 'at rest'"),
        ("plant={ spring_hardening = 3.0 }", "[sources]", "[plant]\nspring_hardening = 3.0\n[sources]"),
    ] {
        let changed = changed(&[change]).unwrap_or_else(|problems| panic!("{change}: {problems}"));
        let edited = edited(from, to);
        let of = |scenario: &Scenario| {
            let mut all = scenario.clone();
            all.places = edited.places.clone();
            all.robot.places = edited.robot.places.clone();
            all.assumptions.clear();
            format!("{all:?}")
        };
        assert_eq!(of(&changed), of(&edited), "{change}");
    }
}

#[test]
fn the_last_change_counts_and_robots_are_changed_too() {
    let scenario = changed(&["duration=3", "duration=4", "robot.joints.stiffness=[200, 20]"]).unwrap();
    assert_eq!((scenario.duration, scenario.robot.stiffness), (4.0, vec![200.0, 20.0]));
    let other = changed(&[
        "robot=quanser-2dof",
        "imperfection.saturation.limit=9",
        "guard.torque_limit=9",
        "robot.joints.stiffness=[200, 20]",
    ])
    .unwrap()
    .robot;
    assert_eq!((&*other.name, other.stiffness), ("quanser-2dof", vec![200.0, 20.0]));
    // A file without changes is another one.
    assert_ne!(
        robot_from_text("r", include_str!("../../../../robots/quanser-2dof.toml"), ".".as_ref())
            .unwrap()
            .stiffness,
        [200.0, 20.0]
    );
}

/// What is wrong with a change is shown in the change, with what the reader of files has to say.
#[test]
fn what_is_wrong_points_into_the_change() {
    for (change, said, column) in [
        ("duration=-3", "duration is -3 s, must be > 0", 10),
        ("duratoin=3", "unknown key 'duratoin'", 1),
        ("controler.phi=tanh", "unknown key 'controler'", 1),
        ("controller.link.metirc=1", "unknown key 'metirc' in [controller.link]", 17),
        ("controller.link.metric=[1, 2, 3]", "controller.link.metric: 2 numbers expected", 24),
        ("controller.link.metric=[1, -2]", "controller.link.metric[1] is -2", 28),
        ("controller.phi=tahn", "controller.phi is 'tahn'", 16),
        ("duration.x=3", "duration is no table", 10),
        ("imperfection.delay=1e-3", "imperfection.delay is a table, not one value", 14),
        ("imperfection.encodr.resolution=1", "imperfection[3].kind is 'encodr', which is not known", 14),
        ("imperfection[7].cutoff=1", "imperfection has 3 entries", 13),
        ("controller.link.metric.first=1", "controller.link.metric is an array", 24),
        ("controller.link.metric=[1, 2", "the value is none", 24),
        ("controller.link.metric=", "the value is none", 23),
        ("robot.joints.stifness=3", "unknown key 'stifness' in [joints]", 14),
        ("robot.joints.stiffness=-3", "joints.stiffness is -3 N m/rad", 24),
    ] {
        let problems = changed(&[change]).map(|_| ()).unwrap_err();
        let problem = problems.iter().next().unwrap();
        assert!(problem.to_string().contains(said), "{change}: {problems}");
        assert_eq!(
            (problem.file(), problem.line_column()),
            (Some("--set"), Some((1, column))),
            "{change}: {problem}"
        );
    }
    let two = ["imperfection.encoder.resolution=1e-3", "imperfection[3]={ kind = 'encoder' }"];
    assert!(changed(&two).unwrap_err().to_string().contains("imperfection has 3 entries"));
    let text = TEXT.replace(
        "kind = \"saturation\"                # at",
        "kind = 'push'\ntorque = 1.0\nfrom = 1.0\nduration = 1.0 # at",
    ) + "\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.toml");
    let push = "[[imperfection]]\nkind = 'push'\ntorque = 1.0\nfrom = 2.0\nduration = 1.0\n\n[sources]";
    std::fs::write(&path, text.replace("[sources]", push)).unwrap();
    let change = [Change::parse("imperfection.push.torque=2.0").unwrap()];
    let ambiguous = load_scenario_with(path.to_str().unwrap(), Reading::changed(&change)).unwrap_err();
    let problem = ambiguous.iter().next().unwrap();
    assert_eq!(problem.code_word(), "ambiguous-key", "{problem}");
    assert!(problem.hint().contains("one of imperfection[2], imperfection[3]"), "{}", problem.hint());
}

#[test]
fn what_is_no_change_is_refused() {
    for text in [
        "",
        "=",
        "duration",
        "=3",
        "duration..x=3",
        ".duration=3",
        "a[=3",
        "a[x]=3",
        "a[-1]=3",
        "[0]=3",
        "\"a=3",
        "a b=3",
        "a.b.c.d.e.f.g.h.i=3",
    ] {
        let problem = Change::parse(text).unwrap_err();
        assert_eq!(problem.code_word(), "syntax", "{text}");
        assert!(problem.hint().contains("KEY=VALUE"));
    }
}
