//! The three steps of v-CBC on a rigid arm: the paper's lemma fullstatecontroller-rigid as an instance.

use flexure_core::contraction::{
    ControlSystem, Dynamics, MatrixField, Root, Together, VirtualSystem, contraction_matrix,
    generalised_jacobian, measure_2, over_pieces,
};
use flexure_core::control::{Linear, LinkGains, Metric, RigidVcbc, Shaping};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{LinkMatrices, Links, MassFactor};
use flexure_core::reference::{Reference, Sine};
use flexure_core::robots::PlanarTwoLink;
use flexure_core::scalar::{Dual, Interval, Over, Piecewise, Scalar};

use super::{norm, solution};
use crate::common::{Numbers, close, planar};

/// A rigid arm with a motor in every joint: q̇ = M⁻¹ p, ṗ = −(E + D) q̇ − g + u, y = q̇.
struct Rigid<C, L> {
    links: L,
    damping: Vector<C, 2>,
}

impl<C: Scalar, L: Links<C, 2>> Rigid<C, L> {
    /// The virtual system along `x`; the arm itself for `x_v = x`.
    fn virtual_rate<T: Over<C>>(
        &self,
        x_v: &Vector<T, 4>,
        x: &Vector<T, 4>,
        u: &Vector<T, 2>,
    ) -> Vector<T, 4> {
        let ([q_v, p_v], [q, p]) = (halves(x_v), halves(x));
        let factor = self.links.factor(&q);
        let v_v = factor.solve(&p_v);
        let E = LinkMatrices::new(&self.links, &q, &factor.solve(&p)).workless();
        let force = *u - E * v_v - self.damping.diag_mul(&v_v) - self.links.gravity_torque(&q_v);
        Vector([v_v[0], v_v[1], force[0], force[1]])
    }
}

fn halves<T: Copy>(x: &Vector<T, 4>) -> [Vector<T, 2>; 2] {
    [Vector([x[0], x[1]]), Vector([x[2], x[3]])]
}

impl<C: Scalar, L: Links<C, 2>> ControlSystem<C, 4, 2> for Rigid<C, L> {
    fn drift<T: Over<C> + Piecewise>(&self, x: &Vector<T, 4>, _: T) -> Vector<T, 4> {
        self.virtual_rate(x, x, &Vector::ZERO)
    }
    fn port<T: Over<C> + Piecewise>(&self, _: &Vector<T, 4>, _: T) -> Matrix<T, 4, 2> {
        Matrix::from_fn(|i, j| if i == 2 + j { T::ONE } else { T::ZERO })
    }
    fn output<T: Over<C> + Piecewise>(&self, x: &Vector<T, 4>, _: T) -> Vector<T, 2> {
        let [q, p] = halves(x);
        self.links.factor(&q).solve(&p)
    }
}

/// The law of the paper's lemma fullstatecontroller-rigid, with a constant metric.
struct RigidDesign<C, L, P> {
    arm: Rigid<C, L>,
    metric: Vector<C, 2>,
    shaping: P,
    gain: Vector<C, 2>,
    reference: Sine<C, 2>,
}

impl<C: Scalar, L: Links<C, 2>, P: Shaping<C, 2>> RigidDesign<C, L, P> {
    fn error<T: Over<C> + Piecewise>(&self, q_v: &Vector<T, 2>, t: T) -> Vector<T, 2> {
        *q_v - self.reference.on(t)
    }
    /// q̇_r = q̇_d − φ(q̃).
    fn velocity<T: Over<C> + Piecewise>(&self, q_v: &Vector<T, 2>, t: T) -> Vector<T, 2> {
        let rate = self.reference.on(Dual::<T, 1>::variable(t, 0)).map(|q| q.gradient[0]);
        rate - self.shaping.eval(&self.error(q_v, t))
    }
    /// (q̃, σ).
    fn errors<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, 4>, x: &Vector<T, 4>, t: T) -> Vector<T, 4> {
        let ([q_v, p_v], [q, _]) = (halves(x_v), halves(x));
        let (e, sigma) = (self.error(&q_v, t), p_v - self.arm.links.mass_mul(&q, &self.velocity(&q_v, t)));
        Vector([e[0], e[1], sigma[0], sigma[1]])
    }
}

impl<C: Scalar, L: Links<C, 2>, P: Shaping<C, 2>> VirtualSystem<C, 4, 2> for RigidDesign<C, L, P> {
    type Actual = Rigid<C, L>;
    fn actual(&self) -> &Rigid<C, L> {
        &self.arm
    }
    fn virtual_rate<T: Over<C> + Piecewise>(
        &self,
        x_v: &Vector<T, 4>,
        x: &Vector<T, 4>,
        u_v: &Vector<T, 2>,
        _: T,
    ) -> Vector<T, 4> {
        self.arm.virtual_rate(x_v, x, u_v)
    }
    fn virtual_output<T: Over<C> + Piecewise>(
        &self,
        x_v: &Vector<T, 4>,
        x: &Vector<T, 4>,
        _: T,
    ) -> Vector<T, 2> {
        self.arm.links.factor(&halves(x)[0]).solve(&halves(x_v)[1])
    }
    fn law<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, 4>, x: &Vector<T, 4>, t: T) -> Vector<T, 2> {
        let ([q_v, p_v], [q, p]) = (halves(x_v), halves(x));
        let factor = self.arm.links.factor(&q);
        let (v, v_v) = (factor.solve(&p), factor.solve(&p_v));
        let moving = Vector::from_fn(|i| Dual { value: q_v[i], gradient: [v_v[i]] });
        let reference = self.velocity(&moving, Dual::<T, 1>::variable(t, 0));
        let (v_r, a_r) = (reference.map(|v| v.value), reference.map(|v| v.gradient[0]));
        self.arm.links.inertial_torque(&q, &v, &v_r, &a_r)
            + self.arm.links.gravity_torque(&q_v)
            + self.arm.damping.diag_mul(&v_r)
            - self.metric.diag_mul(&self.error(&q_v, t))
            - self.gain.diag_mul(&(v_v - v_r))
    }
    fn reference<T: Over<C> + Piecewise>(&self, x: &Vector<T, 4>, t: T) -> Vector<T, 4> {
        let q_d = self.reference.on(Dual::<T, 1>::variable(t, 0));
        let p = self.arm.links.mass_mul(&halves(x)[0], &q_d.map(|q| q.gradient[0]));
        Vector([q_d[0].value, q_d[1].value, p[0], p[1]])
    }
    /// √diag(Π, M⁻¹) ∂(q̃, σ)/∂x_v.
    fn weight<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, 4>, x: &Vector<T, 4>, t: T) -> Matrix<T, 4, 4> {
        let variables = Vector::from_fn(|j| Dual::<T, 4>::variable(x_v[j], j));
        let errors = self.errors(&variables, &x.map(Dual::constant), Dual::<T, 4>::constant(t));
        let factor = self.arm.links.factor(&halves(x)[0]);
        let inverse = Matrix([[T::ONE, T::ZERO], [T::ZERO, T::ONE]].map(|e| factor.solve(&Vector(e)).0));
        let (Pi, root) = (self.metric.map(C::sqrt).lift::<T>(), inverse.ldl().root());
        let root = Matrix::from_fn(|i, j| match (i < 2, j < 2) {
            (true, true) if i == j => Pi[i],
            (false, false) => root[(i - 2, j - 2)],
            _ => T::ZERO,
        });
        root * Matrix(errors.map(|e| e.gradient).0)
    }
}

fn rigid<C: Scalar, P>(
    f: fn(f64) -> C,
    shaping: fn(Vector<C, 2>) -> P,
) -> RigidDesign<C, PlanarTwoLink<C>, P> {
    let two = |a: f64, b: f64| Vector([f(a), f(b)]);
    RigidDesign {
        arm: Rigid { links: planar().map(f), damping: two(0.8, 0.55) },
        metric: two(55.0, 30.0),
        shaping: shaping(two(20.0, 15.0)),
        gain: two(15.0, 10.0),
        reference: Sine { amplitude: two(0.5, 0.4), frequency: two(1.0, 1.5), ..Sine::ZERO },
    }
}

/// Step 1 and 2: real solutions are virtual ones, the reference solves the virtual closed loop, and that contracts at the rate of its slowest
/// block, here of φ. Step 3: at x_v = x the law is the one that the library has for rigid arms.
#[test]
fn a_rigid_arm_is_an_instance() {
    let (mut r, design) = (Numbers(1), rigid(|x| x, |gain| Linear { gain }));
    let built_in = RigidVcbc {
        link: LinkGains {
            metric: Metric::Constant(design.metric),
            shaping: design.shaping,
            damping: design.gain,
        },
    };
    for _ in 0..20 {
        let (x, x_v, t): (Vector<f64, 4>, Vector<f64, 4>, f64) =
            (r.vector(0.5), r.vector(0.5), 3.0 * r.next());
        let defect = design.actual_defect(&x, &r.vector(5.0), t);
        assert!(norm(&defect.rate) < 1e-12 && norm(&defect.output) == 0.0);
        // Momenta of torques of 1e3 N m.
        assert!(norm(&design.reference_defect(&x, t)) < 1e-11);
        let now = design.along(x, t);
        let mu = measure_2(&generalised_jacobian::<f64, f64, 4>(&now, &now, &x_v, 0.0));
        assert!((mu + 15.0).abs() < 1e-8, "{mu}");

        let [q, p] = halves(&x);
        let v = design.arm.links.factor(&q).solve(&p);
        let q_d = design.reference.at::<3>(t);
        let torque =
            built_in.command(&design.arm.links, &design.arm.damping, &q, &v, &q_d, &Vector([0.0; 2]));
        close(&design.law(&x, &x, t), &torque.torque.map(|u| u.coefficient(0)), 1e-12);
    }
}

/// It follows its reference at that rate, from far away, and its virtual system with it.
#[test]
fn the_rigid_arm_converges() {
    let design = rigid(|x| x, |gain| Linear { gain });
    let start = Vector([1.0, -0.8, 0.0, 0.0, -0.5, 0.6, 0.1, 0.0]);
    let (h, steps) = (1e-3, 1000);
    let end = solution(&Together::<_, 4, 2>(&design), start, h, steps);
    let (x, x_v) = (Vector::from_fn(|i| end[i]), Vector::from_fn(|i| end[4 + i]));
    let target = design.reference(&x, 1.0);
    let start_error = 1.5;
    // e^−15 of the length of the error, in coordinates whose weights differ by a factor of 20.
    let bound = start_error * 20.0 * (-15.0_f64).exp();
    assert!(norm(&(x - target)) < bound && norm(&(x_v - target)) < bound, "{x:?} {x_v:?} {target:?}");
}

/// The same closed loop in its error coordinates (q̃, σ), while the arm is at `q` and moves at `v`: what the law cancels is gone, so that intervals
/// of it are tight.
struct RigidErrors<'a, C, L, P> {
    design: &'a RigidDesign<C, L, P>,
    q: Vector<C, 2>,
    v: Vector<C, 2>,
}

impl<C: Scalar, L: Links<C, 2>, P> RigidErrors<'_, C, L, P> {
    fn position<T: Over<C>>(&self, t: T) -> Vector<T, 2> {
        Vector::from_fn(|i| T::constant(self.q[i]) + t.scale(self.v[i]))
    }
}

impl<C: Scalar, L: Links<C, 2>, P: Shaping<C, 2>> Dynamics<C, 4> for RigidErrors<'_, C, L, P> {
    fn rate<T: Over<C> + Piecewise>(&self, x: &Vector<T, 4>, t: T) -> Vector<T, 4> {
        let (design, q, [e, sigma]) = (self.design, self.position(t), halves(x));
        let s = design.arm.links.factor(&q).solve(&sigma);
        let E = LinkMatrices::new(&design.arm.links, &q, &self.v.lift::<T>()).workless();
        let de = s - design.shaping.eval(&e);
        let damping = design.arm.damping + design.gain;
        let d_sigma = -(design.metric.diag_mul(&e) + E * s + damping.diag_mul(&s));
        Vector([de[0], de[1], d_sigma[0], d_sigma[1]])
    }
}

/// diag(Π, M⁻¹).
impl<C: Scalar, L: Links<C, 2>, P> MatrixField<C, 4> for RigidErrors<'_, C, L, P> {
    fn at<T: Over<C> + Piecewise>(&self, _: &Vector<T, 4>, t: T) -> Matrix<T, 4, 4> {
        let factor = self.design.arm.links.factor(&self.position(t));
        let inverse = Matrix([[T::ONE, T::ZERO], [T::ZERO, T::ONE]].map(|e| factor.solve(&Vector(e)).0));
        let Pi = self.design.metric.lift::<T>();
        Matrix::from_fn(|i, j| match (i < 2, j < 2) {
            (true, true) if i == j => Pi[i],
            (false, false) => inverse[(i - 2, j - 2)],
            _ => T::ZERO,
        })
    }
}

/// Where the elbow is between 0.5 and 0.6 rad and the joints turn at up to 0.2 rad/s, wherever the virtual arm is: the rate is above 14, in
/// intervals. The Jacobian is that of the virtual closed loop, at samples.
#[test]
fn the_rigid_arm_is_certified_over_a_box() {
    let (mut r, sampled) = (Numbers(3), rigid(|x| x, |gain| Linear { gain }));
    let (x, x_v): (Vector<f64, 4>, Vector<f64, 4>) = (r.vector(0.5), r.vector(0.5));
    let [q, p] = halves(&x);
    let v = sampled.arm.links.factor(&q).solve(&p);
    let errors = RigidErrors { design: &sampled, q, v };
    let here =
        generalised_jacobian::<f64, f64, 4>(&errors, &Root(&errors), &sampled.errors(&x_v, &x, 0.3), 0.0);
    let now = sampled.along(x, 0.3);
    let there = generalised_jacobian::<f64, f64, 4>(&now, &now, &x_v, 0.0);
    for (a, b) in here.0.as_flattened().iter().zip(there.0.as_flattened()) {
        assert!((a - b).abs() < 1e-9 * 100.0, "{a} against {b}");
    }

    let design = rigid(Interval::point, |gain| Linear { gain });
    let side = |low: f64, high: f64| Interval::new(low, high).expect("an interval");
    let speed = side(-0.2, 0.2);
    let least = |beta: f64| {
        over_pieces(&Vector([side(0.5, 0.6), speed, speed]), 9, &|piece| {
            let [q_2, v_1, v_2] = piece.0;
            let errors =
                RigidErrors { design: &design, q: Vector([Interval::ZERO, q_2]), v: Vector([v_1, v_2]) };
            let any = Vector([Interval::ENTIRE; 4]);
            let matrix = contraction_matrix(&errors, &errors, Interval::point(beta), &any, Interval::ZERO);
            matrix.ldl().pivots().iter().reduce(Interval::min).expect("four pivots")
        })
    };
    assert!(least(14.0).lo() > 0.0, "{:?}", least(14.0));
    // The rate is 15, the smaller gain of φ.
    assert!(least(15.5).lo() <= 0.0);
}
