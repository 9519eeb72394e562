//! Optimal laws.

use flexure_core::control::{LinearModel, Lqr, Mpc, QuadraticCost, Regulator};
use flexure_core::linalg::{BlockMatrix, Matrix, Vector};
use flexure_core::model::{Fjr, Links};

use crate::common::{Numbers, branched, flexible, plant, serial};

fn ones<const N: usize>() -> QuadraticCost<f64, N> {
    QuadraticCost { state: [400.0, 40.0, 1.0, 1.0].map(|x| Vector([x; N])), torque: Vector([0.05; N]) }
}

fn residual<L: Links<f64, N>, const N: usize>(robot: &Fjr<f64, L, N>) {
    let model = LinearModel::at_rest(robot, &Vector::ZERO);
    let cost = ones();
    let start = std::time::Instant::now();
    let regulator = Regulator::continuous(&model, &cost, f64::INFINITY);
    let time = start.elapsed();
    let Ok(Regulator { gain, cost_to_go: P, .. }) = regulator else {
        println!("{N}: refused");
        return;
    };
    let q = BlockMatrix::diagonal(&cost.state);
    let r = Matrix::diagonal(&cost.torque);
    let frf = BlockMatrix::outer(&gain.map(|f| f.transpose() * r), &gain);
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

#[test]
fn explore_mpc() {
    use crate::common::laws::resting;
    use flexure_core::control::ControlLaw;
    use flexure_core::model::Motion;
    use plant::{PERIOD, Push, advance};
    let robot = plant::undamped(plant::plausible_arm());
    let cost = QuadraticCost {
        state: [100.0, 10.0, 0.25, 0.025].map(|x| Vector([x; 2])),
        torque: Vector([0.02, 0.2]),
    };
    let limit = Vector([
        std::env::var("L1").unwrap().parse().unwrap(),
        std::env::var("L2").unwrap().parse().unwrap(),
    ]);
    let goal = resting(&Vector::ZERO);
    let limit: Vector<f64, 2> = limit;
    let run = |law: &dyn Fn(&Motion<f64, 2>) -> Vector<f64, 2>| {
        let mut x = Motion::at_rest(Vector([1.5, -1.0]));
        let mut total = 0.0;
        let mut viol = 0.0f64;
        for _ in 0..3000 {
            let u = law(&x);
            for i in 0..2 {
                viol = viol.max(u[i].abs() - limit[i]);
            }
            let u = Vector::from_fn(|i| u[i].clamp(-limit[i], limit[i]));
            let parts = [x.q_l, x.q_m, x.v_l, x.v_m];
            for (w, e) in cost.state.iter().zip(&parts) {
                total += PERIOD * e.dot(&w.diag_mul(e));
            }
            total += PERIOD * u.dot(&cost.torque.diag_mul(&u));
            x = advance(&robot, &x, &u, &Push::NONE, PERIOD, 10);
        }
        (total, viol, x.q_l)
    };
    let lqr = Lqr::design(&robot, &Vector::ZERO, &cost, f64::INFINITY).expect("one");
    println!("{:?}", lqr.gain);
    println!("lqr {:?}", run(&|x| lqr.torque(&robot, x, &goal)));
    macro_rules! mpc { ($($h:literal $t:literal),*) => {$({
        let law = Mpc::<f64, 2, $h>::design(&robot, &Vector::ZERO, &cost, $t, &limit).expect("one");
        println!("mpc {} {} {:?}", $h, $t, run(&|x| law.torque(&robot, x, &goal)));
    })*} }
    mpc!(10 1e-3, 20 1e-3, 10 1e-2, 20 1e-2, 20 2e-2, 20 4e-2, 10 5e-2);
}
