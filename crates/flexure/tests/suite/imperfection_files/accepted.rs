//! What is read as it is written.

use std::fs;
use std::path::Path;

use flexure::core::scalar::Interval;
use flexure::estimators::{Encoders, Estimator};
use flexure::imperfections::{
    Deadline, DropoutMode, IMPERFECTIONS, Imperfection, ModelError, Outage, Side, Sides, Stall,
    VelocityFilter,
};
use flexure::plant::Shape;
use flexure::robot::{Links, Robot, load_robot};
use flexure::scenario::{Believed, Collision, Reaction, Rejoin, scenario_from_text};

use super::{QUANSER, REAL, SCENARIO, folder, good, with};

#[test]
fn everything_is_read() {
    let scenario = good(&with(REAL));
    assert_eq!(scenario.warnings.len(), 0, "{:?}", scenario.warnings);
    assert_eq!(scenario.seed, 42);
    let kinds: Vec<_> = scenario.imperfections.iter().map(Imperfection::kind).collect();
    for entry in IMPERFECTIONS {
        // A filter and an observer exclude each other; the gain of the drive is read in the tests of whole loops.
        let elsewhere = ["velocity-filter", "torque-gain"].contains(&entry.name);
        assert!(kinds.contains(&entry.name) || elsewhere, "{}", entry.name);
    }
    let [
        motor,
        link,
        noise,
        sampling,
        window,
        chance,
        delay,
        deadline,
        limit,
        rate,
        step,
        friction,
        spring,
        model,
        push,
        bias,
        jump,
        freeze,
        stall,
    ] = scenario.imperfections.as_slice()
    else {
        panic!("{kinds:?}")
    };
    let Imperfection::Encoder(motor) = motor else { panic!() };
    // 2π/(4096 · 100) and 2π/(4096 · 50): the sense of the gear does not matter.
    let count = std::f64::consts::TAU / 4096.0;
    let resolution = motor.resolution(Side::Motor).unwrap();
    assert!((resolution[0] * 100.0 - count).abs() < 1e-18 && (resolution[1] * 50.0 - count).abs() < 1e-18);
    assert!(motor.resolution(Side::Link).is_none() && motor.dither);
    let Imperfection::Encoder(link) = link else { panic!() };
    assert_eq!(
        (link.link.as_deref(), link.motor.as_deref(), link.dither),
        (Some(&[1e-4, 2e-4][..]), None, false)
    );
    let Imperfection::Noise(noise) = noise else { panic!() };
    assert_eq!(
        (&noise.link, &noise.motor, &noise.link_velocity),
        (&vec![1e-5; 2], &vec![1e-5, 2e-5], &vec![0.0; 2])
    );
    let Imperfection::Sampling(sampling) = sampling else { panic!() };
    assert_eq!((sampling.sides, sampling.periods), (Sides::One(Side::Link), 2));
    let (Imperfection::Dropout(window), Imperfection::Dropout(chance)) = (window, chance) else { panic!() };
    assert_eq!((window.sides, window.mode), (Sides::Both, DropoutMode::Nan));
    assert_eq!(window.outage, Outage::Window { from: 0.5, until: 0.6 });
    assert_eq!((chance.sides, chance.mode), (Sides::One(Side::Link), DropoutMode::Hold));
    assert_eq!(chance.outage, Outage::Random { probability: 0.01, mean_length: 3.0 });
    let Imperfection::Delay(delay) = delay else { panic!() };
    assert!((delay.total() - 7e-4).abs() < 1e-18);
    assert!(matches!(deadline, Imperfection::Deadline(Deadline::Every(100))));
    // From the robot.
    assert!(matches!(limit, Imperfection::Saturation(drive) if drive.limit == [8.39, 1.67]));
    assert!(matches!(rate, Imperfection::TorqueRate(drive) if drive.limit == [4000.0, 800.0]));
    assert!(matches!(step, Imperfection::CurrentQuantisation(drive) if drive.step == [0.01, 0.01]));
    let Imperfection::Friction(friction) = friction else { panic!() };
    let stribeck = friction.stribeck.as_ref().unwrap();
    assert_eq!((friction.side, friction.coulomb.as_slice()), (Side::Motor, &[0.2, 0.05][..]));
    assert_eq!(
        (stribeck.breakaway.as_slice(), stribeck.velocity.as_slice()),
        (&[0.3, 0.05][..], &[0.1, 0.1][..])
    );
    let Imperfection::Spring(spring) = spring else { panic!() };
    assert_eq!((spring.hardening[1], spring.dead_zone[1]), (50.0, 0.001));
    assert_eq!((spring.hysteresis_stiffness[1], spring.hysteresis_torque[1]), (0.5, 0.02));
    assert!(
        matches!(model, Imperfection::ModelError(model) if model.payload.is_some() && model.robot.is_none())
    );
    let Imperfection::Push(push) = push else { panic!() };
    assert_eq!((push.torque[1], push.from, push.duration, push.shape), (-0.5, 1.0, 0.1, Shape::HalfSine));
    assert!(matches!(bias, Imperfection::Bias(bias) if bias.link == [0.0; 2] && bias.motor == [0.01, -0.02]));
    let Imperfection::Jump(jump) = jump else { panic!() };
    assert_eq!((jump.sides, jump.size[1], jump.from), (Sides::One(Side::Motor), 6.0, 1.0));
    assert!(jump.until.is_infinite(), "for good");
    let Imperfection::Freeze(freeze) = freeze else { panic!() };
    assert_eq!((freeze.sides, freeze.from, freeze.until), (Sides::One(Side::Link), 1.5, 1.6));
    assert!(matches!(stall, Imperfection::Stall(Stall { from: 1.7, until: 1.72 })));
    let Some(Estimator::Observer { encoders: Encoders::Both, bandwidth }) = scenario.estimator else {
        panic!()
    };
    assert_eq!(bandwidth, [300.0, 400.0]);
    assert!(scenario.disturbance_observer.is_some_and(|o| o.compensate && o.bandwidth == [50.0; 2]));
}

/// Every key of a guard.
#[test]
fn a_guard_is_read() {
    let scenario = good(&with(REAL));
    let guard = scenario.guard.unwrap();
    assert_eq!((guard.torque_limit.as_slice(), guard.torque_rate_limit[0]), (&[8.0, 1.5][..], 4000.0));
    let rejoin = Rejoin {
        after: 10,
        speed: vec![0.1; 2],
        error: vec![0.3, 0.2],
        duration: 0.2,
        settle: 0.2, // no longer than the reference takes
    };
    assert_eq!((guard.max_age, guard.rejoin), (1, rejoin));
    assert_eq!((guard.off_after, guard.latch, guard.watchdog), (Some(5.0), Some((3, 10.0)), Some(3)));
    let believed = Believed {
        position: [vec![-3.0, -2.0], vec![3.0, 2.0]],
        speed: vec![6.0; 2],
        deflection: vec![0.4; 2],
        jump: vec![0.05; 2],
        frozen: (5, 0.01),
        velocity_gap: vec![2.0, 3.0],
        motor_residual: vec![1.0; 2],
    };
    assert_eq!(guard.believed, believed);
    let collision = Collision { threshold: vec![2.0, 0.5], reaction: Reaction::Retract, retract: 0.1 };
    assert_eq!((guard.collision, guard.residual_bandwidth), (Some(collision), 30.0));
}

/// Nothing is there unless asked for.
#[test]
fn the_default_is_ideal() {
    let scenario = good(&SCENARIO.replace("seed = 42\n", "").replace("arm.toml", "plain.toml"));
    assert_eq!(scenario.seed, 0);
    assert!(scenario.imperfections.is_empty() && scenario.estimator.is_none());
    assert!(scenario.disturbance_observer.is_none() && scenario.guard.is_none());
    assert!(scenario.robot.limits.torque_rate.iter().all(|limit| limit.is_infinite()));
    let filter = |text: &str| match good(&with(text)).imperfections.as_slice() {
        [Imperfection::VelocityFilter(filter)] => *filter,
        other => panic!("{other:?}"),
    };
    let first = "[[imperfection]]\nkind = \"velocity-filter\"\norder = 1\ncutoff = 40";
    assert_eq!(filter(first), VelocityFilter::First { cutoff: 40.0 });
    let second = first.replace("order = 1", "damping = 0.9\norder = 2");
    assert_eq!(filter(&second), VelocityFilter::Second { cutoff: 40.0, damping: 0.9 });
    // Several entries of kinds that come and go, and of those on different sides.
    let push = "[[imperfection]]\nkind = \"push\"\ntorque = 1\nfrom = 0\nduration = 0.1\n";
    let friction = "[[imperfection]]\nkind = \"friction\"\nside = \"link\"\ncoulomb = 1\n";
    let text = push.repeat(3) + friction + &friction.replace("link", "motor");
    assert_eq!(good(&with(&text)).imperfections.len(), 5);
    // The mechanics may be imperfect in continuous time.
    good(&with(&text).replace("seed = 42", "hold = \"continuous\""));
}

/// Numbers of a plant whose model is wrong; the law's robot stays.
#[test]
fn a_wrong_model_is_another_robot() {
    let applied = |text: &str| -> (Robot, Robot) {
        let scenario = good(&with(&format!("[[imperfection]]\nkind = \"model-error\"\n{text}")));
        let [Imperfection::ModelError(model)] = scenario.imperfections.as_slice() else { panic!() };
        (ModelError::apply(model, &scenario.robot), scenario.robot)
    };
    let (plant, robot) = applied("mass = [2.0, 1.0]\nstiffness = [0.5, 1.0]\nmotor_inertia = 3.0");
    let (
        Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { mass, inertia, com, .. }),
        Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { mass: m, inertia: i, com: r, .. }),
    ) = (&plant.links, &robot.links)
    else {
        panic!()
    };
    assert_eq!((*mass, *inertia, com), ([2.0 * m[0], m[1]], [2.0 * i[0], i[1]], r));
    assert_eq!((plant.stiffness, plant.motor_inertia[1]), (vec![4.5, 4.0], 3.0 * robot.motor_inertia[1]));
    assert_eq!(plant.link_damping, robot.link_damping);
    let (plant, robot) = applied("robot = \"cad.toml\"");
    let Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { mass, .. }) = plant.links else { panic!() };
    assert_eq!((mass[0], robot.name), (1.5, "quanser-2dof".to_owned()));
    // 0.2 kg at 0.267 m: mass and first moment add, and so do inertias about the joint.
    let (plant, _) = applied("payload = { mass = 0.2, position = [0.267, 0, 0] }");
    let Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { mass, inertia, com, .. }) = plant.links else {
        panic!()
    };
    assert!((mass[1] - m[1] - 0.2).abs() < 1e-15);
    assert!((mass[1] * com[1] - m[1] * r[1] - 0.2 * 0.267).abs() < 1e-15);
    let about_the_joint = inertia[1] + mass[1] * com[1] * com[1];
    assert!((about_the_joint - (i[1] + m[1] * r[1] * r[1] + 0.2 * 0.267 * 0.267)).abs() < 1e-15);
    let Links::PlanarTwoLink(flexure::robot::PlanarTwoLink { inertia: bounds, .. }) = plant.enclosed else {
        panic!()
    };
    assert!(bounds[1].contains_interval(Interval::point(inertia[1])) && bounds[1].width() < 1e-15);
}

/// A payload on a tree is the same as one more body that is fixed to it.
#[test]
fn payloads_on_trees_are_fixed_bodies() {
    let tree = "name = \"tree\"\n[links]\nkind = \"tree\"\n[[links.joint]]\nname = \"a\"\nkind = \"revolute\"\n\
                axis = [0, 1, 0]\nmass = 2\ncom = [0.1, 0.2, 0.3]\ninertia = [0.02, 0.001, 0, 0.03, 0.002, 0.04]\n";
    let drives = "[joints]\nstiffness = 100\nmotor_inertia = 0.1\nlink_damping = 0\nmotor_damping = 0\n";
    let body = "[[links.joint]]\nname = \"b\"\nparent = \"a\"\nkind = \"fixed\"\nxyz = [0.3, -0.1, 0.2]\nmass = 0.7\ncom = [0, 0, 0]\n\
                inertia = [0, 0, 0, 0, 0, 0]\n";
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: String| {
        fs::write(folder.path().join(name), text).unwrap();
        load_robot(folder.path().join(name).to_str().unwrap()).unwrap_or_else(|problems| panic!("{problems}"))
    };
    let robot = file("bare.toml", format!("{tree}{drives}"));
    let heavy = file("heavy.toml", format!("{tree}{body}{drives}"));
    let more =
        "[[imperfection]]\nkind = \"model-error\"\npayload = { mass = 0.7, position = [0.3, -0.1, 0.2] }\n";
    let text = with(more).replace("arm.toml", "bare.toml");
    let scenario =
        scenario_from_text("s.toml", &text, folder.path()).unwrap_or_else(|problems| panic!("{problems}"));
    let [Imperfection::ModelError(model)] = scenario.imperfections.as_slice() else { panic!() };
    let (Links::Tree(loaded), Links::Tree(heavy)) = (model.apply(&robot).links, heavy.links) else {
        panic!()
    };
    let numbers = |links: &[flexure::robot::Body]| -> Vec<f64> {
        let body = links[0];
        [body.mass].into_iter().chain(body.com).chain(body.inertia.into_iter().flatten()).collect()
    };
    for (a, b) in numbers(&loaded).into_iter().zip(numbers(&heavy)) {
        assert!((a - b).abs() < 1e-15, "{loaded:?} and {heavy:?}");
    }
}

/// The example of the guide is a good one, and names every kind.
#[test]
fn the_example_of_the_guide_loads() {
    let guide =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/files.md")).unwrap();
    let (_, section) = guide.split_once("## Real loops").expect("a section");
    let (_, example) = section.split_once("```toml\n").expect("an example");
    let (example, _) = example.split_once("```").expect("its end");
    let folder = folder();
    fs::write(folder.path().join("payload.toml"), QUANSER).unwrap();
    let scenario = scenario_from_text("s.toml", &with(&example.replace("seed = 42", "")), folder.path());
    let scenario = scenario.unwrap_or_else(|problems| panic!("{problems}"));
    assert!(scenario.warnings.is_empty(), "{:?}", scenario.warnings);
    for entry in IMPERFECTIONS {
        assert!(section.contains(&format!("`{}`", entry.name)), "{} is not in the guide", entry.name);
    }
}
