//! Where the rate is weakest, by looking: the same points every time.

use flexure_core::scalar::Interval;

use crate::prove::engine::direct::flow::{Coordinate, Flow};
use crate::prove::engine::direct::split;
use crate::prove::engine::direct::witness::Sample;

/// Corners, and as many points inside.
const POINTS: usize = 256;

/// The weakest of samples over the region: its middle, corners, points inside, then downhill from the weakest of those.
/// `None` where the metric is none at any of them. Once it no longer `goes_on`, it is the weakest of those so far.
pub(crate) fn weakest(flow: &dyn Flow, goes_on: &dyn Fn() -> bool) -> Option<Sample> {
    let coordinates = flow.coordinates();
    let root: Vec<Interval> = coordinates.iter().map(|c| c.range).collect();
    let relevant = split::relevant(flow, &root);
    let at = |place: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let mut point: Vec<f64> = coordinates.iter().map(|c| c.range.midpoint()).collect();
        for (k, &i) in relevant.iter().enumerate() {
            point[i] = place_in(&coordinates[i], place(k));
        }
        point
    };
    let corner_bits = relevant.len();
    let all = 1_usize.checked_shl(u32::try_from(corner_bits).unwrap_or(u32::MAX)).filter(|&n| n <= POINTS);
    let corner = |n: usize, k: usize| match all {
        Some(_) => ((n >> k) & 1) as f64,
        None => radical_inverse(n + 1, prime(k)).round(),
    };
    let middle = std::iter::once(at(&|_| 0.5));
    let corners = (0..all.unwrap_or(POINTS)).map(|n| at(&|k| corner(n, k)));
    // Middles of faces, too: places 0, ½ and 1 mixed.
    let mixed = (0..POINTS).map(|n| at(&|k| (2.999 * radical_inverse(n + 1, prime(k))).floor() / 2.0));
    let inside = (0..POINTS).map(|n| at(&|k| radical_inverse(n + 1, prime(k))));
    let points = middle.chain(corners).chain(mixed).chain(inside);
    let samples = points.take_while(|_| goes_on()).filter_map(|point| Sample::new(flow, point));
    let weakest = samples.min_by(|a, b| a.rate.total_cmp(&b.rate))?;
    Some(downhill(flow, &relevant, weakest, goes_on))
}

/// Compass search from `best`: one coordinate at a time, steps that halve.
fn downhill(flow: &dyn Flow, relevant: &[usize], mut best: Sample, goes_on: &dyn Fn() -> bool) -> Sample {
    let coordinates = flow.coordinates();
    let mut step = 0.25;
    for _ in 0..24 {
        for &i in relevant {
            let range = coordinates[i].range;
            let width = if range.width().is_finite() { range.width() } else { best.at[i].abs().max(1.0) };
            for sign in [-1.0, 1.0] {
                if !goes_on() {
                    return best;
                }
                let mut at = best.at.clone();
                at[i] = (at[i] + sign * step * width).clamp(range.lo(), range.hi());
                if let Some(sample) = Sample::new(flow, at).filter(|sample| sample.rate < best.rate) {
                    best = sample;
                }
            }
        }
        step *= 0.5;
    }
    best
}

/// The point at the place `part` in [0, 1] of a range; unbounded ranges are looked at as far as 16 beyond their end or 0.
fn place_in(coordinate: &Coordinate, part: f64) -> f64 {
    const REACH: f64 = 16.0;
    let range = coordinate.range;
    let (lo, hi) = match (range.lo().is_finite(), range.hi().is_finite()) {
        (true, true) => (range.lo(), range.hi()),
        (true, false) => (range.lo(), range.lo() + REACH),
        (false, true) => (range.hi() - REACH, range.hi()),
        (false, false) => (-REACH, REACH),
    };
    // Both ends exactly: corners are states of the region.
    ((1.0 - part) * lo + part * hi).clamp(lo, hi)
}

/// The digits of `n` in base `base`, mirrored at the point: Halton's sequence.
fn radical_inverse(mut n: usize, base: usize) -> f64 {
    let (mut value, mut digit) = (0.0, 1.0 / base as f64);
    while n > 0 {
        value += (n % base) as f64 * digit;
        n /= base;
        digit /= base as f64;
    }
    value
}

/// Prime number `k`, from 2.
fn prime(k: usize) -> usize {
    let is_prime = |n: &usize| (2..*n).take_while(|d| d * d <= *n).all(|d| !n.is_multiple_of(d));
    (2..).filter(is_prime).nth(k).unwrap_or(2)
}
