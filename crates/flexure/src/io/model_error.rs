//! A robot that differs from its model: masses, springs, dampers, and something in its hand.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::{Interval, Scalar};

use super::diagnostic::Problems;
use super::links::rigid::{Rigid, Weight};
use super::links::{Body, Links};
use super::robot::Robot;

/// By what factors the true robot differs from its model, one a joint, and what it carries that the model does not know.
/// Factors of inertias and stiffness are positive, those of damping not negative.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelError {
    /// Of masses and, with them, of rotational inertias of the links; centres of mass stay.
    pub mass: Vec<f64>,
    /// Of the joint stiffness.
    pub stiffness: Vec<f64>,
    /// Of the link damping.
    pub link_damping: Vec<f64>,
    /// Of the motor damping.
    pub motor_damping: Vec<f64>,
    /// Of the motor inertia.
    pub motor_inertia: Vec<f64>,
    /// What the last link carries.
    pub payload: Option<Payload>,
}

/// A point mass on the last link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Payload {
    /// Mass ≥ 0 \[kg\].
    pub mass: f64,
    /// Where, in the frame of the last moving joint \[m\]; without it at the centre of mass of the link. Links in closed form
    /// have no such frame: a planar two-link arm carries it at its tip, a pendulum at its centre of mass.
    pub position: Option<[f64; 3]>,
}

impl ModelError {
    /// No error, for so many joints.
    pub fn none(joints: usize) -> Self {
        let same = vec![1.0; joints];
        Self {
            mass: same.clone(),
            stiffness: same.clone(),
            link_damping: same.clone(),
            motor_damping: same.clone(),
            motor_inertia: same,
            payload: None,
        }
    }

    /// The true robot of which `model` is the model.
    ///
    /// # Errors
    /// If a position is given for the payload of links in closed form.
    ///
    /// # Panics
    /// If there are not as many factors as joints.
    pub fn applied_to(&self, model: &Robot) -> Result<Robot, Problems> {
        let joints = model.joint_count();
        for factors in
            [&self.mass, &self.stiffness, &self.link_damping, &self.motor_damping, &self.motor_inertia]
        {
            assert_eq!(factors.len(), joints, "one factor a joint");
        }
        let closed_form = !matches!(model.links, Links::Tree(_));
        if closed_form && self.payload.is_some_and(|payload| payload.position.is_some()) {
            let message = format!(
                "robot {} has links in closed form, which have no frame for the payload's position",
                model.name
            );
            let help = "leave the position out: a planar two-link arm carries the payload at its tip, a pendulum at its \
                        centre of mass; or write the links as kind = \"tree\"";
            return Err(model.places.problem("links", "payload", message, help).into());
        }
        let changed = |values: &[f64], factors: &[f64]| -> Vec<f64> {
            values.iter().zip(factors).map(|(&value, &factor)| scaled(value, factor)).collect()
        };
        Ok(Robot {
            links: self.links(&model.links),
            enclosed: self.links::<Interval>(&model.enclosed),
            stiffness: changed(&model.stiffness, &self.stiffness),
            link_damping: changed(&model.link_damping, &self.link_damping),
            motor_damping: changed(&model.motor_damping, &self.motor_damping),
            motor_inertia: changed(&model.motor_inertia, &self.motor_inertia),
            ..model.clone()
        })
    }

    /// The links of the true robot, over any numbers.
    fn links<C: Scalar>(&self, model: &Links<C>) -> Links<C> {
        let mut links = model.clone();
        let factors = self.mass.iter().copied();
        match &mut links {
            Links::PlanarTwoLink { mass, inertia, .. } => {
                for ((mass, inertia), factor) in mass.iter_mut().zip(inertia).zip(factors) {
                    (*mass, *inertia) = (scaled(*mass, factor), scaled(*inertia, factor));
                }
            }
            Links::Pendulum { mass, inertia, .. } => {
                for factor in factors {
                    (*mass, *inertia) = (scaled(*mass, factor), scaled(*inertia, factor));
                }
            }
            Links::Tree(bodies) => {
                for (body, factor) in bodies.iter_mut().zip(factors) {
                    body.mass = scaled(body.mass, factor);
                    body.inertia = body.inertia.map(|row| row.map(|x| scaled(x, factor)));
                }
            }
        }
        if let Some(payload) = self.payload.filter(|payload| payload.mass != 0.0) {
            payload.put_on(&mut links);
        }
        links
    }
}

impl Payload {
    fn put_on<C: Scalar>(&self, links: &mut Links<C>) {
        match links {
            // Along the link; about the joint axis only zz plays a part.
            Links::PlanarTwoLink {
                mass: [_, mass],
                length: [_, tip],
                com: [_, com],
                inertia: [_, inertia],
            } => {
                (*mass, *com, *inertia) = self.beside((*mass, *com, *inertia), *tip);
            }
            Links::Pendulum { mass, com, inertia } => {
                (*mass, *com, *inertia) = self.beside((*mass, *com, *inertia), *com);
            }
            Links::Tree(bodies) => {
                let Some(body) = bodies.last_mut() else { return };
                let at = self.position.map_or(body.com, |xyz| xyz.map(C::from_f64));
                let link = Rigid { weight: Some(weight(body)), inertia: Matrix(body.inertia) };
                let both = link.joined(&self.point(Vector(at)));
                if let Some(Weight { mass, com }) = both.weight {
                    *body = Body { mass, com: com.0, inertia: both.inertia.0, ..*body };
                }
            }
        }
    }

    /// Mass, centre of mass along a planar link and inertia about it, with the payload at a distance of `at` m.
    fn beside<C: Scalar>(&self, (mass, com, inertia): (C, C, C), at: C) -> (C, C, C) {
        let along = |distance: C| Vector([distance, C::ZERO, C::ZERO]);
        let about_z = Matrix::diagonal(&Vector([C::ZERO, C::ZERO, inertia]));
        let link = Rigid { weight: Some(Weight { mass, com: along(com) }), inertia: about_z };
        let both = link.joined(&self.point(along(at)));
        let com = both.weight.map_or(com, |weight| weight.com[0]);
        (both.mass(), com, both.inertia[(2, 2)])
    }

    fn point<C: Scalar>(&self, com: Vector<C, 3>) -> Rigid<C> {
        Rigid { weight: Some(Weight { mass: C::from_f64(self.mass), com }), inertia: Matrix::ZERO }
    }
}

fn weight<C: Scalar>(body: &Body<C>) -> Weight<C> {
    Weight { mass: body.mass, com: Vector(body.com) }
}

/// `x` times `factor`; `x` itself if that is 1, also where products are rounded outwards.
fn scaled<C: Scalar>(x: C, factor: f64) -> C {
    #[expect(clippy::float_cmp, reason = "exactly one means no error")]
    if factor == 1.0 { x } else { x * C::from_f64(factor) }
}
