//! The planar two-link arm in closed form: `kind = "planar-two-link"`.

use flexure_core::robots;
use flexure_core::scalar::Scalar;

use crate::files::field::Field;
use crate::files::quantity::{self, Quantity};
use crate::files::table::Table;
use crate::robot::links::closed_form::{ClosedForm, LineBody, Placed, ReadClosedForm};
use crate::robot::links::{Body, JointKind};

/// Two links in a horizontal plane, in closed form; gravity does not act on them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarTwoLink<C = f64> {
    /// Masses \[kg\].
    pub mass: [C; 2],
    /// Lengths \[m\]; the second plays no part in the dynamics.
    pub length: [C; 2],
    /// Distances of the centres of mass from the joints \[m\].
    pub com: [C; 2],
    /// Rotational inertias about the centres of mass [kg m²].
    pub inertia: [C; 2],
}

impl<C: Scalar> PlanarTwoLink<C> {
    /// The links; gravity in the base frame [m/s²] does not act on them.
    pub fn core(&self, _: [C; 3]) -> robots::PlanarTwoLink<C> {
        robots::PlanarTwoLink::new(self.mass, self.length[0], self.com, self.inertia)
    }
}

impl<C> ClosedForm<C> for PlanarTwoLink<C> {
    const NAME: &'static str = "planar-two-link";
    const WHAT: &'static str = "a planar two-link arm";
    const JOINTS: usize = 2;

    type With<D> = PlanarTwoLink<D>;

    fn map<D>(&self, f: impl Fn(C) -> D) -> PlanarTwoLink<D>
    where
        C: Copy,
    {
        let Self { mass, length, com, inertia } = self;
        PlanarTwoLink {
            mass: mass.map(&f),
            length: length.map(&f),
            com: com.map(&f),
            inertia: inertia.map(&f),
        }
    }

    fn bodies(&mut self) -> Vec<LineBody<'_, C>> {
        let Self { mass, length: _, com, inertia } = self;
        let bodies = mass.iter_mut().zip(com).zip(inertia);
        bodies.map(|((mass, com), inertia)| LineBody { mass, com, inertia }).collect()
    }
}

impl ReadClosedForm for PlanarTwoLink {
    const KEYS: &'static [&'static str] = &["mass", "length", "com", "inertia"];

    fn read(table: &Table<'_>) -> Option<Self> {
        let read = |key, quantity: &Quantity| table.array(key, quantity, "one per link");
        let (mass, length) = (read("mass", &quantity::MASS), read("length", &quantity::LENGTH));
        let (com, inertia) = (read("com", &quantity::POSITION), read("inertia", &quantity::INERTIA));
        Some(Self { mass: mass?, length: length?, com: com?, inertia: inertia? })
    }

    fn placed(&self) -> Vec<Placed> {
        let Self { mass, length, com, inertia } = *self;
        let body = |i: usize| Body {
            parent: i.checked_sub(1),
            kind: JointKind::Revolute,
            axis: [0.0, 0.0, 1.0],
            rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            translation: [if i == 0 { 0.0 } else { length[0] }, 0.0, 0.0],
            mass: mass[i],
            com: [com[i], 0.0, 0.0],
            inertia: [[0.0, 0.0, 0.0], [0.0, inertia[i], 0.0], [0.0, 0.0, inertia[i]]],
        };
        (0..2).map(|i| Placed { body: body(i), tip: Some([length[i], 0.0, 0.0]) }).collect()
    }

    fn check_gravity([x, y, _]: &[f64; 3], field: &Field<'_>) {
        if *x == 0.0 && *y == 0.0 {
            return;
        }
        let message = format!(
            "gravity has a horizontal part ({x}, {y}) m/s^2, must be (0, 0): planar-two-link moves in the horizontal plane"
        );
        field.error("gravity", message, "for an arm in a vertical plane write the links as kind = \"tree\"");
    }
}
