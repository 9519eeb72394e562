//! Torque from outside on the links, for a while.

use std::f64::consts::PI;

use flexure_core::linalg::Vector;

/// A push on the links.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push<const N: usize> {
    /// Largest torque on each link [N m].
    pub torque: Vector<f64, N>,
    /// Time at which it begins in s.
    pub from: f64,
    /// How long it lasts in s.
    pub duration: f64,
    /// Torque over time between beginning and end.
    pub shape: Shape,
}

/// How a push comes and goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// The whole torque from the first instant to the last.
    Rectangle,
    /// As the first half of a sine.
    HalfSine,
}

impl<const N: usize> Push<N> {
    /// Time at which it ends in s.
    pub fn until(&self) -> f64 {
        self.from + self.duration
    }

    /// Its torque at the time `t` in s [N m].
    pub fn at(&self, t: f64) -> Vector<f64, N> {
        let since = t - self.from;
        let part = match self.shape {
            _ if !(0.0..self.duration).contains(&since) => 0.0,
            Shape::Rectangle => 1.0,
            Shape::HalfSine => (PI * since / self.duration).sin(),
        };
        self.torque.scaled(part)
    }

    /// Its mean torque over `[t, t + interval]` in s [N m], exactly: the impulse is that of the push however time is divided.
    pub fn mean(&self, t: f64, interval: f64) -> Vector<f64, N> {
        let begin = (t - self.from).clamp(0.0, self.duration);
        let end = (t + interval - self.from).clamp(0.0, self.duration);
        let part = match self.shape {
            Shape::Rectangle => end - begin,
            Shape::HalfSine => {
                let angle = |t: f64| PI * t / self.duration;
                self.duration / PI * (angle(begin).cos() - angle(end).cos())
            }
        };
        self.torque.scaled(part / interval)
    }
}

#[cfg(test)]
mod tests {
    use super::{Push, Shape, Vector};

    fn push(shape: Shape) -> Push<1> {
        Push { torque: Vector([3.0]), from: 0.25, duration: 0.5, shape }
    }

    /// Sum of mean × interval over `count` equal parts of one second.
    fn impulse(shape: Shape, count: u32) -> f64 {
        let h = 1.0 / f64::from(count);
        (0..count).map(|k| h * push(shape).mean(h * f64::from(k), h)[0]).sum()
    }

    /// A rectangle's impulse is torque × duration, a half sine's 2/π of that, whatever the division. 1e-13: a hundred additions.
    #[test]
    fn impulses_do_not_depend_on_the_division_of_time() {
        for count in [1, 3, 7, 100] {
            assert!((impulse(Shape::Rectangle, count) - 1.5).abs() < 1e-13);
            assert!((impulse(Shape::HalfSine, count) - 3.0 / std::f64::consts::PI).abs() < 1e-13);
        }
    }

    #[test]
    fn nothing_before_and_nothing_after() {
        for shape in [Shape::Rectangle, Shape::HalfSine] {
            assert_eq!(push(shape).mean(0.0, 0.25), Vector([0.0]));
            assert_eq!(push(shape).mean(0.75, 0.25), Vector([0.0]));
            assert!(push(shape).mean(0.49, 0.02)[0] > 2.9);
        }
    }
}
