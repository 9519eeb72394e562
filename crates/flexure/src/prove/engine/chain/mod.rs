//! A bound of the mass matrix of a tree over all its configurations, by a chain of small matrix inequalities without an angle:
//! one for each joint, between its body with all that hangs on it and the body that carries it. Stated and shown in
//! `docs/certificate.md`.
//!
//! Floats find the forms of the chain (`programme`, `barrier`), intervals show that it holds.

mod barrier;
mod bodies;
mod link;
mod programme;

use flexure_core::linalg::Matrix;
use flexure_core::scalar::{Interval, Scalar};

pub use bodies::own_inertias;

use crate::linalg::Symmetric;
use crate::prove::engine::certificate::DecimalBody;
use crate::prove::engine::number::Number;
use crate::prove::engine::rate::Inequality;
use bodies::Body;
use link::{Link, Square};
use programme::{Suggestion, suggestions};

/// The forms of a chain, and what has to hold with them.
pub struct Chain {
    /// Parameters of the form of each joint; none of one at the base.
    pub forms: Vec<Option<Vec<Number>>>,
    /// Inequalities that together bound the mass matrix against the damping.
    pub inequalities: Vec<Inequality>,
    /// What each inequality is called: the index of the joint, with `L` and `H` for the ends of a travel.
    pub cases: Vec<String>,
}

/// The chain that bounds the mass matrix of `bodies` most closely against `damping`, the entries of D + K_d, leaving out the
/// `skipped` closest ones.
///
/// # Errors
/// Says which joint slides without limits, if one does, or that no chain could be shown to hold.
pub fn chain(bodies: &[DecimalBody], damping: &[Interval], skipped: usize) -> Result<Chain, String> {
    let bodies = bodies.iter().enumerate().map(|(k, body)| Body::new(k, body));
    let bodies = bodies.collect::<Result<Vec<_>, _>>()?;
    let links: Vec<Link<Interval>> = bodies.iter().map(Link::new).collect();
    let suggested = suggestions(&links, damping);
    let shown = suggested.into_iter().rev().skip(skipped).find_map(|Suggestion { rate, forms }| {
        let forms: Vec<Option<Vec<Number>>> = forms
            .into_iter()
            .map(|form| form.map(|y| y.into_iter().map(Number::decimal).collect()))
            .collect();
        let inequalities = inequalities(&links, damping, &forms);
        let holds = inequalities.iter().all(|one| one.margin(Interval::point(rate)) > 0.0);
        holds.then(|| Chain { forms, inequalities, cases: cases(&links) })
    });
    shown.ok_or_else(|| "no chain of forms that bounds the mass matrix could be shown to hold".to_owned())
}

/// The children of each link.
fn children<T>(links: &[Link<T>]) -> Vec<Vec<usize>> {
    let of = |k: usize| (0..links.len()).filter(|&c| links[c].parent == Some(k)).collect();
    (0..links.len()).map(of).collect()
}

/// The names of the inequalities, in the order of [`inequalities`].
fn cases(links: &[Link<Interval>]) -> Vec<String> {
    let names = |(k, link): (usize, &Link<Interval>)| match (link.parent, link.lifts().len()) {
        (Some(_), 2) => vec![format!("{k}L"), format!("{k}H")],
        _ => vec![k.to_string()],
    };
    links.iter().enumerate().flat_map(names).collect()
}

/// What has to be positive definite at the rate β, of joint k: diag(Q_k, B_k) − [X, S]ᵀ P [X, S] with P = β I_k + Σ X_cᵀ Q_c X_c
/// over its children c; at the base B_k − Sᵀ P S.
fn inequalities(
    links: &[Link<Interval>],
    damping: &[Interval],
    forms: &[Option<Vec<Number>>],
) -> Vec<Inequality> {
    let form = |k: usize| {
        let numbers = forms[k].as_ref()?;
        Some(links[k].form(&numbers.iter().map(Number::bounds).collect::<Vec<_>>()))
    };
    let forms: Vec<Option<Square<Interval>>> = (0..links.len()).map(form).collect();
    let mut found = Vec::new();
    for ((k, link), children) in links.iter().enumerate().zip(children(links)) {
        let carried = children.iter().filter_map(|&c| Some(seen_by_parent(&links[c], forms[c].as_ref()?)));
        let carried = carried.fold(Matrix::ZERO, |sum, form| sum + form);
        match &forms[k] {
            None => found.push(Inequality {
                form: Symmetric::diagonal(&[damping[k]]).minus(&at_root(link, &carried), Interval::ONE),
                weight: at_root(link, &link.inertia),
            }),
            Some(form) => found.extend(link.lifts().iter().map(|lift| Inequality {
                form: bordered(form, damping[k]).minus(&lifted(lift, &carried), Interval::ONE),
                weight: lifted(lift, &link.inertia),
            })),
        }
    }
    found
}

/// Xᵀ Q X with the placement X of a link: its form for the velocity of its parent.
fn seen_by_parent<T: Scalar>(link: &Link<T>, form: &Square<T>) -> Square<T> {
    link.placement.transpose() * *form * link.placement
}

/// Gᵀ P G.
fn lifted<T: Scalar>(lift: &Matrix<T, 6, 7>, form: &Square<T>) -> Symmetric<T> {
    let product: Matrix<T, 7, 7> = lift.transpose() * (*form * *lift);
    Symmetric::from_fn(7, |i, j| product[(i, j)])
}

/// Sᵀ P S.
fn at_root<T: Scalar>(link: &Link<T>, form: &Square<T>) -> Symmetric<T> {
    let twist = link.twist();
    let product: Matrix<T, 1, 1> = twist.transpose() * (*form * twist);
    Symmetric::diagonal(&[product[(0, 0)]])
}

/// diag(Q, d).
fn bordered<T: Scalar>(form: &Square<T>, d: T) -> Symmetric<T> {
    Symmetric::from_fn(7, |i, j| match (i, j) {
        (6, 6) => d,
        (6, _) => T::ZERO,
        _ => form[(i, j)],
    })
}
