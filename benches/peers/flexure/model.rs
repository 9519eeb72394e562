//! The robots and gains of the built-in files, and the same as JSON for the peers.

use std::error::Error;

use flexure::laws::{Controller, SideGains};
use flexure::robot::{self, JointKind, Robot, load_robot};
use flexure::scenario::load_scenario;
use flexure_core::control::{LinkGains, Metric, MotorGains, Tanh, Vcbc};
use flexure_core::linalg::Vector;
use flexure_core::model::Fjr;
use flexure_core::robots::{PlanarTwoLink, Tree};
use serde_json::{Value, json};

/// The two-link arm of the paper.
pub fn two_link() -> Result<Fjr<f64, PlanarTwoLink<f64>, 2>, Box<dyn Error>> {
    let file = load_robot("quanser-2dof")?;
    let robot::Links::PlanarTwoLink(form) = &file.links else { return Err("not a planar arm".into()) };
    Ok(fjr(&file, PlanarTwoLink::new(form.mass, form.length[0], form.com, form.inertia)))
}

/// The seven-joint arm.
pub fn panda() -> Result<Fjr<f64, Tree<f64, 7>, 7>, Box<dyn Error>> {
    let file = load_robot("panda")?;
    let robot::Links::Tree(bodies) = &file.links else { return Err("not a tree".into()) };
    let tree = Tree::from_bodies(bodies, file.gravity, |x| x).ok_or("not of seven joints")?;
    Ok(fjr(&file, tree))
}

fn fjr<L, const N: usize>(file: &Robot, links: L) -> Fjr<f64, L, N> {
    Fjr {
        links,
        motor_inertia: vector(&file.motor_inertia),
        stiffness: vector(&file.stiffness),
        link_damping: vector(&file.link_damping),
        motor_damping: vector(&file.motor_damping),
    }
}

/// The law with tanh on both sides.
pub type Gains<const N: usize> = Vcbc<f64, Tanh<f64, N>, Tanh<f64, N>, N>;

/// The gains of a built-in scenario.
pub fn gains<const N: usize>(scenario: &str) -> Result<Gains<N>, Box<dyn Error>> {
    let Controller::Vcbc(gains) = load_scenario(scenario)?.controller else { return Err("not v-CBC".into()) };
    let SideGains { metric, shaping, damping, .. } = &gains.link;
    let link = LinkGains {
        metric: Metric::Constant(vector(metric)),
        shaping: Tanh { gain: vector(shaping) },
        damping: vector(damping),
    };
    let SideGains { metric, shaping, damping, .. } = &gains.motor;
    let motor = MotorGains {
        metric: vector(metric),
        shaping: Tanh { gain: vector(shaping) },
        damping: vector(damping),
    };
    Ok(Vcbc { link, motor })
}

fn vector<const N: usize>(values: &[f64]) -> Vector<f64, N> {
    Vector::from_fn(|i| values[i])
}

/// Both robots as bodies, springs, motors and gains.
pub fn print() -> Result<(), Box<dyn Error>> {
    let model =
        json!({"two_link": document("two-link-tanh-smooth")?, "panda": document("panda-tanh-smooth")?});
    println!("{model:#}");
    Ok(())
}

fn document(scenario: &str) -> Result<Value, Box<dyn Error>> {
    let scenario = load_scenario(scenario)?;
    let robot = &scenario.robot;
    let bodies = match &robot.links {
        robot::Links::Tree(bodies) => bodies.iter().map(body).collect::<Result<Vec<_>, _>>()?,
        robot::Links::PlanarTwoLink(form) => planar(form),
        robot::Links::Pendulum(_) => return Err("neither a tree nor a planar arm".into()),
    };
    let Controller::Vcbc(gains) = &scenario.controller else { return Err("not v-CBC".into()) };
    let side =
        |side: &SideGains| json!({"metric": side.metric, "shaping": side.shaping, "damping": side.damping});
    Ok(json!({
        "gravity": robot.gravity,
        "bodies": bodies,
        "stiffness": robot.stiffness,
        "motor_inertia": robot.motor_inertia,
        "link_damping": robot.link_damping,
        "motor_damping": robot.motor_damping,
        "link": side(&gains.link),
        "motor": side(&gains.motor),
        "q_l": scenario.initial.q_l,
    }))
}

fn body(body: &robot::Body) -> Result<Value, &'static str> {
    if body.kind != JointKind::Revolute || body.axis.map(f64::to_bits) != [0.0, 0.0, 1.0].map(f64::to_bits) {
        return Err("the peers' models are of revolute joints about z");
    }
    Ok(json!({
        "rotation": body.rotation,
        "translation": body.translation,
        "mass": body.mass,
        "com": body.com,
        "inertia": body.inertia,
    }))
}

/// The closed form as bodies that turn about z.
fn planar(form: &robot::PlanarTwoLink) -> Vec<Value> {
    let at = [0.0, form.length[0]];
    let body = |i: usize| {
        let inertia = form.inertia[i];
        json!({
            "rotation": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            "translation": [at[i], 0.0, 0.0],
            "mass": form.mass[i],
            "com": [form.com[i], 0.0, 0.0],
            "inertia": [[inertia, 0.0, 0.0], [0.0, inertia, 0.0], [0.0, 0.0, inertia]],
        })
    };
    (0..2).map(body).collect()
}
