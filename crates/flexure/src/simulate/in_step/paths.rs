//! References of loops that go in step, evaluated at several control instants at once.

use std::array;

use flexure_core::linalg::Vector;
use flexure_core::model::Links;
use flexure_core::reference::Reference as _;
use flexure_core::scalar::{Jet, Lanes, Scalar as _};

use crate::imperfections::stages::Tick;
use crate::lanes::{self, Several};
use crate::references::AnyReference;
use crate::simulate::held::Held;

/// How many instants are looked at together: as many on every processor.
const AHEAD: usize = 8;

/// A position with its first four derivatives, an entry per joint.
type Followed<const N: usize, T = f64> = Vector<Jet<T, 5>, N>;

/// What the references of loops are at the control instants around the last one that was asked for.
#[derive(Clone, Debug)]
pub(super) struct Paths<const N: usize> {
    /// Number of the first of these instants; none before any was asked for.
    first: Option<u64>,
    /// That of all loops, or one for each.
    known: Vec<[Followed<N>; AHEAD]>,
}

impl<const N: usize> Paths<N> {
    /// Those of `loops`.
    pub(super) fn of<L: Links<f64, N>>(loops: &[Held<L, N>]) -> Self {
        let is_one = loops.iter().all(|held| followed_by(held) == followed_by(&loops[0]));
        let known = [Vector([Jet::ZERO; N]); AHEAD];
        Self { first: None, known: vec![known; if is_one { 1 } else { loops.len() }] }
    }

    /// Has the references of the `loops` that they are of known at a control instant.
    pub(super) fn reach<L: Links<f64, N>>(&mut self, tick: &Tick, loops: &[Held<L, N>]) {
        let first = tick.k - tick.k % AHEAD as u64;
        if self.first == Some(first) {
            return;
        }
        let t: [f64; AHEAD] = {
            let mut next = first..;
            array::from_fn(|_| Tick::new(next.next().unwrap_or(first), tick.period).t)
        };
        for (known, held) in self.known.iter_mut().zip(loops) {
            let at: Followed<N, Lanes<f64, AHEAD>> =
                followed_by(held).on(Jet::variable(Lanes::from_array(t)));
            for (joint, jet) in at.iter().enumerate() {
                let orders: [[f64; AHEAD]; 5] = array::from_fn(|order| jet.coefficient(order).to_array());
                for (i, known) in known.iter_mut().enumerate() {
                    known[joint] = Jet::from_fn(|order| orders[order][i]);
                }
            }
        }
        self.first = Some(first);
    }

    /// The reference of the loop in a lane at an instant that was [reached](Self::reach).
    #[expect(clippy::cast_possible_truncation, reason = "less than AHEAD")]
    pub(super) fn at(&self, tick: &Tick, lane: usize) -> &Followed<N> {
        let known = self.known.get(lane).unwrap_or(&self.known[0]);
        &known[(tick.k % AHEAD as u64) as usize]
    }

    /// The same for all of them.
    pub(super) fn side_by_side(&self, tick: &Tick) -> Followed<N, Several> {
        if self.known.len() == 1 {
            return self.at(tick, 0).map(|jet| Jet::from_fn(|order| Several::splat(jet.coefficient(order))));
        }
        lanes::series(&array::from_fn(|lane| self.at(tick, lane)))
    }
}

/// The reference of a loop.
fn followed_by<L: Links<f64, N>, const N: usize>(held: &Held<L, N>) -> &AnyReference<f64, N> {
    &held.simulation.controller().reference
}
