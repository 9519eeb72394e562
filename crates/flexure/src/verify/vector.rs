//! Vectors of three intervals, rotations and unit vectors.

use flexure_core::scalar::{Interval, Scalar};

pub(super) type Vec3 = [Interval; 3];

pub(super) fn dot(a: Vec3, b: Vec3) -> Interval {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn plus(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(super) fn scaled(a: Vec3, by: Interval) -> Vec3 {
    a.map(|entry| entry * by)
}

/// a·a.
pub(super) fn squared(a: Vec3) -> Interval {
    a[0].square() + a[1].square() + a[2].square()
}

pub(super) fn norm(a: Vec3) -> Interval {
    squared(a).sqrt()
}

/// x − (x·e) e: what is across the unit vector e.
pub(super) fn across(x: Vec3, e: Vec3) -> Vec3 {
    plus(x, scaled(e, -dot(x, e)))
}

/// R x, R in rows.
pub(super) fn turned(rows: [Vec3; 3], x: Vec3) -> Vec3 {
    rows.map(|row| dot(row, x))
}

/// Axes and rotations may be off by this much, from rounding.
const DEFECT: f64 = 1e-6;

/// Contains e / |e|; none unless e is nearly of unit length.
pub(super) fn unit(e: Vec3) -> Option<Vec3> {
    // | e / |e| − e | = |1 − |e|| ≤ |1 − |e|²|.
    let defect = (squared(e) - Interval::ONE).magnitude();
    widened(defect).map(|slack| e.map(|entry| entry + slack))
}

/// Contains the rotation nearest to R; none unless R is nearly one.
pub(super) fn rotation(rows: [Vec3; 3]) -> Option<[Vec3; 3]> {
    // With singular values s, the distance to the nearest rotation is |s − 1| ≤ |s² − 1| = |R Rᵀ − 1| (Frobenius), where
    // det R > 0.
    let mut defect = Interval::ZERO;
    for (i, a) in rows.iter().enumerate() {
        for (j, b) in rows.iter().enumerate() {
            defect += if i == j { squared(*a) - Interval::ONE } else { dot(*a, *b) }.square();
        }
    }
    let [a, b, c] = rows;
    let proper = dot(cross(a, b), c).lo() > 0.0;
    let slack = widened(defect.sqrt().hi()).filter(|_| proper)?;
    Some(rows.map(|row| row.map(|entry| entry + slack)))
}

fn widened(defect: f64) -> Option<Interval> {
    if defect <= DEFECT { Interval::new(-defect, defect) } else { None }
}

#[cfg(test)]
mod tests {
    use flexure_core::scalar::Interval;

    use super::{rotation, unit};

    fn point<const N: usize>(numbers: [f64; N]) -> [Interval; N] {
        numbers.map(Interval::point)
    }

    #[test]
    fn rounded_axes_and_rotations_hold_the_exact_one_and_others_are_refused() {
        let third = unit(point([0.577350269, 0.577350269, 0.577350269])).unwrap();
        assert!(third[0].contains(1.0 / 3.0_f64.sqrt()) && third[0].width() < 1e-8);
        assert_eq!(unit(point([0.6, 0.0, 0.0])), None);
        assert_eq!(unit(point([1.00001, 0.0, 0.0])), None);
        let turned =
            |c: f64, s: f64| rotation([point([c, -s, 0.0]), point([s, c, 0.0]), point([0.0, 0.0, 1.0])]);
        let half = turned(0.866025404, 0.5).unwrap();
        assert!(half[0][0].contains(3.0_f64.sqrt() / 2.0) && half[0][0].width() < 1e-8);
        assert!(turned(0.866, 0.5).is_none() && turned(1.0, 0.5).is_none());
        assert!(
            rotation([point([1.0, 0.0, 0.0]), point([0.0, 1.0, 0.0]), point([0.0, 0.0, -1.0])]).is_none()
        );
    }
}
