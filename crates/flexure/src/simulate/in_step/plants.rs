//! The plants of loops that go in step.

use std::array;

use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};
use flexure_core::scalar::Scalar;

use crate::estimators::AnyEstimator;
use crate::imperfections::stages::Tick;
use crate::lanes::{self, Each, Several, WIDTH};
use crate::plant::Plant;
use crate::references::AnyReference;
use crate::robot::links::SideBySide;
use crate::scenario::Integration;
use crate::simulate::gauss::{Order, steps_in};
use crate::simulate::held::Held;
use crate::simulate::midpoint::{self, Midpoint};
use crate::simulate::own_law::HeldLaw;
use crate::simulate::simulation::{Divergence, Simulation, World};
use crate::simulate::stepper::Stepper;
use crate::simulate::strides::{Effort, Strides, Strode, finite, likely, put, replace, taken};

/// How plants are moved side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Gait {
    /// By strides of an order, with the tolerated local error.
    Strides(Order, Effort, f64),
    /// By steps of the midpoint rule.
    Midpoint,
}

/// The gait of a loop at its start; none if each period is one for its stepper.
pub(super) fn gait<L: SideBySide<N>, const N: usize>(held: &Held<L, N>) -> Option<Gait> {
    let Simulation { motion, timing, world: World { plant, .. }, .. } = &held.simulation;
    if !plant.is_smooth() || plant.rotor_coupling.is_some() {
        return None;
    }
    match timing.integration {
        Integration::Midpoint => Some(Gait::Midpoint),
        Integration::Collocation { tolerance } => likely(plant, motion, timing.period, tolerance)
            .map(|(order, effort)| Gait::Strides(order, effort, tolerance)),
    }
}

/// Plants side by side, moved by steps of fixed work; what these do not resolve, each by its own stepper.
pub(super) struct Plants<L: SideBySide<N>, const N: usize> {
    robots: Plant<L::Several, N, Several>,
    steps: Steps<N>,
    /// Steps a period.
    parts: u32,
    lanes: Each<Rider>,
    /// Total energy in J at the last instant.
    pub(super) energy: Each<f64>,
}

/// How strides do with the plant in a lane.
#[derive(Clone, Copy, Debug, Default)]
struct Rider {
    /// They took it over the last period: its integrator was elsewhere then.
    strode: bool,
    /// Its periods are not of one piece, as where a drive is late by a part of one.
    pieced: bool,
    /// Periods that they did not resolve, less those that they did, from 0 to [`MANY`].
    failed: u32,
    /// The instant until which they are not tried.
    rests: u64,
}

/// Periods in a row that are not resolved, after which a plant is left to its integrator for a while: as under noise, where every torque jumps.
const MANY: u32 = 5;

/// How many periods that is, at least.
const REST: u64 = 50;

/// Strides have a new iteration matrix whenever the number of the instant is a multiple of this, and rests end there.
const RENEWED: u64 = 10;

/// Steps of fixed work: the midpoint rule, or strides of either order.
enum Steps<const N: usize> {
    Midpoint(Midpoint<N, Several>),
    Four(Box<Strides<2, N, WIDTH>>),
    Eight(Box<Strides<4, N, WIDTH>>),
}

impl<L: SideBySide<N>, const N: usize> Plants<L, N> {
    /// Those of `loops`, one for each lane, which have this `gait`; none if their links are not of one structure.
    pub(super) fn new(loops: &Each<&Held<L, N>>, gait: Gait) -> Option<Self> {
        let (steps, parts) = match gait {
            Gait::Midpoint => {
                let parts = steps_in(loops[0].simulation.timing.period, midpoint::LONGEST);
                (Steps::Midpoint(Midpoint::new()), parts)
            }
            Gait::Strides(Order::Four, effort, tolerance) => {
                (Steps::Four(Box::new(Strides::new(tolerance, effort))), effort.parts)
            }
            Gait::Strides(Order::Eight, effort, tolerance) => {
                (Steps::Eight(Box::new(Strides::new(tolerance, effort))), effort.parts)
            }
        };
        let plants = loops.map(|held| held.simulation.plant());
        let links = L::side_by_side(&plants.map(|plant| &plant.robot.links))?;
        let robots = Plant::together(links, plants)?;
        Some(Self { robots, steps, parts, lanes: [Rider::default(); WIDTH], energy: [0.0; WIDTH] })
    }

    /// Whether strides may take all of the loops that are `going` over the period after the instant `k`.
    pub(super) fn may_stride(&self, k: u64, going: Each<bool>) -> bool {
        self.lanes.iter().zip(going).all(|(rider, going)| !going || (!rider.pieced && k >= rider.rests))
    }

    /// Where strides lead the robots that move as `x` at an instant, over the period that begins there, under the torque `u_m` [N m].
    pub(super) fn stride(
        &mut self,
        tick: &Tick,
        x: &Motion<Several, N>,
        u_m: &Vector<Several, N>,
    ) -> Strode<N, WIDTH> {
        if tick.k.is_multiple_of(RENEWED) {
            self.steps.renew();
        }
        self.steps.advance(&self.robots, x, u_m, tick.period)
    }

    /// Total energy in J.
    pub(super) fn total_energy(&self, x: &Motion<Several, N>) -> Several {
        self.robots.total_energy(x)
    }

    /// Books that strides took the loop in a lane over so many `periods`, the last ones.
    pub(super) fn strode(&mut self, held: &mut Held<L, N>, lane: usize, periods: u32) {
        if periods == 0 {
            return;
        }
        let more = u64::from(periods) * u64::from(self.parts);
        match (&mut held.simulation.world.stepper, &self.steps) {
            (Stepper::Smooth(integrator), _) => integrator.steps += more,
            (Stepper::Rough(stepping), Steps::Midpoint(midpoint)) => {
                stepping.steps += more;
                stepping.last = midpoint.last.map(|a| a.map(|a| a.to_array()[lane]));
            }
            (Stepper::Rough(_), _) => {}
        }
        let rider = &mut self.lanes[lane];
        (rider.strode, rider.failed) = (true, rider.failed.saturating_sub(periods));
    }

    /// Moves the robots of the loops that are `going` over the control period after their last instant, to where they `strode` if that has
    /// been tried; the loops that diverged on the way.
    pub(super) fn advance(
        &mut self,
        loops: &mut [Held<L, N>],
        going: Each<bool>,
        strode: Option<Strode<N, WIDTH>>,
    ) -> Each<Option<Divergence>> {
        let mut ended = [None; WIDTH];
        // All loops are at the same instant.
        let Some(tick) =
            loops.iter().zip(going).find_map(|(held, going)| held.simulation.last_tick().filter(|_| going))
        else {
            self.energy = self.robots.total_energy(&motions(loops)).to_array();
            return ended;
        };
        let k = tick.k;
        let mut torques: Each<Option<Vector<f64, N>>> = [None; WIDTH];
        for (lane, held) in loops.iter().enumerate().filter(|(lane, _)| going[*lane]) {
            let rider = &mut self.lanes[lane];
            rider.pieced |= held.simulation.is_in_pieces();
            torques[lane] = held.simulation.held_torque().filter(|_| !rider.pieced && k >= rider.rests);
        }
        let mut end = motions(loops);
        // What leads on begins with the first period, whoever needs it.
        let strode = strode.or_else(|| {
            (k == 0 || torques.iter().any(Option::is_some)).then(|| {
                let pushed: Each<Vector<f64, N>> = array::from_fn(|lane| one(loops, lane).pushed());
                self.robots.external = lanes::vector(&pushed.each_ref());
                let u_m = torques.map(|torque| torque.unwrap_or(Vector::ZERO));
                self.stride(&tick, &end, &lanes::vector(&u_m.each_ref()))
            })
        });
        if let Some(strode) = &strode {
            end = strode.end;
        }
        for lane in (0..loops.len()).filter(|&lane| going[lane]) {
            let (simulation, rider) = (&mut loops[lane].simulation, &mut self.lanes[lane]);
            let strode = strode.as_ref().filter(|_| torques[lane].is_some());
            if let Some(strode) = strode.filter(|strode| strode.trusted[lane]) {
                simulation.motion = taken(&strode.end, lane);
                simulation.world.ledger.add(&strode.work.of(lane));
                self.strode(&mut loops[lane], lane, 1);
                continue;
            }
            rider.failed += u32::from(strode.is_some());
            if rider.failed >= MANY {
                (rider.failed, rider.rests) = (MANY - 1, (k + REST).next_multiple_of(RENEWED));
            }
            let was_elsewhere = std::mem::take(&mut rider.strode);
            match (&mut simulation.world.stepper, &self.steps) {
                (Stepper::Smooth(integrator), _) if was_elsewhere => integrator.forget(),
                // What it was settled with may be of the attempt.
                (Stepper::Rough(stepping), Steps::Midpoint(midpoint)) if strode.is_some() => {
                    stepping.last = midpoint.before.map(|a| a.map(|a| a.to_array()[lane]));
                }
                _ => {}
            }
            ended[lane] = simulation.advance().err();
            self.steps.resume(lane, &simulation.world.stepper);
            replace(&mut end, lane, &simulation.motion);
        }
        self.energy = self.robots.total_energy(&end).to_array();
        ended
    }
}

/// The loop in a lane; the first in those beyond.
fn one<L: SideBySide<N>, const N: usize>(
    loops: &[Held<L, N>],
    lane: usize,
) -> &Simulation<L, AnyReference<f64, N>, HeldLaw<N>, AnyEstimator<f64, N>, N> {
    &loops.get(lane).unwrap_or(&loops[0]).simulation
}

/// How they move.
fn motions<L: SideBySide<N>, const N: usize>(loops: &[Held<L, N>]) -> Motion<Several, N> {
    let each: Each<&Motion<f64, N>> = array::from_fn(|lane| &one(loops, lane).motion);
    lanes::motion(&each)
}

impl<const N: usize> Steps<N> {
    fn renew(&mut self) {
        match self {
            Self::Midpoint(_) => {}
            Self::Four(strides) => strides.renew(),
            Self::Eight(strides) => strides.renew(),
        }
    }

    fn advance<L: Links<Several, N>>(
        &mut self,
        plants: &Plant<L, N, Several>,
        x: &Motion<Several, N>,
        u_m: &Vector<Several, N>,
        interval: f64,
    ) -> Strode<N, WIDTH> {
        match self {
            Self::Midpoint(midpoint) => {
                let (end, work) = midpoint.advance(plants, x, u_m, interval);
                Strode { end, work, trusted: finite(&end), error: Several::ZERO }
            }
            Self::Four(strides) => strides.advance(plants, x, u_m, interval),
            Self::Eight(strides) => strides.advance(plants, x, u_m, interval),
        }
    }

    /// The loop in a lane has been moved by its own stepper: what that leads on to, these lead on to.
    fn resume(&mut self, lane: usize, stepper: &Stepper<N>) {
        match (self, stepper) {
            (Self::Midpoint(midpoint), Stepper::Rough(stepping)) => {
                for (lanes, one) in midpoint.last.iter_mut().zip(&stepping.last) {
                    for (lanes, one) in lanes.0.iter_mut().zip(one.iter()) {
                        put(lanes, lane, one);
                    }
                }
            }
            (Self::Four(strides), Stepper::Smooth(integrator)) => strides.resume(lane, integrator),
            (Self::Eight(strides), Stepper::Smooth(integrator)) => strides.resume(lane, integrator),
            _ => {}
        }
    }
}
