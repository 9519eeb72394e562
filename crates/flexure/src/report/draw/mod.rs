//! What pictures are made of: scenes, axes, curves, letters, and how they become SVG and PNG.

pub(crate) mod axes;
pub(crate) mod chatter;
pub(crate) mod curve;
pub mod decimate;
pub(crate) mod falling;
pub(crate) mod marker;
pub(crate) mod marks;
pub(crate) mod panel;
pub(crate) mod path;
pub(crate) mod png;
pub(crate) mod range;
pub mod raster;
pub(crate) mod scatter;
pub(crate) mod scene;
pub(crate) mod sheet;
pub(crate) mod style;
pub(crate) mod svg;
pub(crate) mod text;
pub(crate) mod ticks;
pub(crate) mod tracks;
