//! Coulomb friction over a sampling period.
//!
//! Within a period a joint may come to rest and stay, or turn back. Friction that is smoothed over small speeds is not the
//! friction of the plant (set-valued at rest, [`crate::plant::Friction`]), and what is identified with it is biased: the mean
//! of the exact friction over the period is taken instead, of a joint under a constant torque.

/// The mean of friction over a period, and how it moves with the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rubbing {
    /// Mean of the sign of the velocity, −1 to 1; beside it friction is the Coulomb torque times this.
    pub share: f64,
    /// Derivative of the mean torque by the velocity at the start [N m s/rad].
    pub slope: f64,
    /// Whether it rests at the end.
    pub rests: bool,
}

impl Rubbing {
    /// Of a joint that slides all the while, at the velocity `v`.
    pub fn sliding(v: f64) -> Self {
        Self { share: if v == 0.0 { 0.0 } else { v.signum() }, slope: 0.0, rests: false }
    }

    /// Of a joint with the velocity `v` at the start that would have `end` if friction stayed as it is at the start
    /// ([rad/s]), of the inertia `inertia` [kg m²] with the Coulomb torque `coulomb` > 0 [N m], over `h` s.
    pub fn over(v: f64, end: f64, inertia: f64, coulomb: f64, h: f64) -> Self {
        let before = Self::sliding(v);
        if v * end > 0.0 {
            return before;
        }
        // The torque beside friction.
        let torque = inertia * (end - v) / h + coulomb * before.share;
        if torque.abs() <= coulomb {
            let share = before.share + inertia * end / (h * coulomb);
            return Self { share: share.clamp(-1.0, 1.0), slope: inertia / h, rests: true };
        }
        if v == 0.0 {
            return Self { share: torque.signum(), ..before };
        }
        // Until it turns back, a part v/(v − end) of the period.
        let until = v / (v - end);
        let share = before.share * (2.0 * until - 1.0);
        // It reaches zero with one acceleration and leaves it with the other: so much of a change of the velocity is left.
        let left = (torque + coulomb * before.share) / (torque - coulomb * before.share);
        Self { share, slope: (1.0 - left) * inertia / h, rests: false }
    }
}

#[cfg(test)]
mod tests {
    use super::Rubbing;

    const INERTIA: f64 = 0.5;
    const COULOMB: f64 = 2.0;
    const H: f64 = 1e-3;

    /// The velocity after a period under `torque`, by the mean of friction.
    fn by_the_mean(v: f64, torque: f64) -> (f64, Rubbing) {
        let end = v + H / INERTIA * (torque - COULOMB * Rubbing::sliding(v).share);
        let rubbing = Rubbing::over(v, end, INERTIA, COULOMB, H);
        (v + H / INERTIA * (torque - COULOMB * rubbing.share), rubbing)
    }

    /// The same by many small steps of which each stops what would turn back.
    fn by_small_steps(mut v: f64, torque: f64) -> f64 {
        let dt = H / 1e5;
        for _ in 0..100_000 {
            let free = v + dt / INERTIA * torque;
            let loss = dt / INERTIA * COULOMB;
            v = free.signum() * (free.abs() - loss).max(0.0);
        }
        v
    }

    #[test]
    fn the_mean_is_that_of_the_exact_motion() {
        for v in [-0.02, -0.003, -1e-5, 0.0, 1e-6, 0.002, 0.01] {
            for torque in [-9.0, -2.5, -1.9, 0.0, 0.7, 2.1, 6.0] {
                let (found, rubbing) = by_the_mean(v, torque);
                let exact = by_small_steps(v, torque);
                // Small steps are off by one of them.
                assert!((found - exact).abs() < 1e-6, "{v} rad/s, {torque} N m: {found} for {exact}");
                assert_eq!(rubbing.rests, exact == 0.0, "{v} rad/s, {torque} N m");
            }
        }
    }

    #[test]
    fn the_slope_is_that_of_the_mean() {
        for (v, torque) in [(0.002, -6.0), (-0.004, 9.0), (0.01, 0.3)] {
            let (d, at) = (1e-8, by_the_mean(v, torque).1);
            let difference = COULOMB
                * (by_the_mean(v + d, torque).1.share - by_the_mean(v - d, torque).1.share)
                / (2.0 * d);
            assert!((difference - at.slope).abs() < 1e-4 * (1.0 + at.slope.abs()), "{difference} for {at:?}");
        }
    }
}
