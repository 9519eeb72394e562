//! The coupling of the closed loop cancels in its storage: shown once, in words that do not commute, for every number of
//! joints.

use std::collections::BTreeMap;

/// Rows of the variational closed loop: d/dt of δq̃_l, δq̃_m, δσ_l, δσ_m from δq̃_l, δq̃_m, δs_l, δs_m with s = M⁻¹ σ. Paper,
/// eq. design-closed-complete, which it does not print; letters as in `docs/certificate.md`.
pub const ROWS: [[&str; 4]; 4] = [
    ["-Fl", "0", "1", "0"],
    ["0", "-Fm", "-Pm^-1 K", "1"],
    ["-Pl", "K", "-S + 1/2 R - Bl", "0"],
    ["0", "-Pm", "0", "-Bm"],
];

/// What multiplies each row in Ẇ.
const WEIGHTS: [&str; 4] = ["Pl", "Pm", "1", "1"];

/// What the rate of the metric adds on the diagonal: −½ Ṁ_l, from d/dt M_l⁻¹.
const METRIC_RATE: [&str; 4] = ["0", "0", "-1/2 R", "0"];

/// What remains: Ẇ = −Σ δz_iᵀ X_i δz_i.
pub const DISSIPATION: [&str; 4] = ["Pl Fl", "Pm Fm", "Bl", "Bm"];

/// A sum of words with coefficients. Those are dyadic and small: floats hold them exactly.
#[derive(Clone, Debug, Default, PartialEq)]
struct Sum(BTreeMap<Vec<String>, f64>);

impl Sum {
    fn parse(text: &str) -> Self {
        let mut sum = Self::default();
        let (mut sign, mut coefficient, mut word) = (1.0, 1.0, Vec::new());
        let spaced = text.replace('-', " - ").replace("^ - ", "^-");
        for token in spaced.split_whitespace().chain(["+"]) {
            match token {
                "+" | "-" => {
                    if !word.is_empty() {
                        sum.add(word.drain(..).filter(|letter| letter != "1").collect(), sign * coefficient);
                    }
                    (sign, coefficient) = (if token == "-" { -1.0 } else { 1.0 }, 1.0);
                }
                "1/2" => coefficient = 0.5,
                "0" => {}
                letter => word.push(letter.to_owned()),
            }
        }
        sum
    }

    fn add(&mut self, word: Vec<String>, coefficient: f64) {
        let total = self.0.entry(word).or_default();
        *total += coefficient;
        self.0.retain(|_, coefficient| *coefficient != 0.0);
    }

    fn plus(&self, other: &Self) -> Self {
        let mut sum = self.clone();
        for (word, coefficient) in &other.0 {
            sum.add(word.clone(), *coefficient);
        }
        sum
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = Self::default();
        for (a, x) in &self.0 {
            for (b, y) in &other.0 {
                product.add(cancelled(a.iter().chain(b)), x * y);
            }
        }
        product
    }

    fn transposed(&self) -> Self {
        let mut sum = Self::default();
        for (word, coefficient) in &self.0 {
            let skew = word.iter().filter(|letter| *letter == "S").count();
            let sign = if skew % 2 == 0 { 1.0 } else { -1.0 };
            sum.add(word.iter().rev().map(|letter| transposed(letter)).collect(), sign * coefficient);
        }
        sum
    }
}

/// A product of letters without `Pm Pm^-1` and `Pm^-1 Pm`.
fn cancelled<'a>(letters: impl Iterator<Item = &'a String>) -> Vec<String> {
    let mut word: Vec<String> = Vec::new();
    for letter in letters {
        let inverse = matches!(
            (word.last().map(String::as_str), letter.as_str()),
            (Some("Pm"), "Pm^-1") | (Some("Pm^-1"), "Pm")
        );
        if inverse {
            word.pop();
        } else {
            word.push(letter.clone());
        }
    }
    word
}

/// The transpose of a letter; the sign of the skew one is counted elsewhere.
fn transposed(letter: &str) -> String {
    match letter {
        "Fl" | "Fm" => format!("{letter}'"),
        "Fl'" | "Fm'" => letter[..2].to_owned(),
        symmetric => symmetric.to_owned(),
    }
}

/// Whether Ẇ of a closed loop with these `rows` is −Σ δz_iᵀ X_i δz_i with `X` in [`DISSIPATION`], whatever the letters
/// stand for.
fn cancels(rows: &[[&str; 4]; 4]) -> bool {
    let form = |i: usize, j: usize| {
        let entry = Sum::parse(WEIGHTS[i]).times(&Sum::parse(rows[i][j]));
        if i == j { entry.plus(&Sum::parse(METRIC_RATE[i])) } else { entry }
    };
    (0..4).all(|i| {
        (0..=i).all(|j| {
            let both = form(i, j).plus(&form(j, i).transposed());
            let left = Sum::parse(DISSIPATION[i]);
            let expected = if i == j { left.plus(&left.transposed()) } else { Sum::default() };
            both.plus(&expected) == Sum::default()
        })
    })
}

/// Whether the coupling cancels: a fact that every certificate rests on, looked at each time.
pub fn coupling_cancels() -> bool {
    cancels(&ROWS)
}

#[cfg(test)]
mod tests {
    use super::{ROWS, Sum, cancels, coupling_cancels};

    #[test]
    fn words_multiply_and_transpose() {
        let product = Sum::parse("Pm").times(&Sum::parse("-Pm^-1 K + 1/2 S"));
        assert_eq!(product, Sum::parse("-K + 1/2 Pm S"));
        assert_eq!(product.transposed(), Sum::parse("-K - 1/2 S Pm"));
        assert_eq!(Sum::parse("Fl S").transposed(), Sum::parse("-S Fl'"));
        assert_eq!(Sum::parse("K - K"), Sum::default());
        assert_ne!(Sum::parse("1"), Sum::default());
    }

    /// Any sign flipped, any entry left out, and the slip of the paper's text (Π_m K for −Π_m⁻¹ K): none cancels.
    #[test]
    fn the_coupling_cancels_and_no_other_does() {
        assert!(coupling_cancels());
        for (i, row) in ROWS.iter().enumerate() {
            for (j, entry) in row.iter().enumerate().filter(|(_, entry)| **entry != "0") {
                // The sign of S does not matter: skew is skew. That of its neighbours does.
                let flipped = match entry.strip_prefix('-') {
                    Some("S + 1/2 R - Bl") => "-S - 1/2 R - Bl".to_owned(),
                    Some(positive) => positive.to_owned(),
                    None => format!("-{entry}"),
                };
                for other in [flipped.as_str(), "0", "Pm K"] {
                    let mut rows = ROWS;
                    rows[i][j] = other;
                    assert!(!cancels(&rows), "{other} at {i}, {j}");
                }
            }
        }
    }
}
