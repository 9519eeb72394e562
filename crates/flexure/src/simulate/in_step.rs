//! Loops that go in step, several to a SIMD register.
//!
//! What is most of the work of a loop, its law and its robot in motion, is the code of one loop on [`Several`] numbers; sensors, estimator,
//! guard and drive, which decide and draw, are each loop's own, and so are robots with dry friction, play, hysteresis or coupled rotors. A lane never looks at its neighbours: what a loop comes to does not depend on which others
//! go beside it.

mod gliding;
mod paths;
mod plants;

use std::array;

use flexure_core::linalg::Vector;
use flexure_core::model::Fjr;

use crate::files::Problems;
use crate::lanes::{self, Each, Several, WIDTH};
use crate::laws::{AnyLaw, any_law};
use crate::robot::links::{FromFile, SideBySide};
use crate::scenario::{self, Scenario};
use crate::simulate::controller::Sensed;
use crate::simulate::held::Held;
use crate::simulate::in_step::gliding::{Gliding, may_glide};
use crate::simulate::in_step::paths::Paths;
use crate::simulate::in_step::plants::{Gait, Plants, gait};
use crate::simulate::interface::{Loop, Observed};
use crate::simulate::simulation::{Divergence, Kept, Simulation};
use crate::simulate::strides::Strode;

/// Loops that go in step, their joint count hidden.
pub(crate) trait InStep: Send + Sync {
    /// How many loops there are, at most [`WIDTH`].
    fn lanes(&self) -> usize;

    /// The loop in a lane, as it was when the group was last [settled](Self::settle).
    fn lane(&self, lane: usize) -> &dyn Loop;

    /// Writes what is observed of the loop in a lane, at the instant that it has come to, into `observed`, which was made for it.
    fn observe(&self, lane: usize, observed: &mut Observed);

    /// How a loop diverged, if it did: it stays where it is.
    fn divergence(&self, lane: usize) -> Option<Divergence>;

    /// Moves the loops in the lanes that are `going` on to their next control instant.
    fn step(&mut self, going: Each<bool>);

    /// Has the loops know what they have come to: steps may keep that in lanes.
    fn settle(&mut self);
}

/// Whether the loops of two scenarios may go in step, as far as their files say.
pub(crate) fn may_go_together(a: &Scenario, b: &Scenario) -> bool {
    let kind = |scenario: &Scenario| (scenario.controller.kind(), scenario.controller.phi());
    goes_in_step(a)
        && goes_in_step(b)
        && kind(a) == kind(b)
        && a.robot.links.what() == b.robot.links.what()
        && a.robot.joint_count() == b.robot.joint_count()
        && a.control_period.to_bits() == b.control_period.to_bits()
        && a.integration == b.integration
}

/// Whether loops of a scenario go in step with others at all: those in continuous time ask their law within steps.
pub(crate) fn goes_in_step(scenario: &Scenario) -> bool {
    scenario.hold == scenario::Hold::ZeroOrder
}

/// The places of scenarios whose loops may go together, at most [`WIDTH`] each, in the order of the first of them; those whose loops go with no
/// others at all are in none.
pub(crate) fn groups(scenarios: &[&Scenario]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (place, scenario) in scenarios.iter().enumerate().filter(|(_, scenario)| goes_in_step(scenario)) {
        let fits =
            |group: &&mut Vec<usize>| group.len() < WIDTH && may_go_together(scenarios[group[0]], scenario);
        match groups.iter_mut().find(fits) {
            Some(group) => group.push(place),
            None => groups.push(vec![place]),
        }
    }
    groups
}

/// Loops with the numbers of the scenarios that they are of, and scenarios that there is no loop of.
pub(crate) struct Opened<K> {
    /// At most [`WIDTH`] in each.
    pub(crate) groups: Vec<(Vec<K>, Box<dyn InStep>)>,
    pub(crate) refused: Vec<(K, Problems)>,
}

/// Puts loops into groups: of one gait, and one structure, or each into one of its own.
pub(super) fn grouped<K, L, const N: usize>(keys: Vec<K>, loops: Vec<Held<L, N>>, opened: &mut Opened<K>)
where
    L: FromFile<f64, N> + SideBySide<N> + Clone + Send + Sync + 'static,
{
    let mut parts: Vec<(_, Vec<K>, Vec<_>)> = Vec::new();
    for (key, held) in keys.into_iter().zip(loops) {
        let gait = gait(&held);
        match parts.iter_mut().find(|(of, ..)| *of == gait) {
            Some((_, keys, loops)) => {
                keys.push(key);
                loops.push(held);
            }
            None => parts.push((gait, vec![key], vec![held])),
        }
    }
    for (gait, keys, loops) in parts {
        match Group::new(loops, gait) {
            Ok(group) => opened.groups.push((keys, Box::new(group))),
            Err(loops) => {
                for (key, held) in keys.into_iter().zip(loops) {
                    // One is like itself.
                    if let Ok(group) = Group::new(vec![held], gait) {
                        opened.groups.push((vec![key], Box::new(group)));
                    }
                }
            }
        }
    }
}

/// Loops whose size is known to the compiler.
struct Group<L: SideBySide<N>, const N: usize> {
    /// At most [`WIDTH`]; lanes beyond have the numbers of the first.
    loops: Vec<Held<L, N>>,
    /// The robots that the laws know.
    models: Fjr<Several, L::Several, N>,
    laws: AnyLaw<Several, N>,
    /// Where strides are likely to move them.
    plants: Option<Plants<L, N>>,
    paths: Paths<N>,
    /// Torques [N m] up to which they may stay in lanes; none if they may not.
    may_glide: Option<Vector<Several, N>>,
    /// The loops while they do: they themselves know nothing of it until they are settled.
    gliding: Option<Gliding<N>>,
}

impl<L: FromFile<f64, N> + SideBySide<N> + Clone, const N: usize> Group<L, N> {
    /// The loops, if they are of one structure; else they are given back.
    fn new(loops: Vec<Held<L, N>>, gait: Option<Gait>) -> Result<Self, Vec<Held<L, N>>> {
        let lane = |lane: usize| loops.get(lane).unwrap_or(&loops[0]);
        let each: Each<&Held<L, N>> = array::from_fn(lane);
        let models = robots(&each.map(Held::robot));
        let laws = laws(&each.map(Held::scenario));
        let plants = match gait {
            None => Some(None),
            Some(gait) => Plants::new(&each, gait).map(Some),
        };
        match (models, laws, plants) {
            (Some(models), Some(laws), Some(plants)) => {
                let limits: Option<Vec<_>> = each.into_iter().map(may_glide).collect();
                let may_glide = limits
                    .filter(|_| plants.is_some() && laws.memory().is_empty())
                    .map(|limits| lanes::vector(&array::from_fn(|lane| &limits[lane])));
                let paths = Paths::of(&loops);
                Ok(Self { loops, models, laws, plants, paths, may_glide, gliding: None })
            }
            _ => Err(loops),
        }
    }
}

/// Robots side by side; none if their links are not of one structure.
fn robots<L: SideBySide<N>, const N: usize>(
    robots: &Each<&Fjr<f64, L, N>>,
) -> Option<Fjr<Several, L::Several, N>> {
    Some(Fjr {
        links: L::side_by_side(&robots.map(|robot| &robot.links))?,
        motor_inertia: lanes::vector(&robots.map(|robot| &robot.motor_inertia)),
        stiffness: lanes::vector(&robots.map(|robot| &robot.stiffness)),
        link_damping: lanes::vector(&robots.map(|robot| &robot.link_damping)),
        motor_damping: lanes::vector(&robots.map(|robot| &robot.motor_damping)),
    })
}

/// The laws of scenarios whose laws are of one kind; none if not all of them have the same gains.
fn laws<const N: usize>(scenarios: &Each<&Scenario>) -> Option<AnyLaw<Several, N>> {
    let numbers = scenarios.map(|scenario| {
        lanes::numbers(|number| any_law::<f64, N>(&scenario.controller, &scenario.robot, number))
    });
    lanes::together(&numbers, |number| any_law(&scenarios[0].controller, &scenarios[0].robot, number))
}

impl<L, const N: usize> InStep for Group<L, N>
where
    L: FromFile<f64, N> + SideBySide<N> + Clone + Send + Sync,
{
    fn lanes(&self) -> usize {
        self.loops.len()
    }

    fn lane(&self, lane: usize) -> &dyn Loop {
        &self.loops[lane]
    }

    fn divergence(&self, lane: usize) -> Option<Divergence> {
        self.loops[lane].simulation.divergence
    }

    fn observe(&self, lane: usize, observed: &mut Observed) {
        let held = &self.loops[lane];
        match &self.gliding {
            Some(gliding) if gliding.going[lane] => gliding.observe(lane, held.joints(), observed),
            _ => held.observe(observed).expect("made for it"),
        }
    }

    fn settle(&mut self) {
        let (Some(gliding), Some(plants)) = (self.gliding.take(), &mut self.plants) else { return };
        for (lane, held) in self.loops.iter_mut().enumerate().filter(|(lane, _)| gliding.going[*lane]) {
            gliding.put_back(held, lane);
            plants.strode(held, lane, gliding.periods);
        }
    }

    fn step(&mut self, going: Each<bool>) {
        let strode = match self.glide(going) {
            Glided::On => return,
            Glided::Not(strode) => strode,
        };
        let kept: Each<Option<Kept<N>>> = array::from_fn(|lane| {
            going[lane].then(|| self.loops.get(lane)).flatten().map(|held| held.simulation.kept())
        });
        let mut ended: Each<Option<Divergence>> = self.advanced(going, strode);
        let arriving = array::from_fn(|lane| kept[lane].is_some() && ended[lane].is_none());
        let sensed = self.sensed(arriving);
        let torques = self.torques(&sensed);
        for lane in (0..WIDTH).filter(|&lane| arriving[lane]) {
            let simulation = &mut self.loops[lane].simulation;
            let tick = simulation.tick();
            let action = match &sensed[lane] {
                Some(sensed) => {
                    let torque = torques.as_ref().map(|torques| torques[lane]);
                    simulation.controller.act(&tick, sensed, torque)
                }
                None => simulation.controller.silent(&tick),
            };
            let energy = match &self.plants {
                Some(plants) => plants.energy[lane],
                None => simulation.world.energy(&simulation.motion),
            };
            ended[lane] = simulation.arrive(tick, action, energy).err();
        }
        for (held, ended) in self.loops.iter_mut().zip(ended.iter().zip(kept)) {
            if let (Some(divergence), Some(kept)) = ended {
                held.simulation.end(*divergence, kept);
            }
        }
    }
}

/// What became of an attempt to move loops on in lanes.
enum Glided<const N: usize> {
    /// They have moved.
    On,
    /// They are settled where they were; with what strides made of the period, if that was tried.
    Not(Option<Strode<N, WIDTH>>),
}

impl<L, const N: usize> Group<L, N>
where
    L: FromFile<f64, N> + SideBySide<N> + Clone + Send + Sync,
{
    /// Moves the loops that are `going` on in lanes, where that can be.
    fn glide(&mut self, going: Each<bool>) -> Glided<N> {
        if self.gliding.as_ref().is_some_and(|gliding| gliding.going != going) {
            self.settle();
        }
        let (Some(plants), Some(limits)) = (&mut self.plants, &self.may_glide) else {
            return Glided::Not(None);
        };
        if self.gliding.is_none() {
            let first = going.iter().zip(&self.loops).find(|(going, _)| **going);
            let last = first.and_then(|(_, held)| held.simulation.last_tick());
            if last.is_some_and(|tick| plants.may_stride(tick.k, going)) {
                self.gliding = Gliding::of(&self.loops, going);
            }
        }
        let Some(gliding) = &mut self.gliding else { return Glided::Not(None) };
        let strode = plants.stride(&gliding.tick, &gliding.motion, &gliding.u_m);
        if (0..WIDTH).all(|lane| !going[lane] || strode.trusted[lane]) {
            let next = gliding.next();
            self.paths.reach(&next, &self.loops);
            let q_ld = self.paths.side_by_side(&next);
            let energy = plants.total_energy(&strode.end);
            let u_m = self.laws.static_torque(&self.models, &strode.end, &q_ld);
            let arrived = |u_m| gliding.arrive(&strode.end, &strode.work, energy, &q_ld, [&u_m, limits]);
            if u_m.is_some_and(arrived) {
                return Glided::On;
            }
        }
        self.settle();
        Glided::Not(Some(strode))
    }

    /// Moves the robots over the control period after their last instant, as strides did if they have been tried; the loops that diverged
    /// on the way.
    fn advanced(&mut self, going: Each<bool>, strode: Option<Strode<N, WIDTH>>) -> Each<Option<Divergence>> {
        if let Some(plants) = &mut self.plants {
            return plants.advance(&mut self.loops, going, strode);
        }
        let mut ended = [None; WIDTH];
        for (lane, held) in self.loops.iter_mut().enumerate().filter(|(lane, _)| going[*lane]) {
            ended[lane] = held.simulation.advance().err();
        }
        ended
    }

    /// What each controller knows before its law is asked.
    fn sensed(&mut self, arriving: Each<bool>) -> Each<Option<Sensed<N>>> {
        let mut sensed = [None; WIDTH];
        for lane in (0..WIDTH).filter(|&lane| arriving[lane]) {
            let tick = self.loops[lane].simulation.tick();
            self.paths.reach(&tick, &self.loops);
            let Simulation { controller, motion, .. } = &mut self.loops[lane].simulation;
            sensed[lane] = controller.sense(&tick, motion, Some(self.paths.at(&tick, lane)));
        }
        sensed
    }

    /// What the law of each loop asks for at what its controller knows [N m]; anything for loops that know nothing, and nothing of laws with memory: each
    /// loop asks its own.
    fn torques(&self, sensed: &Each<Option<Sensed<N>>>) -> Option<Each<Vector<f64, N>>> {
        let filling = sensed.iter().flatten().next()?;
        let sensed = sensed.each_ref().map(|sensed| sensed.as_ref().unwrap_or(filling));
        let x = lanes::motion(&sensed.map(|sensed| &sensed.seen));
        let q_ld = lanes::series(&sensed.map(|sensed| &sensed.reference));
        self.laws.static_torque(&self.models, &x, &q_ld).map(|torque| lanes::apart(&torque))
    }
}
