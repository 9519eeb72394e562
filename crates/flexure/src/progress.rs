//! Long jobs tell how far they are, and can be broken off.

use std::ops::ControlFlow;

use crate::files::Problems;

/// What is told the fraction of a job that is done, and breaks it off by [`ControlFlow::Break`].
pub type Progress<'a> = &'a (dyn Fn(f64) -> ControlFlow<()> + Sync);

/// The same for a job of several parts side by side: the number of the part, and the fraction of it that is done.
pub type PartProgress<'a> = &'a (dyn Fn(usize, f64) -> ControlFlow<()> + Sync);

/// Progress that nobody watches: never breaks a job off.
pub fn unwatched(_: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Tells `progress` the fraction done.
///
/// # Errors
/// [`Problems::interrupted`] if it breaks the job off.
pub(crate) fn tell(progress: Progress<'_>, fraction: f64) -> Result<(), Problems> {
    if progress(fraction).is_break() { Err(Problems::interrupted()) } else { Ok(()) }
}
