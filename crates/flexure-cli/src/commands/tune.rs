//! `flexure tune`: gains for a scenario.

use flexure::design::{Design, SpecFile, Specified, check_budget, design};
use flexure::files::Reading;

use super::print;
use crate::args::Tune;
use crate::failure::{Failure, say};
use crate::progress::Progress;

pub fn tune(options: &Tune, reading: Reading<'_>, json: bool) -> Result<(), Failure> {
    check_budget(options.budget)?;
    let spec = options.spec.as_deref().map_or_else(|| Ok(SpecFile::usual()), SpecFile::load)?;
    let specified = Specified::load(&options.scenario, reading, &spec)?;
    say(specified.scenarios.iter().flat_map(|scenario| &scenario.warnings));
    let found: Design = {
        let progress = Progress::new(&specified.scenarios[0].name, 1);
        design(&specified, &spec, options.budget, options.seed, &|fraction| progress.set(0, fraction))?
    };
    if json {
        print::json(&found)?;
    } else {
        print::line(&format!("{found:#?}"))?;
    }
    print::line(&specified.with(&found.controller, "tuned"))?;
    Ok(())
}
