//! Read pressures as a robot has them: from a `.npy` file, or from a `.csv` file with a row for each sample.

use std::path::Path;

use super::error::FileError;
use super::npy::{check_sensors, read_any_tactile};
use crate::stages::sense::Tactile;

/// Reads pressures, T × M: from a `.csv` file if its name ends so, and from a `.npy` file otherwise. They may be of any sign;
/// what is no finite float32 becomes NaN.
///
/// A first row of a `.csv` file that is not all numbers is a header. An empty cell is NaN.
///
/// # Errors
/// If the file cannot be read, or a cell is no number; the message says which.
pub fn read_touch(path: &Path) -> Result<Tactile, FileError> {
    let is_csv = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"));
    if is_csv { read_csv(path) } else { read_any_tactile(path) }
}

fn read_csv(path: &Path) -> Result<Tactile, FileError> {
    let wrong = |message: String| FileError::new(path, message);
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .trim(csv::Trim::All)
        .from_path(path)
        .map_err(|error| wrong(format!("cannot be read: {error}")))?;
    let (mut by_time, mut samples, mut sensors) = (Vec::new(), 0, 0);
    for (at, record) in reader.records().enumerate() {
        let record = record.map_err(|error| wrong(error.to_string()))?;
        let cells: Vec<Option<f32>> = record.iter().map(number).collect();
        if at == 0 {
            sensors = cells.len();
            check_sensors(path, sensors, "many")?;
            if cells.contains(&None) {
                continue;
            }
        }
        if let Some(column) = cells.iter().position(Option::is_none) {
            let cell = record.get(column).unwrap_or_default();
            return Err(wrong(format!("row {}, column {}: `{cell}` is not a number", at + 1, column + 1)));
        }
        by_time.extend(cells.into_iter().flatten());
        samples += 1;
    }
    if samples == 0 {
        return Err(wrong(
            "has no row of numbers; each row must be a sample in time, and each column a sensor".to_owned(),
        ));
    }
    let pressures =
        (0..sensors).flat_map(|sensor| by_time[sensor..].iter().step_by(sensors).copied()).collect();
    Ok(Tactile { samples, pressures })
}

/// A cell, NaN if it is empty or not finite; `None` if it is no number.
fn number(cell: &str) -> Option<f32> {
    if cell.is_empty() {
        return Some(f32::NAN);
    }
    cell.parse().ok().map(|value: f32| if value.is_finite() { value } else { f32::NAN })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Tactile, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("touch.csv");
        std::fs::write(&path, text).unwrap();
        read_touch(&path).map_err(|error| error.to_string())
    }

    #[test]
    fn rows_are_times_and_columns_sensors_with_or_without_a_header() {
        for text in ["a,b\n1,-2\n3,4e1\n5,6\n", "1,-2\n3, 40\n5,6\n"] {
            let tactile = read(text).unwrap();
            assert_eq!((tactile.samples, tactile.pressures), (3, vec![1.0, 3.0, 5.0, -2.0, 40.0, 6.0]));
        }
        let holes = read("1,,nan\n4,5,inf\n").unwrap();
        assert_eq!(holes.pressures[..2], [1.0, 4.0]);
        assert!(holes.pressures[2].is_nan() && holes.pressures[4].is_nan() && holes.pressures[5].is_nan());
    }

    #[test]
    fn what_is_no_table_of_numbers_is_named() {
        for (text, expected) in [
            ("1,2\n3,x\n", "row 2, column 2: `x` is not a number"),
            ("1,2\n3\n", "record 1"),
            ("a,b\n", "no row of numbers"),
            ("", "no row of numbers"),
        ] {
            let message = read(text).unwrap_err();
            assert!(message.contains(expected), "{text:?}: {message}");
        }
    }
}
