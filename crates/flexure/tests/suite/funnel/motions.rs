//! Funnels against motions of robots within the tolerances, under torques that jump and torques that push outwards most.

use flexure::core::linalg::Vector;
use flexure::core::model::Motion;
use flexure::core::scalar::{Interval, Scalar as _};
use flexure::linalg::Dense;
use flexure::progress::unwatched;
use flexure::prove::engine::envelope::funnel::{Funnel, FunnelRequest};
use flexure::scenario::{Scenario, load_scenario};

use crate::along::floats;
use crate::along::slabs::enclosed;
use crate::common::Random;
use crate::within::motions::{along, later, rates};
use crate::within::{Arm, Numbers, drawn, spread, tolerant};

/// Parts of K, M_m, D_l and D_m that robots are off by, and torques on links and motors [N m].
const PARTS: [f64; 4] = [0.01, 0.01, 0.03, 0.03];
const ON_LINKS: [f64; 2] = [0.02, 0.01];
const ON_MOTORS: [f64; 2] = [0.01, 0.01];

/// Numbers that one slab of time has for each joint, in this order: torques on link and motor, K, D_l, D_m, M_m.
const CHANNELS: usize = 6;

/// While the reference gets going and at full speed.
const DURATION: f64 = 6.0;
const SLABS: usize = 300;

fn arm() -> (Scenario, Arm, Funnel) {
    let scenario = tolerant(load_scenario("two-link-hardware").expect("built in"), PARTS);
    let spread = spread(&scenario.robot.tolerances, [ON_MOTORS, ON_LINKS]);
    let start = vec![Interval::ZERO; 8];
    let request = FunnelRequest { spread, duration: DURATION, start, slabs: SLABS, room: 1.0 };
    let found = Funnel::along(&enclosed(&scenario), &request, &unwatched).expect("nobody breaks it off");
    let funnel = found.unwrap_or_else(|open| panic!("{open:?}"));
    let arm = floats::arm(&scenario);
    (scenario, arm, funnel)
}

fn errors(arm: &Arm, t: f64, x: &Motion<f64, 2>) -> [f64; 8] {
    let command = arm.command(t, x);
    let all = [command.e_l, command.e_m, command.s_l, command.s_m];
    std::array::from_fn(|i| all[i / 2][i % 2])
}

fn motion(arm: &Arm, t: f64, z: &[f64; 8]) -> Motion<f64, 2> {
    arm.motion(t, std::array::from_fn(|b| Vector([z[2 * b], z[2 * b + 1]])))
}

/// L⁻¹ z: by substitution.
fn reduced(lower: &Dense<f64>, z: &[f64; 8]) -> [f64; 8] {
    let mut y = *z;
    for i in 0..8 {
        for j in 0..i {
            y[i] -= lower[(i, j)] * y[j];
        }
        y[i] /= lower[(i, i)];
    }
    y
}

/// zᵀ (L Lᵀ)⁻¹ n.
fn product(lower: &Dense<f64>, z: &[f64; 8], n: &[f64; 8]) -> f64 {
    reduced(lower, z).iter().zip(reduced(lower, n)).map(|(a, b)| a * b).sum()
}

/// Errors on the surface of the ellipsoid L Lᵀ.
fn surface(lower: &Dense<f64>, r: &mut Random) -> [f64; 8] {
    let direction: [f64; 8] = std::array::from_fn(|_| r.next());
    let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
    std::array::from_fn(|i| (0..=i).map(|j| lower[(i, j)] * direction[j] / length).sum())
}

/// What goes through the channels of joint `i` of an arm that is off by `off`.
fn driving(arm: &Arm, off: &Numbers, t: f64, x: &Motion<f64, 2>, i: usize) -> [f64; CHANNELS] {
    let [stiffness, inertia, link_damping, motor_damping, motor, link] = off;
    let (robot, zeta) = (&arm.robot, x.deflection());
    let accelerates =
        arm.command(t, x).u_m[i] - robot.motor_damping[i] * x.v_m[i] - robot.stiffness[i] * zeta[i];
    [
        link[i],
        motor[i],
        stiffness[i] * zeta[i],
        -link_damping[i] * x.v_l[i],
        -motor_damping[i] * x.v_m[i],
        -inertia[i] * accelerates / robot.motor_inertia[i],
    ]
}

/// ż of robots that are off, by differences along their motion, is A z + Σ n w up to what is said to be left, and |w| is what is said at
/// most: at random times, in the funnel's ellipsoids.
#[test]
fn errors_move_as_the_flow_says() {
    let (scenario, arm, funnel) = arm();
    let (mut r, mut most, mut fullest) = (Random(5), 0.0_f64, [0.0_f64; CHANNELS]);
    for _ in 0..4000 {
        let piece = &funnel.pieces[r.below(SLABS)];
        let t = piece.time.lo() + 0.5 * (1.0 + r.next()) * (piece.time.hi() - piece.time.lo());
        // Any of the ellipsoids is in the tube that the flow is over.
        let z = surface(&piece.passage.0[r.below(piece.passage.0.len())].lower, &mut r);
        let x = motion(&arm, t, &z);
        let mut off = drawn(&scenario.robot.tolerances, ON_MOTORS, &mut r);
        off[5] = Vector(ON_LINKS.map(|most| most * r.next()));
        let rates = rates(&arm, &off, t, &x);
        let h = 1e-6;
        let [before, after] = [-h, h].map(|h| errors(&arm, t + h, &along(&x, &rates, h)));
        let flow = &piece.flow;
        assert_eq!(flow.channels.len(), 2 * CHANNELS);
        let mut expected: [f64; 8] =
            std::array::from_fn(|i| (0..8).map(|j| flow.matrix[(i, j)] * z[j]).sum::<f64>());
        for joint in 0..2 {
            for (k, w) in driving(&arm, &off, t, &x, joint).into_iter().enumerate() {
                let channel = &flow.channels[joint * CHANNELS + k];
                let slope = channel.slope.as_ref();
                let along: f64 = slope.map_or(0.0, |c| c.iter().zip(&z).map(|(c, z)| c * z).sum());
                let bound = channel.size + along.abs();
                assert!(w.abs() <= bound * (1.0 + 1e-9), "channel {k} of joint {joint}: {w} beyond {bound}");
                fullest[k] = fullest[k].max(w.abs() / bound);
                for (x, n) in expected.iter_mut().zip(&channel.column) {
                    *x += n * w;
                }
            }
        }
        for i in 0..8 {
            let rate = (after[i] - before[i]) / (2.0 * h);
            // Differences are good to 1e-9 of the reference's position over the step.
            let (left, slack) = ((rate - expected[i]).abs(), 1e-8 * (1.0 + rate.abs()));
            assert!(left <= flow.rest[i] + slack, "{i} at {t} s: {left} beyond {}", flow.rest[i]);
            most = most.max((left - slack) / flow.rest[i]);
        }
    }
    println!("{most:.3} of what is left, {fullest:.3?} of what channels bear");
    assert!(fullest.iter().all(|&part| part > 0.5), "{fullest:?}");
}

/// Motions from anywhere on the funnel's surface at random times, half of them under torques that jump at random between their bounds,
/// half under those that push outwards most, both `times` as large as the funnel is about. Largest V at ends of slabs, and at the end of each motion.
fn farthest(times: f64, runs: usize) -> [[f64; 2]; 2] {
    const LENGTH: usize = 12;
    let (scenario, arm, funnel) = arm();
    let (mut r, mut most, mut last) = (Random(6), [0.0_f64; 2], [0.0_f64; 2]);
    let bounds = [ON_LINKS, ON_MOTORS].map(|side| side.map(|torque| times * torque));
    for run in 0..runs {
        let pushed = run % 2;
        let mut off = drawn(&scenario.robot.tolerances, bounds[1], &mut r);
        let first = r.below(SLABS - LENGTH);
        let mut t = funnel.pieces[first].time.lo();
        let begin = surface(&funnel.pieces[first].passage.0[0].lower, &mut r);
        // 1e-9 inside: rounding.
        let mut x = motion(&arm, t, &begin.map(|z| z * (1.0 - 1e-9)));
        let mut v = 0.0;
        for piece in &funnel.pieces[first..first + LENGTH] {
            // Steps of a millisecond.
            let steps = 20;
            let step = (piece.time.hi() - piece.time.lo()) / f64::from(steps);
            for _ in 0..steps {
                for (side, joint) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let most = bounds[side][joint];
                    // Torques on links come last in the numbers, those on motors before.
                    let torque = &mut off[5 - side][joint];
                    if pushed == 1 {
                        let column = &piece.flow.channels[joint * CHANNELS + side].column;
                        let n = std::array::from_fn(|i| column[i]);
                        let outwards = product(&piece.passage.0[0].lower, &errors(&arm, t, &x), &n);
                        *torque = most.copysign(outwards);
                    } else if r.below(20) == 0 {
                        *torque = most.copysign(r.next());
                    }
                }
                x = later(&arm, &off, t, &x, step);
                t += step;
            }
            t = piece.time.hi();
            let z = errors(&arm, t, &x);
            v = product(&piece.passage.0[piece.passage.0.len() - 1].lower, &z, &z);
            most[pushed] = most[pushed].max(v);
        }
        last[pushed] = last[pushed].max(v);
    }
    [most, last]
}

/// A thousand motions stay, some of them far out; under torques twice as large some leave.
#[test]
fn no_motion_leaves() {
    let [most, last] = farthest(1.0, 1000);
    println!("V at ends of slabs {most:.3?}, of motions {last:.3?}: torques that jump, torques that push");
    assert!(most.iter().all(|&v| v <= 1.0), "{most:?}");
    // A funnel twice as wide as need be would be seen.
    assert!(last.iter().all(|&v| v > 0.25), "{last:?}");
    assert!(farthest(2.0, 100)[0].iter().any(|&v| v > 1.0));
}
