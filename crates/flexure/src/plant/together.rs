//! Several plants as one, a SIMD lane each.

use std::array;

use flexure_core::linalg::Vector;
use flexure_core::model::Fjr;
use flexure_core::scalar::{Lane, Lanes};

use crate::plant::friction::Friction;
use crate::plant::plant::Plant;
use crate::plant::spring::Hysteresis;

impl<L, const N: usize, const W: usize> Plant<L, N, Lanes<f64, W>>
where
    f64: Lane<W>,
{
    /// The plants `each`, whose links are those in the lanes of `links`. None if one is rough or has coupled rotors: lanes move neither.
    pub(crate) fn together<One>(links: L, each: [&Plant<One, N>; W]) -> Option<Self> {
        if each.iter().any(|plant| !plant.is_smooth() || plant.rotor_coupling.is_some()) {
            return None;
        }
        let pack = |find: &dyn Fn(&Plant<One, N>) -> Vector<f64, N>| {
            Vector::from_fn(|k| Lanes::from_array(array::from_fn(|w| find(each[w])[k])))
        };
        Some(Self {
            robot: Fjr {
                links,
                motor_inertia: pack(&|plant| plant.robot.motor_inertia),
                stiffness: pack(&|plant| plant.robot.stiffness),
                link_damping: pack(&|plant| plant.robot.link_damping),
                motor_damping: pack(&|plant| plant.robot.motor_damping),
            },
            spring_hardening: pack(&|plant| plant.spring_hardening),
            spring_gap: Vector([0.0; N]),
            hysteresis: Hysteresis::NONE,
            link_friction: Friction::NONE,
            motor_friction: Friction::NONE,
            rotor_coupling: None,
            torque_gain: pack(&|plant| plant.torque_gain),
            external: pack(&|plant| plant.external),
        })
    }
}
