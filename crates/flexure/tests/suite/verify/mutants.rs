//! Certificates with one thing changed.

use flexure::verify::Rejected;
use flexure::verify::verify;
use serde_json::Value;

use super::certificates;

/// A certificate with one thing changed, and where.
pub struct Mutant {
    pub name: String,
    pub text: String,
}

impl Mutant {
    pub fn new(certificate: &str, path: &str, what: &str, content: &Value) -> Self {
        Self { name: format!("{certificate}{path}: {what}"), text: content.to_string() }
    }

    /// The exit code that the command has for it.
    pub fn code(&self) -> i32 {
        match verify(&self.text) {
            Ok(_) => 0,
            Err(Rejected::False { .. }) => 1,
            Err(Rejected::Malformed { .. }) => 2,
        }
    }
}

/// Every value of the tree with its path as a JSON pointer.
pub fn paths(value: &Value) -> Vec<String> {
    fn walk(value: &Value, path: &str, found: &mut Vec<String>) {
        found.push(path.to_owned());
        match value {
            Value::Array(list) => {
                for (i, entry) in list.iter().enumerate() {
                    walk(entry, &format!("{path}/{i}"), found);
                }
            }
            Value::Object(object) => {
                for (key, entry) in object {
                    walk(entry, &format!("{path}/{key}"), found);
                }
            }
            _ => {}
        }
    }
    let mut found = Vec::new();
    walk(value, "", &mut found);
    found
}

/// For each certificate and each value in it, what `change` makes of that value, if anything.
pub fn each(what: &str, change: impl Fn(&str, &Value) -> Vec<Value>) -> Vec<Mutant> {
    let mut mutants = Vec::new();
    for (name, certificate) in certificates() {
        for path in paths(&certificate) {
            for changed in change(&path, certificate.pointer(&path).unwrap()) {
                let mut content = certificate.clone();
                *content.pointer_mut(&path).unwrap() = changed;
                mutants.push(Mutant::new(name, &path, what, &content));
            }
        }
    }
    mutants
}

/// Every mutant of every kind: what the other checker is given.
pub fn all() -> Vec<Mutant> {
    [super::values::mutants(), super::lists::mutants(), super::signs::mutants()]
        .into_iter()
        .flatten()
        .collect()
}

/// None is verified.
#[track_caller]
pub fn all_refused(mutants: &[Mutant], at_least: usize) {
    assert!(mutants.len() >= at_least, "{} mutants", mutants.len());
    let verified: Vec<_> =
        mutants.iter().filter(|mutant| mutant.code() == 0).map(|mutant| &mutant.name).collect();
    assert!(verified.is_empty(), "{} of {} verified: {verified:#?}", verified.len(), mutants.len());
}
