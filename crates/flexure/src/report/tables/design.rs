//! Tuned gains as tables.

use super::grid::Grid;
use crate::design::{Constraint, Design, Effect, Trade};
use crate::files::number::{NONE, engineering, short, significant};

/// The gains, a row a joint (`joints` are their names), in so many columns.
pub fn gains_table(joints: &[String], design: &Design, width: usize) -> String {
    gains(joints, design).text(width)
}

/// What each gain trades: by which factor figures change with a quarter more of it in all joints, in so many columns.
pub fn trades_table(list: &[Trade], width: usize) -> String {
    trades(list).text(width)
}

/// What the gains are held to, with what is left of each limit, in so many columns; below it a line for each of which there is more to
/// say.
pub fn constraints_table(list: &[Constraint], width: usize) -> String {
    let noted = list.iter().filter_map(|constraint| Some((&constraint.what, constraint.note.as_ref()?)));
    let notes = noted.map(|(what, note)| format!("{what}: {note}"));
    std::iter::once(constraints(list).text(width)).chain(notes).collect::<Vec<_>>().join("\n")
}

pub(crate) fn gains(joints: &[String], design: &Design) -> Grid {
    let headings = design.gains.iter().map(|trade| trade.gain.replace('.', "\n"));
    let row = |(i, joint): (usize, &String)| {
        let values =
            design.gains.iter().map(|trade| trade.values.get(i).map_or(NONE.to_owned(), |&x| engineering(x)));
        std::iter::once(joint.clone()).chain(values).collect()
    };
    Grid {
        headings: std::iter::once("joint".to_owned()).chain(headings).collect(),
        words: 1,
        rows: joints.iter().enumerate().map(row).collect(),
    }
}

pub(crate) fn trades(list: &[Trade]) -> Grid {
    let factor = |x: f64| if x.is_finite() { format!("×{}", significant(x, 3)) } else { NONE.to_owned() };
    let row = |trade: &Trade| {
        let numbers = match trade.effect {
            Some(Effect { error, torque, chatter, decay }) => {
                [Some(error), Some(torque), Some(chatter), decay].map(|x| x.map_or(NONE.to_owned(), factor))
            }
            None => ["unstable", NONE, NONE, NONE].map(str::to_owned),
        };
        std::iter::once(trade.gain.clone()).chain(numbers).collect()
    };
    let headings = ["a quarter more of", "rms\n|e_l|", "max\n|u_m|", "torque\nchange", "decay as\nsampled"];
    Grid::new(&headings, list.iter().map(row).collect())
}

pub(crate) fn constraints(list: &[Constraint]) -> Grid {
    let row = |constraint: &Constraint| {
        let Constraint { what, joint, value, limit, unit, slack, asked, .. } = constraint;
        let amount = |x: f64| format!("{} {unit}", short(x, 4)).trim_end().to_owned();
        let left = match (*slack < 0.0, *asked) {
            (true, true) => "broken".to_owned(),
            (true, false) => "not borne".to_owned(),
            // Of nothing there is no part.
            (false, _) if *limit == 0.0 => NONE.to_owned(),
            (false, _) => significant(100.0 * slack, 3),
        };
        vec![what.clone(), joint.clone().unwrap_or(NONE.to_owned()), amount(*value), amount(*limit), left]
    };
    let headings = ["constraint", "joint", "value", "limit", "left\n[%]"];
    Grid { words: 2, ..Grid::new(&headings, list.iter().map(row).collect()) }
}
