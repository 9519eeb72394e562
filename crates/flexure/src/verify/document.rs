//! The file as types. What is here has the right keys, names and list lengths; nothing is said of the numbers yet.

use crate::verify::chain::{self, Forms};
use crate::verify::field::Field;
use crate::verify::json::Node;
use crate::verify::number::{Number, Stronger};
use crate::verify::robot::{self, Robot};
use crate::verify::subject::{self, Subject};
use crate::verify::verdict::Rejected;

/// A certificate as its file says it.
pub(super) struct Certificate {
    pub version: Version,
    pub name: String,
    pub made_by: String,
    pub subject: Option<Subject>,
    pub assumptions: Vec<String>,
    pub robot: Robot,
    pub controller: Controller,
    pub region: Region,
    pub closed_loop: ClosedLoop,
    pub blocks: Vec<Block>,
    /// None where Π_l depends on the error.
    pub contraction_rate: Option<Number>,
    pub convergence_rate: Number,
    pub mass_margins: Vec<Number>,
    /// What bounds the mass matrix of a tree; none in version 1, and for other links.
    pub forms: Option<Forms>,
    pub measures: Vec<Measure>,
    pub structure: Vec<Property>,
    pub tube: Option<Tube>,
    pub stretched: Option<Stretched>,
}

/// Version of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Version {
    One,
    Two,
    Three,
}

impl Version {
    /// A number that is claimed. From version 2 on it is held to a rounded one.
    fn claim(self, field: &Field<'_>, stronger: Stronger) -> Result<Number, Rejected> {
        let number = field.number()?;
        Ok(if self == Self::One { number } else { number.held_to(stronger) })
    }

    /// A margin, which is far from what was found: rounded in every version.
    fn margin(field: &Field<'_>) -> Result<Number, Rejected> {
        Ok(field.number()?.held_to(Stronger::Up(1)))
    }

    /// A number that was found as it is, up to rounding: the more the stronger.
    fn up(self, field: &Field<'_>) -> Result<Number, Rejected> {
        self.claim(field, Stronger::Up(DIGITS))
    }

    /// A rate, by which a pivot hangs that nearly vanishes.
    fn rate(self, field: &Field<'_>) -> Result<Number, Rejected> {
        self.claim(field, Stronger::Up(RATE_DIGITS))
    }

    /// A number that was found as it is, up to rounding: the less the stronger.
    fn down(self, field: &Field<'_>) -> Result<Number, Rejected> {
        self.claim(field, Stronger::Down(DIGITS))
    }
}

/// Digits of claims that are compared with what a checker finds.
const DIGITS: usize = 9;

/// Digits of rates.
const RATE_DIGITS: usize = 13;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Link,
    Motor,
}

pub(super) const SIDES: [(&str, Side); 2] = [("link", Side::Link), ("motor", Side::Motor)];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phi {
    Tanh,
    Linear,
    CoupledTanh,
}

pub(super) struct Controller {
    pub phi: Phi,
    link: Gains,
    motor: Gains,
}

impl Controller {
    pub fn gains(&self, side: Side) -> &Gains {
        match side {
            Side::Link => &self.link,
            Side::Motor => &self.motor,
        }
    }
}

pub(super) struct Gains {
    pub metric: Vec<Number>,
    pub shaping: Vec<Number>,
    pub damping: Vec<Number>,
    /// κ of `coupled-tanh`; empty for other laws.
    pub kappa: Vec<Number>,
    /// Growth of Π with the squared error; empty where it is constant.
    pub hardening: Vec<Number>,
}

pub(super) struct Region {
    /// One an entry; none without a bound.
    pub error: Vec<Option<Number>>,
    pub level: Option<Number>,
}

pub(super) struct ClosedLoop {
    pub rows: [[String; 4]; 4],
    pub dissipation: [String; 4],
}

pub(super) struct Block {
    pub name: String,
    pub contraction: Number,
    pub convergence: Number,
    pub cases: Vec<Case>,
}

pub(super) struct Case {
    pub name: String,
    pub contraction: Number,
    pub convergence: Number,
}

pub(super) struct Measure {
    pub side: Side,
    pub norm: String,
    pub bound: Number,
}

pub(super) struct Property {
    pub name: String,
    pub holds: bool,
    pub witness: Option<Witness>,
}

pub(super) struct Witness {
    pub side: Side,
    pub error: Vec<Number>,
    pub row: usize,
    pub column: usize,
    pub difference: Number,
}

pub(super) struct Tube {
    pub disturbance: Vec<Number>,
    /// As a claim that so much is enough.
    pub level: Number,
    /// The same as what errors follow from.
    pub reached: Number,
    pub error: Vec<Number>,
}

pub(super) struct Stretched {
    pub velocity_error: Vec<Number>,
    /// b, links then motors; none where nothing is stretched.
    pub exponent: Vec<Option<Number>>,
    pub rate: Number,
}

const KEYS: [&str; 18] = [
    "format",
    "version",
    "name",
    "made_by",
    "assumptions",
    "robot",
    "controller",
    "region",
    "closed_loop",
    "blocks",
    "contraction_rate",
    "convergence_rate",
    "mass_matrix",
    "measures",
    "structure",
    "tube",
    "subject",
    "stretched",
];

/// Bytes that a certificate may have.
pub const LARGEST: u64 = 4 << 20;

pub(super) fn read(text: &str) -> Result<Certificate, Rejected> {
    if text.len() as u64 > LARGEST {
        return Err(Field::root(&Node::Null).bad("is larger than 4 MiB"));
    }
    let node: Node = serde_json::from_str(text).map_err(|error| Rejected::Malformed {
        place: "the file".to_owned(),
        reason: error.to_string(),
        line: Some(error.line()),
        column: Some(error.column()),
    })?;
    certificate(&Field::root(&node))
}

fn certificate(root: &Field<'_>) -> Result<Certificate, Rejected> {
    // What is no certificate at all says so, rather than which key is missing.
    if root.get("format")?.is_none_or(|format| format.text() != Ok("flexure-certificate")) {
        return Err(root.bad("has no \"format\": \"flexure-certificate\""));
    }
    let version = self::version(root)?;
    let (
        [_, _, name, made_by, assumptions, robot, controller, region, closed_loop, rest @ ..],
        subject,
        stretched,
    ) = match version {
        Version::One => {
            let [keys @ .., _, _] = KEYS;
            (root.object(keys)?, None, None)
        }
        Version::Two => {
            let [keys @ .., _] = KEYS;
            let [fields @ .., subject] = root.object(keys)?;
            (fields, subject.unless_null(), None)
        }
        Version::Three => {
            let [fields @ .., subject, stretched] = root.object(KEYS)?;
            (fields, subject.unless_null(), stretched.unless_null())
        }
    };
    let [blocks, contraction_rate, convergence_rate, mass_matrix, measures, structure, tube] = rest;
    let robot = robot::read(&robot)?;
    let n = robot.joints;
    let (mass_margins, forms) = if version == Version::One {
        let [margins] = mass_matrix.object(["margins"])?;
        (margins, None)
    } else {
        let [margins, forms] = mass_matrix.object(["margins", "forms"])?;
        (margins, chain::read(forms, &robot.links)?)
    };
    Ok(Certificate {
        version,
        made_by: made_by.text()?.to_owned(),
        subject: subject.map(|subject| subject::read(&subject)).transpose()?,
        name: name.text()?.to_owned(),
        assumptions: each(&assumptions, |text| Ok(text.text()?.to_owned()))?,
        controller: self::controller(&controller, n, version)?,
        region: self::region(&region, n, version)?,
        closed_loop: self::closed_loop(&closed_loop)?,
        blocks: each(&blocks, |entry| block(entry, version))?,
        contraction_rate: match version {
            Version::One | Version::Two => Some(contraction_rate.number()?),
            Version::Three => contraction_rate.unless_null().map(|rate| rate.number()).transpose()?,
        },
        convergence_rate: convergence_rate.number()?,
        mass_margins: each(&mass_margins, Version::margin)?,
        forms,
        measures: each(&measures, |entry| measure(entry, version))?,
        structure: each(&structure, |entry| property(entry, n, version))?,
        tube: tube.unless_null().map(|tube| self::tube(&tube, n, version)).transpose()?,
        stretched: stretched.map(|claim| self::stretched(&claim, n, version)).transpose()?,
        robot,
    })
}

/// Which keys there are.
fn version(root: &Field<'_>) -> Result<Version, Rejected> {
    let version = root.get("version")?.ok_or_else(|| root.bad("key 'version' is missing"))?;
    match version.index()? {
        1 => Ok(Version::One),
        2 => Ok(Version::Two),
        3 => Ok(Version::Three),
        _ => Err(version.bad("must be 1, 2 or 3")),
    }
}

fn each<'a, T>(
    list: &Field<'a>,
    read: impl Fn(&Field<'a>) -> Result<T, Rejected>,
) -> Result<Vec<T>, Rejected> {
    list.list()?.iter().map(read).collect()
}

fn controller(field: &Field<'_>, n: usize, version: Version) -> Result<Controller, Rejected> {
    let [phi, link, motor] = field.object(["phi", "link", "motor"])?;
    let phi =
        phi.one_of(&[("tanh", Phi::Tanh), ("linear", Phi::Linear), ("coupled-tanh", Phi::CoupledTanh)])?;
    // A region of coupled slopes has 2ⁿ vertices.
    if phi == Phi::CoupledTanh && n > 16 {
        return Err(field.bad("'coupled-tanh' is for 16 joints at most"));
    }
    let (link, motor) = (gains(&link, phi, n, version)?, gains(&motor, phi, n, version)?);
    if !motor.hardening.is_empty() || !link.hardening.is_empty() && phi == Phi::CoupledTanh {
        return Err(field.bad("hardening is for the link, where phi is tanh or linear"));
    }
    Ok(Controller { phi, link, motor })
}

fn gains(field: &Field<'_>, phi: Phi, n: usize, version: Version) -> Result<Gains, Rejected> {
    const KEYS: [&str; 5] = ["metric", "shaping", "damping", "kappa", "hardening"];
    let ([metric, shaping, damping, kappa], hardening) = if version == Version::Three {
        let [four @ .., hardening] = field.object(KEYS)?;
        (four, hardening.unless_null())
    } else {
        let [four @ .., _] = KEYS;
        (field.object(four)?, None)
    };
    let kappa = match (phi, kappa.unless_null()) {
        (Phi::CoupledTanh, Some(kappa)) => kappa.numbers(n)?,
        (Phi::CoupledTanh, None) => return Err(field.bad("'coupled-tanh' needs kappa")),
        (_, None) => Vec::new(),
        (_, Some(kappa)) => return Err(kappa.bad("must be null but for 'coupled-tanh'")),
    };
    Ok(Gains {
        metric: metric.numbers(n)?,
        shaping: shaping.numbers(n)?,
        damping: damping.numbers(n)?,
        kappa,
        hardening: hardening.map_or(Ok(Vec::new()), |hardening| hardening.numbers(n))?,
    })
}

fn region(field: &Field<'_>, n: usize, version: Version) -> Result<Region, Rejected> {
    let [error, level] = field.object(["error", "level"])?;
    let bound = |field: Field<'_>| field.unless_null().map(|field| field.number()).transpose();
    let error = error.list_of(2 * n)?.into_iter().map(bound).collect::<Result<_, _>>()?;
    let level = level.unless_null().map(|level| version.up(&level)).transpose()?;
    Ok(Region { error, level })
}

fn closed_loop(field: &Field<'_>) -> Result<ClosedLoop, Rejected> {
    let [rows, dissipation] = field.object(["rows", "dissipation"])?;
    let word = |field: &Field<'_>| field.text().map(str::to_owned);
    Ok(ClosedLoop { rows: rows.array(|row| row.array(word))?, dissipation: dissipation.array(word)? })
}

fn block(field: &Field<'_>, version: Version) -> Result<Block, Rejected> {
    let [name, contraction, convergence, cases] =
        field.object(["block", "contraction", "convergence", "cases"])?;
    Ok(Block {
        name: name.text()?.to_owned(),
        contraction: version.rate(&contraction)?,
        convergence: version.rate(&convergence)?,
        cases: each(&cases, |case| {
            let [name, contraction, convergence] = case.object(["case", "contraction", "convergence"])?;
            Ok(Case {
                name: name.text()?.to_owned(),
                contraction: Version::margin(&contraction)?,
                convergence: Version::margin(&convergence)?,
            })
        })?,
    })
}

fn measure(field: &Field<'_>, version: Version) -> Result<Measure, Rejected> {
    let [side, norm, bound] = field.object(["side", "norm", "bound"])?;
    Ok(Measure { side: side.one_of(&SIDES)?, norm: norm.text()?.to_owned(), bound: version.down(&bound)? })
}

fn property(field: &Field<'_>, n: usize, version: Version) -> Result<Property, Rejected> {
    let [name, holds, witness] = field.object(["name", "holds", "witness"])?;
    let witness = witness.unless_null().map(|witness| self::witness(&witness, n, version)).transpose()?;
    Ok(Property { name: name.text()?.to_owned(), holds: holds.truth()?, witness })
}

fn witness(field: &Field<'_>, n: usize, version: Version) -> Result<Witness, Rejected> {
    let [side, error, row, column, difference] =
        field.object(["side", "error", "row", "column", "difference"])?;
    let index = |field: &Field<'_>| match field.index()? {
        index if index < n => Ok(index),
        _ => Err(field.bad(format!("must be less than {n}"))),
    };
    Ok(Witness {
        side: side.one_of(&SIDES)?,
        error: error.numbers(n)?,
        row: index(&row)?,
        column: index(&column)?,
        difference: version.claim(&difference, Stronger::Up(1))?,
    })
}

fn tube(field: &Field<'_>, n: usize, version: Version) -> Result<Tube, Rejected> {
    let [disturbance, level, error] = field.object(["disturbance", "level", "error"])?;
    Ok(Tube {
        disturbance: disturbance.numbers(n)?,
        reached: version.up(&level)?,
        level: version.down(&level)?,
        error: error.list_of(2 * n)?.iter().map(|error| version.down(error)).collect::<Result<_, _>>()?,
    })
}

fn stretched(field: &Field<'_>, n: usize, version: Version) -> Result<Stretched, Rejected> {
    let [velocity_error, exponent, rate] = field.object(["velocity_error", "exponent", "rate"])?;
    let number = |field: Field<'_>| field.unless_null().map(|field| field.number()).transpose();
    Ok(Stretched {
        velocity_error: velocity_error.numbers(2 * n)?,
        exponent: exponent.list_of(2 * n)?.into_iter().map(number).collect::<Result<_, _>>()?,
        rate: version.up(&rate)?,
    })
}
