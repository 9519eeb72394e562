//! The arms under gravity against closed forms written here by hand.

use flexure::eval::{ModelRow, evaluate_model};
use flexure::files::{StateFile, StateRow};
use flexure::robot::load_robot;
use flexure::robot::{Links, Robot};

/// Tomei (1991), a1 … a13 as printed: the digits tell how far to trust them.
const PRINTED: [(&str, [&str; 13]); 2] = [
    (
        "tomei-3r",
        [
            "0.0840", "9.2063", "2.4515", "5.4000", "11.743", "2.6274", "2.7000", "2.4817", "0.1456",
            "23.296", "70.656", "189.17", "52.928",
        ],
    ),
    (
        "tomei-3r-5kg",
        [
            "0.0840", "10.456", "3.7015", "7.9000", "14.243", "3.8774", "3.9500", "3.7317", "0.1456",
            "23.296", "70.656", "213.67", "77.432",
        ],
    ),
];

/// The links at rest at `count` postures spread over a turn, without two alike: multiples of irrational angles.
fn at_rest(robot: &Robot, count: u32) -> Vec<(Vec<f64>, ModelRow)> {
    const STEPS: [f64; 3] = [std::f64::consts::SQRT_2, 2.236_067_977_499_79, 2.645_751_311_064_590_6];
    let angle = |i: u32, step: f64| (f64::from(i) * step).rem_euclid(std::f64::consts::TAU) - 3.0;
    let postures: Vec<Vec<f64>> = (0..count)
        .map(|i| STEPS[..robot.joint_count()].iter().map(|step| angle(i, *step)).collect())
        .collect();
    let rows = postures.iter().map(|q| {
        let still = vec![0.0; q.len()];
        StateRow { q_l: q.clone(), q_m: q.clone(), dq_l: still.clone(), dq_m: still, ..StateRow::default() }
    });
    let states = StateFile { name: "postures".to_owned(), rows: rows.collect() };
    let models = evaluate_model(robot, &states).expect("finite");
    postures.into_iter().zip(models).collect()
}

/// The largest disagreement with the printed closed form, in units of what its rounding allows: half a unit of the last
/// digit of each parameter that takes part.
fn disagreement(robot: &Robot, printed: &[&str; 13]) -> f64 {
    let a = |i: usize| printed[i - 1].parse::<f64>().expect("a number");
    let half = |i: usize| {
        let digits = printed[i - 1].split_once('.').expect("decimals").1.len();
        0.5 * 0.1_f64.powi(i32::try_from(digits).expect("few"))
    };
    let mut worst = 0.0_f64;
    for (q, model) in at_rest(robot, 200) {
        let (c2, c23, c3) = (q[1].cos(), (q[1] + q[2]).cos(), q[2].cos());
        let mut compare = |found: f64, terms: &[(usize, f64)]| {
            let expected: f64 = terms.iter().map(|&(i, factor)| a(i) * factor).sum();
            let allowed: f64 = terms.iter().map(|&(i, factor)| half(i) * factor.abs()).sum();
            // 1e-12: rounding of a few dozen operations on numbers up to 250.
            worst = worst.max((found - expected).abs() / (allowed + 1e-12));
        };
        let m = &model.M_l;
        compare(m[0][0], &[(1, 1.0), (2, c2 * c2), (3, c23 * c23), (4, c2 * c23)]);
        compare(m[0][1], &[]);
        compare(m[0][2], &[]);
        compare(m[1][1], &[(5, 1.0), (4, c3)]);
        compare(m[1][2], &[(8, 1.0), (7, c3)]);
        compare(m[2][2], &[(8, 1.0)]);
        compare(model.bias[0], &[]);
        compare(model.bias[1], &[(12, c2), (13, c23)]);
        compare(model.bias[2], &[(13, c23)]);
    }
    worst
}

#[test]
fn tomei_s_arms_have_the_printed_parameters() {
    for (name, printed) in PRINTED {
        let robot = load_robot(name).expect("built in");
        let found = disagreement(&robot, &printed);
        assert!(found <= 1.0, "{name}: {found} times what rounding allows");
        // B44 and B66 are a10, B55 is a11; B26 = a9 is what the third gear makes of the rotor.
        let a = |i: usize| printed[i - 1].parse::<f64>().expect("a number");
        assert_eq!(robot.motor_inertia, [a(10), a(11), a(10)]);
        let coupling = robot.motor_inertia[2] / robot.gear_ratio.expect("gears")[2];
        assert!((coupling - a(9)).abs() < 0.5e-4, "{coupling}");
    }
}

/// One part in a thousand of any number that plays a part is seen, and so are a wrong sense of rotation and the payload.
#[test]
fn tomei_s_parameters_tell_other_arms_apart() {
    let (name, printed) = PRINTED[0];
    let altered = |change: &dyn Fn(&mut Robot)| {
        let mut robot = load_robot(name).expect("built in");
        change(&mut robot);
        disagreement(&robot, &printed)
    };
    let body = |i: usize, change: &'static dyn Fn(&mut flexure::robot::Body)| {
        altered(&|robot| match &mut robot.links {
            Links::Tree(bodies) => change(&mut bodies[i]),
            other => panic!("{other:?}"),
        })
    };
    assert!(altered(&|_| ()) <= 1.0);
    assert!(altered(&|robot| robot.gravity[2] *= 1.001) > 1.0);
    for i in 1..3 {
        assert!(body(i, &|body| body.mass *= 1.001) > 1.0, "mass {i}");
        assert!(body(i, &|body| body.com[0] *= 1.001) > 1.0, "com {i}");
        for k in 0..3 {
            let seen = match k {
                0 => body(i, &|body| body.inertia[0][0] += 0.002),
                1 => body(i, &|body| body.inertia[1][1] += 0.002),
                _ => body(i, &|body| body.inertia[2][2] += 0.002),
            };
            assert!(seen > 1.0, "inertia {i}, {k}: {seen}");
        }
    }
    assert!(body(2, &|body| body.translation[0] *= 1.001) > 1.0);
    assert!(body(1, &|body| body.axis[1] *= -1.0) > 1.0);
    assert!(disagreement(&load_robot("tomei-3r-5kg").expect("built in"), &printed) > 1.0);
}

/// Thin planar links in a vertical plane, angles from the horizontal: masses, lengths, centres, inertias of each.
fn planar(q: &[f64], links: &[[f64; 4]], g: f64) -> (Vec<Vec<f64>>, Vec<f64>) {
    let n = q.len();
    let heading = |k: usize| q[..=k].iter().sum::<f64>();
    // ∂(x, z)/∂q_i of the centre of link k: segments from joint i on turn with it.
    let slope = |k: usize, i: usize| {
        (i..=k).fold((0.0, 0.0), |(x, z), j| {
            let [_, length, com, _] = links[j];
            let reach = if j == k { com } else { length };
            (x - reach * heading(j).sin(), z + reach * heading(j).cos())
        })
    };
    let mut mass = vec![vec![0.0; n]; n];
    let mut gravity = vec![0.0; n];
    for (k, &[m, _, _, inertia]) in links.iter().enumerate() {
        let slopes: Vec<_> = (0..=k).map(|i| slope(k, i)).collect();
        for ((&(xi, zi), row), torque) in slopes.iter().zip(&mut mass).zip(&mut gravity) {
            *torque += m * g * zi;
            for (&(xj, zj), entry) in slopes.iter().zip(row) {
                *entry += m * (xi * xj + zi * zj) + inertia;
            }
        }
    }
    (mass, gravity)
}

#[test]
fn planar_arms_are_what_their_numbers_say() {
    let two = [[4.0, 0.4, 0.3, 0.4]; 2];
    let three = [10.0, 7.5, 5.0].map(|m| [m, 1.0, 0.5, m / 12.0]);
    // The closed form, once more by hand: M22 = 4 · 0.3² + 0.4, gravity at the elbow 4 · 9.81 · 0.3 when stretched out.
    let (mass, gravity) = planar(&[0.0, 0.0], &two, 9.81);
    assert!((mass[1][1] - 0.76).abs() < 1e-15 && (gravity[1] - 11.772).abs() < 1e-14);
    assert!((mass[0][0] - (0.36 + 0.4 + 4.0 * 0.7 * 0.7 + 0.4)).abs() < 1e-14);
    for (name, links, scale) in [("planar-2r", &two[..], 50.0), ("planar-3r", &three, 300.0)] {
        let robot = load_robot(name).expect("built in");
        let off = |gravity: f64| {
            let mut worst = 0.0_f64;
            for (q, model) in at_rest(&robot, 100) {
                let (mass, torque) = planar(&q, links, gravity);
                let pairs = mass.iter().flatten().zip(model.M_l.iter().flatten());
                for (expected, found) in pairs.chain(torque.iter().zip(&model.bias)) {
                    worst = worst.max((expected - found).abs() / scale);
                }
            }
            worst
        };
        // Relative to the largest gravity torque; 1e-13 of it is a few hundred roundings.
        assert!(off(9.81) < 1e-13, "{name}: {}", off(9.81));
        assert!(off(9.81 * (1.0 + 1e-9)) > 1e-10, "{name}: {}", off(9.81));
    }
    let gears = load_robot("planar-2r").expect("built in");
    for (inertia, ratio) in gears.motor_inertia.iter().zip(gears.gear_ratio.expect("gears")) {
        assert!((inertia - 0.015 * ratio * ratio).abs() < 1e-12, "the rotor's inertia, on the link side");
    }
}
