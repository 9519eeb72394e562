//! What a running loop remembers, piece by piece.

use flexure_core::guard::{Phase, Place};
use flexure_core::linalg::Vector;
use flexure_core::memory::{Memory, Port};
use flexure_core::model::Motion;
use flexure_core::reference::Stop;
use flexure_core::scalar::Jet;

use crate::imperfections::stages::{Pieces, Tick};
use crate::simulate::collocation::Past;
use crate::simulate::controller::{Action, Compensation, Controller, Said};
use crate::simulate::feedback::Feedback;
use crate::simulate::gauss::{Integrator, Order};
use crate::simulate::guarded::Guarded;
use crate::simulate::ledger::Ledger;
use crate::simulate::newton::Anchor;
use crate::simulate::remembered::Remembered;
use crate::simulate::simulation::{Balance, Cause, Divergence, Happened, Simulation, World};
use crate::simulate::stepper::Stepper;
use crate::simulate::stepping::Stepping;

/// Motion, then the last instant, energy balance, controller, integrator, and how the loop diverged, if it did.
impl<L, R, F, E, const N: usize> Memory<f64> for Simulation<L, R, F, E, N>
where
    F: Feedback<L, N>,
    E: Memory<f64>,
{
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        let Self { controller, world, timing, motion, last, balance, divergence } = self;
        port.part("motion", motion);
        port.enter("instant");
        port.optional("there", last, Happened::nothing(timing.period), |last, port| last.memory(port));
        port.leave();
        let Balance { start, worst, scale } = balance;
        for (name, x) in [("start", start), ("worst", worst), ("scale", scale)] {
            port.number(name, "J", x);
        }
        port.part("controller", controller);
        let World { plant: _, pushes: _, stepper, ledger } = world;
        let Ledger { supplied, dissipated, throughput } = ledger;
        for (name, x) in [("supplied", supplied), ("dissipated", dissipated), ("throughput", throughput)] {
            port.number(name, "J", x);
        }
        port.part("integrator", stepper);
        let none = Divergence { time: 0.0, magnitude: 0.0, cause: Cause::Unbounded };
        port.enter("diverged");
        port.optional("there", divergence, none, |Divergence { time, magnitude, cause }, port| {
            port.number("time", "s", time);
            port.number("magnitude", "", magnitude);
            let mut code =
                Cause::ALL.iter().zip(0..).find(|(known, _)| *known == cause).map_or(0, |(_, code)| code);
            port.word("cause", &mut code);
            *cause = Cause::ALL.get(code as usize).copied().unwrap_or(*cause);
        });
        port.leave();
    }
}

/// Sensors, estimator, disturbance observer, guard, computer, watchdog, drive; torque since the last instant and how the reference is joined again.
impl<L, R, F, E, const N: usize> Memory<f64> for Controller<L, R, F, E, N>
where
    F: Feedback<L, N>,
    E: Memory<f64>,
{
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        let Self {
            robot: _,
            reference: _,
            law,
            sensors,
            estimator,
            disturbance,
            guard,
            computer,
            watchdog,
            actuator,
            state,
        } = self;
        port.part("sensors", sensors);
        if let Some(estimator) = estimator {
            port.part("estimator", estimator);
        }
        if let Some(Compensation { observer, compensate: _ }) = disturbance {
            port.part("disturbance_observer", observer);
        }
        if let Some(Guarded { guard, coasting, residual, rejoin: _, settle: _ }) = guard {
            port.part("guard", guard);
            port.part("coasting", coasting);
            if let Some(residual) = residual {
                port.part("residual", residual);
            }
        }
        port.part("computer", computer);
        if let Some(watchdog) = watchdog {
            port.part("watchdog", watchdog);
        }
        port.part("drive", actuator);
        port.joints("u_reported", "N m", &mut state.applied.0);
        let none = Stop { from: Vector([Jet::value(0.0); N]), start: 0.0, duration: 0.0 };
        port.enter("rejoined");
        port.optional("there", &mut state.rejoined, none, |Stop { from, start, duration }, port| {
            series("from", from, port);
            port.number("start", "s", start);
            port.number("duration", "s", duration);
        });
        port.leave();
        let parts = law.memory();
        if !parts.is_empty() {
            port.enter("law");
            port.optional("there", &mut state.remembered, Remembered::NONE, |remembered, port| {
                remembered.walk(parts, port);
            });
            port.leave();
        }
    }
}

impl<const N: usize> Happened<N> {
    /// What stands for nothing while nothing has happened.
    fn nothing(period: f64) -> Self {
        let zero = Vector::ZERO;
        let action = Action {
            reference: Vector([Jet::value(0.0); N]),
            measured: Motion::at_rest(zero),
            seen: Motion::at_rest(zero),
            disturbance: zero,
            u_m: zero,
            applied: Pieces::constant(zero),
            reported: zero,
            certificate: true,
            stopped: false,
            guard: None,
        };
        Self { tick: Tick::new(0, period), action, energy: 0.0, residual: 0.0 }
    }

    fn memory(&mut self, port: &mut dyn Port<f64>) {
        let Self { tick, action, energy, residual } = self;
        port.long("number", &mut tick.k);
        *tick = Tick::new(tick.k, tick.period);
        let Action {
            reference,
            measured,
            seen,
            disturbance,
            u_m,
            applied,
            reported,
            certificate,
            stopped,
            guard,
        } = action;
        series("q_ld", reference, port);
        port.part("measured", measured);
        port.part("seen", seen);
        port.joints("disturbance_m", "N m", &mut disturbance.0);
        port.joints("u_command", "N m", &mut u_m.0);
        port.part("u_m", applied);
        port.joints("u_m_measured", "N m", &mut reported.0);
        port.flag("certificate", certificate);
        port.flag("stopped", stopped);
        let nothing = Said { phase: Phase::Following, fault: None };
        port.optional("guarded", guard, nothing, |Said { phase, fault }, port| {
            phase.walk(port);
            Place::walk(fault, port);
        });
        port.number("hamiltonian", "J", energy);
        port.number("energy_residual", "J", residual);
    }
}

/// The torque at the beginning, and when and to what it changes, if it does.
impl<const N: usize> Memory<f64> for Pieces<N> {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        let Self { first, change } = self;
        port.joints("first", "N m", &mut first.0);
        port.optional("changes", change, (0.0, Vector::ZERO), |(offset, then), port| {
            port.number("offset", "s", offset);
            port.joints("then", "N m", &mut then.0);
        });
    }
}

/// Steps so far; then what the method remembers: the last good step and what it leaves for the next, or hysteresis and accelerations.
impl<const N: usize> Memory<f64> for Stepper<N> {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        match self {
            Self::Smooth(Integrator { low: _, high: _, tolerance: _, order, step, steps, past }) => {
                port.long("steps", steps);
                port.number("step", "s", step);
                let mut high = *order == Order::Eight;
                port.flag("high_order", &mut high);
                *order = if high { Order::Eight } else { Order::Four };
                past.memory(port);
            }
            Self::Rough(Stepping { longest: _, hysteresis, last: [a_l, a_m], steps }) => {
                port.long("steps", steps);
                port.joints("hysteresis", "N m", &mut hysteresis.0);
                port.joints("ddq_l", "rad/s^2", &mut a_l.0);
                port.joints("ddq_m", "rad/s^2", &mut a_m.0);
            }
        }
    }
}

impl<const N: usize> Past<N> {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        const STAGES: [[&str; 4]; 2] = [["a_l1", "a_l2", "a_l3", "a_l4"], ["f_m1", "f_m2", "f_m3", "f_m4"]];
        let Self { anchor: Anchor { q: [q_l, q_m], h }, contraction, stages, link, motor } = self;
        port.enter("last");
        port.joints("q_l", "rad", &mut q_l.0);
        port.joints("q_m", "rad", &mut q_m.0);
        port.number("step", "s", h);
        port.number("contraction", "", contraction);
        let mut code = u32::try_from(*stages).unwrap_or(0);
        port.word("stages", &mut code);
        *stages = code as usize;
        for (names, sides) in STAGES.iter().zip([link, motor]) {
            for (i, name) in names.iter().enumerate() {
                let mut stage = sides.map(|stages| stages[i]);
                port.joints(name, "rad/s^2", &mut stage);
                for (stages, value) in sides.iter_mut().zip(stage) {
                    stages[i] = value;
                }
            }
        }
        port.leave();
    }
}

/// A coefficient after the other, a number per joint each.
pub(super) fn series<const K: usize, const N: usize>(
    name: &'static str,
    x: &mut Vector<Jet<f64, K>, N>,
    port: &mut dyn Port<f64>,
) {
    const ORDERS: [(&str, &str); 5] = [
        ("order0_", "rad"),
        ("order1_", "rad/s"),
        ("order2_", "rad/s^2"),
        ("order3_", "rad/s^3"),
        ("order4_", "rad/s^4"),
    ];
    port.enter(name);
    let mut orders: [[f64; N]; K] = std::array::from_fn(|k| x.map(|jet| jet.coefficient(k)).0);
    for ((order, unit), values) in ORDERS.into_iter().zip(&mut orders) {
        port.joints(order, unit, values);
    }
    *x = Vector::from_fn(|i| Jet::new(orders.map(|values| values[i])));
    port.leave();
}
