//! The section of the report on loops that converge practically.

use maud::{Markup, html as markup};

use super::kit::numbers;
use crate::report::tables::practical::{practical, sentences};
use crate::report::ultimate::Practical;

/// The table of ultimate bounds, with what it means.
pub(crate) fn section(runs: &[Practical]) -> Markup {
    markup! {
        div.prose {
            p {
                "With positions from encoders and velocities by a filter, errors come down to a bound instead of to zero: the loop converges "
                strong { "practically" } ". A filter is late, so that the law goes by velocities of a moment ago; that error comes back with the "
                "reference. Encoder steps are noise, which the filter's difference makes larger. The proofs of rates are of the ideal loop and say "
                "nothing of these bounds."
            }
            @for sentence in sentences(runs) { p { (sentence) } }
        }
        (numbers(&practical(runs)))
    }
}
