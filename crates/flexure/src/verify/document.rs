//! The file as types. What is here has the right keys, names and list lengths; nothing is said of the numbers yet.

use crate::verify::chain::{self, Forms};
use crate::verify::field::Field;
use crate::verify::json::Node;
use crate::verify::number::Number;
use crate::verify::robot::{self, Robot};
use crate::verify::verdict::Rejected;

/// A certificate as its file says it.
pub(super) struct Certificate {
    pub name: String,
    pub assumptions: Vec<String>,
    pub robot: Robot,
    pub controller: Controller,
    pub region: Region,
    pub closed_loop: ClosedLoop,
    pub blocks: Vec<Block>,
    pub contraction_rate: Number,
    pub convergence_rate: Number,
    pub mass_margins: Vec<Number>,
    /// What bounds the mass matrix of a tree; none in version 1, and for other links.
    pub forms: Option<Forms>,
    pub measures: Vec<Measure>,
    pub structure: Vec<Property>,
    pub tube: Option<Tube>,
}

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
    pub level: Number,
    pub error: Vec<Number>,
}

const KEYS: [&str; 16] = [
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
];

/// Largest file, in bytes.
const LARGEST: usize = 4 << 20;

pub(super) fn read(text: &str) -> Result<Certificate, Rejected> {
    if text.len() > LARGEST {
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
    let [_, version, name, made_by, assumptions, robot, controller, region, closed_loop, rest @ ..] =
        root.object(KEYS)?;
    let [blocks, contraction_rate, convergence_rate, mass_matrix, measures, structure, tube] = rest;
    let first = match version.index()? {
        1 => true,
        2 => false,
        _ => return Err(version.bad("must be 1 or 2")),
    };
    made_by.text()?;
    let robot = robot::read(&robot)?;
    let n = robot.joints;
    let (mass_margins, forms) = if first {
        let [margins] = mass_matrix.object(["margins"])?;
        (margins, None)
    } else {
        let [margins, forms] = mass_matrix.object(["margins", "forms"])?;
        (margins, chain::read(forms, &robot.links)?)
    };
    Ok(Certificate {
        name: name.text()?.to_owned(),
        assumptions: each(&assumptions, |text| Ok(text.text()?.to_owned()))?,
        controller: self::controller(&controller, n)?,
        region: self::region(&region, n)?,
        closed_loop: self::closed_loop(&closed_loop)?,
        blocks: each(&blocks, block)?,
        contraction_rate: contraction_rate.number()?,
        convergence_rate: convergence_rate.number()?,
        mass_margins: each(&mass_margins, Field::number)?,
        forms,
        measures: each(&measures, measure)?,
        structure: each(&structure, |entry| property(entry, n))?,
        tube: tube.unless_null().map(|tube| self::tube(&tube, n)).transpose()?,
        robot,
    })
}

fn each<'a, T>(
    list: &Field<'a>,
    read: impl Fn(&Field<'a>) -> Result<T, Rejected>,
) -> Result<Vec<T>, Rejected> {
    list.list()?.iter().map(read).collect()
}

fn controller(field: &Field<'_>, n: usize) -> Result<Controller, Rejected> {
    let [phi, link, motor] = field.object(["phi", "link", "motor"])?;
    let phi =
        phi.one_of(&[("tanh", Phi::Tanh), ("linear", Phi::Linear), ("coupled-tanh", Phi::CoupledTanh)])?;
    // A region of coupled slopes has 2ⁿ vertices.
    if phi == Phi::CoupledTanh && n > 16 {
        return Err(field.bad("'coupled-tanh' is for 16 joints at most"));
    }
    Ok(Controller { phi, link: gains(&link, phi, n)?, motor: gains(&motor, phi, n)? })
}

fn gains(field: &Field<'_>, phi: Phi, n: usize) -> Result<Gains, Rejected> {
    let [metric, shaping, damping, kappa] = field.object(["metric", "shaping", "damping", "kappa"])?;
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
    })
}

fn region(field: &Field<'_>, n: usize) -> Result<Region, Rejected> {
    let [error, level] = field.object(["error", "level"])?;
    let bound = |field: Field<'_>| field.unless_null().map(|field| field.number()).transpose();
    let error = error.list_of(2 * n)?.into_iter().map(bound).collect::<Result<_, _>>()?;
    Ok(Region { error, level: bound(level)? })
}

fn closed_loop(field: &Field<'_>) -> Result<ClosedLoop, Rejected> {
    let [rows, dissipation] = field.object(["rows", "dissipation"])?;
    let word = |field: &Field<'_>| field.text().map(str::to_owned);
    Ok(ClosedLoop { rows: rows.array(|row| row.array(word))?, dissipation: dissipation.array(word)? })
}

fn block(field: &Field<'_>) -> Result<Block, Rejected> {
    let [name, contraction, convergence, cases] =
        field.object(["block", "contraction", "convergence", "cases"])?;
    Ok(Block {
        name: name.text()?.to_owned(),
        contraction: contraction.number()?,
        convergence: convergence.number()?,
        cases: each(&cases, |case| {
            let [name, contraction, convergence] = case.object(["case", "contraction", "convergence"])?;
            Ok(Case {
                name: name.text()?.to_owned(),
                contraction: contraction.number()?,
                convergence: convergence.number()?,
            })
        })?,
    })
}

fn measure(field: &Field<'_>) -> Result<Measure, Rejected> {
    let [side, norm, bound] = field.object(["side", "norm", "bound"])?;
    Ok(Measure { side: side.one_of(&SIDES)?, norm: norm.text()?.to_owned(), bound: bound.number()? })
}

fn property(field: &Field<'_>, n: usize) -> Result<Property, Rejected> {
    let [name, holds, witness] = field.object(["name", "holds", "witness"])?;
    let witness = witness.unless_null().map(|witness| self::witness(&witness, n)).transpose()?;
    Ok(Property { name: name.text()?.to_owned(), holds: holds.truth()?, witness })
}

fn witness(field: &Field<'_>, n: usize) -> Result<Witness, Rejected> {
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
        difference: difference.number()?,
    })
}

fn tube(field: &Field<'_>, n: usize) -> Result<Tube, Rejected> {
    let [disturbance, level, error] = field.object(["disturbance", "level", "error"])?;
    Ok(Tube { disturbance: disturbance.numbers(n)?, level: level.number()?, error: error.numbers(2 * n)? })
}
