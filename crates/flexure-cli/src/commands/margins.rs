//! `flexure margins`: how much a loop bears.

use flexure::io::load_scenario;
use flexure::margins::margins;
use flexure::report::margins_table;

use super::print;
use crate::failure::{Failure, say};

pub fn measure(scenario: &str, json: bool) -> Result<(), Failure> {
    let scenario = load_scenario(scenario)?;
    say(&scenario.warnings);
    let found = margins(&scenario)?;
    if json {
        print::json(&found)?;
    } else {
        print::line(&margins_table(std::slice::from_ref(&found)))?;
        print::line(&format!(
            "holds: the loop does not diverge and its rms error is at most {:.3} mrad; {} runs",
            1e3 * found.allowed_rms_e_l,
            found.runs
        ))?;
    }
    found.objection(&scenario).map_or(Ok(()), |problem| Err(Failure::No(vec![problem.into()])))
}
