//! What imperfections do to a loop.

use flexure_core::estimate::LowPass;

use crate::files::Entry;
use crate::imperfections::kind::Setup;
use crate::imperfections::stages::{Actuating, Actuator, Computer, Missing, Random, Sensing, Sensors};
use crate::imperfections::{IMPERFECTIONS, Imperfection, Push};
use crate::plant::{self, Departures, Plant};
use crate::robot::Robot;

/// Gives joints what the model of the robot leaves out.
pub(crate) type JointChange<'a> = Box<dyn Fn(&mut Departures<'_>) + 'a>;

/// From the robot that the law knows to the one that is simulated.
pub(crate) type RobotChange<'a> = Box<dyn Fn(&Robot) -> Robot + 'a>;

/// What an imperfection does to a loop, and where.
pub(crate) enum Effect<'a> {
    /// A stage between motion and readings.
    Sensing(Box<dyn Sensing>),
    /// The computer stands still at instants in [from, until) in s.
    Stall([f64; 2]),
    /// Commands that do not get out in time.
    Missing(Box<dyn Missing>),
    /// A stage between commanded torque and motor.
    Actuating(Box<dyn Actuating>),
    /// Torque acts so much later in s. Times add up.
    Delay(f64),
    /// Velocities are differences of measured positions through this filter.
    Velocities(LowPass<f64>),
    /// The joints of the simulated robot have what its model leaves out.
    Joints(JointChange<'a>),
    /// Another robot is simulated than the law knows.
    Robot(RobotChange<'a>),
    /// Torque from outside on the links.
    Push(&'a Push),
}

/// What all imperfections of a loop do to it, each in its place: in the order of the registry, whatever order they are given in.
#[derive(Default)]
pub struct Effects<'a> {
    count: usize,
    /// From motion to readings.
    pub sensors: Sensors,
    /// When it runs, and whether commands get out.
    pub computer: Computer,
    /// From command to torque.
    pub actuator: Actuator,
    /// Of differences of measured positions, where velocities are those.
    pub velocities: Option<LowPass<f64>>,
    joints: Vec<JointChange<'a>>,
    robots: Vec<RobotChange<'a>>,
    pushes: Vec<&'a Push>,
}

impl<'a> Effects<'a> {
    /// Of `imperfections` on a robot with so many `joints`, in a loop with control periods of `period` \[s\]. Random numbers come
    /// from streams of `seed`, a stream for each imperfection.
    ///
    /// # Panics
    /// For cut-offs of filters that the reader of scenarios refuses.
    pub fn of(imperfections: &'a [Imperfection], joints: usize, period: f64, seed: u64) -> Self {
        let (mut effects, mut delay) = (Self { count: joints, ..Self::default() }, 0.0);
        let (mut sensing, mut actuating) = (Vec::new(), Vec::new());
        let (mut stalls, mut missing) = (Vec::new(), Vec::new());
        for Entry { name, .. } in IMPERFECTIONS {
            let of_kind = imperfections.iter().filter(|imperfection| imperfection.kind() == *name);
            for (index, imperfection) in (0..).zip(of_kind) {
                let random = Random::new(seed, name, index);
                match imperfection.effect(Setup { joints, period, random }) {
                    Effect::Sensing(stage) => sensing.push((*name, stage)),
                    Effect::Stall(window) => stalls.push(window),
                    Effect::Missing(late) => missing.push((*name, late)),
                    Effect::Actuating(stage) => actuating.push((*name, stage)),
                    Effect::Delay(more) => delay += more,
                    Effect::Velocities(filter) => effects.velocities = Some(filter),
                    Effect::Joints(change) => effects.joints.push(change),
                    Effect::Robot(change) => effects.robots.push(change),
                    Effect::Push(push) => effects.pushes.push(push),
                }
            }
        }
        effects.sensors = Sensors::new(joints, sensing);
        effects.computer = Computer::new(stalls, missing);
        effects.actuator = Actuator::new(joints, actuating, delay, period);
        effects
    }

    /// The robot that is simulated where the law knows `robot`.
    pub fn simulated(&self, robot: &Robot) -> Robot {
        self.robots.iter().fold(robot.clone(), |robot, change| change(&robot))
    }

    /// Gives the joints of `plant` what its model leaves out.
    pub fn depart<L, const N: usize>(&self, plant: &mut Plant<L, N>) {
        for change in &self.joints {
            change(&mut plant.departures(self.count));
        }
    }

    /// What pushes the links.
    pub fn pushes<const N: usize>(&self) -> Vec<plant::Push<N>> {
        self.pushes.iter().map(|push| push.on_links()).collect()
    }
}
