//! Numbers as people read them.

/// Shown where there is no number.
pub const NONE: &str = "—";

/// Three significant digits, powers of ten in steps of three: `0.0123`, `5790`, `123×10⁻⁹`.
pub fn engineering(value: f64) -> String {
    significant(value, 3)
}

/// `value` to `digits` significant digits; outside 10⁻³ … 10⁵ with a power of ten in steps of three.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return "not finite".to_owned();
    }
    // Printed once in scientific form: the exponent is that of the rounded value (9.996 is 10.0 to three digits).
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-3..5).contains(&exponent) {
        return shift(mantissa, exponent);
    }
    let power = exponent.div_euclid(3) * 3;
    format!("{}×10{}", shift(mantissa, exponent - power), superscript(power))
}

/// A power of ten as an axis label: `10⁻⁶`, `1`, `10`.
pub fn power_of_ten(exponent: i32) -> String {
    match exponent {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        _ => format!("10{}", superscript(exponent)),
    }
}

/// An integer in raised digits.
pub fn superscript(value: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raise = |c: char| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]);
    value.to_string().chars().map(raise).collect()
}

/// As few digits as tell the value, at most `digits`: `20`, not `20.0`.
pub fn short(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    let (digits, power) = text.split_at(text.find('×').unwrap_or(text.len()));
    let digits =
        if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits };
    format!("{digits}{power}")
}

/// A small number in thousandths, or millionths where it is below a tenth of that, and the prefix that says which.
pub fn small(value: f64) -> (String, &'static str) {
    if value.abs() < 1e-4 { (engineering(1e6 * value), "µ") } else { (engineering(1e3 * value), "m") }
}

/// The largest number of `digits` significant digits, or nearly, that is not above `value`.
pub fn rounded_down(value: f64, digits: usize) -> f64 {
    let rounded = |x: f64| format!("{x:.*e}", digits.saturating_sub(1)).parse().unwrap_or(x);
    let nearest = rounded(value);
    if nearest <= value || !value.is_finite() {
        return nearest;
    }
    let step = |x: f64| 10f64.powf(x.abs().log10().floor() + 1.0) / 10f64.powf(digits as f64);
    rounded(value - step(value))
}

/// The smallest that is not below `value`.
pub fn rounded_up(value: f64, digits: usize) -> f64 {
    -rounded_down(-value, digits)
}

/// Seconds in the unit that reads best: `3 ms`, `1.25 s`.
pub fn duration(seconds: f64) -> String {
    if seconds != 0.0 && seconds.abs() < 0.1 {
        format!("{} ms", short(seconds * 1e3, 3))
    } else {
        format!("{} s", short(seconds, 3))
    }
}

/// Moves the decimal point of a printed mantissa (`d.ddd`) by `places`, filling with zeros.
fn shift(mantissa: &str, places: i32) -> String {
    let (sign, mantissa) = mantissa.strip_prefix('-').map_or(("", mantissa), |rest| ("−", rest));
    let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    let point = 1 + places;
    let Ok(point) = usize::try_from(point) else {
        return format!("{sign}0.{}{digits}", "0".repeat(point.unsigned_abs() as usize));
    };
    match point {
        0 => format!("{sign}0.{digits}"),
        point if point >= digits.len() => format!("{sign}{digits}{}", "0".repeat(point - digits.len())),
        point => format!("{sign}{}.{}", &digits[..point], &digits[point..]),
    }
}

#[cfg(test)]
mod tests {
    use super::{duration, engineering, power_of_ten, rounded_down, rounded_up, significant, small};

    #[test]
    fn three_digits_and_powers_in_steps_of_three() {
        let cases = [
            (0.0, "0"),
            (1.0, "1.00"),
            (-1.0, "−1.00"),
            (9.996, "10.0"),
            (5787.3, "5790"),
            (99999.0, "100×10³"),
            (0.0123456, "0.0123"),
            (0.00123456, "0.00123"),
            (1.234e-4, "123×10⁻⁶"),
            (1.234e-7, "123×10⁻⁹"),
            (9.9999e-10, "1.00×10⁻⁹"),
            (3.0e12, "3.00×10¹²"),
            (f64::NAN, "not finite"),
        ];
        for (value, text) in cases {
            assert_eq!(engineering(value), text, "{value}");
        }
        assert_eq!(significant(5787.3, 4), "5787");
    }

    #[test]
    fn printed_numbers_read_back() {
        for exponent in -20..20 {
            for mantissa in [1.0, 1.25, 2.5, 4.99, 9.99] {
                let value = mantissa * 10f64.powi(exponent);
                let text = engineering(value);
                let (digits, power) = text.split_once("×10").unwrap_or((&text, ""));
                let power: String = power
                    .chars()
                    .map(|c| {
                        "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|d| d == c).map_or("-".to_owned(), |d| d.to_string())
                    })
                    .collect();
                let back: f64 =
                    format!("{digits}e{}", if power.is_empty() { "0" } else { &power }).parse().unwrap();
                assert!((back / value - 1.0).abs() < 6e-3, "{value:e} printed as {text}"); // half of the third digit
            }
        }
    }

    #[test]
    fn what_is_rounded_down_is_never_above() {
        let cases = [
            (39.46, 39.4),
            (39.4, 39.4),
            (39.44, 39.4),
            (9.999, 9.99),
            (10.0, 10.0),
            (0.012_39, 0.0123),
            (11_970.0, 11_900.0),
        ];
        for (value, below) in cases {
            assert_eq!(rounded_down(value, 3).to_string(), f64::to_string(&below), "{value}");
        }
        for k in 0..20_000 {
            let value = 1e-3 * 1.0007_f64.powi(k);
            let below = rounded_down(value, 3);
            assert!(below <= value && below > 0.989 * value, "{value}: {below}");
        }
    }

    #[test]
    fn durations_and_decades() {
        assert_eq!(duration(0.003), "3 ms");
        assert_eq!(duration(1.25), "1.25 s");
        assert_eq!(
            [power_of_ten(-6), power_of_ten(0), power_of_ten(1), power_of_ten(3)],
            ["10⁻⁶", "1", "10", "10³"]
        );
    }

    #[test]
    fn small_numbers_are_in_the_unit_that_is_short() {
        let words = [0.0206, 1e-4, 5.12e-6, 9.39e-7, 0.0].map(|value| {
            let (number, prefix) = small(value);
            format!("{number} {prefix}rad")
        });
        assert_eq!(words, ["20.6 mrad", "0.100 mrad", "5.12 µrad", "0.939 µrad", "0 µrad"]);
    }

    #[test]
    fn rounding_goes_the_way_it_says() {
        for x in [0.008_534_26, 1.0, 9.996, 0.2, 123_456.0, 9.99e-7, 0.0, -20.998_71, -9.996] {
            let (down, up) = (rounded_down(x, 3), rounded_up(x, 3));
            assert!(down <= x && x <= up && up - down <= 0.011 * x.abs(), "{x}: {down} {up}");
        }
        assert_eq!(significant(rounded_up(0.008_534_26, 3), 3), "0.00854");
        assert_eq!(significant(rounded_up(9.996, 3), 3), "10.0");
        assert_eq!(significant(rounded_down(9.996, 3), 3), "9.99");
        assert_eq!(significant(rounded_up(-20.998_71, 6), 6), "−20.9987");
        assert!(rounded_up(f64::INFINITY, 3).is_infinite() && rounded_down(f64::NAN, 3).is_nan());
    }
}
