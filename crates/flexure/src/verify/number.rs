//! Numbers as the file writes them: decimals that stand for rationals, and pairs of them.

use std::fmt;

use flexure_core::scalar::Interval;

use crate::verify::json::clipped;

/// Longer texts are no numbers.
const LONGEST: usize = 1000;

/// A decimal, or some real between two decimals.
#[derive(Clone, Debug)]
pub(super) struct Number {
    text: String,
    /// Which rational it is; none of a pair.
    rational: Option<Rational>,
    /// Contains every real it may stand for.
    pub(super) value: Interval,
}

/// ± 0.digits · 10^exponent; digits neither start nor end in 0, those of zero are empty.
#[derive(Clone, Debug, PartialEq)]
struct Rational {
    negative: bool,
    digits: String,
    exponent: i64,
}

impl Number {
    /// A decimal.
    pub(super) fn decimal(text: &str) -> Result<Self, String> {
        let no_number = || format!("'{}' is no finite decimal", clipped(text));
        let rational = Rational::parse(text).ok_or_else(no_number)?;
        let value = Interval::from_decimal(text).filter(|value| value.magnitude().is_finite());
        Ok(Self { text: text.to_owned(), rational: Some(rational), value: value.ok_or_else(no_number)? })
    }

    /// Some real between two decimals.
    pub(super) fn between(lower: &str, upper: &str) -> Result<Self, String> {
        let (a, b) = (Self::decimal(lower)?, Self::decimal(upper)?);
        if a.value.lo() > b.value.hi() {
            return Err(format!("the pair [{a}, {b}] is the wrong way round"));
        }
        Ok(Self { text: format!("[{a}, {b}]"), rational: None, value: a.value.hull(b.value) })
    }

    /// Certainly > 0.
    pub(super) fn is_positive(&self) -> bool {
        self.value.lo() > 0.0
    }

    /// Certainly ≥ 0.
    pub(super) fn is_nonnegative(&self) -> bool {
        self.value.lo() >= 0.0
    }

    /// Whether both are the same rational, however written.
    pub(super) fn is(&self, other: &Self) -> bool {
        self.rational.is_some() && self.rational == other.rational
    }

    /// Certainly ≤: the intervals say so, or they are the same rational.
    pub(super) fn is_at_most(&self, other: &Self) -> bool {
        self.value.hi() <= other.value.lo() || self.is(other)
    }

    /// −x.
    pub(super) fn negated(&self) -> Self {
        let rational = self.rational.clone().map(|mut rational| {
            rational.negative = !rational.negative && !rational.digits.is_empty();
            rational
        });
        Self { text: format!("-({})", self.text), rational, value: -self.value }
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&clipped(&self.text))
    }
}

impl Rational {
    fn parse(text: &str) -> Option<Self> {
        if text.len() > LONGEST {
            return None;
        }
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse::<i64>().ok()?),
            None => (text, 0),
        };
        let unsigned = mantissa.strip_prefix(['-', '+']).unwrap_or(mantissa);
        let (whole, fraction) = unsigned.split_once('.').unwrap_or((unsigned, ""));
        let all = format!("{whole}{fraction}");
        if all.is_empty() || !all.bytes().all(|byte| byte.is_ascii_digit()) {
            return None;
        }
        let digits = all.trim_start_matches('0');
        if digits.is_empty() {
            return Some(Self { negative: false, digits: String::new(), exponent: 0 });
        }
        let point = i64::try_from(digits.len()).ok()? - i64::try_from(fraction.len()).ok()?;
        let exponent = exponent.checked_add(point)?;
        Some(Self {
            negative: mantissa.starts_with('-'),
            digits: digits.trim_end_matches('0').to_owned(),
            exponent,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Number;

    #[test]
    fn equal_rationals_are_recognised_and_others_are_not() {
        let number = |text| Number::decimal(text).unwrap();
        for (a, b) in [("55", "5.5e1"), ("0.10", ".1"), ("0", "-0.0e7"), ("100", "1E+2"), ("-2.50", "-25e-1")]
        {
            assert!(number(a).is(&number(b)) && number(a).is_at_most(&number(b)), "{a} {b}");
        }
        for (a, b) in [("55", "-55"), ("0.1", "0.10000000000000000001"), ("1", "10"), ("0.01", "0.1")] {
            assert!(!number(a).is(&number(b)), "{a} {b}");
        }
        assert!(number("0.1").negated().is(&number("-0.1")) && number("0").negated().is(&number("0")));
        assert!(!number("0.10000000000000000001").is_at_most(&number("0.1")));
        let pair = Number::between("1", "2").unwrap();
        assert!(!pair.is(&pair) && !pair.is_at_most(&pair));
    }

    #[test]
    fn what_is_no_number_is_refused() {
        let long = "1".repeat(2000);
        for text in
            ["", "-", ".", "nan", "inf", "1e400", "-1e400", "0x1", "1_000", " 1", "1,5", "e5", "--1", &long]
        {
            assert!(Number::decimal(text).is_err(), "{text}");
        }
        for text in ["1e", "1e1.5", "1e99999999999999999999", "+-1", "1.2.3", "١"] {
            assert!(Number::decimal(text).is_err(), "{text}");
        }
        assert!(Number::between("2", "1").is_err());
    }
}
