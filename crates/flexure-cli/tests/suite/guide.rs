//! "Your robot in ten minutes": the commands of the page are run, and what they print is what the page shows.

use crate::command::Place;
use crate::public_robots::urdf;
use crate::pypi::is_out_of_reach;

const PAGE: &str = include_str!("../../../../docs/your-robot.md");

/// Stands in the page for lines that are left out.
const LEFT_OUT: &str = "…";

/// A number of the page and one that is printed mean the same if they differ by no more than this, relatively.
const NOISE: f64 = 0.02;

/// The commands of a block of the page, and what it shows of their output.
struct Step<'a> {
    commands: Vec<&'a str>,
    shown: Option<&'a str>,
}

/// Blocks of `sh`, each with the block of `text` behind it if one follows before the next.
fn steps(page: &str) -> Vec<Step<'_>> {
    let mut steps: Vec<Step<'_>> = Vec::new();
    for block in page.split("\n```").skip(1).step_by(2) {
        let (language, content) = block.split_once('\n').unwrap_or((block, ""));
        match language {
            "sh" => {
                let commands = content.lines().filter(|line| line.starts_with("flexure "));
                steps.push(Step { commands: commands.collect(), shown: None });
            }
            "text" => steps.last_mut().expect("a command comes first").shown = Some(content),
            _ => {}
        }
    }
    steps
}

/// Whether two words mean the same: numbers up to noise.
fn alike(shown: &str, printed: &str) -> bool {
    let number =
        |word: &str| word.trim_end_matches([',', ';', '.', ':', ')']).replace('−', "-").parse::<f64>().ok();
    match (number(shown), number(printed)) {
        (Some(a), Some(b)) => (a - b).abs() <= NOISE * a.abs().max(b.abs()).max(1e-6),
        _ => shown == printed,
    }
}

/// Whether `printed` is what the page shows, any lines in the place of what it leaves out.
fn shows(shown: &str, printed: &str) -> Result<(), String> {
    let mut rest = printed.lines();
    let mut free = false;
    for line in shown.lines().filter(|line| !line.trim().is_empty()) {
        if line.trim() == LEFT_OUT {
            free = true;
            continue;
        }
        let words: Vec<_> = line.split_whitespace().collect();
        let is_it = |candidate: &str| {
            let others: Vec<_> = candidate.split_whitespace().collect();
            // A ruler is as long as its table is wide.
            let ruler = |text: &str| text.chars().all(|c| "─═━-".contains(c));
            words.len() == others.len()
                && words.iter().zip(&others).all(|(a, b)| alike(a, b) || ruler(a) && ruler(b))
        };
        let mut candidates = rest.by_ref().filter(|line| !line.trim().is_empty());
        let found = if free { candidates.any(is_it) } else { candidates.next().is_some_and(is_it) };
        if !found {
            return Err(format!("not printed: {line}"));
        }
        free = false;
    }
    Ok(())
}

/// A minute, as two searches for gains are among them.
#[test]
fn the_page_shows_what_its_commands_print() {
    if is_out_of_reach() {
        return;
    }
    let place = Place::new();
    for robot in ["ur5", "z1", "xarm7"] {
        place.write(&format!("{robot}.urdf"), urdf(robot));
    }
    let steps = steps(PAGE);
    assert!(steps.iter().map(|step| step.commands.len()).sum::<usize>() > 8);
    for Step { commands, shown } in steps {
        let mut printed = String::new();
        for command in commands {
            let (command, note) = command.split_once('#').unwrap_or((command, ""));
            let code = note.trim().strip_prefix("exit code ").map_or(0, |code| code.parse().unwrap());
            let arguments: Vec<&str> = command.split_whitespace().skip(1).collect();
            let outcome = place.run(&arguments);
            assert_eq!(outcome.code, Some(code), "{command}: {outcome:?}");
            printed.push_str(&outcome.stderr);
            printed.push_str(&outcome.stdout);
        }
        if let Some(shown) = shown {
            shows(shown, &printed).unwrap_or_else(|wrong| panic!("{wrong}\n--- printed ---\n{printed}"));
        }
    }
}

#[test]
fn the_comparison_notices() {
    let printed = "a 1.001 b\nc 5\nd −2.0\n";
    for good in ["a 1.0 b\nc 5\nd -2", "…\nd −2", "a 1 b\n…\nd -2"] {
        assert_eq!(shows(good, printed), Ok(()), "{good}");
    }
    for bad in ["a 1.1 b", "c 5", "a 1 b\nd -2", "…\ne 5", "…\nc 5\nc 5"] {
        assert!(shows(bad, printed).is_err(), "{bad}");
    }
}

/// The SPEC of the page on gains can be met by the robot of the page: for a part of the run, with a part of the budget.
#[test]
fn the_spec_of_the_page_on_gains_is_feasible() {
    const GAINS: &str = include_str!("../../../../docs/tuning.md");
    if is_out_of_reach() {
        return;
    }
    let place = Place::new();
    place.write("ur5.urdf", urdf("ur5"));
    place.run(&["import", "ur5.urdf", "--assume", "harmonic-drive", "--scenario"]).done();
    let mut blocks = GAINS.split("\n```").skip(1).step_by(2);
    let spec = blocks.find_map(|block| block.strip_prefix("toml\n# spec.toml")).expect("a SPEC");
    place.write("spec.toml", spec.split_once('\n').expect("lines").1);
    let command = GAINS.lines().find(|line| line.contains("--spec spec.toml")).expect("a command");
    let mut arguments: Vec<&str> = command.split_whitespace().skip(1).collect();
    arguments.extend(["--budget", "4", "--set", "duration=3.0"]);
    let found = place.run(&arguments).done().stdout;
    assert!(found.contains("wrote fast.toml"), "{found}");
}
