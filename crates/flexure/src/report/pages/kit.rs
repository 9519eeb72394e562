//! What every page is made of: the result in a sentence, the picture that shows it, then detail, folded where it is long.

use maud::{DOCTYPE, Markup, PreEscaped, html as markup};

use crate::report::tables::grid::Grid;

/// The result in a sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Verdict {
    /// Whether it is good; none where that was not decided, or is not for the program to say.
    pub good: Option<bool>,
    /// The result, in numbers.
    pub words: String,
}

/// A part of a page.
pub(crate) struct Section {
    /// Its place in the address.
    pub id: &'static str,
    pub heading: &'static str,
    pub body: Markup,
    /// Whether it is shown only when it is asked for, and on paper.
    pub folded: bool,
}

impl Section {
    pub(crate) fn new(id: &'static str, heading: &'static str, body: Markup) -> Self {
        Self { id, heading, body, folded: false }
    }

    pub(crate) fn folded(self) -> Self {
        Self { folded: true, ..self }
    }
}

/// A whole page.
pub(crate) struct Page<'a> {
    pub title: &'a str,
    pub verdict: Option<&'a Verdict>,
    /// What stands under the verdict: the picture that shows it.
    pub lead: Markup,
    pub sections: Vec<Section>,
    /// How the page was made.
    pub provenance: Markup,
}

impl Page<'_> {
    /// As HTML, which needs nothing else.
    pub(crate) fn html(&self) -> String {
        markup! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    title { (self.title) }
                    style { (PreEscaped(include_str!("report.css"))) }
                }
                body { main {
                    header {
                        h1 { (self.title) }
                        @if let Some(verdict) = self.verdict { (said(verdict)) }
                    }
                    (self.lead)
                    nav aria-label="Contents" {
                        @for section in &self.sections { a href={ "#" (section.id) } { (section.heading) } }
                    }
                    @for section in &self.sections { (part(section)) }
                    footer { h2 { "How this page was made" } (self.provenance) }
                } }
            }
        }
        .into_string()
    }
}

fn said(Verdict { good, words }: &Verdict) -> Markup {
    let (class, mark) = match good {
        Some(true) => ("verdict good", "✓ good"),
        Some(false) => ("verdict bad", "✕ bad"),
        None => ("verdict open", "– no verdict"),
    };
    markup! { p class=(class) { strong { (mark) } " " (words) } }
}

fn part(Section { id, heading, body, folded }: &Section) -> Markup {
    markup! {
        @if *folded {
            section.folded id=(id) { details { summary { h2 { (heading) } } (body) } }
        } @else {
            section id=(id) { h2 { (heading) } (body) }
        }
    }
}

/// A figure in its frame, with what it shows.
pub(crate) fn figure(svg: &str, caption: &Markup) -> Markup {
    markup! { figure { div.card { (PreEscaped(svg)) } figcaption { (caption) } } }
}

/// A table of numbers.
pub(crate) fn numbers(grid: &Grid) -> Markup {
    markup! {
        div.scroll { table.numbers {
            thead { tr { @for (column, heading) in grid.headings.iter().enumerate() {
                th.word[(1..grid.words).contains(&column)] { (heading.replace('\n', " ")) }
            } } }
            tbody { @for row in &grid.rows { tr {
                @for (column, text) in row.iter().enumerate() {
                    @if column == 0 { th scope="row" { (text) } } @else if column < grid.words { td.word { (text) } } @else { td { (text) } }
                }
            } } }
        } }
    }
}

/// How a page was made: the version of the program, and more in sentences.
pub(crate) fn made(sentences: &[String]) -> Markup {
    markup! { ul {
        li { "flexure " (env!("CARGO_PKG_VERSION")) }
        @for sentence in sentences { li { (sentence) } }
    } }
}
