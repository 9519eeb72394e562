//! Many loops in the caller's hand, moved together.

use rayon::prelude::*;

use crate::files::Problems;
use crate::lanes::Each;
use crate::scenario::Scenario;
use crate::simulate::held::opened_together;
use crate::simulate::in_step::{self, InStep};
use crate::simulate::interface::Loop;
use crate::simulate::simulation::Divergence;

/// The loops of many scenarios, moved from one control instant to the next together: those of one kind several to a SIMD register, registers on
/// all cores. Each loop does what it does alone, but for the last digits of sines and tanh in lanes, whatever is beside it.
///
/// ```
/// use flexure::{Scenario, simulate::Batch};
///
/// let scenario = Scenario::load("pendulum-tanh")?;
/// let mut batch = Batch::open(&[&scenario; 10])?;
/// for _ in 0..100 {
///     batch.step();
/// }
/// assert_eq!(batch.divergence(3), None);
/// let mut values = vec![0.0; batch.held(3).signals().len()];
/// batch.held(3).read(&mut values)?;
/// assert!((values[0] - 0.099).abs() < 1e-12); // s: the first instant is at 0
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Batch {
    registers: Vec<Box<dyn InStep>>,
    /// Register and lane of each loop.
    places: Vec<(usize, usize)>,
}

impl Batch {
    /// The loops of `scenarios`, in their order, which have control periods.
    ///
    /// # Errors
    /// As [`Scenario::open`], and `unsupported` for a loop in continuous time.
    pub fn open(scenarios: &[&Scenario]) -> Result<Self, Problems> {
        if let Some(continuous) = scenarios.iter().find(|scenario| !in_step::goes_in_step(scenario)) {
            let message = "hold is \"continuous\": loops that are moved together have control periods";
            let help = "remove hold: the torque is then held between control instants";
            let problem = continuous.places.problem("hold", "unsupported", message.to_owned(), help);
            return Err(problem.into());
        }
        let mut batch = Self { registers: Vec::new(), places: vec![(0, 0); scenarios.len()] };
        for group in in_step::groups(scenarios) {
            let opened = opened_together(group.iter().map(|&place| (place, scenarios[place])).collect())?;
            if let Some((_, problems)) = opened.refused.into_iter().next() {
                return Err(problems);
            }
            for (places, loops) in opened.groups {
                for (lane, place) in places.into_iter().enumerate() {
                    batch.places[place] = (batch.registers.len(), lane);
                }
                batch.registers.push(loops);
            }
        }
        Ok(batch)
    }

    /// How many loops there are.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Moves every loop that has not diverged on to its next control instant, the first at t = 0.
    pub fn step(&mut self) {
        self.steps(1);
    }

    /// The same `count` times: without waiting for each other in between.
    pub fn steps(&mut self, count: usize) {
        let on = |register: &mut Box<dyn InStep>| {
            for _ in 0..count {
                let going: Each<bool> = std::array::from_fn(|lane| {
                    lane < register.lanes() && register.divergence(lane).is_none()
                });
                register.step(going);
            }
            register.settle();
        };
        // On one thread a pool only hands over, which takes as long as a hundred periods.
        if self.registers.len() == 1 || rayon::current_num_threads() == 1 {
            self.registers.iter_mut().for_each(on);
        } else {
            self.registers.par_iter_mut().for_each(on);
        }
    }

    /// The loop of a scenario, by its place, to be read.
    ///
    /// # Panics
    /// If there are no more loops than `place`.
    pub fn held(&self, place: usize) -> &dyn Loop {
        let (register, lane) = self.places[place];
        self.registers[register].lane(lane)
    }

    /// How the loop at a place diverged, if it did: it stays where it is.
    ///
    /// # Panics
    /// If there are no more loops than `place`.
    pub fn divergence(&self, place: usize) -> Option<Divergence> {
        let (register, lane) = self.places[place];
        self.registers[register].divergence(lane)
    }
}
