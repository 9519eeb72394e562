//! Logs that are refused: one message, with the line and what to do.

use super::{HEADER, read, row, sample, written};

/// Reads a log that is refused and gives what is said, with the code and the hint.
#[track_caller]
fn refusal(text: &str, said: Option<&str>) -> String {
    let problems = read(text, said).err().unwrap_or_else(|| panic!("accepted"));
    let problem = problems.iter().next().unwrap();
    let (line, column) = problem.line_column().unwrap_or((0, 0));
    format!("{} {line}:{column}: {problem}; {}", problem.code_word(), problem.hint())
}

#[track_caller]
fn refused(text: &str, said: Option<&str>, fragments: &[&str]) {
    let found = refusal(text, said);
    for fragment in fragments {
        assert!(found.contains(fragment), "{fragment} is not in {found}");
    }
}

/// A good log with the line `number` (from 1) changed.
fn changed(number: usize, change: impl Fn(&str) -> String) -> String {
    let text = written(HEADER, row);
    let lines = text.lines().enumerate();
    lines.map(|(i, line)| if i + 1 == number { change(line) } else { line.to_owned() } + "\n").collect()
}

/// A good log with each sample's numbers changed.
fn remade(change: impl Fn(&mut [f64; 6], &mut f64)) -> String {
    written(HEADER, |k| {
        let (mut t, [a, b], [c, d], [e, f]) = sample(k);
        let mut x = [a, b, c, d, e, f];
        change(&mut x, &mut t);
        let [a, b, c, d, e, f] = x;
        format!("{t},{a},{b},{c},{d},{e},{f}")
    })
}

#[test]
fn cells_that_are_no_numbers() {
    let cell =
        |with: &'static str| changed(57, move |line| line.replacen(&sample(55).1[0].to_string(), with, 1));
    refused(&cell("NaN"), None, &["number 57:7", "'q_l1' is NaN", "cut the log"]);
    refused(&cell("inf"), None, &["number 57:7", "must be a finite number"]);
    refused(&cell(""), None, &["number 57:7", "'q_l1' is empty"]);
    refused(&cell("0.1.2"), None, &["number 57:7", "'0.1.2'", "with a point"]);
    refused(&cell("\u{1b}[31m"), None, &["number 57:", "\\u{1b}"]);
    let comma = written(&HEADER.replace(',', ";"), |k| row(k).replace(',', ";").replace('.', ","));
    refused(&comma, None, &["number 2:5", "with a point"]);
}

#[test]
fn rows_and_headers() {
    refused("", None, &["empty", "is empty"]);
    refused(
        &changed(80, |line| line[..20].to_owned()),
        None,
        &["length 80:1", "cells in this row, must be 7"],
    );
    refused(&changed(80, |line| format!("{line},1")), None, &["length 80:1", "8 cells"]);
    refused(
        &written(HEADER, row).lines().take(50).collect::<Vec<_>>().join("\n"),
        None,
        &["49 samples", "at least 100"],
    );
    refused(
        &written(HEADER, row).lines().skip(1).collect::<Vec<_>>().join("\n"),
        None,
        &["header", "no names but numbers"],
    );
    let header = |from: &str, to: &str| written(&HEADER.replacen(from, to, 1), row);
    refused(&header("u_m1", "um1"), None, &["header 1:1", "'u_m1'", "known: t, q_l1"]);
    refused(&header("u_m2", "um_2"), None, &["'u_m2'", "did you mean"]);
    refused(&header("t,", "time,"), None, &["'t', for the time", "--columns"]);
    refused(&header("q_l2", "q_l1"), None, &["header 1:8", "two columns 'q_l1'"]);
    refused(&header("u_m1", "q_l3"), None, &["header", "more than the 2 joints"]);
    refused(&header("q_l2", "q_l9"), None, &["no column 'q_l2'"]);
    refused("t,u_m1,u_m2\n0,1,1\n", None, &["no column 'q_m1', for positions"]);
    refused(&"x".repeat(2_000_000), None, &["huge", "longer than"]);
    refused("<robot>\n</robot>\n", None, &["header", "no column 't'"]);
}

/// A trace leaves out what was not measured, but torques and one side's positions must be there from the first row on.
#[test]
fn nothing_in_the_first_row() {
    let without = |columns: std::ops::Range<usize>| {
        changed(2, |line| {
            let cells = line.split(',').enumerate();
            cells
                .map(|(i, cell)| if columns.contains(&i) { "nan" } else { cell })
                .collect::<Vec<_>>()
                .join(",")
        })
    };
    refused(&without(5..7), None, &["number 2:", "u_m1"]);
    refused(&without(1..5), None, &["number 2:", "no positions of links or motors"]);
}

#[test]
fn times() {
    let time = |with: &str| changed(90, |line| format!("{with},{}", line.split_once(',').unwrap().1));
    refused(&time("0.01"), None, &["order 90:1", "runs back"]);
    refused(&time(&sample(87).0.to_string()), None, &["order 90:1", "that of the row before"]);
    refused(&time("0.0884"), None, &["spacing", "40 % off", "at most 20 %"]);
    let whole = written(HEADER, row);
    let lines = whole.split_inclusive('\n').enumerate();
    let holed: String = lines.filter(|(i, _)| !(100..130).contains(i)).map(|(_, line)| line).collect();
    refused(&holed, None, &["gap 101:1", "31 ms", "gaps: 1"]);
    refused(&remade(|_, t| *t *= 1e3), None, &["scale", "too slow", "t.unit = \"ms\""]);
}

#[test]
fn units_and_columns_that_the_robot_cannot_do() {
    refused(
        &remade(|x, _| (0..4).for_each(|i| x[i] = x[i].to_degrees())),
        None,
        &["scale", "joint1", "unit = \"deg\""],
    );
    refused(&remade(|x, _| (2..4).for_each(|i| x[i] *= 100.0)), None, &["scale", "motor_side"]);
    refused(
        &remade(|x, _| (0..2).for_each(|i| x[i] = (x[i] * 1e4).round())),
        None,
        &["scale", "encoder counts"],
    );
    refused(&remade(|x, _| x[4] *= 1e3), None, &["scale", "u_m goes up to", "mN m"]);
    // Torques that bend no spring so far.
    let gentle = |change: fn(&mut [f64; 6])| {
        remade(|x, _| {
            change(x);
            x[4] *= 0.1;
            x[5] *= 0.1;
        })
    };
    refused(&gentle(|x| x.swap(2, 3)), None, &["scale", "columns swapped"]);
    refused(&gentle(|x| x[2] = -x[2]), None, &["scale", "sign = -1"]);
    let (_, warnings) = read(&remade(|x, _| x[5] = 0.0), None).unwrap();
    assert!(warnings.iter().any(|warning| warning.to_string().contains("torque is 0 all the time")));
    let (_, warnings) = read(&remade(|x, _| x[4] *= 5.0), None).unwrap();
    assert!(warnings.iter().any(|warning| warning.to_string().contains("its limit is 20.0")), "{warnings:?}");
}

#[test]
fn maps_of_columns() {
    let text = written(HEADER, row);
    let map = |said: &str, fragments: &[&str]| refused(&text, Some(said), fragments);
    map("q_l=q_l{}", &["missing-key", "u_m"]);
    map("u_m=u_m{},q_1=a", &["unknown-key", "did you mean 'q_l'"]);
    map("u_m=u_m{},q_l=pos{}", &["header 1:1", "no column 'pos1', for q_l"]);
    map("u_m=u_m{},q_l=q_l1", &["length", "which is one column", "{}"]);
    map("u_m=u_m{},q_l=q_l{},q_l.unit=degrees", &["unknown-name", "'degrees'"]);
    map("u_m=u_m{},q_l=q_l{},q_l.scale=0", &["range", "must not be 0"]);
    map("u_m=u_m{},q_l=q_l{},q_l.sign=2", &["range", "1 or -1"]);
    map("u_m=u_m{},q_l=q_l{},q_l.motor_side=true", &["unknown-key", "motor_side"]);
    map("u_m=u_m{},q_l=q_l{},nonsense", &["usage", "KEY=VALUE"]);
    map("u_m=u_m{}", &["header", "positions of links or motors"]);
    map("none.toml", &["unreadable", "none.toml"]);
    map("u_m=u_m{},u_m=q_l{}", &["syntax"]);
}

/// Velocities that are not the rates of their positions, whatever limits there are.
#[test]
fn velocities_of_other_units() {
    let log = |factor: f64| {
        written(&format!("{HEADER},dq_m1,dq_m2"), |k| {
            let t = 1e-3 * k as f64;
            let rate = factor * (1.5 * (3.0 * t).cos() + 0.18 * (9.0 * t).cos());
            format!("{},{rate},{}", row(k), -1.5 * factor * (5.0 * t).sin())
        })
    };
    assert!(read(&log(1.0), None).is_ok() && read(&log(0.7), None).is_ok());
    refused(&log(0.02), None, &["scale", "dq_m is 0.0200 times the rate of q_m", "--columns"]);
    refused(&log(-1.0), None, &["scale", "dq_m is −1.00 times", "sign = -1"]);
    assert!(read(&log(0.02), Some("q_m=q_m{},u_m=u_m{},dq_m=dq_m{},dq_m.scale=50")).is_ok());
}
