//! Clocks backwards.

use flexure_core::reference::Clock;
use flexure_core::scalar::Interval;

/// Halvings that locate an instant: as many as a float has digits.
const HALVINGS: usize = 60;

/// Encloses the time in s at which `clock` shows `s`; where it never does, `s` < 0, some time before 0.
pub fn when(clock: &Clock<Interval>, s: Interval) -> Interval {
    let (speed, rise) = match *clock {
        Clock::Steady { speed } => return s / speed,
        Clock::FromRest { speed, rise } => (speed, rise),
    };
    let last = s / speed + rise;
    if s.hi() < 0.0 || !last.hi().is_finite() {
        return s.hull(last);
    }
    // The clock does not go backwards: too early stays too early.
    let before = |t: f64| clock.on(Interval::point(t)).hi() < s.lo();
    let after = |t: f64| clock.on(Interval::point(t)).lo() > s.hi();
    let (lo, _) = bisect(0.0, last.hi(), before);
    let (_, hi) = bisect(0.0, last.hi(), |t| !after(t));
    Interval::new(lo, hi).unwrap_or(Interval::ENTIRE)
}

/// Neighbours in [from, to], `holds` at the first unless that is `from`, and not at the second unless that is `to`.
fn bisect(mut from: f64, mut to: f64, holds: impl Fn(f64) -> bool) -> (f64, f64) {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (from + to);
        if holds(middle) {
            from = middle;
        } else {
            to = middle;
        }
    }
    (from, to)
}

#[cfg(test)]
mod tests {
    use flexure_core::reference::Clock;
    use flexure_core::scalar::Interval;

    use super::when;

    #[test]
    fn clocks_are_inverted() {
        let [speed, rise] = [0.3, 2.0].map(Interval::point);
        for clock in [Clock::Steady { speed }, Clock::FromRest { speed, rise }] {
            for t in [0.5, 1.0, 1.9, 2.0, 7.0] {
                let s = clock.on(Interval::point(t));
                let found = when(&clock, s);
                // Slow at first: an ulp of s is a lot of t.
                assert!(found.contains(t) && found.width() < 1e-11, "{clock:?} at {t} s: {found:?}");
            }
            assert!(when(&clock, Interval::point(-0.5)).lo() < 0.0, "never");
        }
    }
}
