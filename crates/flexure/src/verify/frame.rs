//! The frame of a body: axis, rotation and inertia as intervals.

use flexure_core::scalar::Interval;

use crate::verify::number::Number;
use crate::verify::robot::Body;
use crate::verify::vector::{self, Vec3, unit};
use crate::verify::verdict::Rejected;

/// What the numbers may be.
pub(super) fn values<const N: usize>(numbers: &[Number; N]) -> [Interval; N] {
    numbers.each_ref().map(|number| number.value)
}

/// Contains the unit axis of the joint of body `k`.
pub(super) fn unit_axis(k: usize, body: &Body) -> Result<Vec3, Rejected> {
    let place = || format!("robot.links.bodies[{k}].axis");
    unit(values(&body.axis)).ok_or_else(|| Rejected::claim(place(), "is not a unit vector"))
}

/// Contains the rotation of body `k`, in rows.
pub(super) fn rotation(k: usize, body: &Body) -> Result<[Vec3; 3], Rejected> {
    let place = || format!("robot.links.bodies[{k}].rotation");
    vector::rotation(body.rotation.each_ref().map(values))
        .ok_or_else(|| Rejected::claim(place(), "R R' is not the unit matrix or det R < 0"))
}

/// Rows of the inertia about the centre of mass.
pub(super) fn inertia(body: &Body) -> [Vec3; 3] {
    let [xx, xy, xz, yy, yz, zz] = values(&body.inertia);
    [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
}
