//! Whether the closed form of the closed loop is what the law's own code gives, on intervals.

use flexure_core::control::{Input, Shaping, Vcbc};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion, State};
use flexure_core::scalar::{Dual, Interval, Jet};
use flexure_core::virtual_system::{ErrorState, closed_loop, error_coordinates, virtual_dynamics};

/// How two enclosures of the error's rate compare.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// Entries where the two have no number in common: the closed form is not what the law gives.
    pub disjoint: usize,
    /// The largest width of an entry, in units of the rate: how sharply they were compared.
    pub width: f64,
}

/// The rate of the error x̃ twice, at one state of the virtual system `x_v` along one real motion `x`.
///
/// Once from the code of the law: [`Vcbc::virtual_command`] gives the torque, [`virtual_dynamics`] the motion of the virtual
/// system under it, and [`error_coordinates`] runs the law again on dual numbers along both motions. Once from
/// [`closed_loop`], whose Jacobian the engine proves about. `motor_torque` [N m] drives the real robot: contraction is a property
/// of the virtual system along any motion. `q_ld` is the reference in rad to order 5.
///
/// Intervals without a common number prove that closed form and law differ. Thin ones that overlap show that they agree to
/// their width at this state; that they do at every state is a theorem, which this does not prove, only tests.
pub fn law_agreement<L, Pl, Pm, const N: usize>(
    robot: &Fjr<Interval, L, N>,
    law: &Vcbc<Interval, Pl, Pm, N>,
    x_v: &Motion<Interval, N>,
    x: &Motion<Interval, N>,
    q_ld: &Vector<Jet<Interval, 6>, N>,
    motor_torque: &Vector<Interval, N>,
) -> Agreement
where
    L: Links<Interval, N>,
    Pl: Shaping<Interval, N>,
    Pm: Shaping<Interval, N>,
{
    let reference = q_ld.map(|q| q.truncate::<5>());
    let command = law.virtual_command(robot, x_v, x, &reference, &Input::ZERO);
    // The momenta of the virtual system are M(q) v_v at the real q.
    let x_v = State { p_l: robot.links.mass_mul(&x.q_l, &x_v.v_l), ..robot.state(x_v) };
    let x_v_rate = virtual_dynamics(robot, &x_v, x, &command.u_m);
    let moving_x_v = State {
        q_l: moving(&x_v.q_l, &x_v_rate.q_l),
        q_m: moving(&x_v.q_m, &x_v_rate.q_m),
        p_l: moving(&x_v.p_l, &x_v_rate.p_l),
        p_m: moving(&x_v.p_m, &x_v_rate.p_m),
    };
    let moving_x = Motion {
        q_l: moving(&x.q_l, &x.v_l),
        q_m: moving(&x.q_m, &x.v_m),
        v_l: moving(&x.v_l, &robot.link_acceleration(x)),
        v_m: moving(&x.v_m, &robot.motor_acceleration(x, motor_torque)),
    };
    // Coefficient k + 1 gives the rate of coefficient k.
    let shifting = q_ld.map(|q| {
        let rate = q.differentiate::<5>();
        Jet::from_fn(|k| Dual { value: q.coefficient(k), gradient: [rate.coefficient(k)] })
    });
    let error = error_coordinates(robot, law, &moving_x_v, &moving_x, &shifting, &Input::ZERO);
    let value = |part: Vector<Dual<Interval, 1>, N>| part.map(|e| e.value);
    let here = ErrorState {
        e_l: value(error.e_l),
        e_m: value(error.e_m),
        sigma_l: value(error.sigma_l),
        sigma_m: value(error.sigma_m),
    };
    let closed = closed_loop(robot, law, &here, x, &Input::ZERO);
    let of_law = [error.e_l, error.e_m, error.sigma_l, error.sigma_m];
    let of_form = [closed.e_l, closed.e_m, closed.sigma_l, closed.sigma_m];
    let mut agreement = Agreement { disjoint: 0, width: 0.0 };
    for (law, form) in of_law.iter().flat_map(|x| x.0).zip(of_form.iter().flat_map(|x| x.0)) {
        let law = law.gradient[0];
        agreement.disjoint += usize::from(law.intersection(form).is_none());
        agreement.width = agreement.width.max(law.width()).max(form.width());
    }
    agreement
}

/// `x` moving at the rate `rate`.
fn moving<const N: usize>(
    x: &Vector<Interval, N>,
    rate: &Vector<Interval, N>,
) -> Vector<Dual<Interval, 1>, N> {
    Vector::from_fn(|i| Dual { value: x[i], gradient: [rate[i]] })
}
