//! Parts that do not go together, and what is hardly meant.

use flexure::files::Problem;
use flexure::scenario::scenario_from_text;

use super::{Case, ENTRY, REAL, SCENARIO, folder, good, read, refused, with};

const CASES: &[Case] = &[
    (
        "[imperfection]\nkind = \"delay\"",
        "[imperfection]",
        "type",
        "imperfection is a table, must be an array of tables",
    ),
    (
        "[estimator]\nkind = \"kalman\"\nbandwidth = 1",
        "\"kalman\"",
        "unknown-name",
        "estimator.kind is 'kalman'",
    ),
    ("[estimator]\nkind = \"observer\"", "[estimator]", "missing-key", "missing key estimator.bandwidth"),
    ("[estimator]\nkind = \"observer\"\nbandwidth = 0", "0\n", "range", "bandwidth is 0 rad/s, must be > 0"),
    (
        "[estimator]\nkind = \"observer\"\nencoders = \"link\"\nbandwidth = 9",
        "\"link\"",
        "unknown-name",
        "encoders is 'link'",
    ),
    ("[disturbance_observer]\nbandwidth = [1]", "[1]", "length", "2 numbers expected"),
    ("[guard]", "[guard]", "missing-key", "missing key guard.stop_damping"),
    ("[guard]\nstop_damping = -1", "-1", "range", "stop_damping is -1 N m s/rad, must be >= 0"),
    (
        "[guard]\nstop_damping = 1\nrejoin_after = 0",
        "0\n",
        "range",
        "rejoin_after is 0, must be a whole number from 1",
    ),
    (
        "[guard]\nstop_damping = 1\nlatch_stops = 3",
        "[guard]",
        "missing-key",
        "latch_stops and latch_within must both be given",
    ),
    (
        "[guard]\nstop_damping = 1\nlatch_stops = 17\nlatch_within = 1",
        "17",
        "range",
        "latch_stops is 17, must be a whole number from 1 to 16",
    ),
    ("[guard]\nstop_damping = 1\njump = 0", "0\n", "range", "jump is 0 rad, must be > 0"),
    ("[guard]\nstop_damping = 1\ncollision = [1, -1]", "-1", "range", "collision[1] is -1 N m, must be > 0"),
    ("[guard]\nstop_damping = 1\nreaction = \"flee\"", "\"flee\"", "unknown-name", "reaction is 'flee'"),
    (
        "[guard]\nstop_damping = 1\nmax_age = 0.5",
        "0.5",
        "type",
        "guard.max_age is a number, must be a whole number from 0",
    ),
    (
        "[[imperfection]]\nkind = \"velocity-filter\"\norder = 1\ncutoff = 40\n[estimator]\nkind = \"observer\"\nbandwidth = 300",
        ENTRY,
        "contradiction",
        "velocity-filter, but [estimator] in line 22 gives velocities too",
    ),
    (
        "[[imperfection]]\nkind = \"saturation\"\n[[imperfection]] \nkind = \"saturation\"\nlimit = 1",
        "[[imperfection]] ",
        "contradiction",
        "a second saturation; the first is in line 18",
    ),
    (
        "[[imperfection]]\nkind = \"encoder\"\nresolution = 0.1\n[[imperfection]] \nkind = \"encoder\"\nplacement = \"link\"\nresolution = 0.1",
        "[[imperfection]] ",
        "contradiction",
        "a second encoder on the link side; the first is in line 18",
    ),
    (
        "[[imperfection]]\nkind = \"sampling\"\nperiod = 0.002\n[[imperfection]] \nkind = \"sampling\"\nside = \"motor\"\nperiod = 0.004",
        "[[imperfection]] ",
        "contradiction",
        "a second sampling on the motor side; the first is in line 18",
    ),
    (
        "[[imperfection]]\nkind = \"delay\"\nactuation = 0.001\n[[imperfection]] \nkind = \"delay\"\ncomputation = 0.001",
        "[[imperfection]] ",
        "contradiction",
        "a second delay; the first is in line 18",
    ),
    (
        "[[imperfection]]\nkind = \"noise\"\nlink_velocity = 0.1\n[[imperfection]]\nkind = \"velocity-filter\"\norder = 1\ncutoff = 40",
        ENTRY,
        "contradiction",
        "noise on velocities, but they are computed from positions, as line 21 says",
    ),
    (
        "[[imperfection]]\nkind = \"encoder\"\nresolution = 0.1\nplacement = \"motor\"\n[[imperfection]]\nkind = \"velocity-filter\"\norder = 1\ncutoff = 40",
        ENTRY,
        "contradiction",
        "no encoder on the link side, but velocity-filter in line 22 needs one",
    ),
    (
        "[[imperfection]]\nkind = \"encoder\"\nresolution = 0.1\nplacement = \"motor\"\n[estimator]\nkind = \"observer\"\nbandwidth = 300",
        ENTRY,
        "contradiction",
        "no encoder on the link side, but [estimator] in line 22 needs one",
    ),
    (
        "[plant]\nspring_hardening = 10\n[[imperfection]]\nkind = \"spring\"\nhardening = 20",
        "20\n",
        "contradiction",
        "imperfection[0].hardening and plant.spring_hardening in line 19 both say",
    ),
    (
        "[[imperfection]]\nkind = \"saturation\"\n[guard]\ntorque_limit = [8.0, 1.68]\nstop_damping = 1",
        "[8.0, 1.68]",
        "contradiction",
        "the guard lets 1.68 N m through for joint 2, must be <= 1.67 N m, the saturation in line 18",
    ),
    (
        "[[imperfection]]\nkind = \"saturation\"\nlimit = 1\n[guard]\nstop_damping = 1",
        "[guard]",
        "contradiction",
        "the guard lets 8.39 N m through for joint 1, must be <= 1 N m",
    ),
    (
        "[[imperfection]]\nkind = \"torque-rate\"\nlimit = 100\n[guard]\ntorque_rate_limit = 1e4\nstop_damping = 1",
        "1e4",
        "contradiction",
        "the guard lets 10000 N m/s through for joint 1, must be <= 100 N m/s, the torque-rate in line 18",
    ),
    (
        "[[imperfection]]\nkind = \"sampling\"\nperiod = 0.005\n[guard]\nmax_age = 3\nstop_damping = 1",
        ENTRY,
        "contradiction",
        "readings become 4 control periods old, guard.max_age is 3",
    ),
];

#[test]
fn bad_loops() {
    for case in CASES {
        refused(SCENARIO, *case);
    }
    for (seed, fragment) in [("-1", "seed is -1, must be a whole number from 0"), ("0.5", "seed is a number")]
    {
        let text = SCENARIO.replace("42", seed);
        let problems = read(&text).unwrap_err();
        assert!(problems.to_string().starts_with(&format!("s.toml:4:8: {fragment}")), "{problems}");
    }
}

/// In continuous time nothing samples, estimates or guards.
#[test]
fn continuous_loops_have_no_devices() {
    let base = SCENARIO.replace("seed = 42", "hold = \"continuous\"");
    for (more, at, what) in [
        ("[[imperfection]]\nkind = \"delay\"\nactuation = 0.001", ENTRY, "delay"),
        ("[[imperfection]]\nkind = \"encoder\"\nresolution = 0.001", ENTRY, "encoder"),
        ("[[imperfection]]\nkind = \"saturation\"", ENTRY, "saturation"),
        ("[estimator]\nkind = \"observer\"\nbandwidth = 300", "[estimator]", "estimator"),
        ("[disturbance_observer]\nbandwidth = 300", "[disturbance_observer]", "disturbance_observer"),
        ("[guard]\nstop_damping = 1", "[guard]", "guard"),
    ] {
        let fragment = format!("{what}, but hold is \"continuous\" in line 4");
        refused(&base, (more, at, "contradiction", &fragment));
    }
}

#[test]
fn what_the_robot_does_not_say_is_asked_for() {
    let base = SCENARIO.replace("arm.toml", "plain.toml");
    for (more, at, fragment) in [
        (
            "[[imperfection]]\nkind = \"encoder\"\ncounts_per_turn = 4096",
            "4096",
            "robot quanser-2dof has no gear ratios",
        ),
        ("[[imperfection]]\nkind = \"saturation\"", ENTRY, "robot quanser-2dof has no torque_limit"),
        ("[[imperfection]]\nkind = \"torque-rate\"", ENTRY, "robot quanser-2dof has no torque_rate_limit"),
    ] {
        refused(&base, (more, at, "missing-key", fragment));
    }
    // A link encoder needs no gear, but a link that turns.
    good(&format!(
        "{base}[[imperfection]]\nkind = \"encoder\"\nplacement = \"link\"\ncounts_per_turn = 4096\n[[imperfection]]\nkind = \"encoder\"\nplacement = \"motor\"\nresolution = 0.001"
    ));
    // Of a robot that cannot be read nothing is said twice, and of another one in its own file.
    let problems = read(&with("[[imperfection]]\nkind = \"model-error\"\nrobot = \"bad.toml\"")).unwrap_err();
    assert!(problems.iter().next().and_then(Problem::file).is_some_and(|file| file.ends_with("bad.toml")));
    let problems = read(&with(REAL).replace("arm.toml", "bad.toml")).unwrap_err();
    assert_eq!(problems.iter().count(), 1, "{problems}");
}

/// What can be meant, but hardly is.
#[test]
fn doubts_are_said() {
    for (more, fragment) in [
        ("[[imperfection]]\nkind = \"dropout\"\nfrom = 0.5\nuntil = 0.6", "dropout, but there is no guard"),
        ("[[imperfection]]\nkind = \"dropout\"\nfrom = 5\nuntil = 6", "after the end of the run at 2 s"),
        ("[[imperfection]]\nkind = \"encoder\"\nresolution = 1e-3", "encoder, but velocities stay exact"),
        ("[[imperfection]]\nkind = \"encoder\"\nresolution = 4", "it looks like degrees"),
        ("[[imperfection]]\nkind = \"delay\"\ncomputation = 0.7", "is it in milliseconds?"),
        ("[[imperfection]]\nkind = \"push\"\ntorque = 1\nfrom = 3\nduration = 1", "nobody pushes"),
        ("[[imperfection]]\nkind = \"model-error\"\nmass = 110", "is it in percent?"),
        ("[[imperfection]]\nkind = \"velocity-filter\"\norder = 1\ncutoff = 0.01", "between 10 and 1000 Hz"),
    ] {
        let scenario = good(&with(more));
        let said = |problem: &&Problem| format!("{problem} {}", problem.hint()).contains(fragment);
        let found =
            scenario.warnings.iter().find(said).unwrap_or_else(|| panic!("{more}: {:?}", scenario.warnings));
        assert!(found.is_warning() && found.line_column().is_some_and(|(line, _)| line > 17), "{found}");
    }
    // Nobody wants velocities of a law that reads none.
    let encoder = with("[[imperfection]]\nkind = \"encoder\"\nresolution = 1e-3");
    let at = encoder.find("[controller]").expect("a law");
    let rest = encoder.find("[[imperfection]]").expect("an encoder");
    for (kind, doubts) in [("link-position-feedback", 0), ("pd", 1)] {
        let text = format!("{}[controller]\nkind = \"{kind}\"\n{}", &encoder[..at], &encoder[rest..]);
        let scenario = good(&text);
        let said = |problem: &&Problem| problem.to_string().contains("velocities stay exact");
        assert_eq!(scenario.warnings.iter().filter(said).count(), doubts, "{kind}");
    }
}

/// Cuts and stray tokens in everything that is new: accepted or refused at a place, never a panic.
#[test]
fn mangled_loops_never_panic() {
    let folder = folder();
    let (mut accepted, mut refused) = (0, 0);
    for at in (0..REAL.len()).step_by(5) {
        for token in ["", "-", "nan", "[", "]", "=", "\"", "\n", "1e308", "true", "é", "."] {
            for cut in [0, 1, 7] {
                let mut text = REAL.to_owned();
                text.replace_range(at..(at + cut).min(REAL.len()), token);
                match scenario_from_text("s.toml", &with(&text), folder.path()) {
                    Ok(_) => accepted += 1,
                    Err(problems) => {
                        refused += 1;
                        assert!(problems.iter().all(|p| p.line_column().is_some()), "{problems}");
                    }
                }
            }
        }
    }
    assert!(accepted > 50 && refused > 1000, "{accepted} accepted, {refused} refused");
}
