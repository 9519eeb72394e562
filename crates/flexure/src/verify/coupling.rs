//! The variational closed loop in words: what couples links and motors does no work.

use crate::verify::document::Certificate;
use crate::verify::verdict::{Claim, Rejected, ensure};
use crate::verify::words::Sum;

/// The closed loop, row by row.
const ROWS: [[&str; 4]; 4] = [
    ["-Fl", "0", "1", "0"],
    ["0", "-Fm", "-Pm^-1 K", "1"],
    ["-Pl", "K", "-S + 1/2 R - Bl", "0"],
    ["0", "-Pm", "0", "-Bm"],
];

/// What each block loses.
const DISSIPATION: [&str; 4] = ["Pl Fl", "Pm Fm", "Bl", "Bm"];

/// The metric in front of each row.
const METRIC: [Option<&str>; 4] = [Some("Pl"), Some("Pm"), None, None];

pub(super) fn check(certificate: &Certificate) -> Result<Vec<Claim>, Rejected> {
    let closed_loop = &certificate.closed_loop;
    for (i, (row, own)) in closed_loop.rows.iter().zip(ROWS).enumerate() {
        for (j, (word, own)) in row.iter().zip(own).enumerate() {
            same(&format!("closed_loop.rows[{i}][{j}]"), word, own)?;
        }
    }
    for (i, (word, own)) in closed_loop.dissipation.iter().zip(DISSIPATION).enumerate() {
        same(&format!("closed_loop.dissipation[{i}]"), word, own)?;
    }
    let rows: Vec<Vec<_>> =
        closed_loop.rows.iter().map(|row| row.iter().map(|word| sum(word)).collect()).collect();
    cancels(&rows)?;
    Ok(vec![Claim::new("closed_loop", "the coupling cancels: G + G' = -(X + X') block by block, in words")])
}

/// The file's word is the law's.
fn same(claim: &str, word: &str, own: &str) -> Result<(), Rejected> {
    ensure(word == own, claim, || format!("is '{}', the law's is '{own}'", super::json::clipped(word)))
}

/// Of words that are known to be sums.
fn sum(word: &str) -> Sum {
    Sum::parse(word).unwrap_or_default()
}

/// G = metric · rows − diag(0, 0, ½ R, 0): G + Gᵀ has no block off the diagonal and −(X + Xᵀ) on it.
fn cancels(rows: &[Vec<Sum>]) -> Result<(), Rejected> {
    let work = |i: usize, j: usize| {
        let block = rows[i][j].after(METRIC[i]);
        if (i, j) == (2, 2) { block.plus(&sum("-1/2 R")) } else { block }
    };
    for (i, loss) in DISSIPATION.into_iter().enumerate() {
        for j in 0..=i {
            let mut rest = work(i, j).plus(&work(j, i).transposed());
            if i == j {
                let loss = sum(loss);
                rest = rest.plus(&loss).plus(&loss.transposed());
            }
            ensure(rest.is_zero(), "closed_loop", || format!("block ({i}, {j}) of G + G' leaves {rest:?}"))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{ROWS, cancels, sum};

    #[test]
    fn the_expansion_itself_notices_every_change_of_a_word() {
        let rows = || ROWS.map(|row| row.map(sum).to_vec()).to_vec();
        assert_eq!(cancels(&rows()), Ok(()));
        for i in 0..4 {
            for j in 0..4 {
                let mut other = rows();
                other[i][j] = other[i][j].negated();
                assert_eq!(cancels(&other).is_ok(), rows()[i][j].is_zero(), "-({i}, {j})");
                other[i][j] = rows()[i][j].plus(&sum("Fl K"));
                assert!(cancels(&other).is_err(), "({i}, {j})");
            }
        }
    }
}
