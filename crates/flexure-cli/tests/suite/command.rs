//! Running the command in a folder of its own.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// A scenario to alter: the paper's arm under the tanh law, by the name of a built-in robot.
pub const SCENARIO: &str = include_str!("../../../../scenarios/two-link-tanh.toml");

/// A robot to alter.
pub const ROBOT: &str = include_str!("../../../../robots/quanser-2dof.toml");

/// Keys of a summary that the contract promises.
pub const SUMMARY: [&str; 16] = [
    "name",
    "controller",
    "phi",
    "plant",
    "max_abs_e_l",
    "rms_e_l",
    "final_abs_e_l",
    "settling_time",
    "max_abs_u_m",
    "rms_u_m",
    "saturated_fraction",
    "rate_pointwise",
    "rate_certified",
    "energy_drift",
    "steps",
    "wall_seconds",
];

/// What the command did.
#[derive(Debug)]
pub struct Outcome {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl From<Output> for Outcome {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("the command writes UTF-8");
        Self { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
    }
}

impl Outcome {
    /// It succeeded.
    #[track_caller]
    pub fn done(self) -> Self {
        assert_eq!(self.code, Some(0), "{self:?}");
        self
    }

    /// Stdout is one JSON document.
    #[track_caller]
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}: {self:?}"))
    }

    /// Without the error that stdout has and nothing else.
    #[track_caller]
    pub fn error_taken(self) -> Self {
        let document = self.json();
        let keys: Vec<_> = document.as_object().into_iter().flatten().map(|(key, _)| key).collect();
        assert_eq!(keys, ["error"], "{self:?}");
        Self { stdout: String::new(), ..self }
    }

    /// It refused the input: exit code 2, nothing on stdout, and a plain message on stderr that has a hint and each of
    /// `fragments`.
    #[track_caller]
    pub fn refused(&self, fragments: &[&str]) {
        assert_eq!(self.code, Some(2), "{self:?}");
        assert_eq!(self.stdout, "");
        self.said(fragments);
    }

    /// Stderr has a hint and each of `fragments`, and nothing that belongs on a terminal or in a debugger.
    #[track_caller]
    pub fn said(&self, fragments: &[&str]) {
        let stderr = &self.stderr;
        for fragment in ["help: ", "error["].iter().chain(fragments) {
            assert!(stderr.contains(fragment), "no '{fragment}' in\n{stderr}");
        }
        for never in ["\u{1b}", "panicked", "RUST_BACKTRACE", "flexure::"] {
            assert!(!stderr.contains(never), "'{never}' in\n{stderr}");
        }
    }
}

/// A folder to run the command in.
pub struct Place(TempDir);

impl Place {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    /// Writes a file, with the folders it is in.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> &Self {
        let path = self.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
        self
    }

    /// The default scenario with each `(from, to)` replaced once.
    pub fn scenario(&self, name: &str, changes: &[(&str, &str)]) -> &Self {
        self.write(name, altered(SCENARIO, changes))
    }

    /// The scenario with a reference whose third derivative jumps.
    pub fn jumping(&self, name: &str) -> &Self {
        let quintic = "[reference]\nkind = \"quintic\"\nfrom = [0.0, 0.0]\nto = [0.5, 0.5]\nstart = 0.0\nduration = 1.0\n";
        let (from, to) = (SCENARIO.find("[reference]").unwrap(), SCENARIO.find("[controller]").unwrap());
        self.write(name, format!("{}{quintic}{}", &SCENARIO[..from], &SCENARIO[to..]))
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Names in the folder `name`, sorted; none if it does not exist.
    pub fn names(&self, name: &str) -> Vec<String> {
        let Ok(entries) = fs::read_dir(self.path().join(name)) else { return Vec::new() };
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// The command, to be run here.
    pub fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_flexure"));
        command.args(args).current_dir(self.path()).env("NO_COLOR", "1").stdin(Stdio::null());
        command
    }

    pub fn run(&self, args: &[&str]) -> Outcome {
        self.command(args).output().unwrap().into()
    }

    /// With `input` on stdin.
    pub fn fed(&self, args: &[&str], input: impl AsRef<[u8]>) -> Outcome {
        let mut command = self.command(args);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        // A command that refuses its arguments reads nothing.
        let _ = child.stdin.take().unwrap().write_all(input.as_ref());
        child.wait_with_output().unwrap().into()
    }
}

/// `text` with each `(from, to)` replaced once.
pub fn altered(text: &str, changes: &[(&str, &str)]) -> String {
    changes.iter().fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "'{from}' is there");
        text.replacen(from, to, 1)
    })
}

/// The summary has every key of the contract.
#[track_caller]
pub fn assert_summary(summary: &Value) {
    for key in SUMMARY.iter().chain(&["diverged_at", "files"]) {
        assert!(summary.get(key).is_some(), "no {key} in {summary}");
    }
}
