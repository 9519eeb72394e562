//! The pendulum in closed form: `kind = "pendulum"`.

use flexure_core::robots;
use flexure_core::scalar::Scalar;

use crate::files::field::Field;
use crate::files::quantity;
use crate::files::table::Table;
use crate::robot::links::closed_form::{ClosedForm, LineBody, Placed, ReadClosedForm};
use crate::robot::links::{Body, JointKind};

/// One link on a horizontal axis; q = 0 hangs along gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pendulum<C = f64> {
    /// Mass \[kg\].
    pub mass: C,
    /// Distance of the centre of mass from the joint \[m\].
    pub com: C,
    /// Rotational inertia about the centre of mass [kg m²]; about the joint it is `inertia` + `mass` `com`².
    pub inertia: C,
}

impl<C: Scalar> Pendulum<C> {
    /// The link under `gravity` [m/s²] in the base frame, whichever way it points.
    pub fn core(&self, gravity: [C; 3]) -> robots::Pendulum<C> {
        let [x, y, z] = gravity.map(C::square);
        robots::Pendulum {
            inertia: self.inertia + self.mass * self.com.square(),
            weight_moment: self.mass * self.com * (x + y + z).sqrt(),
        }
    }
}

impl<C> ClosedForm<C> for Pendulum<C> {
    const NAME: &'static str = "pendulum";
    const WHAT: &'static str = "a pendulum";
    const JOINTS: usize = 1;

    type With<D> = Pendulum<D>;

    fn map<D>(&self, f: impl Fn(C) -> D) -> Pendulum<D>
    where
        C: Copy,
    {
        Pendulum { mass: f(self.mass), com: f(self.com), inertia: f(self.inertia) }
    }

    fn bodies(&mut self) -> Vec<LineBody<'_, C>> {
        let Self { mass, com, inertia } = self;
        vec![LineBody { mass, com, inertia }]
    }
}

impl ReadClosedForm for Pendulum {
    const KEYS: &'static [&'static str] = &["mass", "com", "inertia"];

    fn read(table: &Table<'_>) -> Option<Self> {
        let (mass, com) = (table.number("mass", &quantity::MASS), table.number("com", &quantity::POSITION));
        let inertia = table.number("inertia", &quantity::INERTIA);
        Some(Self { mass: mass?, com: com?, inertia: inertia? })
    }

    fn placed(&self) -> Vec<Placed> {
        let Self { mass, com, inertia } = *self;
        // Hanging along −z, which is the link's x; it turns about its y.
        let body = Body {
            parent: None,
            kind: JointKind::Revolute,
            axis: [0.0, 1.0, 0.0],
            rotation: [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]],
            translation: [0.0; 3],
            mass,
            com: [com, 0.0, 0.0],
            inertia: [[0.0, 0.0, 0.0], [0.0, inertia, 0.0], [0.0, 0.0, inertia]],
        };
        vec![Placed { body, tip: None }]
    }

    fn check_gravity(_: &[f64; 3], _: &Field<'_>) {}
}
