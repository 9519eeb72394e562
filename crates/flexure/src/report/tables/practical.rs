//! How far loops with imperfections converge, as a table and in sentences.

use super::grid::Grid;
use crate::files::number::{engineering, short};
use crate::report::Ultimate;
use crate::report::ultimate::Practical;

/// The ultimate bounds of several runs and what each imperfection makes of them alone, in so many columns; then what that means, a line a
/// sentence.
pub fn practical_table(runs: &[Practical], width: usize) -> String {
    let table = practical(runs).text(width);
    std::iter::once(table).chain(sentences(runs)).collect::<Vec<_>>().join("\n")
}

/// A row for all imperfections of a run, and one for each of them alone.
pub(crate) fn practical(runs: &[Practical]) -> Grid {
    let joints = runs.first().map_or(&[][..], |run| &run.joints);
    let of = |side: &'static str| joints.iter().map(move |joint| format!("|{side}|\n{joint}\n[mrad]"));
    let headings =
        ["practical", "imperfections"].map(str::to_owned).into_iter().chain(of("e_l")).chain(of("e_m"));
    let row = |run: &Practical, with: String, Ultimate { links, motors, .. }: &Ultimate| {
        let errors = links.iter().chain(motors).map(|error| engineering(1e3 * error));
        [run.name.clone(), with].into_iter().chain(errors).collect::<Vec<_>>()
    };
    let rows = runs.iter().flat_map(|run| {
        let alone = run.alone.iter().map(|(kind, ultimate)| row(run, format!("{kind} alone"), ultimate));
        std::iter::once(row(run, "all".to_owned(), &run.ultimate)).chain(alone)
    });
    Grid { headings: headings.collect(), words: 2, rows: rows.collect() }
}

/// When errors count from, how large an encoder step is, and how the errors of the second run compare with those of the first, whose law is the
/// paper's first: the paper has considerably smaller ones under the second.
pub(crate) fn sentences(runs: &[Practical]) -> Vec<String> {
    let mut sentences = Vec::new();
    if let Some(run) = runs.first() {
        let steps = list(&run.steps.iter().map(|step| 1e3 * step).collect::<Vec<_>>());
        let steps = if steps.is_empty() { steps } else { format!("; an encoder step is {steps} mrad") };
        let from = short(run.ultimate.from, 4);
        sentences.push(format!("Largest errors from {from} s on, measured and not proved{steps}."));
    }
    if let [first, second] = runs {
        let ratios = |of: fn(&Ultimate) -> &Vec<f64>| -> Vec<f64> {
            let pairs = of(&second.ultimate).iter().zip(of(&first.ultimate));
            pairs.map(|(second, first)| second / first).collect()
        };
        let positions = [ratios(|it| &it.links), ratios(|it| &it.motors)];
        let momenta = [ratios(|it| &it.link_momenta), ratios(|it| &it.motor_momenta)];
        for (what, [links, motors]) in [("positions", &positions), ("momenta", &momenta)] {
            let (links, motors) = (list(links), list(motors));
            sentences.push(format!(
                "Errors of {what}, {} over {}: links {links}; motors {motors}.",
                second.phi, first.phi
            ));
        }
        let [positions, momenta] = [&positions, &momenta].map(compared);
        sentences
            .push(format!("The paper has both smaller; here positions: {positions}; momenta: {momenta}."));
    }
    sentences
}

/// Whether errors are smaller, from their ratios in links and motors.
fn compared([links, motors]: &[Vec<f64>; 2]) -> &'static str {
    let smaller = |ratios: &[f64]| ratios.iter().all(|ratio| *ratio < 1.0);
    if smaller(links) && smaller(motors) {
        "smaller"
    } else if links.iter().all(|ratio| *ratio > 1.0) {
        "larger in all links"
    } else {
        "smaller in some joints"
    }
}

/// Numbers joint by joint; once if all are the same.
fn list(numbers: &[f64]) -> String {
    let mut words: Vec<String> = numbers.iter().map(|number| short(*number, 3)).collect();
    if words.windows(2).all(|pair| pair[0] == pair[1]) {
        words.truncate(1);
    }
    words.join(" and ")
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::{practical_table, sentences};
    use crate::report::Ultimate;
    use crate::report::ultimate::Practical;

    /// Errors of links and motors alike: `positions` in rad, `momenta` in kg m²/s.
    fn run(phi: &str, positions: [f64; 2], momenta: f64) -> Practical {
        let positions = positions.to_vec();
        let ultimate = Ultimate {
            from: 3.7,
            motors: positions.clone(),
            links: positions,
            link_momenta: vec![momenta; 2],
            motor_momenta: vec![momenta; 2],
        };
        Practical {
            name: format!("two-link-{phi}"),
            phi: phi.to_owned(),
            joints: vec!["joint1".to_owned(), "joint2".to_owned()],
            steps: vec![5e-4; 2],
            alone: BTreeMap::from([("encoder", ultimate.clone())]),
            ultimate,
        }
    }

    #[test]
    fn what_is_said_follows_from_the_numbers() {
        let first = run("tanh", [1e-3, 2e-3], 0.4);
        let said = |positions, momenta| sentences(&[first.clone(), run("coupled-tanh", positions, momenta)]);
        let larger = said([2e-3, 3e-3], 0.2);
        assert_eq!(
            larger[0],
            "Largest errors from 3.7 s on, measured and not proved; an encoder step is 0.5 mrad."
        );
        assert_eq!(
            larger[1],
            "Errors of positions, coupled-tanh over tanh: links 2 and 1.5; motors 2 and 1.5."
        );
        assert_eq!(larger[2], "Errors of momenta, coupled-tanh over tanh: links 0.5; motors 0.5.");
        assert!(larger[3].ends_with("positions: larger in all links; momenta: smaller."), "{}", larger[3]);
        let mixed = said([2e-3, 1e-3], 0.8);
        assert!(
            mixed[3].ends_with("positions: smaller in some joints; momenta: larger in all links."),
            "{}",
            mixed[3]
        );
        assert!(said([0.5e-3, 1e-3], 0.2)[3].ends_with("positions: smaller; momenta: smaller."));
        assert_eq!(sentences(&[first]).len(), 1);
        assert!(sentences(&[]).is_empty());
    }

    #[test]
    fn a_row_for_all_and_one_for_each() {
        let table = practical_table(&[run("tanh", [1.25e-3, 2e-3], 0.4)], 100);
        let rows: Vec<&str> = table.lines().filter(|line| line.contains("two-link-tanh")).collect();
        assert!(rows.len() == 2 && rows[0].contains(" all ") && rows[1].contains("encoder alone"), "{table}");
        assert!(rows.iter().all(|row| row.contains("1.25") && row.contains("2.00")), "{table}");
    }
}
