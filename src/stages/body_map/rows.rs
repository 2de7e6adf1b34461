//! Take the rows of a matrix of distances as descriptions of the sensors, and compute the distances between them.

use std::borrow::Cow;

use super::coordinates::BodyMap;
use super::settings::MapOf;
use super::smacof::euclidean;
use crate::stages::distance::Distances;

/// What is scaled to make a body map: the distances, or those between their rows.
pub fn scaled(distances: &Distances, of: MapOf) -> Cow<'_, Distances> {
    match of {
        MapOf::Distances => Cow::Borrowed(distances),
        MapOf::Rows => Cow::Owned(between_rows(distances)),
    }
}

/// Euclidean distances between the rows of a matrix of distances, M × M, in its unit: two sensors are near to each other
/// where they are at like distances from all sensors.
///
/// A program that hands a matrix of distances to scikit-learn's `MDS` without `dissimilarity="precomputed"` maps these.
fn between_rows(distances: &Distances) -> Distances {
    let sensors = distances.sensors;
    let rows = BodyMap { dims: sensors, coordinates: distances.values.clone() };
    Distances { sensors, values: euclidean(&rows) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_compared_entry_by_entry() {
        let values = vec![0.0, 3.0, 4.0, 3.0, 0.0, 0.0, 4.0, 0.0, 0.0];
        let found = between_rows(&Distances { sensors: 3, values });
        let expected = [0.0, 34_f64.sqrt(), 41_f64.sqrt(), 34_f64.sqrt(), 0.0, 1.0, 41_f64.sqrt(), 1.0, 0.0];
        assert!(found.values.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
    }
}
