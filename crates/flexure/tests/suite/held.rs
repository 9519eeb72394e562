//! Robots and loops with their joint count hidden: what `Arm` and `Loop` promise.

use flexure::core::scalar::{Interval, Scalar};
use flexure::files::{Entry, ROBOTS, SCENARIOS};
use flexure::laws::{CONTROLLERS, Controller};
use flexure::progress::unwatched;
use flexure::robot::{Arm, Mismatch, load_robot};
use flexure::scenario::{Scenario, load_scenario};
use flexure::simulate::{Loop, Observed, run};

use crate::common::Random;

fn scenario(name: &str) -> Scenario {
    load_scenario(name).expect("built in")
}

fn rows(held: &mut dyn Loop, count: usize) -> Vec<u64> {
    let mut values = vec![0.0; held.signals().len()];
    let mut all = Vec::new();
    for _ in 0..count {
        held.step().expect("bounded");
        held.read(&mut values).expect("a slot per signal");
        all.extend(values.iter().map(|x| x.to_bits()));
    }
    all
}

/// Saved in the middle and restored, into the same loop and into one opened anew with other random numbers, `scenario` goes on as it did, to
/// the bit.
fn goes_on(scenario: &Scenario, name: &str) {
    let mut held = scenario.open().expect("supported");
    rows(&mut *held, 60);
    let saved = held.state();
    let expected = rows(&mut *held, 60);

    held.restore(&saved).expect("its own");
    assert_eq!(rows(&mut *held, 60), expected, "{name}");

    let mut other = scenario.open().expect("supported");
    other.reset(scenario.seed + 1);
    rows(&mut *other, 7);
    other.restore(&saved).expect("of the same scenario");
    assert_eq!(rows(&mut *other, 60), expected, "{name}, opened anew");
}

/// Nothing that matters is left out of the state.
#[test]
fn every_scenario_goes_on_from_its_state() {
    for (name, _) in SCENARIOS {
        goes_on(&scenario(name), name);
    }
}

/// The same of laws with memory, with the imperfections that a loop can have.
#[test]
fn every_memory_goes_on_from_its_state() {
    let mut scenario = scenario("two-link-everything");
    for Entry { name, .. } in CONTROLLERS {
        scenario.controller = Controller::default_for(name, &scenario.robot).expect("registered");
        if !scenario.controller.memory().is_empty() {
            goes_on(&scenario, name);
        }
    }
}

/// On a tree with fewer joints than its capacity every memory moves with the robot, and what adapts adapts.
#[test]
fn no_memory_stands_still() {
    let mut scenario = scenario("planar-3r-tanh");
    for Entry { name, .. } in CONTROLLERS {
        scenario.controller = Controller::default_for(name, &scenario.robot).expect("registered");
        let parts = scenario.controller.memory();
        if parts.is_empty() {
            continue;
        }
        let mut held = scenario.open().expect("supported");
        let names = held.state_names();
        let mut after = |count: usize| {
            rows(&mut *held, count);
            held.state()
        };
        let (before, now) = (after(2), after(100));
        let moved = |part: &str| {
            let own = format!("law.{part}");
            let values = names.iter().zip(before.iter().zip(&now));
            values
                .filter(|(signal, _)| signal.name.contains(&own))
                .any(|(_, (x, y))| x.to_bits() != y.to_bits())
        };
        let moving = parts.iter().filter(|(part, _)| moved(part)).count();
        assert!(moving > 0, "{name}");
        let adapts = parts.iter().any(|(part, _)| *part == "phi_0");
        assert!(!adapts || (0..10).any(|k| moved(&format!("phi_{k}"))), "{name}");
    }
}

/// Each number of a state has a name of its own and comes back as it was; a state with one number more, less or broken is refused
/// and changes nothing.
#[test]
fn states_are_named_and_bad_ones_refused() {
    let mut held = scenario("two-link-everything").open().expect("supported");
    rows(&mut *held, 50);
    let (saved, names) = (held.state(), held.state_names());
    assert_eq!(saved.len(), names.len());
    let mut unique: Vec<_> = names.iter().map(|signal| signal.name.as_str()).collect();
    unique.sort_unstable();
    unique.dedup();
    assert_eq!(unique.len(), names.len(), "names repeat");

    held.restore(&saved[1..]).expect_err("one too few");
    held.restore(&[&saved[..], &[0.0]].concat()).expect_err("one too many");
    let flag = names.iter().position(|signal| signal.name == "instant.there").expect("a flag");
    let mut broken = saved.clone();
    broken[flag] = 0.5;
    let said = held.restore(&broken).expect_err("half a flag").to_string();
    assert!(said.contains("0.5"), "{said}");
    let bits = |state: &[f64]| state.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&held.state()), bits(&saved));
}

/// `reset` goes back to the beginning: with the seed of the file it is the run of the file, with another one another run.
#[test]
fn seeds_decide_runs() {
    let scenario = scenario("two-link-hardware");
    let mut held = scenario.open().expect("supported");
    let first = rows(&mut *held, 40);
    held.reset(scenario.seed);
    assert_eq!(rows(&mut *held, 40), first);
    let everything = self::scenario("two-link-everything");
    let mut held = everything.open().expect("supported");
    let first = rows(&mut *held, 40);
    held.reset(everything.seed + 1);
    assert_ne!(rows(&mut *held, 40), first);
}

/// A loop that diverges shows its last good instant, the last row of the trace of its run, and goes on saying that it did; `reset`
/// begins anew.
#[test]
fn divergence_leaves_the_last_good_instant() {
    for (name, period) in [("two-link-tanh", 0.05), ("panda-tanh-smooth", 0.02)] {
        let mut scenario = scenario(name);
        scenario.control_period = period;
        // At their limits the drives of the seven-joint arm would swing it to and fro, not beyond all bounds.
        scenario.plant.unlimited = true;
        let run = run(&scenario, &unwatched).expect("supported");
        let diverged = run.divergence.expect("too slow for its gains");
        let mut held = scenario.open().expect("supported");
        let seen = std::iter::repeat_with(|| held.step()).take_while(Result::is_ok).count();
        assert_eq!(seen, run.trace.len(), "{name}");
        let mut values = vec![0.0; held.signals().len()];
        held.read(&mut values).expect("a slot per signal");
        for (column, value) in run.trace.columns().iter().zip(&values) {
            let last = column.values.last().expect("some rows");
            assert_eq!(last.to_bits(), value.to_bits(), "{name}: {}", column.name);
        }
        assert_eq!(held.step().expect_err("it stays so"), diverged);
        held.reset(scenario.seed);
        held.step().expect("the beginning is good");
    }
}

/// The law of many states at once is that of one after the other, but for the rounding of lanes, and whatever the others are; for one
/// state it is that of `command`.
#[test]
fn batches_are_states_one_by_one() {
    for name in ["pendulum-tanh", "planar-3r-tanh", "two-link-coupled-tanh", "panda-tanh-smooth"] {
        let held = scenario(name).open().expect("supported");
        let n = held.joints();
        let mut r = Random(3);
        let motions: Vec<f64> = (0..5 * 4 * n).map(|_| r.next()).collect();
        let mut torques = vec![0.0; 5 * n];
        held.torque(0.4, &motions, &mut torques).expect("five states");
        // Ten ulps of a tanh, times what the law makes of it: torques of this size in its sum.
        let size = torques.iter().fold(0.0, |most: f64, torque| most.max(torque.abs()));
        for (motion, torque) in motions.chunks(4 * n).zip(torques.chunks(n)) {
            let mut alone = vec![0.0; n];
            held.torque(0.4, motion, &mut alone).expect("one state");
            assert_eq!(held.command(0.4, motion).expect("one state").u_m, alone, "{name}");
            for (alone, torque) in alone.iter().zip(torque) {
                assert!((alone - torque).abs() <= 1e-13 * size, "{name}: {alone} {torque}");
            }
        }
        for states in 2..5 {
            let mut fewer = vec![0.0; states * n];
            held.torque(0.4, &motions[4 * n * (5 - states)..], &mut fewer).expect("the last of them");
            assert_eq!(fewer, torques[n * (5 - states)..], "{name}");
        }
        held.torque(0.4, &[], &mut []).expect("no state at all");
    }
}

/// The rate of the motion is what steps of the integrator tend to: over a period of h the mean rate differs by O(h).
#[test]
fn derivatives_are_rates_of_steps() {
    for name in ["two-link-tanh-smooth", "planar-3r-tanh", "tomei-3r-tanh-coupled"] {
        let mut scenario = scenario(name);
        scenario.control_period = 1e-6;
        let mut held = scenario.open().expect("supported");
        let n = held.joints();
        let read = |held: &dyn Loop| {
            let mut values = vec![0.0; held.signals().len()];
            held.read(&mut values).expect("a slot per signal");
            values
        };
        held.step().expect("bounded");
        let before = read(&*held);
        held.step().expect("bounded");
        let after = read(&*held);
        // t, then the motion; the torque is the last of the signals that every loop has.
        let motion = |row: &[f64]| row[1..=4 * n].to_vec();
        let u_m = &before[6 * n + 1..=7 * n];
        let mut rate = vec![0.0; 4 * n];
        held.derivative(0.0, &motion(&before), u_m, &mut rate).expect("one state");
        for ((x, y), rate) in motion(&before).iter().zip(motion(&after)).zip(rate) {
            let mean = (y - x) / 1e-6;
            assert!((mean - rate).abs() <= 1e-3 * rate.abs().max(1.0), "{name}: {mean} against {rate}");
        }
    }
}

/// Forward dynamics undo inverse dynamics, on floats and enclosed; energies are those of M and of rest.
#[test]
fn arms_agree_with_themselves() {
    let mut r = Random(11);
    for (name, _) in ROBOTS {
        let robot = load_robot(name).expect("built in");
        let (arm, enclosed) = (robot.arm().expect("supported"), robot.enclosed_arm().expect("supported"));
        let n = arm.joints();
        assert_eq!((n, enclosed.joints()), (robot.joint_count(), n));
        let mut draw = |count: usize| -> Vec<f64> { (0..count).map(|_| r.next()).collect() };
        let (q, v, a) = (draw(n), draw(n), draw(n));
        let (mut torque, mut mass) = (vec![0.0; n], vec![0.0; n * n]);
        arm.inverse_dynamics(&q, &v, &a, &mut torque).expect("n joints");
        arm.mass_matrix(&q, &mut mass).expect("n joints");
        // M a = τ − τ(a = 0).
        let mut bias = vec![0.0; n];
        arm.inverse_dynamics(&q, &v, &vec![0.0; n], &mut bias).expect("n joints");
        let difference: Vec<f64> = torque.iter().zip(&bias).map(|(x, y)| x - y).collect();
        let mut solved = vec![0.0; n];
        arm.solve_mass(&q, &difference, &mut solved).expect("n joints");
        for (x, y) in solved.iter().zip(&a) {
            assert!((x - y).abs() < 1e-9, "{name}: {x} against {y}");
        }
        // Kinetic energy of the links: the difference of the energies in motion and at rest.
        let still = [&q[..], &q, &vec![0.0; 2 * n]].concat();
        let moving = [&q[..], &q, &v, &vec![0.0; n]].concat();
        let kinetic = arm.energy(&moving).expect("4n") - arm.energy(&still).expect("4n");
        let form: f64 = (0..n)
            .flat_map(|i| (0..n).map(move |j| (i, j)))
            .map(|(i, j)| mass[i * n + j] * v[i] * v[j])
            .sum();
        assert!((kinetic - 0.5 * form).abs() <= 1e-12 * form.max(1.0), "{name}: {kinetic} J");
        let interval = |x: &Vec<f64>| x.iter().map(|&x| Interval::point(x)).collect::<Vec<_>>();
        let mut bounds = vec![Interval::ZERO; n];
        enclosed
            .inverse_dynamics(&interval(&q), &interval(&v), &interval(&a), &mut bounds)
            .expect("n joints");
        for (bound, x) in bounds.iter().zip(&torque) {
            let slack = 1e-12 * x.abs().max(1.0);
            assert!(bound.lo() - slack <= *x && *x <= bound.hi() + slack, "{name}: {x} outside {bound:?}");
        }
    }
}

/// Slices of a wrong length are refused with both lengths, whatever the method.
#[test]
fn wrong_lengths_are_refused() {
    let robot = load_robot("panda").expect("built in");
    let arm: Box<dyn Arm> = robot.arm().expect("supported");
    let held = scenario("panda-tanh-smooth").open().expect("supported");
    let (short, right, long) = ([0.0; 6], [0.0; 7], [0.0; 28]);
    let (mut seven, mut forty) = ([0.0; 7], [0.0; 49]);
    let mut observed = Observed::new(2);
    let refused: [(&str, Result<(), Mismatch>); 12] = [
        ("motion has 8", held.observe(&mut observed)),
        ("q_l has 6", arm.mass_matrix(&short, &mut forty)),
        ("mass has 7", arm.mass_matrix(&right, &mut seven)),
        ("b has 6", arm.solve_mass(&right, &short, &mut seven)),
        ("ddq_l has 28", arm.inverse_dynamics(&right, &right, &long, &mut seven)),
        ("motion has 7", arm.energy(&right).map(drop)),
        ("acceleration has 7", arm.forward_dynamics(&long, &right, &mut seven)),
        ("q_l has 2", arm.torque_along(&[[0.0; 5]; 2], &mut [[0.0; 3]; 7])),
        ("u_m has 7", held.torque(0.0, &[&long[..], &long].concat(), &mut seven)),
        ("motions has 7 numbers, must have 28", held.torque(0.0, &right, &mut seven)),
        ("values has 7", held.read(&mut seven)),
        ("rate has 7", held.derivative(0.0, &long, &right, &mut seven)),
    ];
    for (said, result) in refused {
        let message = result.expect_err(said).to_string();
        assert!(message.contains(said), "{message}");
    }
    assert!(held.torque(0.0, &[0.0; 30], &mut [0.0; 7]).is_err(), "not a multiple of 28");
}

/// A joint that slides has metres and newtons, in the trace of a run too; one that turns beside it has not.
#[test]
fn signals_have_the_units_of_their_joints() {
    let body = "mass = 2.0\ncom = [0.0, 0.0, 0.1]\ninertia = [0.1, 0.0, 0.0, 0.1, 0.0, 0.1]\n";
    let tree = format!(
        "name = 'cart'\ngravity = [0.0, 0.0, -9.81]\n[links]\nkind = 'tree'\n\
         [[links.joint]]\nname = 'slider'\nkind = 'prismatic'\naxis = [1.0, 0.0, 0.0]\n{body}\
         [[links.joint]]\nname = 'pole'\nparent = 'slider'\nkind = 'revolute'\naxis = [0.0, 1.0, 0.0]\n{body}\
         [joints]\nstiffness = [5000.0, 200.0]\nmotor_inertia = [1.0, 0.05]\nlink_damping = [1.0, 0.1]\nmotor_damping = [1.0, 0.1]\n"
    );
    let robot = flexure::robot::robot_from_text("cart.toml", &tree, ".".as_ref());
    let robot = robot.unwrap_or_else(|problems| panic!("{problems}"));
    let mut scenario = scenario("planar-2r-tanh");
    scenario.robot = robot;
    let held = scenario.open().expect("supported");
    let unit = |name: &str| held.signals().iter().find(|signal| signal.name == name).expect(name).unit;
    for (first, second, units) in [
        ("q_l1", "q_l2", ["m", "rad"]),
        ("dq_m1", "dq_m2", ["m/s", "rad/s"]),
        ("u_m1", "u_m2", ["N", "N m"]),
        ("sigma_l1", "sigma_l2", ["kg m/s", "kg m^2/s"]),
    ] {
        assert_eq!([unit(first), unit(second)], units);
    }
    assert_eq!(unit("t"), "s");
}
