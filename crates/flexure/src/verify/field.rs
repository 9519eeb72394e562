//! A place in the file and what stands there.

use crate::verify::json::{Node, clipped};
use crate::verify::number::Number;
use crate::verify::verdict::Rejected;

/// A value with the path that leads to it.
pub(super) struct Field<'a> {
    path: String,
    node: &'a Node,
}

impl<'a> Field<'a> {
    /// The whole file.
    pub(super) fn root(node: &'a Node) -> Self {
        Self { path: String::new(), node }
    }

    /// Refuses the file for what stands here.
    pub(super) fn bad(&self, reason: impl Into<String>) -> Rejected {
        let place = if self.path.is_empty() { "the file".to_owned() } else { self.path.clone() };
        Rejected::Malformed { place, reason: reason.into(), line: None, column: None }
    }

    fn not(&self, wanted: &str) -> Rejected {
        self.bad(format!("is {}, must be {wanted}", self.node.kind()))
    }

    fn entries(&self) -> Result<&'a [(String, Node)], Rejected> {
        match self.node {
            Node::Object(entries) => Ok(entries),
            _ => Err(self.not("an object")),
        }
    }

    /// The value of a key, if the key is there.
    pub(super) fn get(&self, key: &str) -> Result<Option<Self>, Rejected> {
        let node = self.entries()?.iter().find(|(known, _)| known == key).map(|(_, node)| node);
        let dot = if self.path.is_empty() { "" } else { "." };
        Ok(node.map(|node| Field { path: format!("{}{dot}{key}", self.path), node }))
    }

    /// The values of these keys; no key may be missing and there may be no other.
    pub(super) fn object<const N: usize>(&self, keys: [&str; N]) -> Result<[Self; N], Rejected> {
        if let Some((key, _)) = self.entries()?.iter().find(|(key, _)| !keys.contains(&key.as_str())) {
            return Err(self.bad(format!("unknown key '{}'", clipped(key))));
        }
        let mut fields = Vec::with_capacity(N);
        for key in keys {
            fields.push(self.get(key)?.ok_or_else(|| self.bad(format!("key '{key}' is missing")))?);
        }
        fields.try_into().map_err(|_| self.bad("has the wrong keys"))
    }

    /// The entries of a list.
    pub(super) fn list(&self) -> Result<Vec<Self>, Rejected> {
        let Node::List(list) = self.node else { return Err(self.not("a list")) };
        let entry = |(i, node)| Field { path: format!("{}[{i}]", self.path), node };
        Ok(list.iter().enumerate().map(entry).collect())
    }

    /// The entries of a list of `count`.
    pub(super) fn list_of(&self, count: usize) -> Result<Vec<Self>, Rejected> {
        let list = self.list()?;
        if list.len() != count {
            return Err(self.bad(format!("has {} entries, must have {count}", list.len())));
        }
        Ok(list)
    }

    /// The entries of a list of `N`, read one by one.
    pub(super) fn array<const N: usize, T>(
        &self,
        read: impl Fn(&Self) -> Result<T, Rejected>,
    ) -> Result<[T; N], Rejected> {
        let entries = self.list_of(N)?.iter().map(read).collect::<Result<Vec<_>, _>>()?;
        entries.try_into().map_err(|_| self.bad(format!("must have {N} entries")))
    }

    /// What stands here unless it is null.
    pub(super) fn unless_null(self) -> Option<Self> {
        (!matches!(self.node, Node::Null)).then_some(self)
    }

    pub(super) fn text(&self) -> Result<&'a str, Rejected> {
        match self.node {
            Node::Text(text) => Ok(text),
            _ => Err(self.not("a text")),
        }
    }

    pub(super) fn truth(&self) -> Result<bool, Rejected> {
        match self.node {
            Node::Truth(truth) => Ok(*truth),
            _ => Err(self.not("true or false")),
        }
    }

    /// A JSON number, whole and at least 0.
    pub(super) fn index(&self) -> Result<usize, Rejected> {
        match self.node {
            Node::Index(index) => usize::try_from(*index).map_err(|_| self.bad("is too large")),
            _ => Err(self.not("a JSON number")),
        }
    }

    /// What one of the names stands for.
    pub(super) fn one_of<T: Copy>(&self, names: &[(&str, T)]) -> Result<T, Rejected> {
        let text = self.text()?;
        names.iter().find(|(name, _)| *name == text).map(|(_, value)| *value).ok_or_else(|| {
            let known: Vec<_> = names.iter().map(|(name, _)| format!("'{name}'")).collect();
            self.bad(format!("is '{}', must be one of {}", clipped(text), known.join(", ")))
        })
    }

    /// A decimal or a pair of them.
    pub(super) fn number(&self) -> Result<Number, Rejected> {
        let number = match self.node {
            Node::Text(text) => Number::decimal(text),
            Node::List(_) => {
                let [lower, upper] = self.array(Field::text)?;
                Number::between(lower, upper)
            }
            _ => return Err(self.not("a number written as a text, or a pair of them")),
        };
        number.map_err(|reason| self.bad(reason))
    }

    pub(super) fn numbers(&self, count: usize) -> Result<Vec<Number>, Rejected> {
        self.list_of(count)?.iter().map(Self::number).collect()
    }
}
