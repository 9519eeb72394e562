//! Springs, motors, dampers and metrics that couple the joints: where the theory allows full matrices, and that it is told where not.

use flexure_core::contraction::{
    FlexibleJoints, FullDesign, FullGains, FullJoints, Refusal, Together, VirtualSystem,
};
use flexure_core::control::{LinkGains, Metric, MotorGains, Shaping, Tanh, Vcbc};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, LinkMatrices, Links, State};
use flexure_core::reference::Sine;
use flexure_core::robots::PlanarTwoLink;
use flexure_core::scalar::{Dual, Over, Scalar};

use super::{norm, solution};
use crate::common::{Numbers, close, moving, planar};

type Two = Matrix<f64, 2, 2>;
type Design<P> = FullDesign<f64, PlanarTwoLink<f64>, P, P, Sine<f64, 2>, 2>;

/// φ = Λ q̃ with a full Λ.
struct Full(Two);

impl<C: Scalar> Shaping<C, 2> for Full {
    fn eval<T: Over<C>>(&self, error: &Vector<T, 2>) -> Vector<T, 2> {
        self.0.map(T::from_f64) * *error
    }
}

const SINE: Sine<f64, 2> = Sine {
    offset: Vector([0.1, -0.2]),
    amplitude: Vector([0.4, 0.3]),
    frequency: Vector([1.0, 1.7]),
    phase: Vector([0.3, 0.0]),
};

/// Symmetric positive definite, and not diagonal.
fn full(a: f64, b: f64, c: f64) -> Two {
    Matrix([[a, c], [c, b]])
}

fn coupled<P>(link: P, motor: P) -> Design<P> {
    FullDesign {
        joints: FullJoints {
            links: planar(),
            motor_inertia: full(0.3, 0.2, 0.05),
            stiffness: full(120.0, 80.0, 25.0),
            link_damping: full(0.8, 0.5, 0.2),
            motor_damping: full(1.0, 1.5, -0.3),
        },
        link: FullGains { metric: full(50.0, 30.0, 8.0), shaping: link, damping: full(12.0, 9.0, 2.0) },
        motor: FullGains { metric: full(60.0, 40.0, -7.0), shaping: motor, damping: full(8.0, 5.0, 1.0) },
        reference: SINE,
    }
}

/// Along the virtual system the errors obey the closed loop of the theory, with full matrices in the place of diagonal ones; and the coupling
/// cancels in the rate of W = ½ x̃ᵀ Π x̃.
#[test]
fn the_closed_loop_is_that_of_the_theory() {
    let mut r = Numbers(1);
    let design = coupled(Full(full(20.0, 14.0, 3.0)), Full(full(18.0, 15.0, -2.0)));
    assert_eq!(design.check(), Ok(()));
    for _ in 0..10 {
        let (x, x_v, t): (Vector<f64, 8>, Vector<f64, 8>, f64) = (r.vector(0.5), r.vector(0.5), r.next());
        let [dx, dx_v] = [design.actual_rate(&x, t), design.closed_rate(&x_v, &x, t)];
        let error = design.error(&moving(&x_v, &dx_v), &moving(&x, &dx), Dual::variable(t, 0));
        let value = |x: &Vector<Dual<f64, 1>, 2>| x.map(|x| x.value);
        let rate = |x: &Vector<Dual<f64, 1>, 2>| x.map(|x| x.gradient[0]);

        let (joints, q) = (&design.joints, State::<f64, 2>::from_vector(&x).q_l);
        let factor = joints.links.factor(&q);
        let (s_l, s_m) =
            (factor.solve(&value(&error.sigma_l)), joints.motor_inertia.ldl().solve(&value(&error.sigma_m)));
        let v = factor.solve(&State::<f64, 2>::from_vector(&x).p_l);
        let E = LinkMatrices::new(&joints.links, &q, &v).workless();
        let (e_l, e_m) = (value(&error.e_l), value(&error.e_m));
        let spring = design.motor.metric.ldl().solve(&(joints.stiffness.transpose() * s_l));
        let phi =
            |gains: &FullGains<f64, Full, 2>, e: &Vector<f64, 2>| Shaping::<f64, 2>::eval(&gains.shaping, e);
        let (phi_l, phi_m) = (phi(&design.link, &e_l), phi(&design.motor, &e_m));
        let damped = |D: Two, gain: Two, s: &Vector<f64, 2>| (D + gain) * *s;
        let lost = [
            damped(joints.link_damping, design.link.damping, &s_l),
            damped(joints.motor_damping, design.motor.damping, &s_m),
        ];

        // What cancels are torques of 1e4 N m.
        let torque = norm(&design.law(&x_v, &x, t)).max(1.0);
        let near = |a: &Vector<f64, 2>, b: Vector<f64, 2>| {
            assert!(norm(&(*a - b)) < 1e-11 * torque, "{a:?} against {b:?}");
        };
        near(&rate(&error.e_l), s_l - phi_l);
        near(&rate(&error.e_m), s_m - phi_m - spring);
        near(&rate(&error.sigma_l), joints.stiffness * e_m - design.link.metric * e_l - E * s_l - lost[0]);
        near(&rate(&error.sigma_m), -(design.motor.metric * e_m) - lost[1]);

        let moved = Vector::from_fn(|i| Dual { value: q[i], gradient: [v[i]] });
        let s_l_moved = joints.links.factor(&moved).solve(&error.sigma_l);
        let stored = 0.5
            * (2.0 * e_l.dot(&(design.link.metric * rate(&error.e_l)))
                + 2.0 * e_m.dot(&(design.motor.metric * rate(&error.e_m)))
                + error.sigma_l.dot(&s_l_moved).gradient[0]
                + 2.0 * s_m.dot(&rate(&error.sigma_m)));
        let expected = -(e_l.dot(&(design.link.metric * phi_l))
            + e_m.dot(&(design.motor.metric * phi_m))
            + s_l.dot(&lost[0])
            + s_m.dot(&lost[1]));
        assert!((stored - expected).abs() < 1e-10 * torque * norm(&s_m).max(1.0), "{stored} {expected}");

        assert!(norm(&design.actual_defect(&x, &r.vector(5.0), t).rate) < 1e-12);
        assert!(norm(&design.reference_defect(&x, t)) < 1e-10 * torque);
    }
}

/// With diagonal matrices it is the law that runs on controllers, derived in another way: dual numbers in dual numbers against series.
#[test]
fn diagonal_matrices_give_the_law_of_the_library() {
    let mut r = Numbers(2);
    for _ in 0..10 {
        let robot = Fjr {
            links: planar(),
            motor_inertia: r.between(0.1, 0.5),
            stiffness: r.between(50.0, 200.0),
            link_damping: r.between(0.1, 1.0),
            motor_damping: r.between(0.1, 2.0),
        };
        let tanh = |r: &mut Numbers| Tanh { gain: r.between(5.0, 20.0) };
        let (metric, link_damping, motor_damping) =
            (r.between(20.0, 60.0), r.between(2.0, 15.0), r.between(2.0, 9.0));
        let (link, motor, motor_metric) = (tanh(&mut r), tanh(&mut r), r.between(20.0, 70.0));
        let law = Vcbc {
            link: LinkGains { metric: Metric::Constant(metric), shaping: link, damping: link_damping },
            motor: MotorGains { metric: motor_metric, shaping: motor, damping: motor_damping },
        };
        let diagonal = |d: &Vector<f64, 2>| Matrix::diagonal(d);
        let design = FullDesign {
            joints: FullJoints {
                links: planar(),
                motor_inertia: diagonal(&robot.motor_inertia),
                stiffness: diagonal(&robot.stiffness),
                link_damping: diagonal(&robot.link_damping),
                motor_damping: diagonal(&robot.motor_damping),
            },
            link: FullGains { metric: diagonal(&metric), shaping: link, damping: diagonal(&link_damping) },
            motor: FullGains {
                metric: diagonal(&motor_metric),
                shaping: motor,
                damping: diagonal(&motor_damping),
            },
            reference: SINE,
        };
        let built_in = FlexibleJoints { robot, law, reference: SINE };
        let (x, x_v, t): (Vector<f64, 8>, Vector<f64, 8>, f64) = (r.vector(0.5), r.vector(0.5), r.next());
        // Both lose digits to torques of 1e4 N m times the condition of M.
        close(&design.law(&x_v, &x, t), &built_in.law(&x_v, &x, t), 1e-11);
        close(&design.reference(&x, t), &VirtualSystem::<f64, 8, 2>::reference(&built_in, &x, t), 1e-11);
    }
}

/// Step 3 with full matrices: the robot follows.
#[test]
fn the_coupled_robot_follows() {
    let design = coupled(Full(full(20.0, 14.0, 3.0)), Full(full(18.0, 15.0, -2.0)));
    let start: Vector<f64, 8> = design.reference(&Vector([0.0; 8]), 0.0);
    let together: Vector<f64, 16> = Vector::from_fn(|i| start[i % 8] + if i % 3 == 0 { 0.01 } else { -0.01 });
    let (h, steps) = (1e-3, 1500);
    let end = solution(&Together::<_, 8, 2>(&design), together, h, steps);
    let (x, x_v): (Vector<f64, 8>, Vector<f64, 8>) =
        (Vector::from_fn(|i| end[i]), Vector::from_fn(|i| end[8 + i]));
    let target = design.reference(&x, h * steps as f64);
    let (real, copy) = (norm(&(x - target)), norm(&(x_v - target)));
    assert!(real < 1e-6 && copy < 1e-6, "{real:e} and {copy:e}");
}

/// What the theory does not allow is refused by name: springs that cannot pass on every torque, matrices that are no energies.
#[test]
fn what_is_no_design_is_refused_with_the_reason() {
    let design = || coupled(Full(full(20.0, 14.0, 3.0)), Full(full(18.0, 15.0, -2.0)));
    let mut slack = design();
    slack.joints.stiffness = full(120.0, 80.0, 100.0);
    let refused = slack.check();
    assert!(
        matches!(refused, Err(Refusal::NotPositiveDefinite { matrix: "K", index: 1, .. })),
        "{refused:?}"
    );
    let mut skew = design();
    skew.joints.motor_inertia = Matrix([[0.3, 0.1], [0.0, 0.2]]);
    assert_eq!(skew.check(), Err(Refusal::NotSymmetric { matrix: "M_m", row: 1, column: 0 }));
    let mut hollow = design();
    hollow.motor.metric = full(60.0, -1.0, 0.0);
    assert!(matches!(hollow.check(), Err(Refusal::NotPositiveDefinite { matrix: "Π", .. })));
    let mut nothing = design();
    nothing.link.damping = full(f64::NAN, 1.0, 0.0);
    assert!(nothing.check().is_err());
    assert_eq!(
        skew.check().expect_err("refused").to_string(),
        "M_m is not symmetric: entries (1, 0) and (0, 1) differ"
    );
}
