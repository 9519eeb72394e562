//! Rotational inertias as a file gives them, and whether a body can have them.

use flexure_core::linalg::{Matrix, Vector};

use super::rigid::Pose;
use crate::io::quantity;
use crate::io::site::Site;
use crate::io::table::Table;

/// What rounding in a file with few digits may take away, relative to the largest principal inertia.
const SLACK: f64 = 1e-9;

/// Reads `inertia` (ixx, ixy, ixz, iyy, iyz, izz) with `inertia_rpy`, the orientation of its axes.
pub(super) fn read(table: &Table<'_>) -> Option<Matrix<f64, 3, 3>> {
    let names = "ixx, ixy, ixz, iyy, iyz, izz";
    let six = table.array("inertia", &quantity::BODY_INERTIA, names);
    let rpy = table.array_or("inertia_rpy", &quantity::ORIENTATION, "roll, pitch, yaw");
    checked(&table.get("inertia")?.site, six?, rpy?)
}

/// The inertia (ixx, ixy, ixz, iyy, iyz, izz) in axes turned by `rpy`, unless no body can have it.
pub(in crate::io) fn checked(site: &Site<'_>, six: [f64; 6], rpy: [f64; 3]) -> Option<Matrix<f64, 3, 3>> {
    let [xx, xy, xz, yy, yz, zz] = six;
    let inertia = Matrix([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
    check(site, &inertia)?;
    let axes = Pose::new([0.0; 3], rpy).rotation;
    Some(axes * inertia * axes.transpose())
}

/// Notes an error if no body has this inertia, and a warning if no body made of matter has it.
fn check(site: &Site<'_>, inertia: &Matrix<f64, 3, 3>) -> Option<()> {
    let [a, b, c] = principal(inertia);
    let listed = format!("principal inertias {a:.3e}, {b:.3e}, {c:.3e} kg m^2");
    if a < -SLACK * c.abs() {
        let message = format!("{} is indefinite: {listed}, must be >= 0", site.path);
        site.error(
            "inertia",
            message,
            "the order is ixx, ixy, ixz, iyy, iyz, izz; check the signs of the products",
        );
        return None;
    }
    if a + b < c * (1.0 - SLACK) {
        let message = format!(
            "{} belongs to no rigid body: {listed}; the largest exceeds the sum of the others",
            site.path
        );
        site.warn("inertia", message, "is it about the centre of mass, as it must be?");
    }
    Some(())
}

/// Eigenvalues in ascending order, by the trigonometric formula.
fn principal(inertia: &Matrix<f64, 3, 3>) -> [f64; 3] {
    let scale = inertia.0.iter().flatten().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    if scale == 0.0 {
        return [0.0; 3];
    }
    let a = inertia.scaled(scale.recip());
    let mean = (a[(0, 0)] + a[(1, 1)] + a[(2, 2)]) / 3.0;
    let deviator: Matrix<f64, 3, 3> = Matrix::from_fn(|i, j| a[(i, j)] - if i == j { mean } else { 0.0 });
    let spread = (deviator.0.iter().flatten().map(|x| x * x).sum::<f64>() / 6.0).sqrt();
    if spread < 1e-150 {
        return [mean * scale; 3];
    }
    let d = deviator.scaled(spread.recip());
    let [x, y, z] = [0, 1, 2].map(|i| d.row(i));
    let half_determinant = 0.5 * x.dot(&cross(&y, &z));
    let angle = half_determinant.clamp(-1.0, 1.0).acos() / 3.0;
    let third = std::f64::consts::TAU / 3.0;
    let mut values =
        [angle, angle + third, angle - third].map(|phi| scale * (mean + 2.0 * spread * phi.cos()));
    values.sort_by(f64::total_cmp);
    values
}

fn cross(a: &Vector<f64, 3>, b: &Vector<f64, 3>) -> Vector<f64, 3> {
    Vector([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
}

#[cfg(test)]
mod tests {
    use super::{Matrix, Pose, Vector, principal};

    /// Turning the axes of diag(1, 2, 4) leaves its eigenvalues.
    #[test]
    fn principal_inertias_do_not_depend_on_the_axes() {
        let axes = Pose::new([0.0; 3], [0.4, -1.3, 2.2]).rotation;
        let turned = axes * Matrix::diagonal(&Vector([4.0, 1.0, 2.0])) * axes.transpose();
        for (found, exact) in principal(&turned).into_iter().zip([1.0, 2.0, 4.0]) {
            assert!((found - exact).abs() < 1e-14, "{found} for {exact}"); // 100 flops × ε × 4
        }
        assert!(principal(&Matrix::identity()).iter().all(|value| (value - 1.0).abs() < 1e-15));
    }
}
