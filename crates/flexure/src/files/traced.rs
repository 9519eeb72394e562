//! A text that was put together from several files, and where each of its values comes from.

use std::ops::Range;

use toml::de::DeTable;

use crate::files::document::Places;
use crate::files::source::{Part, Source};

/// `text` called `name`; problems with a key are placed where `origin` says that it comes from.
pub(crate) fn traced(
    name: &str,
    text: &str,
    origin: impl Fn(&str) -> Option<(Source, Range<usize>)>,
) -> Source {
    let source = Source::new(name, text);
    let (root, _) = DeTable::parse_recoverable(text);
    let places = Places::of(&source, root.get_ref());
    let mut values: Vec<(usize, (Source, usize))> = Vec::new();
    for (key, span) in places.spans() {
        values.extend(origin(key).map(|(source, at)| (span.start, (source, at.start))));
    }
    values.sort_by_key(|(start, _)| *start);
    let mut before = 0;
    let part = |(value, (source, at)): (usize, (Source, usize))| {
        // What stands before the first value of a line is about it.
        let line = text[..value].rfind('\n').map_or(0, |newline| newline + 1);
        let start = if before <= line { line } else { value };
        before = value + 1;
        let at = at.saturating_sub(value - start);
        Part { start, source, at }
    };
    let parts = values.into_iter().map(part).collect();
    source.of_parts(parts)
}
