//! Where the rows of a run go as they are made.

use std::ops::ControlFlow;

/// What takes the rows of a run, one control instant after the other: a [`Trace`](super::Trace) that keeps them, a
/// [`TraceFile`](super::TraceFile) that writes them down, a [`Sketch`](crate::report::Sketch) that keeps what a figure shows.
///
/// ```
/// use std::ops::ControlFlow;
/// use flexure::simulate::{Sink, run_into};
///
/// /// The largest absolute value of a column, whatever the length of the run.
/// struct Largest { column: usize, value: f64 }
///
/// impl Sink for Largest {
///     fn take(&mut self, row: &[f64]) -> ControlFlow<()> {
///         self.value = self.value.max(row[self.column].abs());
///         ControlFlow::Continue(())
///     }
/// }
///
/// let scenario = flexure::Scenario::load("pendulum-tanh")?;
/// let column = scenario.signals()?.iter().position(|signal| signal.name == "u_m1").expect("every law has a torque");
/// let mut largest = Largest { column, value: 0.0 };
/// let run = run_into(&scenario, &mut [&mut largest], &flexure::progress::unwatched)?;
/// assert_eq!(largest.value, run.summary.max_abs_u_m);
/// # Ok::<(), flexure::Problems>(())
/// ```
pub trait Sink {
    /// Takes the row of an instant, a number per [signal](crate::scenario::Scenario::signals) of the scenario. What breaks off here
    /// ends the run, as far as it is, as what breaks off its progress does.
    fn take(&mut self, row: &[f64]) -> ControlFlow<()>;
}
