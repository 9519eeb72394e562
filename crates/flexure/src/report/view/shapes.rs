//! What the links look like, for the page.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use flexure_core::linalg::Vector;
use serde::Serialize;

use crate::files::Problem;
use crate::files::base::Base;
use crate::robot::Robot;
use crate::robot::links::rigid::Pose;
use crate::robot::looks::{LinkLook, Looks};
use crate::robot::stl::{Triangle, coarser, triangles};
use crate::robot::urdf::looks::{Form, Part};

/// A shape in the frame of a body, or of the base.
#[derive(Serialize)]
pub(super) struct Shape {
    #[serde(flatten)]
    form: Drawn,
    rotation: [[f64; 3]; 3],
    translation: [f64; 3],
}

#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
enum Drawn {
    Box { size: [f64; 3] },
    Cylinder { radius: f64, length: f64 },
    Sphere { radius: f64 },
    Mesh { triangles: String },
}

/// A part whose mesh is there, if it is one.
enum Found<'a> {
    Plain(&'a Part),
    Mesh(&'a Part, Vec<Triangle>),
}

/// Triangles of all meshes together: beyond, the page would be larger than 1.5 MB.
const MOST: usize = 14_000;

/// Cells along a mesh, from fine to coarse, for robots of more triangles.
const CELLS: [f32; 5] = [96.0, 64.0, 40.0, 24.0, 12.0];

/// What a body looks like.
#[derive(Default)]
pub(super) struct Shaped {
    pub shapes: Vec<Shape>,
    /// Where it ends in its link frame \[m\]: as far out as its shapes go, on the way to their middle; none without shapes.
    pub tip: Option<[f64; 3]>,
}

/// What a robot looks like.
pub(super) struct Shapes {
    pub base: Vec<Shape>,
    pub bodies: Vec<Shaped>,
    /// That it does not look as its URDF says, if so.
    pub warning: Option<Problem>,
}

/// The shapes of the base and of each body; of none if a link is told to look like something that cannot be shown: half a robot would be
/// worse than one that is made up.
pub(super) fn shapes(robot: &Robot) -> Shapes {
    let mut base = Vec::new();
    let mut bodies: Vec<Shaped> = robot.joints.iter().map(|_| Shaped::default()).collect();
    let mut points: Vec<Vec<Vector<f64, 3>>> = robot.joints.iter().map(|_| Vec::new()).collect();
    let mut found = Vec::new();
    for link in &robot.looks.links {
        match parts(link, &robot.looks) {
            Some(parts) => found.push((link, parts)),
            None => return Shapes { base, bodies, warning: unseen(robot, link) },
        }
    }
    lighten(found.iter_mut().flat_map(|(_, parts)| parts));
    for (link, parts) in found {
        let Some(body) = link.body else {
            base.extend(parts.into_iter().map(|part| shape(&link.pose, part)));
            continue;
        };
        points[body].extend(parts.iter().flat_map(|part| corners(&link.pose, part)));
        bodies[body].shapes.extend(parts.into_iter().map(|part| shape(&link.pose, part)));
    }
    for (body, points) in bodies.iter_mut().zip(points) {
        body.tip = tip(&points);
    }
    Shapes { base, bodies, warning: None }
}

/// That a link cannot be shown; not of built-in robots, which have no meshes to be found.
fn unseen(robot: &Robot, link: &LinkLook) -> Option<Problem> {
    if robot.looks.base.as_ref().is_some_and(Base::is_built_in) {
        return None;
    }
    let mesh = |part: &Part| match &part.form {
        Form::Mesh(file, _) => Some(file.clone()),
        _ => None,
    };
    let file = link.look.visual.iter().chain(&link.look.collision).find_map(mesh)?;
    let message =
        format!("{}: the page draws links from joint to joint, because {file:?} cannot be shown", robot.name);
    let help = "shown are STL files of at most 32 MB in the folder of the URDF or below, with --allow-outside also where its packages are";
    Some(Problem::new("unseen", message, help).warning())
}

/// Points of a part in the frame of its body: all corners of triangles and boxes, the ends of cylinders, the middle of spheres.
fn corners(link: &Pose<f64>, found: &Found<'_>) -> Vec<Vector<f64, 3>> {
    let (Found::Plain(part) | Found::Mesh(part, _)) = found;
    let pose = link.then(&part.frame.pose(|x| x));
    let own: Vec<[f64; 3]> = match (&part.form, found) {
        (Form::Box(size), _) => {
            let [x, y, z] = size.map(|length| [-0.5 * length, 0.5 * length]);
            x.iter().flat_map(|&x| y.iter().flat_map(move |&y| z.map(|z| [x, y, z]))).collect()
        }
        (Form::Cylinder([_, length]), _) => vec![[0.0, 0.0, -0.5 * length], [0.0, 0.0, 0.5 * length]],
        (Form::Sphere(_), _) => vec![[0.0; 3]],
        (Form::Mesh(_, scale), Found::Mesh(_, triangles)) => {
            let scaled = |corner: &[f32; 3]| std::array::from_fn(|k| f64::from(corner[k]) * scale[k]);
            triangles.iter().flatten().map(scaled).collect()
        }
        (Form::Mesh(..), Found::Plain(_)) => Vec::new(),
    };
    own.into_iter().map(|point| pose.of(Vector(point))).collect()
}

/// Where a body that fills these points ends, seen from its joint.
fn tip(points: &[Vector<f64, 3>]) -> Option<[f64; 3]> {
    let sum = points.iter().fold(Vector::ZERO, |sum: Vector<f64, 3>, point| sum + *point);
    let length = sum.dot(&sum).sqrt();
    if points.is_empty() || length == 0.0 {
        return None;
    }
    let along = sum.scaled(1.0 / length);
    let reach = points.iter().map(|point| point.dot(&along)).fold(0.0, f64::max);
    Some(along.scaled(reach).0)
}

/// The parts of a link that can be shown: its visual, or else what collides.
fn parts<'a>(LinkLook { look, .. }: &'a LinkLook, looks: &Looks) -> Option<Vec<Found<'a>>> {
    let all = |parts: &'a [Part]| -> Option<Vec<Found<'a>>> {
        let found = parts.iter().map(|part| match &part.form {
            Form::Mesh(file, scale) if scale.iter().all(|x| (1e-6..1e6).contains(&x.abs())) => {
                Some(Found::Mesh(part, triangles(&looks.mesh(file)?)?))
            }
            Form::Mesh(..) => None,
            _ => Some(Found::Plain(part)),
        });
        found.collect()
    };
    all(&look.visual)
        .or_else(|| Some(&look.collision).filter(|parts| !parts.is_empty()).and_then(|parts| all(parts)))
}

/// Leaves meshes as they are, if that is not too much, or makes them coarser until it is not.
fn lighten<'a, 'b: 'a>(parts: impl Iterator<Item = &'a mut Found<'b>>) {
    let mut meshes: Vec<&mut Vec<Triangle>> = parts
        .filter_map(|part| match part {
            Found::Mesh(_, triangles) => Some(triangles),
            Found::Plain(_) => None,
        })
        .collect();
    for cells in CELLS {
        if meshes.iter().map(|mesh| mesh.len()).sum::<usize>() <= MOST {
            return;
        }
        for mesh in &mut meshes {
            **mesh = coarser(mesh, cells);
        }
    }
}

fn shape(link: &Pose<f64>, found: Found<'_>) -> Shape {
    let (part, form) = match found {
        Found::Plain(part) => (part, None),
        Found::Mesh(part, triangles) => (part, Some(triangles)),
    };
    let Pose { rotation, translation } = link.then(&part.frame.pose(|x| x));
    let form = match (&part.form, form) {
        (Form::Box(size), _) => Drawn::Box { size: *size },
        (Form::Cylinder([radius, length]), _) => Drawn::Cylinder { radius: *radius, length: *length },
        (Form::Sphere(radius), _) => Drawn::Sphere { radius: *radius },
        (Form::Mesh(_, scale), triangles) => {
            Drawn::Mesh { triangles: mesh(&triangles.unwrap_or_default(), *scale) }
        }
    };
    Shape { form, rotation: rotation.0, translation: translation.0 }
}

#[expect(clippy::cast_possible_truncation, reason = "what a picture shows has seven digits")]
fn mesh(triangles: &[Triangle], scale: [f64; 3]) -> String {
    let corner =
        |corner: &[f32; 3]| -> [f32; 3] { std::array::from_fn(|k| (f64::from(corner[k]) * scale[k]) as f32) };
    let numbers = triangles.iter().flatten().flat_map(corner);
    BASE64_STANDARD.encode(numbers.flat_map(f32::to_le_bytes).collect::<Vec<u8>>())
}
