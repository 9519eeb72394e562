//! The widest tube of a sampled loop, by trying.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::files::Problems;
use crate::files::number::{engineering, short};
use crate::progress::Progress;
use crate::prove::engine::sampled_data::tube::Sections;
use crate::prove::sampled_data::{
    Asked, NoTube, SampledTube, Way, followed, late, rate_to_look_for, sensors, suitable_when_sampled,
};
use crate::scenario::Scenario;

/// How far links may reach in rad, from wide to narrow: three a decade.
const WIDTHS: [f64; 19] = [
    1e-1, 5e-2, 2e-2, 1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6, 2e-6, 1e-6, 5e-7,
    2e-7, 1e-7,
];

/// Control periods after which a tube is taken to have come far.
const FAR: usize = 50;

/// What comes farther by less than this part comes as far.
const FARTHER: f64 = 0.1;

/// A tube that ends so many times as wide as was asked for is not as wide as it is because of that.
const DRIVEN: f64 = 2.0;

/// The widest tube of those that were tried in which two motions come closer at `least` 1/s or faster, all links reaching equally far at
/// the start; or why there is none. None where `progress` breaks it off.
///
/// Too wide a tube ends within a few periods, so that trying from wide to narrow costs little beside the tube that is found. Where one comes far but not to the end, no
/// farther than the wider ones before it, and is wide there whatever was asked for, narrower ones are not tried: it is what readings do that ends them.
///
/// # Errors
/// As [`sampled_tube`](super::sampled_tube).
pub fn widest_tube(
    scenario: &Scenario,
    least: f64,
    progress: Progress<'_>,
) -> Result<Option<Result<SampledTube, NoTube>>, Problems> {
    suitable_when_sampled(scenario)?;
    let rate = match rate_to_look_for(scenario)? {
        Ok(rate) => rate,
        Err(none) => return Ok(Some(Err(none))),
    };
    // A narrower tube begins anew: what is told never goes back. Bits of positive floats are ordered as they are.
    let most = AtomicU64::new(0);
    let told = |fraction: f64| {
        let before = most.fetch_max(fraction.to_bits(), Ordering::Relaxed);
        progress(f64::from_bits(before.max(fraction.to_bits())))
    };
    let n = scenario.robot.joint_count();
    let mut tried = 0;
    let mut farthest: Option<(f64, NoTube)> = None;
    for width in WIDTHS {
        tried += 1;
        let asked = Asked { extents: vec![width; n], rate };
        let none = match followed(scenario, asked, Sections::Made, &told)? {
            None => return Ok(None),
            Some(Ok(tube)) if tube.rate >= least => return Ok(Some(Ok(tube))),
            Some(Ok(tube)) => too_slow(&tube, least),
            Some(Err(none)) => none,
        };
        let way = none.way;
        let before = farthest.as_ref().map_or(0, |(_, best)| best.shown);
        let as_far = none.shown as f64 <= (1.0 + FARTHER) * before as f64;
        // One that is too slow comes to the end: narrower ones are faster.
        let driven = none.shown < scenario.periods() as usize && none.wide > DRIVEN;
        if before <= none.shown {
            farthest = Some((width, none));
        }
        if way != Way::Narrower || (before >= FAR && as_far && driven) {
            break;
        }
    }
    Ok(farthest.map(|(width, none)| Err(none.farthest(tried, width))))
}

/// Control periods times the third power of how many numbers a section is of, up to which a tube is quick to find: 20 s of two joints at 1 kHz are half
/// of it, one or two minutes of two cores are all of it.
const QUICK: f64 = 2e7;

/// Whether it is known within a minute or two what widths have a tube.
pub(crate) fn is_quick(scenario: &Scenario) -> bool {
    if suitable_when_sampled(scenario).is_err() {
        return true;
    }
    let filtered = if sensors(scenario).filter.is_some() { 2 } else { 0 };
    let numbers = scenario.robot.joint_count() * (4 + filtered + late(scenario).waiting);
    f64::from(scenario.periods()) * (numbers as f64).powi(3) <= QUICK
}

/// The widest tube at any rate; for a loop that tubes do not speak of, that.
pub(crate) fn strongest_tube(
    scenario: &Scenario,
    progress: Progress<'_>,
) -> Result<Option<Result<SampledTube, NoTube>>, Problems> {
    match suitable_when_sampled(scenario) {
        Ok(()) => widest_tube(scenario, 0.0, progress),
        Err(problems) => {
            let all: Vec<_> = problems.iter().map(ToString::to_string).collect();
            Ok(Some(Err(NoTube::at_all(all.join("; ")))))
        }
    }
}

fn too_slow(tube: &SampledTube, least: f64) -> NoTube {
    let at = format!(
        "motions in it were shown to come closer at {} 1/s, where {} 1/s are asked for",
        engineering(tube.rate),
        short(least, 5)
    );
    NoTube { way: Way::Narrower, shown: tube.periods, ..NoTube::at_all(at) }
}

impl NoTube {
    /// As the one of so many that came farthest, of `width` in rad.
    fn farthest(&self, tried: usize, width: f64) -> Self {
        let of_all = if tried == 1 {
            String::new()
        } else {
            format!("{tried} widths were tried; that of {width:e} rad came farthest: ")
        };
        let at = format!("{of_all}{}", self.not_shown);
        Self { not_shown: at.clone(), at, ..self.clone() }
    }
}
