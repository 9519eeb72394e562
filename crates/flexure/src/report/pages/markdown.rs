//! The page of `docs/` that reports carry, and symbols of the paper in HTML.

/// `docs/errata.md` as HTML, the slips of the paper and what the software does instead, rendered by a test below.
pub(crate) const ERRATA: &str = include_str!("errata.html");

/// Text as HTML with its subscripts lowered: letters and digits after an underscore that follows a symbol.
pub(crate) fn subscripts(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('_') {
        let length = after.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(after.len());
        let (subscript, remaining) = after.split_at(length);
        html.push_str(&escaped(before));
        if before.ends_with(char::is_whitespace) || before.is_empty() || subscript.is_empty() {
            html.push('_');
            rest = after;
        } else {
            html.extend(["<sub>", subscript, "</sub>"]);
            rest = remaining;
        }
    }
    html + &escaped(rest)
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use pulldown_cmark::{CowStr, Event, Options, Parser, TextMergeStream, html::push_html};

    use super::{ERRATA, escaped, subscripts};

    /// Markdown with tables as HTML, without its top heading: the report has its own. Subscripts (`q_l`) are lowered, and
    /// labels in code spans may break after their punctuation.
    fn body(markdown: &str) -> String {
        let body = match markdown.split_once('\n') {
            Some((heading, rest)) if heading.starts_with("# ") => rest,
            _ => markdown,
        };
        let mut html = String::new();
        let events =
            TextMergeStream::new(Parser::new_ext(body, Options::ENABLE_TABLES)).map(|event| match event {
                Event::Text(text) => Event::InlineHtml(CowStr::from(subscripts(&text))),
                Event::Code(code) => {
                    Event::InlineHtml(CowStr::from(format!("<code>{}</code>", breakable(&code))))
                }
                other => other,
            });
        push_html(&mut html, events);
        html
    }

    fn breakable(code: &str) -> String {
        let mut html = String::with_capacity(code.len());
        for piece in code.split_inclusive(['_', '-']) {
            html.extend([&escaped(piece), "<wbr/>"]);
        }
        html.replace("::", "::<wbr/>")
    }

    #[test]
    fn subscripts_are_lowered_and_text_is_escaped() {
        assert_eq!(subscripts("M_l⁻¹ < q̃_mr"), "M<sub>l</sub>⁻¹ &lt; q̃<sub>mr</sub>");
        assert_eq!(subscripts("_a λ_(k) <b>_1"), "_a λ_(k) &lt;b&gt;<sub>1</sub>");
    }

    /// `FLEXURE_WRITE=1 cargo test --release -p flexure --lib errata` writes the file anew.
    #[test]
    fn the_errata_of_reports_are_those_of_the_docs() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let markdown = std::fs::read_to_string(folder.join("../../docs/errata.md")).unwrap();
        let path = folder.join("src/report/pages/errata.html");
        let rendered = body(&markdown);
        if std::env::var_os("FLEXURE_WRITE").is_some() {
            std::fs::write(&path, &rendered).unwrap();
        }
        let committed = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(committed == rendered, "{} is out of date: FLEXURE_WRITE=1 writes it anew", path.display());
    }

    #[test]
    fn the_errata_table_has_every_slip() {
        let document = format!("<div>{ERRATA}</div>");
        let document = roxmltree::Document::parse(&document).unwrap();
        let rows: Vec<_> = document.descendants().filter(|node| node.has_tag_name("tr")).collect();
        let cells = |row: &roxmltree::Node| row.children().filter(roxmltree::Node::is_element).count();
        assert!(rows.iter().all(|row| cells(row) == 6));
        let numbers: Vec<_> = rows[1..].iter().filter_map(|row| row.first_element_child()?.text()).collect();
        assert_eq!(numbers, (1..=17).map(|n| n.to_string()).collect::<Vec<_>>());
    }
}
