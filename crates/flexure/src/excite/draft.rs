//! A motion while it is designed, joint by joint, and the scenario file that it becomes.

use std::f64::consts::TAU;
use std::fmt::Write;

use crate::excite::design::weights;
use crate::excite::information::{self, Logged, Noise};
use crate::excite::joint::Joint;
use crate::excite::lines::{Allowed, Line, harmonics, shares};
use crate::excite::phases::{Harmonic, peak, phases, signs};
use crate::excite::{JointMotion, MARGIN, Settings};
use crate::feasible::Usage;
use crate::files::suggest;
use crate::files::{Problem, Problems};
use crate::linalg::Complex;
use crate::robot::Robot;

/// How the files begin that hold a motion.
pub(super) const MARK: &str = "# Identification motion of";

/// Part of the run in which the robot joins the motion.
const JOINING: f64 = 0.1;

/// Periods of the motion.
const PERIODS: f64 = 2.0;

/// Largest amplitude of a link about its posture \[rad\], and part of half its range.
const REACH: (f64, f64) = (0.5, 0.5);

/// Part of the power that goes into the slowest lines, for friction: where joints move far and turn around.
const SLOW: f64 = 0.3;

/// Part that all lines share: what the model does not foresee shows where nothing is zero.
const EVEN: f64 = 0.1;

/// How many lines those are.
const SLOW_LINES: usize = 2;

/// Fewest lines that tell four parameters and friction apart.
const FEWEST: usize = 4;

/// The real stiffness over the assumed one, in the cases that the design is for.
const CASES: [f64; 3] = [0.6, 1.0, 1.6];

/// Noise of the logged torque, over the torque limit: assumed.
const TORQUE_NOISE: f64 = 1e-3;

/// Part of the torque limit that must be left beside the weight.
const FREE: f64 = 0.1;

/// What a joint is made smaller by beyond need, and the least that it is made smaller to at a time.
const SAFE: f64 = 0.98;
const LEAST: f64 = 0.3;

/// What a joint does.
struct Course {
    name: String,
    joint: Joint,
    noise: Noise,
    harmonics: Vec<Harmonic>,
    phases: Vec<f64>,
    /// Shares of torque and deflection limit that the weight takes.
    weight: [f64; 2],
}

/// A motion of all joints.
pub(super) struct Plan<'a> {
    robot: &'a Robot,
    settings: &'a Settings,
    joining: f64,
    period: f64,
    posture: Vec<f64>,
    /// Motor positions at rest there \[rad\].
    motors: Vec<f64>,
    courses: Vec<Course>,
}

impl<'a> Plan<'a> {
    /// The best motion of each joint alone.
    pub fn new(robot: &'a Robot, settings: &'a Settings) -> Result<Self, Problems> {
        let n = robot.joint_count();
        let arm = robot.arm()?;
        let middle = || {
            let limits = robot.limits.lower.iter().zip(&robot.limits.upper);
            limits.map(|(lower, upper)| between(*lower, *upper)).collect()
        };
        let posture = settings.posture.clone().unwrap_or_else(middle);
        let still = vec![0.0; n];
        let (mut mass, mut weight) = (vec![0.0; n * n], vec![0.0; n]);
        arm.mass_matrix(&posture, &mut mass).expect("n joints");
        arm.inverse_dynamics(&posture, &still, &still, &mut weight).expect("n joints");
        let whole = |time: f64| (time / settings.control_period).round() * settings.control_period;
        let joining = whole(JOINING * settings.duration);
        let period = whole((settings.duration - joining) / PERIODS);
        let motors = (0..n).map(|i| posture[i] + weight[i] / robot.stiffness[i]).collect();
        let mut plan = Self { robot, settings, joining, period, posture, motors, courses: Vec::new() };
        for (i, weight) in weight.iter().enumerate() {
            let course = plan.course(i, mass[i * (n + 1)], *weight)?;
            plan.courses.push(course);
        }
        Ok(plan)
    }

    /// The motion of joint `i`, which moves `link_inertia` and carries `weight`, with the others held.
    fn course(&self, i: usize, link_inertia: f64, weight: f64) -> Result<Course, Problem> {
        let (robot, settings) = (self.robot, self.settings);
        let name = robot.joints[i].name.clone();
        let limit = robot.limits.torque[i];
        let torque = MARGIN * limit - weight.abs();
        if torque < FREE * limit {
            let message = format!(
                "joint {name}: its weight takes {:.3} N m of a torque_limit of {limit} N m: too little is left for a motion",
                weight.abs()
            );
            let help = "another --posture, as one that hangs, may take less; or is the torque limit that of the motor without its gear?";
            return Err(robot.places.problem("joints", "limits", message, help));
        }
        let joint = Joint {
            link_inertia,
            motor_inertia: robot.motor_inertia[i],
            stiffness: robot.stiffness[i],
            link_damping: robot.link_damping[i],
            motor_damping: robot.motor_damping[i],
        };
        let bent = weight.abs() / robot.stiffness[i];
        let range = (robot.limits.upper[i] - self.posture[i]).min(self.posture[i] - robot.limits.lower[i]);
        let allowed = Allowed {
            position: (REACH.1 * range).min(REACH.0),
            velocity: MARGIN * robot.limits.velocity[i],
            torque,
            deflection: (MARGIN * robot.limits.deflection[i] - bent).max(1e-3 * bent),
        };
        let numbers = harmonics(&joint, i, robot.joint_count(), self.period, settings.control_period);
        if numbers.len() < FEWEST {
            let message = format!(
                "joint {name}: a period of {:.3} s has {} lines for it up to its swing, must be at least {FEWEST}",
                self.period,
                numbers.len()
            );
            return Err(Problem::new("range", message, "a longer --duration has more of them"));
        }
        let variance = |step: f64| 12.0 / (step * step);
        let noise = Noise {
            precision: [settings.link_resolution.map_or(0.0, variance), variance(settings.motor_resolution)],
            torque: (TORQUE_NOISE * limit).powi(2),
            samples: PERIODS * self.period / settings.control_period,
        };
        let mut harmonics = self.shared(&joint, &allowed, &numbers, &noise);
        let phases = phases(&harmonics, settings.budget, settings.seed, i as u64);
        let highest = peak(&harmonics, &phases);
        for line in &mut harmonics {
            line.amplitude /= highest;
        }
        let weight = [weight.abs() / limit, bent / robot.limits.deflection[i]];
        Ok(Course { name, joint, noise, harmonics, phases, weight })
    }

    /// Lines with the amplitudes that tell most, in all in proportion.
    fn shared(&self, joint: &Joint, allowed: &Allowed, numbers: &[usize], noise: &Noise) -> Vec<Harmonic> {
        let omega = |number: usize| TAU * number as f64 / self.period;
        let lines: Vec<_> =
            numbers.iter().map(|number| (*number, shares(joint, allowed, omega(*number)))).collect();
        let cost =
            |shares: &[Complex; 4]| shares.iter().fold(0.0, |cost: f64, share| cost.max(share.abs())).powi(2);
        let case = |factor: f64| {
            let real = Joint { stiffness: factor * joint.stiffness, ..*joint };
            let line = |(number, shares): &(usize, [Complex; 4])| {
                information::of_line(&real, joint, omega(*number), noise).scaled(cost(shares).recip())
            };
            lines.iter().map(line).collect::<Vec<_>>()
        };
        let best = weights(&CASES.map(case));
        let slow = |k: usize| if k < SLOW_LINES { SLOW / SLOW_LINES as f64 } else { 0.0 };
        let harmonic = |(k, ((number, shares), weight)): (usize, ((usize, [Complex; 4]), f64))| {
            let power = (1.0 - SLOW - EVEN) * weight + slow(k) + EVEN / numbers.len() as f64;
            Harmonic { number, amplitude: (power / cost(&shares)).sqrt(), shares }
        };
        lines.into_iter().zip(best).enumerate().map(harmonic).collect()
    }

    /// The robot that moves.
    pub fn robot(&self) -> &Robot {
        self.robot
    }

    /// Number of joints.
    pub fn joint_count(&self) -> usize {
        self.courses.len()
    }

    /// Period of the motion \[s\].
    pub fn period(&self) -> f64 {
        self.period
    }

    /// How much smaller each joint must be, 1 for one that keeps its limits by `usage`.
    pub fn factors(&self, usage: &[Usage]) -> Vec<f64> {
        let mut factors = vec![1.0; self.courses.len()];
        for usage in usage.iter().filter(|usage| usage.share > allowed_share(usage.key)) {
            let course = &self.courses[usage.joint];
            let rest = match usage.key {
                "torque_limit" => course.weight[0],
                "deflection_limit" => course.weight[1],
                _ => 0.0,
            };
            let fits = SAFE * (allowed_share(usage.key) - rest) / (usage.share - rest);
            let factor: &mut f64 = &mut factors[usage.joint];
            *factor = factor.min(if fits.is_finite() { fits.clamp(LEAST, SAFE) } else { LEAST });
        }
        factors
    }

    /// Makes each joint smaller by its factor.
    pub fn scale(&mut self, factors: &[f64]) {
        for (course, factor) in self.courses.iter_mut().zip(factors) {
            for line in &mut course.harmonics {
                line.amplitude *= factor;
            }
        }
    }

    /// What each joint does, and what a log of it would tell.
    pub fn joints(&self) -> Vec<JointMotion> {
        self.courses.iter().map(|course| self.motion(course)).collect()
    }

    fn motion(&self, course: &Course) -> JointMotion {
        let Course { name, joint, noise, harmonics, phases, .. } = course;
        let omega = |line: &Harmonic| TAU * line.number as f64 / self.period;
        let motor = |line: &Harmonic| {
            let [link, motor] = joint.gains(omega(line));
            motor / link
        };
        let signs = signs(harmonics, phases, &harmonics.iter().map(motor).collect::<Vec<_>>());
        let logged: Vec<_> = harmonics
            .iter()
            .zip(phases)
            .zip(signs)
            .map(|((line, phase), sign)| {
                let amplitude = Complex { re: phase.cos(), im: phase.sin() }.scaled(line.amplitude);
                Logged { omega: omega(line), amplitude, sign }
            })
            .collect();
        let line = |(line, phase): (&Harmonic, &f64)| Line {
            frequency: line.number as f64 / self.period,
            amplitude: line.amplitude,
            phase: *phase,
        };
        JointMotion {
            name: name.clone(),
            resonance: joint.resonance() / TAU,
            lines: harmonics.iter().zip(phases).map(line).collect(),
            crest_share: peak(harmonics, phases),
            error_bars: information::error_bars(joint, &logged, noise),
        }
    }

    /// The scenario file; it calls the robot `path`.
    pub fn toml(&self, path: &str) -> String {
        let Settings { control_period, link_resolution, motor_resolution, .. } = self.settings;
        let duration = self.joining + PERIODS * self.period;
        let mut toml = format!(
            "{MARK} {}: {} s to join it, then {PERIODS} periods of {} s.\n\n\
             robot = {}\nduration = {duration}  # s\ncontrol_period = {control_period}  # s\n\n\
             [initial]  # at rest, the springs carry the links\nq_l = {}\nq_m = {}\n\n\
             [reference]  # rad, rad/s\nkind = \"multisine\"\noffset = {}\n",
            self.robot.name,
            self.joining,
            self.period,
            suggest::text(path),
            array(&self.posture),
            array(&self.motors),
            array(&self.posture)
        );
        let most = self.courses.iter().map(|course| course.harmonics.len()).max().unwrap_or(0);
        for k in 0..most {
            let of = |number: &dyn Fn(&Harmonic, f64) -> f64| {
                let joint = |course: &Course| {
                    course.harmonics.get(k).map_or(0.0, |line| number(line, course.phases[k]))
                };
                array(&self.courses.iter().map(joint).collect::<Vec<_>>())
            };
            let _ = write!(
                toml,
                "\n[[reference.term]]\namplitude = {}\nfrequency = {}\nphase = {}\n",
                of(&|line, _| line.amplitude),
                of(&|line, _| TAU * line.number as f64 / self.period),
                of(&|_, phase| phase)
            );
        }
        let _ = write!(
            toml,
            "\n[reference.smooth_start]\nduration = {}  # s\n\n[controller]\nkind = \"vcbc\"  # with starting gains\n\n",
            self.joining
        );
        let encoder = |side: &str, step: f64| {
            format!(
                "[[imperfection]]\nkind = \"encoder\"\nplacement = \"{side}\"\nresolution = {step}  # rad\n\n"
            )
        };
        toml.push_str(&link_resolution.map_or(String::new(), |step| encoder("link", step)));
        toml.push_str(&encoder("motor", *motor_resolution));
        let _ = write!(
            toml,
            "[estimator]\nkind = \"observer\"\nencoders = \"{}\"\nbandwidth = {}  # rad/s\n",
            if link_resolution.is_some() { "both" } else { "motor" },
            OBSERVER / control_period
        );
        toml.push_str("\n[sources]\nreference = \"designed for the largest Fisher information inside the limits of the robot\"\n");
        toml
    }
}

/// Bandwidth of the observer over the rate of control.
const OBSERVER: f64 = 0.3;

/// Part of a limit that the whole arm may use.
fn allowed_share(key: &str) -> f64 {
    if key.starts_with("position") { 1.0 } else { MARGIN }
}

/// The middle of a range; within an open one what is nearest to 0.
fn between(lower: f64, upper: f64) -> f64 {
    let middle = 0.5 * (lower + upper);
    let found = if middle.is_finite() { middle } else { 0.0_f64.clamp(lower + REACH.0, upper - REACH.0) };
    // Where two limits are closer than that.
    (1e6 * found.clamp(lower, upper)).round() / 1e6
}

/// Numbers as an array of TOML, in full; what rounding leaves of zero is zero.
fn array(numbers: &[f64]) -> String {
    let number = |x: f64| if x.abs() < 1e-15 { 0.0 } else { x };
    let numbers: Vec<String> = numbers.iter().map(|x| format!("{:?}", number(*x))).collect();
    format!("[{}]", numbers.join(", "))
}

#[cfg(test)]
mod tests {
    use super::array;

    /// Weights that cancel leave sums that no file may hold: magnitudes below 1e-30.
    #[test]
    fn what_rounding_leaves_of_zero_is_zero() {
        assert_eq!(array(&[-3.9e-31, 0.0, -0.5]), "[0.0, 0.0, -0.5]");
    }
}
