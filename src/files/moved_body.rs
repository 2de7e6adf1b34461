//! Write and read how a body is built and how it moved, for whoever wants to draw it: solids.csv, sensors.csv and poses.npy.
//!
//! A solid is a part as the body was described. Solids that are fixed to each other are one part in the truth.

use std::path::Path;

use npyz::Order;
use serde::{Deserialize, Serialize};

use super::body::ShapeName;
use super::error::FileError;
use super::npy::{read_matrix, write};
use super::sensor_sites::{read_sites_of_solids, write_sites};
use super::tables::{read_rows, write_rows};
use crate::stages::agent::{Agent, Shape, Site, Vector3};
use crate::stages::simulate::{Pose, Trajectory};

/// Numbers of a pose: the centre (m), then the rotation as a quaternion w, x, y, z.
pub(crate) const NUMBERS: usize = 7;

/// The solids of a body, the sensors on them, and where the solids were.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MovedBody {
    /// The shape of each solid, in its own frame.
    pub shapes: Vec<Shape>,
    /// The sensors; `part` is the solid.
    pub sites: Vec<Site>,
    /// (T + 1) × solids, by time.
    pub poses: Vec<[f32; NUMBERS]>,
}

#[derive(Serialize, Deserialize)]
struct SolidRow {
    solid: usize,
    part: usize,
    shape: ShapeName,
    radius_m: Option<f64>,
    length_m: Option<f64>,
    x_m: Option<f64>,
    y_m: Option<f64>,
    z_m: Option<f64>,
}

impl MovedBody {
    /// A body and how it moved.
    pub(crate) fn of(agent: &Agent, trajectory: &Trajectory) -> Self {
        let pose = |pose: &Pose| {
            let ([x, y, z], [w, i, j, k]) = (pose.position, quaternion(&pose.rotation));
            [x, y, z, w, i, j, k].map(|number| number as f32)
        };
        Self {
            shapes: agent.parts.iter().map(|part| part.shape).collect(),
            sites: agent.sites.clone(),
            poses: trajectory.poses.iter().map(pose).collect(),
        }
    }

    /// Whether a folder has one.
    pub(crate) fn is_in(folder: &Path) -> bool {
        folder.join("poses.npy").is_file()
    }

    /// Writes solids.csv, sensors.csv and poses.npy. `parts` are the true parts of the solids.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub(crate) fn write(&self, folder: &Path, parts: &[usize]) -> Result<(), FileError> {
        let solids = self.shapes.iter().zip(parts).enumerate();
        write_rows(
            &folder.join("solids.csv"),
            solids.map(|(at, (shape, &part))| solid_row(at, part, shape)),
        )?;
        write_sites(&folder.join("sensors.csv"), &self.sites)?;
        let shape = [self.poses.len() / self.shapes.len(), NUMBERS * self.shapes.len()];
        write(&folder.join("poses.npy"), shape, Order::C, self.poses.iter().flatten().copied())
    }

    /// Reads what [`MovedBody::write`] wrote.
    ///
    /// # Errors
    /// If a file is missing, or they do not fit each other.
    pub(crate) fn read(folder: &Path) -> Result<Self, FileError> {
        let [solids, sensors, poses] =
            ["solids.csv", "sensors.csv", "poses.npy"].map(|name| folder.join(name));
        let shape = |(at, row): (usize, SolidRow)| {
            let number = |value: Option<f64>| value.filter(|value| value.is_finite() && *value >= 0.0);
            shape_of(&row, number)
                .filter(|_| row.solid == at)
                .ok_or_else(|| FileError::new(&solids, format!("row {} is not solid number {at}", at + 1)))
        };
        let shapes: Vec<Shape> =
            read_rows(&solids)?.into_iter().enumerate().map(shape).collect::<Result<_, _>>()?;
        let sites = read_sites_of_solids(&sensors)?;
        if let Some(at) = sites.iter().position(|site| site.part >= shapes.len()) {
            let message =
                format!("sensor {at} is on solid {}, but there are {} solids", sites[at].part, shapes.len());
            return Err(FileError::new(&sensors, message));
        }
        let matrix = read_matrix(&poses, Order::C, |value| {
            if value.is_finite() { Ok(value as f32) } else { Err("a pose must be finite numbers") }
        })?;
        if matrix.columns != NUMBERS * shapes.len() {
            let message = format!(
                "has {} columns, but {} solids need {}: {NUMBERS} for each",
                matrix.columns,
                shapes.len(),
                NUMBERS * shapes.len()
            );
            return Err(FileError::new(&poses, message));
        }
        Ok(Self { shapes, sites, poses: matrix.values.as_chunks().0.to_vec() })
    }
}

fn solid_row(solid: usize, part: usize, shape: &Shape) -> SolidRow {
    let none = SolidRow {
        solid,
        part,
        shape: ShapeName::Box,
        radius_m: None,
        length_m: None,
        x_m: None,
        y_m: None,
        z_m: None,
    };
    match *shape {
        Shape::Cylinder { radius, length } => {
            SolidRow { shape: ShapeName::Cylinder, radius_m: Some(radius), length_m: Some(length), ..none }
        }
        Shape::Capsule { radius, length } => {
            SolidRow { shape: ShapeName::Capsule, radius_m: Some(radius), length_m: Some(length), ..none }
        }
        Shape::Sphere { radius } => SolidRow { shape: ShapeName::Sphere, radius_m: Some(radius), ..none },
        Shape::Box { sides: [x, y, z] } => SolidRow { x_m: Some(x), y_m: Some(y), z_m: Some(z), ..none },
    }
}

/// The shape of a row, its numbers checked; `None` if one is missing.
fn shape_of(row: &SolidRow, number: impl Fn(Option<f64>) -> Option<f64>) -> Option<Shape> {
    let radius = || number(row.radius_m);
    let length = || number(row.length_m);
    Some(match row.shape {
        ShapeName::Cylinder => Shape::Cylinder { radius: radius()?, length: length()? },
        ShapeName::Capsule => Shape::Capsule { radius: radius()?, length: length()? },
        ShapeName::Sphere => Shape::Sphere { radius: radius()? },
        ShapeName::Box => Shape::Box { sides: [number(row.x_m)?, number(row.y_m)?, number(row.z_m)?] },
    })
}

/// The quaternion w, x, y, z of a rotation matrix given by rows, with the largest of the four positive.
fn quaternion(rows: &[Vector3; 3]) -> [f64; 4] {
    let [[a, b, c], [d, e, f], [g, h, i]] = *rows;
    // Four times the products of the quaternion's numbers; the row with the largest square loses least by rounding.
    let products = [
        [1.0 + a + e + i, h - f, c - g, d - b],
        [h - f, 1.0 + a - e - i, b + d, c + g],
        [c - g, b + d, 1.0 - a + e - i, f + h],
        [d - b, c + g, f + h, 1.0 - a - e + i],
    ];
    let best = (1..4).fold(0, |best, at| if products[at][at] > products[best][best] { at } else { best });
    let length = products[best].iter().map(|number| number * number).sum::<f64>().sqrt();
    products[best].map(|number| number / length)
}

#[cfg(test)]
mod tests;
