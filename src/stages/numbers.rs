//! The numbers that decide which parts and joints are found.
//!
//! They were chosen on calibration data (docs/estimate.md). `docs/shown/numbers` shows how results change with each.

use serde::Serialize;

/// A number that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NumberError {
    /// There is none of this name.
    #[error("no number is called `{0}`; there are: {names}", names = Numbers::NAMES.join(", "))]
    Unknown(String),
    /// It is not in its range.
    #[error("number `{name}` is {value}, but must be {range}")]
    OutOfRange {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: String,
        /// The values it may have, in words.
        range: &'static str,
    },
}

/// A kind of number: what a value is as one, if it can be, and which values can be.
trait Kind: Sized {
    const RANGE: &str;
    fn of(value: f64) -> Option<Self>;
}

impl Kind for f64 {
    const RANGE: &str = "1e-15 to 1e6";
    fn of(value: f64) -> Option<Self> {
        (1e-15..=1e6).contains(&value).then_some(value)
    }
}

impl Kind for usize {
    const RANGE: &str = "a whole number from 1 to 1000000";
    fn of(value: f64) -> Option<Self> {
        ((1.0..=1e6).contains(&value) && value.fract() == 0.0).then_some(value as Self)
    }
}

/// Declares each number once: what it is, its kind, and its default.
macro_rules! numbers {
    ($($(#[$meaning:meta])+ $name:ident: $kind:ty = $value:expr,)+) => {
        /// The numbers that decide which parts and joints are found, all above 0. The default is what `bodyschema estimate` uses.
        #[derive(Debug, Clone, Copy, PartialEq, Serialize)]
        pub struct Numbers {
            $($(#[$meaning])+ pub $name: $kind,)+
        }

        impl Default for Numbers {
            fn default() -> Self {
                Self { $($name: $value,)+ }
            }
        }

        impl Numbers {
            /// Their names.
            pub const NAMES: &[&str] = &[$(stringify!($name)),+];

            /// Sets the number of this name.
            ///
            /// # Errors
            /// If there is none, or the value is not in its range.
            pub fn set(&mut self, name: &str, value: f64) -> Result<(), NumberError> {
                match name {
                    $(stringify!($name) => {
                        let (name, range) = (stringify!($name), <$kind as Kind>::RANGE);
                        let wrong = || NumberError::OutOfRange { name, value: value.to_string(), range };
                        self.$name = <$kind as Kind>::of(value).ok_or_else(wrong)?;
                    })+
                    _ => return Err(NumberError::Unknown(name.to_owned())),
                }
                Ok(())
            }
        }
    };
}

numbers! {
    /// Samples that are searched, spread over all at which anything is felt.
    samples: usize = 1500,
    /// Ridge of both factors of the completion, as a share of the mean square of a root.
    completion_ridge: f64 = 1e-3,
    /// Weight of a completed root while a motion is learned: so small that it decides only where informative roots do not.
    completed_weight: f64 = 3e-3,
    /// The same in more iterations.
    completed_weight_in_the_end: f64 = 3e-4,
    /// Least affinity of the sensors of a seed cluster, on average.
    min_affinity: f64 = 0.1,
    /// Largest residual variance of a seed cluster, in units of the tolerance.
    max_seed_residual: f64 = 10.0,
    /// The least tolerance of the search, the residual variance that is encoded as noise is: what the iterations leave. A separation, which
    /// iterates longer, goes below.
    min_tolerance: f64 = 3e-4,
    /// The largest tolerance of the search.
    max_tolerance: f64 = 5e-2,
    /// Clusters of highest affinity that a cluster may merge with.
    neighbours: usize = 5,
    /// Nats per sample that a merge must save, and a cluster against two pieces of it.
    min_saving: f64 = 0.3,
    /// Largest residual variance of a part, in units of the tolerance.
    max_residual: f64 = 5.0,
    /// Residual variance, in units of the tolerance, up to which more iterations may explain a cluster. A sensor that is in no cluster may
    /// leave as much, which with noise is more than any residual.
    max_open: f64 = 30.0,
    /// How many times the tolerance the variance of a component is at least.
    min_component: f64 = 20.0,
    /// Degrees of freedom of its residual that a part must have per sample. With fewer, any sensors fit.
    min_freedom: f64 = 1.0,
    /// Residual variance that counts as exact, in the coarse step of a separation.
    coarse_tolerance: f64 = 2e-5,
    /// The same in its fine step.
    fine_tolerance: f64 = 2e-8,
    /// Residual variance up to which the motion of a cluster counts as leaving nothing.
    nothing: f64 = 1e-9,
    /// Below this, the residual of a cluster is an error of the model: the residual variance of the calmer half of the samples, as a share
    /// of that of the other half. Two parts move against each other at most times, and have more.
    uneven: f64 = 0.09,
    /// Variance in slow samples, as a share of that in fast ones, below which an error vanishes with the speed.
    vanishing: f64 = 0.25,
    /// How many times less variance a piece must leave than one motion of all sensors does. Pieces of a rigid part with noise, or with a
    /// small error of the model, leave almost as much as the part.
    sharper: f64 = 30.0,
    /// Residual of a sensor by a part, as a share of that by any other, up to which it is on that part.
    better: f64 = 0.2,
    /// Information, in nats, that the tree must gain by assigning an unassigned cluster.
    min_gain: f64 = 0.025,
    /// Information, in nats, that the tree must gain by merging a small part with another, so that the part is spurious. It must gain as
    /// much again if pieces of it go to several parts instead, for each of these but one: more pieces always gain something.
    spurious: f64 = 0.5,
    /// What is added to the variances of monomials, as a share of their mean: forms of hardly any variance are noise.
    monomial_ridge: f64 = 1e-5,
    /// What is added to the variances of components, as a share of their mean: those of hardly any variance are noise.
    component_ridge: f64 = 1e-3,
    /// Unexplained share of a joint's squared speed below which a joint tells hardly any more.
    negligible: f64 = 1e-3,
    /// Samples at which all that two motions share has half of its weight, beside the speed of their joint.
    half_weight: f64 = 1e4,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_number_can_be_set_within_its_range() {
        for name in Numbers::NAMES {
            let mut numbers = Numbers::default();
            numbers.set(name, 7.0).unwrap();
            assert_eq!(serde_json::to_value(numbers).unwrap()[name].as_f64(), Some(7.0), "{name}");
            for value in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e7] {
                assert!(numbers.set(name, value).is_err(), "{name} = {value}");
            }
        }
        let mut numbers = Numbers::default();
        let error = numbers.set("neighbours", 2.5).unwrap_err().to_string();
        assert_eq!(error, "number `neighbours` is 2.5, but must be a whole number from 1 to 1000000");
        let error = numbers.set("neighbors", 2.0).unwrap_err().to_string();
        assert!(error.starts_with("no number is called `neighbors`; there are: samples, "), "{error}");
        assert_eq!(numbers, Numbers::default());
    }
}
