//! `initial`: where a run starts.

use crate::files::field::{Field, Joints};
use crate::files::quantity::{self, Quantity};
use crate::files::table::Table;
use crate::files::{Assumption, Places, Problems};
use crate::imperfections::{Imperfection, Spring};
use crate::plant::deflection;
use crate::references::document::Timed;
use crate::robot::Robot;
use crate::scenario::plant::Plant;

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

/// What is at rest on springs: the robot as the law knows it, on the springs that are simulated.
pub(crate) struct Rest<'a> {
    pub robot: &'a Robot,
    /// k ≥ 0 in the spring torque K ζ + k ζ³ [N m/rad³].
    pub hardening: Vec<f64>,
    /// All of the play \[rad\].
    pub play: Vec<f64>,
    /// Where the reference starts \[rad\].
    pub reference: Vec<f64>,
}

impl<'a> Rest<'a> {
    /// Of a scenario with these parts, if all could be read.
    pub fn of(
        robot: Option<&'a Robot>,
        plant: Option<&Plant>,
        imperfections: Option<&[Imperfection]>,
        timed: Option<&Timed>,
    ) -> Option<Self> {
        let (robot, plant, timed) = (robot?, plant?, timed?);
        let springs: Vec<&Spring> = imperfections?.iter().filter_map(Imperfection::of).collect();
        let hardening = |i: usize| {
            let own = plant.spring_hardening.as_ref().map_or(0.0, |hardening| hardening[i]);
            springs.iter().fold(own, |sum, spring| sum + spring.hardening[i])
        };
        let play = |i: usize| springs.iter().map(|spring| 2.0 * spring.dead_zone[i]).sum();
        let n = robot.joint_count();
        Some(Self {
            robot,
            hardening: (0..n).map(hardening).collect(),
            play: (0..n).map(play).collect(),
            reference: timed.reference.initial(),
        })
    }

    /// The robot at rest with its links at `q_l` in rad: springs carry gravity.
    fn at(&self, q_l: Vec<f64>) -> Result<Initial, Problems> {
        const SIZES: &str = "n joints";
        let (n, zero) = (q_l.len(), vec![0.0; q_l.len()]);
        let mut gravity = zero.clone();
        self.robot.arm()?.inverse_dynamics(&q_l, &zero, &zero, &mut gravity).expect(SIZES);
        let bent =
            |i: usize| deflection(gravity[i], self.robot.stiffness[i], self.hardening[i], self.play[i]);
        let q_m = (0..n).map(|i| q_l[i] + bent(i)).collect();
        Ok(Initial { q_l, q_m, dq_l: zero.clone(), dq_m: zero })
    }
}

/// Reads `initial`: a table with positions and velocities, with `at_rest`, the posture of a robot that its springs carry, or the
/// words "at rest", for the posture that the reference starts in. At rest at zero where nothing is given; that nothing was given
/// is an assumption. `rest` is none if it could not be read.
pub(crate) fn read(
    root: &Table<'_>,
    joints: &Joints,
    places: &Places,
    rest: Option<&Rest<'_>>,
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
    if field.is_text() {
        field.choice(&[(AT_REST, ())])?;
        let rest = rest?;
        return field.absorb(rest.at(rest.reference.clone()));
    }
    let table = field.table(&["at_rest", "q_l", "q_m", "dq_l", "dq_m"])?;
    if let Some(posture) = table.get("at_rest") {
        if let Some((key, other)) = table.fields().find(|(key, _)| *key != "at_rest") {
            let message = format!("initial.at_rest and initial.{key} are given, must be one of them");
            other.error(
                "contradiction",
                message,
                "at_rest says where the links are; q_m follows, and nothing moves",
            );
            return None;
        }
        let q_l = posture.per_joint(joints, &quantity::ANGLE)?;
        return posture.absorb(rest?.at(q_l));
    }
    given(&field, &table, joints)
}

/// What stands for the posture that the reference starts in.
const AT_REST: &str = "at rest";

/// Positions and velocities as they are given, zero where they are not.
fn given(field: &Field<'_>, table: &Table<'_>, joints: &Joints) -> Option<Initial> {
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
            "the springs start loaded; initial = \"at rest\", or at_rest instead of q_l, has them carry the robot",
        );
    }
    Some(initial)
}
