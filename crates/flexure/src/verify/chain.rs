//! The chain that bounds the mass matrix of a tree for all configurations: what hangs on a joint has at most the kinetic energy
//! that the joint's form gives it.

use flexure_core::scalar::{Interval, Scalar};

use crate::verify::field::Field;
use crate::verify::frame::{inertia, rotation, unit_axis, values};
use crate::verify::matrix::Symmetric;
use crate::verify::number::Number;
use crate::verify::robot::{Body, Links};
use crate::verify::vector::{Vec3, cross, dot, plus, scaled, turned};
use crate::verify::verdict::Rejected;

/// The parameters of the form of each joint; none of one at the base.
pub(super) type Forms = Vec<Option<Vec<Number>>>;

/// The forms as the file has them: for trees, a joint each.
pub(super) fn read(field: Field<'_>, links: &Links) -> Result<Option<Forms>, Rejected> {
    let Links::Tree(bodies) = links else {
        return match field.unless_null() {
            None => Ok(None),
            Some(field) => Err(field.bad("must be null but for trees")),
        };
    };
    let form = |(field, body): (Field<'_>, &Body)| match body.parent {
        None => match field.unless_null() {
            None => Ok(None),
            Some(field) => Err(field.bad("must be null for a joint at the base")),
        },
        Some(_) => Ok(Some(field.numbers(if body.travel.is_some() { 21 } else { 7 })?)),
    };
    let entries = field.list_of(bodies.len())?;
    Ok(Some(entries.into_iter().zip(bodies).map(form).collect::<Result<_, _>>()?))
}

/// Angular velocity, and velocity of the frame's origin.
type Velocity = (Vec3, Vec3);

const REST: Velocity = ([Interval::ZERO; 3], [Interval::ZERO; 3]);

/// A link: its body, the form of its joint, its children.
struct Link<'a> {
    body: &'a Body,
    axis: Vec3,
    rotation: [Vec3; 3],
    inertia: [Vec3; 3],
    form: Option<Vec<Interval>>,
    children: Vec<usize>,
}

pub(super) struct Chain<'a>(Vec<Link<'a>>);

/// A matrix of the chain: that of a joint, of one that slides at an end of its travel.
pub(super) struct Case {
    pub name: String,
    pub joint: usize,
    travelled: Option<Interval>,
}

impl<'a> Chain<'a> {
    pub(super) fn new(bodies: &'a [Body], forms: &Forms) -> Result<Self, Rejected> {
        let link = |(k, (body, form)): (usize, (&'a Body, &Option<Vec<Number>>))| {
            Ok(Link {
                body,
                axis: unit_axis(k, body)?,
                rotation: rotation(k, body)?,
                inertia: inertia(body),
                form: form.as_ref().map(|form| form.iter().map(|number| number.value).collect()),
                children: (0..bodies.len()).filter(|&c| bodies[c].parent == Some(k)).collect(),
            })
        };
        Ok(Self(bodies.iter().zip(forms).enumerate().map(link).collect::<Result<_, _>>()?))
    }

    pub(super) fn cases(&self) -> Vec<Case> {
        let of = |(joint, link): (usize, &Link<'_>)| {
            let case = |end: &str, travelled| Case { name: format!("{joint}{end}"), joint, travelled };
            match &link.body.travel {
                Some([lower, upper]) if link.form.is_some() => {
                    vec![case("L", Some(lower.value)), case("H", Some(upper.value))]
                }
                _ => vec![case("", None)],
            }
        };
        self.0.iter().enumerate().flat_map(of).collect()
    }

    /// diag(Q, B) less what the body and the forms of its children have, for the velocities of the body that come of the six
    /// of its joint's place and of the joint's own rate; of the latter alone at the base.
    pub(super) fn matrix(&self, case: &Case, damping: Interval, beta: Interval) -> Symmetric {
        let link = &self.0[case.joint];
        let mut velocities = Vec::new();
        if link.form.is_some() {
            velocities.extend((0..6).map(|i| {
                let mut unit = REST;
                let part = if i < 3 { &mut unit.0 } else { &mut unit.1 };
                part[i % 3] = Interval::ONE;
                unit
            }));
        }
        let shift = case.travelled.map_or([Interval::ZERO; 3], |travelled| scaled(link.axis, travelled));
        let mut of_body: Vec<Velocity> =
            velocities.iter().map(|&(turn, along)| (turn, plus(along, cross(turn, shift)))).collect();
        of_body.push(if link.body.travel.is_some() { (REST.0, link.axis) } else { (link.axis, REST.1) });
        let rate = velocities.len();
        Symmetric::from_fn(of_body.len(), |i, j| {
            let bound = match &link.form {
                _ if i == rate && j == rate => damping,
                Some(form) if i < rate && j < rate => link.form(form, velocities[i], velocities[j]),
                _ => Interval::ZERO,
            };
            let carried = link.children.iter().map(|&c| {
                let child = &self.0[c];
                let at = |v| child.carried_by_parent(v);
                let form = child.form.as_deref().unwrap_or_default();
                child.form(form, at(of_body[i]), at(of_body[j]))
            });
            carried.fold(bound - beta * link.energy(of_body[i], of_body[j]), |rest, form| rest - form)
        })
    }
}

impl Link<'_> {
    /// The velocity of the frame, its joint at 0 and at rest, from the parent's.
    fn carried_by_parent(&self, (turn, along): Velocity) -> Velocity {
        let back = |v: Vec3| [0, 1, 2].map(|i| dot(self.rotation.map(|row| row[i]), v));
        (back(turn), back(plus(along, cross(turn, values(&self.body.translation)))))
    }

    /// The body's own kinetic energy, twice, as a bilinear form.
    fn energy(&self, u: Velocity, v: Velocity) -> Interval {
        let com = |(turn, along): Velocity| plus(along, cross(turn, values(&self.body.com)));
        dot(u.0, turned(self.inertia, v.0)) + self.body.mass.value * dot(com(u), com(v))
    }

    /// The form with the parameters `y`, as a bilinear form.
    fn form(&self, y: &[Interval], u: Velocity, v: Velocity) -> Interval {
        if let &[y0, y1, y2, y3, y4, y5, y6] = y {
            let e = self.axis;
            // Across the axis, along it, and turned about it.
            let pair = |a: Vec3, b: Vec3, across: Interval, along: Interval| {
                let both = dot(a, e) * dot(b, e);
                across * (dot(a, b) - both) + along * both
            };
            let mixed = |a: Vec3, b: Vec3| pair(a, b, y4, y5) + y6 * dot(a, cross(e, b));
            return pair(u.0, v.0, y0, y1) + pair(u.1, v.1, y2, y3) + mixed(u.0, v.1) + mixed(v.0, u.1);
        }
        let six = |(turn, along): Velocity| [turn, along].concat();
        let (u, v) = (six(u), six(v));
        let mut total = Interval::ZERO;
        for (i, row) in (0..6).map(|i| (i, &y[i * (i + 1) / 2..])) {
            for j in 0..i {
                total += row[j] * (u[i] * v[j] + u[j] * v[i]);
            }
            total += row[i] * (u[i] * v[i]);
        }
        total
    }
}
