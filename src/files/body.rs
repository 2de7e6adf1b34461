//! Read and write the description of a body: a TOML file with a table for each part.
//!
//! All places and directions are in one frame, in the rest pose; `docs/reference.md` explains every key.

mod part;

use std::path::Path;

use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::error::FileError;
use super::whole::{read_text, write_text};
use crate::stages::agent::{Agent, Part, Site, Spot, Vector3};
use crate::stages::distance::MAX_SENSORS;

/// Most parts of a body.
const MAX_PARTS: usize = 256;
/// Density of a part, kg/m³, where the file names none: that of water.
pub(crate) const DENSITY: f64 = 1000.0;

/// A body as its file has it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyFile {
    /// Density of parts without one of their own, kg/m³.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Skin of parts without one of their own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skin: Option<SkinEntry>,
    /// The parts, each after its parent.
    #[serde(default, rename = "part")]
    pub parts: Vec<PartEntry>,
}

/// Sensors on a part: a number, or so many for a square metre.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SkinEntry {
    /// Sensors on each part.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sensors: Option<usize>,
    /// Sensors for a square metre of a part.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub per_area: Option<f64>,
}

impl SkinEntry {
    /// How many sensors it has on an area, m².
    ///
    /// # Errors
    /// If it says so in two ways, or has more than a body may have.
    pub(crate) fn count(self, area: f64) -> Result<usize, Wrong> {
        let count = match self {
            Self { sensors: None, per_area: None } => 0,
            Self { sensors: Some(count), per_area: None } => count,
            Self { sensors: None, per_area: Some(density) } => {
                if !(0.0..=1e9).contains(&density) {
                    return Err(format!(
                        "skin.per_area is {density}, but must be 0 to 1e9 (per square metre)"
                    ));
                }
                (density * area).round() as usize
            }
            Self { .. } => return Err("skin has both sensors and per_area; give one".to_owned()),
        };
        if count > MAX_SENSORS {
            return Err(format!("it has {count} sensors, but a body has at most {MAX_SENSORS}"));
        }
        Ok(count)
    }
}

/// Centre of mass and inertia of a part, where they are not those of its shape.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InertiaEntry {
    /// Centre of mass, m; that of the shape if it is not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub centre: Option<Vector3>,
    /// Moments about the axes of the frame through that centre, kg m²: xx, yy, zz.
    pub moments: Vector3,
    /// The other elements of the tensor, kg m²: xy, xz, yz. They are 0 if they are not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub products: Option<Vector3>,
}

/// What shape a part has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ShapeName {
    /// `from`, `to`, `radius`.
    Cylinder,
    /// `from`, `to` (of its cylinder), `radius`.
    Capsule,
    /// `centre`, `radius`.
    Sphere,
    /// `centre`, `size`, and `quaternion` if it is turned.
    Box,
}

/// How a part is joined to its parent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum JointName {
    /// Two axes.
    Universal,
    /// One axis.
    Hinge,
    /// Every axis.
    Ball,
    /// None.
    Fixed,
}

/// A part and its joint; lengths in m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartEntry {
    /// Its name.
    pub name: String,
    /// Its shape.
    pub shape: ShapeName,
    /// Radius of a cylinder, capsule or sphere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// One end of the axis of a cylinder or capsule.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<Vector3>,
    /// The other end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<Vector3>,
    /// Centre of a sphere or box.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub centre: Option<Vector3>,
    /// Lengths of a box's edges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<Vector3>,
    /// Turn of a box from the axes of the frame: w, x, y, z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quaternion: Option<[f64; 4]>,
    /// Density, kg/m³.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Where its mass is and how hard it is to turn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inertia: Option<InertiaEntry>,
    /// The earlier part that carries it; the first part has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parent: Option<String>,
    /// How it is joined to that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint: Option<JointName>,
    /// Where both meet; `from` if it is not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub anchor: Option<Vector3>,
    /// One axis of a hinge, two of a universal joint; those of the latter are across the part if they are not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axes: Option<Vec<Vector3>>,
    /// Its sensors, spread evenly over its shape.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skin: Option<SkinEntry>,
    /// Its sensors one by one, instead of a skin: x, y, z of the place, m, and of the outward direction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub places: Option<Vec<[f64; 6]>>,
}

/// A body and what its parts are called.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedBody {
    /// The body.
    pub agent: Agent,
    /// The name of each part.
    pub names: Vec<String>,
}

impl NamedBody {
    /// The rigid bodies, in the order of their labels, each by the names of its parts: `a + b` of parts that are fixed.
    pub fn rigid_names(&self) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for (body, name) in self.agent.rigid_bodies().into_iter().zip(&self.names) {
            match names.get_mut(body) {
                Some(all) => *all = format!("{all} + {name}"),
                None => names.push(name.clone()),
            }
        }
        names
    }
}

/// Reads a body.
///
/// # Errors
/// If the file cannot be read, or says something that is no body; the message names the part and what to change.
pub fn read_body(path: &Path) -> Result<NamedBody, FileError> {
    let text = read_text(path)?;
    let file: BodyFile = toml::from_str(&text).map_err(|error| {
        let line = error.span().map_or(0, |span| 1 + text[..span.start].matches('\n').count());
        FileError::new(path, format!("line {line}: {}", error.message()))
    })?;
    check_lengths(&text).and_then(|()| file.body()).map_err(|message| FileError::new(path, message))
}

/// Refuses lists with more numbers than are read.
fn check_lengths(text: &str) -> Result<(), Wrong> {
    let file: Table = toml::from_str(text).expect("it was read before");
    let parts = file.get("part").and_then(Value::as_array).into_iter().flatten();
    for part in parts.filter_map(Value::as_table) {
        let inertia = part.get("inertia").and_then(Value::as_table).into_iter().flatten();
        for (key, value) in part.iter().chain(inertia) {
            let most = match &**key {
                "quaternion" => 4,
                "places" => 6,
                _ => 3,
            };
            let lists = match value.as_array() {
                Some(list) if ["axes", "places"].contains(&&**key) => {
                    list.iter().filter_map(Value::as_array).collect()
                }
                list => Vec::from_iter(list),
            };
            if let Some(list) = lists.iter().find(|list| list.len() > most) {
                let name = part.get("name").and_then(Value::as_str).unwrap_or_default();
                return Err(format!("part `{name}`: {key} has {} numbers, but needs {most}", list.len()));
            }
        }
    }
    Ok(())
}

/// Writes a body, with `remark` in its first lines.
///
/// # Errors
/// If the file cannot be written.
pub fn write_body(path: &Path, remark: &str, file: &BodyFile) -> Result<(), FileError> {
    let remark: String = remark.lines().map(|line| format!("# {line}\n")).collect();
    let text = toml::to_string(file).expect("a body is plain data");
    write_text(path, &format!("{remark}\n{text}"))
}

/// What is wrong with a body.
type Wrong = String;

impl BodyFile {
    /// The body that the file describes.
    ///
    /// # Errors
    /// What is wrong, in one line that names the part.
    pub fn body(&self) -> Result<NamedBody, Wrong> {
        let count = self.parts.len();
        if !(1..=MAX_PARTS).contains(&count) {
            return Err(format!("it has {count} parts ([[part]]), but must have 1 to {MAX_PARTS}"));
        }
        let mut agent = Agent { parts: Vec::new(), joints: Vec::new(), sites: Vec::new() };
        for (at, entry) in self.parts.iter().enumerate() {
            let here = |wrong: Wrong| format!("part `{}`: {wrong}", entry.name);
            if entry.name.trim().is_empty() {
                return Err(format!("part {at} has an empty name"));
            }
            if self.parts[..at].iter().any(|other| other.name == entry.name) {
                return Err(here("another part has this name".to_owned()));
            }
            let part = entry.part(self.density.unwrap_or(DENSITY)).map_err(here)?;
            let spots = self.spots(entry, &part).map_err(here)?;
            agent.sites.extend(spots.into_iter().map(|Spot { position, normal }| Site {
                part: at,
                position,
                normal,
            }));
            if agent.sites.len() > MAX_SENSORS {
                return Err(format!("it has more than {MAX_SENSORS} sensors; lower its skin"));
            }
            agent.joints.extend(entry.joint(at, &self.parts[..at], &part).map_err(here)?);
            agent.parts.push(part);
        }
        if agent.sites.is_empty() {
            return Err("it has no sensors; add for instance skin = { sensors = 40 }".to_owned());
        }
        Ok(NamedBody { agent, names: self.parts.iter().map(|part| part.name.clone()).collect() })
    }

    /// Places of the sensors on a part.
    fn spots(&self, entry: &PartEntry, part: &Part) -> Result<Vec<Spot>, Wrong> {
        if let Some(places) = &entry.places {
            if entry.skin.is_some() {
                return Err("it has both skin and places; give one".to_owned());
            }
            return places.iter().map(|numbers| part::spot(part, numbers)).collect();
        }
        let count = entry.skin.or(self.skin).unwrap_or_default().count(part.shape.area())?;
        Ok(part.shape.spread(count))
    }
}

#[cfg(test)]
mod tests;
