//! M̄, a bound of the mass matrix of a tree for all configurations: where centres of mass can be, joint by joint. What
//! certificates of version 1 rest on.

#[cfg(test)]
mod tests;

use flexure_core::scalar::{Interval, Scalar};

use crate::verify::frame::{inertia, rotation, unit_axis, values};
use crate::verify::matrix::Symmetric;
use crate::verify::robot::Body;
use crate::verify::vector::{Vec3, across, cross, dot, norm, plus, scaled, squared, turned};
use crate::verify::verdict::{Rejected, ensure};

/// Where a centre of mass can be, in a joint's frame: its coordinate along the axis, and upper bounds of its distances
/// from the axis and from the origin.
#[derive(Clone, Copy)]
struct Reach {
    along: Interval,
    from_axis: Interval,
    from_origin: Interval,
}

/// A body's numbers as intervals.
struct Frame<'a> {
    body: &'a Body,
    axis: Vec3,
    /// The axis in the parent's frame: z = R e.
    carried: Vec3,
    offset: Vec3,
}

/// The upper end as a number.
fn upper(x: Interval) -> Interval {
    Interval::point(x.hi())
}

/// The smallest upper end.
fn least(candidates: &[Interval]) -> Interval {
    Interval::point(candidates.iter().map(|x| x.hi()).fold(f64::INFINITY, f64::min))
}

impl<'a> Frame<'a> {
    fn new(k: usize, body: &'a Body) -> Result<Self, Rejected> {
        let axis = unit_axis(k, body)?;
        Ok(Self { body, axis, carried: turned(rotation(k, body)?, axis), offset: values(&body.translation) })
    }

    fn is_revolute(&self) -> bool {
        self.body.travel.is_none()
    }

    /// The body's own centre of mass in its joint's frame.
    fn start(&self) -> Reach {
        let c = values(&self.body.com);
        let along = dot(c, self.axis);
        self.slid(Reach { along, from_axis: upper(norm(across(c, self.axis))), from_origin: upper(norm(c)) })
    }

    /// Widened by the joint's travel.
    fn slid(&self, reach: Reach) -> Reach {
        let Some(travel) = &self.body.travel else { return reach };
        let [lower, higher] = values(travel);
        let travel = lower.hull(higher);
        Reach {
            along: reach.along + travel,
            from_origin: upper(reach.from_origin + Interval::point(travel.magnitude())),
            ..reach
        }
    }

    /// From this joint's frame to that of its parent.
    fn to_parent(&self, parent: &Self, reach: Reach) -> Reach {
        let (o, z, e) = (self.offset, self.carried, parent.axis);
        let Reach { along, from_axis: rho, from_origin: r } = reach;
        let ends = [along.lo(), along.hi()].map(Interval::point);
        // The larger of the upper ends at both ends of `along`.
        let largest =
            |f: &dyn Fn(Interval) -> Interval| Interval::point(f(ends[0]).hi().max(f(ends[1]).hi()));
        let two = Interval::from_f64(2.0);

        let (c, normal) = (dot(z, e), cross(e, z));
        let s = norm(normal);
        let square =
            squared(o) + r.square() + two * largest(&|a| a * dot(o, z)) + two * rho * norm(across(o, z));
        let from_origin = least(&[norm(o) + r, square.sqrt()]);

        let axial = ends[0].hull(ends[1]) * c + dot(o, e);
        let spread = rho * Interval::point(s.magnitude());
        let along = axial + spread.hull(-spread);
        let along = along.intersection(from_origin.hull(-from_origin)).unwrap_or(along);

        let straight = rho + largest(&|a| norm(across(plus(o, scaled(z, a)), e)));
        let mut candidates = vec![from_origin, straight];
        if squared(normal).lo() > 1e-6 {
            let sideways = size(dot(o, normal) / s) + rho;
            let tangent = dot(o, across(z, e)) / s;
            let inwards = largest(&|a| size(tangent + a * s)) + size(c) * rho;
            candidates.push((sideways.square() + inwards.square()).sqrt());
        }
        parent.slid(Reach { along, from_axis: least(&candidates), from_origin })
    }
}

/// |x|, its upper end.
fn size(x: Interval) -> Interval {
    Interval::point(x.magnitude())
}

/// M̄: entries are upper ends.
pub(super) fn mass_bound(bodies: &[Body]) -> Result<Vec<Vec<Interval>>, Rejected> {
    let frames =
        bodies.iter().enumerate().map(|(k, body)| Frame::new(k, body)).collect::<Result<Vec<_>, _>>()?;
    let n = frames.len();
    let mut bound = vec![vec![Interval::ZERO; n]; n];
    for (k, body) in bodies.iter().enumerate() {
        let chain = chain(&frames, k);
        for (p, &(j, at_j)) in chain.iter().enumerate() {
            for (q, &(i, at_i)) in chain.iter().enumerate().skip(p) {
                let mut term = Term::new(&frames, k, (i, at_i), (j, at_j));
                if q == p + 1 {
                    term.next_to_each_other(&frames[i], &frames[j], at_j, spread(&inertia(body)));
                }
                let entry = upper(bound[i][j] + body.mass.value * term.linear + term.angular);
                (bound[i][j], bound[j][i]) = (entry, entry);
            }
        }
    }
    Ok(bound)
}

/// The joints from body k to the base, with what the centre of mass of k can reach in each one's frame.
fn chain(frames: &[Frame<'_>], k: usize) -> Vec<(usize, Reach)> {
    let mut reach = frames[k].start();
    let mut chain = vec![(k, reach)];
    let mut j = k;
    while let Some(i) = frames[j].body.parent {
        reach = frames[j].to_parent(&frames[i], reach);
        chain.push((i, reach));
        j = i;
    }
    chain
}

/// What body k adds to the entry (i, j): its mass times `linear`, and `angular`.
struct Term {
    linear: Interval,
    angular: Interval,
}

impl Term {
    fn new(frames: &[Frame<'_>], k: usize, (i, at_i): (usize, Reach), (j, at_j): (usize, Reach)) -> Self {
        let lever =
            |joint: usize, at: Reach| if frames[joint].is_revolute() { at.from_axis } else { Interval::ONE };
        let tensor = inertia(frames[k].body);
        let own = turned(tensor, frames[k].axis);
        let angular = if !frames[i].is_revolute() || !frames[j].is_revolute() {
            Interval::ZERO
        } else if i == k {
            dot(frames[k].axis, own)
        } else if j == k {
            norm(own)
        } else {
            spread(&tensor)
        };
        Self { linear: upper(lever(i, at_i) * lever(j, at_j)), angular: upper(angular) }
    }

    /// Sharper where i is j's parent and both turn: their axes keep their angle.
    fn next_to_each_other(&mut self, parent: &Frame<'_>, child: &Frame<'_>, at: Reach, spread: Interval) {
        if !parent.is_revolute() || !child.is_revolute() {
            return;
        }
        let c = size(dot(parent.axis, child.carried));
        let g = (Interval::ONE + c) * Interval::from_f64(0.5);
        let arm = norm(cross(parent.axis, child.offset));
        self.linear = least(&[self.linear, g * at.from_origin.square() + arm * at.from_axis]);
        self.angular = least(&[self.angular, g * spread]);
    }
}

/// N: an upper bound of the largest eigenvalue of an inertia.
fn spread(rows: &[Vec3; 3]) -> Interval {
    let frobenius = rows.iter().fold(Interval::ZERO, |sum, row| sum + squared(*row)).sqrt();
    let sums = rows.map(|row| row.iter().fold(Interval::ZERO, |sum, entry| sum + size(*entry)).hi());
    least(&[frobenius, Interval::point(sums.into_iter().fold(0.0, f64::max))])
}

/// Body k's own inertia about, or along, its joint's axis: a lower bound. Its inertia is one of a body.
pub(super) fn own_inertia(k: usize, body: &Body) -> Result<f64, Rejected> {
    let (e, rows) = (unit_axis(k, body)?, inertia(body));
    ensure(is_semidefinite(&rows), format!("robot.links.bodies[{k}].inertia"), || {
        "is not positive definite where it is not exactly zero".to_owned()
    })?;
    let own = if body.travel.is_some() {
        body.mass.value
    } else {
        dot(e, turned(rows, e)) + body.mass.value * squared(cross(e, values(&body.com)))
    };
    Ok(own.lo())
}

/// Positive definite without the rows and columns that are exactly zero: thin rods have one, points three.
fn is_semidefinite(rows: &[Vec3; 3]) -> bool {
    let kept: Vec<_> = (0..3).filter(|&i| rows[i].iter().any(|entry| *entry != Interval::ZERO)).collect();
    Symmetric::from_fn(kept.len(), |i, j| rows[kept[i]][kept[j]]).smallest_pivot() > 0.0
}
