//! Decimals are rationals: what a float that was read from a file says about the number that was written.
//!
//! A float is printed as the shortest decimal that is read back as that float. A decimal of at most 15 digits is the only
//! one of so few that is read as its float, so it *is* what the float prints as, and the float is all that need be kept.
//! Of a file with longer decimals (π to twenty digits) it is known that each number was rounded to the nearest float.

use flexure_core::scalar::Interval;

/// What the numbers of a file were read from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Decimals {
    /// All from the decimals that their floats print as.
    #[default]
    Shortest,
    /// Some from others, which round to the same floats.
    Longer,
}

impl Decimals {
    /// What `text`, a decimal that was read as `x`, is.
    pub fn of(text: &str, x: f64) -> Self {
        // So do most numbers, and printing them takes its time.
        if x.is_normal() && digits(text) <= 15 {
            return Self::Shortest;
        }
        let shortest = format!("{:e}", x.abs());
        let same = match (parts(text), parts(&shortest)) {
            (Some(text), Some(shortest)) => text == shortest,
            _ => false,
        };
        // What is smaller than any float is written for zero, and means it.
        if same || x == 0.0 { Self::Shortest } else { Self::Longer }
    }

    /// What is known of the numbers of two files.
    pub fn and(self, other: Self) -> Self {
        if self == Self::Shortest { other } else { self }
    }

    /// Encloses the number that was read as `x`. Infinity, which no file holds, is itself.
    pub fn enclose(self, x: f64) -> Interval {
        let enclosed = match self {
            _ if x == 0.0 || x.is_infinite() => None,
            Self::Shortest => Interval::from_decimal(&format!("{x:e}")),
            Self::Longer => Interval::new(x.next_down(), x.next_up()),
        };
        enclosed.unwrap_or(Interval::point(x))
    }
}

/// Number of digits of a decimal before its exponent.
fn digits(text: &str) -> usize {
    text.bytes().take_while(|byte| !matches!(byte, b'e' | b'E')).filter(u8::is_ascii_digit).count()
}

/// Significant digits of a decimal and the power of ten of the last one, without its sign.
fn parts(text: &str) -> Option<(String, i64)> {
    let (number, exponent) = match text.split_once(['e', 'E']) {
        Some((number, exponent)) => (number, exponent.parse().ok()?),
        None => (text, 0_i64),
    };
    let number = number.strip_prefix(['-', '+']).unwrap_or(number);
    let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
    let digits = format!("{whole}{fraction}");
    let significant = digits.trim_end_matches('0');
    let zeros = i64::try_from(digits.len() - significant.len()).ok()?;
    let power = exponent.checked_sub(i64::try_from(fraction.len()).ok()?)?.checked_add(zeros)?;
    Some((significant.trim_start_matches('0').to_owned(), power))
}

#[cfg(test)]
mod tests {
    use super::{Decimals, Interval};

    /// The number that `text` stands for is in the enclosure of the float that it is read as.
    fn read(text: &str) -> (Decimals, Interval) {
        let x: f64 = text.parse().expect("a number");
        let decimals = Decimals::of(text, x);
        (decimals, decimals.enclose(x))
    }

    /// digits / 10^places against x, in integers: x = mantissa / 2^shift.
    fn against(digits: u128, places: u32, x: f64) -> std::cmp::Ordering {
        let bits = x.to_bits();
        let (mantissa, exponent) = ((bits & ((1 << 52) - 1)) | (1 << 52), bits >> 52);
        let shift = |to_the_left: u64, to_the_right: u64| to_the_left.saturating_sub(to_the_right);
        (digits << shift(1075, exponent))
            .cmp(&((u128::from(mantissa) * 10_u128.pow(places)) << shift(exponent, 1075)))
    }

    #[test]
    fn a_tenth_is_enclosed_by_neighbours() {
        let (decimals, tenth) = read("0.1");
        assert_eq!(decimals, Decimals::Shortest);
        // The float nearest to 1/10 is above it.
        assert_eq!((tenth.lo(), tenth.hi()), (0.1_f64.next_down(), 0.1));
        assert!(against(1, 1, tenth.lo()).is_gt() && against(1, 1, tenth.hi()).is_lt());
        let (_, three_tenths) = read("0.3");
        let ends = (three_tenths.lo(), three_tenths.hi());
        assert_eq!(ends, (0.3, 0.3_f64.next_up()), "and that of 3/10 below");
    }

    #[test]
    fn what_is_a_float_is_a_point() {
        for text in
            ["55.0", "55", "+55", "5.5e1", "0055.000", "550e-1", "0.5", "-0.25", "0", "-0.0", "0e9", "1e22"]
        {
            let (decimals, bounds) = read(text);
            assert_eq!((decimals, bounds.width()), (Decimals::Shortest, 0.0), "{text}: {bounds:?}");
        }
    }

    /// Up to 15 digits, and as many as a float prints.
    #[test]
    fn short_decimals_are_what_their_floats_print_as() {
        for text in [
            "0.123456789012345",
            "1.5707963267948966",
            "-9.81",
            "2.4e-7",
            "0.30000000000000004",
            "123456789012345e9",
        ] {
            let (decimals, bounds) = read(text);
            assert_eq!(decimals, Decimals::Shortest, "{text}");
            assert!(bounds.contains_interval(Interval::from_decimal(text).expect("a decimal")), "{text}");
        }
    }

    /// Decimals between floats, on both sides of the one that they are read as.
    #[test]
    fn long_decimals_are_within_a_step() {
        for (text, digits, places) in [
            ("0.10000000000000000001", 10_000_000_000_000_000_001, 20),
            ("0.10000000000000001249", 10_000_000_000_000_001_249, 20),
            ("0.09999999999999999999", 9_999_999_999_999_999_999, 20),
            ("3.1415926535897932384", 31_415_926_535_897_932_384, 19),
            ("9007199254740993", 9_007_199_254_740_993, 0),
        ] {
            let (decimals, bounds) = read(text);
            assert_eq!(decimals, Decimals::Longer, "{text}");
            let (lower, upper) = (against(digits, places, bounds.lo()), against(digits, places, bounds.hi()));
            assert!(lower.is_ge() && upper.is_le(), "{text}: {bounds:?}");
        }
    }

    /// A file with one such number loses a step on all others; zero stays zero.
    #[test]
    fn one_long_decimal_widens_the_others() {
        let file = Decimals::Shortest.and(Decimals::Longer).and(Decimals::Shortest);
        let bounds = file.enclose(55.0);
        assert_eq!((bounds.lo(), bounds.hi()), (55.0_f64.next_down(), 55.0_f64.next_up()));
        assert_eq!(file.enclose(0.0), Interval::point(0.0));
        assert_eq!(file.enclose(f64::INFINITY), Interval::point(f64::INFINITY));
    }
}
