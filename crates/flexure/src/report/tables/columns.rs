//! Tables in the width that there is: columns that do not fit go below, beside the first ones once more.

use comfy_table::{Cell, Table};

use super::summary::headed;

/// Columns of a terminal that tables are laid out for where nobody says how many there are.
pub const WIDTH: usize = 100;

/// A name may always take so many columns.
const NAME: usize = 16;

/// What stands between two columns.
const GAP: usize = 2;

/// `table` in lines of at most `width` columns, as long as the widest column beside the first `keys` ones fits. If it is
/// wider, names in the first columns take half of the width at most, and the other columns go below each other in blocks.
pub(crate) fn laid_out(table: &Table, keys: usize, width: usize) -> String {
    let mut widths: Vec<usize> = table.column_max_content_widths().into_iter().map(usize::from).collect();
    // No gap before the first column, but a blank.
    let fits =
        |widths: &mut dyn Iterator<Item = &usize>| widths.map(|wide| wide + GAP).sum::<usize>() <= width + 1;
    if fits(&mut widths.iter()) {
        return table.to_string();
    }
    let name = (width / 2 / keys.max(1)).max(NAME);
    widths.iter_mut().take(keys).for_each(|wide| *wide = (*wide).min(name));
    let mut blocks: Vec<Vec<usize>> = Vec::new();
    for column in keys..widths.len() {
        let with = |block: &Vec<usize>| block.iter().copied().chain([column]).collect::<Vec<_>>();
        match blocks.last_mut() {
            Some(block) if fits(&mut with(block).iter().map(|&i| &widths[i])) => block.push(column),
            _ => blocks.push((0..keys).chain([column]).collect()),
        }
    }
    let rows: Vec<Vec<&Cell>> = table.row_iter().map(|row| row.cell_iter().collect()).collect();
    let titles: Vec<String> =
        table.header().into_iter().flat_map(|row| row.cell_iter().map(Cell::content)).collect();
    let block = |columns: &Vec<usize>| {
        let mut part = headed(columns.iter().map(|&column| titles[column].as_str()));
        for row in &rows {
            let cell = |&column: &usize| {
                let text = row[column].content();
                let is_long = column < keys && text.lines().any(|line| line.chars().count() > name);
                if is_long { Cell::new(folded(&text, name)) } else { row[column].clone() }
            };
            part.add_row(columns.iter().map(cell).collect::<Vec<_>>());
        }
        part.to_string()
    };
    blocks.iter().map(block).collect::<Vec<_>>().join("\n")
}

/// Lines of at most `width` characters: a longer one goes on after a `_`, `-`, `.` or blank that is not inside a number, and inside of
/// what has none of them in so many characters.
fn folded(text: &str, width: usize) -> String {
    let ends = |pair: &[char]| match pair {
        ['.' | '-', next] => !next.is_ascii_digit(),
        [last, _] => matches!(last, '_' | ' '),
        _ => false,
    };
    let fold = |line: &str| {
        let (mut lines, mut length) = (String::new(), 0);
        let characters: Vec<char> = line.chars().collect();
        let mut begin = 0;
        let cuts = characters.windows(2).enumerate().filter(|(_, pair)| ends(pair)).map(|(i, _)| i + 1);
        for cut in cuts.chain([characters.len()]) {
            let part = &characters[begin..cut];
            begin = cut;
            for piece in part.chunks(width.max(1)) {
                if length > 0 && length + piece.len() > width {
                    lines.push('\n');
                    length = 0;
                }
                lines.extend(piece);
                length += piece.len();
            }
        }
        lines
    };
    text.lines().map(fold).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use comfy_table::Cell;

    use super::{folded, laid_out};
    use crate::report::tables::summary::{headed, right};

    #[test]
    fn names_are_folded_between_words() {
        assert_eq!(folded("left_inner_finger_joint", 12), "left_inner_\nfinger_joint");
        assert_eq!(folded("short\nleft_inner_finger_joint", 12), "short\nleft_inner_\nfinger_joint");
        assert_eq!(folded("aaaaaaaaaa", 4), "aaaa\naaaa\naa");
        assert_eq!(folded("", 4), "");
        assert_eq!(folded("leaves 0.007598 rad of joint-a", 9), "leaves \n0.007598 \nrad of \njoint-a");
        assert_eq!(folded("below 1e-12 J", 8), "below \n1e-12 J");
    }

    /// Every number is there at every width, no line is wider, and every name is whole or folded between words.
    #[test]
    fn columns_that_do_not_fit_go_below() {
        let titles: Vec<String> = (0..9).map(|column| format!("title\n[{column}]")).collect();
        let mut table = headed(std::iter::once("joint").chain(titles.iter().map(String::as_str)));
        for row in 0..3 {
            let numbers = (0..9).map(|column| right(format!("{row}.{column}0000")));
            let name = Cell::new(format!("shoulder_pan_joint_{row}"));
            table.add_row(std::iter::once(name).chain(numbers).collect::<Vec<_>>());
        }
        let whole = laid_out(&table, 1, 102);
        assert_eq!(whole, table.to_string(), "as it is where it fits");
        for width in [40, 41, 60, 80, 101] {
            let text = laid_out(&table, 1, width);
            let widest = text.lines().map(|line| line.chars().count()).max();
            assert!(widest.is_some_and(|widest| widest <= width), "{width}:\n{text}");
            let words: Vec<&str> = text.split_whitespace().collect();
            for row in 0..3 {
                for column in 0..9 {
                    assert!(words.contains(&format!("{row}.{column}0000").as_str()), "{width}:\n{text}");
                }
                let folded =
                    ["shoulder_pan_", &format!("joint_{row}")].iter().all(|part| words.contains(part));
                assert!(folded || words.contains(&format!("shoulder_pan_joint_{row}").as_str()), "{text}");
            }
        }
    }
}
