//! Figures, tables and the HTML report of closed-loop runs.
//!
//! Nothing here reads a clock, a file or a font of the machine: the same runs give the same bytes everywhere.

mod assumptions;
mod draw;
mod figures;
mod outputs;
mod pages;
mod replay;
mod sketch;
mod tables;
mod ultimate;
mod view;

pub use assumptions::assumptions;
pub use draw::decimate;
pub(crate) use draw::marks::pushes;
pub use draw::marks::{Happening, JointMarks, What};
pub use draw::raster::{self, RasterError};
pub use draw::scene::Scene;
pub use figures::comparison::comparison;
pub use figures::cost::cost_figure;
pub use figures::joint_panels::joint_panels;
pub use figures::response::response_figure;
pub use figures::run::{FigureOptions, four_panel, run_figure};
pub use figures::score_map::score_map;
pub use outputs::{
    page_names, stem, view_name, write_certificate, write_certified, write_document, write_figure,
    write_identified, write_leaderboard, write_margins, write_ran, write_swept, write_tuned, write_view,
};
pub use pages::certificates::CertificateReport;
pub use pages::certify::proof_verdict;
pub use pages::kit::Verdict;
pub use pages::leaderboard::leaderboard_page;
pub use pages::run::RunTold;
pub use pages::runs::{AssumedNumber, RunReport, RunsReport, html};
pub use replay::{replay_figure, replay_table, write_replay};
pub use sketch::Sketch;
pub use tables::columns::WIDTH;
pub use tables::design::{constraints_table, gains_table, trades_table};
pub use tables::excitation::excitation_table;
pub use tables::funnel::{funnel_asked, funnel_lines};
pub use tables::identified::identified_table;
pub use tables::leaderboard::leaderboard_table;
pub use tables::margins::margins_table;
pub use tables::practical::practical_table;
pub use tables::proof::{certificate_table, proof_table};
pub use tables::summary::{joint_table, summary_table, usage_table};
pub use tables::sweep::sweep_table;
pub use tables::tube::tube_lines;
pub use ultimate::{Practical, Ultimate};
pub use view::{Film, Viewed, view};
