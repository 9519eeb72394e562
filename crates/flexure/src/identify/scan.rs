//! A look beyond the nearest minimum.
//!
//! Where friction turns and where a light link swings, the likelihood is rough: along numbers that a log hardly knows it has one
//! dent after the other, and Gauss–Newton ends in the first. Those numbers are few and known by name: the stiffness of a joint, and how
//! much of its damping and of its friction is the link's. Each is walked to both sides until the log clearly objects, which
//! takes one step for what it knows well.

use super::parameters::{Parameter, Values};

/// What is walked along, the other numbers as they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Along {
    /// Stiffness.
    Stiffness,
    /// Stiffness, with the other numbers as the log likes them best then, as far as it is quadratic: joints about nearly the same axis
    /// trade their compliances.
    Valley,
    /// The link's part of both dampings, whose sum stays.
    Damping,
    /// The link's part of both frictions, whose sum stays.
    Friction,
}

impl Along {
    /// All of a joint.
    pub const ALL: [Self; 4] = [Self::Stiffness, Self::Valley, Self::Damping, Self::Friction];

    /// Steps to either side, at most: to more than twice the stiffness and less than half of it, and to 98 % on one side.
    fn most(self) -> i32 {
        match self {
            Self::Stiffness | Self::Valley => 20,
            Self::Damping | Self::Friction => 6,
        }
    }

    /// `values` with the numbers of `joint` `steps` steps away: 4 % of a stiffness each, or a factor of 2 in the ratio of link to
    /// motor. `valley` is the step, as of [`Values::moved`], along which the compliance of the joint falls to nothing.
    pub fn walked(self, values: &Values, joint: usize, steps: i32, valley: &[f64]) -> Values {
        if self == Self::Valley {
            let less = 1.0 - 1.04_f64.powi(-steps);
            let step: Vec<f64> = valley.iter().map(|x| (less * x).clamp(-0.8, 0.8)).collect();
            return values.moved(&step);
        }
        let mut walked = values.clone();
        let numbers = &mut walked.joints[joint];
        let sides = match self {
            Self::Stiffness | Self::Valley => {
                numbers[Parameter::Stiffness.place()] *= 1.04_f64.powi(steps);
                return walked;
            }
            Self::Damping => [Parameter::LinkDamping, Parameter::MotorDamping],
            Self::Friction => [Parameter::LinkFriction, Parameter::MotorFriction],
        };
        let [link, motor] = sides.map(|side| numbers[side.place()]);
        let ratio = link / motor * 2.0_f64.powi(steps);
        numbers[sides[0].place()] = (link + motor) * ratio / (1.0 + ratio);
        numbers[sides[1].place()] = (link + motor) / (1.0 + ratio);
        walked
    }
}

/// Where the logarithm of the likelihood is worse by this than the best, a walk ends.
const HOPELESS: f64 = 1000.0;

/// From `values`, joint by joint, to the least `cost` on these walks, with a valley for each joint; with how much less it is there.
///
/// # Errors
/// Those of `cost`.
pub(crate) fn scanned<E>(
    values: &Values,
    valleys: &[Vec<f64>],
    cost: impl Fn(&Values) -> Result<f64, E>,
) -> Result<(Values, f64), E> {
    let here = cost(values)?;
    let mut best = (values.clone(), here);
    for (joint, valley) in valleys.iter().enumerate() {
        for along in Along::ALL {
            let from = best.0.clone();
            for side in [-1, 1] {
                for steps in 1..=along.most() {
                    let there = along.walked(&from, joint, side * steps, valley);
                    let cost = cost(&there)?;
                    if cost < best.1 {
                        best = (there, cost);
                    } else if cost > best.1 + HOPELESS {
                        break;
                    }
                }
            }
        }
    }
    Ok((best.0, here - best.1))
}

#[cfg(test)]
mod tests {
    use super::{Along, Values, scanned};

    fn values() -> Values {
        Values { joints: vec![[1000.0, 0.1, 0.2, 0.6, 0.1, 0.3]; 2], offsets: vec![0.0] }
    }

    /// Only the compliance of the second joint.
    fn valley() -> Vec<f64> {
        (0..13).map(|i| f64::from(i == 6)).collect()
    }

    #[test]
    fn walks_keep_sums_and_come_back() {
        let from = values();
        for along in [Along::Stiffness, Along::Damping, Along::Friction] {
            let there = along.walked(&from, 1, 3, &valley());
            let back = along.walked(&there, 1, -3, &valley());
            let moved = |joint: usize| {
                there.joints[joint].iter().zip(&from.joints[joint]).any(|(x, y)| (x - y).abs() > 0.0)
            };
            assert!(!moved(0) && moved(1));
            for (x, y) in back.joints[1].iter().zip(&from.joints[1]) {
                assert!((x - y).abs() < 1e-12 * y);
            }
            for pair in [[2, 3], [4, 5]] {
                let sum = |v: &Values| pair.map(|k| v.joints[1][k]).iter().sum::<f64>();
                assert!((sum(&there) - sum(&from)).abs() < 1e-12);
            }
        }
    }

    /// Two compliances whose sum is known well: only both together lead to the better dent.
    #[test]
    fn compliances_are_traded() {
        let mut valley = vec![0.0; 13];
        (valley[0], valley[6]) = (1.0, -1.0);
        let found = scanned(&values(), &[valley.clone(), valley.iter().map(|x| -x).collect()], |at| {
            let [first, second] = [1000.0 / at.joints[0][0], 1000.0 / at.joints[1][0]];
            let apart = first - second;
            Ok::<_, ()>(
                1e7 * (first + second - 2.0).powi(2)
                    + (apart - 0.4).powi(2)
                    + 0.2 * (1.0 - (20.0 * apart).cos()),
            )
        });
        let (found, better) = found.unwrap();
        assert!(
            better > 0.05 && found.joints[0][0] < 900.0 && found.joints[1][0] > 1100.0,
            "{found:?} {better}"
        );
    }

    /// A stiffness behind a ridge, and one where a step costs too much: only the first is walked to.
    #[test]
    fn the_likeliest_dent_is_found() {
        let looks = std::cell::Cell::new(0);
        let found = scanned(&values(), &[vec![0.0; 13], valley()], |at| {
            looks.set(looks.get() + 1);
            let [first, second] = [at.joints[0], at.joints[1]];
            let dent = |x: f64| 50.0 * x * x + 20.0 * (1.0 - (30.0 * x).cos());
            Ok::<_, ()>(dent((first[0] / 1260.0).ln()) + 1e6 * (second[0] / 1000.0).ln().powi(2))
        });
        let (found, better) = found.unwrap();
        assert!((found.joints[0][0] / 1260.0 - 1.0).abs() < 0.03 && better > 1.0, "{found:?} {better}");
        assert!((found.joints[1][0] - 1000.0).abs() < 1e-9);
        // Whole walks along what the cost does not know; one step to each side along what it knows well; and the first look.
        assert_eq!(looks.get(), 1 + 40 + 40 + 12 + 12 + 2 + 2 + 12 + 12);
    }
}
