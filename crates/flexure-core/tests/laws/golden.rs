//! Laws against `golden/laws/`: torque and rate of the memory at random states of two arms, from an independent symbolic implementation.

use std::collections::BTreeMap;
use std::fs;

use flexure_core::control::{
    Adaptation, AdaptiveCommandFilteredBackstepping, AdaptiveVcbc, Applied, CommandFilteredBackstepping,
    CompositePh, ControlByInterconnection, ControlLaw, DisturbanceRejecting, DynamicFeedbackLinearization,
    DynamicLaw, IdaPbc, ImmersionInvariance, InnerLoop, LinkImpedance, LinkPositionFeedback, LoriaOrtega,
    Lqr, MotorObserverPd, MotorPd, MotorPositionPd, MotorPositionPdCapped, Pid, PositionFeedback,
    QuadraticCost, SeaCascade, SlidingMode, in_series, observer_gains,
};
use flexure_core::linalg::{Ldl, Matrix, Vector};
use flexure_core::model::{Fjr, Links, Motion, Parameters};
use flexure_core::scalar::{Jet, Over, Scalar};
use serde::Deserialize;

/// Of the largest number of a case: both sides are double precision, through cutoffs to the third power (10⁷) times errors.
const TOLERANCE: f64 = 1e-9;

/// The paper's links with gravity along them: a robot of one's own.
#[derive(Clone, Copy, Deserialize)]
pub struct TwoLink {
    pub a1: f64,
    pub a2: f64,
    pub b: f64,
    pub g1: f64,
    pub g2: f64,
}

impl TwoLink {
    /// The upright arm of the golden files.
    pub const UPRIGHT: Self =
        Self { a1: 0.180081887, a2: 0.010720825, b: 0.016469145, g1: 5.29277949, g2: 0.47102715 };
}

impl Links<f64, 2> for TwoLink {
    type Factor<'a, T: Over<f64>> = Ldl<T, 2>;

    fn mass_matrix<T: Over<f64>>(&self, q: &Vector<T, 2>) -> Matrix<T, 2, 2> {
        let coupling = q[1].cos().scale(self.b);
        let off = T::from_f64(self.a2) + coupling;
        Matrix([[T::from_f64(self.a1) + coupling + off, off], [off, T::from_f64(self.a2)]])
    }

    fn potential_energy<T: Over<f64>>(&self, q: &Vector<T, 2>) -> T {
        q[0].sin().scale(self.g1) + (q[0] + q[1]).sin().scale(self.g2)
    }

    fn carrier_rates<T: Over<f64>>(&self, _: &Vector<T, 2>, v: &Vector<T, 2>) -> Vector<T, 2> {
        Vector([T::ZERO, v[0]])
    }

    fn factor<T: Over<f64>>(&self, q: &Vector<T, 2>) -> Ldl<T, 2> {
        self.mass_matrix(q).ldl()
    }

    fn parameters(&self) -> Parameters<f64, 2> {
        slots([self.a1, self.a2, self.b, self.g1, self.g2])
    }

    fn regressor_mul<T: Over<f64>>(
        &self,
        [Vector([a1, a2]), Vector([b, _]), Vector([g1, g2]), ..]: &Parameters<T, 2>,
        q: &Vector<T, 2>,
        v: &Vector<T, 2>,
        v_r: &Vector<T, 2>,
        a_r: &Vector<T, 2>,
    ) -> Vector<T, 2> {
        let (s2, c2) = q[1].sin_cos();
        let (coupling, h, outer) = (*b * c2, *b * s2, *g2 * (q[0] + q[1]).cos());
        let both = (*a2 + coupling) * (a_r[0] + a_r[1]);
        Vector([
            (*a1 + coupling) * a_r[0] + both - h * (v[1] * v_r[0] + (v[0] + v[1]) * v_r[1])
                + *g1 * q[0].cos()
                + outer,
            both - coupling * a_r[1] + h * v[0] * v_r[0] + outer,
        ])
    }
}

/// Where the two links keep a1, a2, b, g1, g2 among the numbers of a robot.
fn slots<T: Scalar>([a1, a2, b, g1, g2]: [T; 5]) -> Parameters<T, 2> {
    let mut slots = [Vector::ZERO; 10];
    (slots[0], slots[1], slots[2]) = (Vector([a1, a2]), Vector([b, T::ZERO]), Vector([g1, g2]));
    slots
}

#[derive(Deserialize)]
struct Golden {
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    robot: Robot,
    reference: String,
    gains: BTreeMap<String, Gain>,
    t: f64,
    q_l: [f64; 2],
    q_m: [f64; 2],
    v_l: [f64; 2],
    v_m: [f64; 2],
    memory: Vec<f64>,
    torque: [f64; 2],
    memory_rate: Vec<f64>,
}

#[derive(Deserialize)]
struct Robot {
    #[serde(flatten)]
    links: TwoLink,
    stiffness: [f64; 2],
    motor_inertia: [f64; 2],
    link_damping: [f64; 2],
    motor_damping: [f64; 2],
    rotor_coupling_s12: Option<f64>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Gain {
    Number(f64),
    List(Vec<f64>),
}

type Arm = Fjr<f64, TwoLink, 2>;

impl Case {
    /// The gain `name`, a number per joint.
    fn gain(&self, name: &str) -> Vector<f64, 2> {
        match &self.gains[name] {
            Gain::Number(x) => Vector([*x; 2]),
            Gain::List(list) => Vector(list.as_slice().try_into().expect("a number per joint")),
        }
    }

    fn motor(&self, [stiffness, damping]: [&str; 2]) -> MotorPd<f64, 2> {
        MotorPd { stiffness: self.gain(stiffness), damping: self.gain(damping) }
    }

    /// Designed for the robot, at the posture and with the weights of the file.
    fn lqr(&self) -> Lqr<f64, 2> {
        let Gain::List(state) = &self.gains["Q"] else { panic!("a list") };
        let state = std::array::from_fn(|k| Vector([state[2 * k], state[2 * k + 1]]));
        let cost = QuadraticCost { state, torque: self.gain("R") };
        Lqr::design(&self.arm(), &self.gain("design_posture"), &cost, &Vector([f64::INFINITY; _]))
            .expect("a stabilisable arm")
    }

    fn arm(&self) -> Arm {
        let Robot { links, stiffness, motor_inertia, link_damping, motor_damping, .. } = &self.robot;
        let [motor_inertia, stiffness, link_damping, motor_damping] =
            [motor_inertia, stiffness, link_damping, motor_damping].map(|x| Vector(*x));
        Fjr { links: *links, motor_inertia, stiffness, link_damping, motor_damping }
    }

    fn motion(&self) -> Motion<f64, 2> {
        let [q_l, q_m, v_l, v_m] = [self.q_l, self.q_m, self.v_l, self.v_m].map(Vector);
        Motion { q_l, q_m, v_l, v_m }
    }

    fn q_ld<const K: usize>(&self) -> Vector<Jet<f64, K>, 2> {
        match self.reference.as_str() {
            "q_ld = (sin 0.6 t, sin 0.6 t)" => Vector([Jet::variable(self.t).scale(0.6).sin(); 2]),
            "q_ld = (0.5, -0.4) at rest" => Vector([0.5, -0.4]).map(Jet::value),
            other => panic!("{other}"),
        }
    }

    fn agrees(&self, law: &str, torque: &Vector<f64, 2>, rate: &[Vector<f64, 2>]) {
        self.agrees_with(law, &torque.iter().chain(rate.iter().flat_map(Vector::iter)).collect::<Vec<_>>());
    }

    /// Torque, then rates.
    fn agrees_with(&self, law: &str, found: &[f64]) {
        let expected: Vec<f64> = self.torque.iter().chain(&self.memory_rate).copied().collect();
        assert_eq!(found.len(), expected.len(), "{law}");
        let scale = expected.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
        for (x, y) in found.iter().zip(&expected) {
            assert!((x - y).abs() <= TOLERANCE * scale, "{law}: {found:?} against {expected:?}");
        }
    }
}

fn cases(law: &str) -> Vec<Case> {
    let path = format!("{}/tests/golden/laws/{law}.json", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(path).expect("a golden file");
    let golden: Golden = serde_json::from_str(&text).expect("cases");
    assert_eq!(golden.cases.len(), 4);
    golden.cases
}

/// A law with memory at every case of its file.
fn dynamic<F: DynamicLaw<f64, 2, K>, const K: usize>(name: &str, law: impl Fn(&Case) -> F) {
    for case in cases(name) {
        let (law, robot, x, q_ld) = (law(&case), case.arm(), case.motion(), case.q_ld());
        let z: [_; K] = std::array::from_fn(|k| Vector([case.memory[2 * k], case.memory[2 * k + 1]]));
        let torque = law.torque(&robot, &x, &q_ld, &z);
        let rate = law.rate(&robot, &x, &q_ld, &z, &Applied::fully(torque));
        case.agrees(name, &torque, &rate);
    }
}

/// A static law at every case of its file.
fn fixed<F: ControlLaw<f64, 2>>(name: &str, law: impl Fn(&Case) -> F) {
    for case in cases(name) {
        case.agrees(name, &law(&case).torque(&case.arm(), &case.motion(), &case.q_ld()), &[]);
    }
}

#[test]
fn motor_position_pd() {
    dynamic("motor-position-pd", |case| MotorPositionPd {
        motor: case.motor(["stiffness", "damping"]),
        cutoff: case.gain("cutoff"),
    });
    dynamic("motor-position-pd-capped", |case| MotorPositionPdCapped {
        motor: case.motor(["stiffness", "damping"]),
        cutoff: case.gain("cutoff"),
        stiffness_cap: case.gain("cap_p"),
        damping_cap: case.gain("cap_d"),
    });
}

#[test]
fn position_feedback() {
    dynamic("position-feedback", |case| PositionFeedback {
        link: case.motor(["link_stiffness", "link_damping"]),
        link_cutoff: case.gain("link_cutoff"),
        motor: case.motor(["motor_stiffness", "motor_damping"]),
        motor_cutoff: case.gain("motor_cutoff"),
    });
}

#[test]
fn motor_observer_pd() {
    dynamic("motor-observer-pd", |case| MotorObserverPd {
        stiffness: case.gain("stiffness"),
        inertia: case.gain("inertia"),
        damping: case.gain("damping"),
        coupling: case.gain("coupling"),
    });
}

#[test]
fn control_by_interconnection() {
    dynamic("control-by-interconnection", |case| ControlByInterconnection {
        stiffness: case.gain("stiffness"),
        elastic: case.gain("elastic"),
        viscous: case.gain("viscous"),
    });
}

#[test]
fn ida_pbc() {
    fixed("ida-pbc", |case| IdaPbc {
        inertia: case.gain("inertia"),
        motor: case.motor(["stiffness", "damping"]),
        cross: case.gain("cross"),
    });
}

#[test]
fn link_impedance() {
    fixed("link-impedance", |case| {
        let MotorPd { stiffness, damping } = case.motor(["stiffness", "damping"]);
        let stiffness = Vector::from_fn(|i| in_series(case.arm().stiffness[i], stiffness[i]));
        LinkImpedance { inertia: case.gain("inertia"), motor: MotorPd { stiffness, damping } }
    });
}

#[test]
fn loria_ortega() {
    dynamic("loria-ortega", |case| LoriaOrtega {
        link: case.motor(["link_stiffness", "link_damping"]),
        motor: case.motor(["motor_stiffness", "motor_damping"]),
        cutoff: case.gain("cutoff"),
    });
}

fn immersed(case: &Case) -> ImmersionInvariance<f64, 2> {
    ImmersionInvariance {
        link: case.motor(["link_stiffness", "link_damping"]),
        inner: InnerLoop { position: case.gain("position"), velocity: case.gain("velocity") },
    }
}

#[test]
fn immersion_invariance() {
    fixed("immersion-invariance", immersed);
}

#[test]
fn link_position_feedback() {
    dynamic("link-position-feedback", |case| {
        let (bandwidth, robot) = (case.gain("bandwidth"), case.arm());
        let gains: [[f64; 4]; 2] = std::array::from_fn(|i| {
            observer_gains(bandwidth[i], robot.motor_damping[i] / robot.motor_inertia[i])
        });
        let observer = std::array::from_fn(|k| Vector(gains.map(|joint| joint[k])));
        LinkPositionFeedback { law: immersed(case), observer }
    });
}

#[test]
fn composite_ph() {
    fixed("composite-ph", |case| CompositePh {
        shaping: case.gain("shaping"),
        metric: case.gain("metric"),
        damping: case.gain("damping"),
        fast_stiffness: case.gain("fast_stiffness"),
        fast_damping: case.gain("fast_damping"),
    });
}

#[test]
fn pid() {
    dynamic("pid", |case| Pid {
        motor: case.motor(["stiffness", "damping"]),
        integral: case.gain("integral"),
    });
}

#[test]
fn sliding_mode() {
    fixed("sliding-mode", |case| SlidingMode {
        surface: case.gain("rate"),
        reaching: case.gain("reach"),
        authority: case.gain("gain"),
        layer: case.gain("layer"),
    });
}

#[test]
fn sea_cascade() {
    dynamic("sea-cascade", |case| SeaCascade {
        link: case.motor(["link_stiffness", "link_damping"]),
        torque: case.gain("torque_p"),
        torque_integral: case.gain("torque_i"),
        velocity: case.gain("velocity_p"),
        velocity_integral: case.gain("velocity_i"),
    });
}

#[test]
fn disturbance_rejecting() {
    dynamic("disturbance-rejecting", |case| DisturbanceRejecting {
        law: immersed(case),
        bandwidth: case.gain("bandwidth"),
    });
}

#[test]
fn lqr() {
    fixed("lqr", |case| {
        let law = case.lqr();
        let Gain::List(gain) = &case.gains["F"] else { panic!("a list") };
        // Rows of F for q, θ, v and w.
        for (k, expected) in gain.iter().enumerate() {
            let (row, column) = (k / 8, k % 8);
            let found = law.gain[column / 2][(row, column % 2)];
            assert!((found - expected).abs() <= TOLERANCE * 100.0, "{k}: {found} against {expected}");
        }
        law
    });
}

/// Gains of backstepping from links to motors.
fn backstepping(case: &Case) -> CommandFilteredBackstepping<f64, 2> {
    CommandFilteredBackstepping {
        shaping: case.gain("shaping"),
        link_damping: case.gain("link_damping"),
        metric: case.gain("metric"),
        motor_shaping: case.gain("motor_shaping"),
        rate_metric: case.gain("rate_metric"),
        rate_shaping: case.gain("rate_shaping"),
        bandwidth: case.gain("bandwidth"),
    }
}

#[test]
fn command_filtered_backstepping() {
    dynamic("command-filtered-backstepping", backstepping);
}

/// An adaptive law at every case of its file: numbers per joint, then a1, a2, b, g1, g2.
fn adaptive<F: DynamicLaw<f64, 2, K>, const K: usize>(name: &str, law: impl Fn(&Case) -> F) {
    for case in cases(name) {
        let (law, robot, x, q_ld) = (law(&case), case.arm(), case.motion(), case.q_ld());
        let (filters, parameters) = case.memory.split_at(2 * (K - 10));
        let parameters = slots(parameters.try_into().expect("five numbers"));
        let z: [_; K] = std::array::from_fn(|k| match k.checked_sub(K - 10) {
            Some(slot) => parameters[slot],
            None => Vector([filters[2 * k], filters[2 * k + 1]]),
        });
        let torque = law.torque(&robot, &x, &q_ld, &z);
        let rate = law.rate(&robot, &x, &q_ld, &z, &Applied::fully(torque));
        let (filters, parameters) = rate.split_at(K - 10);
        let [a, Vector([b, unused]), g] = [0, 1, 2].map(|slot| parameters[slot]);
        assert_eq!(Vector([unused]), Vector::ZERO);
        let rates = filters.iter().flat_map(Vector::iter).chain([a[0], a[1], b, g[0], g[1]]);
        case.agrees_with(name, &torque.iter().chain(rates).collect::<Vec<_>>());
    }
}

fn adaptation(case: &Case) -> Adaptation<f64, 2> {
    let Gain::List(gain) = &case.gains["adaptation"] else { panic!("a list") };
    let gain = slots(gain.as_slice().try_into().expect("five numbers"));
    let (low, high) = (slots([f64::NEG_INFINITY; 5]), slots([f64::INFINITY; 5]));
    Adaptation { gain, low, high, least: Vector([0.1; 2]) }
}

#[test]
fn adaptive_laws() {
    adaptive("adaptive-command-filtered-backstepping", |case| AdaptiveCommandFilteredBackstepping {
        nominal: backstepping(case),
        adaptation: adaptation(case),
    });
    adaptive("adaptive-vcbc", |case| AdaptiveVcbc {
        backstepping: backstepping(case),
        link_metric: case.gain("link_metric"),
        adaptation: adaptation(case),
    });
}

#[test]
fn dynamic_feedback_linearization() {
    for case in cases("dynamic-feedback-linearization") {
        let coupling = case.robot.rotor_coupling_s12.expect("coupled rotors");
        let law = DynamicFeedbackLinearization { rate: case.gain("rate"), coupling };
        let z: [_; 2] = std::array::from_fn(|k| Vector([case.memory[2 * k], case.memory[2 * k + 1]]));
        let planned = law.planned(&case.arm(), &case.motion(), &case.q_ld(), &z);
        case.agrees("dynamic-feedback-linearization", &planned.torque, &planned.rate);
    }
}
