//! Make a map of three dimensions where there is none.

use crate::stages::body_map::{BodyMap, ClassicalScaling, MapOf, scaled};
use crate::stages::distance::Distances;

/// The classical map of three dimensions of `count` sensors, of which `mapped` have the distances; the others have no place, and NaN for
/// it. `None` where the distances tell nothing apart, which is no mistake.
pub(crate) fn sketch(distances: &Distances, of: MapOf, mapped: &[usize], count: usize) -> Option<BodyMap> {
    const DIMS: usize = 3;
    if mapped.len() <= DIMS {
        return None;
    }
    let scaling = ClassicalScaling::new(&scaled(distances, of), DIMS);
    let map = scaling.and_then(|scaling| scaling.coordinates(DIMS)).ok()?;
    let mut coordinates = vec![f64::NAN; count * DIMS];
    for (place, &sensor) in map.coordinates.chunks_exact(DIMS).zip(mapped) {
        coordinates[sensor * DIMS..][..DIMS].copy_from_slice(place);
    }
    Some(BodyMap { dims: DIMS, coordinates })
}
