//! The rooms of the library and the arrows between them: every import points downwards.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The rooms of `src`, from the bottom up: each may use those above it in this list, and none below.
const ROOMS: [&str; 31] = [
    "units",         // how numbers are measured and how that is written
    "files",         // text with places, problems that point at it, files that appear whole
    "linalg",        // matrices of run-time sizes
    "lanes",         // numbers side by side in a register
    "processor",     // does it have what the program was built for
    "verify",        // the checker of certificates
    "progress",      // how far long jobs are
    "robot",         // robot files, URDFs, Arm
    "logs",          // what was measured on a robot
    "plant",         // what is simulated: joints as they are
    "references",    // where the links shall be
    "laws",          // control laws and their gains
    "imperfections", // what sensors, computers, drives and joints do
    "estimators",    // from readings to motion
    "scenario",      // all of these in one file
    "registered",    // what has a name
    "feasible",      // does a reference keep the robot's limits, and how fast may it be
    "simulate",      // Loop, runs, traces
    "replay",        // a log over the simulation
    "excite",        // the motion that tells most
    "identify",      // from logs to the numbers of the joints
    "sampled",       // is the loop stable that holds its torque
    "check",         // what is in a file
    "eval",          // law and model at given states
    "prove",         // certificates
    "tune",          // gains by search
    "compare",       // laws on the same tasks
    "margins",       // what a loop bears
    "design",        // gains from a specification
    "sweep",         // many runs whose numbers change
    "report",        // figures, tables, pages
];

/// What stands above all rooms.
const TOP: [&str; 1] = ["reproduce"];

/// Rooms within rooms that may use less than their room: everything else of the crate is out of bounds.
const CONFINED: [(&str, &[&str]); 3] = [
    // The trusted base of proofs knows of no files and no simulation; it tells how far it is.
    ("prove/engine", &["linalg", "units", "progress", "prove::engine"]),
    // The checker shares the interval type with the prover, and nothing else.
    ("verify", &["verify"]),
    ("linalg", &["linalg"]),
];

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Every source file below `folder` with its path from there, `/` between the parts.
fn sources(folder: &Path) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).expect("a folder").map(|entry| entry.expect("an entry").path()) {
            if entry.is_dir() {
                folders.push(entry);
            } else if entry.extension().is_some_and(|ending| ending == "rs") {
                let name = entry.strip_prefix(folder).expect("below it").to_string_lossy().replace('\\', "/");
                found.push((name, fs::read_to_string(&entry).expect("UTF-8")));
            }
        }
    }
    assert!(!found.is_empty());
    found
}

/// The paths of the crate that `text` names, imports and others, without `crate::`; groups are spelt out. Comments and the tests
/// at the end do not count.
fn named(text: &str) -> BTreeSet<String> {
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let code: String = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    let mut paths = BTreeSet::new();
    for (at, _) in code.match_indices("crate::") {
        // `$crate::` of a macro is this crate too; `flexure_crate::` is not.
        if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
            continue;
        }
        spell_out("", &code[at + "crate::".len()..], &mut paths);
    }
    paths
}

/// The paths that `rest` begins with, each behind `before`; returns what comes after them.
fn spell_out<'a>(before: &str, rest: &'a str, paths: &mut BTreeSet<String>) -> &'a str {
    let rest = rest.trim_start();
    let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':')).unwrap_or(rest.len());
    let path = format!("{before}{}", &rest[..end]);
    let Some(mut group) = rest[end..].strip_prefix('{') else {
        paths.insert(path.trim_end_matches("::").to_owned());
        return &rest[end..];
    };
    loop {
        group = spell_out(&path, group, paths).trim_start();
        // `as name`
        group = group.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_' || c == ' ');
        match group.strip_prefix(',').map(str::trim_start) {
            Some(next) if !next.starts_with('}') => group = next,
            Some(next) => return &next[1..],
            None => return group.strip_prefix('}').unwrap_or(group),
        }
    }
}

/// The room of a path of the crate, or of a file.
fn room(path: &str) -> &str {
    path.split(['/', ':', '.']).next().unwrap_or_default()
}

/// What is wrong with the imports of `file`.
fn complaints(file: &str, text: &str) -> Vec<String> {
    let place = |room: &str| ROOMS.iter().chain(&TOP).position(|known| *known == room);
    let Some(own) = place(room(file)) else {
        return vec![format!("{file} is in no room: add it to the list, and to ARCHITECTURE.md")];
    };
    let upwards = |path: &&String| place(room(path)).is_some_and(|other| other > own);
    let paths = named(text);
    let mut wrong: Vec<_> =
        paths.iter().filter(upwards).map(|path| format!("{file} reaches up for {path}")).collect();
    for (folder, allowed) in CONFINED.iter().filter(|(folder, _)| file.starts_with(&format!("{folder}/"))) {
        let outside = paths.iter().filter(|path| !allowed.iter().any(|inside| path.starts_with(inside)));
        wrong.extend(outside.map(|path| format!("{file}, in {folder}, uses {path}")));
    }
    wrong
}

/// The files that only tests are compiled from: their `mod` line stands behind `#[cfg(test)]`.
fn of_tests(sources: &[(String, String)]) -> BTreeSet<String> {
    let of = |(file, text): &(String, String)| {
        let folder = file.strip_suffix("mod.rs").map(str::to_owned);
        let names = text.split("#[cfg(test)]").skip(1).filter_map(|rest| {
            let rest = rest.trim_start();
            rest.strip_prefix("mod ").or(rest.strip_prefix("pub(crate) mod "))?.split_once(';')
        });
        let names = names.map(|(name, _)| name.to_owned()).collect::<Vec<_>>();
        folder.map(|folder| names.into_iter().map(move |name| format!("{folder}{name}.rs")))
    };
    sources.iter().filter_map(of).flatten().collect()
}

#[test]
fn arrows_point_downwards() {
    let sources = sources(&source());
    let of_tests = of_tests(&sources);
    let wrong: Vec<_> = sources
        .iter()
        .filter(|(file, _)| file != "lib.rs" && !of_tests.contains(file))
        .flat_map(|(file, text)| complaints(file, text))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_room_is_there_and_described() {
    let map = fs::read_to_string(source().join("../../../ARCHITECTURE.md")).expect("the map");
    for room in ROOMS.iter().chain(&TOP) {
        let there = source().join(room).is_dir() || source().join(format!("{room}.rs")).is_file();
        assert!(there, "{room} is listed and is not there");
        assert!(map.contains(&format!("  {room}")), "ARCHITECTURE.md has no line for {room}");
    }
}

/// The one file that turns a joint count into a type is used where robots, loops and proofs are made, and laws that are designed
/// for their robot.
#[test]
fn sizes_are_chosen_in_few_places() {
    let users: Vec<String> = sources(&source())
        .into_iter()
        .filter(|(file, text)| file != "robot/sized.rs" && text.contains("sized!("))
        .map(|(file, _)| file)
        .collect();
    assert!(users.len() <= 10, "{users:?}");
    assert!(
        users.iter().all(|file| ["robot", "feasible", "simulate", "identify", "sampled", "prove", "laws"]
            .contains(&room(file))),
        "{users:?}"
    );
}

#[test]
fn the_reader_of_imports_reads() {
    let text =
        "use crate::a::{B, c::{D, e as f}, g};\n// crate::z::no\nlet x = crate::h::i(1);\nuse std::fmt;";
    let found: Vec<_> = named(text).into_iter().collect();
    assert_eq!(found, ["a::B", "a::c::D", "a::c::e", "a::g", "h::i"]);
    assert_eq!(complaints("robot/mod.rs", "use crate::simulate::Loop;").len(), 1);
    assert_eq!(complaints("simulate/mod.rs", "use crate::robot::Arm;").len(), 0);
    assert_eq!(complaints("prove/engine/rate.rs", "use crate::files::Problem;").len(), 1);
    assert_eq!(complaints("verify/mod.rs", "use crate::linalg::Dense;").len(), 1);
    assert_eq!(complaints("attic/mod.rs", "").len(), 1);
}
