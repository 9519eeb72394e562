//! Robots, laws and references over intervals enclose what the decimals of the files say.

mod files;
mod references;
mod robots;

use flexure::core::scalar::Interval;

/// Asserts that `x`, computed in floats with an error of at most `rounding`, is in `bounds`, narrower than `width`.
fn encloses(bounds: Interval, x: f64, rounding: f64, width: f64, what: &str) {
    let inside = bounds.lo() - rounding <= x && x <= bounds.hi() + rounding;
    assert!(inside, "{what}: {x} outside {bounds:?}");
    assert!(bounds.width() <= width, "{what}: {bounds:?} is {:e} wide, more than {width:e}", bounds.width());
}
