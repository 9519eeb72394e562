//! Numbers of a proof: decimals, or reals known to lie between two floats.

use flexure_core::scalar::Interval;
use serde::Serialize;

/// A real number as a certificate writes it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum Number {
    /// The rational that the decimal says: "0.1" is 1/10.
    Decimal(String),
    /// Some real between the two decimals, ends included.
    Between([String; 2]),
}

impl Number {
    /// The decimal that the float `x` is printed as, with the fewest digits that restore it.
    pub fn decimal(x: f64) -> Self {
        let (plain, scientific) = (format!("{x}"), format!("{x:e}"));
        Self::Decimal(if plain.len() <= scientific.len() + 2 { plain } else { scientific })
    }

    /// A share of a pivot as it is claimed: in one digit, which is at most 3/2 of it.
    pub fn margin(share: f64) -> Self {
        Self::decimal(of_digits(share, 1))
    }

    /// A rate of `x` > 0 or slightly less, in thirteen digits.
    pub fn rate(x: f64) -> Self {
        Self::decimal(below(x, RATE_DIGITS))
    }

    /// A claim of nine digits below `x`, so far that whoever computes `x` anew finds more.
    pub fn below(x: f64) -> Self {
        Self::decimal(below(x - ROOM * x.abs(), DIGITS))
    }

    /// A claim of nine digits above `x`, so far that whoever computes `x` anew finds less.
    pub fn above(x: f64) -> Self {
        Self::decimal(-below(-x - ROOM * x.abs(), DIGITS))
    }

    /// A number of a file that was read as the float `x`: its shortest decimal where `bounds` are those of that decimal,
    /// which is then the file's; else the bounds.
    pub fn read(x: f64, bounds: Interval) -> Self {
        let decimal = Self::decimal(x);
        if decimal.bounds() == bounds { decimal } else { Self::between(bounds) }
    }

    /// A number that is computed from those of a file: a decimal only where it is known exactly.
    pub fn computed(bounds: Interval) -> Self {
        let decimal = Self::decimal(bounds.lo());
        if decimal.bounds() == Interval::point(bounds.lo()) && decimal.bounds() == bounds {
            decimal
        } else {
            Self::between(bounds)
        }
    }

    /// The bounds themselves, exactly: a float's shortest decimal may lie beside it, so both ends take one step out.
    pub fn between(bounds: Interval) -> Self {
        let text = |x: f64| match Self::decimal(x) {
            Self::Decimal(text) | Self::Between([text, _]) => text,
        };
        Self::Between([text(bounds.lo().next_down()), text(bounds.hi().next_up())])
    }

    /// An enclosure, rounded outwards; everything if a text is no number.
    pub fn bounds(&self) -> Interval {
        let read = |text: &str| Interval::from_decimal(text).unwrap_or(Interval::ENTIRE);
        match self {
            Self::Decimal(text) => read(text),
            Self::Between([low, high]) => read(low).hull(read(high)),
        }
    }

    /// A float nearby.
    pub fn approximate(&self) -> f64 {
        self.bounds().midpoint()
    }
}

/// Digits of claims that are as strong as they can be.
const DIGITS: usize = 9;

/// Digits of rates.
const RATE_DIGITS: usize = 13;

/// By how much claims of nine digits stay on the safe side at least, relatively: more than the rounding of whoever checks them.
const ROOM: f64 = 1e-12;

/// The float nearest to the nearest decimal of so many digits.
fn of_digits(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits - 1).parse().unwrap_or(x)
}

/// A float nearest to a decimal of so many digits that is at most `x`.
fn below(x: f64, digits: usize) -> f64 {
    let near = of_digits(x, digits);
    if near <= x {
        return near;
    }
    // A unit of the last of the digits less.
    let text = format!("{x:.*e}", digits - 1);
    let power = text.split_once('e').map_or("0", |(_, power)| power);
    let unit: f64 = format!("1e{power}").parse().unwrap_or(0.0);
    of_digits(x - unit * format!("1e-{}", digits - 1).parse().unwrap_or(0.0), digits)
}

#[cfg(test)]
mod tests {
    use super::{Interval, Number};

    /// 1/10 < the float 0.1: what is enclosed is the decimal.
    #[test]
    fn decimals_are_rationals() {
        let tenth = Number::decimal(0.1);
        assert_eq!(tenth, Number::Decimal("0.1".to_owned()));
        assert!(tenth.bounds().width() > 0.0 && tenth.bounds().contains(0.1));
        assert_eq!(Number::decimal(55.0).bounds(), Interval::point(55.0));
        assert_eq!(Number::decimal(1e-30), Number::Decimal("1e-30".to_owned()));
    }

    /// At most nine digits, on the right side, and not farther than two units of the ninth digit.
    #[test]
    fn claims_have_few_digits_and_lie_on_the_safe_side() {
        for x in [27.5, 0.1, 1.0 / 3.0, 1.0, 9.999_999_999, 3e-17, 6.02e23, 1e-9] {
            for x in [x, -x] {
                let (below, above) = (Number::below(x), Number::above(x));
                assert!(below.bounds().hi() < x && x < above.bounds().lo(), "{x}: {below:?} {above:?}");
                for number in [below, above] {
                    assert!((number.approximate() / x - 1.0).abs() < 2.1e-8, "{x}: {number:?}");
                    let Number::Decimal(text) = number else { panic!("{x}") };
                    let digits = text.split('e').next().unwrap_or_default().replace(['-', '.'], "");
                    assert!(digits.trim_start_matches('0').trim_end_matches('0').len() <= 9, "{text}");
                }
            }
        }
        assert_eq!((Number::below(0.0), Number::above(0.0)), (Number::decimal(0.0), Number::decimal(0.0)));
        for pivot in [1.0, 2.999, 3.0, 1.9, 19.0, 7e-15] {
            let margin = Number::margin(0.5 * pivot).approximate();
            assert!(margin > 0.25 * pivot && margin < 0.76 * pivot, "{pivot} {margin}");
        }
    }

    #[test]
    fn bounds_survive_being_written_down() {
        for x in [0.1, 1.0 / 3.0, -2e-7, 5.0] {
            let bounds = Interval::new(x - 1e-9, x + 1e-9).unwrap();
            assert!(Number::between(bounds).bounds().contains_interval(bounds));
            assert!(Number::computed(Interval::point(x)).bounds().contains(x));
        }
    }
}
