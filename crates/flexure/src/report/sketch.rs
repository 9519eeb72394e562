//! What figures show of a run, whatever its length.

use std::ops::ControlFlow;

use crate::report::draw::curve::Curve;
use crate::report::draw::decimate::Thinned;
use crate::report::draw::range::Range;
use crate::report::draw::style::Stroke;
use crate::simulate::{Signal, Sink, Trace, of_joints};

/// The signals that are drawn: one number per joint each.
const DRAWN: [&str; 8] = ["q_l", "q_m", "q_ld", "e_l", "e_m", "sigma_l", "sigma_m", "u_m"];

/// The points of all signals together are about so many, 16 bytes each.
const POINTS: usize = 1 << 20;

/// The points of a signal: those of 16 s at 1 kHz at least, and a minute at most.
const LEAST: usize = 1 << 14;
const MOST: usize = 1 << 16;

/// Stops that are remembered: more could not be told apart.
const MOST_STOPS: usize = 1000;

/// The signals of a run that are drawn, in memory that does not grow with its duration: a run of up to 2¹⁴ instants and more as it is, a
/// longer one with the smallest and the largest value of every so many instants, and when those were.
///
/// ```
/// use flexure::report::{FigureOptions, Sketch, four_panel};
///
/// let scenario = flexure::Scenario::load("pendulum-tanh")?;
/// let mut sketch = Sketch::new(&scenario.signals()?);
/// flexure::simulate::run_into(&scenario, &mut [&mut sketch], &flexure::progress::unwatched)?;
/// assert!(four_panel(&sketch, &FigureOptions::default()).svg().starts_with("<svg"));
/// # Ok::<(), flexure::Problems>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sketch {
    /// The column of the time.
    time: Option<usize>,
    /// The time from the first to the last instant.
    span: Option<Range>,
    instants: usize,
    /// Columns of [`DRAWN`] and what they hold, joint by joint.
    drawn: [Vec<(usize, Thinned)>; DRAWN.len()],
    /// The largest |e_l| over the joints.
    error: Thinned,
    /// The column that says whether the guard has stopped the robot.
    stopped: Option<usize>,
    /// When it had.
    stops: Vec<Range>,
    is_stopped: bool,
}

impl Sketch {
    /// Of nothing yet, for runs that have these signals.
    pub fn new(signals: &[Signal]) -> Self {
        let columns = DRAWN.map(|prefix| of_joints(signals, prefix));
        let count: usize = columns.iter().map(Vec::len).sum();
        let thinned = Thinned::new((POINTS / (count + 1)).clamp(LEAST, MOST));
        let with =
            |columns: Vec<usize>| columns.into_iter().map(|column| (column, thinned.clone())).collect();
        let time = signals.iter().position(|signal| signal.name == "t");
        let stopped = signals.iter().position(|signal| signal.name == "stopped");
        Self {
            time,
            span: None,
            instants: 0,
            drawn: columns.map(with),
            error: thinned.clone(),
            stopped,
            stops: Vec::new(),
            is_stopped: false,
        }
    }

    /// Of a recorded run.
    pub fn of(trace: &Trace) -> Self {
        let mut sketch = Self::new(&trace.signals());
        trace.pour(&mut sketch);
        sketch
    }

    /// The curves of the signal called `prefix`, joint by joint, each with the stroke that `stroke` has for a joint of so many.
    pub(super) fn curves(&self, prefix: &str, stroke: impl Fn(usize, usize) -> Stroke) -> Vec<Curve> {
        let signals = self.signals(prefix);
        let curve =
            |(joint, (_, signal)): (usize, &(usize, Thinned))| of(signal, stroke(joint, signals.len()));
        signals.iter().enumerate().map(curve).collect()
    }

    /// When the guard had stopped the robot.
    pub(super) fn stops(&self) -> impl Iterator<Item = Range> {
        self.stops.iter().copied()
    }

    /// How many joints the signal called `prefix` has.
    pub(super) fn joints(&self, prefix: &str) -> usize {
        self.signals(prefix).len()
    }

    /// The curve of the largest |e_l| over the joints.
    pub(super) fn largest_error(&self, stroke: Stroke) -> Curve {
        of(&self.error, stroke)
    }

    /// The largest absolute value of the signal called `prefix` from a time on, joint by joint.
    pub(super) fn largest(&self, prefix: &str, from: f64) -> Vec<f64> {
        let of_joint = |(_, signal): &(usize, Thinned)| {
            let late = signal.points().into_iter().filter(|(t, _)| *t >= from);
            late.fold(0.0, |largest: f64, (_, value)| largest.max(value.abs()))
        };
        self.signals(prefix).iter().map(of_joint).collect()
    }

    /// Its time axis.
    pub(super) fn span(&self) -> Range {
        self.span.filter(|span| span.low < span.high).unwrap_or(Range { low: 0.0, high: 1.0 })
    }

    /// The last instant of the signal that ends first, if one ends before the run does.
    pub(super) fn diverged(&self) -> Option<f64> {
        let shortest =
            self.drawn.iter().flatten().map(|(_, signal)| signal).min_by_key(|signal| signal.samples())?;
        (shortest.samples() < self.instants).then(|| shortest.end().unwrap_or(0.0))
    }

    /// The time of which the signals have the extremes alone, if they do not have all instants \[s\].
    pub(super) fn thinned(&self) -> Option<f64> {
        let bucket = self.drawn.iter().flatten().find_map(|(_, signal)| signal.bucket())?;
        Some(bucket as f64 * self.span().span() / (self.instants.max(2) - 1) as f64)
    }

    fn signals(&self, prefix: &str) -> &[(usize, Thinned)] {
        DRAWN.iter().zip(&self.drawn).find(|(drawn, _)| **drawn == prefix).map_or(&[], |(_, signals)| signals)
    }
}

fn of(signal: &Thinned, stroke: Stroke) -> Curve {
    let (t, values) = signal.points().into_iter().unzip();
    Curve { t, values, stroke }
}

impl Sink for Sketch {
    fn take(&mut self, row: &[f64]) -> ControlFlow<()> {
        let t = self.time.map_or(f64::NAN, |column| row[column]);
        if t.is_finite() {
            let span = self.span.unwrap_or(Range { low: t, high: t });
            self.span = Some(Range { low: span.low.min(t), high: span.high.max(t) });
        }
        let is_stopped = self.stopped.is_some_and(|column| row[column] > 0.5);
        if is_stopped && !self.is_stopped && self.stops.len() < MOST_STOPS {
            self.stops.push(Range { low: t, high: t });
        } else if let Some(stop) = self.stops.last_mut().filter(|_| is_stopped) {
            stop.high = t;
        }
        self.is_stopped = is_stopped;
        self.instants += 1;
        for (column, signal) in self.drawn.iter_mut().flatten() {
            signal.push(t, row[*column]);
        }
        let [.., e_l, _, _, _, _] = &self.drawn;
        let errors = e_l.iter().map(|(column, _)| row[*column].abs());
        // Not a number from where a joint has none.
        self.error.push(t, errors.fold(0.0, |a, b| if b.is_nan() || b > a { b } else { a }));
        ControlFlow::Continue(())
    }
}
