//! The compiled half of the Python package: each function takes NumPy arrays, runs a stage or the whole estimate, and returns NumPy
//! arrays.
//!
//! `python/bodyschema` has what users see: it checks arguments, and documents what goes in and what comes out. Whatever it hands over
//! wrongly still becomes an exception here, never a panic.

mod arrays;
mod cluster;
mod estimate;
mod placement;
mod run;
mod simulate;
mod stages;

/// The extension module.
#[pyo3::pymodule]
mod _bodyschema {
    use pyo3::prelude::*;
    use pyo3::types::PyModule;

    #[pymodule_export]
    use super::cluster::{cluster, infer};
    #[pymodule_export]
    use super::estimate::{estimate, read_touch, tree};
    #[pymodule_export]
    use super::placement::place;
    #[pymodule_export]
    use super::simulate::{import_body, play, simulate};
    #[pymodule_export]
    use super::stages::{body_map, information_metric, quantise, score};

    #[pymodule_init]
    fn constants(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("REVISION", bodyschema::internals::REVISION)?;
        module.add("SEED", bodyschema::settings::Settings::paper().experiment.seed)?;
        module.add("BODIES", super::simulate::BODIES.map(|(name, _)| name).to_vec())
    }
}
