//! Works that are functions of their inputs: law and dynamics.

use std::array;
use std::error::Error;

use flexure::simulate::SIDE_BY_SIDE;
use flexure_core::control::Input;
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::robots::Tree;
use flexure_core::scalar::Lanes;

use crate::model::{self, Gains};

/// A function of `inputs` numbers that gives `outputs` numbers, of so many `lines` of them at once.
pub struct Call {
    pub inputs: usize,
    pub outputs: usize,
    pub lines: usize,
    pub run: Box<Run>,
}

type Run = dyn FnMut(&[f64], &mut [f64]);

/// The work `name`, if it is one of these.
pub fn call(name: &str) -> Result<Option<Call>, Box<dyn Error>> {
    Ok(Some(match name {
        "law2" => law(model::two_link()?, model::gains("two-link-tanh-smooth")?),
        "law7" => law(model::panda()?, model::gains("panda-tanh-smooth")?),
        "law2-lanes" => law_in_lanes(model::two_link()?, model::gains("two-link-tanh-smooth")?),
        "law7-lanes" => law_in_lanes(model::panda()?, model::gains("panda-tanh-smooth")?),
        "rnea7" => of_links(|links, [q, v, a]: [_; 3]| [links.inverse_dynamics(&q, &v, &v, &a)])?,
        "fd7" => of_links(|links, [q, v, torque]: [_; 3]| [links.forward_dynamics(&q, &v, &torque)])?,
        "crba7" => of_links(|links, [q]: [_; 1]| links.mass_matrix(&q).0.map(Vector))?,
        "rates7" => of_links(|links, q: [_; 5]| {
            links.torque_along::<_, 3, 5>(&Vector::from_derivatives(&q)).derivatives()
        })?,
        _ => return Ok(None),
    }))
}

/// (q_l, q_m, q̇_l, q̇_m) and the reference with four derivatives; the torque.
fn law<L: Links<f64, N> + 'static, const N: usize>(robot: Fjr<f64, L, N>, law: Gains<N>) -> Call {
    call_of(move |[q_l, q_m, v_l, v_m, reference @ ..]: [Vector<f64, N>; 9]| {
        let x = Motion { q_l, q_m, v_l, v_m };
        [law.command(&robot, &x, &Vector::from_derivatives(&reference), &Input::ZERO).u_m]
    })
}

/// The same of as many states at once as a register has numbers.
fn law_in_lanes<L: Links<f64, N> + 'static, const N: usize>(robot: Fjr<f64, L, N>, law: Gains<N>) -> Call {
    let run = move |inputs: &[f64], outputs: &mut [f64]| {
        let (rows, _) = inputs.as_chunks::<N>();
        let lanes = |part: usize| {
            Vector::from_fn(|i| Lanes::from_array(array::from_fn(|lane| rows[9 * lane + part][i])))
        };
        let x: Motion<Several, N> = Motion { q_l: lanes(0), q_m: lanes(1), v_l: lanes(2), v_m: lanes(3) };
        let reference = array::from_fn(|k| lanes(4 + k));
        let u_m = law.command(&robot, &x, &Vector::from_derivatives(&reference), &Input::ZERO).u_m;
        for (i, u) in u_m.iter().enumerate() {
            for (lane, u) in u.to_array().into_iter().enumerate() {
                outputs[N * lane + i] = u;
            }
        }
    };
    Call { inputs: 9 * N, outputs: N, lines: SIDE_BY_SIDE, run: Box::new(run) }
}

/// As many numbers as a register has.
type Several = Lanes<f64, SIDE_BY_SIDE>;

/// A function of the links of the seven-joint arm.
fn of_links<const I: usize, const O: usize>(
    f: impl Fn(&Tree<f64, 7>, [Vector<f64, 7>; I]) -> [Vector<f64, 7>; O] + 'static,
) -> Result<Call, Box<dyn Error>> {
    let links = model::panda()?.links;
    Ok(call_of(move |vectors| f(&links, vectors)))
}

fn call_of<const N: usize, const I: usize, const O: usize>(
    f: impl Fn([Vector<f64, N>; I]) -> [Vector<f64, N>; O] + 'static,
) -> Call {
    let run = move |inputs: &[f64], outputs: &mut [f64]| {
        let (rows, _) = inputs.as_chunks::<N>();
        let results = f(std::array::from_fn(|i| Vector(rows[i])));
        for (to, from) in outputs.as_chunks_mut().0.iter_mut().zip(results) {
            *to = from.0;
        }
    };
    Call { inputs: N * I, outputs: N * O, lines: 1, run: Box::new(run) }
}
