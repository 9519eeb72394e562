//! Every entry of every list dropped and doubled, every key dropped, and one added.

use serde_json::Value;

use super::mutants::{Mutant, all_refused, each};

pub fn mutants() -> Vec<Mutant> {
    // What was assumed is not checked.
    let checked = |path: &str, value: &Value| match value {
        Value::Array(list) if path != "/assumptions" => list.clone(),
        _ => Vec::new(),
    };
    let mut mutants = each("entry dropped", |path, value| {
        let list = checked(path, value);
        let without = |i: usize| [&list[..i], &list[i + 1..]].concat();
        (0..list.len()).map(|i| Value::from(without(i))).collect()
    });
    mutants.extend(each("entry doubled", |path, value| {
        let list = checked(path, value);
        let twice = |i: usize| [&list[..i], &list[i..=i], &list[i..]].concat();
        (0..list.len()).map(|i| Value::from(twice(i))).collect()
    }));
    mutants.extend(each("key dropped", |_, value| {
        let Value::Object(object) = value else { return Vec::new() };
        let without = |key: &String| {
            let mut object = object.clone();
            object.remove(key);
            Value::Object(object)
        };
        object.keys().map(without).collect()
    }));
    mutants.extend(each("key added", |_, value| {
        let Value::Object(object) = value else { return Vec::new() };
        let mut object = object.clone();
        object.insert("more".to_owned(), Value::Null);
        vec![Value::Object(object)]
    }));
    mutants.extend(each("a list instead", |_, value| {
        let Value::Object(object) = value else { return Vec::new() };
        vec![Value::Array(object.values().cloned().collect())]
    }));
    mutants.extend(each("null", |path, value| {
        // Without a tube there is one claim less; an arm that falls into two has a smaller mass matrix.
        if value.is_null() || path == "/tube" || path.ends_with("/parent") {
            Vec::new()
        } else {
            vec![Value::Null]
        }
    }));
    mutants
}

#[test]
fn nothing_is_missing_and_nothing_is_there_twice() {
    all_refused(&mutants(), 2000);
}
