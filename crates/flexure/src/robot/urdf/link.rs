//! `<link>`: its body.

use crate::files::quantity;
use crate::robot::links::inertia;
use crate::robot::links::written::{Frame, Matter};
use crate::robot::urdf::node::Node;

/// The body of a link in the frame of the joint that carries it; nothing without `<inertial>`.
pub(crate) fn matter(link: &Node<'_>) -> Option<Matter> {
    let Some(inertial) = link.child("inertial")? else { return Some(Matter::NOTHING) };
    let Frame { xyz, rpy } = origin(&inertial)?;
    let mass = inertial
        .required_child("mass", "mass in kg: <mass value=\"…\"/>")
        .and_then(|node| node.number("value", &quantity::BODY_MASS));
    let inertia =
        inertial.required_child("inertia", "inertia about the centre of mass in kg m^2").and_then(|node| {
            let six = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"]
                .map(|name| node.number(name, &quantity::BODY_INERTIA));
            let [Some(xx), Some(xy), Some(xz), Some(yy), Some(yz), Some(zz)] = six else { return None };
            let six = [xx, xy, xz, yy, yz, zz];
            inertia::check(&node.site, six).map(|()| six)
        });
    Some(Matter { mass: mass?, com: xyz, inertia: inertia?, inertia_rpy: rpy })
}

/// `<origin xyz rpy>` of a node; zeros without it.
pub(crate) fn origin(node: &Node<'_>) -> Option<Frame> {
    let Some(origin) = node.child("origin")? else { return Some(Frame { xyz: [0.0; 3], rpy: [0.0; 3] }) };
    if origin.has("quat_xyzw") {
        let message = format!("{} has a quaternion, which is not read", origin.site.path);
        origin.site.error("unsupported", message, "write the orientation as rpy, in rad");
        return None;
    }
    let xyz = origin.numbers("xyz", &quantity::POSITION, "x, y, z", [0.0; 3]);
    let rpy = origin.numbers("rpy", &quantity::ORIENTATION, "roll, pitch, yaw", [0.0; 3]);
    Some(Frame { xyz: xyz?, rpy: rpy? })
}
