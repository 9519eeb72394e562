//! Every robot of at most 16 joints of a public collection, and of our own test data, against Pinocchio: see `pinocchio/compare.py`.
//!
//! Pinocchio and the robots come from PyPI into a virtual environment of the test's own, about 900 MB under the target
//! folder. Set `FLEXURE_OFFLINE=1` to leave the test out where PyPI is out of reach.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const HERE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/pinocchio");

fn run(program: &Path, arguments: &[&str]) -> Output {
    Command::new(program)
        .args(arguments)
        .env_remove("PYTHONPATH")
        .output()
        .unwrap_or_else(|error| panic!("{}: {error}", program.display()))
}

/// Runs a program that has to succeed.
fn must(program: &Path, arguments: &[&str], help: &str) {
    let Output { status, stdout, stderr } = run(program, arguments);
    let (stdout, stderr) = (String::from_utf8_lossy(&stdout), String::from_utf8_lossy(&stderr));
    assert!(status.success(), "{} {arguments:?}: {help}\n{stdout}{stderr}", program.display());
}

/// The interpreter of an environment with what `requirements.txt` asks for, made where there is none yet.
fn environment() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pinocchio");
    let (python, done) = (folder.join("bin/python"), folder.join("requirements.txt"));
    let wanted = format!("{HERE}/requirements.txt");
    let requirements = std::fs::read(&wanted).unwrap();
    if std::fs::read(&done).ok() == Some(requirements.clone()) {
        return python;
    }
    let folder = folder.to_str().unwrap();
    let help = "Python 3.11 or newer with venv is needed (on Debian: apt-get install python3-venv)";
    must(Path::new("python3"), &["-m", "venv", "--clear", folder], help);
    let help = "PyPI is needed; FLEXURE_OFFLINE=1 leaves this test out";
    must(&python, &["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", &wanted], help);
    std::fs::write(&done, requirements).unwrap();
    python
}

#[test]
fn agrees_with_pinocchio_and_notices_one_inertia() {
    if std::env::var_os("FLEXURE_OFFLINE").is_some() {
        println!("left out: FLEXURE_OFFLINE is set");
        return;
    }
    let python = environment();
    let compare = |more: &[&str]| {
        let script = format!("{HERE}/compare.py");
        let output = run(&python, &[&[&*script, env!("CARGO_BIN_EXE_flexure")], more].concat());
        let text =
            String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        (output.status.code(), text)
    };
    let (code, text) = compare(&[]);
    println!("{text}");
    assert_eq!(code, Some(0), "{text}");
    assert!(text.matches("ok     ").count() >= 40, "{text}");
    for robot in ["panda.urdf", "two-arms.urdf", "baxter.urdf", "allegro_left_hand.urdf"] {
        let line =
            text.lines().find(|line| line.ends_with(robot)).unwrap_or_else(|| panic!("{robot}: {text}"));
        assert!(line.starts_with("ok     "), "{line}");
    }
    let (code, text) = compare(&["--perturb"]);
    assert_eq!(code, Some(1), "one inertia is wrong by a millionth: {text}");
    assert!(text.contains("FAILED 7 serial"), "{text}");
}
