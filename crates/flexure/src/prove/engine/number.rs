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

    #[test]
    fn bounds_survive_being_written_down() {
        for x in [0.1, 1.0 / 3.0, -2e-7, 5.0] {
            let bounds = Interval::new(x - 1e-9, x + 1e-9).unwrap();
            assert!(Number::between(bounds).bounds().contains_interval(bounds));
            assert!(Number::computed(Interval::point(x)).bounds().contains(x));
        }
    }
}
