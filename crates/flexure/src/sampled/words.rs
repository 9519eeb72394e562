//! What is said of a sampled loop.

use crate::files::number::short;
use crate::files::{Problem, quantity::shortest};
use crate::sampled::advice::{Advice, Move};
use crate::sampled::{Place, ROUNDING, Sampled};
use crate::scenario::Scenario;

/// What is to be said of a loop that [passes](Sampled::passes).
const PASSING: &str = " on the whole way along the reference; a robot that stood there would not be stable";

impl Sampled {
    /// In one line.
    pub fn line(&self) -> String {
        format!("sampled loop: {}", self.words())
    }

    /// The same without what it is of.
    pub fn words(&self) -> String {
        let at = self.at();
        let digits = if (self.spectral_radius - 1.0).abs() < 0.01 { 7 } else { 4 };
        let radius = short(self.spectral_radius, digits);
        match (self.stable, &self.joint) {
            (true, _) if self.is_neutral() => {
                format!("spectral radius {radius} {at}: no small error grows, and some do not shrink")
            }
            (true, _) => format!(
                "spectral radius {radius} {at}; small errors shrink by {} 1/s{}",
                short(self.rate, 4),
                if self.passes() { PASSING } else { "" }
            ),
            (false, None) => format!("spectral radius {radius} {at}: unstable"),
            (false, Some(joint)) => {
                format!("spectral radius {radius} {at}: unstable, in joint {joint} most")
            }
        }
    }

    /// Where the spectral radius is the largest.
    pub(crate) fn at(&self) -> String {
        match self.place {
            Place::Start => "at the start".to_owned(),
            Place::Reference => format!("on the reference at t = {} s", short(self.time, 4)),
        }
    }

    /// Whether errors shrink on the whole way although they would grow if the robot stood at one place of it.
    pub(crate) fn passes(&self) -> bool {
        self.stable && self.spectral_radius > 1.0 + ROUNDING
    }

    /// Whether small errors stay as they are that nothing in the loop sees, as those of a conserved quantity.
    fn is_neutral(&self) -> bool {
        self.stable && (self.spectral_radius - 1.0).abs() <= ROUNDING
    }

    /// What makes it stable, where it is not.
    pub fn help(&self) -> Option<String> {
        let (advice, gain) = (self.advice.as_ref()?, self.gain.as_ref()?);
        let Advice { direction, factor, now, starting_gains, period, exchange, .. } = advice;
        let now = now.as_ref().map_or(String::new(), |now| {
            format!(
                " (now {now:?} by the starting rule: `flexure check` shows all gains, to be written down)"
            )
        });
        let first = match (direction, factor) {
            (Move::Raise, Some(factor)) => {
                format!("raise {gain}: the loop is stable with {factor} times as much")
            }
            (Move::Lower, Some(factor)) => {
                format!("lower {gain}: the loop is stable with 1/{} of it", 1.0 / factor)
            }
            (Move::Raise, None) => format!("raise {gain} first; alone it does not suffice"),
            (Move::Lower, None) => format!("lower {gain} first; alone it does not suffice"),
        };
        let first = first + &now;
        let start = (*starting_gains < 1.0).then(|| {
            format!(
                "leave the gains out: with its kind alone the law starts from others, of spectral radius {}",
                short(*starting_gains, 4)
            )
        });
        let period = period.map(|period| format!("control_period = {} is short enough", shortest(period)));
        let mut ways: Vec<String> = start.into_iter().chain(period).collect();
        match factor {
            // What suffices comes first.
            Some(_) => ways.insert(0, first),
            None => ways.push(first),
        }
        if let [_] = ways.as_slice()
            && factor.is_none()
        {
            ways.push(
                "less delay, faster filters and estimators, softer gains on both sides: neither one gain, nor the starting gains, nor \
                 a shorter period makes it stable; `flexure tune` searches for gains that do"
                    .to_owned(),
            );
        }
        let why = exchange
            .as_ref()
            .map_or(String::new(), |exchange| format!("{exchange} is too fast for the control period;\n"));
        Some(format!("{why}{}", ways.join(";\nor ")))
    }

    /// The problem that it is, if it is not stable.
    pub fn problem(&self, scenario: &Scenario) -> Option<Problem> {
        let help = self.help().unwrap_or_else(|| {
            "the slope of the law is no number there: check gains and reference".to_owned()
        });
        let message = format!("{}: {}", scenario.name, self.line());
        (!self.stable).then(|| scenario.places.problem("control_period", "sampled", message, help))
    }
}
