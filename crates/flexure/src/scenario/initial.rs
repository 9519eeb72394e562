//! `[initial]`: where a run starts.

use crate::files::field::Joints;
use crate::files::quantity::{self, Quantity};
use crate::files::table::Table;
use crate::files::{Assumption, Places};

/// Positions and velocities at t = 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Initial {
    /// Link positions \[rad\].
    pub q_l: Vec<f64>,
    /// Motor positions, link side of the gear \[rad\].
    pub q_m: Vec<f64>,
    /// Link velocities [rad/s].
    pub dq_l: Vec<f64>,
    /// Motor velocities, link side of the gear [rad/s].
    pub dq_m: Vec<f64>,
}

/// Reads `[initial]`, at rest at zero where nothing is given; that nothing was given is an assumption.
pub(crate) fn read(
    root: &Table<'_>,
    joints: &Joints,
    places: &Places,
    assumed: &mut Vec<Assumption>,
) -> Option<Initial> {
    let Some(field) = root.get("initial") else {
        assumed.push(Assumption {
            key: "initial".into(),
            value: "at rest at q = 0".into(),
            note: "not given in the scenario".into(),
            file: places.file().into(),
        });
        let zero = || joints.count.map(|n| vec![0.0; n]);
        return Some(Initial { q_l: zero()?, q_m: zero()?, dq_l: zero()?, dq_m: zero()? });
    };
    let table = field.table(&["q_l", "q_m", "dq_l", "dq_m"])?;
    let read = |key, quantity: &Quantity| table.per_joint_or_zero(key, joints, quantity);
    let (q_l, q_m) = (read("q_l", &quantity::ANGLE), read("q_m", &quantity::ANGLE));
    let (dq_l, dq_m) = (read("dq_l", &quantity::VELOCITY), read("dq_m", &quantity::VELOCITY));
    let initial = Initial { q_l: q_l?, q_m: q_m?, dq_l: dq_l?, dq_m: dq_m? };
    if table.get("q_m").is_none() && initial.q_l.iter().any(|&q| q != 0.0) {
        let message =
            format!("initial.q_l is {:?} rad and initial.q_m is not given, is taken as 0", initial.q_l);
        field.warn(
            "preload",
            message,
            format!("the springs start loaded; for relaxed ones add q_m = {:?}", initial.q_l),
        );
    }
    Some(initial)
}
