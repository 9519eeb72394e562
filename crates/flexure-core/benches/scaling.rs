//! How time grows with the number of joints: `cargo bench -p flexure-core --bench scaling`.
//!
//! A row per function: µs on chains of n revolute joints, and the slope of log time against log n by least squares, which is 1 for
//! O(n): between 8 and 64, and between 16 and 64. With 8 joints the mass matrix is dense, which takes six tenths of the time of the articulated bodies
//! that it is from 16 on. Times are the least of many, so that what else the machine does hurts little.
//! The exact statement, in operations instead of time, is `tests/suite/operation_counts.rs`.

use std::hint::black_box;
use std::time::{Duration, Instant};

use flexure_core::control::Input;
use flexure_core::model::{FeedForward, Links, MassFactor};

#[path = "../tests/suite/common/mod.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod common;
use common::{Numbers, flexible, gains, serial, tanh};

/// Joints.
const SIZES: [usize; 5] = [7, 8, 16, 32, 64];

fn main() {
    // Rounds over everything, so that a slow spell of the machine falls on all alike.
    let mut all = [const { Vec::new() }; SIZES.len()];
    for _ in 0..40 {
        let round = [chain::<7>(), chain::<8>(), chain::<16>(), chain::<32>(), chain::<64>()];
        for (least, now) in all.iter_mut().zip(round) {
            if least.is_empty() {
                *least = now;
            } else {
                for (least, now) in least.iter_mut().zip(now) {
                    least.1 = least.1.min(now.1);
                }
            }
        }
    }
    print!("{:28}", "µs on chains of n joints");
    for n in SIZES {
        print!("{n:>9}");
    }
    println!("     8–64    16–64");
    for (i, (name, _)) in all[0].iter().enumerate() {
        let times = all.each_ref().map(|of_a_chain| of_a_chain[i].1);
        print!("{name:28}");
        for time in times {
            print!("{:9.3}", 1e6 * time);
        }
        println!("{:9.3}{:9.3}", slope(&times, 1), slope(&times, 2));
    }
}

/// Least-squares slope of log time against log n, without the first `skipped` sizes.
fn slope(times: &[f64; SIZES.len()], skipped: usize) -> f64 {
    let points: Vec<_> =
        SIZES.iter().zip(times).skip(skipped).map(|(&n, time)| ((n as f64).ln(), time.ln())).collect();
    let count = points.len() as f64;
    let (sum_x, sum_y) = points.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x, b + y));
    let (x0, y0) = (sum_x / count, sum_y / count);
    let (covariance, variance) =
        points.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + (x - x0) * (y - y0), b + (x - x0) * (x - x0)));
    covariance / variance
}

/// Seconds that a call of `f` takes: the least over runs of at least 50 µs, for some milliseconds.
fn time<R>(mut f: impl FnMut() -> R) -> f64 {
    let mut run = |calls: u32| {
        let start = Instant::now();
        for _ in 0..calls {
            black_box(f());
        }
        start.elapsed()
    };
    let mut calls = 1;
    while run(calls) < Duration::from_micros(50) {
        calls *= 2;
    }
    (0..20).map(|_| run(calls)).min().unwrap_or_default().as_secs_f64() / f64::from(calls)
}

/// Everything on a chain of `N` joints.
fn chain<const N: usize>() -> Vec<(&'static str, f64)> {
    let mut r = Numbers(1);
    let robot = flexible(serial::<N>(), &mut r);
    let law = gains(tanh, false, &mut r);
    let (x, a) = (r.motion::<N>(1.0), r.vector::<N>(1.0));
    let (q_2, q_4, q_ld) = (r.series::<5, N>(1.0), r.series::<7, N>(1.0), r.series::<5, N>(1.0));
    let omega = Input::ZERO;
    let links = &robot.links;
    vec![
        (
            "inverse dynamics",
            time(|| {
                let x = black_box(&x);
                black_box(links).inverse_dynamics(&x.q_l, &x.v_l, &x.v_l, black_box(&a))
            }),
        ),
        (
            "modified Newton–Euler",
            time(|| {
                let x = black_box(&x);
                black_box(links).inertial_torque(&x.q_l, &x.v_l, &x.v_m, black_box(&a))
            }),
        ),
        ("factor and solve", time(|| black_box(links).factor(&black_box(&x).q_l).solve(black_box(&a)))),
        (
            "forward dynamics",
            time(|| {
                let x = black_box(&x);
                black_box(links).forward_dynamics(&x.q_l, &x.v_l, black_box(&a))
            }),
        ),
        ("torque with two derivatives", time(|| black_box(links).torque_along::<_, 3, 5>(black_box(&q_2)))),
        (
            "flexible inverse dynamics",
            time(|| -> FeedForward<f64, N, 3, 5> { black_box(&robot).inverse_dynamics(black_box(&q_4)) }),
        ),
        (
            "law",
            time(|| {
                black_box(&law).command(black_box(&robot), black_box(&x), black_box(&q_ld), black_box(&omega))
            }),
        ),
    ]
}
