//! What a certificate is about: hashes that depend on what files say and on nothing else, and another program finds the same.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use flexure::files::{SCENARIOS, TASKS};
use flexure::prove::engine::certificate::Certificate;
use flexure::prove::question::Question;
use flexure::prove::subject::{Difference, differences};
use flexure::scenario::{Scenario, load_scenario};
use flexure::verify::verify;
use tempfile::TempDir;

use super::{CERTIFICATES, certificates};
use crate::common::root;

/// A folder with a copy of a robot, of its URDF and of a scenario that names it.
struct Files {
    folder: TempDir,
}

const ROBOT: &str = "robot.toml";
const LOOP: &str = "loop.toml";

impl Files {
    fn new(scenario: &str, robot: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let read = |path: String| fs::read_to_string(root().join(path)).unwrap();
        let own = read(format!("scenarios/{scenario}.toml"));
        let named = own.replace(&format!("robot = \"{robot}\""), &format!("robot = \"{ROBOT}\""));
        assert_ne!(own, named);
        fs::write(folder.path().join(LOOP), named).unwrap();
        fs::write(folder.path().join(ROBOT), read(format!("robots/{robot}.toml"))).unwrap();
        fs::write(folder.path().join("panda.urdf"), read("robots/panda.urdf".to_owned())).unwrap();
        Self { folder }
    }

    fn path(&self, file: &str) -> PathBuf {
        self.folder.path().join(file)
    }

    /// With `from` once replaced in a file.
    #[track_caller]
    fn with(self, file: &str, from: &str, to: &str) -> Self {
        let text = fs::read_to_string(self.path(file)).unwrap();
        assert!(text.contains(from), "{from} is not in {file}");
        fs::write(self.path(file), text.replacen(from, to, 1)).unwrap();
        self
    }

    fn load(&self) -> Scenario {
        load_scenario(self.path(LOOP).to_str().unwrap()).unwrap_or_else(|problems| panic!("{problems}"))
    }
}

fn certificate(scenario: &Scenario) -> Certificate {
    let proof = scenario.certify(&Question::default()).unwrap();
    proof.verdict.proved().unwrap_or_else(|| panic!("{:?}", proof.verdict)).clone()
}

/// Places at which the certificate of `one` is not about `other`.
fn places(one: &Scenario, other: &Scenario) -> Vec<String> {
    let text = serde_json::to_string(&certificate(one)).unwrap();
    differences(&text, other).unwrap().into_iter().map(|Difference { place, .. }| place).collect()
}

#[test]
fn spelling_is_not_the_loop() {
    let plain = Files::new("pendulum-tanh", "pendulum-1dof").load();
    let named = load_scenario("pendulum-tanh").unwrap();
    assert_eq!(places(&named, &plain), [""; 0]);
    let other = Files::new("pendulum-tanh", "pendulum-1dof");
    let text = fs::read_to_string(other.path(LOOP)).unwrap();
    // Tables in another order, comments, blanks, numbers in another spelling, what is said anyway.
    let (head, tables) = text.split_at(text.find("\n[").unwrap());
    let mut tables: Vec<_> = tables.split("\n[").filter(|table| !table.is_empty()).collect();
    tables.reverse();
    let text = format!("# Other words.\nseed = 0\nhold = 'zero-order'\n{head}\n[{}\n", tables.join("\n["));
    fs::write(other.path(LOOP), text.replace("0.001", "1.0e-3").replace(" = ", "  =\t")).unwrap();
    let robot = fs::read_to_string(other.path(ROBOT)).unwrap();
    let renamed = robot.replace("name = \"pendulum-1dof\"", "name = \"another name\"");
    assert_ne!(robot, renamed);
    fs::write(other.path(ROBOT), renamed).unwrap();
    assert_eq!(places(&plain, &other.load()), [""; 0]);
}

#[test]
fn whatever_is_said_of_the_loop_counts() {
    let plain = Files::new("pendulum-tanh", "pendulum-1dof").load();
    let changed = |file: &str, from: &str, to: &str| {
        Files::new("pendulum-tanh", "pendulum-1dof").with(file, from, to).load()
    };
    // Of the controller the numbers are named; of what no number of the certificate tells, the file.
    let text = fs::read_to_string(root().join("scenarios/pendulum-tanh.toml")).unwrap();
    let duration = text.lines().find(|line| line.starts_with("duration")).unwrap();
    assert_eq!(places(&plain, &changed(LOOP, duration, "duration = 7.5")), ["subject.scenario"]);
    assert_eq!(
        places(&plain, &changed(LOOP, duration, &format!("{duration}\nseed = 1"))),
        ["subject.scenario"]
    );
    let robot = fs::read_to_string(root().join("robots/pendulum-1dof.toml")).unwrap();
    let stiffness = robot.lines().find(|line| line.starts_with("stiffness")).unwrap();
    let found = places(&plain, &changed(ROBOT, stiffness, "stiffness = [77.0]"));
    assert_eq!(found, ["robot.stiffness[0]", "subject.robot"]);
}

/// A URDF counts with what is read of it.
#[test]
fn a_urdf_counts_by_what_it_says() {
    let files = || Files::new("panda-tanh-smooth", "panda");
    let plain = files().load();
    let text = fs::read_to_string(files().path("panda.urdf")).unwrap();
    let mass = &text[text.find("<mass value=\"").unwrap()..];
    let mass = &mass[..=mass.find("/>").unwrap()];
    let subject = |scenario: &Scenario| certificate(scenario).subject.unwrap();
    let own = subject(&plain);
    let spelt = files().with("panda.urdf", "<robot ", "<!-- words -->\n<robot ").with(
        "panda.urdf",
        mass,
        &mass.replace("=\"", " = \"\n 0"),
    );
    assert_eq!(subject(&spelt.load()), own);
    let other = files().with("panda.urdf", mass, &mass.replace("=\"", "=\"1"));
    let other = subject(&other.load());
    assert_eq!((other.robot == own.robot, other.scenario == own.scenario), (false, true));
}

/// The statement is enough to write a program that finds the same hashes: one in Python has.
#[test]
fn another_program_finds_the_same_hashes() {
    let folder = root();
    let names: Vec<&str> = SCENARIOS.iter().chain(TASKS).map(|(name, _)| *name).collect();
    let run = Command::new("python3")
        .arg(folder.join("tools/normal_form.py"))
        .args(names.iter().map(|name| folder.join(format!("scenarios/{name}.toml"))))
        .output()
        .unwrap();
    let said = String::from_utf8(run.stdout).unwrap();
    let hashes: Vec<_> = said.lines().map(|line| line.split(' ').nth(1).unwrap()).collect();
    assert_eq!(hashes.len(), 2 * names.len(), "{}", String::from_utf8_lossy(&run.stderr));
    let mut compared = 0;
    for (name, hashes) in names.iter().zip(hashes.chunks(2)) {
        let scenario = load_scenario(name).unwrap();
        // Where there is no certificate, there is no hash to be seen.
        let Ok(problem) = flexure::prove::proposition::proposition(&scenario, &Question::default(), None)
        else {
            continue;
        };
        let subject = problem.subject.unwrap();
        assert_eq!([subject.robot.as_str(), subject.scenario.as_str()], *hashes, "{name}");
        compared += 1;
    }
    assert!(compared >= 10, "{compared}");
}

/// A sampled reference counts with its samples, wherever they lie.
#[test]
fn samples_count_by_their_numbers() {
    let with = |name: &str, samples: &str| {
        let files = Files::new("pendulum-tanh", "pendulum-1dof");
        let text = fs::read_to_string(files.path(LOOP)).unwrap();
        let start = text.find("[reference]").unwrap();
        let end = start + text[start..].find("[controller").unwrap();
        let reference = format!("[reference]\nkind = \"samples\"\nfile = \"{name}\"\n\n");
        fs::write(files.path(LOOP), format!("{}{reference}{}", &text[..start], &text[end..])).unwrap();
        fs::write(files.path(name), samples).unwrap();
        certificate(&files.load()).subject.unwrap()
    };
    let rows = |q: &str| (0..30).map(|i| format!("{i},{q}")).collect::<Vec<_>>().join("\n");
    let own = with("a.csv", &format!("t,q1\n{}", rows("0.10")));
    assert_eq!(with("b.csv", &format!(" t , q1\n\n{}", rows(" 1e-1"))), own);
    assert_ne!(with("a.csv", &format!("t,q1\n{}", rows("0.11"))), own);
}

/// What a file of version 1 has not, cannot be compared; what it has, is.
#[test]
fn version_1_has_no_hash() {
    let scenario = load_scenario("two-link-tanh").unwrap();
    let found = differences(CERTIFICATES[4].1, &scenario).unwrap();
    assert!(found.iter().any(|found| found.place == "subject" && found.certificate == "null"), "{found:?}");
}

/// Fields of the wrong form are no certificate, to both checkers; made-up hashes of the right form are words of the file.
#[test]
fn hashes_have_a_form() {
    let certificate = serde_json::to_value(certificate(&load_scenario("pendulum-tanh").unwrap())).unwrap();
    let own = certificate["subject"]["robot"].as_str().unwrap().to_owned();
    assert!(verify(&certificate.to_string()).is_ok());
    let texts: Vec<String> = [
        own.to_uppercase(),
        own[1..].to_owned(),
        format!("{own}0"),
        "x".repeat(64),
        String::new(),
        format!("{own}\n"),
    ]
    .into_iter()
    .filter(|text| *text != own)
    .map(|text| certificate.to_string().replace(&own, &text.escape_debug().to_string()))
    .collect();
    for text in &texts {
        assert!(matches!(verify(text), Err(flexure::verify::Rejected::Malformed { .. })), "{text}");
    }
    let fine = [certificate.to_string().replace(&own, &"0".repeat(64)), {
        let mut none = certificate.clone();
        none["subject"] = serde_json::Value::Null;
        none.to_string()
    }];
    assert!(fine.iter().all(|text| verify(text).is_ok()));
    if let Some(codes) = super::python::codes(&texts) {
        assert!(codes.iter().all(|code| *code == 2), "{codes:?}");
        assert_eq!(super::python::codes(&fine).unwrap(), [0, 0]);
    }
}

/// The file's own words are told as such, whatever they look like.
#[test]
fn words_of_the_file_are_in_quotes() {
    let (_, mut content) = certificates().next().unwrap();
    content["name"] = "x\nverified: \u{1b}[2Jall\u{202e}".into();
    let report = verify(&content.to_string()).unwrap();
    let name = report.about.iter().find(|claim| claim.name == "name").unwrap();
    assert_eq!(name.value, r#""x\nverified: \u{1b}[2Jall\u{202e}""#);
    for wanted in ["made_by", "robot.name", "robot.stiffness", "controller.link.metric", "robot.links.mass"] {
        assert!(report.about.iter().any(|claim| claim.name == wanted), "{wanted}");
    }
}
