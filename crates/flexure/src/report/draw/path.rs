//! The way of a point in a plane, in memory that does not grow with how long it moves.

/// Points that are kept, at most.
const MOST: usize = 2000;
/// How far apart points are at first, as a part of the farthest that each coordinate has been from zero.
const APART: f64 = 1.0 / 1024.0;
/// How far apart they are at most: to and fro in steps larger than this a way is noise.
const COARSEST: f64 = 1.0 / 32.0;

/// Points of a way, each so far from the one before that a picture shows it.
#[derive(Clone, Debug)]
pub(crate) struct Path {
    points: Vec<[f64; 2]>,
    last: Option<[f64; 2]>,
    /// Farthest that each coordinate has been from zero.
    farthest: [f64; 2],
    apart: f64,
}

impl Path {
    /// Of nothing yet.
    pub(crate) fn new() -> Self {
        Self { points: Vec::new(), last: None, farthest: [0.0; 2], apart: APART }
    }

    /// Goes on to a point; one that has coordinates which are no numbers ends it.
    pub(crate) fn push(&mut self, point: [f64; 2]) {
        if self.last.is_some_and(|last| !last.iter().all(|x| x.is_finite())) {
            return;
        }
        self.last = Some(point);
        if !point.iter().all(|x| x.is_finite()) {
            return;
        }
        for (farthest, x) in self.farthest.iter_mut().zip(point) {
            *farthest = farthest.max(x.abs());
        }
        if self.points.last().is_none_or(|kept| self.is_far(*kept, point)) {
            self.points.push(point);
        }
        while self.points.len() > MOST {
            let points = std::mem::take(&mut self.points);
            if self.apart < COARSEST {
                self.apart *= 2.0;
                for point in points {
                    if self.points.last().is_none_or(|last| self.is_far(*last, point)) {
                        self.points.push(point);
                    }
                }
            } else {
                // A way to and fro without end: some of it looks like all of it.
                self.points = points.into_iter().step_by(2).collect();
            }
        }
    }

    fn is_far(&self, from: [f64; 2], to: [f64; 2]) -> bool {
        (0..2).any(|i| (to[i] - from[i]).abs() > self.apart * self.farthest[i])
    }

    /// The points, the first and the last one among them.
    pub(crate) fn points(&self) -> Vec<[f64; 2]> {
        let mut points = self.points.clone();
        points.extend(self.last.filter(|last| last.iter().all(|x| x.is_finite())));
        points
    }
}

#[cfg(test)]
mod tests {
    use super::{MOST, Path};

    /// A spiral that comes in, and noise without end: the picture of it is near to every point that there was.
    #[test]
    fn every_point_is_near_to_one_that_is_kept() {
        let mut noise = 1_u64;
        let mut random = move || {
            noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (noise >> 40) as f64 / f64::from(1 << 24) - 0.5
        };
        let spiral = |k: u32| {
            let (angle, radius) = (0.01 * f64::from(k), (-0.002 * f64::from(k)).exp());
            [radius * angle.cos(), 0.1 * radius * angle.sin()]
        };
        let noisy = (0..200_000).map(|_| [random(), 0.1 * random()]);
        // Steps of a smooth way stay far below those between points; noise leaves gaps between two thousand points.
        let ways = [((0..3000).map(spiral).collect::<Vec<_>>(), 1.0 / 256.0), (noisy.collect(), 0.25)];
        for (points, far) in ways {
            let mut path = Path::new();
            for point in &points {
                path.push(*point);
            }
            let kept = path.points();
            assert!(kept.len() <= MOST + 1);
            assert_eq!((kept[0], kept[kept.len() - 1]), (points[0], points[points.len() - 1]));
            for point in points.iter().step_by(97) {
                let near =
                    |kept: &[f64; 2]| (0..2).all(|i| (kept[i] - point[i]).abs() <= far * path.farthest[i]);
                assert!(kept.iter().any(near), "{point:?}");
            }
        }
    }

    #[test]
    fn it_ends_where_numbers_do() {
        let mut path = Path::new();
        for point in [[1.0, 2.0], [f64::NAN, 2.0], [3.0, 4.0]] {
            path.push(point);
        }
        assert_eq!(path.points(), [[1.0, 2.0]]);
        assert!(Path::new().points().is_empty());
    }
}
