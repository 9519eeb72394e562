//! Where a tube ends, in words.

use crate::files::number::{engineering, short};
use crate::prove::engine::sampled_data::sensors::Sensors;
use crate::prove::engine::sampled_data::tube::{Ends, Why};
use crate::prove::engine::sampled_data::watch::{Beyond, Limit};
use crate::prove::sampled_data::{NoTube, Way};
use crate::sampled;
use crate::scenario::Scenario;
use crate::units::{self, Unit};

const BELIEVES: &str = "and the guard believes up to";

/// Why nobody looks at small errors.
pub fn not_looked_at(scenario: &Scenario) -> String {
    let why = sampled::not_looked_at(scenario).unwrap_or_default();
    why.strip_prefix("sampled loop: ").map_or(why.clone(), str::to_owned)
}

/// Where a tube ends, in words.
pub fn why(scenario: &Scenario, rate: f64, sensors: &Sensors, ends: &Ends) -> NoTube {
    let time = format!("at t = {} s", short(ends.period as f64 * scenario.control_period, 5));
    let unit = |unit: Unit, joint: usize| unit.of(scenario.robot.joints[joint].kind).plain;
    let narrower = if sensors.off.is_empty() { "a smaller one" } else { "another width" };
    let at = match ends.why {
        Why::NotStable => {
            format!("at the start small errors do not shrink at {} 1/s", engineering(rate))
        }
        Why::StartsOutside => "the start of the run is not in the first ellipsoid".to_owned(),
        Why::Unbounded => format!("{time} motions in it were not shown to stay bounded for a control period"),
        Why::Grows => format!("{time} motions in it were not shown to come closer"),
        Why::Widens(link, reach) => format!(
            "{time} it would have to be so wide that link {} is up to {} {} from the run",
            link + 1,
            engineering(reach),
            unit(units::ANGLE, link)
        ),
        Why::Missed => {
            format!("{time} where its middle goes is not known as closely as motions come closer")
        }
        Why::Beyond(Beyond { limit, joint, found, passes, parts }) => {
            let (what, of, who) = match limit {
                Limit::Torque => ("the torque", units::TORQUE, "and the limit is"),
                Limit::TorqueStep => {
                    ("a control period's change of the torque", units::TORQUE, "and the limit is")
                }
                Limit::Highest => ("a reading", units::ANGLE, BELIEVES),
                Limit::Lowest => ("minus a reading", units::ANGLE, BELIEVES),
                Limit::Speed => ("a reading of the speed", units::SPEED, BELIEVES),
                Limit::Deflection => ("a reading of the deflection", units::ANGLE, BELIEVES),
                Limit::Jump => ("a control period's change of a reading", units::ANGLE, BELIEVES),
                Limit::Travel => (
                    "what the other side or the reference moves while a reading may stay the same",
                    units::ANGLE,
                    "and the guard takes it to be frozen from",
                ),
            };
            let (found, passes) = (short(found, 5), short(passes, 5));
            let (unit, joint) = (unit(of, joint), joint + 1);
            let parts = parts.map_or_else(String::new, |[run, readings]| {
                let readings = if sensors.off.is_empty() {
                    String::new()
                } else {
                    format!(", readings may add {}", short(readings, 3))
                };
                format!(": the run takes {}{readings}", short(run, 3))
            });
            format!("{time} {what} of joint {joint} may come to {found} {unit}, {who} {passes} {unit}{parts}")
        }
    };
    let (way, other) = match ends.why {
        Why::Unbounded | Why::Grows | Why::Widens(..) => (Way::Narrower, Some(narrower)),
        // A run that stays below the limit by itself has a tube that does.
        Why::Beyond(_) => (Way::Narrower, None),
        Why::Missed => (Way::Wider, Some("a larger one")),
        Why::NotStable | Why::StartsOutside => (Way::None, None),
    };
    let advised = other.map_or(at.clone(), |other| format!("{at}; {other} may have one"));
    NoTube { at: advised, not_shown: at, way, shown: ends.period, wide: ends.wide }
}
