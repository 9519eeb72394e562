//! Loops with nothing between law and robot, which stay in lanes from one control instant to the next.
//!
//! What each of them would book of a period, [`Gliding`] books for all at once, in the same operations: to the bit the same numbers. What does
//! not go that way, strides that did not resolve a period or a loop that diverges, is left to the loops themselves.

use std::array;

use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};
use flexure_core::scalar::{Jet, Piecewise, Scalar};

use crate::imperfections::stages::{Pieces, Tick};
use crate::lanes::{self, Each, Several, WIDTH};
use crate::robot::links::SideBySide;
use crate::robot::slices::{write, write_motion};
use crate::simulate::controller::Action;
use crate::simulate::held::Held;
use crate::simulate::interface::Observed;
use crate::simulate::ledger::Ledger;
use crate::simulate::simulation::{BEYOND, Balance, Happened};
use crate::simulate::strides::taken;

/// What [`Simulation`](crate::simulate::simulation::Simulation)s know of their last control instant, in lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gliding<const N: usize> {
    /// Lanes that move. What is in others means nothing.
    pub(super) going: Each<bool>,
    pub(super) tick: Tick,
    /// Periods since they were taken up.
    pub(super) periods: u32,
    pub(super) motion: Motion<Several, N>,
    /// Torque that acts until the next instant [N m].
    pub(super) u_m: Vector<Several, N>,
    reference: Vector<Jet<Several, 5>, N>,
    ledger: Ledger<Several>,
    balance: Balance<Several>,
    energy: Several,
    residual: Several,
}

/// Torques [N m] up to which a loop may glide; none if it may not at all, because something else stands between law and robot or pushes it.
pub(super) fn may_glide<L: Links<f64, N> + Clone, const N: usize>(
    held: &Held<L, N>,
) -> Option<Vector<f64, N>> {
    let simulation = &held.simulation;
    let is_free = simulation.pushes().is_empty() && simulation.plant().torque_gain == Vector([1.0; N]);
    is_free.then(|| simulation.controller().ideal_up_to())?
}

impl<const N: usize> Gliding<N> {
    /// Takes the `loops` up that are `going`, of which each has come to the same instant; none before the first.
    pub(super) fn of<L: SideBySide<N>>(loops: &[Held<L, N>], going: Each<bool>) -> Option<Self> {
        let first = going.iter().position(|going| *going)?;
        let lasts: Each<&Happened<N>> = {
            let filling = loops[first].simulation.last.as_ref()?;
            array::from_fn(|lane| {
                let last =
                    loops.get(lane).filter(|_| going[lane]).and_then(|held| held.simulation.last.as_ref());
                last.unwrap_or(filling)
            })
        };
        let each: Each<&Held<L, N>> = array::from_fn(|lane| loops.get(lane).unwrap_or(&loops[0]));
        let number = |find: &dyn Fn(&Held<L, N>) -> f64| Several::from_array(each.map(find));
        Some(Self {
            going,
            tick: lasts[first].tick,
            periods: 0,
            motion: lanes::motion(&each.map(|held| &held.simulation.motion)),
            u_m: lanes::vector(&lasts.map(|last| &last.action.applied.first)),
            reference: lanes::series(&lasts.map(|last| &last.action.reference)),
            ledger: Ledger {
                supplied: number(&|held| held.simulation.world.ledger.supplied),
                dissipated: number(&|held| held.simulation.world.ledger.dissipated),
                throughput: number(&|held| held.simulation.world.ledger.throughput),
            },
            balance: Balance {
                start: number(&|held| held.simulation.balance.start),
                worst: number(&|held| held.simulation.balance.worst),
                scale: number(&|held| held.simulation.balance.scale),
            },
            energy: Several::from_array(lasts.map(|last| last.energy)),
            residual: Several::from_array(lasts.map(|last| last.residual)),
        })
    }

    /// The next control instant.
    pub(super) fn next(&self) -> Tick {
        Tick::new(self.tick.k + 1, self.tick.period)
    }

    /// Books an instant to which the robots have moved, with that `work` on the way and the total `energy` in J there, and at which their
    /// laws ask for the torques `u_m` at the reference `q_ld`, cut at `limits` [N m]. Whether it is one of loops that go on without being cut;
    /// nothing is booked else.
    pub(super) fn arrive(
        &mut self,
        motion: &Motion<Several, N>,
        work: &Ledger<Several>,
        energy: Several,
        q_ld: &Vector<Jet<Several, 5>, N>,
        [u_m, limits]: [&Vector<Several, N>; 2],
    ) -> bool {
        let parts = [&motion.q_l, &motion.q_m, &motion.v_l, &motion.v_m];
        let magnitude = parts
            .iter()
            .flat_map(|v| v.iter())
            .fold(Several::ZERO, |m: Several, x| m.max(x.abs()))
            .to_array();
        let torque = u_m.iter().fold(Several::ZERO, |sum: Several, u| sum + u.abs()).to_array();
        let over = u_m.iter().zip(limits.iter());
        let over = over.fold(Several::ZERO, |most: Several, (u, limit)| most.max(u.abs() - limit)).to_array();
        let goes_on = |lane: usize| magnitude[lane] < BEYOND && torque[lane].is_finite() && over[lane] <= 0.0;
        if !(0..WIDTH).all(|lane| !self.going[lane] || goes_on(lane)) {
            return false;
        }
        let Self { ledger, balance, .. } = self;
        ledger.add(work);
        self.residual = energy - balance.start - ledger.supplied + ledger.dissipated;
        balance.scale = balance.scale.max(energy.abs()).max(ledger.throughput).max(ledger.dissipated);
        balance.worst = balance.worst.max(self.residual.abs());
        (self.tick, self.periods) = (self.next(), self.periods + 1);
        (self.motion, self.reference, self.u_m, self.energy) = (*motion, *q_ld, *u_m, energy);
        true
    }

    /// Gives a loop back what it has come to.
    pub(super) fn put_back<L: SideBySide<N>>(&self, held: &mut Held<L, N>, lane: usize) {
        let (simulation, number) = (&mut held.simulation, |lanes: Several| lanes.to_array()[lane]);
        let Balance { start, worst, scale } = self.balance;
        simulation.motion = taken(&self.motion, lane);
        simulation.world.ledger = self.ledger.of(lane);
        simulation.balance = Balance { start: number(start), worst: number(worst), scale: number(scale) };
        let u_m = self.u_m.map(number);
        let action = Action {
            reference: self.reference.map(|jet| Jet::from_fn(|k| number(jet.coefficient(k)))),
            measured: simulation.motion,
            seen: simulation.motion,
            disturbance: Vector::ZERO,
            u_m,
            applied: Pieces::constant(u_m),
            reported: u_m,
            certificate: true,
            stopped: false,
            guard: None,
        };
        simulation.controller.state.applied = u_m;
        let (energy, residual) = (number(self.energy), number(self.residual));
        simulation.last = Some(Happened { tick: self.tick, action, energy, residual });
    }

    /// What is observed of the loop in a lane, which has `n` joints, as [`Loop::observe`](crate::simulate::interface::Loop::observe) says.
    pub(super) fn observe(&self, lane: usize, n: usize, observed: &mut Observed) {
        observed.t = self.tick.t;
        write_motion(&taken(&self.motion, lane), n, &mut observed.motion);
        let positions = self.reference.map(|jet| jet.coefficient(0).to_array()[lane]);
        write(&positions, &mut observed.followed);
        write(&positions, &mut observed.reference);
        let u_m = self.u_m.map(|u| u.to_array()[lane]);
        write(&u_m, &mut observed.command);
        write(&u_m, &mut observed.applied);
        (observed.certificate, observed.stopped) = (true, false);
    }
}
