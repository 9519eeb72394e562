//! One joint, linear and alone: link and motor on either side of the spring, in steady oscillation.

use flexure_core::scalar::{Dual, Over, Scalar};

use crate::linalg::Complex;

/// Parameters of the linear joint that are to be found: stiffness and motor inertia, in logarithms, and both dampings.
pub(super) const LINEAR: usize = 4;

/// A joint with the others held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// Inertia of what the joint moves [kg m²].
    pub link_inertia: f64,
    /// Motor inertia [kg m²].
    pub motor_inertia: f64,
    /// Stiffness [N m/rad].
    pub stiffness: f64,
    /// Damping of the link [N m s/rad].
    pub link_damping: f64,
    /// Damping of the motor [N m s/rad].
    pub motor_damping: f64,
}

/// Real and imaginary part.
type Pair<T> = [T; 2];

fn product<T: Scalar>(a: Pair<T>, b: Pair<T>) -> Pair<T> {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn quotient<T: Scalar>(a: Pair<T>, b: Pair<T>) -> Pair<T> {
    let size = (b[0].square() + b[1].square()).recip();
    product(a, [b[0] * size, -(b[1] * size)])
}

impl Joint {
    /// ω of the swing of link and motor against each other, √(K (1/M_l + 1/M_m)) [rad/s].
    pub fn resonance(&self) -> f64 {
        (self.stiffness * (self.link_inertia.recip() + self.motor_inertia.recip())).sqrt()
    }

    /// Positions of link and motor per N m of motor torque at `omega` [rad/s], each with its derivatives after ln K, ln M_m, D_l and
    /// D_m: (k − m ω² + i ω d) q_l = k q_m and (k − b ω² + i ω e) q_m = u + k q_l.
    pub(super) fn response(&self, omega: f64) -> [Pair<Dual<f64, LINEAR>>; 2] {
        let relative = |value: f64, index: usize| {
            let Dual { gradient, .. } = Dual::<f64, LINEAR>::variable(value, index);
            Dual { value, gradient: gradient.map(|slope| slope * value) }
        };
        let (k, b) = (relative(self.stiffness, 0), relative(self.motor_inertia, 1));
        let (d, e) = (Dual::variable(self.link_damping, 2), Dual::variable(self.motor_damping, 3));
        let m = Dual::constant(self.link_inertia);
        // What a side asks for beside its spring, −m ω² + i ω d.
        let side = |inertia: Dual<f64, LINEAR>, damping: Dual<f64, LINEAR>| {
            [-inertia.scale(omega * omega), damping.scale(omega)]
        };
        let (link, motor) = (side(m, d), side(b, e));
        let both = product(link, motor);
        // (k + link) (k + motor) − k², without the squares that cancel.
        let determinant = [0, 1].map(|part| k * (link[part] + motor[part]) + both[part]);
        let zero = Dual::constant(0.0);
        [quotient([k, zero], determinant), quotient([k + link[0], link[1]], determinant)]
    }

    /// Positions of link and motor per N m at `omega`, without derivatives.
    pub(super) fn gains(&self, omega: f64) -> [Complex; 2] {
        self.response(omega).map(|[re, im]| Complex { re: re.value, im: im.value })
    }
}

#[cfg(test)]
impl Joint {
    /// With a parameter moved by `step`: ln K, ln M_m, D_l, D_m; others are not its own.
    pub(super) fn moved(mut self, parameter: usize, step: f64) -> Self {
        match parameter {
            0 => self.stiffness *= step.exp(),
            1 => self.motor_inertia *= step.exp(),
            2 => self.link_damping += step,
            3 => self.motor_damping += step,
            _ => {}
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::{Joint, LINEAR};

    const JOINT: Joint = Joint {
        link_inertia: 0.93,
        motor_inertia: 0.6057,
        stiffness: 14_000.0,
        link_damping: 0.5,
        motor_damping: 1.0,
    };

    /// Both equations of motion hold, and derivatives are limits of differences.
    #[test]
    fn responses_solve_the_equations() {
        for omega in [1.0, 50.0, 0.99 * JOINT.resonance(), 400.0] {
            let [link, motor] = JOINT.gains(omega);
            let Joint { link_inertia: m, motor_inertia: b, stiffness: k, link_damping: d, motor_damping: e } =
                JOINT;
            let sides = [(m, d, link, motor, 0.0), (b, e, motor, link, 1.0)];
            for (inertia, damping, own, other, torque) in sides {
                let re =
                    (k - inertia * omega * omega) * own.re - omega * damping * own.im - k * other.re - torque;
                let im = (k - inertia * omega * omega) * own.im + omega * damping * own.re - k * other.im;
                assert!(re.abs() + im.abs() < 1e-9 * (1.0 + k * own.abs()), "{omega}: {re}, {im}");
            }
            let duals = JOINT.response(omega);
            for parameter in 0..LINEAR {
                const STEP: f64 = 1e-5;
                let ends = [STEP, -STEP].map(|step| JOINT.moved(parameter, step).gains(omega));
                for side in 0..2 {
                    let slope = (ends[0][side] - ends[1][side]).scaled(0.5 / STEP);
                    let exact = duals[side].map(|part| part.gradient[parameter]);
                    let size = exact[0].hypot(exact[1]);
                    // Second order in the step times the quality of the swing, and rounding over it.
                    assert!(
                        (slope.re - exact[0]).hypot(slope.im - exact[1])
                            < 1e-5 * size + 1e-9 * ends[0][side].abs(),
                        "{omega} {parameter}"
                    );
                }
            }
        }
    }
}
