//! A robot with its joint count hidden: rigid-body and flexible-joint dynamics on slices.

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, LinkMatrices, Links, MassFactor, Motion};
use flexure_core::scalar::{Interval, Jet, Over, Scalar};

use crate::files::Problems;
use crate::robot::Robot;
use crate::robot::links::FromFile;
use crate::robot::sized::{OF_THE_KIND, fjr, sized};
use crate::robot::slices::{Mismatch, check, read, read_motion, read_rows, write, write_rows};

/// What can be asked of a flexible-joint robot, over numbers of type `C`: `f64`, or [`Interval`] for enclosures of every robot
/// that its file may mean.
///
/// Vectors have one number per joint, n = [`joints`](Self::joints), in the order of the robot file. Matrices are given row by
/// row, n² numbers. Positions in rad, velocities in rad/s, torques in N m, inertias in kg m², energies in J; for prismatic joints
/// read m for rad and N for N m. Motors are seen from the link side of the gear. A *motion* is (q_l, q_m, q̇_l, q̇_m), 4n
/// numbers. *Series* are Taylor coefficients in time, x, ẋ, ẍ/2, x⃛/6, …, one array per joint.
///
/// Nothing is allocated. Every method fails with [`Mismatch`] if a slice has another length than it must have, before anything
/// is written.
///
/// ```
/// let arm = flexure::Robot::load("pendulum-1dof")?.arm()?;
/// let (mut mass, mut torque) = ([0.0], [0.0]);
/// arm.mass_matrix(&[0.3], &mut mass)?;
/// // At rest, an acceleration of 1 rad/s² takes the inertia on top of what holds the weight.
/// arm.inverse_dynamics(&[0.3], &[0.0], &[1.0], &mut torque)?;
/// let mut weight = [0.0];
/// arm.inverse_dynamics(&[0.3], &[0.0], &[0.0], &mut weight)?;
/// assert!((torque[0] - weight[0] - mass[0]).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Arm<C = f64>: Send + Sync {
    /// Number of joints n.
    fn joints(&self) -> usize;

    /// Mass matrix of the links M_l(q_l) [kg m²].
    ///
    /// # Errors
    /// For slices of a wrong length.
    fn mass_matrix(&self, q_l: &[C], mass: &mut [C]) -> Result<(), Mismatch>;

    /// `x` = M_l(q_l)⁻¹ `b`.
    ///
    /// # Errors
    /// For slices of a wrong length.
    fn solve_mass(&self, q_l: &[C], b: &[C], x: &mut [C]) -> Result<(), Mismatch>;

    /// What the links ask of their springs: M_l q̈_l + C q̇_l + g [N m], without link damping.
    ///
    /// # Errors
    /// For slices of a wrong length.
    fn inverse_dynamics(&self, q_l: &[C], dq_l: &[C], ddq_l: &[C], torque: &mut [C]) -> Result<(), Mismatch>;

    /// Accelerations [rad/s²] of links and motors (2n numbers) of a robot that moves as `motion` under motor torques `u_m`
    /// [N m].
    ///
    /// # Errors
    /// For slices of a wrong length.
    fn forward_dynamics(&self, motion: &[C], u_m: &[C], acceleration: &mut [C]) -> Result<(), Mismatch>;

    /// Torque on the links along a trajectory, M_l q̈_l + C q̇_l + g [N m], with its rate and half its second rate: three
    /// coefficients from five of the positions.
    ///
    /// # Errors
    /// For slices of a wrong length.
    fn torque_along(&self, q_l: &[[C; 5]], torque: &mut [[C; 3]]) -> Result<(), Mismatch>;

    /// The motor positions q_m (four coefficients) and motor torques u_m [N m] (two) under which the links follow a trajectory
    /// exactly, given with six coefficients.
    ///
    /// # Errors
    /// For slices of a wrong length.
    fn feed_forward(&self, q_l: &[[C; 6]], q_m: &mut [[C; 4]], u_m: &mut [[C; 2]]) -> Result<(), Mismatch>;

    /// Where the links go from here whatever the motors will do: position, velocity, half the acceleration and a sixth of the
    /// jerk.
    ///
    /// # Errors
    /// For slices of a wrong length.
    fn link_motion(&self, motion: &[C], series: &mut [[C; 4]]) -> Result<(), Mismatch>;

    /// Total energy in J: links and motors in motion, gravity and springs.
    ///
    /// # Errors
    /// For a slice of a wrong length.
    fn energy(&self, motion: &[C]) -> Result<C, Mismatch>;

    /// The matrices of the port-Hamiltonian form at link positions and velocities.
    ///
    /// # Errors
    /// For slices of a wrong length.
    fn matrices(&self, q_l: &[C], dq_l: &[C], matrices: PortHamiltonian<'_, C>) -> Result<(), Mismatch>;

    /// (q̇_l, q̇_m, ṗ_l, ṗ_m) under motor torques `u_m` [N m], with momenta p = M q̇ [kg m²/s]: 4n numbers.
    ///
    /// # Errors
    /// For slices of a wrong length.
    fn hamiltonian_rates(&self, motion: &[C], u_m: &[C], rates: &mut [C]) -> Result<(), Mismatch>;
}

/// Matrices of the links at a motion, n² numbers each, row by row.
#[derive(Debug)]
pub struct PortHamiltonian<'a, C> {
    /// Skew-symmetric S_l(q_l, q̇_l) [N m s/rad].
    pub skew: &'a mut [C],
    /// E_l = S_l − ½ Ṁ_l [N m s/rad].
    pub workless: &'a mut [C],
    /// Ṁ_l [kg m²/s].
    pub mass_rate: &'a mut [C],
}

impl Robot {
    /// The robot of the file in `f64`.
    ///
    /// # Errors
    /// If it has more than [`MAX_JOINTS`](crate::robot::MAX_JOINTS) joints.
    pub fn arm(&self) -> Result<Box<dyn Arm>, Problems> {
        Ok(sized!(self, L, N => hold::<f64, L<f64>, N>(fjr(self, &self.links, |x| x, &|x| x))))
    }

    /// The robot that the decimals of the file make, enclosed: every method on intervals encloses what it gives for each robot
    /// and each argument inside.
    ///
    /// # Errors
    /// If it has more than [`MAX_JOINTS`](crate::robot::MAX_JOINTS) joints.
    pub fn enclosed_arm(&self) -> Result<Box<dyn Arm<Interval>>, Problems> {
        let number = |x| self.bounds(x);
        Ok(sized!(roomy self, L, N => {
            hold::<Interval, L<Interval>, N>(fjr(self, &self.enclosed, number, &Interval::midpoint))
        }))
    }
}

/// Hides the size of `robot`, which is of the type that its own file asked for.
fn hold<C, L, const N: usize>(robot: Option<Fjr<C, L, N>>) -> Box<dyn Arm<C>>
where
    C: Over<C> + Send + Sync + 'static,
    L: FromFile<C, N> + Send + Sync + 'static,
{
    Box::new(Held(robot.expect(OF_THE_KIND)))
}

/// A robot of a size that is known to the compiler.
struct Held<C, L, const N: usize>(Fjr<C, L, N>);

impl<C, L, const N: usize> Arm<C> for Held<C, L, N>
where
    C: Over<C> + Send + Sync,
    L: Links<C, N> + Send + Sync,
{
    fn joints(&self) -> usize {
        self.0.links.joints()
    }

    fn mass_matrix(&self, q_l: &[C], mass: &mut [C]) -> Result<(), Mismatch> {
        let n = self.joints();
        check("mass", "n²", mass.len(), n * n)?;
        let M: Matrix<C, N, N> = self.0.links.mass_matrix(&read("q_l", q_l, n)?);
        write_rows(&M, n, mass);
        Ok(())
    }

    fn solve_mass(&self, q_l: &[C], b: &[C], x: &mut [C]) -> Result<(), Mismatch> {
        let n = self.joints();
        check("x", "n", x.len(), n)?;
        let (q_l, b): (Vector<C, N>, _) = (read("q_l", q_l, n)?, read("b", b, n)?);
        write(&self.0.links.factor(&q_l).solve(&b), x);
        Ok(())
    }

    fn inverse_dynamics(&self, q_l: &[C], dq_l: &[C], ddq_l: &[C], torque: &mut [C]) -> Result<(), Mismatch> {
        let n = self.joints();
        check("torque", "n", torque.len(), n)?;
        let (q, v, a): (Vector<C, N>, _, _) =
            (read("q_l", q_l, n)?, read("dq_l", dq_l, n)?, read("ddq_l", ddq_l, n)?);
        write(&self.0.links.inverse_dynamics(&q, &v, &v, &a), torque);
        Ok(())
    }

    fn forward_dynamics(&self, motion: &[C], u_m: &[C], acceleration: &mut [C]) -> Result<(), Mismatch> {
        let n = self.joints();
        check("acceleration", "2n", acceleration.len(), 2 * n)?;
        let (x, u_m): (Motion<C, N>, _) = (read_motion(motion, n)?, read("u_m", u_m, n)?);
        let (links, motors) = acceleration.split_at_mut(n);
        write(&self.0.link_acceleration(&x), links);
        write(&self.0.motor_acceleration(&x, &u_m), motors);
        Ok(())
    }

    fn torque_along(&self, q_l: &[[C; 5]], torque: &mut [[C; 3]]) -> Result<(), Mismatch> {
        let n = self.joints();
        check("torque", "n", torque.len(), n)?;
        let q_l: Vector<Jet<C, 5>, N> = read_rows("q_l", q_l, n)?;
        write(&self.0.links.torque_along::<C, 3, 5>(&q_l).map(coefficients), torque);
        Ok(())
    }

    fn feed_forward(&self, q_l: &[[C; 6]], q_m: &mut [[C; 4]], u_m: &mut [[C; 2]]) -> Result<(), Mismatch> {
        let n = self.joints();
        check("q_m", "n", q_m.len(), n)?;
        check("u_m", "n", u_m.len(), n)?;
        let q_l: Vector<Jet<C, 6>, N> = read_rows("q_l", q_l, n)?;
        let forward = self.0.inverse_dynamics::<C, 2, 4, 6>(&q_l);
        write(&forward.q_m.map(coefficients), q_m);
        write(&forward.u_m.map(coefficients), u_m);
        Ok(())
    }

    fn link_motion(&self, motion: &[C], series: &mut [[C; 4]]) -> Result<(), Mismatch> {
        let n = self.joints();
        check("series", "n", series.len(), n)?;
        let x: Motion<C, N> = read_motion(motion, n)?;
        write(&self.0.link_motion(&self.0.links.factor(&x.q_l), &x).map(coefficients), series);
        Ok(())
    }

    fn energy(&self, motion: &[C]) -> Result<C, Mismatch> {
        Ok(self.0.total_energy(&read_motion::<C, N>(motion, self.joints())?))
    }

    fn matrices(&self, q_l: &[C], dq_l: &[C], matrices: PortHamiltonian<'_, C>) -> Result<(), Mismatch> {
        let n = self.joints();
        let PortHamiltonian { skew, workless, mass_rate } = matrices;
        for (name, matrix) in [("skew", &skew), ("workless", &workless), ("mass_rate", &mass_rate)] {
            check(name, "n²", matrix.len(), n * n)?;
        }
        let (q, v): (Vector<C, N>, _) = (read("q_l", q_l, n)?, read("dq_l", dq_l, n)?);
        let found = LinkMatrices::new(&self.0.links, &q, &v);
        write_rows(&found.skew, n, skew);
        write_rows(&found.workless(), n, workless);
        write_rows(&found.mass_rate, n, mass_rate);
        Ok(())
    }

    fn hamiltonian_rates(&self, motion: &[C], u_m: &[C], rates: &mut [C]) -> Result<(), Mismatch> {
        let n = self.joints();
        check("rates", "4n", rates.len(), 4 * n)?;
        let (x, u_m): (Motion<C, N>, _) = (read_motion(motion, n)?, read("u_m", u_m, n)?);
        let found = self.0.workless_dynamics(&self.0.state(&x), &u_m);
        for (part, slot) in [found.q_l, found.q_m, found.p_l, found.p_m].iter().zip(rates.chunks_exact_mut(n))
        {
            write(part, slot);
        }
        Ok(())
    }
}

/// The coefficients of a series.
fn coefficients<C: Scalar, const K: usize>(series: Jet<C, K>) -> [C; K] {
    std::array::from_fn(|k| series.coefficient(k))
}
