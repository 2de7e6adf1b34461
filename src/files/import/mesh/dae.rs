//! Read COLLADA: the triangles of all geometries that its scene shows, in m.
//!
//! Which axis points up is ignored, as viewers of ROS do. `lookat` and `skew` are refused, since no robot has them.

use std::cell::Cell;
use std::collections::HashMap;

use nalgebra::{Matrix4, Point3, Rotation3, Unit, Vector3 as Column};
use roxmltree::Node;

use super::{MOST_TRIANGLES, look_outward, too_many};
use crate::files::import::document::Wrong;
use crate::files::import::document::parsed;

/// Most nodes within nodes, and most nodes and numbers altogether, however often they are instantiated.
const MOST_DEPTH: usize = 64;
const MOST_READ: usize = 100_000_000;
/// Largest offset of an index among those of a corner.
const MOST_OFFSET: usize = 1000;

/// The elements of a file by their identifiers, and how much of it has been read.
struct Elements<'a>(HashMap<&'a str, Node<'a, 'a>>, Cell<usize>);

/// Reads the triangles.
///
/// # Errors
/// If the text is no COLLADA, or something that it names is not there.
pub(super) fn triangles(text: &str) -> Result<Vec<[Column<f64>; 3]>, Wrong> {
    let document = parsed(text)?;
    let root = document.root_element();
    if !named(&root, "COLLADA") {
        return Err(format!("is no COLLADA: its root is <{}>", root.tag_name().name()));
    }
    let elements = root.descendants().filter_map(|node| Some((node.attribute("id")?, node)));
    let elements = Elements(elements.collect(), Cell::new(0));
    let unit = below(root, "asset").and_then(|asset| below(asset, "unit"));
    let metre = match unit.and_then(|unit| unit.attribute("meter")) {
        Some(text) => {
            text.trim().parse().map_err(|_| format!("has unit meter `{text}`, which must be a number"))?
        }
        None => 1.0,
    };
    let mut triangles = Vec::new();
    let shown = below(root, "scene").and_then(|scene| below(scene, "instance_visual_scene"));
    match shown {
        Some(shown) => {
            let scene = elements.find(shown)?;
            elements.add_nodes(scene, Matrix4::new_scaling(metre), 0, &mut triangles)?;
        }
        None => {
            let all = root.descendants().filter(|node| named(node, "geometry"));
            for geometry in all {
                elements.add_geometry(geometry, &Matrix4::new_scaling(metre), &mut triangles)?;
            }
        }
    }
    Ok(triangles)
}

fn named(node: &Node, tag: &str) -> bool {
    node.is_element() && node.tag_name().name() == tag
}

fn below<'a>(node: Node<'a, 'a>, tag: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|child| named(child, tag))
}

/// Numbers in the text of an element.
fn numbers<T: std::str::FromStr>(node: Node) -> Result<Vec<T>, Wrong> {
    let text = node.text().unwrap_or_default();
    let wrong = |word: &str| format!("has `{word}` in <{}>, which must be a number", node.tag_name().name());
    text.split_ascii_whitespace().map(|word| word.parse().map_err(|_| wrong(word))).collect()
}

fn exactly<const N: usize>(node: Node) -> Result<[f64; N], Wrong> {
    let found: Vec<f64> = numbers(node)?;
    found.try_into().map_err(|_| format!("has <{}> without {N} numbers", node.tag_name().name()))
}

impl<'a> Elements<'a> {
    /// Counts what is read.
    fn count(&self, more: usize) -> Result<(), Wrong> {
        self.1.set(self.1.get() + more);
        if self.1.get() > MOST_READ {
            Err("shows more than can be read; simplify it".to_owned())
        } else {
            Ok(())
        }
    }

    /// What an element refers to, by `url` or `source`.
    fn find(&self, node: Node) -> Result<Node<'a, 'a>, Wrong> {
        let name = node.attribute("url").or(node.attribute("source")).unwrap_or_default();
        let found = self.0.get(name.trim_start_matches('#')).copied();
        found.ok_or_else(|| format!("names `{name}` in <{}>, which is not there", node.tag_name().name()))
    }

    /// Adds what is in a node, and in nodes within it.
    fn add_nodes(
        &self,
        node: Node<'a, 'a>,
        around: Matrix4<f64>,
        depth: usize,
        triangles: &mut Vec<[Column<f64>; 3]>,
    ) -> Result<(), Wrong> {
        if depth > MOST_DEPTH {
            return Err(format!("has more than {MOST_DEPTH} nodes within each other"));
        }
        self.count(1)?;
        let mut pose = around;
        for child in node.children().filter(Node::is_element) {
            match child.tag_name().name() {
                "matrix" => pose *= Matrix4::from_row_slice(&exactly::<16>(child)?),
                "translate" => pose *= Matrix4::new_translation(&exactly(child)?.into()),
                "scale" => pose *= Matrix4::new_nonuniform_scaling(&exactly(child)?.into()),
                "rotate" => {
                    let [x, y, z, degrees] = exactly(child)?;
                    if let Some(axis) = Unit::try_new(Column::new(x, y, z), 1e-12) {
                        pose *= Rotation3::from_axis_angle(&axis, degrees.to_radians()).to_homogeneous();
                    }
                }
                tag @ ("lookat" | "skew") => return Err(format!("has <{tag}>, which is not supported")),
                "node" => self.add_nodes(child, pose, depth + 1, triangles)?,
                "instance_node" => self.add_nodes(self.find(child)?, pose, depth + 1, triangles)?,
                "instance_geometry" => self.add_geometry(self.find(child)?, &pose, triangles)?,
                "instance_controller" => {
                    let skin = below(self.find(child)?, "skin").ok_or("has a controller without <skin>")?;
                    self.add_geometry(self.find(skin)?, &pose, triangles)?;
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Adds the triangles of a geometry in this pose.
    fn add_geometry(
        &self,
        geometry: Node<'a, 'a>,
        pose: &Matrix4<f64>,
        triangles: &mut Vec<[Column<f64>; 3]>,
    ) -> Result<(), Wrong> {
        let Some(mesh) = below(geometry, "mesh") else { return Ok(()) };
        let first = triangles.len();
        for primitive in mesh.children().filter(Node::is_element) {
            let kind = primitive.tag_name().name();
            if !["triangles", "polylist", "polygons", "tristrips", "trifans"].contains(&kind) {
                continue;
            }
            let inputs = || primitive.children().filter(|node| named(node, "input"));
            let offset = |node: &Node| {
                let offset =
                    node.attribute("offset").and_then(|text| text.parse::<usize>().ok()).unwrap_or(0);
                offset.min(MOST_OFFSET)
            };
            let Some(vertex) = inputs().find(|node| node.attribute("semantic") == Some("VERTEX")) else {
                continue;
            };
            let (own, stride) = (offset(&vertex), 1 + inputs().map(|node| offset(&node)).max().unwrap_or(0));
            let places = self.places(vertex)?;
            self.count(places.len())?;
            let corner = |at: usize| {
                let place: &Column<f64> = places.get(at).ok_or("has a triangle without a corner")?;
                Ok::<_, Wrong>(pose.transform_point(&Point3::from(*place)).coords)
            };
            let counts = match below(primitive, "vcount") {
                Some(counts) => numbers::<usize>(counts)?,
                None => Vec::new(),
            };
            for list in primitive.children().filter(|node| named(node, "p")) {
                let all: Vec<usize> = numbers(list)?;
                self.count(all.len())?;
                let corners: Vec<usize> =
                    all.chunks_exact(stride).filter_map(|index| index.get(own).copied()).collect();
                let mut rest = &corners[..];
                let lengths: Vec<usize> = match kind {
                    "triangles" => vec![3; corners.len() / 3],
                    "polylist" => counts.clone(),
                    _ => vec![corners.len()],
                };
                for length in lengths {
                    let (face, others) =
                        rest.split_at_checked(length).ok_or("has fewer corners than it says")?;
                    rest = others;
                    for at in 2..face.len() {
                        let [a, b] = if kind == "tristrips" {
                            // Every other triangle of a strip goes round the other way.
                            if at % 2 == 0 { [at - 2, at - 1] } else { [at - 1, at - 2] }
                        } else {
                            [0, at - 1]
                        };
                        triangles.push([corner(face[a])?, corner(face[b])?, corner(face[at])?]);
                    }
                    if triangles.len() > MOST_TRIANGLES {
                        return Err(too_many());
                    }
                }
            }
        }
        look_outward(&mut triangles[first..], pose);
        Ok(())
    }

    /// The places of the vertices that an input names.
    fn places(&self, input: Node) -> Result<Vec<Column<f64>>, Wrong> {
        let vertices = self.find(input)?;
        let is_position =
            |node: &Node| named(node, "input") && node.attribute("semantic") == Some("POSITION");
        let position = vertices.children().find(is_position).ok_or("has vertices without positions")?;
        let source = self.find(position)?;
        let numbers: Vec<f64> = match below(source, "float_array") {
            Some(array) => numbers(array)?,
            None => return Err("has a source of positions without <float_array>".to_owned()),
        };
        let accessor = below(source, "technique_common").and_then(|common| below(common, "accessor"));
        let stride = accessor.and_then(|node| node.attribute("stride")?.parse().ok()).unwrap_or(3).max(3);
        Ok(numbers.chunks_exact(stride).map(|place| Column::new(place[0], place[1], place[2])).collect())
    }
}
