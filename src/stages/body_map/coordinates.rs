//! Hold the coordinates of the sensors on a body map.

/// Coordinates of n points (sensors) in d dimensions.
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

    /// The first d of its dimensions.
    ///
    /// # Panics
    /// If it has fewer.
    pub fn first(&self, dims: usize) -> Self {
        let rows = self.coordinates.chunks_exact(self.dims);
        Self { dims, coordinates: rows.flat_map(|row| &row[..dims]).copied().collect() }
    }
}
