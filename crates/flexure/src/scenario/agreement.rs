//! Whether the parts of a real loop can be meant together.

use crate::estimators::{Encoders, Estimator};
use crate::files::table::Table;
use crate::imperfections::document::{Context, Found};
use crate::imperfections::{
    Dropout, Encoder, Kind, Noise, Outage, Overlap, Sampling, Saturation, Side, Spring, TorqueRate,
    VelocityFilter,
};
use crate::laws::Controller;
use crate::scenario::document::Hold;
use crate::scenario::guard::GuardSettings;
use crate::scenario::integration::{self, midpoint};
use crate::scenario::plant::Plant;

/// What to do where hold is "continuous" and must not be.
const HELD: &str = "remove hold: the torque is then held between control instants";

/// Why `controller` cannot act with this hold, if it cannot, and what to do.
pub(crate) fn against_hold(controller: &Controller, hold: Hold) -> Option<(String, &'static str)> {
    (hold == Hold::Continuous && !controller.memory().is_empty()).then(|| {
        let kind = controller.kind();
        let message =
            format!("hold is \"continuous\", but the memory of '{kind}' moves from instant to instant");
        (message, HELD)
    })
}

/// The parts of a scenario that a real loop is made of.
pub(crate) struct Loop<'a> {
    pub root: &'a Table<'a>,
    pub context: &'a Context<'a>,
    pub found: &'a [Found<'a>],
    pub hold: Hold,
    pub plant: &'a Plant,
    pub estimator: Option<&'a Estimator>,
    pub guard: Option<&'a GuardSettings>,
    /// Whether the law, a guard or an observer goes by velocities.
    pub reads_velocities: bool,
}

/// Notes an error for all that contradicts itself, and warnings for what is hardly meant.
pub(crate) fn agree(real: &Loop<'_>) {
    real.repeated();
    real.continuous();
    real.velocities();
    real.placement();
    real.bandwidth();
    real.hardening();
    real.limits();
    real.ages();
    real.unguarded();
    real.unlimited();
    real.integration();
}

impl<'a> Loop<'a> {
    /// The entries of kind `K` and what they say.
    fn all<K: Kind>(&self) -> impl Iterator<Item = (&'a Found<'a>, &'a K)> {
        self.found.iter().filter_map(|found| Some((found, found.what.of()?)))
    }

    /// The first of them.
    fn first<K: Kind>(&self) -> Option<(&'a Found<'a>, &'a K)> {
        self.all().next()
    }

    /// Each kind once, or once a side; what comes and goes as often as wanted.
    fn repeated(&self) {
        for (i, second) in self.found.iter().enumerate() {
            let mut earlier = self.found.iter().take(i);
            let clash = earlier.find_map(|first| Some((first, second.what.overlap(&first.what)?)));
            let Some((first, overlap)) = clash else { continue };
            let what = match overlap {
                Overlap::Whole => String::new(),
                Overlap::On(side) => format!(" on the {} side", side.name()),
            };
            let kind = second.what.kind();
            let message = format!("a second {kind}{what}; the first is in line {}", first.field.line());
            second.field.error(
                "contradiction",
                message,
                format!("put both into one entry of kind \"{kind}\", or remove one"),
            );
        }
    }

    /// Devices sample: there is no continuous time in them.
    fn continuous(&self) {
        if self.hold != Hold::Continuous {
            return;
        }
        let device = self.found.iter().find(|found| found.what.is_of_devices());
        let device = device.map(|found| (found.field.clone(), found.what.kind()));
        let tables = ["estimator", "disturbance_observer", "guard"];
        let table = tables.iter().find_map(|&key| Some((self.root.get(key)?, key)));
        if let (Some((field, what)), Some(hold)) = (device.or(table), self.root.get("hold")) {
            let message = format!(
                "{what}, but hold is \"continuous\" in line {}: the law runs at every instant",
                hold.line()
            );
            field.error("contradiction", message, HELD);
        }
        if let (Some(field), Some(hold)) = (midpoint(self.root), self.root.get("hold")) {
            let message = format!(
                "integration is \"midpoint\", but hold is \"continuous\" in line {}: steps of one length do not follow a stiff law",
                hold.line()
            );
            field.error("contradiction", message, "remove one of them");
        }
    }

    /// One source of velocities; what is measured of them is used.
    fn velocities(&self) {
        let filter = self.first::<VelocityFilter>().map(|(filter, _)| filter);
        let estimator = self.root.get("estimator");
        if let (Some(filter), Some(estimator)) = (filter, &estimator) {
            let message =
                format!("velocity-filter, but [estimator] in line {} gives velocities too", estimator.line());
            filter.field.error("contradiction", message, "remove one of them");
        }
        let source = match (filter, &estimator) {
            (Some(filter), _) => Some(&filter.field),
            (_, estimator) => estimator.as_ref(),
        };
        let Some(source) = source else {
            for (found, Encoder { .. }) in self.all().filter(|_| self.reads_velocities) {
                found.field.warn(
                    "exact-velocity",
                    "encoder, but velocities stay exact",
                    "add [[imperfection]] kind = \"velocity-filter\", or [estimator]",
                );
            }
            return;
        };
        for (found, Noise { link_velocity, motor_velocity, .. }) in self.all() {
            if link_velocity.iter().chain(motor_velocity).any(|&x| x != 0.0) {
                let message = format!(
                    "noise on velocities, but they are computed from positions, as line {} says",
                    source.line()
                );
                found.field.error("contradiction", message, "remove link_velocity and motor_velocity");
            }
        }
    }

    /// What is needed is measured.
    fn placement(&self) {
        let Some((entry, Encoder { .. })) = self.first() else { return };
        let placed = |side| self.all().any(|(_, encoder): (_, &Encoder)| encoder.resolution(side).is_some());
        let (need, hint): (&[Side], _) = match self.estimator {
            Some(Estimator::Observer { encoders: Encoders::Motor, .. }) => {
                (&[Side::Motor], "add an encoder with placement = \"motor\"")
            }
            Some(Estimator::Observer { encoders: Encoders::Both, .. }) => {
                (&Side::ALL, "add the other encoder, or let [estimator] use encoders = \"motor\"")
            }
            None => (
                &Side::ALL,
                "add the other encoder, or [estimator] kind = \"observer\" with encoders = \"motor\"",
            ),
        };
        if let Some(missing) = need.iter().find(|&&side| !placed(side)) {
            let who = match (self.root.get("estimator"), self.first::<VelocityFilter>()) {
                (Some(field), _) => format!("[estimator] in line {}", field.line()),
                (_, Some((filter, _))) => format!("velocity-filter in line {}", filter.field.line()),
                _ => "the law without [estimator]".to_owned(),
            };
            let message = format!("no encoder on the {} side, but {who} needs one", missing.name());
            entry.field.error("contradiction", message, hint);
        }
    }

    /// The gains of an observer with motor encoders only assume that it is slower than its period.
    fn bandwidth(&self) {
        let Some(Estimator::Observer { encoders: Encoders::Motor, bandwidth }) = self.estimator else {
            return;
        };
        let (Some((_, period)), Some(field)) = (self.context.times, self.root.get("estimator")) else {
            return;
        };
        if let Some(fast) = bandwidth.iter().find(|&&bandwidth| bandwidth * period >= 1.0) {
            let message = format!(
                "estimator.bandwidth is {fast} rad/s, must be < {} rad/s, one over the control period",
                1.0 / period
            );
            field.error("range", message, "with encoders = \"motor\"; a tenth of that is a good start");
        }
    }

    /// How smooth plants are integrated is of no effect on others, and a tolerance of none on steps of one length, whose errors nobody estimates.
    fn integration(&self) {
        if let Some(found) = self.found.iter().find(|found| found.what.is_rough()) {
            for field in integration::KEYS.iter().filter_map(|key| self.root.get(key)) {
                let message = format!(
                    "{} in line {} makes the robot one that is stepped at 0.1 ms, whatever {} is",
                    found.what.kind(),
                    found.field.line(),
                    field.path
                );
                let help = "smooth robots are integrated by it: those without friction, play and hysteresis";
                field.warn("unused", message, help);
            }
            return;
        }
        let Some(midpoint) = midpoint(self.root) else { return };
        let message = "integration is \"midpoint\": steps of at most 1 ms, whose errors are not estimated";
        let help = "good for sweeps and batches of many loops; margins, tune and compare go by collocation whatever it is";
        midpoint.warn("midpoint", message.to_owned(), help);
        if let Some(field) = self.root.get("integration_tolerance") {
            let message = format!(
                "integration is \"midpoint\" in line {}: steps of at most 1 ms, whatever integration_tolerance is",
                midpoint.line()
            );
            field.warn("unused", message, "remove one of them");
        }
    }

    /// One place for the hardening of springs.
    fn hardening(&self) {
        let Some((spring, Spring { .. })) = self.first() else { return };
        if let (Some(own), Some(field), true) = (
            spring.table.get("hardening"),
            self.root.get("plant").and_then(|plant| plant.any_table()?.get("spring_hardening")),
            self.plant.spring_hardening.is_some(),
        ) {
            let message = format!(
                "{} and {} in line {} both say how springs harden",
                own.path,
                field.path,
                field.line()
            );
            own.error("contradiction", message, "remove one of them");
        }
    }

    /// Limits that do not undo each other.
    fn limits(&self) {
        let saturation = self.first().map(|(found, Saturation { limit })| (found, limit));
        let torque =
            saturation.map(|(_, limit)| limit).or(self.context.robot.map(|robot| &robot.limits.torque));
        let rates = self.first().map(|(found, TorqueRate { limit })| (found, limit));
        if let Some(guard) = self.guard {
            self.keeps_to(("torque_limit", "N m"), &guard.torque_limit, saturation);
            // A guard need not know of rates at all.
            let rates = rates.filter(|_| guard.torque_rate_limit.iter().all(|rate| rate.is_finite()));
            self.keeps_to(("torque_rate_limit", "N m/s"), &guard.torque_rate_limit, rates);
        }
        if let (Some(torque), Some((found, rate)), Some((duration, _))) = (torque, rates, self.context.times)
        {
            let slow = torque.iter().zip(rate).position(|(t, r)| t.is_finite() && t / r > duration);
            if let Some((i, torque, rate)) = slow.and_then(|i| Some((i, torque.get(i)?, rate.get(i)?))) {
                let message = format!(
                    "at {rate} N m/s joint {} takes {:.4} s to its torque limit, {torque} N m, must be <= duration, {duration} s",
                    i + 1,
                    torque / rate
                );
                found.field.error("range", message, "drives do it in milliseconds; is the rate in N m/ms?");
            }
        }
    }

    /// A limit of the guard is not above that of the drive.
    fn keeps_to(&self, (key, unit): (&str, &str), guard: &[f64], drive: Option<(&Found<'_>, &Vec<f64>)>) {
        let (Some((found, drive)), Some(field)) = (drive, self.root.get("guard")) else { return };
        let Some((i, (low, high))) = larger(guard, drive) else { return };
        let given = field.any_table().and_then(|table| table.get(key));
        let message = format!(
            "the guard lets {high} {unit} through for joint {}, must be <= {low} {unit}, the {} in line {}",
            i + 1,
            found.what.kind(),
            found.field.line()
        );
        let hint =
            format!("a guard knows of limits that it keeps to: set guard.{key} to the drive's or less");
        given.unwrap_or(field).error("contradiction", message, hint);
    }

    /// A guard must not take for dead what is only slow.
    fn ages(&self) {
        let Some(guard) = self.guard else { return };
        for (found, Sampling { periods, .. }) in self.all() {
            let needed = periods - 1;
            if needed > guard.max_age {
                let message = format!(
                    "readings become {needed} control periods old, guard.max_age is {}",
                    guard.max_age
                );
                found.field.error(
                    "contradiction",
                    message,
                    format!("set guard.max_age to {needed} or more: the guard would stop the robot at once"),
                );
            }
        }
    }

    /// A robot whose sensors fail is stopped by somebody.
    fn unguarded(&self) {
        if self.guard.is_some() {
            return;
        }
        let fails = |(_, dropout): &(_, &Dropout)| !matches!(dropout.outage, Outage::Random { probability, .. } if probability == 0.0);
        if let Some((found, _)) = self.all().find(fails) {
            found.field.warn(
                "unguarded",
                "dropout, but there is no guard: the law goes on with what it reads",
                "add [guard] with stop_damping",
            );
        }
    }

    /// Until a fault is found the law answers it: something must bound the answer.
    fn unlimited(&self) {
        let (Some(guard), Some(field)) = (self.guard, self.root.get("guard")) else { return };
        let limits = guard.torque_limit.iter().zip(&guard.torque_rate_limit);
        if limits.clone().any(|(torque, rate)| torque.is_infinite() && rate.is_infinite()) {
            field.warn(
                "unlimited",
                "the guard limits neither torques nor their rates",
                "a reading that lies is answered by the law until that is found: set torque_limit or torque_rate_limit, in [guard] or \
                 in the [limits] of the robot",
            );
        }
    }
}

/// The first entry of `a` that is larger than that of `b`: index, and (of b, of a).
fn larger(a: &[f64], b: &[f64]) -> Option<(usize, (f64, f64))> {
    b.iter().copied().zip(a.iter().copied()).enumerate().find(|(_, (b, a))| a > b)
}
