//! The parameters of `estimate`: those that decide which parts and joints are found.
//!
//! They were chosen on calibration data (docs/estimate.md). `reproduce/influence.py` shows how results change with each.

/// A parameter that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ParameterError {
    /// There is none of this name.
    #[error("no parameter is called `{0}`; there are: {names}", names = Parameters::NAMES.join(", "))]
    Unknown(String),
    /// It is not in its range.
    #[error("parameter `{name}` is {value}, but must be {range}")]
    OutOfRange {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: String,
        /// The values it may have, in words.
        range: String,
    },
    /// The tolerances are not in their order.
    #[error(
        "the parameters fine_tolerance, coarse_tolerance, min_tolerance and max_tolerance must rise, but are {0:?}"
    )]
    Order([String; 4]),
}

/// How many times less or more than its default a parameter may be.
const FARTHEST: f64 = 100.0;

/// A kind of number: what a value is as one, if it can be, and which values near a default can be, in words.
trait Kind: Copy {
    fn of(value: f64, default: Self) -> Option<Self>;
    fn range(default: Self) -> String;
}

impl Kind for f64 {
    fn of(value: f64, default: Self) -> Option<Self> {
        (default / FARTHEST..=default * FARTHEST).contains(&value).then_some(value)
    }

    fn range(default: Self) -> String {
        format!("{} to {}", default / FARTHEST, default * FARTHEST)
    }
}

impl Kind for usize {
    fn of(value: f64, default: Self) -> Option<Self> {
        let near = f64::max(1.0, default as f64 / FARTHEST)..=default as f64 * FARTHEST;
        (near.contains(&value) && value.fract() == 0.0).then_some(value as Self)
    }

    fn range(default: Self) -> String {
        let least = f64::max(1.0, default as f64 / FARTHEST);
        format!("a whole number from {least} to {}", default as f64 * FARTHEST)
    }
}

/// Declares each parameter once: what it is, its kind, and its default.
macro_rules! parameters {
    ($($(#[$meaning:meta])+ $name:ident: $kind:ty = $value:expr,)+) => {
        /// The parameters of `estimate`. The default is what `bodyschema estimate` uses.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct Parameters {
            $($(#[$meaning])+ pub(crate) $name: $kind,)+
        }

        impl Default for Parameters {
            fn default() -> Self {
                Self { $($name: $value,)+ }
            }
        }

        impl Parameters {
            /// Their names.
            pub const NAMES: &[&str] = &[$(stringify!($name)),+];

            /// Their values, in the same order.
            #[cfg(test)]
            pub(crate) fn values(&self) -> Vec<f64> {
                vec![$(self.$name as f64),+]
            }

            /// Sets the parameter of this name.
            fn set(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
                match name {
                    $(stringify!($name) => {
                        let wrong = || ParameterError::OutOfRange {
                            name: stringify!($name),
                            value: value.to_string(),
                            range: <$kind as Kind>::range($value),
                        };
                        self.$name = <$kind as Kind>::of(value, $value).ok_or_else(wrong)?;
                    })+
                    _ => return Err(ParameterError::Unknown(name.to_owned())),
                }
                Ok(())
            }
        }
    };
}

parameters! {
    /// Samples that are searched, spread over all at which anything is felt.
    samples: usize = 1500,
    /// Ridge of both factors of the completion, as a share of the mean square of a root.
    completion_ridge: f64 = 1e-3,
    /// Weight of a completed root while a motion is learned: so small that it decides only where informative roots do not.
    completed_weight: f64 = 3e-3,
    /// The same in later iterations.
    late_completed_weight: f64 = 3e-4,
    /// Least affinity of the sensors of a seed cluster, on average.
    min_affinity: f64 = 0.1,
    /// Largest residual variance of a seed cluster, in units of the tolerance.
    max_seed_residual: f64 = 10.0,
    /// Least tolerance of the search. The tolerance is the residual variance that is encoded as noise. The least one is what the iterations
    /// leave in exact data. A separation, which iterates longer, goes below.
    min_tolerance: f64 = 3e-4,
    /// Largest tolerance of the search.
    max_tolerance: f64 = 5e-2,
    /// Clusters of highest affinity that a cluster may merge with.
    neighbours: usize = 5,
    /// Nats per sample that a merge must save, and a cluster against two pieces of it.
    min_saving: f64 = 0.3,
    /// Largest residual variance of a part, in units of the tolerance.
    max_residual: f64 = 5.0,
    /// Residual variance, in units of the tolerance, up to which more iterations may explain a cluster. A sensor that is in no cluster may
    /// leave as much, which with noise is more than any residual.
    max_open_residual: f64 = 30.0,
    /// Least variance of a component, in units of the tolerance.
    min_component: f64 = 20.0,
    /// Degrees of freedom of its residual that a part must have per sample. With fewer, any sensors fit.
    min_freedom: f64 = 1.0,
    /// Residual variance that counts as exact, in the coarse step of a separation.
    coarse_tolerance: f64 = 2e-5,
    /// The same in its fine step.
    fine_tolerance: f64 = 2e-8,
    /// Residual variance up to which the motion of a cluster counts as leaving nothing.
    max_exact_residual: f64 = 1e-9,
    /// Below this, the residual of a cluster is an error of the model: the residual variance of the calmer half of the samples, as a share
    /// of that of the other half. Two parts move against each other at most times, and have more.
    max_calm_share: f64 = 0.09,
    /// Variance in slow samples, as a share of that in fast ones, below which an error vanishes with the speed.
    max_slow_share: f64 = 0.25,
    /// How many times less variance a piece must leave than one motion of all sensors does. Pieces of a rigid part with noise, or with a
    /// small error of the model, leave almost as much as the part.
    min_piece_gain: f64 = 30.0,
    /// Residual of a sensor by a part, as a share of that by any other, up to which it is on that part.
    max_residual_share: f64 = 0.2,
    /// Information, in nats, that the tree must gain by assigning an unassigned cluster. A later move to another part must gain a fifth.
    min_assignment_gain: f64 = 0.025,
    /// Information, in nats, that the tree must gain by merging a small part with another, so that the part is spurious. It must gain as
    /// much again if pieces of it go to several parts instead, for each of these but one: more pieces always gain something.
    min_merge_gain: f64 = 0.5,
    /// What is added to the variances of monomials, as a share of their mean: forms of hardly any variance are noise.
    monomial_ridge: f64 = 1e-5,
    /// What is added to the variances of components, as a share of their mean: those of hardly any variance are noise.
    component_ridge: f64 = 1e-3,
    /// Unexplained share of a joint's squared speed below which a joint tells hardly any more.
    min_unexplained: f64 = 1e-3,
    /// Samples at which all that two motions share has half of its weight, beside the speed of their joint.
    half_weight_samples: f64 = 1e4,
}

impl Parameters {
    /// The defaults, but for those that are changed, by their names.
    ///
    /// # Errors
    /// If there is none of a name, a value is not within a hundredth to a hundred times its default, or tolerances are not in their order.
    pub fn changed<'a>(changes: impl IntoIterator<Item = (&'a str, f64)>) -> Result<Self, ParameterError> {
        let mut parameters = Self::default();
        changes.into_iter().try_for_each(|(name, value)| parameters.set(name, value))?;
        let Self { fine_tolerance, coarse_tolerance, min_tolerance, max_tolerance, .. } = parameters;
        let tolerances = [fine_tolerance, coarse_tolerance, min_tolerance, max_tolerance];
        // Below the least tolerance of the search is a separation.
        let rise = tolerances.windows(2).all(|pair| pair[0] < pair[1]);
        if rise { Ok(parameters) } else { Err(ParameterError::Order(tolerances.map(|one| one.to_string()))) }
    }
}

#[cfg(test)]
mod tests;
