//! Tuned gains as text for the terminal.

use comfy_table::Cell;

use super::columns::laid_out;
use super::summary::{headed, right};
use crate::design::{Constraint, Design, Effect, Trade};
use crate::files::number::{NONE, engineering, short, significant};

/// The gains, a row a joint (`joints` are their names), in so many columns.
pub fn gains_table(joints: &[String], design: &Design, width: usize) -> String {
    let titles: Vec<String> = design.gains.iter().map(|trade| trade.gain.replace('.', "\n")).collect();
    let mut table = headed(std::iter::once("joint").chain(titles.iter().map(String::as_str)));
    for (i, joint) in joints.iter().enumerate() {
        let values = design.gains.iter().map(|trade| right(engineering(trade.values[i])));
        table.add_row(std::iter::once(Cell::new(joint)).chain(values).collect::<Vec<_>>());
    }
    laid_out(&table, 1, width)
}

/// What each gain trades: by which factor figures change with a quarter more of it in all joints, in so many columns.
pub fn trades_table(trades: &[Trade], width: usize) -> String {
    let titles = ["a quarter more of", "rms\n|e_l|", "max\n|u_m|", "torque\nchange", "decay as\nsampled"];
    let mut table = headed(titles.into_iter());
    for trade in trades {
        let factor =
            |x: f64| if x.is_finite() { format!("×{}", significant(x, 3)) } else { NONE.to_owned() };
        let numbers = match trade.effect {
            Some(Effect { error, torque, chatter, decay }) => {
                [Some(error), Some(torque), Some(chatter), decay].map(|x| x.map_or(NONE.to_owned(), factor))
            }
            None => ["unstable", NONE, NONE, NONE].map(str::to_owned),
        };
        let numbers = numbers.map(right);
        table.add_row(std::iter::once(Cell::new(&trade.gain)).chain(numbers).collect::<Vec<_>>());
    }
    laid_out(&table, 1, width)
}

/// What the gains are held to, with what is left of each limit, in so many columns; below it a line for each of which there is more to
/// say.
pub fn constraints_table(constraints: &[Constraint], width: usize) -> String {
    let mut table = headed(["constraint", "joint", "value", "limit", "left\n[%]"].into_iter());
    for constraint in constraints {
        let Constraint { what, joint, value, limit, unit, slack, asked, .. } = constraint;
        let amount = |x: f64| right(format!("{} {unit}", short(x, 4)).trim_end().to_owned());
        let joint = joint.as_deref().unwrap_or(NONE);
        let left = match (*slack < 0.0, *asked) {
            (true, true) => "broken".to_owned(),
            (true, false) => "not borne".to_owned(),
            (false, _) => significant(100.0 * slack, 3),
        };
        table.add_row(vec![Cell::new(what), Cell::new(joint), amount(*value), amount(*limit), right(left)]);
    }
    let noted =
        constraints.iter().filter_map(|constraint| Some((&constraint.what, constraint.note.as_ref()?)));
    let notes = noted.map(|(what, note)| format!("{what}: {note}"));
    std::iter::once(laid_out(&table, 2, width)).chain(notes).collect::<Vec<_>>().join("\n")
}
