//! The certificate: everything that is needed to check a proof without the prover. Its text is JSON; what each number
//! claims is stated in `docs/certificate.md`. In the published schema the types keep the names that the format gave them first.

use flexure_core::scalar::Interval;
use serde::Serialize;

use crate::prove::engine::number::Number;

/// Version of the format.
pub const VERSION: u32 = 3;

/// A proof in numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
pub struct Certificate {
    /// "flexure-certificate".
    pub format: String,
    /// Version of the format.
    pub version: u32,
    /// Name of the scenario.
    pub name: String,
    /// Program and version that wrote it.
    pub made_by: String,
    /// What the files of the loop say, hashed; none of a loop that was not read from files.
    pub subject: Option<Subject>,
    /// What no source vouches for, and options that were not given.
    pub assumptions: Vec<String>,
    /// The robot.
    pub robot: DecimalRobot,
    /// The law with its gains.
    pub controller: DecimalLaw,
    /// Errors for which the claims hold.
    pub region: CertifiedRegion,
    /// The variational closed loop in words.
    pub closed_loop: ClosedLoopWords,
    /// The rates of the four blocks.
    pub blocks: Vec<Block>,
    /// Decay rate of the distance between any two virtual solutions [1/s]; none where Π_l depends on the error.
    pub contraction_rate: Option<Number>,
    /// Decay rate of the distance to the reference [1/s].
    pub convergence_rate: Number,
    /// Why the mass matrix is positive definite at every configuration.
    pub mass_matrix: MassMatrix,
    /// Matrix measures of the slopes of φ.
    pub measures: Vec<Measure>,
    /// Which structures the closed loop keeps; nothing is said of them where Π_l depends on the error.
    pub structure: Vec<StructureClaim>,
    /// Error tube under a disturbance of the motors.
    pub tube: Option<Tube>,
    /// A contraction rate in a metric that grows with the error.
    pub stretched: Option<StretchedClaim>,
}

impl Certificate {
    /// The file: JSON.
    ///
    /// # Panics
    /// Never: there is nothing in it that JSON cannot say.
    pub fn text(&self) -> String {
        serde_json::to_string_pretty(self).expect("texts and lists") + "\n"
    }
}

/// SHA-256 of what the files of a loop say, in hexadecimal: `docs/certificate.md` has their normal form.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
pub struct Subject {
    /// The robot file, with the URDF that it names.
    pub robot: String,
    /// The scenario file without its robot.
    pub scenario: String,
}

/// A flexible-joint robot in decimals.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Robot", deny_unknown_fields))]
pub struct DecimalRobot {
    /// Its name.
    pub name: String,
    /// Number of joints.
    pub joints: usize,
    /// The links.
    pub links: DecimalLinks,
    /// K [N m/rad].
    pub stiffness: Vec<Number>,
    /// M_m [kg m²].
    pub motor_inertia: Vec<Number>,
    /// D_l [N m s/rad].
    pub link_damping: Vec<Number>,
    /// D_m [N m s/rad].
    pub motor_damping: Vec<Number>,
}

/// The links of a robot in decimals.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[cfg_attr(test, schemars(rename = "Links"))]
pub enum DecimalLinks {
    /// Two links in a plane, in closed form.
    PlanarTwoLink {
        /// Masses in kg.
        mass: [Number; 2],
        /// Length of the first link in m.
        length: Number,
        /// Distances of the centres of mass from the joints in m.
        com: [Number; 2],
        /// Inertias about the centres of mass [kg m²].
        inertia: [Number; 2],
    },
    /// One link.
    Pendulum {
        /// Mass in kg.
        mass: Number,
        /// Distance of the centre of mass from the joint in m.
        com: Number,
        /// Inertia about the centre of mass [kg m²].
        inertia: Number,
    },
    /// A tree of joints.
    Tree {
        /// Parents before children.
        bodies: Vec<DecimalBody>,
    },
}

/// A body of a tree and the joint that carries it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Body", deny_unknown_fields))]
pub struct DecimalBody {
    /// Index of the body that carries the joint; none for the base.
    pub parent: Option<usize>,
    /// How the joint moves.
    pub kind: JointMotion,
    /// Unit joint axis in the body's frame.
    pub axis: [Number; 3],
    /// The body's frame in the parent's at q = 0, by rows.
    pub rotation: [[Number; 3]; 3],
    /// Origin of the body's frame in the parent's in m.
    pub translation: [Number; 3],
    /// Mass in kg.
    pub mass: Number,
    /// Centre of mass in the body's frame in m.
    pub com: [Number; 3],
    /// Inertia about the centre of mass: xx, xy, xz, yy, yz, zz [kg m²].
    pub inertia: [Number; 6],
    /// For a prismatic joint: its lower and upper end in m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub travel: Option<[Number; 2]>,
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(test, schemars(rename = "JointKind"))]
pub enum JointMotion {
    /// About its axis.
    Revolute,
    /// Along its axis.
    Prismatic,
}

/// The law with its gains.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Controller", deny_unknown_fields))]
pub struct DecimalLaw {
    /// Shaping function of both sides.
    pub phi: CertifiedPhi,
    /// Link side.
    pub link: DecimalGains,
    /// Motor side.
    pub motor: DecimalGains,
}

/// A shaping function with a structure theorem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(test, schemars(rename = "Phi"))]
pub enum CertifiedPhi {
    /// φ_1 = Λ tanh q̃.
    Tanh,
    /// φ_2 = Λ q̃.
    Linear,
    /// φ_3 = (1 + κ) q̃ with tanh of the errors of the other joints.
    CoupledTanh,
}

/// The gains of one side, one number per joint.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Gains", deny_unknown_fields))]
pub struct DecimalGains {
    /// Metric Π [N m/rad].
    pub metric: Vec<Number>,
    /// Gain Λ inside φ [1/s].
    pub shaping: Vec<Number>,
    /// Injected damping K_d [N m s/rad].
    pub damping: Vec<Number>,
    /// κ of `coupled-tanh` [1/s].
    pub kappa: Option<Vec<Number>>,
    /// Growth of Π_l with the squared error [N m/rad³]; none where Π is constant.
    pub hardening: Option<Vec<Number>>,
}

/// Errors for which the claims hold, and a level set of W inside.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Region", deny_unknown_fields))]
pub struct CertifiedRegion {
    /// Largest |q̃_i| in rad, links then motors; none for no bound.
    pub error: Vec<Option<Number>>,
    /// c: {W ≤ c} lies inside and is invariant, in J; none where the errors are not bounded.
    pub level: Option<Number>,
}

/// The variational closed loop in words that do not commute.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "ClosedLoop", deny_unknown_fields))]
pub struct ClosedLoopWords {
    /// d/dt of δq̃_l, δq̃_m, δσ_l, δσ_m from δq̃_l, δq̃_m, δs_l, δs_m.
    pub rows: [[String; 4]; 4],
    /// What Ẇ is made of once the coupling has cancelled: the sum of −δz_iᵀ X_i δz_i.
    pub dissipation: [String; 4],
}

/// The rates of one block.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
pub struct Block {
    /// Block of the closed loop.
    pub block: BlockName,
    /// Rate with the slopes of φ [1/s].
    pub contraction: Number,
    /// Rate with its chords from the origin [1/s].
    pub convergence: Number,
    /// The matrices that cover all others.
    pub cases: Vec<Case>,
}

/// A block of the closed loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum BlockName {
    /// Link positions.
    PhiL,
    /// Motor positions.
    PhiM,
    /// Link momenta.
    SigmaL,
    /// Motor momenta.
    SigmaM,
}

impl BlockName {
    /// The name in certificates.
    pub fn name(self) -> &'static str {
        match self {
            Self::PhiL => "phi_l",
            Self::PhiM => "phi_m",
            Self::SigmaL => "sigma_l",
            Self::SigmaM => "sigma_m",
        }
    }
}

/// A matrix that has to be positive definite at the claimed rates, and by how much its pivots are positive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
pub struct Case {
    /// Which ends of their ranges the variables are at: a letter each, L or H.
    pub case: String,
    /// Least pivot at the contraction rate.
    pub contraction: Number,
    /// Least pivot at the convergence rate.
    pub convergence: Number,
}

/// Why the mass matrix is positive definite, and for trees what bounds it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
pub struct MassMatrix {
    /// Lower bounds of pivots: one per case or body.
    pub margins: Vec<Number>,
    /// For trees a form for each joint: 7 numbers if it turns, 21 if it slides, none at the base.
    pub forms: Option<Vec<Option<Vec<Number>>>>,
}

/// An upper bound of a matrix measure of −Θ ∂φ Θ⁻¹.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
pub struct Measure {
    /// Side whose φ it is about: links or motors.
    pub side: LoopSide,
    /// Norm that the measure belongs to.
    pub norm: Norm,
    /// The bound [1/s].
    pub bound: Number,
}

/// Links or motors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[cfg_attr(test, schemars(rename = "Side"))]
pub enum LoopSide {
    /// Links.
    Link,
    /// Motors.
    Motor,
}

/// The norm that a matrix measure belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub enum Norm {
    /// Sums of absolute values.
    #[serde(rename = "1")]
    One,
    /// Euclidean.
    #[serde(rename = "2")]
    Two,
    /// Largest absolute value.
    #[serde(rename = "inf")]
    Infinity,
}

/// Whether the closed loop keeps a structure.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Structure", deny_unknown_fields))]
pub struct StructureClaim {
    /// The structure.
    pub name: StructureName,
    /// Whether the closed loop keeps it.
    pub holds: bool,
    /// An error at which it is lost; none if it is kept.
    pub witness: Option<Witness>,
}

/// A structure that the closed loop may keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum StructureName {
    /// The variation is a port-Hamiltonian system.
    VariationalPh,
    /// The closed loop itself is one.
    PhLike,
    /// Strict differential passivity from δω to M⁻¹ δσ.
    StrictDifferentialPassivity,
    /// Incremental passivity of χ = Π φ.
    IncrementalPassivity,
}

/// An error at which two numbers differ that a structure wants equal.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
pub struct Witness {
    /// Side whose φ it is about: links or motors.
    pub side: LoopSide,
    /// q̃ of that side in rad.
    pub error: Vec<Number>,
    /// Row of the entry.
    pub row: usize,
    /// Column of the entry.
    pub column: usize,
    /// By how much they differ at least.
    pub difference: Number,
}

/// An error tube under a disturbance torque of the motors.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
pub struct Tube {
    /// Largest |d_i| [N m].
    pub disturbance: Vec<Number>,
    /// c: {W ≤ c} is invariant and attracts, in J.
    pub level: Number,
    /// What |q̃_i| ≤ there, links then motors, in rad.
    pub error: Vec<Number>,
}

/// A contraction rate of any two solutions while both have position errors in the region and velocity errors up to a bound, in a metric
/// that counts position errors for more where tanh is flat.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "Stretched", deny_unknown_fields))]
pub struct StretchedClaim {
    /// Largest |s_i| = |(M⁻¹ σ)_i|, links then motors [rad/s].
    pub velocity_error: Vec<Number>,
    /// b of the stretch of each position error, links then motors: 0 < b < 1; none where nothing is stretched.
    pub exponent: Vec<Option<Number>>,
    /// The rate [1/s].
    pub rate: Number,
}

/// Enclosures of a list of numbers.
pub(crate) fn bounds(numbers: &[Number]) -> Vec<Interval> {
    numbers.iter().map(Number::bounds).collect()
}

impl DecimalGains {
    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.metric.len()
    }
}
