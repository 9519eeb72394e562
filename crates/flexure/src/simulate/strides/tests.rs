//! Strides against the integrator, which is their oracle.

mod again;
mod robots;

use std::array;

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::robots::Pendulum;
use flexure_core::scalar::{Lane, Lanes, Piecewise as _};

use self::robots::{Branches, Kind, OneLink, Panda, TwoLink, torques};
use super::{Effort, STILL, Strides, is_solved, likely, replace, taken};
use crate::plant::Plant;
use crate::simulate::collocation::{Collocation, Past, Task};
use crate::simulate::gauss::{Integrator, Order, SOLVED};
use crate::simulate::ledger::Ledger;

const PERIOD: f64 = 1e-3;
const TOLERANCE: f64 = 1e-7;
const EFFORT: Effort = Effort { parts: 1, corrections: 2, kept: 1 };

/// Plants moved together, and one by one where strides are not trusted.
struct Rode<const N: usize, const W: usize> {
    end: [Motion<f64, N>; W],
    work: [Ledger; W],
    /// Periods that were trusted, per lane.
    trusted: [usize; W],
}

/// Moves `plants` over the periods of `torques`, each held for a period, as a block of loops does.
fn ride<One, L, const S: usize, const N: usize, const W: usize>(
    (plants, links): (&[Plant<One, N>; W], L),
    start: [Motion<f64, N>; W],
    torques: &[[Vector<f64, N>; W]],
    (tolerance, effort): (f64, Effort),
) -> Rode<N, W>
where
    f64: Lane<W>,
    One: Links<f64, N>,
    L: Links<Lanes<f64, W>, N>,
{
    let plant = Plant::together(links, plants.each_ref()).expect("smooth");
    let mut strides = Strides::<S, N, W>::new(tolerance, effort);
    let mut integrators = [(); W].map(|()| Integrator::new(tolerance));
    let mut x = together(start);
    let (mut work, mut trusted) = ([Ledger::default(); W], [0; W]);
    for torques in torques {
        let strode = strides.advance(&plant, &x, &in_lanes(torques), PERIOD);
        let mut end = strode.end;
        for w in 0..W {
            if strode.trusted[w] {
                trusted[w] += 1;
                work[w].add(&booked(&strode.work, w));
                continue;
            }
            let (one, again) =
                redone(&mut strides, w, &mut integrators[w], &plants[w], taken(&x, w), torques[w]);
            work[w].add(&again);
            replace(&mut end, w, &one);
        }
        x = end;
    }
    Rode { end: array::from_fn(|w| taken(&x, w)), work, trusted }
}

/// A lane is moved over the last period once more, by its own integrator: where it leads to, and the work.
fn redone<One: Links<f64, N>, const S: usize, const N: usize, const W: usize>(
    strides: &mut Strides<S, N, W>,
    lane: usize,
    integrator: &mut Integrator<N>,
    plant: &Plant<One, N>,
    x: Motion<f64, N>,
    u_m: Vector<f64, N>,
) -> (Motion<f64, N>, Ledger)
where
    f64: Lane<W>,
{
    // Where it was last is not where this one starts.
    integrator.forget();
    let mut work = Ledger::ZERO;
    let end = integrator.advance(plant, x, 0.0, PERIOD, &|_, _: &_| u_m, &mut work).expect("bounded");
    strides.resume(lane, integrator);
    (end, work)
}

/// Corrections that shrink are believed, and no others.
#[test]
fn what_does_not_shrink_is_not_solved() {
    assert!(is_solved(1e-3, 1e-7, 1e-10) && is_solved(0.0, 1e-11, 1e-10) && is_solved(1.0, 1e-10, 1e-10));
    assert!(
        !is_solved(1e-3, 1e-6, 1e-10) && !is_solved(1e-9, 0.9e-9, 1e-9 * 0.5) && !is_solved(0.0, 1e-9, 1e-10)
    );
    assert!(!is_solved(f64::NAN, f64::NAN, 1e-10) && !is_solved(1.0, f64::NAN, 1e-10));
}

/// The same by the integrator alone, a lane at a time.
fn alone<One: Links<f64, N>, const N: usize>(
    plant: &Plant<One, N>,
    start: Motion<f64, N>,
    torques: impl Iterator<Item = Vector<f64, N>>,
    tolerance: f64,
) -> (Motion<f64, N>, Ledger) {
    let (mut integrator, mut work) = (Integrator::new(tolerance), Ledger::default());
    let end = torques.fold(start, |x, u| {
        integrator.advance(plant, x, 0.0, PERIOD, &|_, _: &_| u, &mut work).expect("bounded")
    });
    (end, work)
}

fn together<const N: usize, const W: usize>(each: [Motion<f64, N>; W]) -> Motion<Lanes<f64, W>, N>
where
    f64: Lane<W>,
{
    let mut x = Motion::at_rest(Vector::ZERO);
    for (lane, one) in each.iter().enumerate() {
        replace(&mut x, lane, one);
    }
    x
}

fn in_lanes<const N: usize, const W: usize>(each: &[Vector<f64, N>; W]) -> Vector<Lanes<f64, W>, N>
where
    f64: Lane<W>,
{
    Vector::from_fn(|k| Lanes::from_array(array::from_fn(|w| each[w][k])))
}

fn booked<const W: usize>(work: &Ledger<Lanes<f64, W>>, lane: usize) -> Ledger
where
    f64: Lane<W>,
{
    let one = |lanes: Lanes<f64, W>| lanes.to_array()[lane];
    let Ledger { supplied, dissipated, throughput } = *work;
    Ledger { supplied: one(supplied), dissipated: one(dissipated), throughput: one(throughput) }
}

/// The largest difference of any position or velocity, in rad or rad/s.
fn distance<const N: usize>(a: &Motion<f64, N>, b: &Motion<f64, N>) -> f64 {
    [a.q_l - b.q_l, a.q_m - b.q_m, a.v_l - b.v_l, a.v_m - b.v_m]
        .iter()
        .flat_map(|v| v.0)
        .fold(0.0, |m: f64, x| m.max(x.abs()))
}

/// Over a second of torques at random, as far off as the integrator is at the same tolerance, or by the local errors of a few steps.
fn goes_along<K: Kind<N>, const S: usize, const N: usize, const W: usize>(corrections: usize, share: f64)
where
    f64: Lane<W>,
{
    let effort = Effort { corrections, kept: 10, ..EFFORT };
    let numbers: [usize; W] = array::from_fn(|lane| lane);
    let (plants, start) = (numbers.map(K::plant), numbers.map(K::start));
    let torques = torques::<K, N, W>(numbers, 1000);
    let rode = ride::<_, _, S, N, W>((&plants, K::links(numbers)), start, &torques, (TOLERANCE, effort));
    for w in [0, W - 1] {
        let own = || torques.iter().map(|torques| torques[w]);
        let (exact, of_exact) = alone(&plants[w], start[w], own(), 1e-12);
        let (scalar, _) = alone(&plants[w], start[w], own(), TOLERANCE);
        let what = format!("{} with S = {S}, lane {w} of {W}", std::any::type_name::<K>());
        let off = [&rode.end[w], &scalar].map(|end| distance(end, &exact));
        let trusted = rode.trusted[w] as f64 / torques.len() as f64;
        println!("{what}: {off:?}, trusted {trusted}");
        assert!(off[0] <= 2.0 * off[1] + 5.0 * TOLERANCE, "{what}: {off:?}");
        assert!(trusted >= share, "{what}: {trusted}");
        let work = rode.work[w];
        let gaps = [work.supplied - of_exact.supplied, work.dissipated - of_exact.dissipated];
        assert!(gaps.iter().all(|gap| gap.abs() < 1e-6 * of_exact.throughput), "{what}: {gaps:?}");
        // Its integrand has corners, where stages lie otherwise.
        assert!((work.throughput / of_exact.throughput - 1.0).abs() < 1e-3, "{what}: {work:?}");
    }
}

#[test]
fn strides_go_where_the_integrator_goes() {
    goes_along::<TwoLink, 2, 2, 2>(2, 0.9);
    goes_along::<TwoLink, 4, 2, 4>(2, 0.5);
    goes_along::<TwoLink, 2, 2, 8>(2, 0.9);
    goes_along::<OneLink, 2, 1, 4>(2, 0.9);
    goes_along::<OneLink, 4, 1, 8>(2, 0.9);
    // Fast springs that swing are too much for the lower order.
    goes_along::<Panda, 2, 8, 2>(2, 0.0);
    goes_along::<Panda, 4, 8, 2>(4, 0.9);
    goes_along::<Branches, 2, 8, 4>(3, 0.2);
}

/// Each stride that is trusted is the scalar step that is accepted, its equations solved as far as was asked for.
fn is_solved_as_asked<K: Kind<N>, const S: usize, const N: usize>(corrections: usize)
where
    f64: Lane<S> + Lane<2>,
{
    let numbers = [0, 1];
    let plants = numbers.map(K::plant);
    let plant = Plant::together(K::links(numbers), plants.each_ref()).expect("smooth");
    let mut strides = Strides::<S, N, 2>::new(TOLERANCE, Effort { corrections, kept: 10, ..EFFORT });
    let mut x = together(numbers.map(K::start));
    let what = format!("{} with S = {S}", std::any::type_name::<K>());
    let (mut worst, mut count) = (0.0_f64, 0);
    for torques in &torques::<K, N, 2>(numbers, 200) {
        let strode = strides.advance(&plant, &x, &in_lanes(torques), PERIOD);
        for w in (0..2).filter(|&w| strode.trusted[w]) {
            let from = taken(&x, w);
            let task =
                Task { plant: &plants[w], x: &from, t: 0.0, h: PERIOD, torque: &|_, _: &_| torques[w] };
            let step =
                Collocation::<S, N>::new().step(&task, &mut Past::NONE.clone(), 1e-16).expect("solvable");
            assert!(step.error <= 1.01 * TOLERANCE, "{what}: {:e}", step.error);
            let got = taken(&strode.end, w);
            for (start, end, solved) in [(from.v_l, got.v_l, step.end.v_l), (from.v_m, got.v_m, step.end.v_m)]
            {
                for k in 0..N {
                    let speed = start[k].abs() + (solved[k] - start[k]).abs() + 1e-3;
                    worst = worst.max(((end[k] - solved[k]).abs() - STILL) / speed);
                }
            }
            count += 1;
        }
        x = strode.end;
    }
    println!("{what}: {worst:e} where {count} are trusted");
    assert!(worst <= 2.0 * SOLVED * TOLERANCE, "{what}: {worst:e}");
}

#[test]
fn what_is_trusted_is_solved_as_asked() {
    is_solved_as_asked::<TwoLink, 2, 2>(2);
    is_solved_as_asked::<TwoLink, 4, 2>(2);
    is_solved_as_asked::<OneLink, 2, 1>(2);
    is_solved_as_asked::<Panda, 2, 8>(2);
    is_solved_as_asked::<Panda, 4, 8>(2);
    is_solved_as_asked::<Panda, 4, 8>(4);
    is_solved_as_asked::<Branches, 2, 8>(3);
}

/// The bits of one robot over some periods among others, all moved by strides only.
fn bits<K: Kind<N>, const S: usize, const N: usize>(
    numbers: [usize; 4],
    lane: usize,
    spoil: impl Fn(&mut Motion<Lanes<f64, 4>, N>, usize),
) -> Vec<u64> {
    let plants = numbers.map(K::plant);
    let plant = Plant::together(K::links(numbers), plants.each_ref()).expect("smooth");
    let mut strides = Strides::<S, N, 4>::new(TOLERANCE, Effort { kept: 3, ..EFFORT });
    let mut x = together(numbers.map(K::start));
    let mut bits = Vec::new();
    for (k, torques) in torques::<K, N, 4>(numbers, 40).iter().enumerate() {
        spoil(&mut x, k);
        let strode = strides.advance(&plant, &x, &in_lanes(torques), if k % 7 == 3 { 4e-4 } else { PERIOD });
        x = strode.end;
        let one = taken(&x, lane);
        let Ledger { supplied, dissipated, throughput } = booked(&strode.work, lane);
        let parts = [one.q_l, one.q_m, one.v_l, one.v_m];
        let numbers = parts.iter().flat_map(|v| v.0).chain([supplied, dissipated, throughput]);
        bits.extend(numbers.map(f64::to_bits));
        bits.extend([u64::from(strode.trusted[lane]), strode.error.to_array()[lane].to_bits()]);
    }
    bits
}

fn is_independent<K: Kind<N>, const S: usize, const N: usize>() {
    let expected = bits::<K, S, N>([3, 0, 1, 2], 0, |_, _| ());
    let others = [([7, 5, 3, 4], 2), ([3, 3, 3, 3], 1), ([6, 0, 9, 3], 3)];
    for (numbers, lane) in others {
        assert!(bits::<K, S, N>(numbers, lane, |_, _| ()) == expected, "{numbers:?}, lane {lane}");
        // Neighbours that leave the numbers.
        let spoil = |x: &mut Motion<Lanes<f64, 4>, N>, k: usize| {
            for other in (0..4).filter(|&other| other != lane) {
                let value = [f64::NAN, f64::INFINITY, 1e300, -0.0][(k + other) % 4];
                replace(x, other, &Motion { v_l: Vector([value; N]), ..taken(x, other) });
            }
        };
        assert!(bits::<K, S, N>(numbers, lane, spoil) == expected, "{numbers:?}, lane {lane}, spoilt");
    }
}

#[test]
fn a_lane_is_what_it_is_whatever_its_neighbours_are() {
    is_independent::<TwoLink, 2, 2>();
    is_independent::<OneLink, 4, 1>();
    is_independent::<Branches, 2, 8>();
}

/// One step after a few that lead on, by strides with many corrections and by the scalar code.
fn as_the_scalar_step<K: Kind<N>, const S: usize, const N: usize>()
where
    f64: Lane<S> + Lane<2>,
{
    let effort = Effort { corrections: 12, ..EFFORT };
    let numbers = [0, 1];
    let plants = numbers.map(K::plant);
    let plant = Plant::together(K::links(numbers), plants.each_ref()).expect("smooth");
    let mut strides = Strides::<S, N, 2>::new(TOLERANCE, effort);
    let mut x = together(numbers.map(K::start));
    for torques in &torques::<K, N, 2>(numbers, 20) {
        let strode = strides.advance(&plant, &x, &in_lanes(torques), PERIOD);
        for (w, plant) in plants.iter().enumerate() {
            let from = taken(&x, w);
            let task = Task { plant, x: &from, t: 0.0, h: PERIOD, torque: &|_, _: &_| torques[w] };
            let mut scalar = Collocation::<S, N>::new();
            let step = scalar.step(&task, &mut Past::NONE.clone(), 1e-16).expect("solvable");
            let gap = distance(&taken(&strode.end, w), &step.end);
            assert!(gap < 1e-12, "{gap:e}");
            let [error, work] = [strode.error.to_array()[w], booked(&strode.work, w).supplied];
            assert!((error / step.error - 1.0).abs() < 1e-4 || error < 1e-12, "{error:e} {:e}", step.error);
            assert!((work - step.work.supplied).abs() < 1e-12 * step.work.throughput + 1e-16, "{work:e}");
            let [lost, expected] = [booked(&strode.work, w).dissipated, step.work.dissipated];
            assert!((lost - expected).abs() < 1e-10 * expected.abs() + 1e-16, "{lost:e} {expected:e}");
        }
        x = strode.end;
    }
}

#[test]
fn ends_errors_and_work_are_those_of_the_scalar_step() {
    as_the_scalar_step::<TwoLink, 2, 2>();
    as_the_scalar_step::<TwoLink, 4, 2>();
    as_the_scalar_step::<OneLink, 2, 1>();
    as_the_scalar_step::<Panda, 2, 8>();
    as_the_scalar_step::<Branches, 4, 8>();
}

/// What is trusted of one stride of pendulums as `change` has them, from a start that `spoil` has changed, after some that are trusted.
fn trusted(
    change: impl Fn(&mut Plant<<OneLink as Kind<1>>::Of<f64>, 1>),
    spoil: impl Fn(&mut Motion<f64, 1>, &mut Vector<f64, 1>),
) -> [bool; 4] {
    let numbers = [0, 2, 4, 6];
    let mut plants = numbers.map(OneLink::plant);
    change(&mut plants[1]);
    let plant = Plant::together(OneLink::links(numbers), plants.each_ref()).expect("smooth");
    let mut strides = Strides::<2, 1, 4>::new(TOLERANCE, EFFORT);
    let mut x = together(numbers.map(OneLink::start));
    let mut u = [Vector([0.0]); 4];
    for _ in 0..5 {
        x = strides.advance(&plant, &x, &in_lanes(&u), PERIOD).end;
    }
    let mut one = taken(&x, 1);
    spoil(&mut one, &mut u[1]);
    replace(&mut x, 1, &one);
    strides.advance(&plant, &x, &in_lanes(&u), PERIOD).trusted
}

#[test]
fn what_fixed_work_does_not_solve_is_not_trusted() {
    assert_eq!(trusted(|_| (), |_, _| ()), [true; 4]);
    let not_the_second = [true, false, true, true];
    for value in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e200] {
        assert_eq!(trusted(|_| (), |x, _| x.q_l[0] = value), not_the_second, "q_l = {value}");
        assert_eq!(trusted(|_| (), |x, _| x.v_m[0] = value), not_the_second, "v_m = {value}");
        assert_eq!(trusted(|_| (), |_, u| u[0] = value), not_the_second, "u_m = {value}");
    }
    // A torque that jumps on a spring that swings twice in the period.
    let stiff = |plant: &mut Plant<_, 1>| plant.robot.stiffness[0] = 1e6;
    assert_eq!(trusted(stiff, |_, u| u[0] = 1.0), not_the_second);
    // A spring whose stiffness grows with every correction.
    let hard = |plant: &mut Plant<_, 1>| plant.spring_hardening[0] = 1e8;
    assert_eq!(trusted(hard, |x, _| x.q_m[0] += 0.1), not_the_second);
}

#[test]
fn an_interval_in_parts_is_as_many_intervals() {
    let plants = [0, 1].map(TwoLink::plant);
    let plant = Plant::together(TwoLink::links([0, 1]), plants.each_ref()).expect("smooth");
    let x = together([0, 1].map(TwoLink::start));
    let u = Vector([0.3, 2.0]).map(Lanes::splat);
    let whole =
        Strides::<2, 2, 2>::new(TOLERANCE, Effort { parts: 2, ..EFFORT }).advance(&plant, &x, &u, PERIOD);
    let mut strides = Strides::<2, 2, 2>::new(TOLERANCE, EFFORT);
    let first = strides.advance(&plant, &x, &u, 0.5 * PERIOD);
    let second = strides.advance(&plant, &first.end, &u, 0.5 * PERIOD);
    let mut work = booked(&first.work, 0);
    work.add(&booked(&second.work, 0));
    assert_eq!((whole.end, booked(&whole.work, 0)), (second.end, work));
    let bits = |lanes: Lanes<f64, 2>| lanes.to_array().map(f64::to_bits);
    assert_eq!(bits(whole.error), bits(first.error.max(second.error)));
    assert_eq!(whole.trusted, array::from_fn(|w| first.trusted[w] && second.trusted[w]));
}

/// The iteration matrix of a linear joint is all there is to its equations: one correction solves them, whatever the spring.
fn is_solved_at_once<const S: usize>() {
    let joint = |weight_moment: f64, stiffness: f64| {
        let links = Pendulum { inertia: 0.1, weight_moment };
        let (motor_inertia, stiffness) = (Vector([0.02]), Vector([stiffness]));
        let (link_damping, motor_damping) = (Vector([0.3]), Vector([4.0]));
        Plant::from(Fjr { links, motor_inertia, stiffness, link_damping, motor_damping })
    };
    let plants = [joint(0.0, 1e2), joint(0.0, 1e5)];
    let links = Pendulum { inertia: Lanes::splat(0.1), weight_moment: Lanes::splat(0.0) };
    let plant = Plant::together(links, plants.each_ref()).expect("smooth");
    let x = together([Motion { v_l: Vector([1.0]), ..Motion::at_rest(Vector([0.2])) }; 2]);
    let [one, more] = [1, 3].map(|corrections| {
        let effort = Effort { corrections, ..EFFORT };
        let mut strides = Strides::<S, 1, 2>::new(TOLERANCE, effort);
        // What comes after the first is not corrected more often than was asked for.
        let x = strides.advance(&plant, &x, &Vector([Lanes::splat(1.0)]), PERIOD).end;
        strides.advance(&plant, &x, &Vector([Lanes::splat(5.0)]), PERIOD).end
    });
    for w in 0..2 {
        let gap = distance(&taken(&one, w), &taken(&more, w));
        assert!(gap < 1e-12, "lane {w}, S = {S}: {gap:e}");
    }
}

#[test]
fn linear_joints_are_solved_by_one_correction() {
    is_solved_at_once::<2>();
    is_solved_at_once::<4>();
}

#[test]
fn rough_plants_stay_with_the_stepper() {
    let plant = TwoLink::plant(0);
    let rough = Plant { spring_gap: Vector([1e-3, 0.0]), ..plant };
    let links = || TwoLink::links([0, 0]);
    assert!(Plant::together(links(), [&plant, &plant]).is_some());
    assert!(Plant::together(links(), [&plant, &rough]).is_none());
}

#[test]
fn the_order_is_that_of_the_fastest_spring() {
    let (plant, x) = (Panda::plant(0), Panda::start(0));
    let order = |h: f64, tolerance: f64| {
        likely(&plant, &x, h, tolerance).map(|(order, effort)| (order, effort.corrections))
    };
    assert_eq!(order(1e-3, 1e-7), Some((Order::Four, 2)));
    assert_eq!(order(2e-3, 1e-7), Some((Order::Four, 3)));
    assert_eq!(order(4e-3, 1e-7), Some((Order::Eight, 4)));
    assert_eq!(order(1e-3, 1e-10), Some((Order::Eight, 4)));
    assert_eq!(order(1e-2, 1e-7), None);
}
