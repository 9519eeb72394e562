//! An element under the name that messages have for it: finding its parts, reading its attributes.

use crate::files::decimals::Decimals;
use crate::files::document::Log;
use crate::files::quantity::Quantity;
use crate::files::site::Site;
use crate::files::suggest;
use crate::robot::urdf::xml::{Attribute, Element};

/// What a drawing program writes for zero is smaller than this.
const DUST: f64 = 1e-30;

/// An element in its context.
///
/// Every reader returns `None` after it has noted what is wrong.
#[derive(Clone)]
pub(crate) struct Node<'a> {
    pub element: &'a Element<'a>,
    pub site: Site<'a>,
}

impl<'a> Node<'a> {
    /// A link or joint, whose name is what messages call it by.
    pub fn named(element: &'a Element<'a>, log: &'a Log) -> Option<(&'a str, Self)> {
        let path = format!("<{}>", element.name);
        let node = Self { element, site: Site { span: element.span.clone(), path, log } };
        let attribute = node.required("name", "a name of its own")?;
        let name = node.at(attribute).name(&attribute.value)?;
        let path = format!("{} {}", element.name, suggest::quoted(name));
        Some((name, Self { element, site: Site { path, ..node.site } }))
    }

    /// `Some(None)` without the child; `None` if there are two.
    #[expect(clippy::option_option, reason = "bad, absent and good are three cases")]
    pub fn child(&self, name: &str) -> Option<Option<Self>> {
        let mut found = self.element.children.iter().filter(|child| child.name == name);
        let Some(element) = found.next() else { return Some(None) };
        let separator = if self.site.path.ends_with('\'') { ":" } else { "" };
        let path = format!("{}{separator} {name}", self.site.path);
        let site = |element: &Element<'_>| Site {
            span: element.span.clone(),
            path: path.clone(),
            log: self.site.log,
        };
        if let Some(second) = found.next() {
            let message = format!("{path} stands twice");
            site(second).error("duplicate", message, "one of them is enough");
            return None;
        }
        Some(Some(Self { element, site: site(element) }))
    }

    /// The child, which must be there.
    pub fn required_child(&self, name: &str, what: &str) -> Option<Self> {
        let child = self.child(name)?;
        if child.is_none() {
            let message = format!("{} has no <{name}>", self.site.path);
            self.site.error("missing", message, what);
        }
        child
    }

    fn attribute(&self, name: &str) -> Option<&'a Attribute<'a>> {
        self.element.attributes.iter().find(|attribute| attribute.name == name)
    }

    /// Whether the attribute is there.
    pub fn has(&self, name: &str) -> bool {
        self.attribute(name).is_some()
    }

    fn required(&self, name: &str, what: &str) -> Option<&'a Attribute<'a>> {
        let found = self.attribute(name);
        if found.is_none() {
            self.site.error("missing", format!("{} has no attribute {name}", self.site.path), what);
        }
        found
    }

    /// The site of an attribute.
    fn at(&self, attribute: &Attribute<'_>) -> Site<'a> {
        let path = format!("{} {}", self.site.path, attribute.name);
        Site { span: attribute.span.clone(), path, log: self.site.log }
    }

    /// The text of an attribute that must be there, with its place.
    pub fn text(&self, name: &str, what: &str) -> Option<(&'a str, Site<'a>)> {
        let attribute = self.required(name, what)?;
        Some((&attribute.value, self.at(attribute)))
    }

    /// The number of an attribute that must be there.
    pub fn number(&self, name: &str, quantity: &Quantity) -> Option<f64> {
        let attribute = self.required(name, &quantity.described())?;
        self.at(attribute).parse(&attribute.value, quantity)
    }

    /// The number of an attribute, if it is there.
    #[expect(clippy::option_option, reason = "bad, absent and good are three cases")]
    pub fn optional_number(&self, name: &str, quantity: &Quantity) -> Option<Option<f64>> {
        match self.attribute(name) {
            None => Some(None),
            Some(attribute) => self.at(attribute).parse(&attribute.value, quantity).map(Some),
        }
    }

    /// `N` numbers between blanks, called `entries` in messages; `default` without the attribute.
    pub fn numbers<const N: usize>(
        &self,
        name: &str,
        quantity: &Quantity,
        entries: &str,
        default: [f64; N],
    ) -> Option<[f64; N]> {
        let Some(attribute) = self.attribute(name) else { return Some(default) };
        let site = self.at(attribute);
        let words: Vec<&str> = attribute.value.split_whitespace().collect();
        let Ok(words) = <[&str; N]>::try_from(words.as_slice()) else {
            let message = format!("{}: {N} numbers expected ({entries}); got {}", site.path, words.len());
            site.error("length", message, format!("{}, with blanks between them", quantity.described()));
            return None;
        };
        let numbers = words.map(|word| site.parse(word, quantity));
        // All of them are looked at before the first bad one ends it.
        let numbers: Option<Vec<f64>> = numbers.into_iter().collect();
        numbers?.try_into().ok()
    }
}

impl Site<'_> {
    fn parse(&self, word: &str, quantity: &Quantity) -> Option<f64> {
        let word = word.trim();
        match word.parse::<f64>() {
            Ok(x) if x.abs() < DUST => Some(0.0),
            Ok(x) if x.is_finite() => {
                self.log.note(Decimals::of(word, x));
                self.log.accept(&self.path, x, quantity, self.span.clone())
            }
            Ok(_) => {
                let message = format!("{} is {}, must be a finite number", self.path, suggest::quoted(word));
                self.error("not-finite", message, quantity.described());
                None
            }
            Err(_) => {
                let message = format!("{} is {}, must be a number", self.path, suggest::quoted(word));
                let help = if word.contains(',') {
                    "the decimal mark is a point, and lists have blanks between numbers".to_owned()
                } else if word.contains('$') {
                    "it looks like xacro: expand it first with xacro robot.urdf.xacro > robot.urdf".to_owned()
                } else {
                    format!("{}, a number like 0.5", quantity.described())
                };
                self.error("number", message, help);
                None
            }
        }
    }
}
