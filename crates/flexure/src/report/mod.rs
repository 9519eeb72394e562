//! Figures, tables and the HTML report of closed-loop runs.
//!
//! Nothing here reads a clock, a file or a font of the machine: the same runs give the same bytes everywhere.

mod axes;
mod certificates;
pub mod comparison;
mod curve;
pub mod decimate;
mod effort;
pub mod figure;
pub mod html;
mod leaderboard_page;
mod leaderboard_table;
mod margins_table;
mod markdown;
mod marker;
pub mod number;
mod panel;
mod png;
mod proof_table;
mod range;
pub mod raster;
mod scatter;
mod scene;
mod sheet;
mod style;
mod svg;
pub mod table;
mod text;
mod ticks;

pub use certificates::CertificateReport;
pub use comparison::comparison;
pub use effort::{chatter_figure, effort_figure};
pub use figure::{FigureOptions, four_panel};
pub use html::{Assumption, Report, RunReport, html};
pub use leaderboard_page::leaderboard_page;
pub use leaderboard_table::leaderboard_table;
pub use margins_table::margins_table;
pub use proof_table::{certificate_table, proof_table};
pub use raster::RasterError;
pub use scene::Scene;
pub use table::{joint_table, summary_table, usage_table};
