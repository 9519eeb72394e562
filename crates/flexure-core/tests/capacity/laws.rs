//! Every law, its gains padded by 1.

use flexure_core::control::{
    Backstepping, Cascade, ControlLaw, CoupledTanh, Esp, FeedbackLinearization, FeedforwardPd,
    GravityCancellation, InnerLoop, IntegralManifold, Linear, LinkGains, Metric, MotorGains, MotorPd,
    Passivity, Pd, PdOnlineGravity, RigidVcbc, Shaping, SingularPerturbation, Tanh, TorqueFeedback, Vcbc,
};
use flexure_core::linalg::Vector;
use flexure_core::model::Motion;
use flexure_core::scalar::{Jet, Over, Scalar};

use super::{Constants, Random, fit, fit_motion, random, robot, same_joints, tree};
use crate::common::{Numbers, flexible, laws as random_law, linear, tanh};

/// The same gains for `N` joints, 1 for those beyond, as constants of another type.
trait Padded {
    type At<C: Scalar, const N: usize>;
    fn at<C: Scalar, const N: usize>(&self, number: fn(f64) -> C) -> Self::At<C, N>;
}

impl<const K: usize> Padded for Vector<f64, K> {
    type At<C: Scalar, const N: usize> = Vector<C, N>;
    fn at<C: Scalar, const N: usize>(&self, number: fn(f64) -> C) -> Vector<C, N> {
        fit(self, 1.0).map(number)
    }
}

impl<P: Padded> Padded for [P; 4] {
    type At<C: Scalar, const N: usize> = [P::At<C, N>; 4];
    fn at<C: Scalar, const N: usize>(&self, number: fn(f64) -> C) -> [P::At<C, N>; 4] {
        self.each_ref().map(|part| part.at(number))
    }
}

macro_rules! padded {
    ($($law:ident { $($gain:ident),+ })+) => {$(
        impl<const K: usize> Padded for $law<f64, K> {
            type At<C: Scalar, const N: usize> = $law<C, N>;
            fn at<C: Scalar, const N: usize>(&self, number: fn(f64) -> C) -> $law<C, N> {
                $law { $($gain: self.$gain.at(number)),+ }
            }
        }
    )+};
}

padded! {
    Backstepping { shaping, link_damping, metric, motor_shaping }
    Cascade { shaping, link_damping, inner }
    Esp { link_damping, motor }
    FeedbackLinearization { gains }
    FeedforwardPd { motor }
    GravityCancellation { motor }
    InnerLoop { position, velocity }
    IntegralManifold { position, velocity, damping }
    Linear { gain }
    MotorPd { stiffness, damping }
    Passivity { shaping, link_damping, motor_damping }
    Pd { motor }
    PdOnlineGravity { motor }
    SingularPerturbation { position, velocity, damping }
    Tanh { gain }
    TorqueFeedback { inertia, motor }
}

impl<const K: usize> Padded for RigidVcbc<f64, Linear<f64, K>, K> {
    type At<C: Scalar, const N: usize> = RigidVcbc<C, Linear<C, N>, N>;
    fn at<C: Scalar, const N: usize>(&self, number: fn(f64) -> C) -> Self::At<C, N> {
        let Metric::Constant(metric) = &self.link.metric else { panic!("made constant") };
        let metric = Metric::Constant(metric.at(number));
        let (shaping, damping) = (self.link.shaping.at(number), self.link.damping.at(number));
        RigidVcbc { link: LinkGains { metric, shaping, damping } }
    }
}

/// κ and Λ of a coupled tanh of `K` joints.
struct Coupled<const K: usize>([Vector<f64, K>; 2]);

impl<const K: usize> Padded for Coupled<K> {
    type At<C: Scalar, const N: usize> = CoupledTanh<C, N>;
    fn at<C: Scalar, const N: usize>(&self, number: fn(f64) -> C) -> CoupledTanh<C, N> {
        CoupledTanh::of_joints(K, self.0[0].at(number), &self.0[1].at(number))
    }
}

/// v-CBC with a metric that hardens: base, hardening, damping of the links; metric, damping of the motors.
struct Virtual<P, const K: usize> {
    gains: [Vector<f64, K>; 5],
    shaping: [P; 2],
}

impl<P: Padded, const K: usize> Padded for Virtual<P, K> {
    type At<C: Scalar, const N: usize> = Vcbc<C, P::At<C, N>, P::At<C, N>, N>;
    fn at<C: Scalar, const N: usize>(&self, number: fn(f64) -> C) -> Self::At<C, N> {
        let [base, hardening, damping_l, metric, damping_m] = self.gains.map(|gain| gain.at(number));
        let [link, motor] = self.shaping.each_ref().map(|shaping| shaping.at(number));
        Vcbc {
            link: LinkGains {
                metric: Metric::Hardening { base, hardening },
                shaping: link,
                damping: damping_l,
            },
            motor: MotorGains { metric, shaping: motor, damping: damping_m },
        }
    }
}

/// The torque of a law on a robot in motion; phantoms get 0. Out of line: all laws in one function are more than the compiler survives.
#[inline(never)]
fn torque<C: Scalar + PartialEq, T: Over<C>, A: Padded, const K: usize, const N: usize>(
    law: &A,
    constants: Constants<C>,
    number: Random<T>,
) where
    A::At<C, K>: ControlLaw<C, K>,
    A::At<C, N>: ControlLaw<C, N>,
{
    let r = &mut Numbers(11);
    let data = flexible(tree::<f64, K, K>(4, crate::FLOAT), r);
    let (exact, roomy) = (robot::<C, K, K>(4, &data, constants), robot::<C, K, N>(4, &data, constants));
    for _ in 0..3 {
        let x = Motion {
            q_l: random::<T, K>(r, number, 1.0),
            q_m: random(r, number, 1.0),
            v_l: random(r, number, 1.0),
            v_m: random(r, number, 1.0),
        };
        let q_d: Vector<Jet<T, 5>, K> = random(r, number, 1.0).map(|x| Jet::variable(x).sin());
        let small = law.at::<C, K>(constants.0).torque(&exact, &x, &q_d);
        let large = law.at::<C, N>(constants.0).torque(&roomy, &fit_motion(&x), &fit(&q_d, Jet::ZERO));
        // The sum takes the sign from zeros.
        same_joints(&small, &large.map(|u| u + T::ZERO), &Vector::ZERO);
    }
}

/// Every law.
fn all<C: Scalar + PartialEq, T: Over<C>, const K: usize, const N: usize>(
    constants: Constants<C>,
    number: Random<T>,
) {
    macro_rules! each {
        ($($law:expr),+ $(,)?) => {$( torque::<C, T, _, K, N>(&$law, constants, number); )+};
    }
    let r = &mut Numbers(23);
    each!(
        random_law::backstepping::<K>(r),
        random_law::cascade::<K>(r),
        random_law::esp::<K>(r),
        random_law::feedback_linearization::<K>(r),
        random_law::feedforward_pd::<K>(r),
        random_law::gravity_cancellation::<K>(r),
        random_law::integral_manifold::<K>(r),
        random_law::passivity::<K>(r),
        random_law::pd::<K>(r),
        random_law::pd_online_gravity::<K>(r),
        random_law::rigid::<K>(r),
        random_law::singular_perturbation::<K>(r),
        random_law::torque_feedback::<K>(r),
    );
    v_cbc::<C, T, K, N>(constants, number);
}

/// v-CBC with every shaping function.
#[inline(never)]
fn v_cbc<C: Scalar + PartialEq, T: Over<C>, const K: usize, const N: usize>(
    constants: Constants<C>,
    number: Random<T>,
) {
    let r = &mut Numbers(29);
    let gains: [Vector<f64, K>; 5] = core::array::from_fn(|_| r.between(2.0, 20.0));
    let linear: [Linear<f64, K>; 2] = core::array::from_fn(|_| linear(r));
    let tanh: [Tanh<f64, K>; 2] = core::array::from_fn(|_| tanh(r));
    let coupled: [Coupled<K>; 2] =
        core::array::from_fn(|_| Coupled([r.between(4.0, 10.0), r.between(20.0, 60.0)]));
    torque::<C, T, _, K, N>(&Virtual { gains, shaping: linear }, constants, number);
    torque::<C, T, _, K, N>(&Virtual { gains, shaping: tanh }, constants, number);
    torque::<C, T, _, K, N>(&Virtual { gains, shaping: coupled }, constants, number);
}

#[test]
fn every_law() {
    all::<f64, f64, 3, 4>(crate::FLOAT, crate::number_f64);
    all::<f64, f64, 7, 16>(crate::FLOAT, crate::number_f64);
}

#[test]
fn the_virtual_law_on_every_number() {
    on_numbers!(v_cbc::<3, 4>);
    v_cbc::<f64, f64, 6, 8>(crate::FLOAT, crate::number_f64);
}

/// Without [`CoupledTanh::of_joints`] real errors would move phantoms, and n would be the capacity.
#[test]
fn only_real_joints_are_coupled() {
    let (kappa, gain) = (Vector([2.0; 4]), Vector([4.0; 4]));
    let error = Vector([0.5, -0.25, 0.0, 0.0]);
    let all = CoupledTanh::new(kappa, &gain).eval(&error);
    assert!(all[2] != 0.0 && all[3] != 0.0);
    let two = CoupledTanh::of_joints(2, kappa, &gain).eval(&error);
    assert_eq!(two, Vector([1.5 + (-0.25_f64).tanh(), -0.75 + 0.5_f64.tanh(), 0.0, 0.0]));
}
