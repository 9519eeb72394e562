//! The plants of loops that go in step.

use std::array;

use flexure_core::linalg::Vector;
use flexure_core::model::Motion;

use crate::estimators::AnyEstimator;
use crate::lanes::{self, Each, Several, WIDTH};
use crate::plant::Plant;
use crate::references::AnyReference;
use crate::robot::links::SideBySide;
use crate::simulate::gauss::{Integrator, Order};
use crate::simulate::held::Held;
use crate::simulate::own_law::HeldLaw;
use crate::simulate::simulation::{Divergence, Simulation};
use crate::simulate::stepper::Stepper;
use crate::simulate::strides::{Effort, Strides, Strode, likely, replace, taken};

/// By which strides a plant is moved; none if each period is one for its integrator.
pub(super) type Gait = Option<(Order, Effort)>;

/// The gait of a loop at its start.
pub(super) fn gait<L: SideBySide<N>, const N: usize>(held: &Held<L, N>) -> Gait {
    let (simulation, plant) = (&held.simulation, held.simulation.plant());
    let moves = plant.is_smooth() && plant.rotor_coupling.is_none();
    moves.then(|| likely(plant, &simulation.motion, simulation.timing.period, simulation.timing.tolerance))?
}

/// Plants side by side, moved by strides; what these do not resolve, each by its own integrator.
pub(super) struct Plants<L: SideBySide<N>, const N: usize> {
    robots: Plant<L::Several, N, Several>,
    strides: Gauss<N>,
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

/// Strides of either order.
enum Gauss<const N: usize> {
    Four(Box<Strides<2, N, WIDTH>>),
    Eight(Box<Strides<4, N, WIDTH>>),
}

impl<L: SideBySide<N>, const N: usize> Plants<L, N> {
    /// Those of `loops`, one for each lane, which have this gait; none if their links are not of one structure.
    pub(super) fn new(loops: &Each<&Held<L, N>>, (order, effort): (Order, Effort)) -> Option<Self> {
        let plants = loops.map(|held| held.simulation.plant());
        let links = L::side_by_side(&plants.map(|plant| &plant.robot.links))?;
        let tolerance = loops[0].simulation.timing.tolerance;
        Some(Self {
            robots: Plant::together(links, plants)?,
            strides: match order {
                Order::Four => Gauss::Four(Box::new(Strides::new(tolerance, effort))),
                Order::Eight => Gauss::Eight(Box::new(Strides::new(tolerance, effort))),
            },
            parts: effort.parts,
            lanes: [Rider::default(); WIDTH],
            energy: [0.0; WIDTH],
        })
    }

    /// Moves the robots of the loops that are `going` over the control period after their last instant; the loops that diverged on the way.
    pub(super) fn advance(
        &mut self,
        loops: &mut [Held<L, N>],
        going: Each<bool>,
    ) -> Each<Option<Divergence>> {
        let mut ended = [None; WIDTH];
        // All loops are at the same instant.
        let Some(k) =
            loops.iter().zip(going).find_map(|(held, going)| held.simulation.last_tick().filter(|_| going))
        else {
            self.energy = self.robots.total_energy(&motions(loops)).to_array();
            return ended;
        };
        let mut torques: Each<Option<Vector<f64, N>>> = [None; WIDTH];
        for (lane, held) in loops.iter().enumerate().filter(|(lane, _)| going[*lane]) {
            let rider = &mut self.lanes[lane];
            rider.pieced |= held.simulation.is_in_pieces();
            torques[lane] = held.simulation.held_torque().filter(|_| !rider.pieced && k >= rider.rests);
        }
        let mut end = motions(loops);
        // What leads on begins with the first period, whoever needs it.
        let strode = (k == 0 || torques.iter().any(Option::is_some)).then(|| {
            if k.is_multiple_of(RENEWED) {
                self.strides.renew();
            }
            let pushed: Each<Vector<f64, N>> = array::from_fn(|lane| one(loops, lane).pushed());
            self.robots.external = lanes::vector(&pushed.each_ref());
            let u_m = torques.map(|torque| torque.unwrap_or(Vector::ZERO));
            let u_m = lanes::vector(&u_m.each_ref());
            self.strides.advance(&self.robots, &end, &u_m, loops[0].simulation.timing.period)
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
                if let Stepper::Smooth(integrator) = &mut simulation.world.stepper {
                    integrator.steps += u64::from(self.parts);
                }
                (rider.strode, rider.failed) = (true, rider.failed.saturating_sub(1));
                continue;
            }
            rider.failed += u32::from(strode.is_some());
            if rider.failed >= MANY {
                (rider.failed, rider.rests) = (MANY - 1, (k + REST).next_multiple_of(RENEWED));
            }
            let was_elsewhere = std::mem::take(&mut rider.strode);
            if let (Stepper::Smooth(integrator), true) = (&mut simulation.world.stepper, was_elsewhere) {
                integrator.forget();
            }
            ended[lane] = simulation.advance().err();
            if let Stepper::Smooth(integrator) = &simulation.world.stepper {
                self.strides.resume(lane, integrator);
            }
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

impl<const N: usize> Gauss<N> {
    fn renew(&mut self) {
        match self {
            Self::Four(strides) => strides.renew(),
            Self::Eight(strides) => strides.renew(),
        }
    }

    fn advance<L: flexure_core::model::Links<Several, N>>(
        &mut self,
        plants: &Plant<L, N, Several>,
        x: &Motion<Several, N>,
        u_m: &Vector<Several, N>,
        interval: f64,
    ) -> Strode<N, WIDTH> {
        match self {
            Self::Four(strides) => strides.advance(plants, x, u_m, interval),
            Self::Eight(strides) => strides.advance(plants, x, u_m, interval),
        }
    }

    fn resume(&mut self, lane: usize, integrator: &Integrator<N>) {
        match self {
            Self::Four(strides) => strides.resume(lane, integrator),
            Self::Eight(strides) => strides.resume(lane, integrator),
        }
    }
}
