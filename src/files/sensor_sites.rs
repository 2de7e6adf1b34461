//! Read and write where sensors are: a row for each, with its position and its outward normal.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::error::FileError;
use super::tables::{read_rows, write_rows};
use crate::stages::agent::Site;

#[derive(Serialize)]
struct Written {
    sensor: usize,
    solid: usize,
    x_m: f64,
    y_m: f64,
    z_m: f64,
    normal_x: f64,
    normal_y: f64,
    normal_z: f64,
}

/// As [`Written`], with the shorter names that people use.
#[derive(Deserialize)]
struct Read {
    sensor: Option<usize>,
    #[serde(alias = "frame")]
    solid: Option<usize>,
    #[serde(alias = "x")]
    x_m: f64,
    #[serde(alias = "y")]
    y_m: f64,
    #[serde(alias = "z")]
    z_m: f64,
    #[serde(alias = "nx")]
    normal_x: f64,
    #[serde(alias = "ny")]
    normal_y: f64,
    #[serde(alias = "nz")]
    normal_z: f64,
}

/// Writes a table `sensor,solid,x_m,y_m,z_m,normal_x,normal_y,normal_z`, positions in the frames of the solids.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write_sites(path: &Path, sites: &[Site]) -> Result<(), FileError> {
    let row = |(sensor, site): (usize, &Site)| {
        let ([x_m, y_m, z_m], [normal_x, normal_y, normal_z]) = (site.position, site.normal);
        Written { sensor, solid: site.part, x_m, y_m, z_m, normal_x, normal_y, normal_z }
    };
    write_rows(path, sites.iter().enumerate().map(row))
}

/// Reads such a table; normals get length 1.
///
/// `sensor` may be missing: then rows are in the order of the sensors. `solid`, or `frame`, may be missing: then all positions are in one
/// frame, of the body at rest, and `part` of each site is 0. Names without a unit (`x`, `nx`) will do, and other columns may follow.
///
/// # Errors
/// If the file cannot be read, a number is missing or not finite, a normal is 0, or sensors are not counted 0, 1, 2, ….
pub fn read_sites(path: &Path) -> Result<Vec<Site>, FileError> {
    sites_of(path, read_rows(path)?)
}

/// Reads a table that [`write_sites`] wrote, in which each sensor has its solid.
pub(crate) fn read_sites_of_solids(path: &Path) -> Result<Vec<Site>, FileError> {
    let rows: Vec<Read> = read_rows(path)?;
    match rows.iter().position(|row| row.solid.is_none()) {
        Some(at) => Err(FileError::new(path, format!("line {}: the sensor has no solid", at + 2))),
        None => sites_of(path, rows),
    }
}

fn sites_of(path: &Path, rows: Vec<Read>) -> Result<Vec<Site>, FileError> {
    let site = |(at, row): (usize, Read)| {
        let wrong = |message: String| Err(FileError::new(path, format!("line {}: {message}", at + 2)));
        if let Some(sensor) = row.sensor.filter(|sensor| *sensor != at) {
            return wrong(format!(
                "sensor {sensor} is where sensor {at} should be; give each sensor one row, in order"
            ));
        }
        let numbers = [
            ("x_m", row.x_m),
            ("y_m", row.y_m),
            ("z_m", row.z_m),
            ("normal_x", row.normal_x),
            ("normal_y", row.normal_y),
            ("normal_z", row.normal_z),
        ];
        if let Some((name, number)) = numbers.iter().find(|(_, number)| !number.is_finite()) {
            return wrong(format!("{name} is {number}, but must be a finite number"));
        }
        let (position, normal) = ([row.x_m, row.y_m, row.z_m], [row.normal_x, row.normal_y, row.normal_z]);
        Site::facing(row.solid.unwrap_or(0), position, normal).map_or_else(
            || wrong(format!("the normal of sensor {at} has no direction; it must point out of the surface")),
            Ok,
        )
    };
    rows.into_iter().enumerate().map(site).collect()
}

#[cfg(test)]
mod tests;
