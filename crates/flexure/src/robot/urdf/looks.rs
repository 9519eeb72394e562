//! `<visual>` and `<collision>`: what links look like. Only pictures want that, so what cannot be read is passed over without a word.

use std::collections::HashMap;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use crate::robot::links::written::Frame;

/// Shapes of links, by the names of the links.
pub(crate) type Looks = HashMap<String, Look>;

/// What a link looks like.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Look {
    pub visual: Vec<Part>,
    /// What collides, which stands in where the visual cannot be shown.
    pub collision: Vec<Part>,
}

/// A shape in the frame of its link.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Part {
    pub frame: Frame,
    pub form: Form,
}

/// A shape.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Form {
    /// Lengths of the edges \[m\].
    Box([f64; 3]),
    /// Along z; radius and length \[m\].
    Cylinder([f64; 2]),
    /// Radius \[m\].
    Sphere(f64),
    /// Triangles in a file, by its name in the URDF, and what its numbers are multiplied by.
    Mesh(String, [f64; 3]),
}

/// Links with more parts are hardly drawn by a person.
const MOST_PARTS: usize = 100;

/// What the links of a URDF look like.
pub(crate) fn looks(text: &str) -> Looks {
    let mut reader = Reader::from_str(text);
    let mut found = Looks::new();
    let (mut link, mut of_collision, mut frame): (Option<String>, Option<bool>, Frame) = (None, None, ORIGIN);
    loop {
        let (tag, is_empty) = match reader.read_event() {
            Ok(Event::Start(tag)) => (tag, false),
            Ok(Event::Empty(tag)) => (tag, true),
            Ok(Event::End(tag)) => {
                match tag.name().as_ref() {
                    "link" => link = None,
                    "visual" | "collision" => of_collision = None,
                    _ => {}
                }
                continue;
            }
            Ok(Event::Eof) | Err(_) => return found,
            Ok(_) => continue,
        };
        match tag.name().as_ref() {
            "link" if !is_empty => link = attribute(&tag, "name"),
            name @ ("visual" | "collision") if link.is_some() && !is_empty => {
                (of_collision, frame) = (Some(name == "collision"), ORIGIN);
            }
            "origin" if of_collision.is_some() => {
                let three = |name| numbers(&tag, name).unwrap_or([0.0; 3]);
                frame = Frame { xyz: three("xyz"), rpy: three("rpy") };
            }
            _ => {
                let (Some(link), Some(of_collision), Some(form)) = (&link, of_collision, form(&tag)) else {
                    continue;
                };
                let look = found.entry(link.clone()).or_default();
                let parts = if of_collision { &mut look.collision } else { &mut look.visual };
                if parts.len() < MOST_PARTS {
                    parts.push(Part { frame, form });
                }
            }
        }
    }
}

const ORIGIN: Frame = Frame { xyz: [0.0; 3], rpy: [0.0; 3] };

fn form(tag: &BytesStart<'_>) -> Option<Form> {
    let length = |name| numbers(tag, name).map(|[x]: [f64; 1]| x).filter(|x| *x > 0.0);
    match tag.name().as_ref() {
        "box" => numbers(tag, "size").map(Form::Box),
        "cylinder" => Some(Form::Cylinder([length("radius")?, length("length")?])),
        "sphere" => length("radius").map(Form::Sphere),
        "mesh" => {
            // A scale that is no numbers is nobody's guess.
            let scale = if attribute(tag, "scale").is_some() { numbers(tag, "scale")? } else { [1.0; 3] };
            Some(Form::Mesh(attribute(tag, "filename")?, scale))
        }
        _ => None,
    }
}

fn attribute(tag: &BytesStart<'_>, name: &str) -> Option<String> {
    Some(tag.try_get_attribute(name).ok()??.value.into_owned())
}

/// As many finite numbers as there are in an attribute.
fn numbers<const K: usize>(tag: &BytesStart<'_>, name: &str) -> Option<[f64; K]> {
    let text = attribute(tag, name)?;
    let numbers: Vec<f64> = text.split_whitespace().map_while(|word| word.parse().ok()).collect();
    numbers.try_into().ok().filter(|numbers: &[f64; K]| numbers.iter().all(|x| x.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::{Form, Frame, ORIGIN, looks};

    #[test]
    fn shapes_are_found_with_their_frames() {
        let found = looks(
            r#"<robot><link name="a"><visual><origin xyz="1 2 3" rpy="0 0 0.5"/><geometry><box size="1 2 3"/></geometry></visual>
               <collision><geometry><cylinder radius="0.1" length="2"/></geometry></collision></link>
               <link name="b"><visual><geometry><mesh filename="package://p/b.stl" scale="0.001 0.001 0.001"/></geometry></visual>
               <inertial><origin xyz="9 9 9"/></inertial></link><link name="empty"/></robot>"#,
        );
        let a = &found["a"];
        assert_eq!(a.visual[0].frame, Frame { xyz: [1.0, 2.0, 3.0], rpy: [0.0, 0.0, 0.5] });
        assert_eq!(a.visual[0].form, Form::Box([1.0, 2.0, 3.0]));
        assert_eq!(a.collision[0].form, Form::Cylinder([0.1, 2.0]));
        assert_eq!(a.collision[0].frame, ORIGIN);
        assert_eq!(found["b"].visual[0].form, Form::Mesh("package://p/b.stl".to_owned(), [1e-3; 3]));
        assert_eq!(found.len(), 2);
    }

    #[test]
    fn what_cannot_be_read_is_passed_over() {
        for text in [
            "",
            "<",
            "no XML",
            r#"<robot><link name="a"><visual><geometry><box size="1 2"/><sphere radius="-1"/><sphere radius="nan"/></geometry></visual></link>"#,
            r#"<link><visual><box size="1 1 1"/></visual></link>"#,
            r#"<visual><sphere radius="1"/></visual><link name="x"/>"#,
            r#"<link name="a"><visual><mesh/></visual></link><link name="b"><sphere radius="1"/></link>"#,
        ] {
            assert!(looks(text).is_empty(), "{text}");
        }
    }
}
