//! The controllers by name.

use flexure_core::control::{
    Backstepping, Cascade, Command, ControlLaw, Esp, FeedbackLinearization, FeedforwardPd,
    GravityCancellation, Input, IntegralManifold, Linear, LinkGains, Metric, MotorGains, MotorPd, Passivity,
    Pd, PdOnlineGravity, RigidVcbc, SingularPerturbation, TorqueFeedback, Vcbc,
};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::{Jet, Over, Scalar};

use crate::files::Entry;
use crate::laws::{AnyShaping, Baseline, Controller, Phi, SideGains, VcbcGains};
use crate::robot::padded;

/// The registered controllers.
pub const CONTROLLERS: &[Entry] = &[
    Entry {
        name: "vcbc", summary: "virtual-contraction law of flexible-joint robots: (φ, Π, K_d) per side"
    },
    Entry { name: "pd", summary: "PD of the motors with the gravity of the goal (Tomei 1991)" },
    Entry {
        name: "pd-online-gravity",
        summary: "PD of the motors with the gravity of where they are (De Luca, Siciliano, Zollo 2005)",
    },
    Entry {
        name: "rigid-vcbc",
        summary: "virtual-contraction law of rigid robots on the motors, as if the springs were rigid",
    },
    Entry { name: "feedback-linearization", summary: "four integrators per joint (Spong 1987)" },
    Entry {
        name: "feedforward-pd",
        summary: "nominal torque of the reference and PD of the motors (De Luca 2000)",
    },
    Entry {
        name: "integral-manifold",
        summary: "rigid computed torque corrected for compliance (Spong, Khorasani, Kokotović 1987)",
    },
    Entry { name: "passivity", summary: "passivity-based tracking (Brogliato, Ortega, Lozano 1995)" },
    Entry {
        name: "torque-feedback",
        summary: "regulation with shaped motor inertia (Albu-Schäffer, Ott, Hirzinger 2007)",
    },
    Entry {
        name: "singular-perturbation",
        summary: "rigid computed torque with damping of the springs (Spong 1987)",
    },
    Entry {
        name: "gravity-cancellation",
        summary: "regulation after gravity is cancelled (De Luca, Flacco 2010)",
    },
    Entry { name: "backstepping", summary: "from links to motors (Brogliato, Ortega, Lozano 1995)" },
    Entry { name: "cascade", summary: "spring torques by an inner loop of motor positions" },
    Entry { name: "esp", summary: "elastic structure preserving damping injection (Keppler et al. 2018)" },
];

/// The v-CBC law over the registered shaping functions, with gains of type `C`.
pub type Law<C, const N: usize> = Vcbc<C, AnyShaping<C, N>, AnyShaping<C, N>, N>;

/// Any registered law, with gains of type `C`.
#[derive(Clone, Debug)]
pub enum AnyLaw<C, const N: usize> {
    /// `vcbc`.
    Vcbc(Box<Law<C, N>>),
    /// `pd`.
    Pd(Pd<C, N>),
    /// `pd-online-gravity`.
    PdOnlineGravity(PdOnlineGravity<C, N>),
    /// `rigid-vcbc`.
    RigidVcbc(RigidVcbc<C, Linear<C, N>, N>),
    /// `feedback-linearization`.
    FeedbackLinearization(FeedbackLinearization<C, N>),
    /// `feedforward-pd`.
    FeedforwardPd(FeedforwardPd<C, N>),
    /// `integral-manifold`.
    IntegralManifold(IntegralManifold<C, N>),
    /// `passivity`.
    Passivity(Passivity<C, N>),
    /// `torque-feedback`.
    TorqueFeedback(TorqueFeedback<C, N>),
    /// `singular-perturbation`.
    SingularPerturbation(SingularPerturbation<C, N>),
    /// `gravity-cancellation`.
    GravityCancellation(GravityCancellation<C, N>),
    /// `backstepping`.
    Backstepping(Backstepping<C, N>),
    /// `cascade`.
    Cascade(Cascade<C, N>),
    /// `esp`.
    Esp(Esp<C, N>),
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for AnyLaw<C, N> {
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        match self {
            Self::Vcbc(law) => law.torque(robot, x, q_ld),
            Self::Pd(law) => law.torque(robot, x, q_ld),
            Self::PdOnlineGravity(law) => law.torque(robot, x, q_ld),
            Self::RigidVcbc(law) => law.torque(robot, x, q_ld),
            Self::FeedbackLinearization(law) => law.torque(robot, x, q_ld),
            Self::FeedforwardPd(law) => law.torque(robot, x, q_ld),
            Self::IntegralManifold(law) => law.torque(robot, x, q_ld),
            Self::Passivity(law) => law.torque(robot, x, q_ld),
            Self::TorqueFeedback(law) => law.torque(robot, x, q_ld),
            Self::SingularPerturbation(law) => law.torque(robot, x, q_ld),
            Self::GravityCancellation(law) => law.torque(robot, x, q_ld),
            Self::Backstepping(law) => law.torque(robot, x, q_ld),
            Self::Cascade(law) => law.torque(robot, x, q_ld),
            Self::Esp(law) => law.torque(robot, x, q_ld),
        }
    }
}

/// The law that `controller` describes, with every gain through `number`.
pub fn any_law<C: Scalar, const N: usize>(
    controller: &Controller,
    number: impl Fn(f64) -> C,
) -> AnyLaw<C, N> {
    match controller {
        Controller::Vcbc(gains) => AnyLaw::Vcbc(Box::new(law_over(gains, number))),
        Controller::Baseline(law) => baseline(law, number),
    }
}

fn baseline<C: Scalar, const N: usize>(law: &Baseline, number: impl Fn(f64) -> C) -> AnyLaw<C, N> {
    let gain = |key: &str| padded(law.gain(key), 1.0).map(&number);
    let motor = || MotorPd { stiffness: gain("stiffness"), damping: gain("damping") };
    match law.kind {
        "pd" => AnyLaw::Pd(Pd { motor: motor() }),
        "pd-online-gravity" => AnyLaw::PdOnlineGravity(PdOnlineGravity { motor: motor() }),
        "rigid-vcbc" => AnyLaw::RigidVcbc(RigidVcbc {
            link: LinkGains {
                metric: Metric::Constant(gain("metric")),
                shaping: Linear { gain: gain("shaping") },
                damping: gain("damping"),
            },
        }),
        "feedback-linearization" => AnyLaw::FeedbackLinearization(FeedbackLinearization {
            gains: ["position", "velocity", "acceleration", "jerk"].map(gain),
        }),
        "feedforward-pd" => AnyLaw::FeedforwardPd(FeedforwardPd { motor: motor() }),
        "integral-manifold" => AnyLaw::IntegralManifold(IntegralManifold {
            position: gain("position"),
            velocity: gain("velocity"),
            damping: gain("damping"),
        }),
        "passivity" => AnyLaw::Passivity(Passivity {
            shaping: gain("shaping"),
            link_damping: gain("link_damping"),
            motor_damping: gain("motor_damping"),
        }),
        "torque-feedback" => {
            AnyLaw::TorqueFeedback(TorqueFeedback { inertia: gain("inertia"), motor: motor() })
        }
        "singular-perturbation" => AnyLaw::SingularPerturbation(SingularPerturbation {
            position: gain("position"),
            velocity: gain("velocity"),
            damping: gain("damping"),
        }),
        "gravity-cancellation" => AnyLaw::GravityCancellation(GravityCancellation { motor: motor() }),
        "backstepping" => AnyLaw::Backstepping(Backstepping {
            shaping: gain("shaping"),
            link_damping: gain("link_damping"),
            metric: gain("metric"),
            motor_shaping: gain("motor_shaping"),
        }),
        "cascade" => AnyLaw::Cascade(Cascade {
            shaping: gain("shaping"),
            link_damping: gain("link_damping"),
            position: gain("position"),
            velocity: gain("velocity"),
        }),
        "esp" => AnyLaw::Esp(Esp { link_damping: gain("link_damping"), motor: motor() }),
        kind => unreachable!("{kind} is in the reader's table and not here"),
    }
}

/// The v-CBC law with the gains of a scenario.
pub fn law<const N: usize>(gains: &VcbcGains) -> Law<f64, N> {
    law_over(gains, |x| x)
}

/// The v-CBC law with every gain of a scenario through `number`: [`Scenario::bounds`] for the law over intervals that
/// encloses what the decimals in the file say.
///
/// [`Scenario::bounds`]: crate::scenario::Scenario::bounds
pub fn law_over<C: Scalar, const N: usize>(gains: &VcbcGains, number: impl Fn(f64) -> C) -> Law<C, N> {
    let VcbcGains { phi, link, motor } = gains;
    let gains = |values: &[f64]| padded(values, 1.0).map(&number);
    let base = gains(&link.metric);
    let metric = match &link.metric_hardening {
        Some(hardening) => Metric::Hardening { base, hardening: gains(hardening) },
        None => Metric::Constant(base),
    };
    let shaping = |side: &SideGains| shaping(*phi, gains(&side.shaping), side.kappa.as_deref().map(gains));
    Vcbc {
        link: LinkGains { metric, shaping: shaping(link), damping: gains(&link.damping) },
        motor: MotorGains {
            metric: gains(&motor.metric),
            shaping: shaping(motor),
            damping: gains(&motor.damping),
        },
    }
}

/// What the v-CBC `law` commands the robot at `x` to do, following `q_ld`, the reference in rad to order 4. Compiled once
/// per robot: it is much code, wanted in many places.
#[inline(never)]
pub fn command<L: Links<f64, N>, const N: usize>(
    law: &Law<f64, N>,
    robot: &Fjr<f64, L, N>,
    x: &Motion<f64, N>,
    q_ld: &Vector<Jet<f64, 5>, N>,
) -> Command<f64, N> {
    law.command(robot, x, q_ld, &Input::ZERO)
}

/// What `law` asks of the motors of the robot at `x` [N m], following `q_ld`, the reference in rad to order 4. Compiled
/// once per robot, as [`command`] is.
#[inline(never)]
pub fn torque<L: Links<f64, N>, const N: usize>(
    law: &AnyLaw<f64, N>,
    robot: &Fjr<f64, L, N>,
    x: &Motion<f64, N>,
    q_ld: &Vector<Jet<f64, 5>, N>,
) -> Vector<f64, N> {
    match law {
        AnyLaw::Vcbc(law) => command(law, robot, x, q_ld).u_m,
        law => law.torque(robot, x, q_ld),
    }
}

fn shaping<C: Scalar, const N: usize>(
    phi: Phi,
    gain: Vector<C, N>,
    kappa: Option<Vector<C, N>>,
) -> AnyShaping<C, N> {
    AnyShaping::new(phi.name(), gain, kappa)
        .expect("the reader takes registered names only, and asks for kappa where it is needed")
}
