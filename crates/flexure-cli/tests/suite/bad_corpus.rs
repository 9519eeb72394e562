//! Five hundred bad files and more: an error with its place, no partial output, within bounds of time and memory.
//!
//! Those in `tests/bad` are written by hand, a file a reader, each bad one below a line `#### what must be said`. The others
//! are good ones with cuts, flipped bits, stray tokens and numbers that are none, drawn from a seed: what is still good after
//! that is not counted.

use std::io::Write;
use std::process::{Command, Stdio};

use crate::command::{Outcome, Place, ROBOT, SCENARIO, altered};

/// A reader: the file it reads, the command that makes it, what else lies there, and good files.
struct Reader {
    file: &'static str,
    command: &'static str,
    beside: Option<(&'static str, String)>,
    good: Vec<String>,
    by_hand: &'static str,
}

/// Mutants that are drawn for each reader, and how many bad files each must have had at the end.
const DRAWN: usize = 110;
const BAD: usize = 90;

/// The page that lists the codes of errors.
const CODES: &str = include_str!("../../../../docs/files.md");

/// Runs the command with 2 s of processor time and 256 MiB of address space, for a program built for tests.
fn run(place: &Place, command: &str) -> Outcome {
    let flexure = env!("CARGO_BIN_EXE_flexure");
    let script = format!("ulimit -t 2; ulimit -v 262144; ulimit -s 1024; exec '{flexure}' {command}");
    let mut shell = Command::new("sh");
    shell.args(["-c", &script]).current_dir(place.path()).env("NO_COLOR", "1").env("RAYON_NUM_THREADS", "1");
    let mut child =
        shell.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let _ = child.stdin.take().unwrap().write_all(STATE.as_bytes());
    child.wait_with_output().unwrap().into()
}

/// For the readers that want to be asked something.
const STATE: &str = "{\"q_l\": [0, 0], \"q_m\": [0, 0], \"dq_l\": [0, 0], \"dq_m\": [0, 0]}\n";

/// xorshift64*: the same files every time.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        usize::try_from(self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33).unwrap() % bound.max(1)
    }

    fn one<'a>(&mut self, of: &[&'a str]) -> &'a str {
        of[self.below(of.len())]
    }

    /// `text` with one to three things wrong.
    fn mutant(&mut self, text: &str) -> Vec<u8> {
        let mut bytes = text.as_bytes().to_vec();
        for _ in 0..=self.below(3) {
            let at = self.below(bytes.len());
            match self.below(8) {
                0 => bytes.truncate(at),
                1 => bytes[at] ^= 1 << self.below(8),
                2 => bytes.insert(at, self.one(&["\0", "\u{1b}", "\u{7f}", "\r", "\t"]).as_bytes()[0]),
                3 => drop(bytes.splice(at..at, [0xff, 0xc0])),
                4 => {
                    let token =
                        self.one(&["[", "]", "{", "}", "\"", "'''", "<", "&", "=", ",", "\n", "é", "--"]);
                    drop(bytes.splice(at..at, token.bytes()));
                }
                5 => drop(bytes.drain(at..(at + 1 + self.below(60)).min(bytes.len()))),
                _ => self.replace_number(&mut bytes, at),
            }
            if bytes.is_empty() {
                break;
            }
        }
        bytes
    }

    /// The next number after `at` by one that is none, or by one beyond all bounds.
    fn replace_number(&mut self, bytes: &mut Vec<u8>, at: usize) {
        let Some(start) = (at..bytes.len()).find(|&i| bytes[i].is_ascii_digit()) else { return };
        let is_number = |byte: &u8| byte.is_ascii_digit() || b".e-+".contains(byte);
        let end = (start..bytes.len()).find(|&i| !is_number(&bytes[i])).unwrap_or(bytes.len());
        let number = self.one(&[
            "nan", "-inf", "1e999", "-1e308", "1,5", "0x", "1_", "", "\"1\"", "[[1]]", "null", "1e-999x",
        ]);
        drop(bytes.splice(start..end, number.bytes()));
    }
}

impl Reader {
    /// The answer to the file `content`: refused with code, place and hint, or good.
    fn is_bad(&self, place: &Place, content: &[u8]) -> bool {
        place.write(self.file, content);
        let before = place.names(".");
        let outcome = run(place, &format!("{} --json", self.command));
        let shown = || format!("{outcome:?}\n{}", String::from_utf8_lossy(content));
        assert_eq!(place.names("."), before, "{}", shown());
        assert!(matches!(outcome.code, Some(0..=2)), "{}", shown());
        assert!(!outcome.stderr.contains("panicked") && !outcome.stderr.contains('\u{1b}'), "{}", shown());
        assert!(outcome.stdout.len() < 100_000 && outcome.stderr.len() < 100_000, "{}", shown());
        if outcome.code == Some(0) {
            return false;
        }
        let error = &outcome.json()["error"];
        let text = |key: &str| error[key].as_str().unwrap_or_default().to_owned();
        assert!(
            !text("code").is_empty() && !text("message").is_empty() && !text("hint").is_empty(),
            "{}",
            shown()
        );
        assert!(CODES.contains(&format!("`{}`", text("code"))), "{} is not in docs/files.md", text("code"));
        // A claim that does not hold is named instead; certificates have places of their own: keys.
        if self.file == "bad.json" {
            assert!(text("message").contains(": "), "{}", shown());
        } else {
            let beside = self.beside.as_ref().map(|(name, _)| *name);
            assert!([Some(self.file), beside].contains(&error["file"].as_str()), "{}", shown());
            assert_eq!(outcome.code, Some(2), "{}", shown());
            assert!(error["line"].as_u64() >= Some(1) && error["column"].as_u64() >= Some(1), "{}", shown());
        }
        true
    }

    fn sweep(&self, seed: u64) {
        let place = Place::new();
        if let Some((name, content)) = &self.beside {
            place.write(name, content);
        }
        for good in &self.good {
            assert!(!self.is_bad(&place, good.as_bytes()), "good files are accepted");
        }
        let mut bad = 0;
        for section in self.by_hand.split("#### ").skip(1) {
            let (said, content) = section.split_once('\n').expect("a line that says what must be said");
            place.write(self.file, content);
            let outcome = run(&place, self.command);
            assert!(matches!(outcome.code, Some(1 | 2)), "{said}: {outcome:?}");
            assert!(outcome.stdout.is_empty(), "{said}: {outcome:?}");
            outcome.said(&[said, self.file]);
            assert!(self.is_bad(&place, content.as_bytes()), "{said}");
            bad += 1;
        }
        let mut random = Random(seed);
        for i in 0..DRAWN {
            let mutant = random.mutant(&self.good[i % self.good.len()]);
            bad += usize::from(self.is_bad(&place, &mutant));
        }
        assert!(bad >= BAD, "{bad} bad files for `{}`", self.command);
    }
}

fn built_in(name: &str) -> String {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../");
    std::fs::read_to_string(format!("{root}{name}")).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn robots() {
    let reader = Reader {
        file: "bad.toml",
        command: "model bad.toml --states -",
        beside: None,
        good: vec![
            ROBOT.to_owned(),
            built_in("robots/two-link-plausible.toml"),
            built_in("robots/planar-2r.toml"),
        ],
        by_hand: include_str!("../bad/robots.txt"),
    };
    reader.sweep(1);
}

#[test]
fn scenarios() {
    let reader = Reader {
        file: "bad.toml",
        command: "eval bad.toml --states -",
        beside: None,
        good: ["two-link-tanh", "two-link-hardware", "two-link-everything", "two-link-coupled-tanh-smooth"]
            .map(|name| built_in(&format!("scenarios/{name}.toml")))
            .to_vec(),
        by_hand: include_str!("../bad/scenarios.txt"),
    };
    reader.sweep(2);
}

#[test]
fn urdfs() {
    let reader = Reader {
        file: "bad.urdf",
        command: "import bad.urdf",
        beside: None,
        good: vec![built_in("fuzz/seeds/arm.urdf"), built_in("robots/panda.urdf")],
        by_hand: include_str!("../bad/urdfs.txt"),
    };
    reader.sweep(3);
}

#[test]
fn samples() {
    let start = SCENARIO.find("kind = \"sine\"").unwrap();
    let sine = &SCENARIO[start..SCENARIO.find("[controller]").unwrap()];
    let changes = [(sine, "kind = \"samples\"\nfile = \"bad.csv\"\n"), ("duration = 10.0", "duration = 2.0")];
    let reader = Reader {
        file: "bad.csv",
        command: "eval s.toml --states -",
        beside: Some(("s.toml", altered(SCENARIO, &changes))),
        good: vec![built_in("fuzz/seeds/path.csv")],
        by_hand: include_str!("../bad/samples.txt"),
    };
    reader.sweep(4);
}

#[test]
fn states() {
    let reader = Reader {
        file: "bad.jsonl",
        command: "model quanser-2dof --states bad.jsonl",
        beside: None,
        good: vec![built_in("fuzz/seeds/states.jsonl"), built_in("fuzz/seeds/along.jsonl")],
        by_hand: include_str!("../bad/states.txt"),
    };
    reader.sweep(5);
}

#[test]
fn certificates() {
    let reader = Reader {
        file: "bad.json",
        command: "verify bad.json",
        beside: None,
        good: ["pendulum", "two-link-linear", "two-link-tanh"]
            .map(|name| built_in(&format!("crates/flexure/tests/certificates/{name}.json")))
            .to_vec(),
        by_hand: include_str!("../bad/certificates.txt"),
    };
    reader.sweep(6);
}
