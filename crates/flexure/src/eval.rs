//! The law and the model at given states.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, LinkMatrices, Links, Motion};
use flexure_core::reference::Reference;
use flexure_core::scalar::Jet;
use serde::Serialize;

use crate::feasible;
use crate::files::{Problem, Problems, StateFile, StateRow};
use crate::laws::{self, AnyLaw, any_law};
use crate::robot::{Robot, RobotVisitor, vector, with_robot};
use crate::scenario::Scenario;

/// The law at one state: a line of `flexure eval`. What is none is known of v-CBC only.
#[expect(non_snake_case, reason = "keys of the contract")]
#[derive(Clone, Debug, Serialize)]
pub struct LawRow {
    /// Time in s.
    pub t: f64,
    /// Motor torque [N m].
    pub u_m: Vec<f64>,
    /// Link torque that the springs should give [N m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub u_l: Option<Vec<f64>>,
    /// Motor position that would give it, in rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub q_md: Option<Vec<f64>>,
    /// Link position error in rad.
    pub e_l: Vec<f64>,
    /// Motor position error in rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub e_m: Option<Vec<f64>>,
    /// Link momentum error [kg m²/s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma_l: Option<Vec<f64>>,
    /// Motor momentum error [kg m²/s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma_m: Option<Vec<f64>>,
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
    /// Torque M q̈ + C q̇ + g that the given `ddq_l` takes [N m]; left out if none is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tau_l: Option<Vec<f64>>,
    /// Its rate along the trajectory with the given `d3q_l` [N m/s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dtau_l: Option<Vec<f64>>,
    /// Its second rate along the trajectory with the given `d4q_l` [N m/s²].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ddtau_l: Option<Vec<f64>>,
}

/// Evaluates the law of `scenario` at `states`.
///
/// # Errors
/// If the robot has too many joints, the reference is no path, or a number is not finite at one of the states.
pub fn evaluate_law(scenario: &Scenario, states: &StateFile) -> Result<Vec<LawRow>, Problems> {
    with_robot(&scenario.robot, EvaluateLaw { scenario, states })?
}

/// Evaluates the model of `robot` at `states`.
///
/// # Errors
/// If the robot has too many joints, or a number is not finite at one of the states.
pub fn evaluate_model(robot: &Robot, states: &StateFile) -> Result<Vec<ModelRow>, Problems> {
    Ok(with_robot(robot, EvaluateModel { states })??)
}

struct EvaluateLaw<'a> {
    scenario: &'a Scenario,
    states: &'a StateFile,
}

impl RobotVisitor for EvaluateLaw<'_> {
    type Output = Result<Vec<LawRow>, Problems>;

    fn visit<L: Links<f64, N> + Sync, const N: usize>(self, robot: Fjr<f64, L, N>) -> Self::Output {
        let law: AnyLaw<f64, N> = any_law(&self.scenario.controller, |x| x);
        let reference = feasible::reference::<N>(self.scenario)?;
        let row = |state: &StateRow| -> Result<LawRow, Problem> {
            let x = motion(state);
            let row = law_row(&law, &robot, state.t, &x, &reference.at(state.t));
            let given = |values: &Option<Vec<f64>>| values.clone().unwrap_or_default();
            let numbers: [(_, &[f64]); 8] = [
                ("u_m", &row.u_m),
                ("u_l", &given(&row.u_l)),
                ("q_md", &given(&row.q_md)),
                ("e_l", &row.e_l),
                ("e_m", &given(&row.e_m)),
                ("sigma_l", &given(&row.sigma_l)),
                ("sigma_m", &given(&row.sigma_m)),
                ("H", &[row.H]),
            ];
            finite(self.states, state, numbers)?;
            Ok(row)
        };
        Ok(self.states.rows.iter().map(row).collect::<Result<_, Problem>>()?)
    }
}

/// The law at the motion `x`; what only v-CBC computes on the way is left out for other laws.
fn law_row<L: Links<f64, N>, const N: usize>(
    law: &AnyLaw<f64, N>,
    robot: &Fjr<f64, L, N>,
    t: f64,
    x: &Motion<f64, N>,
    q_ld: &Vector<Jet<f64, 5>, N>,
) -> LawRow {
    let mut row = LawRow {
        t,
        u_m: Vec::new(),
        u_l: None,
        q_md: None,
        e_l: list(&(x.q_l - q_ld.map(|jet| jet.coefficient(0)))),
        e_m: None,
        sigma_l: None,
        sigma_m: None,
        H: robot.total_energy(x),
    };
    if let AnyLaw::Vcbc(law) = law {
        let command = laws::command(law, robot, x, q_ld);
        let sigma = robot.state(&Motion { v_l: command.s_l, v_m: command.s_m, ..*x });
        row.u_m = list(&command.u_m);
        row.u_l = Some(list(&command.u_l));
        row.q_md = Some(list(&command.q_md));
        row.e_m = Some(list(&command.e_m));
        row.sigma_l = Some(list(&sigma.p_l));
        row.sigma_m = Some(list(&sigma.p_m));
    } else {
        row.u_m = list(&laws::torque(law, robot, x, q_ld));
    }
    row
}

struct EvaluateModel<'a> {
    states: &'a StateFile,
}

impl RobotVisitor for EvaluateModel<'_> {
    type Output = Result<Vec<ModelRow>, Problem>;

    fn visit<L: Links<f64, N> + Sync, const N: usize>(self, robot: Fjr<f64, L, N>) -> Self::Output {
        let row = |state: &StateRow| -> Result<ModelRow, Problem> {
            let row = model_row(&robot, state);
            let numbers: [(_, &[f64]); 11] = [
                ("M_l", &row.M_l.concat()),
                ("E_l", &row.E_l.concat()),
                ("S_l", &row.S_l.concat()),
                ("dM_l", &row.dM_l.concat()),
                ("bias", &row.bias),
                ("H", &[row.H]),
                ("ddq_l", &row.ddq_l),
                ("dx", row.dx.as_deref().unwrap_or_default()),
                ("tau_l", row.tau_l.as_deref().unwrap_or_default()),
                ("dtau_l", row.dtau_l.as_deref().unwrap_or_default()),
                ("ddtau_l", row.ddtau_l.as_deref().unwrap_or_default()),
            ];
            finite(self.states, state, numbers)?;
            Ok(row)
        };
        self.states.rows.iter().map(row).collect()
    }
}

fn model_row<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>, state: &StateRow) -> ModelRow {
    let x = motion(state);
    let matrices = LinkMatrices::new(&robot.links, &x.q_l, &x.v_l);
    let dx = state.u_m.as_deref().map(|u_m| {
        let dx = robot.workless_dynamics(&robot.state(&x), &vector(u_m));
        [dx.q_l, dx.q_m, dx.p_l, dx.p_m].iter().flat_map(list).collect()
    });
    let [tau_l, dtau_l, ddtau_l] = torques(&robot.links, &x, state);
    ModelRow {
        M_l: rows(&matrices.mass),
        E_l: rows(&matrices.workless()),
        S_l: rows(&matrices.skew),
        dM_l: rows(&matrices.mass_rate),
        bias: list(&robot.links.inverse_dynamics(&x.q_l, &x.v_l, &x.v_l, &Vector::ZERO)),
        H: robot.total_energy(&x),
        ddq_l: list(&robot.link_acceleration(&x)),
        dx,
        tau_l,
        dtau_l,
        ddtau_l,
    }
}

/// The torque on the links and its first two rates, each if the derivatives it depends on are given. Of those that are
/// not, none is in the torque that is asked for: zero does.
fn torques<L: Links<f64, N>, const N: usize>(
    links: &L,
    x: &Motion<f64, N>,
    state: &StateRow,
) -> [Option<Vec<f64>>; 3] {
    let given = [&state.ddq_l, &state.d3q_l, &state.d4q_l];
    let [a, jerk, snap] = given.map(|x| x.as_deref().map_or(Vector::ZERO, vector));
    let torque = links.torque_along::<_, 3, 5>(&Vector::from_derivatives(&[x.q_l, x.v_l, a, jerk, snap]));
    let rates = torque.derivatives();
    std::array::from_fn(|k| given[k].as_ref().map(|_| list(&rates[k])))
}

/// A problem if some of the numbers computed at `state` are not finite: JSON has no word for them.
fn finite<const K: usize>(
    states: &StateFile,
    state: &StateRow,
    numbers: [(&str, &[f64]); K],
) -> Result<(), Problem> {
    match numbers.iter().find(|(_, values)| !values.iter().all(|x| x.is_finite())) {
        None => Ok(()),
        Some((key, values)) => Err(states.problem(
            state,
            "not-finite",
            format!("at this state {key} is {values:?}, must be finite"),
            "the state is beyond what double precision can square; positions are in rad, velocities in rad/s, torques in N m",
        )),
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
