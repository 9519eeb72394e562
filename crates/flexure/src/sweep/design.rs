//! Which points of the space of parameters are looked at.

use super::parameter::{Parameter, Value};
use super::sobol;
use super::streams::Stream;

/// How points are spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Every combination of the values of all parameters, the last changing first.
    Grid,
    /// Independent and uniform.
    Uniform,
    /// As many parts of each axis as there are points, and one in each part (McKay, Beckman and Conover, 1979).
    LatinHypercube,
    /// Sobol's sequence, scrambled after Owen: the first 2ᵐ points are spread evenly for each m.
    Sobol,
}

/// Their names in files.
pub(super) const KINDS: [(&str, Kind); 4] = [
    ("grid", Kind::Grid),
    ("uniform", Kind::Uniform),
    ("latin-hypercube", Kind::LatinHypercube),
    ("sobol", Kind::Sobol),
];

/// Points, by their indices.
#[derive(Clone, Copy, Debug)]
pub(super) struct Design {
    pub kind: Kind,
    pub points: u64,
    pub seed: u64,
}

impl Design {
    /// The values of `parameters` at a point.
    pub fn point(&self, index: u64, parameters: &[Parameter]) -> Vec<Value> {
        if self.kind == Kind::Grid {
            let mut left = index;
            let mut values: Vec<Value> = parameters
                .iter()
                .rev()
                .map(|parameter| {
                    let count = parameter.count();
                    let number = left % count;
                    left /= count;
                    parameter.on_grid(number)
                })
                .collect();
            values.reverse();
            return values;
        }
        parameters.iter().zip(0..).map(|(parameter, axis)| parameter.along(self.part(index, axis))).collect()
    }

    /// How far along an axis a point is, from [0, 1).
    #[expect(clippy::cast_possible_truncation, reason = "the upper half; and indices are below 2³²")]
    fn part(&self, index: u64, axis: u32) -> f64 {
        let stream = |purpose| Stream { seed: self.seed, purpose };
        let column = u64::from(axis);
        match self.kind {
            Kind::Grid | Kind::Uniform => stream("uniform").unit(index, column),
            Kind::LatinHypercube => {
                let part = stream("latin-hypercube").shuffled(index, self.points, column);
                let within = stream("latin-hypercube, within").unit(index, column);
                ((part as f64 + within) / self.points as f64).min(1.0_f64.next_down())
            }
            Kind::Sobol => {
                let seed = (stream("sobol").bits(0, column) >> 32) as u32;
                sobol::coordinate(index as u32, axis as usize, seed)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::{Design, Kind};
    use crate::sweep::parameter::{Parameter, Value, Values};

    fn axes(points: [u64; 2]) -> Vec<Parameter> {
        let axis = |points| Parameter {
            key: "a".to_owned(),
            values: Values::Between { from: 0.0, to: 1.0, logarithmic: false, points },
            relative: false,
            base: Vec::new(),
        };
        points.map(axis).to_vec()
    }

    fn points(kind: Kind, count: u64) -> Vec<[f64; 2]> {
        let (design, axes) = (Design { kind, points: count, seed: 3 }, axes([3, 2]));
        let number = |value: &Value| if let Value::Number(x) = value { *x } else { f64::NAN };
        (0..count)
            .map(|i| {
                let point = design.point(i, &axes);
                [number(&point[0]), number(&point[1])]
            })
            .collect()
    }

    #[test]
    fn a_grid_has_every_combination_once_the_last_axis_first() {
        let expected = [[0.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 1.0], [1.0, 0.0], [1.0, 1.0]];
        assert_eq!(points(Kind::Grid, 6), expected);
    }

    /// One point in each of n parts of each axis; independent points leave a third of them empty.
    #[test]
    fn a_latin_hypercube_has_one_point_in_each_part() {
        let filled = |kind, axis: usize| {
            let points = points(kind, 200);
            let parts: BTreeSet<String> =
                points.iter().map(|point| format!("{:.0}", (point[axis] * 200.0).floor())).collect();
            parts.len()
        };
        for axis in [0, 1] {
            assert_eq!(filled(Kind::LatinHypercube, axis), 200);
            assert!((100..150).contains(&filled(Kind::Uniform, axis)));
        }
    }

    /// The mean of a smooth function: even points know it better than independent ones by far (the error of the latter is σ/√n).
    #[test]
    fn even_points_integrate_better() {
        let error = |kind| {
            let found = points(kind, 1024);
            let mean = found.iter().map(|[x, y]| x * x + x * y).sum::<f64>() / 1024.0;
            (mean - (1.0 / 3.0 + 0.25)).abs()
        };
        assert!(error(Kind::Sobol) < 1e-3 && error(Kind::Uniform) < 0.05);
        assert!(
            error(Kind::Sobol) < 0.2 * error(Kind::Uniform),
            "{} {}",
            error(Kind::Sobol),
            error(Kind::Uniform)
        );
    }
}
