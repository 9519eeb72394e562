//! The plants of loops that go in step.

use std::array;

use flexure_core::linalg::Vector;
use flexure_core::model::Motion;

use crate::lanes::{self, Each, Several, WIDTH};
use crate::plant::Plant;
use crate::robot::links::SideBySide;
use crate::simulate::gauss::{Integrator, Order};
use crate::simulate::held::Held;
use crate::simulate::simulation::Divergence;
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
    plants: Plant<L::Several, N, Several>,
    strides: Gauss<N>,
    parts: u32,
    /// Lanes that strides took over the last period: their integrators were elsewhere then.
    strode: Each<bool>,
    /// Lanes whose periods are not of one piece, as where a drive is late by a part of one: strides do not move them.
    pieced: Each<bool>,
    /// Total energy in J at the last instant.
    pub(super) energy: Each<f64>,
}

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
            plants: Plant::together(links, plants)?,
            strides: match order {
                Order::Four => Gauss::Four(Box::new(Strides::new(tolerance, effort))),
                Order::Eight => Gauss::Eight(Box::new(Strides::new(tolerance, effort))),
            },
            parts: effort.parts,
            strode: [false; WIDTH],
            pieced: [false; WIDTH],
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
        let torques: Each<Option<Vector<f64, N>>> = array::from_fn(|lane| {
            let held = loops.get(lane).filter(|_| going[lane])?;
            held.simulation.held_torque()
        });
        for (lane, held) in loops.iter().enumerate().filter(|(lane, _)| going[*lane]) {
            self.pieced[lane] |= held.simulation.is_in_pieces();
        }
        let each = |lane: usize| &loops.get(lane).unwrap_or(&loops[0]).simulation;
        let motions: Each<&Motion<f64, N>> = array::from_fn(|lane| &each(lane).motion);
        let mut end = lanes::motion(&motions);
        let strode = (0..loops.len()).any(|lane| torques[lane].is_some() && !self.pieced[lane]).then(|| {
            let pushed: Each<Vector<f64, N>> = array::from_fn(|lane| each(lane).pushed());
            self.plants.external = lanes::vector(&pushed.each_ref());
            let u_m = torques.map(|torque| torque.unwrap_or(Vector::ZERO));
            let u_m = lanes::vector(&u_m.each_ref());
            self.strides.advance(&self.plants, &end, &u_m, loops[0].simulation.timing.period)
        });
        if let Some(strode) = &strode {
            end = strode.end;
        }
        for lane in (0..loops.len()).filter(|&lane| going[lane]) {
            let simulation = &mut loops[lane].simulation;
            match strode.as_ref().filter(|strode| strode.trusted[lane] && torques[lane].is_some()) {
                Some(strode) if !self.pieced[lane] => {
                    simulation.motion = taken(&strode.end, lane);
                    let work = [strode.work.supplied, strode.work.dissipated, strode.work.throughput];
                    let [supplied, dissipated, throughput] = work.map(|work| work.to_array()[lane]);
                    let ledger = &mut simulation.world.ledger;
                    ledger.supplied += supplied;
                    ledger.dissipated += dissipated;
                    ledger.throughput += throughput;
                    self.strode[lane] = true;
                    if let Stepper::Smooth(integrator) = &mut simulation.world.stepper {
                        integrator.steps += u64::from(self.parts);
                    }
                }
                _ => {
                    let was_elsewhere = std::mem::replace(&mut self.strode[lane], false);
                    if let (Stepper::Smooth(integrator), true) =
                        (&mut simulation.world.stepper, was_elsewhere)
                    {
                        integrator.forget();
                    }
                    ended[lane] = simulation.advance().err();
                    if let (Stepper::Smooth(integrator), true) = (&simulation.world.stepper, strode.is_some())
                    {
                        self.strides.resume(lane, integrator);
                    }
                    replace(&mut end, lane, &simulation.motion);
                }
            }
        }
        self.energy = self.plants.total_energy(&end).to_array();
        ended
    }
}

impl<const N: usize> Gauss<N> {
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
