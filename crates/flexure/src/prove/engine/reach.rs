//! An entrywise bound of the mass matrix of a tree over all its configurations, by one pass over the joints for each body:
//! how far its centre of mass can get from each axis. The formulas are stated in `docs/certificate.md`.

use flexure_core::scalar::{Interval, Piecewise, Scalar};
use flexure_core::spatial::Vec3;

use crate::linalg::{Dense, Symmetric};
use crate::prove::engine::certificate::{DecimalBody, JointMotion};
use crate::prove::engine::number::Number;

type V = Vec3<Interval>;

/// A body with its numbers enclosed.
struct Enclosed {
    parent: Option<usize>,
    revolute: bool,
    axis: V,
    /// Columns of the rotation.
    columns: [V; 3],
    translation: V,
    mass: Interval,
    com: V,
    /// Rows of the inertia about the centre of mass.
    inertia: [V; 3],
    travel: Option<[Interval; 2]>,
}

/// Where a point can be, seen from a joint: its coordinate along the axis, at most `radius` away from the axis and
/// `distance` from the origin.
#[derive(Clone, Copy)]
struct Reach {
    axial: [Interval; 2],
    radius: Interval,
    distance: Interval,
}

/// M̄ ≥ |M(q)|, entry by entry, for all q.
///
/// # Errors
/// Says which joint slides without limits, if one does.
pub fn mass_bound(bodies: &[DecimalBody]) -> Result<Symmetric<Interval>, String> {
    let bodies: Vec<Enclosed> = bodies.iter().map(Enclosed::of).collect();
    if let Some(k) = bodies.iter().position(|body| !body.revolute && body.travel.is_none()) {
        return Err(format!("joint {} slides without limits: the mass matrix has no bound", k + 1));
    }
    let n = bodies.len();
    let mut total = Dense::from_fn(n, n, |_, _| Interval::ZERO);
    for k in 0..n {
        let reaches = reaches(&bodies, k);
        for (position, &(j, at_j)) in reaches.iter().enumerate() {
            for &(i, at_i) in &reaches[position..] {
                total[(j, i)] += share(&bodies, k, (i, at_i), (j, at_j));
            }
        }
    }
    Ok(Symmetric::from_fn(n, |j, i| total[(j, i)]))
}

/// Inertia of each body about, or along, the axis of its joint: lower bounds; 0 where the body's inertia may be
/// indefinite or its mass negative.
pub fn own_inertias(bodies: &[DecimalBody]) -> Vec<f64> {
    bodies
        .iter()
        .map(|body| {
            let sound = inertia(body).is_none_or(|inertia| inertia.smallest_pivot() > 0.0);
            let body = Enclosed::of(body);
            if !sound || body.mass.lo() < 0.0 {
                return 0.0;
            }
            if !body.revolute {
                return body.mass.lo();
            }
            let arm = body.axis.cross(body.com);
            (body.axis.dot(body.turn(body.axis)) + body.mass * norm_squared(arm)).lo()
        })
        .collect()
}

/// The inertia about the centre of mass, without the axes about which there is exactly none; none if there is none at all.
fn inertia(body: &DecimalBody) -> Option<Symmetric<Interval>> {
    let [xx, xy, xz, yy, yz, zz] = body.inertia.each_ref().map(Number::bounds);
    let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let axes: Vec<usize> = (0..3).filter(|&i| rows[i] != [Interval::ZERO; 3]).collect();
    (!axes.is_empty()).then(|| Symmetric::from_fn(axes.len(), |i, j| rows[axes[i]][axes[j]]))
}

impl Enclosed {
    fn of(body: &DecimalBody) -> Self {
        let v = |x: &[Number; 3]| Vec3::from_array(x.each_ref().map(Number::bounds));
        let [x, y, z] = body.rotation.each_ref().map(v);
        let [xx, xy, xz, yy, yz, zz] = body.inertia.each_ref().map(Number::bounds);
        Self {
            parent: body.parent,
            revolute: body.kind == JointMotion::Revolute,
            axis: v(&body.axis),
            columns: [Vec3::new(x.x, y.x, z.x), Vec3::new(x.y, y.y, z.y), Vec3::new(x.z, y.z, z.z)],
            translation: v(&body.translation),
            mass: body.mass.bounds(),
            com: v(&body.com),
            inertia: [Vec3::new(xx, xy, xz), Vec3::new(xy, yy, yz), Vec3::new(xz, yz, zz)],
            travel: body.travel.as_ref().map(|ends| ends.each_ref().map(Number::bounds)),
        }
    }

    /// I v.
    fn turn(&self, v: V) -> V {
        let [x, y, z] = self.inertia;
        Vec3::new(x.dot(v), y.dot(v), z.dot(v))
    }

    /// The joint's axis in the parent's frame.
    fn axis_in_parent(&self) -> V {
        let [x, y, z] = self.columns;
        x.scaled(self.axis.x) + y.scaled(self.axis.y) + z.scaled(self.axis.z)
    }

    /// An upper bound of the largest principal inertia: the Frobenius norm or the largest row sum.
    fn largest_inertia(&self) -> Interval {
        let frobenius = self.inertia.iter().fold(Interval::ZERO, |sum, row| sum + norm_squared(*row)).sqrt();
        let row = |v: &V| v.x.abs() + v.y.abs() + v.z.abs();
        let rows = self.inertia.iter().map(row).fold(Interval::ZERO, Piecewise::max);
        frobenius.min(rows)
    }
}

fn norm_squared(v: V) -> Interval {
    v.x.square() + v.y.square() + v.z.square()
}

fn norm(v: V) -> Interval {
    norm_squared(v).sqrt()
}

/// `x` without its part along the unit vector `e`.
fn across(x: V, e: V) -> V {
    x - e.scaled(x.dot(e))
}

/// The upper end, as a number.
fn top(x: Interval) -> Interval {
    Interval::point(x.hi())
}

/// Where the centre of mass of body `k` can be, seen from each joint between it and the base, outermost first.
fn reaches(bodies: &[Enclosed], k: usize) -> Vec<(usize, Reach)> {
    let body = &bodies[k];
    let along = body.com.dot(body.axis);
    let start = Reach {
        axial: [along, along],
        radius: top(norm(across(body.com, body.axis))),
        distance: top(norm(body.com)),
    };
    let mut found = vec![(k, start.slid(body))];
    while let Some(&(j, reach)) = found.last() {
        let Some(i) = bodies[j].parent else { break };
        found.push((i, reach.seen_from_parent(&bodies[j], bodies[i].axis).slid(&bodies[i])));
    }
    found
}

impl Reach {
    /// Widened by the travel of a prismatic joint.
    fn slid(self, body: &Enclosed) -> Self {
        let Some([lower, upper]) = body.travel else { return self };
        let [low, high] = self.axial;
        Self {
            axial: [low + lower, high + upper],
            distance: top(self.distance + lower.abs().max(upper.abs())),
            ..self
        }
    }

    /// Seen from the parent of `body`, whose joint has the axis `e`; the joint of `body` at any angle.
    fn seen_from_parent(&self, body: &Enclosed, e: V) -> Self {
        let (o, z) = (body.translation, body.axis_in_parent());
        let c = z.dot(e);
        // Rounding may take 1 − c² below 0: the part above counts.
        let s = (Interval::ONE - c.square()).max(Interval::ZERO).sqrt();
        let ends = self.axial;
        let largest = |f: &dyn Fn(Interval) -> Interval| top(f(ends[0]).max(f(ends[1])));

        let oz = o.dot(z);
        let turned = norm_squared(o)
            + self.distance.square()
            + Interval::point(2.0) * (largest(&|a| a * oz) + self.radius * norm(across(o, z)));
        let distance = top((norm(o) + self.distance).min(turned.max(Interval::ZERO).sqrt()));

        let along = ends.map(|a| o.dot(e) + a * c);
        let (low, high) =
            (along[0].min(along[1]) - self.radius * s, along[0].max(along[1]) + self.radius * s);
        let axial = [Interval::point(low.max(-distance).lo()), Interval::point(high.min(distance).hi())];

        let centre = |a: Interval| norm(across(o + z.scaled(a), e));
        let mut radius = (self.radius + largest(&centre)).min(distance);
        let normal = e.cross(z);
        if norm_squared(normal).lo() > 1e-6 {
            let u = normal.scaled(norm(normal).recip());
            let t = across(z, e);
            let t = t.scaled(norm(t).recip());
            let beside = o.dot(u).abs() + self.radius;
            let above = largest(&|a| (o.dot(t) + a * s).abs()) + c.abs() * self.radius;
            radius = radius.min((beside.square() + above.square()).sqrt());
        }
        Self { axial, radius: top(radius), distance }
    }
}

/// What body `k` adds to M̄_ij at most, `i` being `j` or on its way to the base.
fn share(bodies: &[Enclosed], k: usize, (i, at_i): (usize, Reach), (j, at_j): (usize, Reach)) -> Interval {
    let (body, first, second) = (&bodies[k], &bodies[i], &bodies[j]);
    let lever = |joint: &Enclosed, reach: Reach| if joint.revolute { reach.radius } else { Interval::ONE };
    let mut moved = lever(first, at_i) * lever(second, at_j);
    let both_turn = first.revolute && second.revolute;
    let mut turned = match (both_turn, i == k, j == k) {
        (false, ..) => Interval::ZERO,
        (true, true, _) => body.axis.dot(body.turn(body.axis)),
        (true, false, true) => norm(body.turn(body.axis)),
        (true, false, false) => body.largest_inertia(),
    };
    if second.parent == Some(i) && both_turn {
        let g = (Interval::ONE + first.axis.dot(second.axis_in_parent()).abs()) * Interval::point(0.5);
        let offset = norm(first.axis.cross(second.translation));
        moved = moved.min(g * at_j.distance.square() + offset * at_j.radius);
        turned = turned.min(g * body.largest_inertia());
    }
    top(body.mass * moved + turned)
}
