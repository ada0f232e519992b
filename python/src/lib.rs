//! The private module `pfaff._pfaff` of the Python package `pfaff`: a binding that contains no
//! mechanics and no texts. Results are arrays, and documents of the library as JSON. The Python
//! layer above this module adds names.
//!
//! | module | content |
//! | --- | --- |
//! | `fault` | errors and panics become exceptions |
//! | `hearing` | Ctrl-C and callbacks during a run |
//! | `control` | the state of a mechanism, and a Python function that controls a run |
//! | `functions` | Python functions as laws of drives and as forces on bodies |
//! | `scene` | the text of a scene, and the results that are computed from it |
//! | `options` | conversion of texts and numbers from Python to options of the library |
//! | `run` | the rows of a run as arrays |
//! | `simulator` | a run that is advanced step by step |
//! | `sweep` | many runs in shards, and their columns |

mod control;
mod fault;
mod functions;
mod hearing;
mod options;
mod run;
mod scene;
mod simulator;
mod sweep;

/// The private module.
#[pyo3::pymodule]
mod _pfaff {
    #[pymodule_export]
    use super::control::Kinematics;
    #[pymodule_export]
    use super::fault::{input_code, panics};
    #[pymodule_export]
    use super::run::Run;
    #[pymodule_export]
    use super::scene::{Scene, explain, nearest, templates};
    #[pymodule_export]
    use super::simulator::Simulator;
    #[pymodule_export]
    use super::sweep::{Sweep, forget_crashed, merge, sweep_columns};

    /// The version of the package.
    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
