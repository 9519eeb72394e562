//! Figures, tables and the HTML report of closed-loop runs.
//!
//! Nothing here reads a clock, a file or a font of the machine: the same runs give the same bytes everywhere.

mod assumptions;
mod axes;
mod certificates;
mod columns;
pub mod comparison;
mod curve;
pub mod decimate;
mod design_table;
mod effort;
mod excitation_table;
pub mod figure;
pub mod html;
mod identified_table;
mod leaderboard_page;
mod leaderboard_table;
mod margins_table;
mod markdown;
mod marker;
mod outputs;
mod panel;
mod png;
mod proof_table;
mod range;
pub mod raster;
mod replay;
mod scatter;
mod scene;
mod sheet;
mod style;
mod svg;
mod sweep_table;
pub mod table;
mod text;
mod ticks;

pub use assumptions::assumptions;
pub use certificates::CertificateReport;
pub use columns::WIDTH;
pub use comparison::comparison;
pub use design_table::{constraints_table, gains_table, trades_table};
pub use effort::{chatter_figure, effort_figure};
pub use excitation_table::excitation_table;
pub use figure::{FigureOptions, four_panel};
pub use html::{AssumedNumber, RunReport, RunsReport, html};
pub use identified_table::identified_table;
pub use leaderboard_page::leaderboard_page;
pub use leaderboard_table::leaderboard_table;
pub use margins_table::margins_table;
pub use outputs::{write_certificate, write_figure, write_leaderboard};
pub use proof_table::{certificate_table, proof_table};
pub use raster::RasterError;
pub use replay::{replay_figure, replay_table, write_replay};
pub use scene::Scene;
pub use sweep_table::sweep_table;
pub use table::{joint_table, summary_table, usage_table};
