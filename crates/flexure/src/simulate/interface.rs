//! A control loop with its joint count hidden: what programs hold that are not Rust, or not generic.

use flexure_core::memory::Unfit;

use crate::robot::Mismatch;
use crate::simulate::fault_log::FaultLog;
use crate::simulate::simulation::Divergence;

/// A closed loop that a caller holds and moves, made from a scenario by [`Scenario::open`](crate::scenario::Scenario::open).
///
/// Vectors have one number per joint, n = [`joints`](Self::joints), in the order of the robot file; a *motion* is
/// (q_l, q_m, q̇_l, q̇_m), 4n numbers. Positions in rad, velocities in rad/s, torques in N m; for prismatic joints read m for rad
/// and N for N m. Motors are seen from the link side of the gear.
///
/// A loop moves from one control instant to the next. At an instant the sensors read the motion, and what is between them and
/// the motors gives the torque that acts until the next one. Control steps allocate nothing.
///
/// ```
/// let mut held = flexure::Scenario::load("pendulum-tanh")?.open()?;
/// held.step()?; // the instant at t = 0
/// let saved = held.state();
/// held.step()?;
/// let mut first = vec![0.0; held.signals().len()];
/// held.read(&mut first)?;
///
/// held.restore(&saved)?;
/// held.step()?;
/// let mut again = first.clone();
/// held.read(&mut again)?;
/// assert_eq!(first, again);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Loop: Send + Sync {
    /// Number of joints n.
    fn joints(&self) -> usize;

    /// Time between two control instants in s.
    fn period(&self) -> f64;

    /// What the law alone asks of the motors at the time `t` in s: `u_m`, n numbers, for one motion, or many of both, one after
    /// the other. It sees the motion as it is and follows the reference of the scenario; no device stands in between and
    /// nothing is remembered. Several motions go through v-CBC laws in SIMD lanes: what one of them gives differs from that of a call
    /// with it alone in the last digits of sines and tanh ([`Lanes`](flexure_core::scalar::Lanes)), but not with its neighbours.
    ///
    /// # Errors
    /// If `motions` is not a multiple of 4n long, or `u_m` does not have n numbers for each.
    fn torque(&self, t: f64, motions: &[f64], u_m: &mut [f64]) -> Result<(), Mismatch>;

    /// What the law wants at the time `t` in s of a robot that moves as `motion`.
    ///
    /// # Errors
    /// If `motion` does not have 4n numbers.
    fn command(&self, t: f64, motion: &[f64]) -> Result<Commanded, Mismatch>;

    /// Taylor coefficients in time of the reference at `t` in s, from the position to a 24th of the fourth derivative: one array
    /// per joint.
    ///
    /// # Errors
    /// If `series` does not have n entries.
    fn reference(&self, t: f64, series: &mut [[f64; 5]]) -> Result<(), Mismatch>;

    /// Rate of `motion`, (q̇_l, q̇_m, q̈_l, q̈_m), of the simulated robot at the time `t` in s when its motors give `u_m`: model
    /// errors, rotor coupling, springs that are not linear and pushes included, without dry friction and hysteresis, which are
    /// no functions of the motion.
    ///
    /// # Errors
    /// For slices of a wrong length.
    fn derivative(&self, t: f64, motion: &[f64], u_m: &[f64], rate: &mut [f64]) -> Result<(), Mismatch>;

    /// What loads the links of the simulated robot at the time `t` in s when it moves as `motion`, beside gravity, friction and damping: the
    /// torque of the springs, without what hysteresis adds, which is no function of the motion, and that of pushes [N m].
    ///
    /// # Errors
    /// For slices of a wrong length.
    fn loads(&self, t: f64, motion: &[f64], spring: &mut [f64], external: &mut [f64])
    -> Result<(), Mismatch>;

    /// Moves on to the next control instant, the first at t = 0, and does what the controller does there. There is no end: the
    /// duration of the scenario is that of its runs.
    ///
    /// # Errors
    /// If the loop diverged, now or before; what can be read is then the last good instant.
    fn step(&mut self) -> Result<(), Divergence>;

    /// What can be [read](Self::read) at an instant: the columns of the trace of a run.
    fn signals(&self) -> &[Signal];

    /// The values of the [signals](Self::signals) at the last instant; NaN before the first.
    ///
    /// # Errors
    /// If `values` does not have one entry per signal.
    fn read(&self, values: &mut [f64]) -> Result<(), Mismatch>;

    /// What runs are judged by at the last instant, into `instant`, made by [`Observed::new`] for as many joints: cheaper than
    /// [`read`](Self::read). Nothing is written before the first instant.
    ///
    /// # Errors
    /// If `instant` was made for another number of joints.
    fn observe(&self, instant: &mut Observed) -> Result<(), Mismatch>;

    /// What the guard kept of the stops so far; none without a guard.
    fn faults(&self) -> Option<FaultLog>;

    /// Integration steps so far.
    fn steps(&self) -> u64;

    /// |H(t) − H(0) − supplied + dissipated|, its largest value so far, relative to the energy that went through the robot.
    fn energy_drift(&self) -> f64;

    /// Everything that the loop remembers, as numbers: motion and time, the last instant, estimators, guard, sensors, drive,
    /// their random numbers, integrator and energy balance. It changes nothing; it is `&mut` because saving and restoring are one
    /// walk.
    fn state(&mut self) -> Vec<f64>;

    /// Name and unit of each number of the [state](Self::state).
    fn state_names(&mut self) -> Vec<Signal>;

    /// Goes on from a [state](Self::state) of this loop, or of another one opened from the same scenario.
    ///
    /// # Errors
    /// If `state` does not have as many numbers, or one that must be whole is not; nothing has changed then.
    fn restore(&mut self, state: &[f64]) -> Result<(), Unfit>;

    /// Goes back to before the first instant, with other random numbers.
    fn reset(&mut self, seed: u64);
}

/// A number that can be read, by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signal {
    /// Name, valid as a pandas column and as a MATLAB variable: `t`, `q_l1`, `e_l2`, `u_m1`, `hamiltonian`, …
    pub name: String,
    /// SI unit as plain text (`rad`, `N m`, `kg m^2/s`, `J`), empty for none.
    pub unit: &'static str,
}

/// Where `prefix1`, `prefix2`, … are, a vector signal with one number per joint.
pub(crate) fn of_joints(signals: &[Signal], prefix: &str) -> Vec<usize> {
    let place = |name: String| signals.iter().position(|signal| signal.name == name);
    (1..).map_while(|joint| place(format!("{prefix}{joint}"))).collect()
}

/// What a law wants of a robot, a number per joint each.
#[derive(Clone, Debug, PartialEq)]
pub struct Commanded {
    /// Motor torque [N m].
    pub u_m: Vec<f64>,
    /// Link position error q_l − q_ld in rad.
    pub e_l: Vec<f64>,
    /// Total energy of the robot that the law knows, in J.
    pub energy: f64,
    /// What only v-CBC computes on the way.
    pub errors: Option<Errors>,
}

/// What the v-CBC law computes on the way to its torque, a number per joint each.
#[derive(Clone, Debug, PartialEq)]
pub struct Errors {
    /// Link torque that the springs should give [N m].
    pub u_l: Vec<f64>,
    /// Motor position that would give it, in rad.
    pub q_md: Vec<f64>,
    /// Motor position error in rad.
    pub e_m: Vec<f64>,
    /// Link velocity error [rad/s].
    pub s_l: Vec<f64>,
    /// Motor velocity error [rad/s].
    pub s_m: Vec<f64>,
    /// Link momentum error [kg m²/s].
    pub sigma_l: Vec<f64>,
    /// Motor momentum error [kg m²/s].
    pub sigma_m: Vec<f64>,
}

/// What runs are judged by at an instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Observed {
    /// Time in s.
    pub t: f64,
    /// True motion, 4n numbers [rad, rad/s].
    pub motion: Vec<f64>,
    /// Where the links shall be by the scenario in rad, n numbers.
    pub reference: Vec<f64>,
    /// The reference that the law follows in rad, n numbers: the same, but after a stop of the guard, until that is joined again.
    pub followed: Vec<f64>,
    /// Torque that leaves the controller [N m], n numbers.
    pub command: Vec<f64>,
    /// Torque of the motors at the end of the period [N m], n numbers.
    pub applied: Vec<f64>,
    /// Whether a certificate of the law can hold: the motors give what the law asks, over the whole period, and no guard limits
    /// or stops.
    pub certificate: bool,
    /// Whether the guard has stopped the robot.
    pub stopped: bool,
}

impl Observed {
    /// For a loop of `n` joints; nothing observed yet.
    pub fn new(n: usize) -> Self {
        let zeros = |count: usize| vec![0.0; count];
        Self {
            t: 0.0,
            motion: zeros(4 * n),
            reference: zeros(n),
            followed: zeros(n),
            command: zeros(n),
            applied: zeros(n),
            certificate: true,
            stopped: false,
        }
    }
}
