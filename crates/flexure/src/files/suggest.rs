//! "Did you mean": the nearest of the names that would have been right.

/// No more names are listed in a hint once it is so many bytes long.
const LONGEST_LIST: usize = 400;

/// As many characters of a name are shown.
const LONGEST_NAME: usize = 60;

/// Names that the given one is compared with: a hint must not take longer than the file.
const MOST_COMPARED: usize = 128;

/// `did you mean 'x'? known: x, y, z`, as far as it applies.
pub(crate) fn hint<'a>(given: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    let mut list = String::new();
    for name in known.clone() {
        if list.len() > LONGEST_LIST {
            list.push_str(", …");
            break;
        }
        if !list.is_empty() {
            list.push_str(", ");
        }
        list.extend(name.chars().take(LONGEST_NAME).flat_map(char::escape_debug));
    }
    match nearest(given, known) {
        Some(name) => format!("did you mean '{name}'? known: {list}"),
        None => format!("known: {list}"),
    }
}

/// The name at the smallest edit distance, if it is near at all.
fn nearest<'a>(given: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let length = given.chars().count();
    if length > LONGEST_NAME {
        return None;
    }
    let plain = |text: &str| text.to_lowercase().replace(['-', ' '], "_");
    let (distance, name) = known
        .take(MOST_COMPARED)
        .filter(|name| !name.is_empty() && name.len() <= 4 * LONGEST_NAME)
        .map(|name| (strsim::osa_distance(&plain(given), &plain(name)), name))
        .min_by_key(|&(distance, _)| distance)?;
    (distance <= (length / 3).max(1)).then_some(name)
}

/// User text as it may stand in a message: in quotes, one line, of bounded length.
pub(crate) fn quoted(text: &str) -> String {
    let mut shown: String = text.chars().take(60).flat_map(char::escape_debug).collect();
    if text.chars().nth(60).is_some() {
        shown.push('…');
    }
    format!("'{shown}'")
}

/// `name` as a key of TOML: quoted unless it is bare.
pub(crate) fn key(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(bare) { name.to_owned() } else { text(name) }
}

/// `text` as a string of TOML.
pub(crate) fn text(text: &str) -> String {
    let escaped = |c: char| match c {
        '"' | '\\' => format!("\\{c}"),
        c if c.is_control() => format!("\\u{:04X}", u32::from(c)),
        c => c.to_string(),
    };
    format!("\"{}\"", text.chars().map(escaped).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::hint;

    #[test]
    fn names_the_near_and_only_the_near() {
        let known = ["stiffness", "motor_inertia"];
        assert_eq!(
            hint("stifness", known.into_iter()),
            "did you mean 'stiffness'? known: stiffness, motor_inertia"
        );
        assert!(hint("Motor-Inertia", known.into_iter()).starts_with("did you mean 'motor_inertia'"));
        assert!(hint("colour", known.into_iter()).starts_with("known:"));
    }
}
