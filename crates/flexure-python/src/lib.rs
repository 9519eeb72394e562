//! The module `flexure._flexure`: classes over [`flexure::Robot`], [`flexure::Scenario`] and [`flexure::Loop`], functions for what
//! the command line does. The package around it is in `python/flexure`; docs/python.md is the guide.

#![allow(clippy::needless_pass_by_value, reason = "arguments come from Python as values")]

mod arrays;
mod changes;
mod controller;
mod documents;
mod failure;
mod gains;
mod held;
mod library;
mod logs;
mod own_law;
mod plant;
mod proofs;
mod robot;
mod run;
mod scenario;
mod sweep;
mod watched;

use pyo3::prelude::*;

/// The compiled half of the package.
#[pymodule]
mod _flexure {
    use flexure::processor;
    use pyo3::exceptions::PyImportError;
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::controller::Controller;
    #[pymodule_export]
    use super::failure::{FlexureError, FlexureWarning};
    #[pymodule_export]
    use super::gains::{compare, tune};
    #[pymodule_export]
    use super::held::Loop;
    #[pymodule_export]
    use super::library::{check, import_urdf, registered, reproduce};
    #[pymodule_export]
    use super::logs::{excite, identify, replay};
    #[pymodule_export]
    use super::plant::Plant;
    #[pymodule_export]
    use super::proofs::{certify, margins, verify};
    #[pymodule_export]
    use super::robot::Robot;
    #[pymodule_export]
    use super::run::simulate;
    #[pymodule_export]
    use super::scenario::Scenario;
    #[pymodule_export]
    use super::sweep::Sweep;
    #[pymodule_export]
    use super::watched::panic;

    /// Refuses a processor that lacks what the module was built for.
    #[pymodule_init]
    fn init(_module: &Bound<'_, PyModule>) -> PyResult<()> {
        match processor::lacking() {
            None => Ok(()),
            Some(lacking) => Err(PyImportError::new_err(format!(
                "this processor has no {lacking}, which flexure was built for; build the wheel with RUSTFLAGS=\"-C target-cpu=x86-64\""
            ))),
        }
    }

    /// The version of the package.
    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "its name in Python")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
