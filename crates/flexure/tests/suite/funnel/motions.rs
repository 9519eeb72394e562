//! Funnels against motions of robots within the tolerances, under torques that jump and torques that push outwards most.

use std::sync::Arc;

use flexure::core::linalg::Vector;
use flexure::core::model::Motion;
use flexure::core::robots::PlanarTwoLink;
use flexure::core::scalar::{Interval, Scalar as _};
use flexure::linalg::Dense;
use flexure::progress::unwatched;
use flexure::prove::engine::envelope::flow::Channel;
use flexure::prove::engine::envelope::funnel::{Funnel, FunnelRequest, Piece};
use flexure::prove::engine::envelope::slab::Slab;
use flexure::robot::{Links, Tolerances};
use flexure::scenario::{Scenario, load_scenario};

use crate::along::floats;
use crate::along::slabs::enclosed;
use crate::common::Random;
use crate::within::motions::{along, later, rates_with};
use crate::within::{Arm, Numbers, drawn, spread, tolerant};

/// A loop, and what a funnel of it is about.
struct Case {
    scenario: &'static str,
    /// Parts of K, M_m, D_l and D_m that robots are off by.
    parts: [f64; 4],
    /// Parts of the masses of both links, with their inertias.
    masses: [f64; 2],
    /// Torques on links and motors [N m].
    on_links: [f64; 2],
    on_motors: [f64; 2],
    /// In s: while the reference gets going and at full speed.
    duration: f64,
}

/// Gains of hardware.
const SOFT: Case = Case {
    scenario: "two-link-hardware",
    parts: [0.01, 0.01, 0.03, 0.03],
    masses: [0.0; 2],
    on_links: [0.02, 0.01],
    on_motors: [0.01, 0.01],
    duration: 6.0,
};

/// The paper's gains: springs and motors swing at 500 rad/s, ten times in the longest slab.
const STIFF: Case = Case {
    scenario: "two-link-tanh-smooth",
    parts: [2e-5, 2e-5, 1e-3, 1e-3],
    masses: [0.0; 2],
    on_links: [0.005, 0.002],
    on_motors: [0.005, 0.002],
    duration: 3.0,
};

/// Links that are heavier or lighter.
const HEAVY: Case = Case {
    scenario: "two-link-hardware",
    parts: [0.001, 0.001, 0.01, 0.01],
    masses: [0.1, 0.1],
    on_links: [0.005, 0.005],
    on_motors: [0.005, 0.005],
    duration: 6.0,
};

/// Numbers that one slab of time has for each joint, in this order: torques on link and motor, K, D_l, D_m, M_m.
const CHANNELS: usize = 6;

/// The robots of a case, and its funnel.
struct Funnelled {
    case: &'static Case,
    tolerances: Tolerances,
    scenario: Scenario,
    arm: Arm,
    pieces: Vec<Piece>,
}

fn funnelled(case: &'static Case) -> Funnelled {
    let mut scenario = tolerant(load_scenario(case.scenario).expect("built in"), case.parts);
    scenario.robot.tolerances.link_mass = case.masses.to_vec();
    let tolerances = scenario.robot.tolerances.clone();
    let request = FunnelRequest {
        spread: spread(&tolerances, [case.on_motors, case.on_links]),
        duration: case.duration,
        start: vec![Interval::ZERO; 8],
        slab: 0.02,
        room: 1.0,
        most: 40_000,
    };
    let found = Funnel::along(&enclosed(&scenario), &request, &unwatched).expect("nobody breaks it off");
    let funnel = found.unwrap_or_else(|open| panic!("{}: {open:?}", case.scenario));
    println!("{}: {} slabs, errors {:.6?}", case.scenario, funnel.pieces.len(), funnel.extents());
    Funnelled { case, tolerances, arm: floats::arm(&scenario), scenario, pieces: funnel.pieces }
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

/// Links of an arm whose masses are off, each with its inertia, and by which parts.
fn other_links(scenario: &Scenario, masses: [f64; 2], r: &mut Random) -> (PlanarTwoLink<f64>, [f64; 2]) {
    let Links::PlanarTwoLink(links) = &scenario.robot.links else { panic!("two links") };
    let parts = masses.map(|most| if r.below(3) == 0 { most * r.next() } else { most.copysign(r.next()) });
    let times = |values: [f64; 2]| std::array::from_fn(|i| values[i] * (1.0 + parts[i]));
    (PlanarTwoLink::new(times(links.mass), links.length[0], links.com, times(links.inertia)), parts)
}

/// |C z|.
fn length(slopes: &[Vec<f64>], z: &[f64; 8]) -> f64 {
    let square = |slope: &Vec<f64>| slope.iter().zip(z).map(|(c, z)| c * z).sum::<f64>().powi(2);
    slopes.iter().map(square).sum::<f64>().sqrt()
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
/// most: at random times, in the funnel's ellipsoids. The largest parts of both that were seen.
fn flows(case: &'static Case, samples: usize) -> (f64, [f64; CHANNELS]) {
    let Funnelled { tolerances, scenario, arm, pieces, .. } = funnelled(case);
    let (mut r, mut most, mut fullest) = (Random(5), 0.0_f64, [0.0_f64; CHANNELS]);
    for _ in 0..samples {
        let piece = &pieces[r.below(pieces.len())];
        let t = piece.time.lo() + 0.5 * (1.0 + r.next()) * (piece.time.hi() - piece.time.lo());
        // Any of the ellipsoids is in the tube that the flow is over.
        let z = surface(&piece.passage.0[r.below(piece.passage.0.len())].lower, &mut r);
        let x = motion(&arm, t, &z);
        let mut off = drawn(&tolerances, case.on_motors, &mut r);
        off[5] = Vector(case.on_links.map(|most| most * r.next()));
        let (links, heavier) = other_links(&scenario, case.masses, &mut r);
        let rates = rates_with(&links, &arm, &off, t, &x);
        let h = 1e-6;
        let [before, after] = [-h, h].map(|h| errors(&arm, t + h, &along(&x, &rates, h)));
        let flow = &piece.flow;
        let matrix = flow.at(Interval::point(t));
        let mut expected: [f64; 8] =
            std::array::from_fn(|i| (0..8).map(|j| matrix[(i, j)].midpoint() * z[j]).sum::<f64>());
        let (of_joints, others) = flow.channels.split_at(2 * CHANNELS);
        let late = Interval::point(t - flow.time);
        let columns = |channel: &Channel| {
            channel
                .at(late)
                .into_iter()
                .map(|n| n.iter().map(|x| x.midpoint()).collect::<Vec<_>>())
                .collect::<Vec<_>>()
        };
        for joint in 0..2 {
            for (k, w) in driving(&arm, &off, t, &x, joint).into_iter().enumerate() {
                let channel = &of_joints[joint * CHANNELS + k];
                let bound = channel.size + length(&channel.slopes, &z);
                assert!(w.abs() <= bound * (1.0 + 1e-9), "channel {k} of joint {joint}: {w} beyond {bound}");
                fullest[k] = fullest[k].max(w.abs() / bound);
                for (x, n) in expected.iter_mut().zip(&columns(channel)[0]) {
                    *x += n * w;
                }
            }
        }
        // Masses are one number a link. How loads differ from those on the reference, and what inverse masses leave open, is not told apart.
        let loads = if tolerances.masses_are_none() { 0 } else { 2 };
        assert_eq!(others.len(), 2 * loads + 2);
        let mut open = flow.rest.clone();
        for (k, channel) in others.iter().enumerate() {
            let bound = channel.size + length(&channel.slopes, &z);
            for (column, i) in columns(channel).iter().flat_map(|column| (0..8).map(move |i| (column, i))) {
                if k < loads {
                    expected[i] -= heavier[k] * column[i];
                } else {
                    open[i] += bound * column[i].abs();
                }
            }
        }
        for i in 0..8 {
            let rate = (after[i] - before[i]) / (2.0 * h);
            // Differences are good to 1e-9 of the reference's position over the step.
            let (left, slack) = ((rate - expected[i]).abs(), 1e-8 * (1.0 + rate.abs()));
            assert!(left <= open[i] + slack, "{i} at {t} s: {left} beyond {}", open[i]);
            most = most.max((left - slack) / open[i]);
        }
    }
    println!("{most:.3} of what is left, {fullest:.3?} of what channels bear");
    (most, fullest)
}

#[test]
fn errors_move_as_the_flow_says() {
    for case in [&SOFT, &STIFF, &HEAVY] {
        let (_, fullest) = flows(case, 4000);
        assert!(fullest.iter().all(|&part| part > 0.5), "{fullest:?}");
    }
}

/// How fast motor torques change, by differences along motions of robots that are off from ellipsoids of the funnel at random times, half of them where that is
/// most: the largest part of what is said to be the most.
fn fastest(case: &'static Case, samples: usize) -> f64 {
    let Funnelled { tolerances, scenario, arm, pieces, .. } = funnelled(case);
    let system = enclosed(&scenario);
    let (mut r, mut fullest) = (Random(7), 0.0_f64);
    for sample in 0..samples {
        let piece = &pieces[r.below(pieces.len())];
        let slab =
            Slab::of(&system, Arc::new(piece.passage.clone()), piece.time, &|| true).expect("it goes on");
        let t = piece.time.lo() + 0.5 * (1.0 + r.next()) * (piece.time.hi() - piece.time.lo());
        let lower = &piece.passage.0[r.below(piece.passage.0.len())].lower;
        let mut off = drawn(&tolerances, case.on_motors, &mut r);
        off[5] = Vector(case.on_links.map(|most| most.copysign(r.next())));
        let (links, _) = other_links(&scenario, case.masses, &mut r);
        for i in 0..2 {
            let rate = |z: &[f64; 8], off: &Numbers| {
                let x = motion(&arm, t, z);
                let rates = rates_with(&links, &arm, off, t, &x);
                let h = 1e-6;
                let [before, after] = [-h, h].map(|h| arm.command(t + h, &along(&x, &rates, h)).u_m[i]);
                (after - before) / (2.0 * h)
            };
            let mut z = surface(lower, &mut r);
            if sample % 2 == 0 {
                // Along X g, g how the rate depends on the errors: about linear in so small ones.
                let unit = |j: usize, x: f64| std::array::from_fn(|k| if k == j { x } else { 0.0 });
                let step = |j: usize| (0..8).map(|k| lower[(j, k)].abs()).sum::<f64>();
                let g: [f64; 8] = std::array::from_fn(|j| {
                    (rate(&unit(j, step(j)), &off) - rate(&unit(j, -step(j)), &off)) / (2.0 * step(j))
                });
                let pulled: [f64; 8] = std::array::from_fn(|k| (k..8).map(|j| lower[(j, k)] * g[j]).sum());
                let length = pulled.iter().map(|x| x * x).sum::<f64>().sqrt().copysign(rate(&[0.0; 8], &off));
                z = std::array::from_fn(|j| (0..=j).map(|k| lower[(j, k)] * pulled[k] / length).sum());
            }
            let [drift, moved] = slab.rates(4 + i, &piece.flow);
            let bound = (drift + moved).magnitude();
            // Rounding of torques over a step of 2 µs.
            let part = (rate(&z.map(|z| z * (1.0 - 1e-9)), &off).abs() - 1e-6) / bound;
            assert!(part <= 1.0, "joint {i} at {t} s: {part} of {bound}");
            fullest = fullest.max(part);
        }
    }
    println!("{fullest:.3} of how fast torques are said to change at most");
    fullest
}

#[test]
fn torques_change_as_fast_as_is_said() {
    for (case, most) in [(&SOFT, 0.9), (&STIFF, 0.9), (&HEAVY, 0.8)] {
        assert!(fastest(case, 400) > most);
    }
}

/// Motions from anywhere on the funnel's surface at random times, half of them under torques that jump at random between their bounds,
/// half under those that push outwards most, both `times` as large as the funnel is about. Largest V at ends of slabs, and at the end of each motion.
fn farthest(funnelled: &Funnelled, times: f64, runs: usize) -> [[f64; 2]; 2] {
    const LENGTH: usize = 12;
    let Funnelled { case, tolerances, scenario, arm, pieces } = funnelled;
    let (mut r, mut most, mut last) = (Random(6), [0.0_f64; 2], [0.0_f64; 2]);
    let bounds = [case.on_links, case.on_motors].map(|side| side.map(|torque| times * torque));
    for run in 0..runs {
        let pushed = run % 2;
        let mut off = drawn(tolerances, bounds[1], &mut r);
        let (links, _) = other_links(scenario, case.masses, &mut r);
        let first = r.below(pieces.len() - LENGTH);
        let mut t = pieces[first].time.lo();
        let begin = surface(&pieces[first].passage.0[0].lower, &mut r);
        // 1e-9 inside: rounding.
        let mut x = motion(arm, t, &begin.map(|z| z * (1.0 - 1e-9)));
        let mut v = 0.0;
        for piece in &pieces[first..first + LENGTH] {
            // Of a millisecond or less, and stable.
            let fastest = (0..8).map(|i| piece.flow.matrix[(i, i)].abs()).fold(500.0, f64::max);
            let length = piece.time.hi() - piece.time.lo();
            let end = piece.time.hi();
            let step = length / (2.0 * fastest * length).ceil();
            while t < end - 0.5 * step {
                for (side, joint) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let most = bounds[side][joint];
                    // Torques on links come last in the numbers, those on motors before.
                    let torque = &mut off[5 - side][joint];
                    if pushed == 1 {
                        let column = &piece.flow.channels[joint * CHANNELS + side].columns[0];
                        let n = std::array::from_fn(|i| column[i]);
                        let outwards = product(&piece.passage.0[0].lower, &errors(arm, t, &x), &n);
                        *torque = most.copysign(outwards);
                    } else if r.below(20) == 0 {
                        *torque = most.copysign(r.next());
                    }
                }
                x = later(|t, x| rates_with(&links, arm, &off, t, x), t, &x, step);
                t += step;
            }
            t = piece.time.hi();
            let z = errors(arm, t, &x);
            v = product(&piece.passage.0[piece.passage.0.len() - 1].lower, &z, &z);
            assert!(v.is_finite());
            most[pushed] = most[pushed].max(v);
        }
        last[pushed] = last[pushed].max(v);
    }
    [most, last]
}

/// A thousand motions stay, some of them far out; under torques several times as large some leave.
#[test]
fn no_motion_leaves() {
    for (case, larger, runs) in [(&SOFT, 2.0, 1000), (&STIFF, 4.0, 200), (&HEAVY, 4.0, 1000)] {
        let funnelled = funnelled(case);
        let [most, last] = farthest(&funnelled, 1.0, runs);
        println!(
            "V at ends of slabs {most:.3?}, of motions {last:.3?}: torques that jump, torques that push"
        );
        assert!(most.iter().all(|&v| v <= 1.0), "{most:?}");
        // A funnel several times as wide as need be would be seen.
        assert!(last.iter().all(|&v| v > 0.1), "{last:?}");
        assert!(farthest(&funnelled, larger, 100)[0].iter().any(|&v| v > 1.0));
    }
}
