//! The mass matrix of the links: closed forms, and why it is positive definite.

use flexure_core::scalar::{Interval, Scalar};

use crate::verify::document::Certificate;
use crate::verify::matrix::Symmetric;
use crate::verify::number::Number;
use crate::verify::reach::own_inertia;
use crate::verify::robot::Links;
use crate::verify::verdict::{Claim, Rejected, ensure};

/// The entries (1, 1), (1, 2), (2, 2) of the planar arm where cos q_2 is `cosine`; zeros for other links.
pub(super) fn planar_mass(links: &Links, cosine: f64) -> [Interval; 3] {
    let Links::PlanarTwoLink(arm) = links else { return [Interval::ZERO; 3] };
    let [m1, m2] = arm.mass.each_ref().map(|number| number.value);
    let [r1, r2] = arm.com.each_ref().map(|number| number.value);
    let [i1, i2] = arm.inertia.each_ref().map(|number| number.value);
    let l1 = arm.length.value;
    let a1 = m1 * r1.square() + m2 * l1.square() + i1;
    let a2 = m2 * r2.square() + i2;
    let bc = m2 * l1 * r2 * Interval::point(cosine);
    [a1 + a2 + bc + bc, a2 + bc, a2]
}

/// I + m r² of the pendulum; zero for other links.
pub(super) fn pendulum_mass(links: &Links) -> Interval {
    let Links::Pendulum(body) = links else { return Interval::ZERO };
    let [mass, com, inertia] = body.as_ref();
    inertia.value + mass.value * com.value.square()
}

pub(super) fn check(certificate: &Certificate) -> Result<Vec<Claim>, Rejected> {
    let links = &certificate.robot.links;
    let found: Vec<f64> = match links {
        Links::PlanarTwoLink(_) => {
            let pivot = |cosine| {
                let mass = planar_mass(links, cosine);
                Symmetric::from_fn(2, |i, j| mass[i + j]).smallest_pivot()
            };
            vec![pivot(-1.0), pivot(1.0)]
        }
        Links::Pendulum(_) => vec![pendulum_mass(links).lo()],
        Links::Tree(bodies) => {
            let own = bodies.iter().enumerate().map(|(k, body)| own_inertia(k, body));
            own.collect::<Result<_, _>>()?
        }
    };
    let margins = &certificate.mass_margins;
    ensure(margins.len() == found.len(), "mass_matrix.margins", || {
        format!("there are {}, must be {}", margins.len(), found.len())
    })?;
    for (i, (margin, found)) in margins.iter().zip(found).enumerate() {
        let claim = format!("mass_matrix.margins[{i}]");
        ensure(margin.is_positive(), claim.as_str(), || format!("the margin {margin} is not > 0"))?;
        ensure(found >= margin.claimed.hi(), claim, || {
            format!("at least {margin} kg m^2 (kg for a prismatic joint) is claimed, found {found:e}")
        })?;
    }
    let margins: Vec<_> = margins.iter().map(Number::to_string).collect();
    Ok(vec![Claim::new(
        "mass_matrix",
        format!("positive definite for all q, pivots at least {}", margins.join(", ")),
    )])
}
