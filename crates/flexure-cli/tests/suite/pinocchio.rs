//! Every robot of at most 16 joints of a public collection, and of our own test data, against Pinocchio: see `pinocchio/compare.py`.
//!
//! Pinocchio and the robots come from PyPI into a virtual environment of the test's own, about 900 MB under the target
//! folder. Set `FLEXURE_OFFLINE=1` to leave the test out where PyPI is out of reach.

use crate::pypi::{environment, is_out_of_reach, run};

const HERE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/pinocchio");

#[test]
fn agrees_with_pinocchio_and_notices_one_inertia() {
    if is_out_of_reach() {
        return;
    }
    let python = environment("pinocchio", &format!("{HERE}/requirements.txt"));
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
