//! Simplify a fine mesh for a picture, by clustering its corners (Rossignac and Borrel 1993).

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::Vector3 as Column;

/// Triangles up to which a mesh is drawn as it is.
const FINE: usize = 4000;
/// Cells along the longest side of a mesh. All corners in a cell become one.
const CELLS: f64 = 32.0;

/// The place of a cell.
type Cell = [i64; 3];

/// These triangles, or fewer that look alike.
pub(super) fn simplified(triangles: &[[Column<f64>; 3]]) -> Vec<[Column<f64>; 3]> {
    if triangles.len() <= FINE {
        return triangles.to_vec();
    }
    let corners = || triangles.iter().flatten();
    let (mut low, mut high) = (triangles[0][0], triangles[0][0]);
    corners().for_each(|corner| (low, high) = (low.inf(corner), high.sup(corner)));
    let side = (high - low).max() / CELLS;
    let cell = |corner: &Column<f64>| -> Cell { ((corner - low) / side).map(|at| at.floor() as i64).into() };
    let mut sums: BTreeMap<Cell, (Column<f64>, f64)> = BTreeMap::new();
    for corner in corners() {
        let (sum, count) = sums.entry(cell(corner)).or_insert((Column::zeros(), 0.0));
        *sum += corner;
        *count += 1.0;
    }
    let mut kept: BTreeSet<[Cell; 3]> = BTreeSet::new();
    for cells in triangles.iter().map(|corners| corners.each_ref().map(cell)) {
        if cells[0] != cells[1] && cells[1] != cells[2] && cells[2] != cells[0] {
            // The smallest first, so that each triangle is there once, and looks to the same side.
            let first = (0..3).min_by_key(|at| cells[*at]).unwrap_or(0);
            kept.insert([cells[first], cells[(first + 1) % 3], cells[(first + 2) % 3]]);
        }
    }
    let middle = |cell: Cell| sums.get(&cell).map_or(low, |(sum, count)| sum / *count);
    kept.into_iter().map(|cells| cells.map(middle)).collect()
}
