//! How much a TOML file may hold, counted token by token before anything is built of it.
//!
//! Values take a hundred times the memory of their text, and every key is kept with the keys that it is in: without bounds a
//! file of 16 MiB took a gigabyte, and one of nothing but slips took minutes. A robot of sixteen joints has 300 keys.

use std::ops::Range;

use toml_parser::Source;
use toml_parser::lexer::TokenKind;

/// Largest file \[bytes\].
pub(crate) const LIMIT: u64 = 1 << 20;

/// Keys, tables and arrays.
const MOST_KEYS: usize = 5_000;

/// Lines and entries of arrays.
const MOST_ENTRIES: usize = 100_000;

/// Keys joined by dots, brackets in brackets.
const DEEPEST: usize = 8;

/// Longest key \[bytes\].
const LONGEST_KEY: usize = 256;

/// Where there is too much in `text`, and of what.
pub(crate) fn objection(text: &str) -> Option<(Range<usize>, String)> {
    let (mut keys, mut entries, mut brackets, mut dots) = (0, 0, 0_usize, 0);
    let mut word = 0;
    for token in Source::new(text).lex() {
        let kind = token.kind();
        match kind {
            TokenKind::Equals => keys += 1,
            TokenKind::Dot => dots += 1,
            TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket => {
                (keys, brackets) = (keys + 1, brackets + 1);
            }
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket => {
                brackets = brackets.saturating_sub(1);
            }
            TokenKind::Comma | TokenKind::Newline => entries += 1,
            _ => {}
        }
        let span = token.span().start()..token.span().end();
        let ends_key = matches!(kind, TokenKind::Equals | TokenKind::Dot | TokenKind::RightSquareBracket);
        let objection = if keys > MOST_KEYS {
            format!("more than {MOST_KEYS} keys, tables and arrays")
        } else if entries > MOST_ENTRIES {
            format!("more than {MOST_ENTRIES} lines and entries of arrays")
        } else if brackets > DEEPEST || dots > DEEPEST {
            format!("keys, arrays or tables nested more than {DEEPEST} deep")
        } else if ends_key && word > LONGEST_KEY {
            format!("a key is {word} bytes long, must be at most {LONGEST_KEY}")
        } else {
            match kind {
                TokenKind::Whitespace | TokenKind::Dot => {}
                TokenKind::Atom | TokenKind::BasicString | TokenKind::LiteralString => word = span.len(),
                _ => (word, dots) = (0, 0),
            }
            // What is open at the end of a line may be an array, or a slip that the parser names better.
            continue;
        };
        return Some((span, objection));
    }
    None
}

#[cfg(test)]
mod tests {
    use super::objection;

    #[test]
    fn what_is_too_much() {
        let refused = |text: &str, said: &str| {
            let (span, objection) = objection(text).unwrap_or_else(|| panic!("accepted: {said}"));
            assert!(objection.contains(said), "{objection}");
            assert!(text.get(span).is_some_and(|part| !part.is_empty()));
        };
        refused(&"k = 1\n".repeat(5001), "more than 5000 keys");
        refused(&"[[a]]\n".repeat(2501), "more than 5000 keys");
        refused(&format!("a = [{}]", "1,".repeat(100_001)), "more than 100000 lines and entries");
        refused(&"\n".repeat(100_001), "more than 100000 lines and entries");
        refused(&format!("a{} = 1", ".a".repeat(9)), "nested more than 8 deep");
        refused(&format!("[{}a]", "a . ".repeat(9)), "nested more than 8 deep");
        refused(&format!("a = {}", "[".repeat(9)), "nested more than 8 deep");
        refused(&format!("{}1", "a = {".repeat(9)), "nested more than 8 deep");
        for long in [format!("{} = 1", "a".repeat(257)), format!("[b.\"{}\"]", "a".repeat(257))] {
            refused(&long, "a key is 25");
        }
    }

    #[test]
    fn what_is_not() {
        for text in [
            format!("{} = '{}'\n", "a".repeat(256), "x.[={,".repeat(10_000)),
            format!("# {}\na = \"\"\"{}\"\"\"", "[.".repeat(1000), "[.\n".repeat(1000)),
            format!("a{} = [{}]\n", ".a".repeat(8), "0.5, ".repeat(10_000)),
            "[a.b.c]\nd.e = {f = [[1]]}\n".repeat(500),
            "]]]]\n".into(),
        ] {
            assert_eq!(objection(&text), None, "{text:.50}");
        }
    }
}
