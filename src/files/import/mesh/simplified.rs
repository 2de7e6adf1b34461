//! Simplify a fine mesh for a picture, by clustering its corners (Rossignac and Borrel 1993).

use nalgebra::Vector3 as Column;

/// Triangles up to which a mesh is drawn as it is.
const FINE: usize = 4000;
/// Cells along the longest side of a mesh; the last corners are in one more. All corners in a cell become one.
const CELLS: usize = 32;
const EDGE: usize = CELLS + 1;

/// These triangles, or fewer that look alike.
pub(super) fn simplified(triangles: &[[Column<f64>; 3]]) -> Vec<[Column<f64>; 3]> {
    if triangles.len() <= FINE {
        return triangles.to_vec();
    }
    let corners = || triangles.iter().flatten();
    let (mut low, mut high) = (triangles[0][0], triangles[0][0]);
    corners().for_each(|corner| (low, high) = (low.inf(corner), high.sup(corner)));
    let side = (high - low).max() / CELLS as f64;
    let cell = |corner: &Column<f64>| {
        ((corner - low) / side).iter().fold(0, |cell, at| cell * EDGE + (*at as usize).min(CELLS))
    };
    let mut sums = vec![(Column::zeros(), 0.0); EDGE.pow(3)];
    for corner in corners() {
        let (sum, count) = &mut sums[cell(corner)];
        *sum += corner;
        *count += 1.0;
    }
    let cells = triangles.iter().map(|corners| corners.each_ref().map(cell));
    let mut kept: Vec<[usize; 3]> = cells
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .map(|cells| {
            // The smallest first, so that each triangle is there once, and looks to the same side.
            let first = (0..3).min_by_key(|at| cells[*at]).unwrap_or(0);
            [cells[first], cells[(first + 1) % 3], cells[(first + 2) % 3]]
        })
        .collect();
    kept.sort_unstable();
    kept.dedup();
    let middle = |cell: usize| sums[cell].0 / sums[cell].1;
    kept.into_iter().map(|cells| cells.map(middle)).collect()
}
