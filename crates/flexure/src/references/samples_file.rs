//! A reference given by samples: a CSV file with the header `t,q1,…,qn`.

use std::ops::Range;

use crate::files::Problems;
use crate::files::base::Base;
use crate::files::document::Log;
use crate::files::field::{Field, Joints};
use crate::files::normal::Normal;
use crate::files::quantity::{self, Quantity};
use crate::files::source::Source;
use crate::files::suggest;
use crate::files::table::Table;

/// Largest file that is read \[bytes\].
const LIMIT: u64 = 16 << 20;

/// Fewer samples leave nothing to interpolate between with four derivatives.
const FEWEST: usize = 8;

/// The times in s and the positions in rad of the samples for a run of `end` seconds.
pub(crate) fn read(
    table: &Table<'_>,
    joints: &Joints,
    base: &Base,
    end: f64,
) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
    let field =
        table.required("file", "path of a CSV file, relative to the scenario, with the header t,q1,q2,…")?;
    let path = field.text()?;
    let source = match base.read(path, LIMIT) {
        Ok(source) => source,
        Err(problem) => {
            field.log.push(problem.or_at(&field.log.source, field.span.clone()));
            return None;
        }
    };
    let log = Log::new(&source);
    let rows = parse(&log, joints);
    let rows = field.log.absorb(log.finish(rows))?;
    check_span(&field, &rows, end)?;
    field.log.contain(&field.path, normal(&rows));
    Some(rows.into_iter().unzip())
}

/// The times in s and the positions in rad of the samples in `text`, a CSV file with the header `t,q1,…,qn` for as many
/// `joints`; `name` stands for the file in messages.
///
/// # Errors
/// With what is wrong.
pub fn samples_from_text(
    name: &str,
    text: &str,
    joints: usize,
) -> Result<(Vec<f64>, Vec<Vec<f64>>), Problems> {
    let log = Log::new(&Source::new(name, text));
    let rows = parse(&log, &Joints { count: Some(joints), robot: "the robot".to_owned() });
    let (rows, _) = log.finish(rows)?;
    Ok(rows.into_iter().unzip())
}

/// The rows, each a list that begins with the time.
fn normal(rows: &[Row]) -> Normal {
    let row = |(t, q): &Row| std::iter::once(t).chain(q).copied().map(Normal::number).collect();
    Normal::List(rows.iter().map(|entry| Normal::List(row(entry))).collect())
}

/// One sample: its time and the positions.
type Row = (f64, Vec<f64>);

/// Notes an error if the run leaves the samples.
fn check_span(field: &Field<'_>, rows: &[Row], end: f64) -> Option<()> {
    let ((first, _), (last, _)) = (rows.first()?, rows.last()?);
    let message = if *first > 0.0 {
        format!("{} begins at t = {first} s, must be at or before 0", field.path)
    } else if *last < end {
        format!("{} ends at t = {last} s, before the run does at {end} s", field.path)
    } else {
        return Some(());
    };
    field.error("samples", message, "the samples must cover the run from t = 0 to `duration`");
    None
}

fn parse(log: &Log, joints: &Joints) -> Option<Vec<Row>> {
    let mut lines = lines(&log.source).filter(|(_, line)| !line.trim().is_empty());
    let (start, header) = lines.next().unwrap_or((0, ""));
    let columns = header.split(',').count();
    let joint_columns = 1..=joints.count.unwrap_or(columns.saturating_sub(1));
    let expected: Vec<String> =
        std::iter::once("t".into()).chain(joint_columns.map(|i| format!("q{i}"))).collect();
    if !header.split(',').map(str::trim).eq(expected.iter().map(String::as_str)) {
        let message = format!("the header is {}, must be {}", suggest::quoted(header), expected.join(","));
        log.error(
            start..start + header.len(),
            "header",
            message,
            format!("t in s, then positions in rad: {}", joints.expected()),
        );
        return None;
    }
    let mut rows: Vec<Row> = Vec::new();
    for (start, line) in lines {
        let numbers = row(log, start, line, columns)?;
        let (&t, q) = numbers.split_first()?;
        if let Some((before, _)) = rows.last().filter(|(before, _)| *before >= t) {
            let message = format!("t is {t} s, must be > {before} s, the time of the row before");
            log.error(start..start + line.len(), "order", message, "times increase strictly");
            return None;
        }
        rows.push((t, q.to_vec()));
    }
    if rows.len() < FEWEST {
        let message = format!("{} rows of samples, must be at least {FEWEST}", rows.len());
        log.error(0..header.len(), "length", message, "more samples, or a reference of another kind");
        return None;
    }
    Some(rows)
}

/// The numbers of one line.
fn row(log: &Log, start: usize, line: &str, columns: usize) -> Option<Vec<f64>> {
    let cells: Vec<(usize, &str)> = cells(line).collect();
    if cells.len() != columns {
        let message = format!("{} numbers in this row, must be {columns} as in the header", cells.len());
        log.error(start..start + line.len(), "length", message, "columns are separated by commas");
        return None;
    }
    let number = |(i, (offset, cell)): (usize, (usize, &str))| {
        let (name, quantity) =
            if i == 0 { ("t".into(), &quantity::TIME) } else { (format!("q{i}"), &quantity::ANGLE) };
        let blank = cell.len() - cell.trim_start().len();
        let from = start + offset + blank;
        checked(log, from..from + cell.trim().len(), &name, cell.trim(), quantity)
    };
    cells.into_iter().enumerate().map(number).collect()
}

fn checked(log: &Log, span: Range<usize>, name: &str, cell: &str, quantity: &Quantity) -> Option<f64> {
    let Ok(x) = cell.parse::<f64>() else {
        let message = format!("{name} is {}, must be a number", suggest::quoted(cell));
        log.error(
            span,
            "number",
            message,
            format!("{}; numbers like 0.5 or 1e-3, with a point", quantity.described()),
        );
        return None;
    };
    log.accept(name, x, quantity, span)
}

/// The lines with the byte that each begins at.
fn lines(source: &Source) -> impl Iterator<Item = (usize, &str)> {
    let text: &str = &source.text;
    let text_start = text.as_ptr().addr();
    text.lines().map(move |line| (line.as_ptr().addr() - text_start, line))
}

/// The cells of a line with the byte in it that each begins at.
fn cells(line: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut next = 0;
    line.split(',').map(move |cell| {
        let start = next;
        next += cell.len() + 1;
        (start, cell)
    })
}
