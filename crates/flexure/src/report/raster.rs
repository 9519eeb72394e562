//! SVG to PNG, with the fonts that this crate carries: the same pixels on a machine without fonts.

use std::fmt;
use std::sync::{Arc, OnceLock};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

/// Width of every picture, in px.
pub const WIDTH: u32 = 1600;

/// Why a picture could not be made.
#[derive(Debug)]
pub enum RasterError {
    /// The text is not an SVG that can be drawn.
    Svg(resvg::usvg::Error),
    /// The drawing has no area, or too much of it.
    Size {
        /// Width of the drawing, in px.
        width: f32,
        /// Height of the drawing, in px.
        height: f32,
    },
    /// The picture could not be written as PNG.
    Encode(String),
}

impl fmt::Display for RasterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Svg(error) => write!(f, "not a drawable SVG: {error}"),
            Self::Size { width, height } => write!(f, "a drawing of {width} by {height} px has no picture"),
            Self::Encode(error) => write!(f, "the picture could not be written as PNG: {error}"),
        }
    }
}

impl std::error::Error for RasterError {}

/// The drawing as a PNG file, [`WIDTH`] pixels wide.
///
/// # Errors
/// If `svg` is not a drawable SVG, or is more than ten times as high as wide.
pub fn png(svg: &str) -> Result<Vec<u8>, RasterError> {
    let tree = Tree::from_str(svg, options()).map_err(RasterError::Svg)?;
    let size = tree.size();
    let no_area = || RasterError::Size { width: size.width(), height: size.height() };
    let scale = WIDTH as f32 / size.width();
    let target = size.to_int_size().scale_to_width(WIDTH).filter(|target| target.height() <= 10 * WIDTH);
    let target = target.ok_or_else(no_area)?;
    let mut pixmap = Pixmap::new(target.width(), target.height()).ok_or_else(no_area)?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    pixmap.encode_png().map_err(|error| RasterError::Encode(error.to_string()))
}

/// Fonts are read once a process.
fn options() -> &'static Options<'static> {
    static OPTIONS: OnceLock<Options<'static>> = OnceLock::new();
    OPTIONS.get_or_init(|| {
        let mut fonts = fontdb::Database::new();
        fonts.load_font_source(fontdb::Source::Binary(Arc::new(dejavu::sans::regular())));
        fonts.load_font_source(fontdb::Source::Binary(Arc::new(dejavu::sans::bold())));
        fonts.set_sans_serif_family("DejaVu Sans");
        Options { fontdb: Arc::new(fonts), font_family: "DejaVu Sans".to_owned(), ..Options::default() }
    })
}
