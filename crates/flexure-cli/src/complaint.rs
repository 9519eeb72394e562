//! Problems as JSON: what `--json` says where there is no answer, or beside one that is no.

use flexure::files::Problem;
use miette::Report;
use serde::Serialize;

use crate::failure::Said;

/// A problem and where it is, as far as it is anywhere.
#[derive(Serialize)]
pub struct Complaint {
    /// One word, the same in every version: docs/files.md lists them.
    code: String,
    message: String,
    hint: String,
    file: Option<String>,
    line: Option<usize>,
    column: Option<usize>,
}

impl From<&Problem> for Complaint {
    fn from(problem: &Problem) -> Self {
        let (line, column) = problem.line_column().unzip();
        Self {
            code: problem.code_word().to_owned(),
            message: problem.to_string(),
            hint: problem.hint().to_owned(),
            file: problem.file().map(str::to_owned),
            line,
            column,
        }
    }
}

impl From<&Report> for Complaint {
    fn from(report: &Report) -> Self {
        if let Some(problem) = report.downcast_ref::<Problem>() {
            return problem.into();
        }
        let code = report.code().map(|code| code.to_string()).unwrap_or_default();
        let place = report.downcast_ref::<Said>().and_then(|said| said.place.clone());
        let (line, column) = place.as_ref().map_or((None, None), |place| (place.line, place.column));
        Self {
            code: code.trim_start_matches("error[").trim_end_matches(']').to_owned(),
            message: report.to_string(),
            hint: report.help().map(|help| help.to_string()).unwrap_or_default(),
            file: place.map(|place| place.file),
            line,
            column,
        }
    }
}

/// The key `error`: the first problem, and the others.
#[derive(Serialize)]
pub struct Errors {
    /// There and true where Ctrl-C broke the answer off.
    #[serde(skip_serializing_if = "Option::is_none")]
    interrupted: Option<bool>,
    error: First,
}

#[derive(Serialize)]
struct First {
    #[serde(flatten)]
    complaint: Complaint,
    others: Vec<Complaint>,
}

impl Errors {
    /// None if nothing is wrong.
    pub fn of(reports: &[Report]) -> Option<Self> {
        let (first, others) = reports.split_first()?;
        let others = others.iter().map(Complaint::from).collect();
        Some(Self { interrupted: None, error: First { complaint: first.into(), others } })
    }

    /// Of an answer that was broken off.
    pub fn interrupted(self) -> Self {
        Self { interrupted: Some(true), ..self }
    }
}
