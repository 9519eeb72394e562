//! Branch and bound: a contraction rate over a region, box by box.

use flexure_core::scalar::Interval;

use crate::linalg::Symmetric;
use crate::progress::{Progress, unwatched};
use crate::prove::engine::direct::definite::{Definite, definite};
use crate::prove::engine::direct::flow::{Balance, Flow};
use crate::prove::engine::direct::witness::{DirectWitness, Sample};
use crate::prove::engine::direct::{samples, split};
use crate::prove::engine::verdict::{Undecided, Verdict};

/// A rate that holds at every state of the region.
#[derive(Clone, Debug, PartialEq)]
pub struct Proved {
    /// β [1/s].
    pub rate: f64,
    /// Boxes looked at.
    pub boxes: usize,
}

/// Whether `flow` contracts at the rate `beta` [1/s] at every state of its region, looking at no more than `budget` boxes.
///
/// [`Verdict::Proved`] is rigorous for every value of constants that are intervals, and so is [`Verdict::Refuted`].
pub fn prove(flow: &dyn Flow, beta: f64, budget: usize) -> Verdict<Proved, DirectWitness> {
    prove_watched(flow, beta, budget, &unwatched)
}

/// [`prove`], with `progress` told about what fraction is done at every box; what it breaks off is undecided.
pub fn prove_watched(
    flow: &dyn Flow,
    beta: f64,
    budget: usize,
    progress: Progress<'_>,
) -> Verdict<Proved, DirectWitness> {
    /// Boxes before samples: most rates that hold with room to spare take no more, and samples cost as much as hundreds.
    const FEW: usize = 32;
    let few = budget.min(FEW);
    let share = few as f64 / budget.max(1) as f64;
    let (verdict, spent) = bisect(flow, beta, few, &|fraction| progress(share * fraction));
    let goes_on = || progress(share).is_continue();
    if !matches!(verdict, Verdict::Undecided(_)) || !goes_on() {
        return verdict;
    }
    if let Some(witness) = samples::weakest(flow, &goes_on).and_then(|sample| sample.refutes(flow, beta)) {
        return Verdict::Refuted(witness);
    }
    match bisect(flow, beta, budget - spent, &|fraction| progress(share + (1.0 - share) * fraction)).0 {
        Verdict::Proved(proved) => Verdict::Proved(Proved { boxes: spent + proved.boxes, ..proved }),
        Verdict::Undecided(at) => Verdict::Undecided(Undecided { spent: spent + at.spent, ..at }),
        refuted @ Verdict::Refuted(_) => refuted,
    }
}

/// [`prove_watched`] without looking at samples first, only boxes that resist are searched for witnesses; and the boxes it took.
pub(crate) fn bisect(
    flow: &dyn Flow,
    beta: f64,
    budget: usize,
    progress: Progress<'_>,
) -> (Verdict<Proved, DirectWitness>, usize) {
    let root: Vec<Interval> = flow.coordinates().iter().map(|c| c.range).collect();
    let undecided = |at: String, spent| (Verdict::Undecided(Undecided { at, spent }), spent);
    if !beta.is_finite() {
        return undecided(format!("a rate of {beta}"), 0);
    }
    let mut relevant = None;
    // Boxes, and the part of the region that each is by the cuts that made it.
    let mut open = vec![(root.clone(), 1.0)];
    let (mut spent, mut done) = (0, 0.0_f64);
    while let Some((at, part)) = open.pop() {
        let fraction = done.max(spent as f64 / budget.max(1) as f64);
        if spent == budget || progress(fraction).is_break() {
            return undecided(describe(flow, &at), spent);
        }
        spent += 1;
        let Some(Doubt { about, reach }) = decide(flow, &at, beta) else {
            done += part;
            continue;
        };
        let middle: Vec<f64> = at.iter().map(|x| x.midpoint()).collect();
        if let Some(witness) = Sample::new(flow, middle).and_then(|sample| sample.refutes(flow, beta)) {
            return (Verdict::Refuted(witness), spent);
        }
        let relevant = relevant.get_or_insert_with(|| split::relevant(flow, &root));
        let matrix = |at: &[Interval]| about.matrix(flow, at, beta);
        let parts = split::most_effective(flow, &at, relevant, matrix, &reach)
            .and_then(|i| split::halves(at[i]).map(|parts| (i, parts)));
        let Some((i, (left, right))) = parts else {
            return undecided(describe(flow, &at), spent);
        };
        for half in [left, right] {
            let mut piece = at.clone();
            piece[i] = half;
            open.push((piece, 0.5 * part));
        }
    }
    (Verdict::Proved(Proved { rate: beta, boxes: spent }), spent)
}

/// Which of the two inequalities was not shown on a box.
#[derive(Clone, Copy, Debug)]
enum About {
    /// dissipation − β weight is positive definite.
    Rate,
    /// The weight is: without it W would be no length.
    Weight,
}

impl About {
    fn matrix(self, flow: &dyn Flow, at: &[Interval], beta: f64) -> Symmetric<Interval> {
        let balance = flow.enclosure(at);
        match self {
            Self::Rate => balance.dissipation.minus(&balance.weight, Interval::point(beta)),
            Self::Weight => balance.weight,
        }
    }
}

/// What was not shown, and how much the uncertainty of each row counts there.
struct Doubt {
    about: About,
    reach: Vec<f64>,
}

/// `None` where both inequalities hold on the whole box `at`.
fn decide(flow: &dyn Flow, at: &[Interval], beta: f64) -> Option<Doubt> {
    let Balance { dissipation, weight } = flow.enclosure(at);
    let rate = dissipation.minus(&weight, Interval::point(beta));
    // Before anything is known of a factor, rows count by the size of the metric.
    let unit = |a: &Symmetric<Interval>, i: usize| {
        let size = a.at(i, i).magnitude();
        if size.is_finite() && size > 0.0 { size.sqrt().recip() } else { 1.0 }
    };
    for (about, matrix) in [(About::Rate, rate), (About::Weight, weight)] {
        if let Definite::Unknown(reach) = definite(&matrix) {
            let reach = reach.unwrap_or_else(|| (0..matrix.size()).map(|i| unit(&matrix, i)).collect());
            return Some(Doubt { about, reach });
        }
    }
    None
}

/// The box in words: coordinates that are bounded, and their ranges.
fn describe(flow: &dyn Flow, at: &[Interval]) -> String {
    let coordinates = flow.coordinates().iter().zip(at).filter(|(_, x)| **x != Interval::ENTIRE);
    let words = coordinates.map(|(c, x)| format!("{} in [{}, {}] {}", c.name, x.lo(), x.hi(), c.unit));
    words.collect::<Vec<_>>().join(", ")
}
