//! JSON as a tree: every key once, no number but whole ones from 0.

use std::fmt;

use serde::de::{self, Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_json::Value;

/// A JSON value.
pub(super) enum Node {
    Null,
    Truth(bool),
    Index(u64),
    Text(String),
    List(Vec<Node>),
    Object(Vec<(String, Node)>),
}

impl Node {
    /// Name of the kind of value, for messages.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self::Null => "null",
            Self::Truth(_) => "true or false",
            Self::Index(_) => "a JSON number",
            Self::Text(_) => "a text",
            Self::List(_) => "a list",
            Self::Object(_) => "an object",
        }
    }
}

impl<'de> Deserialize<'de> for Node {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Nodes)
    }
}

/// Builds nodes from what the parser meets.
struct Nodes;

impl<'de> Visitor<'de> for Nodes {
    type Value = Node;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a text, a list, an object, null, true, false or a whole number from 0")
    }

    fn visit_unit<E>(self) -> Result<Node, E> {
        Ok(Node::Null)
    }

    fn visit_bool<E>(self, truth: bool) -> Result<Node, E> {
        Ok(Node::Truth(truth))
    }

    fn visit_u64<E>(self, index: u64) -> Result<Node, E> {
        Ok(Node::Index(index))
    }

    fn visit_str<E>(self, text: &str) -> Result<Node, E> {
        Ok(Node::Text(text.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> Result<Node, A::Error> {
        let mut list = Vec::new();
        while let Some(entry) = entries.next_element()? {
            list.push(entry);
        }
        Ok(Node::List(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Node, A::Error> {
        let mut object: Vec<(String, Node)> = Vec::new();
        while let Some(key) = entries.next_key::<String>()? {
            // More keys than any object of a certificate has: also keeps the search for doubles short.
            if object.len() == MOST_KEYS {
                return Err(de::Error::custom(format!("an object has more than {MOST_KEYS} keys")));
            }
            if object.iter().any(|(known, _)| *known == key) {
                return Err(de::Error::custom(format!("key '{}' is there twice", clipped(&key))));
            }
            object.push((key, entries.next_value()?));
        }
        Ok(Node::Object(object))
    }
}

/// JSON of which every key is there once, and no number but whole ones from 0.
///
/// # Errors
/// Where it is not.
pub(crate) fn strict(text: &str) -> serde_json::Result<Value> {
    serde_json::from_str::<Node>(text).map(Value::from)
}

impl From<Node> for Value {
    fn from(node: Node) -> Self {
        match node {
            Node::Null => Self::Null,
            Node::Truth(truth) => truth.into(),
            Node::Index(index) => index.into(),
            Node::Text(text) => text.into(),
            Node::List(list) => Self::Array(list.into_iter().map(Self::from).collect()),
            Node::Object(object) => {
                Self::Object(object.into_iter().map(|(key, node)| (key, node.into())).collect())
            }
        }
    }
}

/// Objects with more keys are refused.
const MOST_KEYS: usize = 64;

/// The first 60 characters of a text, for messages.
pub(super) fn clipped(text: &str) -> String {
    match text.char_indices().nth(60) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}
