//! The law and the model at given states.

use flexure_core::scalar::Jet;
use serde::Serialize;

use crate::files::{Problem, Problems, StateFile, StateRow};
use crate::robot::{Arm, Mismatch, PortHamiltonian, Robot};
use crate::scenario::Scenario;
use crate::simulate::{Commanded, Errors, Loop};

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
/// If the loop cannot be [opened](Scenario::open), or a number is not finite at one of the states.
pub fn evaluate_law(scenario: &Scenario, states: &StateFile) -> Result<Vec<LawRow>, Problems> {
    let held = scenario.open()?;
    let row = |state: &StateRow| -> Result<LawRow, Problem> {
        let row = law_row(&*held, state);
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
        finite(states, state, numbers)?;
        Ok(row)
    };
    Ok(states.rows.iter().map(row).collect::<Result<_, Problem>>()?)
}

/// The law at a state; what only v-CBC computes on the way is left out for other laws.
fn law_row(held: &dyn Loop, state: &StateRow) -> LawRow {
    let Commanded { u_m, e_l, energy, errors } = held.command(state.t, &motion(state)).expect(CHECKED);
    let mut row = LawRow {
        t: state.t,
        u_m,
        u_l: None,
        q_md: None,
        e_l,
        e_m: None,
        sigma_l: None,
        sigma_m: None,
        H: energy,
    };
    if let Some(Errors { u_l, q_md, e_m, sigma_l, sigma_m, .. }) = errors {
        row.u_l = Some(u_l);
        row.q_md = Some(q_md);
        row.e_m = Some(e_m);
        row.sigma_l = Some(sigma_l);
        row.sigma_m = Some(sigma_m);
    }
    row
}

/// Evaluates the model of `robot` at `states`.
///
/// # Errors
/// If the robot has too many joints, or a number is not finite at one of the states.
///
/// # Panics
/// If `states` were read for a robot with another joint count.
pub fn evaluate_model(robot: &Robot, states: &StateFile) -> Result<Vec<ModelRow>, Problems> {
    let arm = robot.arm()?;
    let row = |state: &StateRow| -> Result<ModelRow, Problem> {
        let row = model_row(&*arm, state).expect(CHECKED);
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
        finite(states, state, numbers)?;
        Ok(row)
    };
    Ok(states.rows.iter().map(row).collect::<Result<_, Problem>>()?)
}

fn model_row(arm: &dyn Arm, state: &StateRow) -> Result<ModelRow, Mismatch> {
    let (n, x, zero) = (arm.joints(), motion(state), vec![0.0; arm.joints()]);
    let [mut mass, mut skew, mut workless, mut mass_rate] = [(); 4].map(|()| vec![0.0; n * n]);
    arm.mass_matrix(&state.q_l, &mut mass)?;
    let matrices = PortHamiltonian { skew: &mut skew, workless: &mut workless, mass_rate: &mut mass_rate };
    arm.matrices(&state.q_l, &state.dq_l, matrices)?;
    let mut bias = zero.clone();
    arm.inverse_dynamics(&state.q_l, &state.dq_l, &zero, &mut bias)?;
    let mut acceleration = vec![0.0; 2 * n];
    arm.forward_dynamics(&x, state.u_m.as_deref().unwrap_or(&zero), &mut acceleration)?;
    acceleration.truncate(n);
    let dx = state.u_m.as_ref().map(|u_m| {
        let mut rates = vec![0.0; 4 * n];
        arm.hamiltonian_rates(&x, u_m, &mut rates).map(|()| rates)
    });
    let [tau_l, dtau_l, ddtau_l] = torques(arm, state)?;
    let rows = |matrix: &[f64]| matrix.chunks(n).map(<[f64]>::to_vec).collect();
    Ok(ModelRow {
        M_l: rows(&mass),
        E_l: rows(&workless),
        S_l: rows(&skew),
        dM_l: rows(&mass_rate),
        bias,
        H: arm.energy(&x)?,
        ddq_l: acceleration,
        dx: dx.transpose()?,
        tau_l,
        dtau_l,
        ddtau_l,
    })
}

/// The torque on the links and its first two rates, each if the derivatives it depends on are given. Of those that are
/// not, none is in the torque that is asked for: zero does.
fn torques(arm: &dyn Arm, state: &StateRow) -> Result<[Option<Vec<f64>>; 3], Mismatch> {
    let given = [&state.ddq_l, &state.d3q_l, &state.d4q_l];
    let at = |values: &Option<Vec<f64>>, i: usize| values.as_ref().map_or(0.0, |values| values[i]);
    let series = |i: usize| {
        let [a, jerk, snap] = given.map(|values| at(values, i));
        let jet = Jet::<f64, 5>::from_derivatives([state.q_l[i], state.dq_l[i], a, jerk, snap]);
        std::array::from_fn(|k| jet.coefficient(k))
    };
    let q_l: Vec<[f64; 5]> = (0..arm.joints()).map(series).collect();
    let mut torque = vec![[0.0; 3]; arm.joints()];
    arm.torque_along(&q_l, &mut torque)?;
    let rate = |k: usize| torque.iter().map(|series| Jet::new(*series).derivative(k)).collect();
    Ok(std::array::from_fn(|k| given[k].as_ref().map(|_| rate(k))))
}

/// Why slices fit.
const CHECKED: &str = "the reader has checked the lengths of the states";

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

/// (q_l, q_m, q̇_l, q̇_m).
fn motion(state: &StateRow) -> Vec<f64> {
    [&state.q_l, &state.q_m, &state.dq_l, &state.dq_m].into_iter().flatten().copied().collect()
}
