//! The meshes that MJCF names, each read when it is first used.

use std::collections::HashMap;
use std::rc::Rc;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use roxmltree::Node;

use super::defaults::Defaults;
use crate::files::import::document::Wrong;
use crate::files::import::located::Located;
use crate::files::import::mesh::{self, Mesh};
use crate::files::import::notes::absent;
use crate::files::import::xml::Element;

/// The meshes of a description.
pub(super) struct Assets<'a> {
    files: &'a Located,
    folder: &'a str,
    strips_paths: bool,
    elements: HashMap<&'a str, Element<'a>>,
    read: HashMap<&'a str, Rc<Mesh>>,
}

impl<'a> Assets<'a> {
    /// Those of a file.
    pub(super) fn new(
        root: Node<'a, 'a>,
        files: &'a Located,
        defaults: &Defaults<'a>,
    ) -> Result<Self, Wrong> {
        let sections = root.children().filter(|node| node.has_tag_name("asset"));
        let mut elements = HashMap::new();
        for node in sections.flat_map(|section| section.children()).filter(|node| node.has_tag_name("mesh")) {
            // A mesh without a name is called as its file, without folder and ending.
            let stem = |file: &'a str| {
                let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
                name.rsplit_once('.').map_or(name, |(stem, _)| stem)
            };
            if let Some(name) = node.attribute("name").or(node.attribute("file").map(stem)) {
                elements.insert(name, defaults.over(format!("mesh `{name}`"), node, None)?);
            }
        }
        Ok(Self {
            files,
            folder: defaults.mesh_folder,
            strips_paths: defaults.strips_paths,
            elements,
            read: HashMap::new(),
        })
    }

    /// The mesh of a geom in the frame of the geom, or why there is none.
    pub(super) fn mesh(&mut self, geom: &Element<'a>) -> Result<Result<Rc<Mesh>, String>, Wrong> {
        let name = geom.needed("mesh")?;
        if let Some(mesh) = self.read.get(name) {
            return Ok(Ok(mesh.clone()));
        }
        let Some(element) = self.elements.get(name) else {
            return Err(
                geom.wrong(format!("has mesh `{name}`, which no asset is; add it or correct the name"))
            );
        };
        let Some(file) = element.text("file") else {
            return Ok(Err(format!("mesh `{name}` is not in a file")));
        };
        let own = if self.strips_paths { file.rsplit(['/', '\\']).next().unwrap_or(file) } else { file };
        let Some(path) = self.files.find(self.folder, own).map_err(|wrong| element.wrong(wrong))? else {
            return Ok(Err(absent(file)));
        };
        let scale = element.numbers("scale")?.unwrap_or([1.0; 3]);
        let shift = Vector3::from(element.numbers("refpos")?.unwrap_or_default());
        let [w, x, y, z] = element.numbers("refquat")?.unwrap_or([1.0, 0.0, 0.0, 0.0]);
        let turn = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-9).unwrap_or_default();
        let mesh = mesh::read(&path)
            .and_then(|mesh| mesh.moved(|corner| turn.inverse() * (corner - shift)).scaled(scale))
            .map_err(|wrong| element.wrong(format!("cannot be read: {wrong}")))?;
        let mesh = Rc::new(mesh);
        self.read.insert(name, mesh.clone());
        Ok(Ok(mesh))
    }
}
