//! Rotational inertias as a file gives them, and whether a body can have them.

use flexure_core::linalg::Matrix;

use crate::files::quantity;
use crate::files::site::Site;
use crate::files::table::Table;
use crate::linalg::{Leading, eigenvalues};
use crate::robot::links::written::symmetric;

/// What rounding in a file with few digits may take away, relative to the largest principal inertia.
const SLACK: f64 = 1e-9;

/// Inertias smaller than this are nothing [kg m²]: a milligram at a tenth of a millimetre has more.
const DUST: f64 = 1e-15;

/// Reads `inertia` (ixx, ixy, ixz, iyy, iyz, izz) and `inertia_rpy`, the orientation of its axes.
pub(crate) fn read(table: &Table<'_>) -> Option<([f64; 6], [f64; 3])> {
    let names = "ixx, ixy, ixz, iyy, iyz, izz";
    let six = table.array("inertia", &quantity::BODY_INERTIA, names);
    let rpy = table.array_or("inertia_rpy", &quantity::ORIENTATION, "roll, pitch, yaw");
    let (six, rpy) = (six?, rpy?);
    check(&table.get("inertia")?.site, six)?;
    Some((six, rpy))
}

/// Notes an error if no body has the inertia (ixx, ixy, ixz, iyy, iyz, izz), and a warning if no body made of matter has
/// it.
pub(crate) fn check(site: &Site<'_>, six: [f64; 6]) -> Option<()> {
    let [a, b, c] = principal(&symmetric(six));
    let listed = format!("principal inertias {a:.3e}, {b:.3e}, {c:.3e} kg m^2");
    if a < -SLACK * c.abs() - DUST {
        let message = format!("{} is indefinite: {listed}, must be >= 0", site.path);
        site.error(
            "inertia",
            message,
            "the order is ixx, ixy, ixz, iyy, iyz, izz; check the signs of the products",
        );
        return None;
    }
    if a + b < c * (1.0 - SLACK) - DUST {
        let message = format!(
            "{} belongs to no rigid body: {listed}; the largest exceeds the sum of the others",
            site.path
        );
        site.warn("inertia", message, "is it about the centre of mass, as it must be?");
    }
    Some(())
}

/// Principal inertias in ascending order.
fn principal(inertia: &Matrix<f64, 3, 3>) -> [f64; 3] {
    let mut axes = *inertia;
    let mut values = [0.0; 3];
    for (value, found) in values.iter_mut().zip(eigenvalues(Leading::of(&mut axes.0, 3))) {
        *value = found;
    }
    values.sort_by(f64::total_cmp);
    values
}

#[cfg(test)]
mod tests {
    use flexure_core::linalg::Vector;

    use super::super::rigid::Pose;
    use super::{Matrix, principal};

    /// Turning the axes of diag(1, 2, 4) leaves its eigenvalues.
    #[test]
    fn principal_inertias_do_not_depend_on_the_axes() {
        let axes = Pose::new([0.0; 3], [0.4, -1.3, 2.2]).rotation;
        let turned = axes * Matrix::diagonal(&Vector([4.0, 1.0, 2.0])) * axes.transpose();
        for (found, exact) in principal(&turned).into_iter().zip([1.0, 2.0, 4.0]) {
            assert!((found - exact).abs() < 1e-14, "{found} for {exact}"); // 100 flops × ε × 4
        }
        let disc = axes * Matrix::diagonal(&Vector([0.0, 3.0, 0.0])) * axes.transpose();
        for (found, exact) in principal(&disc).into_iter().zip([0.0, 0.0, 3.0]) {
            assert!((found - exact).abs() < 1e-14, "{found} for {exact}");
        }
    }
}
