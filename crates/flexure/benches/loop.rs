//! What the parts of a simulated control loop cost: `cargo bench --bench loop`.

use divan::Bencher;

fn main() {
    divan::main();
}

/// One control period of a robot with every imperfection of the plant: friction on both sides, hardening, play, hysteresis.
mod rough_plant {
    use super::Bencher;

    use flexure::plant::{Friction, Hysteresis, Plant};
    use flexure::robot::{self, load_robot};
    use flexure::scenario::Integration;
    use flexure::simulate::{Ledger, Stepper, Stepping};
    use flexure_core::linalg::Vector;
    use flexure_core::model::Fjr;
    use flexure_core::model::Links;
    use flexure_core::model::Motion;
    use flexure_core::robots::{PlanarTwoLink, Tree};

    fn period<L: Links<f64, N>, const N: usize>(bencher: Bencher, robot: Fjr<f64, L, N>, seconds: f64) {
        let friction = |torque: f64| Friction {
            coulomb: Vector([torque; N]),
            stiction: Vector([1.5 * torque; N]),
            stribeck_velocity: Vector([0.05; N]),
        };
        let plant = Plant {
            spring_hardening: robot.stiffness.scaled(10.0),
            spring_gap: Vector([0.002; N]),
            hysteresis: Hysteresis { stiffness: robot.stiffness.scaled(0.5), yield_torque: Vector([0.1; N]) },
            link_friction: friction(0.02),
            motor_friction: friction(0.1),
            ..Plant::from(robot)
        };
        let mut stepper =
            Stepper::new(&plant, Integration::Collocation { tolerance: 1e-10 }, Stepping::<N>::STEP);
        let (mut x, mut t) = (Motion::at_rest(Vector::ZERO), 0.0);
        let mut ledger = Ledger::default();
        bencher.bench_local(|| {
            // Pushed to and fro, so that joints slide, stick and turn.
            let u_m = Vector::from_fn(|i| 3.0 * (8.0 * t + i as f64).sin() - 0.5 * x.q_m[i]);
            x = stepper.advance(&plant, x, t, seconds, &|_, _: &_| u_m, &mut ledger).expect("bounded");
            t += seconds;
        });
    }

    /// The robot of `file` on links of a size that is known here.
    fn robot<L, const N: usize>(file: &robot::Robot, links: L) -> Fjr<f64, L, N> {
        let drive = |values: &[f64]| Vector::from_fn(|i| values[i]);
        Fjr {
            links,
            motor_inertia: drive(&file.motor_inertia),
            stiffness: drive(&file.stiffness),
            link_damping: drive(&file.link_damping),
            motor_damping: drive(&file.motor_damping),
        }
    }

    #[divan::bench(args = [1e-3, 2e-3], sample_count = 2000, sample_size = 1)]
    fn two_link(bencher: Bencher, seconds: f64) {
        let file = load_robot("quanser-2dof").expect("built in");
        let robot::Links::PlanarTwoLink(form) = &file.links else { panic!("two links") };
        period::<_, 2>(
            bencher,
            robot(&file, PlanarTwoLink::new(form.mass, form.length[0], form.com, form.inertia)),
            seconds,
        );
    }

    #[divan::bench(args = [1e-3, 2e-3], sample_count = 2000, sample_size = 1)]
    fn panda(bencher: Bencher, seconds: f64) {
        let file = load_robot("panda").expect("built in");
        let robot::Links::Tree(bodies) = &file.links else { panic!("a tree") };
        let tree = Tree::<f64, 7>::from_bodies(bodies, file.gravity, |x| x).expect("seven joints");
        period::<_, 7>(bencher, robot(&file, tree), seconds);
    }
}

/// Whole runs of built-in scenarios, figures only; items are control periods.
mod whole_loop {
    use super::Bencher;
    use divan::counter::ItemsCount;
    use flexure::scenario::load_scenario;
    use flexure::simulate::measure;

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few thousand periods")]
    #[divan::bench(args = ["two-link-everything", "two-link-hardware", "two-link-tanh-smooth"], sample_count = 10, sample_size = 1)]
    fn periods(bencher: Bencher, name: &str) {
        let scenario = load_scenario(name).expect("built in");
        let periods = (scenario.duration / scenario.control_period).round();
        let count = ItemsCount::new(periods as usize);
        bencher.counter(count).bench_local(|| measure(&scenario).expect("two joints"));
    }
}

/// The law at 10,000 motions in one call, as `python crates/flexure-python/benches/calls.py` has it from Python, compiled as the wheel is.
mod law {
    use super::Bencher;
    use divan::counter::ItemsCount;
    use flexure::Scenario;

    const MOTIONS: usize = 10_000;

    #[divan::bench(args = ["two-link-tanh", "panda-tanh-smooth"], sample_count = 40, sample_size = 1)]
    fn batch(bencher: Bencher, name: &str) {
        let scenario = Scenario::load(name).expect("built in");
        let held = scenario.open().expect("a loop");
        let start = &scenario.initial;
        let motions = [&start.q_l[..], &start.q_m, &start.dq_l, &start.dq_m].concat().repeat(MOTIONS);
        let mut u_m = vec![0.0; MOTIONS * held.joints()];
        bencher
            .counter(ItemsCount::new(MOTIONS))
            .bench_local(|| held.torque(0.5, &motions, &mut u_m).expect("lengths fit"));
    }
}
