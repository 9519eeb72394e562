//! The page of a sweep.

use maud::{Markup, html as markup};

use super::kit::{Page, Section, Verdict, figure, made, numbers};
use super::runs;
use crate::files::number::engineering;
use crate::report::assumptions;
use crate::report::draw::scene::Scene;
use crate::report::tables::sweep::metrics;
use crate::sweep::{Statistics, Status, Sweep, Values};

/// The page: what became of the runs, how their metrics are spread, and what was changed.
pub(crate) fn sweep_page(sweep: &Sweep, statistics: &Statistics, picture: &Scene) -> String {
    let caption = markup! {
        "Each metric on an axis of its own, logarithmic where its values lie far apart. Runs that were refused have no metrics, runs that diverged have \
         those of the time until then."
    };
    let changed = |key: &str| sweep.parameters().iter().any(|parameter| parameter.key == key);
    // Of a row: what the sweep changes is not assumed.
    let scenario = sweep.scenario(0).ok();
    let mut assumed = assumptions(scenario.iter());
    assumed.retain(|number| !changed(&number.key));
    let sections = vec![
        Section::new("metrics", "Metrics in numbers", numbers(&metrics(sweep, statistics))),
        Section::new("what", "What the metrics are", explained(sweep)).folded(),
        Section::new("parameters", "What was changed", parameters(sweep)),
        Section::new("assumptions", "Assumptions", runs::assumptions(&assumed)).folded(),
    ];
    let lines = [
        format!("The sweep is {}; identity {}.", sweep.name(), sweep.identity()),
        "Quantiles are good to half a percent. The same rows give the same page, byte for byte, in whichever parts they were computed.".to_owned(),
    ];
    Page {
        title: &format!("{}: sweep", sweep.name()),
        verdict: Some(&verdict(sweep, statistics)),
        lead: figure(&picture.svg(), &caption),
        sections,
        provenance: made(&lines),
    }
    .html()
}

/// The metric that tells whether a loop is stable as it is sampled.
const DECAY: &str = "sampled_rate";

/// Good if every run is there and follows in a loop that is stable as sampled; how many may fail is not for the program to say.
fn verdict(sweep: &Sweep, statistics: &Statistics) -> Verdict {
    let follow = statistics.statuses.get(Status::Follows.name()).copied().unwrap_or_default();
    let all = statistics.statuses.values().sum::<u64>() == sweep.rows();
    let decay = statistics.metrics.get(DECAY);
    let slowest = decay.filter(|decay| decay.count == sweep.rows()).and_then(|decay| decay.least);
    let sampled = match (decay.and_then(|decay| decay.least), slowest) {
        (_, Some(slowest)) if slowest > 0.0 => {
            format!(" Small errors shrink in every sampled loop, by {} 1/s or faster.", engineering(slowest))
        }
        (Some(least), _) if least <= 0.0 => {
            " Some of the loops are unstable as sampled: small errors grow.".to_owned()
        }
        _ => format!(
            " Whether small errors shrink in each of the sampled loops is not known from the metrics ({DECAY})."
        ),
    };
    let midpoint = sweep.is_by_midpoint();
    let steps = if midpoint {
        " Plants were moved by midpoint steps of at most 1 ms, whose errors nobody estimates."
    } else {
        ""
    };
    let good = (!midpoint && all && follow == sweep.rows() && slowest.is_some_and(|slowest| slowest > 0.0))
        .then_some(true);
    Verdict { good, words: format!("{}.{sampled}{steps}", statistics.sentence(sweep)) }
}

fn explained(sweep: &Sweep) -> Markup {
    markup! { ul { @for metric in sweep.metrics() { li { code { (metric.name) } ": " (metric.what) } } } }
}

fn parameters(sweep: &Sweep) -> Markup {
    let words = |values: &Values| match values {
        Values::Between { from, to, logarithmic, .. } => {
            let by = if *logarithmic { ", by equal factors" } else { "" };
            format!("{} to {}{by}", engineering(*from), engineering(*to))
        }
        Values::Listed(values) => {
            values.iter().map(|(value, _)| value.to_string()).collect::<Vec<_>>().join(", ")
        }
    };
    markup! {
        div.scroll { table {
            thead { tr { th { "key" } th { "values" } } }
            tbody { @for parameter in sweep.parameters() { tr {
                td { code { (parameter.key) } }
                td { @if parameter.relative { "what the file says times " } (words(&parameter.values)) }
            } } }
        } }
    }
}
