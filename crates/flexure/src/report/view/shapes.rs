//! What the links look like, for the page.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde::Serialize;

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

/// The shapes of the base and of each body; of none if a link is told to look like something that cannot be shown: half a robot would be
/// worse than one that is made up.
pub(super) fn shapes(robot: &Robot) -> (Vec<Shape>, Vec<Vec<Shape>>) {
    let mut base = Vec::new();
    let mut bodies: Vec<Vec<Shape>> = robot.joints.iter().map(|_| Vec::new()).collect();
    let found: Option<Vec<_>> =
        robot.looks.links.iter().map(|link| Some((link, parts(link, &robot.looks)?))).collect();
    let Some(mut found) = found else { return (base, bodies) };
    lighten(found.iter_mut().flat_map(|(_, parts)| parts));
    for (link, parts) in found {
        let of = link.body.map_or(&mut base, |body| &mut bodies[body]);
        of.extend(parts.into_iter().map(|part| shape(&link.pose, part)));
    }
    (base, bodies)
}

/// The parts of a link that can be shown: its visual, or else what collides.
fn parts<'a>(LinkLook { look, .. }: &'a LinkLook, looks: &Looks) -> Option<Vec<Found<'a>>> {
    let all = |parts: &'a [Part]| -> Option<Vec<Found<'a>>> {
        let found = parts.iter().map(|part| match &part.form {
            Form::Mesh(file, _) => Some(Found::Mesh(part, triangles(&looks.mesh(file)?)?)),
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
