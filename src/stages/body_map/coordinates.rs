//! Hold the coordinates of the sensors on a body map.

/// Coordinates of n points (sensors) in d dimensions, in the unit of the distances: bits.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyMap {
    /// d.
    pub dims: usize,
    /// n × d, by rows.
    pub coordinates: Vec<f64>,
}

impl BodyMap {
    /// n.
    pub fn points(&self) -> usize {
        self.coordinates.len() / self.dims
    }

    /// The map of its first `dims` dimensions.
    ///
    /// # Panics
    /// If the map has fewer dimensions.
    pub fn first(&self, dims: usize) -> Self {
        let rows = self.coordinates.chunks_exact(self.dims);
        Self { dims, coordinates: rows.flat_map(|row| &row[..dims]).copied().collect() }
    }
}
