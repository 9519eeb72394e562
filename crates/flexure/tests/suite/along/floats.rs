//! The closed loop in plain floats, from error coordinates, for two robots without the visitor that would compile all.

use flexure::core::control::{Command, Metric, Shaping};
use flexure::core::linalg::Vector;
use flexure::core::model::{Fjr, Links, Motion};
use flexure::core::reference::Reference;
use flexure::core::robots::{Pendulum, PlanarTwoLink};
use flexure::feasible;
use flexure::laws::{Law, command, law};
use flexure::references::AnyReference;
use flexure::robot;
use flexure::scenario::Scenario;

use crate::common::Random;

pub struct Floats<L, const N: usize> {
    pub robot: Fjr<f64, L, N>,
    pub law: Law<f64, N>,
    pub reference: AnyReference<f64, N>,
}

fn floats<L, const N: usize>(scenario: &Scenario, links: L) -> Floats<L, N> {
    let drive = |values: &[f64]| Vector::from_fn(|i| values[i]);
    let data = &scenario.robot;
    let robot = Fjr {
        links,
        motor_inertia: drive(&data.motor_inertia),
        stiffness: drive(&data.stiffness),
        link_damping: drive(&data.link_damping),
        motor_damping: drive(&data.motor_damping),
    };
    Floats { robot, law: law(scenario.vcbc().unwrap()), reference: feasible::reference(scenario).unwrap() }
}

pub fn arm(scenario: &Scenario) -> Floats<PlanarTwoLink<f64>, 2> {
    let robot::Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { mass, length, com, inertia }) =
        scenario.robot.links
    else {
        panic!("two links")
    };
    floats(scenario, PlanarTwoLink::new(mass, length[0], com, inertia))
}

pub fn pendulum(scenario: &Scenario) -> Floats<Pendulum<f64>, 1> {
    let robot::Links::Pendulum(flexure::robot::Pendulum { mass, com, inertia }) = scenario.robot.links else {
        panic!("pendulum")
    };
    let gravity = scenario.robot.gravity.iter().map(|x| x * x).sum::<f64>().sqrt();
    floats(scenario, Pendulum { inertia: inertia + mass * com * com, weight_moment: mass * com * gravity })
}

/// Velocity, deflection and torque of all joints; the link position errors.
pub struct Values {
    pub quantities: Vec<f64>,
    pub error: Vec<f64>,
    pub level: f64,
}

impl<L: Links<f64, N>, const N: usize> Floats<L, N> {
    pub fn command(&self, t: f64, x: &Motion<f64, N>) -> Command<f64, N> {
        command(&self.law, &self.robot, x, &self.reference.at(t))
    }

    /// The state with the errors `e_l`, `e_m`, `s_l`, `s_m`.
    pub fn motion(&self, t: f64, [e_l, e_m, s_l, s_m]: [Vector<f64, N>; 4]) -> Motion<f64, N> {
        let q_ld = self.reference.at::<2>(t);
        let v_lr = q_ld.map(|jet| jet.coefficient(1)) - self.law.link.shaping.eval(&e_l);
        let zero = Vector::ZERO;
        let mut x =
            Motion { q_l: q_ld.map(|jet| jet.coefficient(0)) + e_l, q_m: zero, v_l: v_lr + s_l, v_m: zero };
        x.q_m = self.command(t, &x).q_md + e_m;
        x.v_m = s_m - self.command(t, &x).s_m;
        x
    }

    pub fn level(&self, x: &Motion<f64, N>, command: &Command<f64, N>) -> f64 {
        let Metric::Constant(metric) = &self.law.link.metric else { panic!("constant") };
        let Command { e_l, e_m, s_l, s_m, .. } = command;
        let form = |d: &Vector<f64, N>, e: &Vector<f64, N>| e.dot(&d.diag_mul(e));
        let links = s_l.dot(&self.robot.links.mass_mul(&x.q_l, s_l));
        0.5 * (form(metric, e_l)
            + form(&self.law.motor.metric, e_m)
            + form(&self.robot.motor_inertia, s_m)
            + links)
    }

    pub fn values(&self, t: f64, x: &Motion<f64, N>) -> Values {
        let command = self.command(t, x);
        let quantities = [x.v_l, x.deflection(), command.u_m].iter().flat_map(Vector::iter).collect();
        Values { quantities, error: command.e_l.iter().collect(), level: self.level(x, &command) }
    }

    /// A random state with W = `level`.
    pub fn sample(&self, t: f64, level: f64, r: &mut Random) -> Motion<f64, N> {
        let Metric::Constant(metric) = &self.law.link.metric else { panic!("constant") };
        let direction: [[f64; N]; 4] = std::array::from_fn(|_| std::array::from_fn(|_| r.next()));
        let scaled = |d: &[f64; N], metric: &Vector<f64, N>| Vector::from_fn(|i| d[i] / metric[i].sqrt());
        let e_l = scaled(&direction[0], metric);
        let e_m = scaled(&direction[1], &self.law.motor.metric);
        let s_m = scaled(&direction[3], &self.robot.motor_inertia);
        let q_ld: Vector<f64, N> = self.reference.on(t);
        let at = |scale: f64| {
            // The links' speeds in the metric of where they are.
            let ldl = self.robot.links.mass_matrix(&(q_ld + e_l.scaled(scale))).ldl();
            let mut s_l = Vector::from_fn(|i| direction[2][i]);
            s_l = ldl.solve(&s_l);
            let mass = s_l.dot(&self.robot.links.mass_mul(&(q_ld + e_l.scaled(scale)), &s_l)).sqrt();
            let length = direction[2].iter().map(|x| x * x).sum::<f64>().sqrt();
            [e_l, e_m, s_l.scaled(length / mass), s_m].map(|e| e.scaled(scale))
        };
        // All four parts have the norm of their direction, whatever the mass matrix: W is exact.
        let length: f64 = direction.iter().flatten().map(|x| x * x).sum();
        self.motion(t, at((2.0 * level / length).sqrt()))
    }
}
