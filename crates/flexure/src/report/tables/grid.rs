//! A table as data: what the terminal prints and what a page shows.

use comfy_table::Cell;

use super::columns::laid_out;
use super::summary::{headed, right};

/// Words on the left, numbers to the right of them.
pub(crate) struct Grid {
    /// Over each column; their lines are those of the terminal.
    pub headings: Vec<String>,
    /// Leading columns that are words.
    pub words: usize,
    /// A text a column each.
    pub rows: Vec<Vec<String>>,
}

impl Grid {
    /// Of rows with one word in front.
    pub(crate) fn new(headings: &[&str], rows: Vec<Vec<String>>) -> Self {
        Self { headings: headings.iter().map(|&heading| heading.to_owned()).collect(), words: 1, rows }
    }

    /// For the terminal, in so many columns.
    pub(crate) fn text(&self, width: usize) -> String {
        let mut table = headed(self.headings.iter().map(String::as_str));
        for row in &self.rows {
            let cell = |(column, text): (usize, &String)| {
                if column < self.words { Cell::new(text) } else { right(text.clone()) }
            };
            table.add_row(row.iter().enumerate().map(cell).collect::<Vec<_>>());
        }
        laid_out(&table, self.words, width)
    }
}
