//! The programs of `examples/`, run as they stand: each ends in assertions of its own.

use std::collections::BTreeSet;
use std::fs;
use std::process::Termination;

use crate::common::root;

/// A module and a test for each program.
macro_rules! examples {
    ($($name:ident: $path:literal,)*) => {
        $(
            #[path = $path]
            mod $name;

            #[test]
            fn $name() -> impl Termination {
                $name::main()
            }
        )*

        const RUN: &[&str] = &[$(stringify!($name)),*];
    };
}

examples! {
    batch_of_states: "../../examples/batch_of_states.rs",
    cancel_a_run: "../../examples/cancel_a_run.rs",
    check_a_certificate: "../../examples/check_a_certificate.rs",
    exact_jacobian: "../../examples/exact_jacobian.rs",
    hold_a_loop: "../../examples/hold_a_loop.rs",
    own_law: "../../examples/own_law.rs",
    robot_from_urdf: "../../examples/robot_from_urdf.rs",
    tune_gains: "../../examples/tune_gains.rs",
}

/// Every program is run here, fits on a page, asserts something, and stands in the README.
#[test]
fn every_example_is_here() {
    let readme = fs::read_to_string(root().join("README.md")).expect("README.md");
    let mut found = BTreeSet::new();
    for entry in fs::read_dir(root().join("crates/flexure/examples")).expect("a folder") {
        let path = entry.expect("readable").path();
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let text = fs::read_to_string(&path).expect("UTF-8");
        let lines = text.lines().count();
        assert!(lines <= 60, "{name} has {lines} lines");
        assert!(text.contains("assert"), "{name} asserts nothing");
        assert!(readme.contains(&format!("crates/flexure/examples/{name}.rs")), "{name} is not in README.md");
        found.insert(name);
    }
    assert_eq!(found, RUN.iter().map(|&name| name.to_owned()).collect());
}
