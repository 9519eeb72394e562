//! What a torque on the links does to where the law wants the motors.

use flexure_core::scalar::{Interval, Jet, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::envelope::closed_loop::{Place, Slope, TrackingLoop};
use crate::prove::engine::envelope::slab::{View, Way};

/// By how much accelerations of the links move the rates of q_md and of q̇_mr: ∂q_md/∂q̇_l A and ∂q̇_mr/∂q̇_l A over slab and tube, where
/// `accelerations` are the entries of A, a column per torque or whatever speeds links up. Positions of the motors in rad, velocities of links and motors [rad/s] are as given.
pub(super) fn responses(
    system: &dyn TrackingLoop,
    way: &Way<'_>,
    accelerations: &dyn Fn(usize, usize) -> Interval,
    [q_m, v_l, v_m]: [&[Interval]; 3],
) -> [Dense<Interval>; 2] {
    let n = system.joints();
    let seed = way.seeded(View::Everywhere);
    let (q_l, natural) = seed.links(system);
    let constant = |values: &[Interval]| values.iter().map(|&x| Slope::value(x)).collect::<Vec<_>>();
    let answers: Vec<_> = (0..n)
        .map(|i| {
            let moved = |(j, (&v, natural)): (usize, (&Interval, &Slope))| {
                let natural = natural.coefficient(0);
                Jet::new([v.intersection(natural).unwrap_or(v), accelerations(j, i), Interval::ZERO])
            };
            let v_l = v_l.iter().zip(&natural).enumerate().map(moved).collect();
            let place = Place { q_l: q_l.clone(), q_m: constant(q_m), v_l, v_m: constant(v_m) };
            system.command(&place, &seed.q_ld)
        })
        .collect();
    let first = |x: &Slope| x.coefficient(1);
    [
        Dense::from_fn(n, n, |j, i| first(&answers[i].q_md[j])),
        Dense::from_fn(n, n, |j, i| first(&answers[i].s_m[j])),
    ]
}
