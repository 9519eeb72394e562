//! Fewer points for drawing, with every peak kept: of signals that are there, and of signals that come.

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
pub(crate) fn extremes(values: &[f64]) -> (usize, usize) {
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

/// A signal that comes sample by sample and takes no more than so much memory: every sample as long as they are few, then
/// as [`decimate`] has them, the smallest and the largest of so many samples, at their own instants and in their own order, and the
/// first and the last one. It ends before the first sample that is not a number.
#[derive(Clone, Debug)]
pub struct Thinned {
    most: usize,
    points: Vec<(f64, f64)>,
    /// Samples that two points stand for; 1 while each stands for itself.
    size: usize,
    /// The samples after those that the points stand for.
    open: Option<Bucket>,
    ends: Option<[(f64, f64); 2]>,
    samples: usize,
    is_over: bool,
}

/// Some samples one after the other.
#[derive(Clone, Copy, Debug)]
struct Bucket {
    count: usize,
    low: (f64, f64),
    high: (f64, f64),
}

impl Thinned {
    /// Of nothing yet; it will have `most` points and four at most, a multiple of four from eight on.
    pub fn new(most: usize) -> Self {
        let most = (most / 4).max(2) * 4;
        Self { most, points: Vec::new(), size: 1, open: None, ends: None, samples: 0, is_over: false }
    }

    /// Takes a sample.
    pub fn push(&mut self, t: f64, value: f64) {
        self.is_over |= !(t.is_finite() && value.is_finite());
        if self.is_over {
            return;
        }
        let sample = (t, value);
        self.samples += 1;
        self.ends = Some([self.ends.map_or(sample, |[first, _]| first), sample]);
        if self.size == 1 && self.points.len() < self.most {
            self.points.push(sample);
            return;
        }
        if self.size == 1 {
            self.halve();
        }
        let bucket = match self.open {
            Some(bucket) => bucket.with(sample),
            None => Bucket { count: 1, low: sample, high: sample },
        };
        self.open = Some(bucket);
        if bucket.count == self.size && self.points.len() == self.most {
            // What was a whole bucket is half of one now.
            self.halve();
        } else if bucket.count == self.size {
            self.points.extend(bucket.points());
            self.open = None;
        }
    }

    /// Two points where four were.
    fn halve(&mut self) {
        self.size = if self.size == 1 { 4 } else { 2 * self.size };
        for k in 0..self.points.len() / 4 {
            let values: [f64; 4] = std::array::from_fn(|i| self.points[4 * k + i].1);
            let (low, high) = extremes(&values);
            let kept = [low.min(high), low.max(high)].map(|i| self.points[4 * k + i]);
            self.points[2 * k..2 * k + 2].copy_from_slice(&kept);
        }
        self.points.truncate(self.points.len() / 2);
    }

    /// What is left of the signal.
    pub fn points(&self) -> Vec<(f64, f64)> {
        if self.size == 1 {
            return self.points.clone();
        }
        let [first, last] = self.ends.map(|[first, last]| [Some(first), Some(last)]).unwrap_or_default();
        let rest = self.open.map(Bucket::points).into_iter().flatten();
        let mut points = Vec::with_capacity(self.points.len() + 4);
        points.extend(first.into_iter().chain(self.points.iter().copied()).chain(rest).chain(last));
        points.dedup();
        points
    }

    /// How many samples were left their extremes; none while all of them are there.
    pub fn bucket(&self) -> Option<usize> {
        (self.size > 1).then_some(self.size)
    }

    /// How many samples it had.
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// When the last one was; none of nothing.
    pub fn end(&self) -> Option<f64> {
        self.ends.map(|[_, (t, _)]| t)
    }
}

impl Bucket {
    /// With a later sample.
    fn with(self, sample: (f64, f64)) -> Self {
        let Self { count, low, high } = self;
        Self {
            count: count + 1,
            low: if sample.1 < low.1 { sample } else { low },
            high: if sample.1 > high.1 { sample } else { high },
        }
    }

    /// Its smallest and its largest sample in their order.
    fn points(self) -> [(f64, f64); 2] {
        if self.low.0 <= self.high.0 { [self.low, self.high] } else { [self.high, self.low] }
    }
}
