//! Every registered law on every number, and on joints that only fill a vector.

use flexure::compare::{Entrant, entrants};
use flexure::core::linalg::{Matrix, Vector};
use flexure::core::model::{Fjr, Links as LinkModel, MassFactor, Motion};
use flexure::core::robots::Tree;
use flexure::core::scalar::{Dual, Interval, Jet, Over, Scalar};
use flexure::laws::{CONTROLLERS, Controller, any_law};
use flexure::robot::{Links, Robot, load_robot};

/// Three joints under gravity: the bodies of a built-in arm with numbers through `number`. One joint count only: every
/// registered law on every number is much code.
pub fn arm<C: Scalar + PartialEq>(
    robot: &Robot,
    number: impl Fn(f64) -> C,
    near: impl Fn(C) -> f64,
) -> Fjr<C, Tree<C, 3>, 3> {
    let Links::Tree(bodies) = &robot.links else { panic!("a tree") };
    let bodies: Vec<_> = bodies.iter().map(|body| body.map(&number)).collect();
    let vector = |values: &[f64]| Vector::from_fn(|i| number(values[i]));
    Fjr {
        links: Tree::from_bodies(&bodies, robot.gravity.map(&number), near).expect("parents come first"),
        motor_inertia: vector(&robot.motor_inertia),
        stiffness: vector(&robot.stiffness),
        link_damping: vector(&robot.link_damping),
        motor_damping: vector(&robot.motor_damping),
    }
}

/// A reference in general position, and a motion near it.
pub fn place() -> (Motion<f64, 3>, Vector<Jet<f64, 5>, 3>) {
    let q_ld: Vector<Jet<f64, 5>, 3> = Vector::from_fn(|i| Jet::variable(0.4 + i as f64).sin());
    let [q, v, ..] = q_ld.derivatives();
    let off = |scale: f64| Vector::from_fn(|i| scale * (i as f64 + 1.0).sin());
    (Motion { q_l: q + off(0.01), q_m: q + off(0.012), v_l: v + off(0.1), v_m: v + off(-0.1) }, q_ld)
}

fn on<T: Scalar>(q: &Vector<Jet<f64, 5>, 3>, number: impl Fn(f64) -> T) -> Vector<Jet<T, 5>, 3> {
    q.map(|q| Jet::from_fn(|k| number(q.coefficient(k))))
}

/// The same values on duals and jets to the bit, the same rates on both, and intervals around them.
#[test]
fn every_law_runs_on_every_number() {
    let data = load_robot("tomei-3r").expect("built in");
    let (robot, enclosed) = (arm(&data, |x| x, |x| x), arm(&data, Interval::point, Interval::midpoint));
    let (x, q_ld) = place();
    for kind in CONTROLLERS.iter().map(|entry| entry.name) {
        let controller = Controller::default_for(kind, &data).expect("registered");
        let law = any_law::<f64, 3>(&controller, &data, &|x| x);
        let z = law.start(&robot, &x, &q_ld);
        let u = law.torque(&robot, &x, &q_ld, &z);
        let dual_motion = x.map(|x| Dual::<f64, 1> { value: x, gradient: [x.sin()] });
        let dual_z = z.map(|part| part.map(Dual::constant));
        let dual = law.torque(&robot, &dual_motion, &on(&q_ld, Dual::constant), &dual_z);
        let jet_motion = x.map(|x| Jet::<f64, 2>::new([x, x.sin()]));
        let jet_z = z.map(|part| part.map(Jet::value));
        let jet = law.torque(&robot, &jet_motion, &on(&q_ld, Jet::value), &jet_z);
        let law = any_law::<Interval, 3>(&controller, &data, &Interval::point);
        let interval_z = z.map(|part| part.map(Interval::point));
        let bounds = law.torque(&enclosed, &x.map(Interval::point), &on(&q_ld, Interval::point), &interval_z);
        for i in 0..3 {
            assert_eq!(
                [dual[i].value, jet[i].coefficient(0)].map(f64::to_bits),
                [u[i].to_bits(); 2],
                "{kind}"
            );
            let (a, b) = (dual[i].gradient[0], jet[i].coefficient(1));
            assert!((a - b).abs() <= 1e-9 * (1.0 + a.abs()), "{kind}: {a} and {b}");
            // Exact torques lie inside, floats a few thousand roundings from them.
            let slack = 1e-10 * (1.0 + u[i].abs());
            assert!(
                bounds[i].lo() - slack <= u[i] && u[i] <= bounds[i].hi() + slack,
                "{kind}: {:?}",
                bounds[i]
            );
            // Of thirty sweeps of a plan each widens what the one before left.
            let is_tight = bounds[i].width() < 1e-3 * (1.0 + u[i].abs());
            assert!(is_tight || kind == "mpc", "{kind}: {:?}", bounds[i]);
        }
    }
}

/// Three joints and two that are not there: unit inertia, no gravity, coupled with nothing.
struct Padded(Tree<f64, 3>);

/// The first three entries.
fn head<T: Scalar>(v: &Vector<T, 5>) -> Vector<T, 3> {
    Vector::from_fn(|i| v[i])
}

/// `v` and what the others have in `rest`.
fn joined<T: Scalar>(v: &Vector<T, 3>, rest: &Vector<T, 5>) -> Vector<T, 5> {
    Vector::from_fn(|i| if i < 3 { v[i] } else { rest[i] })
}

struct PaddedFactor<'a, T: Over<f64>>(<Tree<f64, 3> as LinkModel<f64, 3>>::Factor<'a, T>);

impl<T: Over<f64>> MassFactor<T, 5> for PaddedFactor<'_, T> {
    fn solve(&self, b: &Vector<T, 5>) -> Vector<T, 5> {
        joined(&self.0.solve(&head(b)), b)
    }
}

impl LinkModel<f64, 5> for Padded {
    type Factor<'a, T: Over<f64>> = PaddedFactor<'a, T>;

    fn mass_matrix<T: Over<f64>>(&self, q: &Vector<T, 5>) -> Matrix<T, 5, 5> {
        let mass = self.0.mass_matrix(&head(q));
        let one = Matrix::<T, 5, 5>::identity();
        Matrix::from_fn(|i, j| if i < 3 && j < 3 { mass[(i, j)] } else { one[(i, j)] })
    }

    fn potential_energy<T: Over<f64>>(&self, q: &Vector<T, 5>) -> T {
        self.0.potential_energy(&head(q))
    }

    fn carrier_rates<T: Over<f64>>(&self, q: &Vector<T, 5>, v: &Vector<T, 5>) -> Vector<T, 5> {
        joined(&self.0.carrier_rates(&head(q), &head(v)), &Vector::ZERO)
    }

    fn factor<T: Over<f64>>(&self, q: &Vector<T, 5>) -> PaddedFactor<'_, T> {
        PaddedFactor(self.0.factor(&head(q)))
    }

    fn gravity_torque<T: Over<f64>>(&self, q: &Vector<T, 5>) -> Vector<T, 5> {
        joined(&self.0.gravity_torque(&head(q)), &Vector::ZERO)
    }

    fn inertial_torque<T: Over<f64>>(
        &self,
        q: &Vector<T, 5>,
        v: &Vector<T, 5>,
        v_r: &Vector<T, 5>,
        a_r: &Vector<T, 5>,
    ) -> Vector<T, 5> {
        joined(&self.0.inertial_torque(&head(q), &head(v), &head(v_r), &head(a_r)), a_r)
    }

    fn inverse_dynamics<T: Over<f64>>(
        &self,
        q: &Vector<T, 5>,
        v: &Vector<T, 5>,
        v_r: &Vector<T, 5>,
        a_r: &Vector<T, 5>,
    ) -> Vector<T, 5> {
        joined(&self.0.inverse_dynamics(&head(q), &head(v), &head(v_r), &head(a_r)), a_r)
    }
}

/// Joints that only fill a vector get no torque, and the others the torque that they have without them, to the bit.
#[test]
fn joints_that_are_not_there_change_no_law() {
    let data = load_robot("tomei-3r").expect("built in");
    let robot = arm(&data, |x| x, |x| x);
    let longer = |v: &Vector<f64, 3>, pad: f64| joined(v, &Vector([pad; 5]));
    let padded = Fjr {
        links: Padded(arm(&data, |x| x, |x| x).links),
        motor_inertia: longer(&robot.motor_inertia, 1.0),
        stiffness: longer(&robot.stiffness, 1.0),
        link_damping: longer(&robot.link_damping, 0.0),
        motor_damping: longer(&robot.motor_damping, 0.0),
    };
    let (x, q_ld) = place();
    let [q_l, q_m, v_l, v_m] = [x.q_l, x.q_m, x.v_l, x.v_m].map(|v| longer(&v, 0.0));
    let (far, q_far) = (Motion { q_l, q_m, v_l, v_m }, joined(&q_ld, &Vector::ZERO));
    for name in
        entrants(&[]).expect("all laws").iter().map(|law| law.name()).chain(["vcbc:coupled-tanh".into()])
    {
        let controller = Entrant::named(&name).expect("known").controller(&data).expect("three joints");
        let (law, larger) =
            (any_law::<f64, 3>(&controller, &data, &|x| x), any_law::<f64, 5>(&controller, &data, &|x| x));
        let u = law.torque(&robot, &x, &q_ld, &law.start(&robot, &x, &q_ld));
        let more = larger.torque(&padded, &far, &q_far, &larger.start(&padded, &far, &q_far));
        assert_eq!(head(&more).0.map(f64::to_bits), u.0.map(f64::to_bits), "{name}");
        assert_eq!([more[3], more[4]].map(|u| u.abs().to_bits()), [0; 2], "{name}");
    }
}
