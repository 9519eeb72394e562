//! The chain as a semidefinite programme in floats: the least μ, the unknowns being μ and the parameters of the forms.

use flexure_core::linalg::Matrix;
use flexure_core::scalar::Interval;

use super::barrier::{Block, central_path};
use super::link::{Link, Square};
use super::{at_root, bordered, children, lifted, seen_by_parent};
use crate::linalg::Symmetric;

/// A positive semidefinite form is at most twice its diagonal blocks, these are at most their traces, and adding the joint's
/// own rate doubles it once more: four times the traces. A little more is strictly more.
const ABOVE: f64 = 4.2;

/// Some directions of a form may never be felt at the base: its traces stay below this many times those at the start, or the
/// barrier has no least value.
const BOUND: f64 = 500.0;

/// What parts of a form without inertia start from, relative to the whole robot.
const NOTHING: f64 = 1e-9;

/// A chain in floats, and the rate for which it holds [1/s].
pub struct Suggestion {
    pub rate: f64,
    pub forms: Vec<Option<Vec<f64>>>,
}

/// Chains ever closer to the largest rate, each strictly inside of what holds, in floats.
pub fn suggestions(links: &[Link<Interval>], damping: &[Interval]) -> Vec<Suggestion> {
    let links: Vec<Link<f64>> = links.iter().map(Link::midpoint).collect();
    let damping: Vec<f64> = damping.iter().map(|d| d.midpoint()).collect();
    let Programme { blocks, start, first } = programme(&links, &damping);
    central_path(&blocks, start)
        .into_iter()
        .map(|v| {
            // Forms against μ B with the inertias as they are; a rate of 1/μ scales both.
            let rate = v[0].recip();
            let form = |(first, link): (&Option<usize>, &Link<f64>)| {
                first.map(|i| v[i..i + link.parameters()].iter().map(|y| y * rate).collect())
            };
            Suggestion { rate, forms: first.iter().zip(&links).map(form).collect() }
        })
        .collect()
}

/// The unknowns are μ and the parameters of the forms.
struct Programme {
    blocks: Vec<Block>,
    /// Strictly inside.
    start: Vec<f64>,
    /// The first unknown of each form.
    first: Vec<Option<usize>>,
}

/// Least μ with diag(Q_k, μ B_k) − [X, S]ᵀ P [X, S] positive definite for every joint, P = I_k + Σ X_cᵀ Q_c X_c.
fn programme(links: &[Link<f64>], damping: &[f64]) -> Programme {
    let mut first = vec![None; links.len()];
    let mut unknowns = 1;
    for (k, link) in links.iter().enumerate().filter(|(_, link)| link.parent.is_some()) {
        first[k] = Some(unknowns);
        unknowns += link.parameters();
    }
    let whole =
        links.iter().map(|link| traces(&link.inertia)).fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d]);
    let mut programme = Programme { blocks: Vec::new(), start: vec![0.0; unknowns], first };
    let children = children(links);
    // From the leaves: the start of a form needs those of its children.
    for k in (0..links.len()).rev() {
        let carried: Vec<(usize, Square<f64>)> = children[k]
            .iter()
            .flat_map(|&c| {
                programme
                    .slopes(c, &links[c])
                    .into_iter()
                    .map(move |(i, form)| (i, seen_by_parent(&links[c], &form)))
            })
            .collect();
        programme.joint(
            &links[k],
            damping[k],
            &programme.slopes(k, &links[k]),
            &carried,
            whole.map(|x| NOTHING * x),
        );
    }
    programme.start[0] *= 1.1;
    programme
}

impl Programme {
    /// The unknowns of the form of joint `k`, with what the form grows by with each.
    fn slopes(&self, k: usize, link: &Link<f64>) -> Vec<(usize, Square<f64>)> {
        let Some(first) = self.first[k] else { return Vec::new() };
        let count = link.parameters();
        let unit = |i: usize| (0..count).map(|j| f64::from(u8::from(i == j))).collect::<Vec<_>>();
        (0..count).map(|i| (first + i, link.form(&unit(i)))).collect()
    }

    /// Adds what has to hold at a joint, with the slopes of its `own` form and of those `carried`, and a start inside.
    fn joint(
        &mut self,
        link: &Link<f64>,
        damping: f64,
        own: &[(usize, Square<f64>)],
        carried: &[(usize, Square<f64>)],
        least: [f64; 2],
    ) {
        let total = carried.iter().fold(link.inertia, |sum, (i, slope)| sum + slope.scaled(self.start[*i]));
        let mut require = |seen: &dyn Fn(&Square<f64>) -> Symmetric<f64>, damper: Symmetric<f64>| {
            let negative = |form: &Square<f64>| seen(form).map(|x| -x);
            let own = own.iter().map(|(i, slope)| (*i, bordered(slope, 0.0)));
            let carried = carried.iter().map(|(i, slope)| (*i, negative(slope)));
            let slopes = std::iter::once((0, damper)).chain(own).chain(carried).collect();
            self.blocks.push(Block { constant: negative(&link.inertia), slopes });
        };
        if own.is_empty() {
            require(&|form| at_root(link, form), Symmetric::diagonal(&[damping]));
            self.start[0] = self.start[0].max(at_root(link, &total).at(0, 0) / damping);
            return;
        }
        let mut largest = least;
        for lift in link.lifts() {
            require(&|form| lifted(&lift, form), bordered(&Matrix::ZERO, damping));
            let form = lifted(&lift, &total);
            for (part, largest) in largest.iter_mut().enumerate() {
                *largest = largest.max(ABOVE * trace(part, |i| form.at(i, i)));
            }
            self.start[0] = self.start[0].max(2.0 * form.at(6, 6) / damping);
        }
        for (part, largest) in largest.into_iter().enumerate() {
            let of_trace = own.iter().map(|(i, slope)| (*i, trace(part, |j| slope[(j, j)])));
            let of_trace: Vec<_> = of_trace.filter(|(_, slope)| *slope != 0.0).collect();
            self.blocks.push(Block {
                constant: Symmetric::diagonal(&[3.0 * BOUND * largest]),
                slopes: of_trace.iter().map(|&(i, slope)| (i, Symmetric::diagonal(&[-slope]))).collect(),
            });
            for (i, _) in of_trace {
                self.start[i] = largest;
            }
        }
    }
}

/// The sum of the entries on the diagonal that belong to ω (0) or to v (1).
fn trace(part: usize, entry: impl Fn(usize) -> f64) -> f64 {
    (3 * part..3 * part + 3).map(entry).sum()
}

fn traces(form: &Square<f64>) -> [f64; 2] {
    [0, 1].map(|part| trace(part, |i| form[(i, i)]))
}
