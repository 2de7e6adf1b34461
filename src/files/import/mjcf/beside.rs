//! What a description has beside its tree of rigid bodies, which a body has not: ties, soft bodies and plugins.

use roxmltree::Node;

use super::defaults::Defaults;
use crate::files::import::document::Wrong;
use crate::files::import::notes::names;
use crate::files::import::xml::Element;

/// What is left out, by name.
#[derive(Default)]
pub(super) struct Beside {
    ties: Vec<String>,
    followers: Vec<String>,
    soft: Vec<String>,
    plugins: Vec<String>,
}

impl Beside {
    /// An element of a body that is no part of it, if it is one. With `strict` it is refused.
    ///
    /// A cable is a chain of short rigid bodies only for MuJoCo's sake, as a cloth is a net of points: neither has joints that a
    /// robot moves, nor skin.
    pub(super) fn has(&mut self, element: &Element, strict: bool) -> Result<bool, Wrong> {
        let tag = element.tag();
        let (all, keys, what) = match tag {
            "composite" | "flexcomp" | "flex" => {
                (&mut self.soft, ["name", "prefix"], "is a soft body, and no rigid part")
            }
            "plugin" => (&mut self.plugins, ["plugin", "instance"], "is not supported"),
            _ => return Ok(false),
        };
        if strict {
            return Err(element.wrong(format!("{what}; remove it")));
        }
        all.push(keys.iter().find_map(|key| element.text(key)).unwrap_or(tag).to_owned());
        Ok(true)
    }

    /// The soft bodies and ties of the element `mujoco`. A tie with the world is none: a body floats. Names become those that
    /// `name` gives; it gives none to a body that is not there.
    pub(super) fn of_model<'a>(
        &mut self,
        root: Node<'a, 'a>,
        defaults: &Defaults<'a>,
        name: &dyn Fn(&str) -> Option<String>,
        strict: bool,
    ) -> Result<(), Wrong> {
        let section = |tag: &'static str| {
            root.children().filter(move |node| node.has_tag_name(tag)).flat_map(|node| node.children())
        };
        for node in section("deformable").filter(|node| node.has_tag_name("flex")) {
            self.has(&Element::new("flex", node), strict)?;
        }
        for node in section("equality") {
            let tag = node.tag_name().name();
            if tag == "joint" {
                let element = defaults.over_as("joint in equality".to_owned(), node, "equality")?;
                let follower = node.attribute("joint1").filter(|_| element.text("active") != Some("false"));
                self.followers.extend(follower.map(str::to_owned));
                continue;
            }
            if !["connect", "weld"].contains(&tag) {
                continue;
            }
            let element = defaults.over_as(format!("{tag} in equality"), node, "equality")?;
            let (Some(first), Some(second)) = (node.attribute("body1"), node.attribute("body2")) else {
                continue;
            };
            if element.text("active") == Some("false") || [first, second].contains(&"world") {
                continue;
            }
            let (Some(first), Some(second)) = (name(first), name(second)) else { continue };
            if strict {
                return Err(element.wrong("joins bodies in addition to the tree; remove it"));
            }
            self.ties.push(format!("{first} with {second}"));
        }
        Ok(())
    }

    /// What is left out, in a line each.
    pub(super) fn notes(&self) -> impl Iterator<Item = String> {
        [
            ("ties between bodies beside the tree are left out", &self.ties),
            ("joints that follow others (equality) move by themselves", &self.followers),
            ("soft bodies (composite, flex) are no rigid parts and left out", &self.soft),
            ("plugins of bodies are left out", &self.plugins),
        ]
        .into_iter()
        .filter_map(|(what, all)| Some(format!("{what} {}", names(all.iter().map(String::as_str))?)))
    }
}
