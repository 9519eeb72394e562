//! How the errors of a run move, and the storage W in them.

use std::ops::ControlFlow;

use crate::files::Problems;
use crate::progress::Progress;
use crate::prove::along::start_level;
use crate::report::draw::decimate::Thinned;
use crate::report::draw::path::Path;
use crate::scenario::Scenario;
use crate::simulate::{Loop, Signal, Sink, of_joints, run_into};

/// Points of W over time, about.
const POINTS: usize = 1 << 14;

/// The errors of a run of the v-CBC law.
pub(crate) struct ErrorPath {
    law: Box<dyn Loop>,
    metrics: [Vec<f64>; 2],
    /// Columns of the time and of the motion.
    time: Option<usize>,
    motion: Vec<usize>,
    storage: Thinned,
    /// Position errors of each joint, e_l and e_m \[rad\].
    errors: Vec<Path>,
    /// e_l over time.
    links: Vec<Thinned>,
}

impl ErrorPath {
    /// Runs `scenario` as its file says. The errors are those of the true state, whatever the law knows of it.
    ///
    /// # Errors
    /// If W is not defined or jumps ([`start_level`]), as [`run_into`], and [`Problems::interrupted`] if `progress` breaks the run off.
    pub(crate) fn of(scenario: &Scenario, progress: Progress<'_>) -> Result<Self, Problems> {
        start_level(scenario)?;
        let signals = scenario.signals()?;
        let mut path = Self::new(scenario, &signals)?;
        let run = run_into(scenario, &mut [&mut path], progress)?;
        if run.broken_off.is_some() { Err(Problems::interrupted()) } else { Ok(path) }
    }

    fn new(scenario: &Scenario, signals: &[Signal]) -> Result<Self, Problems> {
        let gains = scenario.vcbc()?;
        let motion = ["q_l", "q_m", "dq_l", "dq_m"];
        Ok(Self {
            law: scenario.open()?,
            metrics: [gains.link.metric.clone(), gains.motor.metric.clone()],
            time: signals.iter().position(|signal| signal.name == "t"),
            motion: motion.iter().flat_map(|name| of_joints(signals, name)).collect(),
            storage: Thinned::new(POINTS),
            errors: vec![Path::new(); scenario.robot.joint_count()],
            links: vec![Thinned::new(POINTS); scenario.robot.joint_count()],
        })
    }

    /// W = ½ (e_lᵀ Π_l e_l + e_mᵀ Π_m e_m + σ_lᵀ s_l + σ_mᵀ s_m) over time, \[s\] and in J.
    pub(crate) fn storage(&self) -> (Vec<f64>, Vec<f64>) {
        self.storage.points().into_iter().unzip()
    }

    /// The position error of a joint's link over time, \[s\] and \[rad\].
    pub(crate) fn of_link(&self, joint: usize) -> (Vec<f64>, Vec<f64>) {
        self.links.get(joint).map(Thinned::points).unwrap_or_default().into_iter().unzip()
    }

    /// The position errors of a joint's link and of its motor \[rad\].
    pub(crate) fn of_joint(&self, joint: usize) -> (Vec<f64>, Vec<f64>) {
        self.errors
            .get(joint)
            .map(Path::points)
            .unwrap_or_default()
            .into_iter()
            .map(|[e_l, e_m]| (e_l, e_m))
            .unzip()
    }
}

impl Sink for ErrorPath {
    fn take(&mut self, row: &[f64]) -> ControlFlow<()> {
        let motion: Vec<f64> = self.motion.iter().map(|&column| row[column]).collect();
        let t = self.time.map_or(f64::NAN, |column| row[column]);
        let commanded = self.law.command(t, &motion).ok();
        let Some((e_l, errors)) = commanded.and_then(|commanded| Some((commanded.e_l, commanded.errors?)))
        else {
            self.storage.push(t, f64::NAN);
            return ControlFlow::Continue(());
        };
        let form =
            |metric: &[f64], e: &[f64]| metric.iter().zip(e).map(|(metric, e)| metric * e * e).sum::<f64>();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let [link, motor] = &self.metrics;
        let positions = form(link, &e_l) + form(motor, &errors.e_m);
        let momenta = dot(&errors.sigma_l, &errors.s_l) + dot(&errors.sigma_m, &errors.s_m);
        self.storage.push(t, 0.5 * (positions + momenta));
        for (path, errors) in self.errors.iter_mut().zip(e_l.iter().zip(&errors.e_m)) {
            path.push([*errors.0, *errors.1]);
        }
        self.links.iter_mut().zip(&e_l).for_each(|(link, &error)| link.push(t, error));
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::ErrorPath;
    use crate::progress::unwatched;
    use crate::prove::along::start_level;
    use crate::prove::question::{Question, prove};
    use crate::scenario::{Hold, load_scenario};

    /// The bound over intervals holds W, and the law in continuous time shrinks it as is proved, at every instant of the run: that is the
    /// theorem, and the sum above has nothing of its proof.
    #[test]
    fn storage_shrinks_as_is_proved() {
        let mut scenario = load_scenario("two-link-tanh").unwrap();
        scenario.hold = Hold::Continuous;
        let path = ErrorPath::of(&scenario, &unwatched).unwrap();
        let (t, storage) = path.storage();
        let bound = start_level(&scenario).unwrap();
        // The bound is of the same numbers rounded outwards: no more than rounding above.
        assert!(storage[0] <= bound && storage[0] > 0.999_999 * bound, "{} {bound}", storage[0]);
        let proof = prove(&scenario, &Question::default()).unwrap();
        let rate = proof.verdict.proved().unwrap().convergence_rate.approximate();
        let decays = |factor: f64| {
            // Below 1e-12 of the start the integrator's tolerance is what is left.
            let mut above = t.iter().zip(&storage).filter(|(_, w)| **w > 1e-12 * storage[0]);
            above.all(|(t, w)| *w <= storage[0] * (-2.0 * factor * rate * t).exp() * (1.0 + 1e-9))
        };
        assert!(decays(1.0));
        assert!(!decays(20.0), "a rate that nobody proved");
        let (e_l, e_m) = path.of_joint(1);
        assert_eq!(e_l.len(), e_m.len());
        assert!(e_l.len() > 100);
    }
}
