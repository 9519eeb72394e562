//! `[[imperfection]]`, `[estimator]`, `[disturbance_observer]`, `[guard]` and `seed` of scenario files: read as written,
//! refused at the right place.

mod accepted;
mod entries;
mod loops;

use std::fs;

use flexure::files::Problems;
use flexure::scenario::{Scenario, scenario_from_text};
use miette::Diagnostic;
use tempfile::TempDir;

const QUANSER: &str = include_str!("../../../../../robots/quanser-2dof.toml");

const DRIVES: &str = "[joints]\ngear_ratio = [100.0, -50.0]\ntorque_limit = [8.39, 1.67]\ntorque_rate_limit = [4000.0, 800.0]\n";

const SCENARIO: &str = r#"robot = "arm.toml"
duration = 2.0
control_period = 0.001
seed = 42
[reference]
kind = "sine"
amplitude = 0.3
frequency = 3.0
[controller]
kind = "vcbc"
phi = "tanh"
[controller.link]
metric = 50.0
damping = 10.0
[controller.motor]
metric = 60.0
damping = 10.0
"#;

/// Every kind, and what the controller does about them.
const REAL: &str = r#"
[[imperfection]]
kind = "encoder"
placement = "motor"
counts_per_turn = 4096
dither = true
[[imperfection]]
kind = "encoder"
placement = "link"
resolution = [1e-4, 2e-4]
[[imperfection]]
kind = "noise"
link = 1e-5
motor = [1e-5, 2e-5]
[[imperfection]]
kind = "sampling"
side = "link"
period = 0.002
[[imperfection]]
kind = "dropout"
from = 0.5
until = 0.6
[[imperfection]]
kind = "dropout"
side = "link"
mode = "hold"
probability = 0.01
mean_length = 3.0
[[imperfection]]
kind = "delay"
computation = 0.0002
actuation = 0.0005
[[imperfection]]
kind = "deadline"
every = 100
[[imperfection]]
kind = "saturation"
[[imperfection]]
kind = "torque-rate"
[[imperfection]]
kind = "current-quantisation"
step = 0.01
[[imperfection]]
kind = "friction"
side = "motor"
coulomb = [0.2, 0.05]
static = [0.3, 0.05]
stribeck_velocity = 0.1
[[imperfection]]
kind = "spring"
hardening = [100.0, 50.0]
dead_zone = 0.001
hysteresis_stiffness = [1.0, 0.5]
hysteresis_torque = 0.02
[[imperfection]]
kind = "model-error"
mass = [1.1, 0.9]
stiffness = 0.7
[imperfection.payload]
mass = 0.2
position = [0.267, 0.0, 0.0]
[[imperfection]]
kind = "push"
torque = [1.0, -0.5]
from = 1.0
duration = 0.1
shape = "half-sine"
[[imperfection]]
kind = "bias"
motor = [0.01, -0.02]
[[imperfection]]
kind = "jump"
side = "motor"
size = [0.0, 6.0]
from = 1.0
[[imperfection]]
kind = "freeze"
side = "link"
from = 1.5
until = 1.6
[[imperfection]]
kind = "stall"
from = 1.7
until = 1.72
[estimator]
kind = "observer"
encoders = "both"
bandwidth = [300.0, 400.0]
[disturbance_observer]
bandwidth = 50.0
[guard]
max_age = 1
torque_limit = [8.0, 1.5]
stop_damping = [4.0, 1.0]
rejoin_speed = 0.1
rejoin_error = [0.3, 0.2]
rejoin_duration = 0.2
off_after = 5.0
latch_stops = 3
latch_within = 10.0
watchdog = 3
position = [3.0, 2.0]
speed = 6.0
deflection = 0.4
jump = 0.05
frozen_after = 5
frozen_travel = 0.01
velocity_gap = [2.0, 3.0]
motor_residual = 1.0
collision = [2.0, 0.5]
reaction = "retract"
retract_duration = 0.1
residual_bandwidth = 30.0
"#;

/// A folder with the paper's arm and data of its drives, and its sister in the laboratory's drawings.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("arm.toml"), QUANSER.replace("[joints]\n", DRIVES)).unwrap();
    fs::write(folder.path().join("plain.toml"), QUANSER).unwrap();
    fs::write(folder.path().join("cad.toml"), QUANSER.replace("[1.510, 0.873]", "[1.500, 0.873]")).unwrap();
    fs::write(folder.path().join("bad.toml"), QUANSER.replace("[1.510, 0.873]", "[-1.5, 0.873]")).unwrap();
    folder
}

fn read(text: &str) -> Result<Scenario, Problems> {
    scenario_from_text("s.toml", text, folder().path())
}

fn good(text: &str) -> Scenario {
    read(text).unwrap_or_else(|problems| panic!("{problems}"))
}

fn with(more: &str) -> String {
    format!("{SCENARIO}{more}\n")
}

/// What is appended, the text that the problem must point at (in what is appended), its code, and part of the message.
type Case = (&'static str, &'static str, &'static str, &'static str);

const ENTRY: &str = "[[imperfection]]";

/// The problem with `fragment` when `more` is appended: at `at`, with a code and a hint.
fn refused(base: &str, (more, at, code, fragment): (&str, &str, &str, &str)) {
    let text = format!("{base}{more}\n[sources]\n");
    let problems = read(&text).err().unwrap_or_else(|| panic!("accepted: {more}"));
    let problem = problems.iter().find(|problem| problem.to_string().contains(fragment));
    let problem = problem.unwrap_or_else(|| panic!("{more}: no '{fragment}' in\n{problems}"));
    let offset = base.len() + text[base.len()..].find(at).unwrap_or_else(|| panic!("no {at} in {more}"));
    let before = &text[..offset];
    let column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
    assert_eq!(problem.line_column(), Some((before.matches('\n').count() + 1, column)), "{more}: {problem}");
    assert_eq!(problem.code().unwrap().to_string(), format!("error[{code}]"), "{more}");
    assert!(problem.hint().len() > 8 && problem.file() == Some("s.toml"), "{more}: {}", problem.hint());
    assert_eq!(problems.iter().filter(|problem| !problem.is_warning()).count(), 1, "{more}:\n{problems}");
}
