//! Robot and scenario files with cuts, flipped bits and stray tokens: accepted or refused at a place, never a panic.

use std::path::Path;

use flexure::files::{ROBOTS, SCENARIOS};
use flexure::robot::robot_from_text;
use flexure::scenario::scenario_from_text;

use crate::common::Random;

impl Random {
    /// `text` after a few cuts, flipped bits and stray tokens.
    fn mangled(&mut self, text: &str) -> String {
        const TOKENS: [&str; 12] =
            ["-", "nan", "[", "]", "=", "\"", "\n", "1e308", "é", "[[links.joint]]\n", "'''", "."];
        let mut bytes = text.as_bytes().to_vec();
        for _ in 0..=self.below(3) {
            let at = self.below(bytes.len());
            match self.below(10) {
                0 => bytes.truncate(at),
                1..=5 if !bytes.is_empty() => bytes[at] ^= 1 << self.below(7),
                6 | 7 => drop(bytes.splice(at..at, TOKENS[self.below(TOKENS.len())].bytes())),
                _ => drop(bytes.drain(at..(at + 1 + self.below(40)).min(bytes.len()))),
            }
        }
        String::from_utf8_lossy(&bytes).into_owned()
    }
}

#[test]
fn mangled_files_never_panic() {
    let mut noise = Random(7);
    let (mut accepted, mut refused) = (0, 0);
    for (_, text) in ROBOTS.iter().chain(SCENARIOS) {
        for _ in 0..150 {
            let mangled = noise.mangled(text);
            let robot = robot_from_text("m.toml", &mangled, ".".as_ref()).map(drop);
            for result in [robot, scenario_from_text("m.toml", &mangled, Path::new("")).map(drop)] {
                let Err(problems) = result else {
                    accepted += 1;
                    continue;
                };
                refused += 1;
                assert!(!problems.to_string().is_empty());
                assert!(problems.iter().all(|problem| problem.line_column().is_some()), "{problems}");
            }
        }
    }
    assert!(accepted > 100 && refused > 1000, "{accepted} accepted, {refused} refused");
}
