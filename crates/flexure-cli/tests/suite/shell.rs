//! What a shell and its user see: completion, manual pages, examples, the width of the terminal.
#![cfg(unix)]

use std::process::{Command, Output};

use crate::command::{Outcome, Place};

/// `script` in a shell that finds the command.
fn shell(place: &Place, shell: &str, script: &str) -> Output {
    let folder = std::path::Path::new(env!("CARGO_BIN_EXE_flexure")).parent().unwrap();
    let path = format!("{}:{}", folder.display(), std::env::var("PATH").unwrap());
    Command::new(shell)
        .args(["-c", script])
        .current_dir(place.path())
        .env("PATH", path)
        .env("NO_COLOR", "1")
        .output()
        .unwrap()
}

fn commands(place: &Place) -> Vec<String> {
    let help = place.run(&["--help"]).done().stdout;
    let listed =
        help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    // Summaries go on in deeper lines.
    let named = listed.filter_map(|line| line.strip_prefix("  ")).filter(|line| !line.starts_with(' '));
    let names: Vec<String> = named
        .map(|line| line.split_whitespace().next().unwrap().to_owned())
        .filter(|name| name != "help")
        .collect();
    assert!(names.len() >= 13, "{names:?}");
    names
}

/// What follows `Example` in a help text.
fn examples(help: &str) -> Vec<&str> {
    let after = help.lines().skip_while(|line| !line.starts_with("Example"));
    after.filter_map(|line| line.strip_prefix("  ")).filter(|line| line.starts_with("flexure ")).collect()
}

/// Every command has an example in its help, and every example does what it says.
/// Runs of two instants each.
const SWEEP: &str = "scenario = \"pendulum-tanh\"\ndesign = \"uniform\"\npoints = 8200\nset.duration = 0.001\n[parameters]\n\
                     \"robot.joints.stiffness\" = { from = 0.9, to = 1.1, relative = true }\n";

#[test]
fn examples_of_every_help_run() {
    let place = Place::new();
    place.write("panda.urdf", include_str!("../../../../robots/panda.urdf"));
    let state = "{\"t\": 0, \"q_l\": [0.1, 0], \"q_m\": [0.1, 0], \"dq_l\": [0, 0], \"dq_m\": [0, 0]}\n";
    place.write("states.jsonl", state);
    // A sweep of which row 8123 is the last that the examples speak of.
    place.write("sweep.toml", SWEEP);
    let help = place.run(&["--help"]).done().stdout;
    let mut lines: Vec<String> = examples(&help).into_iter().map(str::to_owned).collect();
    assert!(!lines.is_empty(), "{help}");
    for command in commands(&place) {
        let help = place.run(&[&command, "--help"]).done().stdout;
        let own = examples(&help);
        assert!(!own.is_empty(), "{command}");
        assert!(own.iter().all(|line| line.starts_with(&format!("flexure {command}"))), "{own:?}");
        lines.extend(own.into_iter().map(str::to_owned));
    }
    // A log to replay.
    place.run(&["run", "two-link-tanh"]).done();
    // Identification takes minutes, unless optimised; its own tests run it.
    for line in lines.into_iter().filter(|line| !line.starts_with("flexure identify")) {
        let outcome = Outcome::from(shell(&place, "sh", &line));
        assert_eq!(outcome.code, Some(0), "{line}: {outcome:?}");
    }
}

#[test]
fn bash_completes_commands_and_kinds() {
    let place = Place::new();
    let complete = |words: &str, word: &str| {
        let script = format!(
            "source <(flexure completions bash) && complete -p flexure >/dev/null && COMP_WORDS=({words}) && \
             COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)) && _flexure flexure '{word}' && echo \"${{COMPREPLY[@]}}\""
        );
        String::from_utf8(shell(&place, "bash", &script).stdout).unwrap()
    };
    assert_eq!(complete("flexure cert", "cert").trim(), "certify");
    assert!(complete("flexure list imp", "imp").trim().ends_with("imperfections"));
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = place.run(&["completions", shell]).done().stdout;
        assert!(script.contains("margins"), "{shell}");
        assert_eq!(place.run(&["completions", shell, "--json"]).done().json()["script"], script);
    }
    assert_eq!(place.run(&["completions", "tcsh"]).code, Some(2));
}

#[test]
fn every_command_has_a_manual_page() {
    let place = Place::new();
    let page = place.run(&["man"]).done().stdout;
    assert!(page.contains(".TH FLEXURE 1") && page.contains("certify"), "{page}");
    place.run(&["man", "pages"]).done();
    let mut names: Vec<String> =
        commands(&place).iter().map(|command| format!("flexure-{command}.1")).collect();
    names.push("flexure.1".to_owned());
    names.sort();
    assert_eq!(place.names("pages"), names);
    assert_eq!(place.read("pages/flexure.1"), page);
    assert!(place.read("pages/flexure-run.1").contains("flexure run two"), "its example");
    let json = place.run(&["man", "pages", "--json"]).done().json();
    assert_eq!((&json["page"], json["files"].as_array().unwrap().len()), (&page.into(), names.len()));
    place.write("file", "").run(&["man", "file"]).refused(&["file"]);
}

/// On a terminal no line is wider than it, every number is there, and no name is broken.
#[test]
#[cfg(target_os = "linux")]
fn tables_are_as_wide_as_the_terminal() {
    let place = Place::new();
    let plain = place.run(&["check", "panda"]).done().stdout;
    for columns in [40_usize, 60, 80, 200] {
        let script =
            format!("script -qec 'stty cols {columns} rows 24 && flexure check panda' /dev/null </dev/null");
        let output = shell(&place, "bash", &script);
        let text = String::from_utf8(output.stdout).unwrap().replace('\r', "");
        assert!(output.status.success(), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= columns), "{columns}:\n{text}");
        for word in plain.split_whitespace().filter(|word| word.starts_with("panda_") || word.contains("000"))
        {
            assert!(text.contains(word), "no {word} at {columns}:\n{text}");
        }
    }
}
