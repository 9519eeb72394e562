//! The plant of a scenario under given torques, without any controller.

use flexure_core::model::{Links, Motion};

use crate::files::Problems;
use crate::imperfections::stages::{Pieces, Tick};
use crate::plant::{Plant, Push};
use crate::robot::Mismatch;
use crate::robot::links::FromFile;
use crate::robot::sized::{OF_THE_KIND, fjr, sized};
use crate::robot::slices::{check, read, read_motion, write_motion};
use crate::scenario::{Integration, Scenario};
use crate::simulate::assembly;
use crate::simulate::ledger::Ledger;
use crate::simulate::simulation::World;
use crate::simulate::stepper::Stepper;

/// The simulated robot of a scenario with its joint count hidden: model errors, friction, coupled rotors, springs that are not
/// linear, torque constants that are off and pushes included.
pub trait Driven: Send + Sync {
    /// Number of joints n.
    fn joints(&self) -> usize;

    /// How it moves from `start` (q_l, q_m, q̇_l, q̇_m; 4n numbers in rad and rad/s) on under the torques `u_m` that its drives
    /// believe to give, n numbers each [N m], each for `period` s. `first` counts the periods since the run began, which pushes
    /// go by. Gives 4n numbers at the end of each period; not a number from where the motion cannot be integrated on.
    ///
    /// # Errors
    /// If `start` does not have 4n numbers, or `u_m` no multiple of n.
    fn motion(&self, start: &[f64], first: u64, period: f64, u_m: &[f64]) -> Result<Vec<f64>, Mismatch>;
}

impl Scenario {
    /// The robot that this scenario simulates, to be driven by given torques.
    ///
    /// # Errors
    /// If the robot has more joints than this program was built for.
    ///
    /// # Panics
    /// Never: links are of the kind that their size was chosen by.
    pub fn driven(&self) -> Result<Box<dyn Driven>, Problems> {
        let simulated = assembly::simulated(self);
        Ok(sized!(&simulated, L, N => {
            let robot = fjr::<f64, L<f64>, N>(&simulated, &simulated.links, |x| x, &|x| x).expect(OF_THE_KIND);
            let plant = assembly::plant(self, robot);
            let (integration, longest) = (self.integration, assembly::LONGEST_STEP);
            Box::new(Sized { plant, pushes: assembly::pushes(self), integration, longest })
        }))
    }
}

/// A plant whose size is known to the compiler.
struct Sized<L, const N: usize> {
    plant: Plant<L, N>,
    pushes: Vec<Push<N>>,
    integration: Integration,
    longest: f64,
}

impl<L, const N: usize> Driven for Sized<L, N>
where
    L: FromFile<f64, N> + Links<f64, N> + Clone + Send + Sync,
{
    fn joints(&self) -> usize {
        self.plant.robot.links.joints()
    }

    fn motion(&self, start: &[f64], first: u64, period: f64, u_m: &[f64]) -> Result<Vec<f64>, Mismatch> {
        let n = self.joints();
        let mut x: Motion<f64, N> = read_motion(start, n)?;
        check("u_m", "n for each period", u_m.len(), u_m.len().next_multiple_of(n))?;
        let plant = self.plant.clone();
        let stepper = Stepper::new(&plant, self.integration, self.longest);
        let mut world = World { plant, pushes: self.pushes.clone(), stepper, ledger: Ledger::default() };
        let mut motions = vec![f64::NAN; 4 * u_m.len()];
        for ((k, torque), motion) in (first..).zip(u_m.chunks_exact(n)).zip(motions.chunks_exact_mut(4 * n)) {
            let given = world.plant.torque_gain.diag_mul(&read("u_m", torque, n)?);
            let Ok(next) = world.advance_pieces(x, &Tick::new(k, period), &Pieces::constant(given)) else {
                break;
            };
            x = next;
            write_motion(&x, n, motion);
        }
        Ok(motions)
    }
}
