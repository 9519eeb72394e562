//! The law and the model at given states.

use flexure_core::control::Input;
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, LinkMatrices, Links, Motion};
use flexure_core::reference::Reference;
use serde::Serialize;

use crate::io::{Problems, Robot, Scenario, StateRow};
use crate::registry::{AnyReference, Law, RobotVisitor, law, vector, with_robot};

/// The law at one state: a line of `flexure eval`.
#[expect(non_snake_case, reason = "keys of the contract")]
#[derive(Clone, Debug, Serialize)]
pub struct LawRow {
    /// Time in s.
    pub t: f64,
    /// Motor torque [N m].
    pub u_m: Vec<f64>,
    /// Link torque that the springs should give [N m].
    pub u_l: Vec<f64>,
    /// Motor position that would give it, in rad.
    pub q_md: Vec<f64>,
    /// Link position error in rad.
    pub e_l: Vec<f64>,
    /// Motor position error in rad.
    pub e_m: Vec<f64>,
    /// Link momentum error [kg m²/s].
    pub sigma_l: Vec<f64>,
    /// Motor momentum error [kg m²/s].
    pub sigma_m: Vec<f64>,
    /// Total energy in J.
    pub H: f64,
}

/// The model at one state: a line of `flexure model`.
#[expect(non_snake_case, reason = "keys of the contract")]
#[derive(Clone, Debug, Serialize)]
pub struct ModelRow {
    /// Mass matrix [kg m²].
    pub M_l: Vec<Vec<f64>>,
    /// E_l = S_l − ½ Ṁ_l [N m s/rad].
    pub E_l: Vec<Vec<f64>>,
    /// Skew-symmetric S_l [N m s/rad].
    pub S_l: Vec<Vec<f64>>,
    /// Rate of the mass matrix [kg m²/s].
    pub dM_l: Vec<Vec<f64>>,
    /// C q̇ + g of the links [N m].
    pub bias: Vec<f64>,
    /// Total energy in J.
    pub H: f64,
    /// Link accelerations [rad/s²].
    pub ddq_l: Vec<f64>,
    /// (q̇_l, q̇_m, ṗ_l, ṗ_m) under the given u_m; left out if none is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dx: Option<Vec<f64>>,
}

/// Evaluates the law of `scenario` at `states`.
///
/// # Errors
/// If the robot has too many joints or the reference is no path.
pub fn evaluate_law(scenario: &Scenario, states: &[StateRow]) -> Result<Vec<LawRow>, Problems> {
    with_robot(&scenario.robot, EvaluateLaw { scenario, states })?
}

/// Evaluates the model of `robot` at `states`.
///
/// # Errors
/// If the robot has too many joints.
pub fn evaluate_model(robot: &Robot, states: &[StateRow]) -> Result<Vec<ModelRow>, Problems> {
    with_robot(robot, EvaluateModel { states })
}

struct EvaluateLaw<'a> {
    scenario: &'a Scenario,
    states: &'a [StateRow],
}

impl RobotVisitor for EvaluateLaw<'_> {
    type Output = Result<Vec<LawRow>, Problems>;

    fn visit<L: Links<f64, N> + Sync, const N: usize>(self, robot: Fjr<f64, L, N>) -> Self::Output {
        let law: Law<N> = law(&self.scenario.controller);
        let reference = AnyReference::new(self.scenario)?;
        let row = |state: &StateRow| {
            let x = motion(state);
            let command = law.command(&robot, &x, &reference.at(state.t), &Input::ZERO);
            let sigma = robot.state(&Motion { v_l: command.s_l, v_m: command.s_m, ..x });
            LawRow {
                t: state.t,
                u_m: list(&command.u_m),
                u_l: list(&command.u_l),
                q_md: list(&command.q_md),
                e_l: list(&command.e_l),
                e_m: list(&command.e_m),
                sigma_l: list(&sigma.p_l),
                sigma_m: list(&sigma.p_m),
                H: robot.total_energy(&x),
            }
        };
        Ok(self.states.iter().map(row).collect())
    }
}

struct EvaluateModel<'a> {
    states: &'a [StateRow],
}

impl RobotVisitor for EvaluateModel<'_> {
    type Output = Vec<ModelRow>;

    fn visit<L: Links<f64, N> + Sync, const N: usize>(self, robot: Fjr<f64, L, N>) -> Self::Output {
        let row = |state: &StateRow| {
            let x = motion(state);
            let matrices = LinkMatrices::new(&robot.links, &x.q_l, &x.v_l);
            let dx = state.u_m.as_deref().map(|u_m| {
                let dx = robot.workless_dynamics(&robot.state(&x), &vector(u_m));
                [dx.q_l, dx.q_m, dx.p_l, dx.p_m].iter().flat_map(list).collect()
            });
            ModelRow {
                M_l: rows(&matrices.mass),
                E_l: rows(&matrices.workless()),
                S_l: rows(&matrices.skew),
                dM_l: rows(&matrices.mass_rate),
                bias: list(&robot.links.inverse_dynamics(&x.q_l, &x.v_l, &x.v_l, &Vector::ZERO)),
                H: robot.total_energy(&x),
                ddq_l: list(&robot.link_acceleration(&x)),
                dx,
            }
        };
        self.states.iter().map(row).collect()
    }
}

fn motion<const N: usize>(state: &StateRow) -> Motion<f64, N> {
    Motion {
        q_l: vector(&state.q_l),
        q_m: vector(&state.q_m),
        v_l: vector(&state.dq_l),
        v_m: vector(&state.dq_m),
    }
}

fn list<const N: usize>(v: &Vector<f64, N>) -> Vec<f64> {
    v.0.to_vec()
}

fn rows<const N: usize>(m: &Matrix<f64, N, N>) -> Vec<Vec<f64>> {
    m.0.iter().map(|row| row.to_vec()).collect()
}
