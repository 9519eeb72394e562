//! The elements of a URDF that matter to its dynamics, with the place of every attribute.
//!
//! Pulled from the text one tag at a time: what is drawn, sensed or simulated elsewhere is passed over without being
//! kept, nesting is counted instead of recursed into, and nothing is ever expanded or opened.

use std::borrow::Cow;
use std::ops::Range;

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use crate::files::document::Log;
use crate::files::normal::Normal;
use crate::files::suggest;

/// Elements nested deeper than this are no URDF.
const DEEPEST: usize = 64;

/// Elements kept beyond this number are no robot.
const MOST_ELEMENTS: usize = 20_000;

/// Attributes of one element beyond this number are no URDF.
const MOST_ATTRIBUTES: usize = 64;

/// Elements that say something about the dynamics. Others are passed over with all that is in them.
const KEPT: &[&str] = &[
    "robot", "link", "joint", "inertial", "origin", "mass", "inertia", "parent", "child", "axis", "dynamics",
    "limit", "mimic",
];

/// An element with its attributes and those of its children that are kept.
#[derive(Debug)]
pub(crate) struct Element<'a> {
    pub name: &'a str,
    /// Bytes of the opening tag in the file.
    pub span: Range<usize>,
    pub attributes: Vec<Attribute<'a>>,
    pub children: Vec<Element<'a>>,
}

/// Attributes that name something: texts, whatever they look like.
const NAMES: [&str; 4] = ["name", "link", "joint", "type"];

impl Element<'_> {
    /// What it says: its name, attributes and children. Attributes of numbers are lists of them.
    pub fn normal(&self) -> Normal {
        let attribute = |attribute: &Attribute<'_>| {
            let numbers: Option<Vec<_>> = attribute
                .value
                .split_whitespace()
                .map(|word| word.parse().ok().filter(|x: &f64| x.is_finite()).map(Normal::Number))
                .collect();
            let value = match numbers {
                Some(numbers) if !NAMES.contains(&attribute.name) => Normal::List(numbers),
                _ => Normal::Text(attribute.value.to_string()),
            };
            (attribute.name.to_owned(), value)
        };
        Normal::List(vec![
            Normal::Text(self.name.to_owned()),
            Normal::Table(self.attributes.iter().map(attribute).collect()),
            Normal::List(self.children.iter().map(Self::normal).collect()),
        ])
    }
}

/// An attribute with its references resolved.
#[derive(Debug)]
pub(crate) struct Attribute<'a> {
    pub name: &'a str,
    pub value: Cow<'a, str>,
    /// Of the value, as it stands in the text.
    pub span: Range<usize>,
}

const WELL_FORMED: &str = "the file must be well-formed XML";
const XACRO: &str = "expand it first: xacro robot.urdf.xacro > robot.urdf";

/// The root element of the file of `log`; none after a note of what is wrong.
pub(crate) fn parse(log: &Log) -> Option<Element<'_>> {
    let mut document = Document { log, open: Vec::new(), skipped: Vec::new(), root: None, count: 0 };
    let mut reader = Reader::from_str(&log.source.text);
    loop {
        let start = position(reader.buffer_position());
        let event = match reader.read_event() {
            Ok(event) => event,
            Err(error) => {
                let at = position(reader.error_position());
                log.error(at..at, "xml", format!("{error}"), WELL_FORMED);
                return None;
            }
        };
        let span = start..position(reader.buffer_position());
        match event {
            Event::Start(tag) => document.enter(&tag, span)?,
            Event::Empty(tag) => {
                document.enter(&tag, span)?;
                document.leave();
            }
            Event::End(_) => document.leave(),
            Event::DocType(_) => {
                let message = "a document type declaration (<!DOCTYPE …>) stands here, must not";
                log.error(span, "dtd", message, "remove it: a URDF has none, and entities are not expanded");
                return None;
            }
            Event::Eof => return document.finish(),
            Event::Text(_)
            | Event::CData(_)
            | Event::Comment(_)
            | Event::Decl(_)
            | Event::PI(_)
            | Event::GeneralRef(_) => {}
        }
    }
}

struct Document<'a> {
    log: &'a Log,
    /// Kept elements that are still open.
    open: Vec<Element<'a>>,
    /// Opening tags of what is open and passed over, inside the innermost of `open`.
    skipped: Vec<Range<usize>>,
    root: Option<Element<'a>>,
    count: usize,
}

impl<'a> Document<'a> {
    fn enter(&mut self, tag: &BytesStart<'_>, span: Range<usize>) -> Option<()> {
        let log = self.log;
        let refuse = |code, message: String, help: &str| log.error(span.clone(), code, message, help);
        let raw = tag.name();
        let name = part(&log.source.text, raw.as_ref())?;
        let shown = || suggest::quoted(name);
        if self.open.len() + self.skipped.len() >= DEEPEST {
            let message = format!("element {} is nested {DEEPEST} deep, must be less", shown());
            refuse("depth", message, "in a URDF links and joints stand side by side");
            return None;
        }
        if name.starts_with("xacro:") && self.skipped.is_empty() {
            refuse("xacro", format!("{} is a macro, must be plain URDF", shown()), XACRO);
            return None;
        }
        if self.open.is_empty() && (name != "robot" || self.root.is_some()) {
            let message = match self.root {
                None => format!("the root element is {}, must be 'robot'", shown()),
                Some(_) => format!("{} stands after the end of <robot>, must be inside", shown()),
            };
            refuse("root", message, "a URDF is one <robot name=\"…\"> with links and joints in it");
            return None;
        }
        if !self.skipped.is_empty() || !KEPT.contains(&name) {
            self.skipped.push(span);
            return Some(());
        }
        self.count += 1;
        if self.count > MOST_ELEMENTS {
            let message = format!("more than {MOST_ELEMENTS} links, joints and parts of them");
            refuse("size", message, "is it the right file?");
            return None;
        }
        let attributes = attributes(tag, &span, log)?;
        self.open.push(Element { name, span, attributes, children: Vec::new() });
        Some(())
    }

    fn leave(&mut self) {
        if self.skipped.pop().is_some() {
            return;
        }
        let Some(element) = self.open.pop() else { return };
        match self.open.last_mut() {
            Some(parent) => parent.children.push(element),
            None => self.root = Some(element),
        }
    }

    fn finish(self) -> Option<Element<'a>> {
        let unclosed = self.skipped.first().or(self.open.first().map(|element| &element.span));
        if let Some(span) = unclosed {
            let tag = self.log.source.text.get(span.clone()).unwrap_or_default();
            let message = format!("{} is never closed", suggest::quoted(tag));
            self.log.error(span.clone(), "xml", message, "the file is cut off, or a closing tag is missing");
            return None;
        }
        if self.root.is_none() {
            let help = "a URDF is one <robot name=\"…\"> with links and joints in it";
            self.log.error(0..0, "root", "there is no element <robot>", help);
        }
        self.root
    }
}

fn attributes<'a>(tag: &BytesStart<'_>, span: &Range<usize>, log: &'a Log) -> Option<Vec<Attribute<'a>>> {
    let text = &log.source.text;
    let mut found: Vec<Attribute<'a>> = Vec::new();
    // Duplicates are looked for below: the check of the library is quadratic in what has no limit there.
    for attribute in tag.attributes().with_checks(false) {
        let attribute = match attribute {
            Ok(attribute) => attribute,
            Err(error) => {
                log.error(span.clone(), "xml", format!("{error}"), WELL_FORMED);
                return None;
            }
        };
        let name = part(text, attribute.key.as_ref())?;
        let raw = part(text, &attribute.value)?;
        let start = offset(text, raw);
        let span = start..start + raw.len();
        let objection = if found.len() >= MOST_ATTRIBUTES {
            Some(format!("an element has more than {MOST_ATTRIBUTES} attributes"))
        } else if found.iter().any(|other| other.name == name) {
            Some(format!("attribute {} stands twice", suggest::quoted(name)))
        } else {
            None
        };
        if let Some(objection) = objection {
            log.error(span, "xml", objection, WELL_FORMED);
            return None;
        }
        let value = if raw.contains('&') {
            match attribute.normalized_value(XmlVersion::Implicit1_0) {
                Ok(value) => Cow::Owned(value.into_owned()),
                Err(error) => {
                    log.error(
                        span,
                        "xml",
                        format!("{error}"),
                        "only &amp; &lt; &gt; &quot; &apos; are known",
                    );
                    return None;
                }
            }
        } else {
            Cow::Borrowed(raw)
        };
        found.push(Attribute { name, value, span });
    }
    Some(found)
}

/// The part of `text` that `slice`, which was cut out of it, is.
fn part<'a>(text: &'a str, slice: &str) -> Option<&'a str> {
    let start = offset(text, slice);
    text.get(start..start + slice.len())
}

fn offset(text: &str, slice: &str) -> usize {
    (slice.as_ptr() as usize).wrapping_sub(text.as_ptr() as usize)
}

/// Files are far smaller than 4 GiB.
fn position(offset: u64) -> usize {
    usize::try_from(offset).unwrap_or(usize::MAX)
}
