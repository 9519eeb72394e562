//! Fewer points for drawing, with every peak kept.

/// At most two points a bucket: its smallest and its largest value, at their own instants and in their own order.
///
/// The signal is cut into at most `buckets` runs of equally many samples; a signal that is short enough already comes
/// back whole. The first and the last sample are always kept, so the curve spans its whole time.
///
/// # Panics
/// If `t` and `values` differ in length: a programming error of the caller.
pub fn decimate(t: &[f64], values: &[f64], buckets: usize) -> Vec<(f64, f64)> {
    assert_eq!(t.len(), values.len(), "a signal has one value per instant");
    let whole = || t.iter().copied().zip(values.iter().copied());
    let bucket_size = bucket_size(values.len(), buckets);
    if bucket_size <= 2 {
        return whole().collect();
    }
    let mut points = Vec::with_capacity(2 * buckets + 2);
    points.extend(whole().next());
    for (t, values) in t.chunks(bucket_size).zip(values.chunks(bucket_size)) {
        let (low, high) = extremes(values);
        for index in [low.min(high), low.max(high)] {
            points.push((t[index], values[index]));
        }
    }
    points.extend(whole().next_back());
    points.dedup();
    points
}

/// One point a bucket, its largest value at its own instant: the upper envelope of a signal that dips.
///
/// The signal is cut as by [`decimate`], and is whole if it is short enough.
///
/// # Panics
/// If `t` and `values` differ in length: a programming error of the caller.
pub fn envelope(t: &[f64], values: &[f64], buckets: usize) -> Vec<(f64, f64)> {
    assert_eq!(t.len(), values.len(), "a signal has one value per instant");
    let size = bucket_size(values.len(), buckets);
    let highest = |(t, values): (&[f64], &[f64])| {
        let (_, high) = extremes(values);
        (t[high], values[high])
    };
    t.chunks(size).zip(values.chunks(size)).map(highest).collect()
}

/// Samples in each bucket (the last one may hold fewer).
pub fn bucket_size(samples: usize, buckets: usize) -> usize {
    samples.div_ceil(buckets.max(1)).max(1)
}

/// Indices of the smallest and the largest value.
fn extremes(values: &[f64]) -> (usize, usize) {
    let mut low = 0;
    let mut high = 0;
    for (index, &value) in values.iter().enumerate() {
        if value < values[low] {
            low = index;
        }
        if value > values[high] {
            high = index;
        }
    }
    (low, high)
}
