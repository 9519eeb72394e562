//! The shaping functions φ by name.

mod coupled_tanh;
mod linear;
mod registry;
mod tanh;

use flexure_core::control::Shaping;
use flexure_core::linalg::Vector;
use flexure_core::scalar::{Over, Scalar};

use crate::files::Entry;

pub use registry::Extra;
use registry::{ShapingKind, shaping};

// One line a shaping function, in the order in which lists show them.
shaping! {
    tanh::Tanh,
    linear::Linear,
    coupled_tanh::CoupledTanh,
}

#[cfg(test)]
mod tests {
    use super::{AnyShaping, Phi, Shaping, Vector};

    /// Every member: built with its starting gains, zero at zero, and contracting towards zero.
    #[test]
    fn every_shaping_function_vanishes_at_zero_and_pulls_back() {
        let gain = Vector([5.0, 2.0, 7.0]);
        for phi in Phi::ALL {
            let name = phi.name();
            // What a reader reads is what is listed: nothing else may be asked for.
            let listed = phi.extra();
            let phi = AnyShaping::new(*phi, 3, gain, &|extra| {
                assert!(listed.iter().any(|known| known.key == extra.key), "{name} asks for {}", extra.key);
                gain.map(extra.start)
            });
            assert_eq!(phi.eval(&Vector([0.0; 3])), Vector([0.0; 3]), "{name}");
            for e in [[0.1, -0.2, 0.3], [2.0, 1.0, -3.0], [-0.5, 0.0, 0.0]] {
                let e = Vector(e);
                assert!(phi.eval(&e).dot(&gain.diag_mul(&e)) > 0.0, "{name} at {e:?}");
            }
        }
    }

    /// Joints that only fill a vector have φ = 0 and leave that of the others as it is, to the bit.
    #[test]
    fn joints_that_are_not_there_change_nothing() {
        let gain = Vector([5.0, 2.0, 7.0]);
        let longer = |v: Vector<f64, 3>, pad| Vector::<f64, 8>::from_fn(|i| if i < 3 { v[i] } else { pad });
        for phi in Phi::ALL {
            let exact = AnyShaping::new(*phi, 3, gain, &|extra| gain.map(extra.start));
            let padded = AnyShaping::new(*phi, 3, longer(gain, 1.0), &|x| longer(gain.map(x.start), 1.0));
            let e = Vector([0.3, -1.2, 0.7]);
            let (short, long) = (exact.eval(&e), padded.eval(&longer(e, 0.0)));
            assert_eq!(long.0.map(f64::to_bits), longer(short, 0.0).0.map(f64::to_bits), "{}", phi.name());
        }
    }
}
