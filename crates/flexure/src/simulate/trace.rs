//! Traces: what a run recorded, column by column.

use std::ops::ControlFlow;

use crate::simulate::interface::Signal;
use crate::simulate::sink::Sink;

/// One recorded signal.
#[derive(Clone, Debug)]
pub struct Column {
    /// Name, valid as a pandas column and as a MATLAB variable: `t`, `q_l1`, `e_l2`, `u_m1`, `hamiltonian`, …
    pub name: String,
    /// SI unit as plain text (`rad`, `N m`, `kg m^2/s`, `J`), empty for none.
    pub unit: &'static str,
    /// One value per recorded instant.
    pub values: Vec<f64>,
}

/// Columns of equal length.
///
/// ```
/// use flexure::simulate::Trace;
/// let mut trace = Trace::new([("t", "s"), ("q_l1", "rad"), ("q_l2", "rad")].map(|(name, unit)| (name.to_owned(), unit)));
/// trace.push(&[0.0, 0.1, 0.2]);
/// trace.push(&[0.001, 0.3, 0.4]);
/// assert_eq!(trace.column("q_l1"), Some(&[0.1, 0.3][..]));
/// assert_eq!(trace.joints("q_l"), [[0.1, 0.3], [0.2, 0.4]]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Trace {
    columns: Vec<Column>,
}

impl Trace {
    /// An empty trace with the given `(name, unit)` columns.
    pub fn new(columns: impl IntoIterator<Item = (String, &'static str)>) -> Self {
        let column = |(name, unit)| Column { name, unit, values: Vec::new() };
        Self { columns: columns.into_iter().map(column).collect() }
    }

    /// Appends one instant: a value per column, in the order of [`columns`](Self::columns).
    ///
    /// # Panics
    /// If `row` does not have one value per column: a programming error of the recorder.
    pub fn push(&mut self, row: &[f64]) {
        assert_eq!(row.len(), self.columns.len(), "a trace row has one value per column");
        for (column, &value) in self.columns.iter_mut().zip(row) {
            column.values.push(value);
        }
    }

    /// All columns, in the order they were declared.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// All columns, given away.
    pub fn into_columns(self) -> Vec<Column> {
        self.columns
    }

    /// The column called `name`.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.columns.iter().find(|column| column.name == name).map(|column| column.values.as_slice())
    }

    /// The columns `prefix1`, `prefix2`, … of a vector signal, one per joint.
    pub fn joints(&self, prefix: &str) -> Vec<&[f64]> {
        (1..).map_while(|joint| self.column(&format!("{prefix}{joint}"))).collect()
    }

    /// Name and unit of each column.
    pub fn signals(&self) -> Vec<Signal> {
        let signal = |column: &Column| Signal { name: column.name.clone(), unit: column.unit };
        self.columns.iter().map(signal).collect()
    }

    /// Gives its rows to `sink`, from the first on until that breaks off: what a run into it would have done.
    pub fn pour(&self, sink: &mut dyn Sink) {
        let mut row = vec![0.0; self.columns.len()];
        for k in 0..self.len() {
            for (slot, column) in row.iter_mut().zip(&self.columns) {
                *slot = column.values[k];
            }
            if sink.take(&row).is_break() {
                return;
            }
        }
    }

    /// Number of recorded instants.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }

    /// Whether nothing was recorded.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl Sink for Trace {
    fn take(&mut self, row: &[f64]) -> ControlFlow<()> {
        self.push(row);
        ControlFlow::Continue(())
    }
}

/// A trace with these columns and no row.
impl From<&[Signal]> for Trace {
    fn from(signals: &[Signal]) -> Self {
        Self::new(signals.iter().map(|signal| (signal.name.clone(), signal.unit)))
    }
}
