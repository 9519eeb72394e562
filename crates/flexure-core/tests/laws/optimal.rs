//! Optimal laws.

use flexure_core::control::{LinearModel, Lqr, Mpc, QuadraticCost, Regulator};
use flexure_core::linalg::{BlockMatrix, Matrix, Vector};
use flexure_core::model::{Fjr, Links};

use crate::common::{Numbers, branched, flexible, plant, serial};

fn ones<const N: usize>() -> QuadraticCost<f64, N> {
    QuadraticCost {
        state: [400.0, 40.0, 1.0, 1.0].map(|x| Vector([x; N])),
        torque: Vector([0.05; N]),
    }
}

fn residual<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>) {
    let model = LinearModel::at_rest(robot, &Vector::ZERO);
    let cost = ones();
    let start = std::time::Instant::now();
    let regulator = Regulator::continuous(&model, &cost, f64::INFINITY);
    let time = start.elapsed();
    let Ok(Regulator { gain, cost_to_go: P, .. }) = regulator else { println!("{N}: refused"); return };
    let q = BlockMatrix::from_blocks(|r, c| if r == c { Matrix::diagonal(&cost.state[r]) } else { Matrix::ZERO });
    let r = Matrix::diagonal(&cost.torque);
    let frf = BlockMatrix::from_blocks(|i, j| gain[i].transpose() * r * gain[j]);
    let pa = P * model.state;
    let res = pa + pa.transpose() + q - frf;
    let size = pa.rows().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    let err = res.rows().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    println!("n {N} residual {err:e} of {size:e} in {time:?}");
}

#[test]
fn explore() {
    residual(&plant::paper_arm());
    residual(&plant::plausible_arm());
    let r = &mut Numbers(1);
    residual(&flexible(branched::<5>(2), r));
    residual(&flexible(serial::<7>(), r));
    residual(&flexible(serial::<16>(), r));
}
