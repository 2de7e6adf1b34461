//! The models of a description: the one that is read and those that it attaches, each with its own units, defaults and meshes.

use std::collections::HashMap;
use std::path::PathBuf;

use roxmltree::{Document, Node};

use super::assets::Assets;
use super::defaults::Defaults;
use crate::files::import::document::{Wrong, parsed};
use crate::files::import::located::Located;
use crate::files::import::text::attached_text;
use crate::files::import::xml::Element;

/// The name of a model that has none.
const UNNAMED: &str = "MuJoCo Model";

/// The file of a model that is attached.
pub(super) struct Source {
    text: String,
    files: Located,
    /// Which models it may attach, by name.
    models: HashMap<String, usize>,
}

/// The files of all models that a description may attach, and which of them it names itself; the description is model 0.
pub(super) struct Sources {
    own: HashMap<String, usize>,
    sources: Vec<Source>,
}

/// A model as it is read.
pub(super) struct Model<'a> {
    pub root: Node<'a, 'a>,
    pub defaults: Defaults<'a>,
    pub assets: Assets<'a>,
    models: &'a HashMap<String, usize>,
}

/// What an element `attach` stands for.
pub(super) struct Attached<'a> {
    pub model: usize,
    /// A body or a frame, or all worlds of the model.
    pub tops: Vec<Node<'a, 'a>>,
    pub is_world: bool,
    /// Class of its elements that name none.
    pub class: Option<&'a str>,
}

impl Sources {
    /// Reads the files that the element `mujoco` and the models themselves name.
    pub(super) fn read(root: Node, files: &Located) -> Result<Self, Wrong> {
        let mut places = HashMap::new();
        let mut sources: Vec<Source> = Vec::new();
        let own = named(root, files, &mut places, &mut sources)?;
        let mut at = 0;
        while at < sources.len() {
            let source = std::mem::take(&mut sources[at].text);
            let models = {
                let document = parsed(&source)?;
                let files = sources[at].files.clone();
                named(document.root_element(), &files, &mut places, &mut sources)?
            };
            (sources[at].text, sources[at].models) = (source, models);
            at += 1;
        }
        Ok(Self { own, sources })
    }

    pub(super) fn documents(&self) -> Result<Vec<Document<'_>>, Wrong> {
        self.sources.iter().map(|source| parsed(&source.text)).collect()
    }

    /// The models, the one that attaches the others first.
    pub(super) fn models<'a>(
        &'a self,
        root: Node<'a, 'a>,
        files: &'a Located,
        documents: &'a [Document<'a>],
    ) -> Result<Vec<Model<'a>>, Wrong> {
        let model = |root: Node<'a, 'a>, files: &'a Located, models: &'a HashMap<String, usize>| {
            let defaults = Defaults::new(root)?;
            Ok(Model { root, assets: Assets::new(root, files, &defaults)?, defaults, models })
        };
        let attached = self
            .sources
            .iter()
            .zip(documents)
            .map(|(source, document)| model(document.root_element(), &source.files, &source.models));
        std::iter::once(model(root, files, &self.own)).chain(attached).collect()
    }
}

/// Which models the element `mujoco` may attach, by name; files that are new are read. None if it attaches nothing.
fn named(
    root: Node,
    files: &Located,
    places: &mut HashMap<PathBuf, usize>,
    sources: &mut Vec<Source>,
) -> Result<HashMap<String, usize>, Wrong> {
    let mut models = HashMap::new();
    if !root.descendants().any(|node| node.has_tag_name("attach")) {
        return Ok(models);
    }
    let assets = root.children().filter(|node| node.has_tag_name("asset"));
    for node in assets.flat_map(|asset| asset.children()).filter(|node| node.has_tag_name("model")) {
        let element = Element::new("model", node);
        let file = element.needed("file")?;
        let path = files.find("", file).map_err(|wrong| element.wrong(wrong))?;
        let path = path.ok_or_else(|| element.wrong(format!("names `{file}`, which is not there")))?;
        let at = match places.get(&path) {
            Some(at) => *at,
            None => {
                let files = files.of(&path);
                let text = attached_text(&path, &files).map_err(|wrong| format!("{file}: {wrong}"))?;
                sources.push(Source { text, files, models: HashMap::new() });
                places.insert(path, sources.len());
                sources.len()
            }
        };
        let name = match node.attribute("name") {
            Some(name) => name.to_owned(),
            None => {
                let document = parsed(&sources[at - 1].text)?;
                document.root_element().attribute("model").unwrap_or(UNNAMED).to_owned()
            }
        };
        models.insert(name, at);
    }
    Ok(models)
}

/// The worlds of the element `mujoco`.
pub(super) fn worlds<'a>(root: Node<'a, 'a>) -> impl Iterator<Item = Node<'a, 'a>> {
    root.children().filter(|node| node.has_tag_name("worldbody"))
}

/// What an element `attach` of a model stands for.
pub(super) fn attached<'a>(
    models: &[Model<'a>],
    own: usize,
    element: &Element<'a>,
) -> Result<Attached<'a>, Wrong> {
    let model = match element.text("model") {
        None => own,
        Some(name) => *models[own].models.get(name).ok_or_else(|| {
            element.wrong(format!("has model `{name}`, which no asset is; add it or correct the name"))
        })?,
    };
    let root = models[model].root;
    let Some(kind) = element.one_of(&["body", "frame"]).filter(|kind| element.text(kind) != Some("")) else {
        if model == own {
            return Err(element.wrong("lacks model, body and frame; name what it attaches"));
        }
        return Ok(Attached { model, tops: worlds(root).collect(), is_world: true, class: None });
    };
    let name = element.needed(kind)?;
    let is_it = |node: &Node| node.has_tag_name(kind) && node.attribute("name") == Some(name);
    let node = worlds(root).flat_map(|world| world.descendants()).find(is_it).ok_or_else(|| {
        element.wrong(format!("has {kind} `{name}`, which its model does not have; correct the name"))
    })?;
    let class = node.ancestors().skip(1).find_map(|node| node.attribute("childclass"));
    Ok(Attached { model, tops: vec![node], is_world: false, class })
}

#[cfg(test)]
mod tests;
