//! Command-filtered laws: their storage decays by the same formula for every bandwidth of the filters and all parameters that links are taken to have.

use flexure_core::control::{
    Adaptation, AdaptiveCommandFilteredBackstepping, AdaptiveVcbc, Applied, CommandFilteredBackstepping,
    DynamicLaw, Running,
};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion, Parameters};
use flexure_core::robots::Tree;
use flexure_core::scalar::{Jet, Over};

use crate::common::laws::Course;
use crate::common::{GRAVITY, Numbers, branched, branched_bodies, flexible, planar, serial};

/// Of the largest of all terms of dV/dt: what a few hundred operations round off it is some 1e-14 of it.
const TOLERANCE: f64 = 1e-12;

fn backstepping<const N: usize>(r: &mut Numbers) -> CommandFilteredBackstepping<f64, N> {
    CommandFilteredBackstepping {
        shaping: r.between(2.0, 8.0),
        link_damping: r.between(0.5, 5.0),
        metric: r.between(20.0, 80.0),
        motor_shaping: r.between(10.0, 50.0),
        rate_metric: r.between(0.01, 0.1),
        rate_shaping: r.between(20.0, 100.0),
        // Four decades.
        bandwidth: r.between(0.0, 4.0).map(|x| 10.0_f64.powf(x)),
    }
}

/// Γ at random, and no bounds.
fn adaptation<const N: usize>(r: &mut Numbers) -> Adaptation<f64, N> {
    Adaptation {
        gain: [(); 10].map(|()| r.between(0.1, 2.0)),
        low: [Vector([f64::NEG_INFINITY; N]); 10],
        high: [Vector([f64::INFINITY; N]); 10],
        least: Vector([0.1; N]),
    }
}

/// v_2, v_3, v_4 of filters x_3, x_4, ξ_2, ξ_3.
fn errors<T: Over<f64>, const N: usize>(
    law: &CommandFilteredBackstepping<f64, N>,
    x: &Motion<T, N>,
    [q_d, v_d]: [&Vector<T, N>; 2],
    [x_3, x_4, xi_2, xi_3]: [&Vector<T, N>; 4],
) -> [Vector<T, N>; 3] {
    let z_2 = x.v_l - *v_d + law.shaping.diag_mul(&(x.q_l - *q_d));
    [z_2 - *xi_2, x.q_m - *x_3 - *xi_3, x.v_m - *x_4]
}

/// ½ yᵀ W y.
fn half_square<T: Over<f64>, const N: usize>(weight: &Vector<f64, N>, y: &Vector<T, N>) -> T {
    y.dot(&weight.diag_mul(y)).scale(0.5)
}

fn product<const N: usize>(a: &Vector<f64, N>, b: &Vector<f64, N>) -> Vector<f64, N> {
    a.diag_mul(b)
}

/// What a law stores and loses. `x_3`, `x_4`, ξ_1, ξ_2, ξ_3 and φ̂ are where the law has them in its memory.
struct Storage<'a, const N: usize> {
    law: &'a CommandFilteredBackstepping<f64, N>,
    /// Π_l and the place of ξ_1.
    link_metric: Option<(&'a Vector<f64, N>, usize)>,
    /// x_3, x_4, ξ_2, ξ_3.
    places: [usize; 4],
    /// Γ and the place of φ̂.
    adapted: Option<(&'a Parameters<f64, N>, usize)>,
}

impl<const N: usize> Storage<'_, N> {
    fn value<T: Over<f64>, L: Links<f64, N>>(
        &self,
        robot: &Fjr<f64, L, N>,
        x: &Motion<T, N>,
        reference: [&Vector<T, N>; 2],
        z: &[Vector<T, N>],
    ) -> T {
        let [v_2, v_3, v_4] = errors(self.law, x, reference, self.places.map(|k| &z[k]));
        let mut V = v_2.dot(&robot.links.mass_mul(&x.q_l, &v_2)).scale(0.5)
            + half_square(&self.law.metric, &v_3)
            + half_square(&self.law.rate_metric, &v_4);
        if let Some((metric, xi_1)) = self.link_metric {
            V += half_square(metric, &(x.q_l - *reference[0] - z[xi_1]));
        }
        if let Some((gain, place)) = self.adapted {
            for (k, (slot, gain)) in robot.links.parameters().iter().zip(gain).enumerate() {
                V += half_square(&gain.map(f64::recip), &(z[place + k] - slot.lift()));
            }
        }
        V
    }

    /// −dV/dt of the theory.
    fn loss<L: Links<f64, N>>(
        &self,
        robot: &Fjr<f64, L, N>,
        x: &Motion<f64, N>,
        reference: [&Vector<f64, N>; 2],
        z: &[Vector<f64, N>],
    ) -> f64 {
        let law = self.law;
        let [v_2, v_3, v_4] = errors(law, x, reference, self.places.map(|k| &z[k]));
        let lost = |weight: &Vector<f64, N>, y: &Vector<f64, N>| 2.0 * half_square(weight, y);
        let links = self.link_metric.map_or(0.0, |(metric, xi_1)| {
            lost(&product(metric, &law.shaping), &(x.q_l - *reference[0] - z[xi_1]))
        });
        links
            + lost(&(robot.link_damping + law.link_damping), &v_2)
            + lost(&product(&law.metric, &law.motor_shaping), &v_3)
            + lost(&product(&law.rate_metric, &law.rate_shaping), &v_4)
    }
}

/// dV/dt along the closed loop less what the theory says, over the largest of its terms; `spoil` changes ż on the way.
fn residual<L: Links<f64, N>, F: DynamicLaw<f64, N, K>, const N: usize, const K: usize>(
    robot: &Fjr<f64, L, N>,
    law: &F,
    storage: &Storage<N>,
    z: &[Vector<f64, N>; K],
    spoil: impl Fn(&mut [Vector<f64, N>; K]),
    r: &mut Numbers,
) -> f64 {
    let (x, q_ld) = (r.motion::<N>(1.0), r.series::<5, N>(1.0));
    let u_m = law.torque(robot, &x, &q_ld, z);
    let mut rate = law.rate(robot, &x, &q_ld, z, &Applied::fully(u_m));
    spoil(&mut rate);
    let along: [_; K] = core::array::from_fn(|k| {
        Vector::<Jet<f64, 2>, N>::from_fn(|i| {
            Jet::from_fn(|order| if order == 0 { z[k][i] } else { rate[k][i] })
        })
    });
    let course = Course::new(robot, &x, &u_m).motion();
    let (q_d, v_d) = (q_ld.map(|q| q.truncate()), q_ld.map(|q| q.differentiate()));
    let V = storage.value(robot, &course, [&q_d, &v_d], &along);
    let [q, v, ..] = q_ld.derivatives();
    let loss = storage.loss(robot, &x, [&q, &v], z);
    assert!(loss > 0.0);

    // dV/dt by each number alone: what has to cancel.
    let mut size = loss;
    for i in 0..N {
        let only = |v: &Vector<Jet<f64, 2>, N>| {
            Vector::from_fn(|j| if i == j { v[j] } else { Jet::value(v[j].coefficient(0)) })
        };
        let still = |v: &Vector<Jet<f64, 2>, N>| v.map(|x| Jet::<f64, 2>::value(x.coefficient(0)));
        let rest = Motion {
            q_l: still(&course.q_l),
            q_m: still(&course.q_m),
            v_l: still(&course.v_l),
            v_m: still(&course.v_m),
        };
        let (q_s, v_s) = (still(&q_d), still(&v_d));
        let z_s = along.each_ref().map(still);
        let mut add = |x: &Motion<Jet<f64, 2>, N>, reference: [&Vector<_, N>; 2], z: &[Vector<_, N>]| {
            size = size.max(storage.value(robot, x, reference, z).coefficient(1).abs());
        };
        let reference = [&q_s, &v_s];
        add(&Motion { q_l: only(&course.q_l), ..rest }, reference, &z_s);
        add(&Motion { q_m: only(&course.q_m), ..rest }, reference, &z_s);
        add(&Motion { v_l: only(&course.v_l), ..rest }, reference, &z_s);
        add(&Motion { v_m: only(&course.v_m), ..rest }, reference, &z_s);
        add(&rest, [&only(&q_d), &v_s], &z_s);
        add(&rest, [&q_s, &only(&v_d)], &z_s);
        for k in 0..K {
            let mut moved = z_s;
            moved[k] = only(&along[k]);
            add(&rest, reference, &moved);
        }
    }
    (V.coefficient(1) + loss).abs() / size
}

/// The identity holds, and fails if the rate of any of `parts` has the other sign.
fn decays<L: Links<f64, N>, F: DynamicLaw<f64, N, K>, const N: usize, const K: usize>(
    robot: &Fjr<f64, L, N>,
    law: &F,
    storage: &Storage<N>,
    z: &[Vector<f64, N>; K],
    parts: &[usize],
    r: &mut Numbers,
) {
    let found = residual(robot, law, storage, z, |_| {}, r);
    assert!(found <= TOLERANCE, "{found}");
    for &part in parts {
        let spoilt = residual(robot, law, storage, z, |rate| rate[part] = -rate[part], r);
        assert!(spoilt > 1e-9, "{part}: {spoilt}");
    }
}

fn known<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
    let (robot, law, z) = (flexible(links(), r), backstepping(r), [(); 6].map(|()| r.vector(1.0)));
    let storage = Storage { law: &law, link_metric: None, places: [0, 2, 4, 5], adapted: None };
    decays(&robot, &law, &storage, &z, &[0, 2, 4, 5], r);
}

/// A memory with φ̂ up to a fifth off φ behind its first parts.
fn memory<L: Links<f64, N>, const N: usize, const K: usize>(
    links: &L,
    r: &mut Numbers,
) -> [Vector<f64, N>; K] {
    let phi = links.parameters();
    core::array::from_fn(|k| match k.checked_sub(K - 10) {
        Some(slot) => product(&phi[slot], &r.between(0.8, 1.2)),
        None => r.vector(1.0),
    })
}

fn adaptive<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
    let robot = flexible(links(), r);
    let law = AdaptiveCommandFilteredBackstepping { nominal: backstepping(r), adaptation: adaptation(r) };
    let storage = Storage {
        law: &law.nominal,
        link_metric: None,
        places: [0, 2, 4, 5],
        adapted: Some((&law.adaptation.gain, 6)),
    };
    // Numbers that every one of the three robots has.
    decays(&robot, &law, &storage, &memory(&robot.links, r), &[0, 2, 4, 5, 7], r);
}

fn vcbc<L: Links<f64, N>, const N: usize>(links: fn() -> L, r: &mut Numbers) {
    let robot = flexible(links(), r);
    let law = AdaptiveVcbc {
        backstepping: backstepping(r),
        link_metric: r.between(2.0, 20.0),
        adaptation: adaptation(r),
    };
    let storage = Storage {
        law: &law.backstepping,
        link_metric: Some((&law.link_metric, 4)),
        places: [0, 2, 5, 6],
        adapted: Some((&law.adaptation.gain, 7)),
    };
    decays(&robot, &law, &storage, &memory(&robot.links, r), &[0, 2, 4, 5, 6, 8], r);
}

macro_rules! on_three_arms {
    ($check:ident, $seed:literal) => {{
        let r = &mut Numbers($seed);
        for _ in 0..10 {
            $check(planar, r);
            $check(|| branched::<5>(2), r);
            $check(serial::<7>, r);
        }
    }};
}

#[test]
fn command_filtered_backstepping_decays_at_every_bandwidth() {
    on_three_arms!(known, 41);
}

#[test]
fn adaptive_backstepping_decays_whatever_the_links_are_taken_for() {
    on_three_arms!(adaptive, 42);
}

#[test]
fn adaptive_vcbc_decays_whatever_the_links_are_taken_for() {
    on_three_arms!(vcbc, 43);
}

/// Joints that only fill a capacity change nothing for the others, and stay at rest.
#[test]
fn phantoms_stay_at_rest() {
    let r = &mut Numbers(44);
    let exact = flexible(branched::<5>(2), r);
    let padded = |x: &Vector<f64, 5>| Vector::<f64, 7>::from_fn(|i| x.0.get(i).copied().unwrap_or(1.0));
    let still = |x: &Vector<f64, 5>| Vector::<f64, 7>::from_fn(|i| x.0.get(i).copied().unwrap_or(0.0));
    let [stiffness, motor_inertia, link_damping, motor_damping] =
        [exact.stiffness, exact.motor_inertia, exact.link_damping, exact.motor_damping].map(|x| padded(&x));
    let links = Tree::from_bodies(&branched_bodies::<5>(2), GRAVITY, |x| x).expect("a tree that fits");
    let roomy = Fjr { links, stiffness, motor_inertia, link_damping, motor_damping };
    let small = AdaptiveVcbc {
        backstepping: backstepping(r),
        link_metric: r.between(2.0, 20.0),
        adaptation: Adaptation::around(
            &exact.links,
            &r.between(0.1, 1.0),
            &Vector([0.5; 5]),
            &Vector([0.1; 5]),
        ),
    };
    let CommandFilteredBackstepping {
        shaping,
        link_damping,
        metric,
        motor_shaping,
        rate_metric,
        rate_shaping,
        bandwidth,
    } = small.backstepping;
    let large = AdaptiveVcbc {
        backstepping: CommandFilteredBackstepping {
            shaping: padded(&shaping),
            link_damping: padded(&link_damping),
            metric: padded(&metric),
            motor_shaping: padded(&motor_shaping),
            rate_metric: padded(&rate_metric),
            rate_shaping: padded(&rate_shaping),
            bandwidth: padded(&bandwidth),
        },
        link_metric: padded(&small.link_metric),
        adaptation: Adaptation {
            gain: small.adaptation.gain.map(|slot| padded(&slot)),
            low: small.adaptation.low.map(|slot| still(&slot)),
            high: small.adaptation.high.map(|slot| still(&slot)),
            least: Vector([0.1; 7]),
        },
    };
    let widened = |x: &Motion<f64, 5>| Motion {
        q_l: still(&x.q_l),
        q_m: still(&x.q_m),
        v_l: still(&x.v_l),
        v_m: still(&x.v_m),
    };
    let (x, q_ld) = (r.motion(0.5), r.series::<5, 5>(0.5));
    let wide_q_ld = Vector::from_fn(|i| q_ld.0.get(i).copied().unwrap_or(Jet::value(0.0)));
    let mut one = Running::start(&small, &exact, &x, &q_ld);
    let mut other = Running::start(&large, &roomy, &widened(&x), &wide_q_ld);
    for _ in 0..20 {
        one.advance(&small, &exact, &x, &q_ld, &Applied::NOTHING, 1e-3);
        other.advance(&large, &roomy, &widened(&x), &wide_q_ld, &Applied::NOTHING, 1e-3);
    }
    let (u, wide) = (
        small.torque(&exact, &x, &q_ld, &one.memory),
        large.torque(&roomy, &widened(&x), &wide_q_ld, &other.memory),
    );
    for (part, wide) in one.memory.iter().chain([&u]).zip(other.memory.iter().chain([&wide])) {
        assert_eq!(still(part), *wide);
    }
}
