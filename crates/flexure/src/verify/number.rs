//! Numbers as the file writes them: decimals that stand for rationals, and pairs of them.

use std::cmp::Ordering;
use std::fmt;

use flexure_core::scalar::Interval;

use crate::verify::json::clipped;

/// Longer texts are no numbers.
const LONGEST: usize = 100;

/// Exponents have at most so many digits.
const MOST_EXPONENT_DIGITS: usize = 3;

/// A number is 0, or of a magnitude from 10^-330 to less than 10^100: 0.1 to less than 1 times these powers of ten.
const MAGNITUDES: std::ops::RangeInclusive<i64> = -329..=100;

/// A decimal, or some real between two decimals.
#[derive(Clone, Debug)]
pub(super) struct Number {
    text: String,
    low: Rational,
    high: Rational,
    is_pair: bool,
    /// Contains every real it may stand for.
    pub(super) value: Interval,
    /// The same after rounding as [`Stronger`] has it: what a claim is held to.
    pub(super) claimed: Interval,
}

/// How a claimed number is rounded before it is compared with what a checker finds: to a number of few digits that claims
/// no less, so that checkers that compute with different precision agree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stronger {
    /// Up, to so many digits: the more the stronger.
    Up(usize),
    /// Down, to so many digits: the less the stronger.
    Down(usize),
}

/// ± 0.digits · 10^exponent; digits neither start nor end in 0, those of zero are empty.
#[derive(Clone, Debug, PartialEq)]
struct Rational {
    negative: bool,
    digits: String,
    exponent: i64,
}

/// Whether `text` is a number as `docs/certificate.md` spells it.
pub(crate) fn is_decimal(text: &str) -> bool {
    Number::decimal(text).is_ok()
}

impl Number {
    /// A decimal.
    pub(super) fn decimal(text: &str) -> Result<Self, String> {
        let rational = Rational::parse(text)
            .ok_or_else(|| format!("'{}' is no decimal as certificates have them", clipped(text)))?;
        let value = rational.enclosed();
        let (low, high) = (rational.clone(), rational);
        Ok(Self { text: text.to_owned(), low, high, is_pair: false, value, claimed: value })
    }

    /// Some real between two decimals.
    pub(super) fn between(lower: &str, upper: &str) -> Result<Self, String> {
        let (a, b) = (Self::decimal(lower)?, Self::decimal(upper)?);
        if a.low > b.high {
            return Err(format!("the pair [{a}, {b}] is the wrong way round"));
        }
        let (text, value) = (format!("[{a}, {b}]"), a.value.hull(b.value));
        Ok(Self { text, low: a.low, high: b.high, is_pair: true, value, claimed: value })
    }

    /// As a claim that is rounded before it is compared.
    pub(super) fn held_to(mut self, stronger: Stronger) -> Self {
        let [low, high] = [&self.low, &self.high].map(|end| end.rounded(stronger).enclosed());
        self.claimed = low.hull(high);
        self
    }

    /// Certainly > 0.
    pub(super) fn is_positive(&self) -> bool {
        !self.low.negative && !self.low.digits.is_empty()
    }

    /// Certainly ≥ 0.
    pub(super) fn is_nonnegative(&self) -> bool {
        !self.low.negative
    }

    /// Whether both are the same rational, however written.
    pub(super) fn is(&self, other: &Self) -> bool {
        !self.is_pair && !other.is_pair && self.low == other.low
    }

    /// Certainly ≤, as rationals.
    pub(super) fn is_at_most(&self, other: &Self) -> bool {
        self.high <= other.low
    }

    /// Certainly of a magnitude of at most `bound`, as rationals.
    pub(super) fn is_within(&self, bound: &Self) -> bool {
        bound.low.negated() <= self.low && self.high <= bound.low
    }

    /// −x.
    pub(super) fn negated(&self) -> Self {
        Self {
            text: format!("-({})", self.text),
            low: self.high.negated(),
            high: self.low.negated(),
            is_pair: self.is_pair,
            value: -self.value,
            claimed: -self.claimed,
        }
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&clipped(&self.text))
    }
}

impl Rational {
    /// A number of JSON, not too long and neither too large nor too small.
    fn parse(text: &str) -> Option<Self> {
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, Self::exponent(exponent)?),
            None => (text, 0),
        };
        let unsigned = mantissa.strip_prefix('-').unwrap_or(mantissa);
        let (whole, fraction) = match unsigned.split_once('.') {
            Some((whole, fraction)) => (whole, Some(fraction)),
            None => (unsigned, None),
        };
        let all_digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
        let sound = text.len() <= LONGEST
            && all_digits(whole)
            && (whole == "0" || !whole.starts_with('0'))
            && fraction.is_none_or(all_digits);
        if !sound {
            return None;
        }
        let all = format!("{whole}{}", fraction.unwrap_or_default());
        let digits = all.trim_start_matches('0');
        let leading = i64::try_from(whole.len() + digits.len()).ok()? - i64::try_from(all.len()).ok()?;
        let digits = digits.trim_end_matches('0').to_owned();
        if digits.is_empty() {
            return Some(Self { negative: false, digits, exponent: 0 });
        }
        let exponent = exponent + leading;
        let negative = mantissa.starts_with('-');
        MAGNITUDES.contains(&exponent).then_some(Self { negative, digits, exponent })
    }

    fn exponent(text: &str) -> Option<i64> {
        let (negative, digits) = match text.strip_prefix('-') {
            Some(digits) => (true, digits),
            None => (false, text.strip_prefix('+').unwrap_or(text)),
        };
        let sound = (1..=MOST_EXPONENT_DIGITS).contains(&digits.len());
        let exponent: i64 =
            digits.parse().ok().filter(|_| sound && digits.bytes().all(|byte| byte.is_ascii_digit()))?;
        Some(if negative { -exponent } else { exponent })
    }

    /// Contains the rational.
    fn enclosed(&self) -> Interval {
        let Self { negative, digits, exponent } = self;
        let (sign, digits) = (if *negative { "-" } else { "" }, if digits.is_empty() { "0" } else { digits });
        // The fewest digits: short ones are enclosed most tightly.
        let power = exponent.saturating_sub(i64::try_from(digits.len()).unwrap_or(i64::MAX));
        Interval::from_decimal(&format!("{sign}{digits}e{power}")).unwrap_or(Interval::ENTIRE)
    }

    fn negated(&self) -> Self {
        let negative = !self.negative && !self.digits.is_empty();
        Self { negative, ..self.clone() }
    }

    /// The nearest number of so many digits above, or below, if it is not one itself.
    fn rounded(&self, stronger: Stronger) -> Self {
        let (count, away) = match stronger {
            Stronger::Up(count) => (count, !self.negative),
            Stronger::Down(count) => (count, self.negative),
        };
        let Some(kept) = self.digits.get(..count).filter(|_| self.digits.len() > count) else {
            return self.clone();
        };
        let digits = if away { incremented(kept) } else { kept.to_owned() };
        let carry = i64::from(digits.len() > count);
        Self {
            negative: self.negative,
            digits: digits.trim_end_matches('0').to_owned(),
            exponent: self.exponent + carry,
        }
    }

    /// Compares magnitudes.
    fn magnitude(&self, other: &Self) -> Ordering {
        let key = |x: &Self| (!x.digits.is_empty(), x.exponent);
        // Digits without zeros at their ends are in the order of what they stand for.
        key(self).cmp(&key(other)).then_with(|| self.digits.cmp(&other.digits))
    }
}

/// The whole number after that of these digits.
fn incremented(digits: &str) -> String {
    let nines = digits.len() - digits.trim_end_matches('9').len();
    let (rest, zeros) = (&digits[..digits.len() - nines], "0".repeat(nines));
    match rest.as_bytes().split_last() {
        None => format!("1{zeros}"),
        Some((last, before)) => {
            let before: String = before.iter().map(|&byte| char::from(byte)).collect();
            format!("{before}{}{zeros}", char::from(last + 1))
        }
    }
}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(match (self.negative, other.negative) {
            (false, true) => Ordering::Greater,
            (true, false) => Ordering::Less,
            (false, false) => self.magnitude(other),
            (true, true) => other.magnitude(self),
        })
    }
}

#[cfg(test)]
mod tests {
    use flexure_core::scalar::Interval;

    use super::{Number, Stronger};

    fn number(text: &str) -> Number {
        Number::decimal(text).unwrap_or_else(|reason| panic!("{reason}"))
    }

    #[test]
    fn equal_rationals_are_recognised_and_others_are_not() {
        for (a, b) in
            [("55", "5.5e1"), ("0.10", "1e-1"), ("0", "-0.0e7"), ("100", "1E+2"), ("-2.50", "-25e-1")]
        {
            assert!(number(a).is(&number(b)) && number(a).is_at_most(&number(b)), "{a} {b}");
        }
        for (a, b) in [("55", "-55"), ("0.1", "0.10000000000000000001"), ("1", "10"), ("0.01", "0.1")] {
            assert!(!number(a).is(&number(b)), "{a} {b}");
        }
        assert!(number("0.1").negated().is(&number("-0.1")) && number("0").negated().is(&number("0")));
        let pair = Number::between("1", "2").unwrap();
        assert!(!pair.is(&pair) && !pair.is_at_most(&pair));
        let point = Number::between("1", "1.0").unwrap();
        assert!(!point.is(&point) && point.is_at_most(&point));
    }

    /// Where floats see no difference.
    #[test]
    fn order_is_that_of_the_rationals() {
        let rising = [
            "-1e99",
            "-2",
            "-1.5",
            "-1e-320",
            "0",
            "1e-320",
            "0.1",
            "0.10000000000000000001",
            "0.2",
            "1",
            "1.5",
            "15",
            "2e1",
        ];
        for (i, a) in rising.iter().enumerate() {
            for (j, b) in rising.iter().enumerate() {
                assert_eq!(number(a).is_at_most(&number(b)), i <= j, "{a} {b}");
            }
            assert_eq!((number(a).is_positive(), number(a).is_nonnegative()), (i > 4, i >= 4), "{a}");
        }
        assert!(number("-1.5").is_within(&number("1.5")) && !number("-1.51").is_within(&number("1.5")));
        assert!(
            Number::between("0.10000000000000000001", "0.1").is_err() && Number::between("2", "1").is_err()
        );
    }

    /// The grammar of `docs/certificate.md`, at its edges.
    #[test]
    fn what_is_no_number_is_refused() {
        let (most, more) = (format!("0.{}", "1".repeat(98)), format!("0.{}", "1".repeat(99)));
        for text in ["0", "-0", "0.0", "1e003", "1E+99", "9.99e99", "1e-330", "0e999", "-0.0e-999", &most] {
            assert!(Number::decimal(text).is_ok(), "{text}");
        }
        for text in [
            "",
            "-",
            ".",
            "+1",
            ".5",
            "5.",
            "01",
            "-01",
            "00",
            "nan",
            "inf",
            "-Infinity",
            "0x1",
            "1_000",
            " 1",
            "1 ",
            "1,5",
            "e5",
            "--1",
            "1e",
            "1e+",
            "1e1.5",
            "1e0003",
            "1e00003",
            "0e9999",
            "1e99999999999999999999",
            "+-1",
            "1.2.3",
            "١",
            "1.7976931348623157e308",
            "1e100",
            "-1e100",
            "0.09e-329",
            "1ee1",
            "1e--1",
            "1e+-1",
            "-",
            "1e١",
            &more,
        ] {
            assert!(Number::decimal(text).is_err(), "{text}");
        }
    }

    #[test]
    fn claims_are_rounded_to_the_stronger_side() {
        let claimed = |text, stronger| number(text).held_to(stronger).claimed;
        let up = Stronger::Up(1);
        for (text, wanted) in
            [("3.01e-14", "4e-14"), ("9.5", "10"), ("3", "3"), ("-3.9", "-3"), ("0", "0"), ("0.0999", "0.1")]
        {
            assert_eq!(claimed(text, up), number(wanted).value, "{text}");
        }
        let down = Stronger::Down(3);
        for (text, wanted) in [("1.2349", "1.23"), ("-1.2341", "-1.24"), ("-9.999", "-10"), ("-0.5", "-0.5")]
        {
            assert_eq!(claimed(text, down), number(wanted).value, "{text}");
        }
        assert_eq!(number("1.5").value, Interval::point(1.5));
        let pair = Number::between("1.21", "1.29").unwrap().held_to(up).claimed;
        assert_eq!((pair.lo(), pair.hi()), (2.0, 2.0));
    }
}
