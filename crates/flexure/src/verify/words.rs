//! Sums of words over non-commuting letters: `-S + 1/2 R - Bl`.

use std::collections::BTreeMap;

/// Letters that are their own transposes; `Fl` and `Fm` have `Fl'`, `Fm'`, and S is skew.
const SYMMETRIC: [&str; 7] = ["Pl", "Pm", "Pm^-1", "K", "R", "Bl", "Bm"];
const TRANSPOSES: [(&str, &str); 4] = [("Fl", "Fl'"), ("Fl'", "Fl"), ("Fm", "Fm'"), ("Fm'", "Fm")];

type Letter = &'static str;

/// A sum of products of letters; coefficients count halves. No product has the coefficient 0.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Sum(BTreeMap<Vec<Letter>, i64>);

impl Sum {
    /// Reads a sum; none if it is not one.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        let (mut negative, text) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest));
        let mut sum = Self::default();
        let mut term = Vec::new();
        for token in text.split_whitespace() {
            if token == "+" || token == "-" {
                sum.add_term(negative, &term)?;
                (negative, term) = (token == "-", Vec::new());
            } else {
                term.push(token);
            }
        }
        sum.add_term(negative, &term)?;
        Some(sum)
    }

    /// Adds ± `1/2 R`: a coefficient, letters, or both.
    fn add_term(&mut self, negative: bool, tokens: &[&str]) -> Option<()> {
        let (halves, letters) = match tokens.split_first()? {
            (&"0", letters) => (0, letters),
            (&"1", letters) => (2, letters),
            (&"1/2", letters) => (1, letters),
            _ => (2, tokens),
        };
        let word = letters.iter().map(|token| letter(token)).collect::<Option<_>>()?;
        self.add(word, if negative { -halves } else { halves });
        Some(())
    }

    fn add(&mut self, word: Vec<Letter>, halves: i64) {
        let total = self.0.get(&word).copied().unwrap_or(0).saturating_add(halves);
        if total == 0 {
            self.0.remove(&word);
        } else {
            self.0.insert(word, total);
        }
    }

    /// `self + other`.
    pub(super) fn plus(&self, other: &Self) -> Self {
        let mut sum = self.clone();
        for (word, halves) in &other.0 {
            sum.add(word.clone(), *halves);
        }
        sum
    }

    /// `−self`.
    #[cfg(test)]
    pub(super) fn negated(&self) -> Self {
        Self(self.0.iter().map(|(word, halves)| (word.clone(), -halves)).collect())
    }

    /// A letter times the sum: `Pm Pm^-1` cancels.
    pub(super) fn after(&self, first: Option<Letter>) -> Self {
        let Some(first) = first else { return self.clone() };
        let mut sum = Self::default();
        for (word, halves) in &self.0 {
            let inverse = first == "Pm" && word.first() == Some(&"Pm^-1");
            let product = if inverse { word[1..].to_vec() } else { [&[first], word.as_slice()].concat() };
            sum.add(product, *halves);
        }
        sum
    }

    /// The transpose: words are read from the end, each letter transposed.
    pub(super) fn transposed(&self) -> Self {
        let mut sum = Self::default();
        for (word, halves) in &self.0 {
            let skew = word.iter().filter(|letter| **letter == "S").count() % 2 == 1;
            let transposed = |letter: &Letter| {
                TRANSPOSES.iter().find(|(from, _)| from == letter).map_or(*letter, |(_, to)| *to)
            };
            sum.add(word.iter().rev().map(transposed).collect(), if skew { -halves } else { *halves });
        }
        sum
    }

    pub(super) fn is_zero(&self) -> bool {
        self.0.is_empty()
    }
}

fn letter(token: &str) -> Option<Letter> {
    let transposed = TRANSPOSES.iter().map(|(letter, _)| *letter);
    SYMMETRIC.into_iter().chain(transposed).chain(["S"]).find(|letter| *letter == token)
}

#[cfg(test)]
mod tests {
    use super::Sum;

    fn sum(text: &str) -> Sum {
        Sum::parse(text).unwrap()
    }

    #[test]
    fn words_do_not_commute() {
        assert_ne!(sum("K Pm"), sum("Pm K"));
        assert_eq!(sum("Pm K - K"), sum("- K + Pm K"));
        assert!(sum("Fl - Fl").is_zero() && sum("0").is_zero() && !sum("1").is_zero());
    }

    #[test]
    fn products_are_transposed_from_the_end() {
        assert_eq!(sum("Pl Fl").transposed(), sum("Fl' Pl"));
        assert_eq!(sum("-S + 1/2 R").transposed(), sum("S + 1/2 R"));
        assert_eq!(sum("S K S").transposed(), sum("S K S"));
    }

    #[test]
    fn an_inverse_cancels_from_its_side_only() {
        assert_eq!(sum("-Pm^-1 K + 1").after(Some("Pm")), sum("-K + Pm"));
        assert_eq!(sum("K Pm^-1").after(Some("Pm")), sum("Pm K Pm^-1"));
    }

    #[test]
    fn what_is_no_sum_is_refused() {
        for text in ["", "-", "K +", "+ K", "X", "2 K", "K - - K", "1/2/2", "Pm^-2", "--K", "S'"] {
            assert_eq!(Sum::parse(text), None, "{text}");
        }
    }
}
