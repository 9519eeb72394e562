//! Works that go on in time, a millisecond each: plants under given torques, and whole loops.

use std::error::Error;

use flexure::Scenario;
use flexure::plant::Plant;
use flexure::scenario::Integration;
use flexure::simulate::{Batch, Ledger, Loop, Observed, Stepper, Stepping, TOLERANCE};
use flexure_core::linalg::Vector;
use flexure_core::model::{self, Fjr, Links};

use crate::model::{panda, two_link};

/// Milliseconds of a loop that are timed at once.
const PASS: usize = 20;
/// Milliseconds after which motions are compared; those of a plant that are timed at once, because its first ones from rest take twice the time.
pub const SECOND: usize = 1000;

/// Goes on for so many milliseconds.
pub struct Motion {
    on: Box<dyn FnMut(usize) -> Reached>,
    /// How many robots move.
    pub robots: usize,
    /// Periods that are timed at once.
    pub pass: usize,
}

/// Where the motion is then.
type Reached = Result<Vec<f64>, Box<dyn Error>>;

impl Motion {
    fn of_one(pass: usize, on: impl FnMut(usize) -> Reached + 'static) -> Self {
        Self { on: Box::new(on), robots: 1, pass }
    }

    /// Where the motion is after `periods` of a millisecond.
    pub fn run(&mut self, periods: usize) -> Reached {
        (self.on)(periods)
    }
}

/// The work `name`, if it is one of these.
pub fn motion(name: &str) -> Result<Option<Motion>, Box<dyn Error>> {
    let (kind, method) = name.split_once('-').unwrap_or((name, ""));
    Ok(Some(match kind {
        "plant2" => plant(two_link()?, method, Vector::ZERO, &TWO_LINK)?,
        "plant7" => plant(panda()?, method, Vector([0.0, -0.6, 0.0, -1.8, 0.0, 1.5, 0.5]), &PANDA)?,
        "loop2" => closed(&scenario("two-link-tanh-smooth", method)?)?,
        "loop7" => closed(&scenario("panda-tanh-smooth", method)?)?,
        "loop" => closed(&scenario(method, "")?)?,
        "batch2" => batch(&scenario("two-link-tanh-smooth", method)?)?,
        "batch7" => batch(&scenario("panda-tanh-smooth", method)?)?,
        _ => return Ok(None),
    }))
}

/// The motor torque, held for a millisecond: at t, hold + `amplitude` sin(8 t + i) − `stiffness` (q_m − q_m0). `mujoco.c` has it too.
struct Drive {
    amplitude: f64,
    stiffness: f64,
}

const TWO_LINK: Drive = Drive { amplitude: 3.0, stiffness: 0.5 };
const PANDA: Drive = Drive { amplitude: 20.0, stiffness: 200.0 };

/// From rest, hanging in the springs. Methods: what runs use, the same with a tolerance, a tight reference, midpoint steps of a millisecond.
fn plant<L, const N: usize>(
    robot: Fjr<f64, L, N>,
    method: &str,
    q_l: Vector<f64, N>,
    drive: &'static Drive,
) -> Result<Motion, Box<dyn Error>>
where
    L: Links<f64, N> + Copy + 'static,
{
    let plant = Plant::from(robot);
    let hold = robot.links.gravity_torque(&q_l);
    let start = model::Motion { q_m: robot.motors_at_rest(&q_l), ..model::Motion::at_rest(q_l) };
    let by = match method {
        "midpoint" => Integration::Midpoint,
        "tight" => Integration::Collocation { tolerance: 1e-15 },
        "" => Integration::Collocation { tolerance: TOLERANCE },
        tolerance => Integration::Collocation { tolerance: tolerance.parse()? },
    };
    let fresh = Stepper::new(&plant, by, Stepping::<N>::STEP);
    let pieces: u32 = if method == "tight" { 10 } else { 1 };
    Ok(Motion::of_one(SECOND, move |periods| {
        let (mut x, mut stepper, mut ledger) = (start, fresh.clone(), Ledger::default());
        for period in 0..periods {
            let t = 1e-3 * period as f64;
            let u_m = Vector::from_fn(|i| {
                hold[i] + drive.amplitude * (8.0 * t + i as f64).sin()
                    - drive.stiffness * (x.q_m[i] - start.q_m[i])
            });
            let length = 1e-3 / f64::from(pieces);
            for _ in 0..pieces {
                x = stepper
                    .advance(&plant, x, t, length, &|_, _: &_| u_m, &mut ledger)
                    .map_err(|failure| format!("{failure:?}"))?;
            }
        }
        Ok([x.q_l.0, x.q_m.0].concat())
    }))
}

/// Periods before those that are timed: by then the arms have joined their references.
const JOINED: usize = 3000;

/// A scenario whose plant is moved as runs do it, tightly, or by the midpoint rule.
fn scenario(name: &str, method: &str) -> Result<Scenario, Box<dyn Error>> {
    let mut scenario = Scenario::load(name)?;
    match method {
        "" => {}
        "tight" => scenario.integration = Integration::Collocation { tolerance: 1e-13 },
        "midpoint" => scenario.integration = Integration::Midpoint,
        _ => return Err(format!("no method {method}").into()),
    }
    Ok(scenario)
}

/// The loop of a scenario, as programs hold it; its periods, a millisecond or not.
fn closed(scenario: &Scenario) -> Result<Motion, Box<dyn Error>> {
    let mut held: Box<dyn Loop> = scenario.open()?;
    for _ in 0..JOINED {
        held.step()?;
    }
    let start = held.state();
    Ok(Motion::of_one(PASS, move |periods| {
        held.restore(&start)?;
        for _ in 0..periods {
            held.step()?;
        }
        positions(&*held)
    }))
}

/// Where links and motors are.
fn positions(held: &dyn Loop) -> Reached {
    let mut observed = Observed::new(held.joints());
    held.observe(&mut observed)?;
    observed.motion.truncate(2 * held.joints());
    Ok(observed.motion)
}

/// Loops that are moved together in [`batch`].
const LOOPS: usize = 16;

/// Many loops of a scenario, side by side in the registers of one core; periods go on and on.
fn batch(scenario: &Scenario) -> Result<Motion, Box<dyn Error>> {
    let mut batch = Batch::open(&[scenario; LOOPS])?;
    batch.steps(JOINED);
    let on = move |periods| {
        batch.steps(periods);
        match (0..LOOPS).find_map(|place| batch.divergence(place)) {
            Some(divergence) => Err(divergence.into()),
            None => positions(batch.held(0)),
        }
    };
    Ok(Motion { on: Box::new(on), robots: LOOPS, pass: PASS })
}
