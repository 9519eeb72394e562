//! Following the file of a funnel: is it about this loop, and do errors stay in every slab of it?

use std::sync::atomic::{AtomicUsize, Ordering};

use flexure_core::scalar::Interval;
use rayon::prelude::*;
use serde_json::json;

use crate::files::Problems;
use crate::files::number::short;
use crate::progress::Progress;
use crate::prove::along::{enclosed, start_errors, suitable};
use crate::prove::documents::{
    Checked, FUNNEL, bounds_hold, every, malformed, of_lower, rate_holds, refuted, triangle, unpacked,
};
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::envelope::deviation::Spread;
use crate::prove::engine::envelope::followed::{Given, Lacks, count};
use crate::prove::engine::envelope::shape::{Passage, Shape};
use crate::prove::robust::file::{Claims, Document, Own, about};
use crate::prove::robust::inside::Inside;
use crate::prove::robust::{About, Robust, SHARE};
use crate::prove::subject::Difference;
use crate::prove::within::spread;
use crate::scenario::Scenario;
use crate::verify::{Rejected, is_decimal};

/// Follows every slab of the file whose text is `text` along the reference of `scenario`.
///
/// # Errors
/// If funnels do not speak of such a loop.
pub fn check(text: &str, scenario: &Scenario, progress: Progress<'_>) -> Result<Checked<Robust>, Problems> {
    suitable(scenario)?;
    let document: Document = match FUNNEL.read(text, &["tolerances", "torques", "claims"]) {
        Ok(document) => document,
        Err(rejected) => return Ok(Checked::Rejected(rejected)),
    };
    let differences = compared(&document, &about(scenario, &spread(&scenario.robot, None, None))?);
    if !differences.is_empty() {
        return Ok(Checked::Differs(differences));
    }
    let n = scenario.robot.joint_count();
    let own = &document.own;
    let read = own.spread(n).and_then(|spread| {
        let slabs = own.slabs(n, spread.has_masses())?;
        own.claims.are_numbers(n).map(|()| (spread, slabs))
    });
    let (spread, slabs) = match read {
        Ok(read) => read,
        Err(rejected) => return Ok(Checked::Rejected(rejected)),
    };
    let system = enclosed(scenario)?;
    let checking = Checking { scenario, system: &*system, spread: &spread, claims: &own.claims };
    Ok(match checking.followed(slabs, progress) {
        None => Checked::BrokenOff,
        Some(Ok(robust)) => Checked::Holds(Box::new(robust)),
        Some(Err(rejected)) => Checked::Rejected(rejected),
    })
}

/// Where what the file says of its loop is not what the scenario's is. Torques are those that the file is about.
fn compared(ours: &Document, theirs: &Document) -> Vec<Difference> {
    let (of_ours, of_theirs) = (&ours.own, &theirs.own);
    ours.told.differences(
        &theirs.told,
        &[
            ("duration", of_ours.duration.clone(), of_theirs.duration.clone()),
            ("limits", of_ours.limits.clone(), of_theirs.limits.clone()),
            ("tolerances", json!(of_ours.tolerances), json!(of_theirs.tolerances)),
        ],
    )
}

impl Own {
    /// What the file leaves open of a robot of `n` joints, and what that feels.
    fn spread(&self, n: usize) -> Result<Spread, Rejected> {
        let read = |place: &str, texts: &[String]| {
            let number = |text: &String| {
                let bounds = Interval::from_decimal(text).filter(|_| is_decimal(text));
                bounds.filter(|x| x.lo() >= 0.0 && x.hi().is_finite())
            };
            let all = texts.iter().map(number).collect::<Option<Vec<_>>>();
            all.filter(|all| all.len() == n)
                .ok_or_else(|| malformed(place, format!("must be {n} numbers of 0 or more")))
        };
        let (of, torques) = (&self.tolerances, &self.torques);
        Ok(Spread {
            stiffness: read("tolerances.stiffness", &of.stiffness)?,
            motor_inertia: read("tolerances.motor_inertia", &of.motor_inertia)?,
            link_damping: read("tolerances.link_damping", &of.link_damping)?,
            motor_damping: read("tolerances.motor_damping", &of.motor_damping)?,
            link_mass: read("tolerances.link_mass", &of.link_mass)?,
            motor_torque: read("torques.motors", &torques.motors)?,
            link_torque: read("torques.links", &torques.links)?,
        })
    }

    /// The slabs of a robot of `n` joints.
    fn slabs(&self, n: usize, has_masses: bool) -> Result<Vec<Given>, Rejected> {
        if self.slabs.is_empty() {
            return Err(malformed("slabs", "must be one at least"));
        }
        let slab = |(k, text): (usize, &String)| {
            read(text, 4 * n, count(n, has_masses)).map_err(|reason| malformed(format!("slabs[{k}]"), reason))
        };
        self.slabs.iter().enumerate().map(slab).collect()
    }
}

/// The slab of `size` errors and so many `causes` that `text` is, or what is wrong with it.
fn read(text: &str, size: usize, causes: usize) -> Result<Given, String> {
    let all = unpacked(text)?;
    let (own, around) = (1 + triangle(size), triangle(size) + 2 * causes);
    let instants = all.len().saturating_sub(around) / own;
    if all.len() != around + instants * own || instants < 2 {
        return Err(format!("has {} numbers, must have {around} and two or more times {own}", all.len()));
    }
    let (times, rest) = all.split_at(instants);
    let (shapes, rest) = rest.split_at(instants * triangle(size));
    let (around, rest) = rest.split_at(triangle(size));
    let (alpha, tau) = rest.split_at(causes);
    if !times.is_sorted_by(|a, b| a < b) {
        return Err("has times that do not increase".to_owned());
    }
    let shape = |entries: &[f64]| Ok::<_, String>(Shape { lower: of_lower(size, entries)? });
    Ok(Given {
        times: times.to_vec(),
        passage: Passage(shapes.chunks(triangle(size)).map(shape).collect::<Result<_, _>>()?),
        around: shape(around)?,
        alpha: alpha.to_vec(),
        tau: tau.to_vec(),
    })
}

/// What is followed.
struct Checking<'a> {
    scenario: &'a Scenario,
    system: &'a dyn TrackingLoop,
    spread: &'a Spread,
    claims: &'a Claims,
}

impl Checking<'_> {
    /// What the slabs show, if it is what is claimed; none where `progress` breaks it off.
    fn followed(&self, slabs: Vec<Given>, progress: Progress<'_>) -> Option<Result<Robust, Rejected>> {
        let (scenario, system) = (self.scenario, self.system);
        let (first, last) = (&slabs[0], &slabs[slabs.len() - 1]);
        let duration = scenario.bounds(scenario.duration).hi();
        if first.times[0] != 0.0 || last.time().hi() < duration {
            return Some(Err(refuted("slabs", "they do not cover the run")));
        }
        let start = start_errors(scenario, system).concat();
        if !first.passage.0[0].holds(&start) {
            return Some(Err(refuted("slabs", "the start is not in the first ellipsoid")));
        }
        let room = Interval::from_decimal(&self.claims.room).unwrap_or(Interval::ENTIRE);
        let done = AtomicUsize::new(0);
        let goes_on = || {
            let part = done.load(Ordering::Relaxed) as f64 / slabs.len() as f64;
            progress(SHARE * part.min(1.0)).is_continue()
        };
        let slab = |k: usize| {
            let before = k.checked_sub(1).map(|before| &slabs[before]);
            let upper = Interval::point(room.hi());
            let found = slabs[k].check(before, system, self.spread, upper, &goes_on);
            done.fetch_add(1, Ordering::Relaxed);
            found
        };
        let found: Vec<_> = (0..slabs.len()).into_par_iter().map(slab).collect::<Option<_>>()?;
        let mut rate = f64::INFINITY;
        for (k, found) in found.into_iter().enumerate() {
            match found {
                Ok(found) => rate = rate.min(found),
                Err(lacks) => return Some(Err(refuted(&format!("slabs[{k}]"), lacks.words(&slabs[k])))),
            }
        }
        let rest = |fraction: f64| progress(SHARE + (1.0 - SHARE) * fraction);
        let seen = Inside::of(scenario, system, self.spread, &slabs, &rest)?;
        let about = About { spread: self.spread, rate, room: room.midpoint() };
        let robust = Robust::new(scenario, system.joints(), slabs, &about, &seen);
        Some(self.claims.hold(&robust).map(|()| robust))
    }
}

impl Lacks {
    /// In words, of `slab`.
    fn words(self, slab: &Given) -> String {
        let from = |k: usize| format!("at t = {} s", short(slab.times[k], 5));
        match self {
            Self::Joint => format!("{} it does not join the slab before", from(0)),
            Self::Around => format!(
                "{} errors so many times as large are not known to lie in the ellipsoid around them",
                from(0)
            ),
            Self::Way(k) => {
                format!("{} errors were not shown to stay until {} s", from(k), short(slab.times[k + 1], 5))
            }
        }
    }
}

impl Claims {
    /// Every bound that is claimed, with its place.
    fn bounds(&self) -> Vec<(&'static str, Vec<Option<&String>>)> {
        vec![
            ("error", every(&self.error)),
            ("velocity_error", every(&self.velocity_error)),
            ("velocity", self.velocity.iter().map(Option::as_ref).collect()),
            ("deflection", self.deflection.iter().map(Option::as_ref).collect()),
            ("torque", self.torque.iter().map(Option::as_ref).collect()),
            ("torque_rate", self.torque_rate.iter().map(Option::as_ref).collect()),
        ]
    }

    /// That they are numbers of a robot of `n` joints.
    fn are_numbers(&self, n: usize) -> Result<(), Rejected> {
        for (what, text) in [("room", &self.room), ("rate", &self.rate)] {
            if !is_decimal(text) {
                return Err(malformed(format!("claims.{what}"), format!("'{text}' is no number")));
            }
        }
        if Interval::from_decimal(&self.room).is_none_or(|room| room.lo() < 1.0 || !room.hi().is_finite()) {
            return Err(malformed("claims.room", "must be 1 or more"));
        }
        for (what, texts) in self.bounds() {
            let wanted = if what.ends_with("error") { 2 * n } else { n };
            if texts.len() != wanted {
                return Err(malformed(format!("claims.{what}"), format!("must be {wanted} numbers")));
            }
            if let Some(text) = texts.into_iter().flatten().find(|text| !is_decimal(text)) {
                return Err(malformed(format!("claims.{what}"), format!("'{text}' is no number")));
            }
        }
        Ok(())
    }

    /// That they are no more than what was found.
    fn hold(&self, found: &Robust) -> Result<(), Rejected> {
        let there = [
            &found.error,
            &found.velocity_error,
            &found.velocity.bound,
            &found.deflection.bound,
            &found.torque.bound,
            &found.torque_rate.bound,
        ];
        rate_holds(&self.rate, found.rate)?;
        self.bounds()
            .into_iter()
            .zip(there)
            .try_for_each(|((what, texts), there)| bounds_hold(what, &texts, there))
    }
}
