//! How far simulation and log are apart.

use serde::Serialize;

use crate::logs::Log;
use crate::replay::closed_loop::Signals;
use crate::robot::JointKind;
use crate::scenario::Scenario;
use crate::simulate::Trace;
use crate::units::{self, Unit};

/// Simulation minus log, of one signal of one joint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Residual {
    /// Root mean square over the samples, in the unit of the signal.
    pub rms: f64,
    /// Largest absolute value.
    pub max: f64,
    /// When that was \[s\].
    pub time: f64,
    /// Root mean square of the logged signal about its mean: what there was to explain.
    pub signal: f64,
}

/// Residuals of one joint; none where the log has no such signal. Positions and deflections in rad, torques in N m.
#[derive(Clone, Debug, Serialize)]
pub struct JointResiduals {
    /// Name of the joint.
    pub name: String,
    /// Link position predicted from the beginning of each window.
    pub predicted_q_l: Option<Residual>,
    /// Motor position, the same.
    pub predicted_q_m: Option<Residual>,
    /// Deflection q_m − q_l, the same.
    pub predicted_deflection: Option<Residual>,
    /// Link position of the closed loop.
    pub loop_q_l: Option<Residual>,
    /// Motor position of the closed loop.
    pub loop_q_m: Option<Residual>,
    /// Deflection of the closed loop.
    pub loop_deflection: Option<Residual>,
    /// Motor torque of the closed loop.
    pub loop_u_m: Option<Residual>,
}

/// Log and simulations side by side.
pub(super) struct Sheet<'a> {
    pub scenario: &'a Scenario,
    pub log: &'a Log,
    pub closed: &'a Signals,
    pub predicted: &'a Signals,
}

/// A number per sample and joint.
type Values = Vec<f64>;

impl Sheet<'_> {
    /// Of each joint.
    pub fn residuals(&self) -> Vec<JointResiduals> {
        let Self { scenario, log, closed, predicted } = self;
        let (q_l, q_m) = (log.q_l.as_ref(), log.q_m.as_ref());
        let deflection = self.logged_deflection();
        let wound = |simulated: &Signals| difference(&simulated.q_m, &simulated.q_l);
        let (wound_alone, wound_in_loop) = (wound(predicted), wound(closed));
        let joint = |i: usize| {
            let of = |simulated: &Values, logged: Option<&Values>| self.residual(i, simulated, logged?);
            JointResiduals {
                name: scenario.robot.joints[i].name.clone(),
                predicted_q_l: of(&predicted.q_l, q_l),
                predicted_q_m: of(&predicted.q_m, q_m),
                predicted_deflection: of(&wound_alone, deflection.as_ref()),
                loop_q_l: of(&closed.q_l, q_l),
                loop_q_m: of(&closed.q_m, q_m),
                loop_deflection: of(&wound_in_loop, deflection.as_ref()),
                loop_u_m: of(&closed.u_m, Some(&log.u_m)),
            }
        };
        (0..log.joints).map(joint).collect()
    }

    fn logged_deflection(&self) -> Option<Values> {
        Some(difference(self.log.q_m.as_ref()?, self.log.q_l.as_ref()?))
    }

    /// Of joint `i`, over the samples that have a simulation; none if there is no such sample.
    fn residual(&self, i: usize, simulated: &Values, logged: &Values) -> Option<Residual> {
        let log = self.log;
        let of_joint =
            |values: &Values| values.iter().skip(i).step_by(log.joints).copied().collect::<Vec<_>>();
        let (simulated, logged) = (of_joint(simulated), of_joint(logged));
        let pairs =
            || (0..).zip(simulated.iter().zip(&logged)).filter(|(_, (simulated, _))| simulated.is_finite());
        let count = pairs().count() as f64;
        let mean = pairs().map(|(_, (_, logged))| logged).sum::<f64>() / count;
        let rms = |sum: f64| (sum / count).sqrt();
        let (k, max) = pairs()
            .map(|(k, (simulated, logged))| (k, (simulated - logged).abs()))
            .max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Residual {
            rms: rms(pairs().map(|(_, (simulated, logged))| (simulated - logged).powi(2)).sum()),
            max,
            time: log.time(k),
            signal: rms(pairs().map(|(_, (_, logged))| (logged - mean).powi(2)).sum()),
        })
    }

    /// Everything over time.
    pub fn trace(&self) -> Trace {
        let Self { log, closed, predicted, .. } = self;
        let deflection = self.logged_deflection();
        let residual = |simulated: &Values, logged: Option<&Values>| Some(difference(simulated, logged?));
        let (q_l, q_m) = (log.q_l.as_ref(), log.q_m.as_ref());
        let wound = |simulated: &Signals| Some(difference(&simulated.q_m, &simulated.q_l));
        let signals: [(&str, Unit, Option<Values>); 17] = [
            ("q_l", units::ANGLE, q_l.cloned()),
            ("q_m", units::ANGLE, q_m.cloned()),
            ("deflection", units::ANGLE, deflection.clone()),
            ("u_m", units::TORQUE, Some(log.u_m.clone())),
            ("q_l_loop", units::ANGLE, Some(closed.q_l.clone())),
            ("q_m_loop", units::ANGLE, Some(closed.q_m.clone())),
            ("deflection_loop", units::ANGLE, wound(closed)),
            ("u_m_loop", units::TORQUE, Some(closed.u_m.clone())),
            ("q_l_predicted", units::ANGLE, Some(predicted.q_l.clone())),
            ("q_m_predicted", units::ANGLE, Some(predicted.q_m.clone())),
            ("deflection_predicted", units::ANGLE, wound(predicted)),
            ("q_l_loop_residual", units::ANGLE, residual(&closed.q_l, q_l)),
            ("q_m_loop_residual", units::ANGLE, residual(&closed.q_m, q_m)),
            ("u_m_loop_residual", units::TORQUE, residual(&closed.u_m, Some(&log.u_m))),
            ("q_l_residual", units::ANGLE, residual(&predicted.q_l, q_l)),
            ("q_m_residual", units::ANGLE, residual(&predicted.q_m, q_m)),
            (
                "deflection_residual",
                units::ANGLE,
                wound(predicted).and_then(|wound| residual(&wound, deflection.as_ref())),
            ),
        ];
        let there: Vec<_> =
            signals.iter().filter_map(|(name, unit, values)| Some((name, unit, values.as_ref()?))).collect();
        let names = there.iter().flat_map(|(name, unit, _)| {
            let joint = |(i, kind): (usize, JointKind)| (format!("{name}{}", i + 1), unit.of(kind).plain);
            self.scenario.robot.kinds().into_iter().enumerate().map(joint).collect::<Vec<_>>()
        });
        let mut trace = Trace::new(std::iter::once(("t".to_owned(), units::TIME.plain)).chain(names));
        for k in 0..log.samples() {
            let rows = there.iter().flat_map(|(.., values)| &values[k * log.joints..(k + 1) * log.joints]);
            trace.push(&std::iter::once(log.time(k)).chain(rows.copied()).collect::<Vec<_>>());
        }
        trace
    }
}

fn difference(a: &[f64], b: &[f64]) -> Values {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}
