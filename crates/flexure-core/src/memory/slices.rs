//! Saving to slices and restoring from them.

use core::fmt;

use super::{Memory, Port};
use crate::scalar::Scalar;

/// How many numbers are remembered where there are `joints` real joints.
pub fn length<S>(of: &mut dyn Memory<S>, joints: usize) -> usize {
    let mut length = 0;
    of.memory(&mut Each { joints, visit: |_: Piece<'_, S>| length += 1 });
    length
}

/// Saves to `to`, in the order of the walk; of vectors over joints the first `joints` entries.
///
/// # Errors
///
/// If `to` has not the right [`length`]; nothing was written then.
pub fn save<S: Copy + Into<f64>>(
    from: &mut dyn Memory<S>,
    joints: usize,
    to: &mut [f64],
) -> Result<(), Unfit> {
    fits(from, joints, to.len())?;
    let mut slots = to.iter_mut();
    from.memory(&mut Each {
        joints,
        visit: |piece: Piece<'_, S>| {
            if let Some(slot) = slots.next() {
                *slot = match piece {
                    Piece::Number(x) => (*x).into(),
                    Piece::Word(x) => f64::from(*x),
                    Piece::Flag(x) => f64::from(u8::from(*x)),
                };
            }
        },
    });
    Ok(())
}

/// Restores what was [saved](save) of something made alike.
///
/// # Errors
///
/// If `from` has not the right [`length`], or a number in it stands for an integer or a flag and is none; nothing was
/// restored then.
pub fn restore<S: Scalar>(to: &mut dyn Memory<S>, joints: usize, from: &[f64]) -> Result<(), Unfit> {
    fits(to, joints, from.len())?;
    let (mut slots, mut wrong) = (from.iter().copied().enumerate(), None);
    to.memory(&mut Each {
        joints,
        visit: |piece: Piece<'_, S>| {
            let Some((at, x)) = slots.next() else { return };
            let sound = match piece {
                Piece::Number(_) => true,
                Piece::Word(_) => word(x).is_some(),
                Piece::Flag(_) => word(x).is_some_and(|x| x < 2),
            };
            if !sound {
                wrong = wrong.or(Some(Unfit::Entry { at, value: x }));
            }
        },
    });
    if let Some(wrong) = wrong {
        return Err(wrong);
    }
    let mut slots = from.iter().copied();
    to.memory(&mut Each {
        joints,
        visit: |piece: Piece<'_, S>| {
            let Some(x) = slots.next() else { return };
            match piece {
                Piece::Number(slot) => *slot = S::from_f64(x),
                Piece::Word(slot) => *slot = word(x).unwrap_or(*slot),
                Piece::Flag(slot) => *slot = x > 0.0,
            }
        },
    });
    Ok(())
}

/// Numbers that cannot be restored, or a slice that they do not fit into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unfit {
    /// The slice holds `has` numbers where `needs` are remembered.
    Length {
        /// Length of the slice.
        has: usize,
        /// Numbers that are remembered.
        needs: usize,
    },
    /// Number `at`, from 0, is `value` where there should be a whole number of at most 2³² − 1, or 0 or 1 for a flag.
    Entry {
        /// Place in the slice.
        at: usize,
        /// What is there.
        value: f64,
    },
}

impl fmt::Display for Unfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { has, needs } => {
                write!(f, "{has} numbers where {needs} are remembered: was this saved of another loop?")
            }
            Self::Entry { at, value } => {
                write!(
                    f,
                    "number {at} is {value} where a count or a flag is remembered: was this saved of another loop?"
                )
            }
        }
    }
}

impl core::error::Error for Unfit {}

fn fits<S>(of: &mut dyn Memory<S>, joints: usize, has: usize) -> Result<(), Unfit> {
    let needs = length(of, joints);
    if has == needs { Ok(()) } else { Err(Unfit::Length { has, needs }) }
}

/// The integer that `x` is.
fn word(x: f64) -> Option<u32> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the next line compares")]
    let word = x as u32;
    #[expect(clippy::float_cmp, reason = "integers")]
    (f64::from(word) == x).then_some(word)
}

/// What takes one place in a slice.
enum Piece<'a, S> {
    Number(&'a mut S),
    Word(&'a mut u32),
    Flag(&'a mut bool),
}

/// Visits every piece of the first `joints` joints.
struct Each<F> {
    joints: usize,
    visit: F,
}

impl<S, F: FnMut(Piece<'_, S>)> Port<S> for Each<F> {
    fn numbers(&mut self, _: &'static str, _: &'static str, x: &mut [S]) {
        for x in x {
            (self.visit)(Piece::Number(x));
        }
    }

    fn joints(&mut self, _: &'static str, _: &'static str, x: &mut [S]) {
        for x in x.iter_mut().take(self.joints) {
            (self.visit)(Piece::Number(x));
        }
    }

    fn word(&mut self, _: &'static str, x: &mut u32) {
        (self.visit)(Piece::Word(x));
    }

    fn flag(&mut self, _: &'static str, x: &mut bool) {
        (self.visit)(Piece::Flag(x));
    }
}
