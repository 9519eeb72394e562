//! Funnels of the arm with the gains of its hardware: how wide they are, and that the check of a slab can fail.

mod file;
mod motions;
mod python;
pub mod random;

use flexure::core::scalar::{Interval, Scalar};
use flexure::progress::unwatched;
use flexure::prove::engine::envelope::deviation::Spread;
use flexure::prove::engine::envelope::funnel::{Funnel, FunnelRequest};
use flexure::prove::engine::envelope::inequality::holds;
use flexure::prove::engine::envelope::shape::part;
use flexure::scenario::load_scenario;

use crate::along::slabs::enclosed;

/// Torques on links and motors [N m], and how far springs may be from the file, as a part.
fn request(link: f64, motor: f64, spring: f64) -> FunnelRequest {
    let point = |x: f64| vec![Interval::point(x); 2];
    let spread = Spread {
        stiffness: [39.96, 6.86].map(|x| Interval::point(x * spring)).to_vec(),
        motor_inertia: point(0.0),
        link_damping: point(0.0),
        motor_damping: point(0.0),
        link_mass: point(0.0),
        motor_torque: point(motor),
        link_torque: point(link),
    };
    FunnelRequest {
        spread,
        duration: 20.0,
        start: vec![Interval::ZERO; 8],
        slab: 0.02,
        room: 1.0,
        most: 40_000,
    }
}

/// Largest link error in rad.
fn link_error(request: &FunnelRequest) -> (Funnel, f64) {
    let system = enclosed(&load_scenario("two-link-hardware").expect("built in"));
    let found = Funnel::along(&system, request, &unwatched).expect("nobody breaks it off");
    let funnel = found.unwrap_or_else(|open| panic!("{open:?}"));
    let largest = funnel.extents()[..2].iter().copied().fold(0.0, f64::max);
    (funnel, largest)
}

/// With the loop frozen at instants it is 4 to 6 mrad of a torque on the links, and 1.7 mrad of one on the motors. W gives radians.
#[test]
fn torques_and_springs_move_links_by_millirads() {
    for (link, motor, spring, most) in
        [(0.05, 0.0, 0.0, 0.010), (0.0, 0.05, 0.0, 0.003), (0.0, 0.0, 0.1, 0.010)]
    {
        let (funnel, largest) = link_error(&request(link, motor, spring));
        println!(
            "{link} N m on links, {motor} N m on motors, {spring} of the springs: {:.5?}, {} 1/s",
            funnel.extents(),
            funnel.rate()
        );
        // At standstill, too, where next to nothing drives.
        assert!(funnel.rate() > 0.9, "{} 1/s", funnel.rate());
        assert!(largest <= most, "{largest} rad");
        // No smaller than what a torque that stays there leaves: its part over the slowest of all springs and gains.
        assert!(largest > 0.1 * most, "{largest} rad");
    }
}

/// An end that is smaller than what leads there, a driving torque that is larger than was said, another flow: each is seen.
#[test]
fn a_slab_that_is_not_so_is_refused() {
    let mut request = request(0.05, 0.0, 0.0);
    request.duration = 1.0;
    let (funnel, _) = link_error(&request);
    let piece = &funnel.pieces[20];
    let [from, to] = [&piece.passage.0[0], &piece.passage.0[1]];
    let time = part(piece.time, 0, piece.passage.0.len() - 1);
    let so = |flow: &_, from: &_, to: &_| holds(flow, &piece.multipliers, [from, to], time);
    assert!(so(&piece.flow, from, to));
    assert!(!so(&piece.flow, from, &to.times(0.99)), "a smaller end");
    let mut stronger = piece.flow.clone();
    stronger.channels.iter_mut().for_each(|channel| channel.size *= 1.1);
    assert!(!so(&stronger, from, to), "a larger torque");
    let mut slower = piece.flow.clone();
    (0..2).for_each(|i| slower.matrix[(i, i)] *= 0.5);
    assert!(!so(&slower, from, to), "a slower link");
    let mut reversed = piece.flow.clone();
    reversed.matrix[(4, 2)] *= -1.0;
    assert!(!so(&reversed, from, to), "a spring that pushes");
    let mut fewer = piece.multipliers.clone();
    fewer.alpha.pop();
    assert!(!holds(&piece.flow, &fewer, [from, to], time), "a multiplier less");
}
