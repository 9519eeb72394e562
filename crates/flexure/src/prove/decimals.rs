//! Robot and gains of a scenario in decimals, as certificates write them.

use flexure_core::scalar::Interval;

use crate::prove::engine::certificate::{DecimalBody, DecimalGains, DecimalLinks, DecimalRobot, JointMotion};
use crate::prove::engine::number::Number;
use crate::scenario::Scenario;
use crate::{laws, robot};

/// The gains of a side.
pub(crate) fn gains(scenario: &Scenario, gains: &laws::SideGains) -> DecimalGains {
    let numbers = |values: &[f64]| values.iter().map(|&x| Number::read(x, scenario.bounds(x))).collect();
    DecimalGains {
        metric: numbers(&gains.metric),
        shaping: numbers(&gains.shaping),
        damping: numbers(&gains.damping),
        kappa: gains.extra("kappa").map(|kappa| numbers(kappa)),
        hardening: gains.hardens().map(numbers),
    }
}

/// The robot of a file in decimals.
pub(crate) fn robot(data: &robot::Robot) -> DecimalRobot {
    let numbers = |values: &[f64]| values.iter().map(|&x| Number::read(x, data.bounds(x))).collect();
    DecimalRobot {
        name: data.name.clone(),
        joints: data.joint_count(),
        links: links(data),
        stiffness: numbers(&data.stiffness),
        motor_inertia: numbers(&data.motor_inertia),
        link_damping: numbers(&data.link_damping),
        motor_damping: numbers(&data.motor_damping),
    }
}

fn links(data: &robot::Robot) -> DecimalLinks {
    let number = |x: f64| Number::read(x, data.bounds(x));
    match &data.links {
        robot::Links::PlanarTwoLink(robot::PlanarTwoLink { mass, length, com, inertia }) => {
            DecimalLinks::PlanarTwoLink {
                mass: mass.map(number),
                length: number(length[0]),
                com: com.map(number),
                inertia: inertia.map(number),
            }
        }
        robot::Links::Pendulum(robot::Pendulum { mass, com, inertia }) => {
            DecimalLinks::Pendulum { mass: number(*mass), com: number(*com), inertia: number(*inertia) }
        }
        robot::Links::Tree(_) => {
            let bodies = data.enclosed.tree().iter().enumerate();
            DecimalLinks::Tree { bodies: bodies.map(|(i, enclosed)| body(data, i, enclosed)).collect() }
        }
    }
}

fn body(data: &robot::Robot, joint: usize, body: &robot::Body<Interval>) -> DecimalBody {
    let computed = Number::computed;
    let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = body.inertia;
    let (lower, upper) = (data.limits.lower[joint], data.limits.upper[joint]);
    let number = |x: f64| Number::read(x, data.bounds(x));
    let prismatic = body.kind == robot::JointKind::Prismatic;
    DecimalBody {
        parent: body.parent,
        kind: if prismatic { JointMotion::Prismatic } else { JointMotion::Revolute },
        axis: body.axis.map(computed),
        rotation: body.rotation.map(|row| row.map(computed)),
        translation: body.translation.map(computed),
        mass: computed(body.mass),
        com: body.com.map(computed),
        inertia: [xx, xy, xz, yy, yz, zz].map(computed),
        travel: (prismatic && lower.is_finite() && upper.is_finite()).then(|| [number(lower), number(upper)]),
    }
}
