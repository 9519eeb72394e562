//! From a CSV file to a log, a line at a time.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::ops::Range;
use std::path::Path;

use crate::files::{Problem, Problems, source, suggest};
use crate::logs::channel::Channel;
use crate::logs::clock::Times;
use crate::logs::columns::{Columns, Signal, Time, expanded};
use crate::logs::lines::{Line, Lines};
use crate::logs::log::Log;
use crate::logs::plausible;
use crate::robot::Robot;

/// Fewest samples of a log.
pub const FEWEST: usize = 100;

/// Most numbers that are kept of a log.
const MOST_NUMBERS: usize = 100_000_000;

/// Reads the log at `path` of `robot`: a CSV file with a line of column names, which `columns` says what they are. Columns are
/// separated by commas, semicolons or tabs. The warnings are about numbers that are allowed but hardly meant.
///
/// # Errors
/// With the first thing that is wrong with it: it cannot be read, lacks columns, has rows of different lengths, cells that are no
/// numbers, times that run back, gaps, uneven times, fewer than [`FEWEST`] samples, or numbers that the robot cannot do.
pub fn read_log(path: &Path, columns: &Columns, robot: &Robot) -> Result<(Log, Vec<Problem>), Problems> {
    let file = File::open(path).map_err(|error| source::unreadable(path, &error))?;
    if file.metadata().is_ok_and(|file| file.is_dir()) {
        return Err(source::unreadable(path, &std::io::ErrorKind::IsADirectory.into()).into());
    }
    let log = read(BufReader::new(file), &path.display().to_string(), columns, robot)?;
    let warnings = plausible::check(&log, robot)?;
    Ok((log, warnings))
}

/// Reads a log called `name`.
fn read(reader: impl BufRead, name: &str, columns: &Columns, robot: &Robot) -> Result<Log, Problem> {
    let mut lines = Lines::new(reader, name);
    let empty = || {
        Problem::new(
            "empty",
            format!("{name} is empty"),
            "a log has a line of column names, then rows of numbers",
        )
    };
    let (separator, mut layout) = {
        let header = lines.next()?.ok_or_else(empty)?;
        let separator = header.separator();
        (separator, Layout::new(&header, separator, columns, robot)?)
    };
    let mut times = Times::default();
    let mut signals: [Vec<f64>; 5] = Default::default();
    while let Some(line) = lines.next()? {
        let cells: Vec<_> = line.cells(separator).collect();
        layout.row(&line, &cells, &mut times, &mut signals)?;
    }
    finish(name, &layout, &times, signals, robot.joint_count())
}

/// The log of what was read.
fn finish(
    name: &str,
    layout: &Layout,
    times: &Times,
    signals: [Vec<f64>; 5],
    joints: usize,
) -> Result<Log, Problem> {
    if times.len() < FEWEST {
        let message = format!("{name} has {} samples, must be at least {FEWEST}", times.len());
        return Err(Problem::new("length", message, "a longer log; a second at 1 kHz has 1000"));
    }
    let period = times.even(name, layout.time.scale, layout.time.unit)?;
    let mut signals =
        signals.into_iter().zip(&layout.signals).map(|(values, there)| there.as_ref().map(|_| values));
    let mut next = || signals.next().flatten();
    let [q_l, q_m, dq_l, dq_m] = std::array::from_fn(|_| next());
    Ok(Log { name: name.to_owned(), period, joints, q_l, q_m, dq_l, dq_m, u_m: next().unwrap_or_default() })
}

/// Where everything stands in a row.
struct Layout {
    /// Names of all columns.
    names: Vec<String>,
    time: Time,
    /// The column of the time.
    time_at: usize,
    /// Of each channel that is there, index and scale of the column of each joint.
    signals: [Option<Vec<(usize, f64)>>; 5],
    /// Whether channels without a number in the first row are not there.
    lenient: bool,
}

impl Layout {
    fn new(header: &Line<'_>, separator: char, columns: &Columns, robot: &Robot) -> Result<Self, Problem> {
        let names: Vec<String> = header.cells(separator).map(|(_, name)| name.to_owned()).collect();
        if names.iter().all(|name| name.parse::<f64>().is_ok()) {
            let help = "the first line has the names of the columns";
            return Err(header.whole("header", "the first line has no names but numbers", help));
        }
        let find = |name: &str| find(header, separator, name);
        let joints = robot.joint_count();
        let time = columns.time.clone().unwrap_or(Time { column: "t".to_owned(), scale: 1.0, unit: false });
        let time_at = find(&time.column)?.ok_or_else(|| missing(header, &names, "the time", &time.column))?;
        let signal = |channel: Channel, said: &Option<Signal>| match said {
            Some(Signal { columns, scale }) => {
                located(header, &names, &find, channel, columns, scale).map(Some)
            }
            None if columns == &Columns::default() => in_trace(header, &names, &find, channel, joints),
            None => Ok(None),
        };
        let mut signals: [Option<Vec<(usize, f64)>>; 5] = Default::default();
        for ((slot, channel), said) in signals.iter_mut().zip(Channel::ALL).zip(&columns.channels) {
            *slot = signal(channel, said)?;
        }
        if signals[..2].iter().all(Option::is_none) {
            return Err(missing(header, &names, "positions of links or motors", "q_m1"));
        }
        Ok(Self { names, time, time_at, signals, lenient: columns == &Columns::default() })
    }

    /// Takes a row in.
    fn row(
        &mut self,
        line: &Line<'_>,
        cells: &[(Range<usize>, &str)],
        times: &mut Times,
        signals: &mut [Vec<f64>; 5],
    ) -> Result<(), Problem> {
        if cells.len() != self.names.len() {
            let message =
                format!("{} cells in this row, must be {} as in the header", cells.len(), self.names.len());
            return Err(line.whole("length", message, "is the file cut off here?"));
        }
        let number = |column: usize| {
            let (span, cell) = &cells[column];
            line.number(span.clone(), &self.names[column], cell)
        };
        let (span, cell) = &cells[self.time_at];
        if let Err(step) = times.push(cell, number(self.time_at)?, line.number) {
            let what = if step == 0.0 { "is that of the row before" } else { "runs back" };
            let message = format!("the time {} {what}, must grow from row to row", suggest::quoted(cell));
            let help =
                "one row per sample, in their order; are times rounded too far, or two logs in one file?";
            return Err(line.problem(span.clone(), "order", message, help));
        }
        if times.len() == 1 && self.lenient {
            let is_nan = |&(column, _): &(usize, f64)| cells[column].1.parse().is_ok_and(f64::is_nan);
            // What a trace has no numbers of was not measured. Nothing can be done without torques.
            for (there, channel) in self.signals.iter_mut().zip(Channel::ALL) {
                let is_kept =
                    |columns: &Vec<_>| channel == Channel::MotorTorque || !columns.iter().all(is_nan);
                *there = there.take().filter(is_kept);
            }
            if self.signals[..2].iter().all(Option::is_none) {
                let message = "no positions of links or motors: all are nan in the first row";
                return Err(line.whole(
                    "number",
                    message,
                    "cut off what was logged before the encoders spoke",
                ));
            }
        }
        for (values, columns) in signals.iter_mut().zip(&self.signals) {
            for &(column, scale) in columns.iter().flatten() {
                values.push(scale * number(column)?);
            }
        }
        let kept: usize = signals.iter().map(Vec::len).sum();
        if kept > MOST_NUMBERS {
            let message = format!("more than {MOST_NUMBERS} numbers up to this row");
            return Err(line.whole("huge", message, "a log of a minute will do: cut it"));
        }
        Ok(())
    }
}

/// The index of the column `name`, if there is one.
fn find(header: &Line<'_>, separator: char, name: &str) -> Result<Option<usize>, Problem> {
    let mut found = header.cells(separator).enumerate().filter(|(_, (_, cell))| *cell == name);
    let (first, again) = (found.next(), found.next());
    match again {
        Some((_, (span, _))) => {
            let message = format!("there are two columns {}", suggest::quoted(name));
            Err(header.problem(span, "header", message, "columns have names of their own"))
        }
        None => Ok(first.map(|(index, _)| index)),
    }
}

type Find<'a> = dyn Fn(&str) -> Result<Option<usize>, Problem> + 'a;

/// The columns of a channel that a map of columns names.
fn located(
    header: &Line<'_>,
    names: &[String],
    find: &Find<'_>,
    channel: Channel,
    columns: &[String],
    scale: &[f64],
) -> Result<Vec<(usize, f64)>, Problem> {
    let place = |(name, scale): (&String, &f64)| {
        let index = find(name)?.ok_or_else(|| missing(header, names, channel.key(), name))?;
        Ok((index, *scale))
    };
    columns.iter().zip(scale).map(place).collect()
}

/// The columns of a channel in a trace of Flexure, if there are any.
fn in_trace(
    header: &Line<'_>,
    names: &[String],
    find: &Find<'_>,
    channel: Channel,
    joints: usize,
) -> Result<Option<Vec<(usize, f64)>>, Problem> {
    for pattern in channel.in_traces() {
        let columns = expanded(pattern, joints);
        if find(&columns[0])?.is_some() {
            if find(&pattern.replace("{}", &(joints + 1).to_string()))?.is_some() {
                let message = format!(
                    "there are columns {} for more than the {joints} joints of the robot",
                    pattern.replace("{}", "1, …")
                );
                return Err(header.whole("header", message, "is it a log of this robot?"));
            }
            return located(header, names, find, channel, &columns, &vec![1.0; joints]).map(Some);
        }
    }
    if channel == Channel::MotorTorque {
        return Err(missing(header, names, "the motor torques", "u_m1"));
    }
    Ok(None)
}

fn missing(header: &Line<'_>, names: &[String], what: &str, name: &str) -> Problem {
    let message = format!("no column {}, for {what}", suggest::quoted(name));
    let hint = suggest::hint(name, names.iter().map(String::as_str));
    header.whole("header", message, format!("{hint}; --columns says which column is what"))
}
