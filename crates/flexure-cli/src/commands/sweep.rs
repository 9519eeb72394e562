//! `flexure sweep`: many runs of a scenario whose numbers change, and what came of them.

use std::ops::Range;
use std::path::{Path, PathBuf};

use flexure::files::{Reading, Unfinished};
use flexure::report::{sweep_table, write_swept};
use flexure::sweep::{Collocated, Folder, Sweep as Many, Told};
use serde::Serialize;

use super::{print, run};
use crate::args::{OfFolder, Sweep, Traced};
use crate::failure::{Failure, say};
use crate::progress::Progress;

/// What there is of a sweep.
#[derive(Serialize)]
struct Outcome<'a> {
    name: &'a str,
    /// A hash of what it is.
    identity: &'a str,
    folder: &'a Path,
    /// Rows in all.
    rows: u64,
    /// Shards in all.
    shards: u64,
    /// Shards that are there.
    shards_there: u64,
    /// Shards that this command computed.
    computed: u64,
    /// Its page and figure; not there without `--page`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pages: Vec<PathBuf>,
    /// What collocation makes of some of its rows; there for those by midpoint steps.
    #[serde(skip_serializing_if = "Option::is_none")]
    collocated: Option<&'a Collocated>,
    #[serde(flatten)]
    told: Told<'a>,
}

pub fn sweep(options: &Sweep, reading: Reading<'_>, json: bool) -> Result<(), Failure> {
    if let Some(of) = &options.of {
        if !reading.changes.is_empty() {
            let message = "--set changes a scenario, and that of a folder stands".to_owned();
            return Err(Failure::input(
                "usage",
                message,
                "give it to `flexure sweep SWEEP`, with another folder",
            ));
        }
        return match of {
            OfFolder::Replay { folder, row, traced } => replay(folder, *row, traced, json),
            OfFolder::Show { folder, paged } => {
                let (folder, sweep) = Folder::open(folder)?;
                paged.prepare(sweep.name(), "sweep", 1, &[""; 0])?;
                show(&sweep, &folder, 0, paged.page.as_deref(), json)
            }
        };
    }
    let sweep = Many::load(options.file.as_deref().unwrap_or_default(), reading)?;
    say(sweep.warnings());
    let range = shards(options.shards.as_deref(), sweep.shards())?;
    let path = options.out.clone().unwrap_or_else(|| PathBuf::from("out").join(sweep.name()));
    options.paged.prepare(sweep.name(), "sweep", 1, &[""; 0])?;
    let folder = Folder::of(&sweep, &path)?;
    let there = || folder.parts().map(|parts| parts.range(range.clone()).count());
    let before = there()?;
    let computed = {
        let progress = Progress::of_one(sweep.name());
        folder.complete(&sweep, range.clone(), &|fraction| progress.set(0, fraction))
    };
    match computed {
        Ok(computed) => show(&sweep, &folder, computed, options.paged.page.as_deref(), json),
        Err(Unfinished::Problems(problems)) if problems.is_interrupted() => {
            let there = there()?;
            show(&sweep, &folder, (there - before.min(there)) as u64, None, json)?;
            let message = format!("broken off: {there} of {} shards are there", range.end - range.start);
            let hint = options.paged.broken_off("the same command goes on where it was");
            Err(Failure::interrupted(message, &hint))
        }
        Err(other) => Err(other.into()),
    }
}

/// `A..B`, or one shard.
fn shards(said: Option<&str>, count: u64) -> Result<Range<u64>, Failure> {
    let Some(said) = said else { return Ok(0..count) };
    let number = |text: &str, missing: u64| {
        let text = text.trim();
        if text.is_empty() { Some(missing) } else { text.parse().ok() }
    };
    let range = match said.split_once("..") {
        Some((from, to)) => number(from, 0).zip(number(to, count)),
        None => said.trim().parse().ok().map(|shard: u64| (shard, shard.saturating_add(1))),
    };
    match range {
        Some((from, to)) if from < to && to <= count => Ok(from..to),
        _ => {
            let message = format!("--shards is '{said}', must be shards from 0 to {}", count - 1);
            Err(Failure::input(
                "usage",
                message,
                "--shards 0..10 is the first ten, --shards 3 the one after three",
            ))
        }
    }
}

fn show(
    sweep: &Many,
    folder: &Folder,
    computed: u64,
    page: Option<&Path>,
    json: bool,
) -> Result<(), Failure> {
    let statistics = folder.statistics(sweep)?;
    let pages = page.map_or_else(|| Ok(Vec::new()), |page| write_swept(page, sweep, &statistics))?;
    let there = folder.parts()?.len() as u64;
    let (collocated, broken_off) = {
        let progress = Progress::of_one(sweep.name());
        match sweep.beside_collocation(&|fraction| progress.set(0, fraction)) {
            Err(problems) if problems.is_interrupted() => (None, true),
            collocated => (collocated?.filter(|_| statistics.rows > 0), false),
        }
    };
    if json {
        print::json(&Outcome {
            name: sweep.name(),
            identity: sweep.identity(),
            folder: folder.path(),
            rows: sweep.rows(),
            shards: sweep.shards(),
            shards_there: there,
            computed,
            pages,
            collocated: collocated.as_ref(),
            told: statistics.told(sweep),
        })?;
    } else {
        if statistics.rows > 0 {
            print::line(&sweep_table(sweep, &statistics, print::columns()))?;
        }
        print::line(&statistics.sentence(sweep))?;
        print::line(&format!("{there} of {} shards in {}", sweep.shards(), folder.path().display()))?;
        collocated.as_ref().map_or(Ok(()), |collocated| print::line(&collocated.line()))?;
        print::wrote(&pages)?;
    }
    if broken_off {
        let message = "broken off: what rows by midpoint steps are by collocation is not known".to_owned();
        return Err(Failure::interrupted(message, "`flexure sweep show` looks again"));
    }
    let answer = collocated.and_then(|collocated| collocated.disagreement(sweep));
    answer.map_or(Ok(()), |answer| Err(Failure::No(vec![answer.into()])))
}

/// Runs a row again, with its trace.
fn replay(folder: &Path, row: u64, traced: &Traced, json: bool) -> Result<(), Failure> {
    let (_, sweep) = Folder::open(folder)?;
    let mut scenario = sweep.scenario(row)?;
    scenario.name = format!("{}-row-{row}", sweep.name());
    let values = sweep.values(row);
    let said = sweep.parameters().iter().zip(&values).map(|(parameter, value)| {
        let times = if parameter.relative { "× " } else { "" };
        format!("{} {times}{value}", parameter.key)
    });
    let said: Vec<String> = said.collect();
    let first = format!("row {row}: {}; seed {}", said.join(", "), sweep.seed(row));
    run::told(vec![scenario], Some(&first), traced, json)
}
