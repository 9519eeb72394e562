//! The pages of `docs/` that reports carry.

use pulldown_cmark::{Options, Parser, html::push_html};

/// `docs/errata.md`: the slips of the paper and what the software does instead.
pub(super) const ERRATA: &str = include_str!("../../../../docs/errata.md");

/// Markdown with tables as HTML, without its top heading: the report has its own.
pub(super) fn body(markdown: &str) -> String {
    let body = match markdown.split_once('\n') {
        Some((heading, rest)) if heading.starts_with("# ") => rest,
        _ => markdown,
    };
    let mut html = String::new();
    push_html(&mut html, Parser::new_ext(body, Options::ENABLE_TABLES));
    html
}

#[cfg(test)]
mod tests {
    use super::{ERRATA, body};

    #[test]
    fn the_errata_table_has_every_slip() {
        let html = body(ERRATA);
        let document = format!("<div>{html}</div>");
        let document = roxmltree::Document::parse(&document).unwrap();
        let rows: Vec<_> = document.descendants().filter(|node| node.has_tag_name("tr")).collect();
        let cells = |row: &roxmltree::Node| row.children().filter(roxmltree::Node::is_element).count();
        assert!(rows.iter().all(|row| cells(row) == 6));
        let numbers: Vec<_> = rows[1..].iter().filter_map(|row| row.first_element_child()?.text()).collect();
        assert_eq!(numbers, (1..=17).map(|n| n.to_string()).collect::<Vec<_>>());
    }
}
