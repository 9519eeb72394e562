//! Decimals as intervals: "0.1" is a rational, not a float.

use super::Interval;

impl Interval {
    /// Encloses the number written in decimal (`-1.5e-3`); `None` if it is not one.
    ///
    /// An integer, or a decimal that is a float (`0.5`), is a point. Others are at most two steps wide.
    pub fn from_decimal(text: &str) -> Option<Self> {
        if let Some(exact) = short(text) {
            return Some(exact);
        }
        // The parser accepts "inf" and "nan": decimals hold no other letter than e.
        let decimal = text.bytes().all(|b| matches!(b, b'0'..=b'9' | b'.' | b'e' | b'E' | b'+' | b'-'));
        let nearest: f64 = text.parse().ok().filter(|_| decimal)?;
        // core's parser rounds correctly: one step each way encloses; a sign survives underflow.
        Some(Self { lo: nearest.next_down(), hi: nearest.next_up() })
    }
}

/// `digits · 10ᵏ` where both parts are exact floats: one division or multiplication of points. `None` if not so short.
fn short(text: &str) -> Option<Interval> {
    let (number, exponent) = match text.split_once(['e', 'E']) {
        Some((number, exponent)) => (number, exponent.parse().ok()?),
        None => (text, 0_i32),
    };
    let negative = number.starts_with('-');
    let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
    let whole = whole.strip_prefix(['-', '+']).unwrap_or(whole);
    if whole.is_empty() && fraction.is_empty() {
        return None;
    }
    let mut digits = 0_u64;
    for byte in whole.bytes().chain(fraction.bytes()) {
        let digit = byte.checked_sub(b'0').filter(|&d| d < 10)?;
        digits = digits.checked_mul(10)?.checked_add(u64::from(digit))?;
    }
    // Integers to 2⁵³ and powers of ten to 10²² are floats.
    let digits = Interval::point((digits <= 1 << 53).then_some(digits as f64)?);
    let power = exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?;
    let mut ten = 1.0;
    for _ in 0..Some(power.unsigned_abs()).filter(|&p| p <= 22)? {
        ten *= 10.0;
    }
    let ten = Interval::point(ten);
    let value = if power < 0 { digits / ten } else { digits * ten };
    Some(if negative { -value } else { value })
}
