//! Where the numbers along an axis stand, and how they are written.

use super::range::{Range, decade_step, round_step};
use crate::files::number::{power_of_ten, short};

/// A number along an axis.
pub(crate) struct Tick {
    /// In the units of the axis.
    pub at: f64,
    pub name: String,
}

/// At most `most` steps of 1, 2 or 5 times a power of ten.
pub(crate) fn even(axis: Range, most: f64) -> Vec<Tick> {
    even_by(axis, most, 0)
}

/// The same, numbers written in units of ten to the `power`, which the label of the axis says.
pub(crate) fn even_by(axis: Range, most: f64, power: i32) -> Vec<Tick> {
    let unit = 10f64.powi(power);
    every(axis, round_step(axis, most)).map(|at| Tick { at, name: even_name(at / unit) }).collect()
}

/// The same of at most about `most`, but of three at least: one number says nothing of the scale.
pub(crate) fn several(axis: Range, most: u8, power: i32) -> Vec<Tick> {
    let by = |most| even_by(axis, f64::from(most), power);
    (most..12).map(by).find(|ticks| ticks.len() > 2).unwrap_or_else(|| by(most))
}

/// The power of ten, in steps of three, in which the numbers of an axis are short; 0 for most.
#[expect(clippy::cast_possible_truncation, reason = "an exponent of ten of an f64: within ±308")]
pub(crate) fn power(axis: Range) -> i32 {
    let largest = axis.low.abs().max(axis.high.abs());
    if (1e-3..1e5).contains(&largest) || !largest.is_finite() || largest == 0.0 {
        return 0;
    }
    3 * (largest.log10() / 3.0).floor() as i32
}

/// For an axis that carries exponents of ten: whole decades, at most eight.
#[expect(clippy::cast_possible_truncation, reason = "an exponent of ten of an f64: within ±308")]
pub(crate) fn decades(axis: Range) -> Vec<Tick> {
    every(axis, decade_step(axis)).map(|at| Tick { at, name: power_of_ten(at.round() as i32) }).collect()
}

/// For an axis that carries exponents of ten, at most about `most`: powers of ten on long axes, 1, 2 and 5 times them on
/// shorter ones, even steps where the axis is so short that it is hardly bent.
pub(crate) fn logarithmic(axis: Range, most: f64) -> Vec<Tick> {
    let ends = Range { low: 10f64.powf(axis.low), high: 10f64.powf(axis.high) };
    let tick = |value: f64| Tick { at: value.log10(), name: name(value) };
    if axis.span() < 0.6 {
        return every(ends, round_step(ends, most)).map(tick).collect();
    }
    let multiples: &[f64] = if axis.span() < 2.2 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let step = (axis.span() / most).ceil().max(1.0);
    steps(axis.low.floor(), axis.high.floor())
        .filter(|decade| multiples.len() > 1 || (decade / step).fract() == 0.0)
        .flat_map(|decade| multiples.iter().map(move |m| m * 10f64.powf(decade)))
        .filter(|value| ends.contains(*value))
        .map(tick)
        .collect()
}

/// The multiples of `step` on an axis; what is past an end by a rounding is on it.
fn every(axis: Range, step: f64) -> impl Iterator<Item = f64> {
    let (first, last) = ((axis.low / step - 1e-9).ceil(), (axis.high / step + 1e-9).floor());
    steps(first, last).map(move |k| k * step)
}

/// Whole numbers, both ends included.
fn steps(first: f64, last: f64) -> impl Iterator<Item = f64> {
    // More than a frame has room for: where the axis is finer than its numbers.
    const MOST: u8 = 100;
    (0..MOST).map(move |k| first + f64::from(k)).take_while(move |k| *k <= last)
}

/// A step apart, names differ in fewer than six digits; 0 comes out of the stepping as a rounding error.
fn even_name(value: f64) -> String {
    if value.abs() < 1e-12 { "0".to_owned() } else { short(value, 6) }
}

/// A round number, as short as it gets.
#[expect(clippy::cast_possible_truncation, reason = "an exponent of ten of an f64: within ±308")]
fn name(value: f64) -> String {
    // A product of a power of ten is off by a rounding.
    let exponent = (value.log10() + 1e-9).floor();
    if (-3.0..5.0).contains(&exponent) {
        return short(value, 4);
    }
    match short(value / 10f64.powf(exponent), 4).as_str() {
        "1" => power_of_ten(exponent as i32),
        mantissa => format!("{mantissa}×{}", power_of_ten(exponent as i32)),
    }
}

#[cfg(test)]
mod tests {
    use super::{Range, decades, even, even_by, logarithmic, name, power};

    /// At least two numbers on any axis, at most nine, all inside.
    #[test]
    fn every_axis_has_labels() {
        for k in 1..60 {
            let span = 0.13 * f64::from(k);
            for low in [-7.3, -0.04, 0.0, 2.71] {
                let axis = Range { low, high: low + span };
                for ticks in [logarithmic(axis, 5.0), even(axis, 5.0)] {
                    let values: Vec<f64> = ticks.into_iter().map(|tick| tick.at).collect();
                    assert!((2..=9).contains(&values.len()), "{axis:?}: {values:?}");
                    let inside = |at: f64| axis.low - 1e-8 <= at && at <= axis.high + 1e-8;
                    assert!(values.iter().all(|&at| inside(at)), "{axis:?}: {values:?}");
                }
            }
        }
    }

    #[test]
    fn labels_are_short() {
        let names = [0.0001, 2e-7, 0.001, 0.2, 1.0, 50.0, 5e5, 2.25].map(name);
        assert_eq!(names, ["10⁻⁴", "2×10⁻⁷", "0.001", "0.2", "1", "50", "5×10⁵", "2.25"]);
        let names = |ticks: Vec<super::Tick>| ticks.into_iter().map(|tick| tick.name).collect::<Vec<_>>();
        assert_eq!(names(even(Range { low: -0.25, high: 0.61 }, 6.0)), ["−0.2", "0", "0.2", "0.4", "0.6"]);
        assert_eq!(names(decades(Range { low: -2.0, high: 1.25 })), ["10⁻²", "10⁻¹", "1", "10"]);
    }

    /// A diverged run has torques of 10⁸ N m, a smooth one errors of 10⁻⁷ rad: neither fits beside a frame.
    #[test]
    fn numbers_far_from_one_are_in_powers_of_a_thousand() {
        let names = |high: f64| {
            let axis = Range { low: -0.1 * high, high };
            let ticks = even_by(axis, 6.0, power(axis));
            (power(axis), ticks.into_iter().map(|tick| tick.name).collect::<Vec<_>>().join(" "))
        };
        assert_eq!(names(1.1e8), (6, "0 50 100".to_owned()));
        assert_eq!(names(4.1e-7), (-9, "0 100 200 300 400".to_owned()));
        assert_eq!(names(2.2), (0, "0 0.5 1 1.5 2".to_owned()));
        assert_eq!(power(Range { low: -2e5, high: 1.0 }), 3);
    }

    /// Where neighbouring floats are further apart than the step: no end of numbers.
    #[test]
    fn an_axis_finer_than_its_numbers_ends() {
        let axis = Range { low: 1e17, high: 1e17 + 16.0 };
        assert!(even(axis, 6.0).len() <= 100);
    }
}
