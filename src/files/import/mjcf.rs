//! Read MJCF, the description that MuJoCo reads: its nested bodies, their joints and geoms.

mod assets;
mod beside;
mod defaults;
mod geoms;
mod models;

use std::collections::{HashMap, HashSet};

use nalgebra::{Isometry3, Matrix3, Point3};
use roxmltree::{Node, NodeId};

use self::beside::Beside;
use self::geoms::{Found, touches};
use self::models::{Attached, Model, Sources, attached, worlds};
use super::document::Wrong;
use super::inertia::Mass;
use super::known::{MJCF, mjcf_elements, unknown};
use super::located::Located;
use super::placed::{Link, Read, Solid, Turn, settled};
use super::text::SUFFIX;
use super::xml::Element;

/// Elements of bodies that say nothing of parts, joints or shapes.
const BESIDE: [&str; 5] = ["site", "camera", "light", "inertial", "geom"];
/// Most bytes that are attached, and most bodies that are attached within each other.
const MOST_ATTACHED: usize = 64 << 20;
const DEEPEST: usize = 64;

/// A frame, and what holds for all within it.
#[derive(Clone, Copy)]
struct Frame<'a> {
    /// From this frame to the common one.
    pose: Isometry3<f64>,
    /// Class of elements that name none.
    class: Option<&'a str>,
    /// The body that it belongs to; none for the world.
    body: Option<usize>,
    /// The model that its elements are of.
    model: usize,
    /// What is put around their names.
    naming: usize,
}

/// What a body names as its inertia.
struct Inertial {
    /// kg.
    mass: f64,
    /// About the centre of mass, kg m².
    tensor: Matrix3<f64>,
    /// From the frame of the tensor to the common one.
    pose: Isometry3<f64>,
}

/// A geom of a body.
struct Geom<'a> {
    element: Element<'a>,
    frame: Isometry3<f64>,
    model: usize,
}

/// Bodies of a file, as far as they are read.
struct Bodies<'a> {
    models: Vec<Model<'a>>,
    strict: bool,
    notes: Vec<String>,
    beside: Beside,
    links: Vec<Link>,
    /// Those of each body.
    geoms: Vec<Vec<Geom<'a>>>,
    /// The inertia that each body names.
    inertials: Vec<Option<Inertial>>,
    /// What is put before and after the names of what is attached; nothing for the first.
    namings: Vec<[String; 2]>,
    /// The model and naming of all that is attached.
    attached: Vec<(usize, usize)>,
    /// What is being attached now, and how many bytes have been.
    attaching: Vec<(usize, NodeId)>,
    attached_bytes: usize,
    /// Names of bodies that have one.
    taken: HashSet<String>,
    unnamed: usize,
}

/// The bodies of the element `mujoco`, each after the one that carries it. `strict` refuses what a body cannot have, such as bodies
/// that are tied together in addition to the tree.
pub(super) fn links<'a>(root: Node<'a, 'a>, files: &'a Located, strict: bool) -> Result<Read, Wrong> {
    if worlds(root).next().is_none() {
        return Err(
            "has no <worldbody>, in which bodies are; if another file includes or attaches it, give that one"
                .to_owned(),
        );
    }
    let sources = Sources::read(root, files)?;
    let documents = sources.documents()?;
    let models = sources.models(root, files, &documents)?;
    let elements = models.iter().flat_map(|model| mjcf_elements(model.root));
    let notes = Vec::from_iter(unknown(elements, &MJCF, strict)?);
    let named = models.iter().flat_map(|model| worlds(model.root)).flat_map(|world| world.descendants());
    let taken = named.filter(|node| node.has_tag_name("body")).filter_map(|node| node.attribute("name"));
    let mut bodies = Bodies {
        taken: taken.map(str::to_owned).collect(),
        models,
        strict,
        notes,
        beside: Beside::default(),
        links: Vec::new(),
        geoms: Vec::new(),
        inertials: Vec::new(),
        namings: vec![Default::default()],
        attached: vec![(0, 0)],
        attaching: Vec::new(),
        attached_bytes: 0,
        unnamed: 0,
    };
    for world in worlds(bodies.models[0].root) {
        let class = world.attribute("childclass");
        let pose = Isometry3::identity();
        bodies.within(world, Frame { pose, class, body: None, model: 0, naming: 0 })?;
    }
    bodies.finish()
}

impl<'a> Bodies<'a> {
    /// Reads what is within an element that is this frame.
    fn within(&mut self, top: Node<'a, 'a>, frame: Frame<'a>) -> Result<(), Wrong> {
        // Elements come before those within them.
        let mut frames = HashMap::from([(top.id(), frame)]);
        let mut ignored = HashSet::new();
        for node in top.descendants().skip(1).filter(Node::is_element) {
            let parent = node.parent_element().map(|parent| parent.id());
            if parent.is_some_and(|parent| ignored.contains(&parent)) {
                ignored.insert(node.id());
                continue;
            }
            let tag = node.tag_name().name();
            let Some(around) = parent.and_then(|parent| frames.get(&parent).copied()) else {
                if ["body", "geom", "joint", "freejoint", "frame"].contains(&tag) {
                    return Err(Element::new(tag, node)
                        .wrong("is within an element that cannot contain it; move it out"));
                }
                continue;
            };
            let element = Element::new(self.label(tag, around), node);
            if self.beside.has(&element, self.strict)? {
                ignored.insert(node.id());
            } else if tag == "attach" {
                self.attach(&element, node, around)?;
            } else if let Some(frame) = self.read(node, around)? {
                frames.insert(node.id(), frame);
            }
        }
        Ok(())
    }

    /// What messages call an element in this frame.
    fn label(&self, tag: &str, around: Frame) -> String {
        match around.body {
            Some(body) => format!("{tag} of body `{}`", self.links[body].name),
            None => tag.to_owned(),
        }
    }

    /// Reads what an element `attach` in a frame stands for. Its names get the prefix.
    fn attach(&mut self, element: &Element<'a>, node: Node<'a, 'a>, around: Frame<'a>) -> Result<(), Wrong> {
        let Attached { model, tops, is_world, class } = attached(&self.models, around.model, element)?;
        let prefix = element.needed("prefix")?;
        let [before, after] = &self.namings[around.naming];
        let suffix = node.attribute(SUFFIX).unwrap_or_default();
        self.namings.push([format!("{before}{prefix}"), format!("{suffix}{after}")]);
        let naming = self.namings.len() - 1;
        self.attached.push((model, naming));
        if self.attaching.len() == DEEPEST {
            return Err(element.wrong(format!("is more than {DEEPEST} deep within others; write some out")));
        }
        for top in tops {
            let is_around = || model == around.model && node.ancestors().any(|node| node == top);
            if is_around() || self.attaching.contains(&(model, top.id())) {
                return Err(element.wrong("attaches what contains it; remove one of them"));
            }
            self.attached_bytes += top.range().len();
            if self.attached_bytes > MOST_ATTACHED {
                return Err(element.wrong(format!("and others attach more than {MOST_ATTACHED} bytes")));
            }
            self.attaching.push((model, top.id()));
            let frame = Frame { model, naming, class, ..around };
            match if is_world { Some(frame) } else { self.read(top, frame)? } {
                Some(frame) => self.within(top, frame)?,
                None => unreachable!("a body and a frame are frames"),
            }
            self.attaching.pop();
        }
        Ok(())
    }

    /// Reads an element that is in a frame, but not what is within it; gives the frame that it is itself.
    fn read(&mut self, node: Node<'a, 'a>, around: Frame<'a>) -> Result<Option<Frame<'a>>, Wrong> {
        let tag = node.tag_name().name();
        let label = self.label(tag, around);
        let defaults = &self.models[around.model].defaults;
        match (tag, around.body) {
            ("body", parent) => {
                let name = match node.attribute("name") {
                    Some(name) => self.namings[around.naming].join(name),
                    None => self.free_name(),
                };
                let (frame, placed) =
                    self.frame(Element::new(format!("body `{name}`"), node), node, around)?;
                let origin = placed.translation.vector;
                let (turns, solids) = (Vec::new(), Vec::new());
                self.links.push(Link { name, parent, origin, turns, solids, ..Link::default() });
                self.geoms.push(Vec::new());
                self.inertials.push(None);
                Ok(Some(Frame { body: Some(self.links.len() - 1), ..frame }))
            }
            ("frame", _) => self.frame(Element::new(label, node), node, around).map(|(frame, _)| Some(frame)),
            ("geom", Some(body)) => {
                let element = defaults.over(label, node, around.class)?;
                self.geoms[body].push(Geom { element, frame: around.pose, model: around.model });
                Ok(None)
            }
            ("joint" | "freejoint", Some(body)) => {
                let joint = defaults.over(label, node, around.class)?;
                let turn = if tag == "joint" { turn(&joint, &around.pose)? } else { Turn::Other("free") };
                self.links[body].turns.push(turn);
                Ok(None)
            }
            ("inertial", Some(body)) if !defaults.weighs_geoms => {
                self.inertials[body] = Some(self.inertial(&Element::new(label, node), &around)?);
                Ok(None)
            }
            _ if BESIDE.contains(&tag) => Ok(None),
            _ => Err(Element::new(label, node).wrong("is unknown here; check its name and where it is")),
        }
    }

    /// The frame that what is within an element is in, and where the element itself is.
    fn frame(
        &self,
        element: Element<'a>,
        node: Node<'a, 'a>,
        around: Frame<'a>,
    ) -> Result<(Frame<'a>, Isometry3<f64>), Wrong> {
        let defaults = &self.models[around.model].defaults;
        let placed = around.pose * defaults.pose(&element)?;
        let pose = if defaults.is_global { around.pose } else { placed };
        Ok((Frame { pose, class: node.attribute("childclass").or(around.class), ..around }, placed))
    }

    /// A name for a body that has none.
    fn free_name(&mut self) -> String {
        loop {
            self.unnamed += 1;
            let name = format!("body{}", self.unnamed);
            if !self.taken.contains(&name) {
                return name;
            }
        }
    }

    fn inertial(&self, element: &Element, around: &Frame) -> Result<Inertial, Wrong> {
        let pose = around.pose * self.models[around.model].defaults.pose(element)?;
        let tensor = match element.numbers("fullinertia")? {
            Some([xx, yy, zz, xy, xz, yz]) => Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
            None => Matrix3::from_diagonal(&element.numbers("diaginertia")?.unwrap_or_default().into()),
        };
        Ok(Inertial { mass: element.needed_number("mass")?, tensor, pose })
    }

    /// The bodies, with their solids.
    fn finish(mut self) -> Result<Read, Wrong> {
        let geoms = std::mem::take(&mut self.geoms);
        let inertials = std::mem::take(&mut self.inertials);
        for (body, (geoms, inertial)) in geoms.into_iter().zip(inertials).enumerate() {
            let (solids, bare_mass) = self.solids(body, &geoms, inertial.as_ref())?;
            self.links[body].bare_mass = bare_mass;
            self.links[body].named = inertial.and_then(|own| Mass::new(own.mass, own.tensor, &own.pose));
            self.links[body].solids = solids;
        }
        if let Some(total) = self.models[0].defaults.total_mass {
            let solids = || self.links.iter().flat_map(|link| &link.solids);
            let own = solids().map(Solid::own_mass).sum::<f64>()
                + self.links.iter().map(|link| link.bare_mass).sum::<f64>();
            for link in &mut self.links {
                link.bare_mass *= total / own;
                link.named = link.named.map(|named| named.times(total / own));
                link.solids.iter_mut().for_each(|solid| solid.mass = Some(solid.own_mass() * total / own));
            }
        }
        let known: HashSet<&str> = self.links.iter().map(|link| &*link.name).collect();
        for (at, (model, naming)) in self.attached.iter().enumerate() {
            let named = |name: &str| {
                let name = self.namings[*naming].join(name);
                (at == 0 || known.contains(&*name)).then_some(name)
            };
            let Model { root, defaults, .. } = &self.models[*model];
            self.beside.of_model(*root, defaults, &named, self.strict)?;
        }
        self.notes.extend(self.beside.notes());
        Ok(Read { links: self.links, notes: self.notes })
    }

    /// What a body consists of, and its mass, kg, if it has no shape.
    fn solids(
        &mut self,
        body: usize,
        geoms: &[Geom<'a>],
        inertial: Option<&Inertial>,
    ) -> Result<(Vec<Solid>, f64), Wrong> {
        let touches = geoms.iter().map(|geom| touches(&geom.element)).collect::<Result<Vec<_>, _>>()?;
        // What touches nothing is a picture, if anything else does.
        let all = !touches.contains(&true);
        let (mut solids, mut mass, mut missing) = (Vec::new(), 0.0, None);
        for (Geom { element, frame, model }, touches) in geoms.iter().zip(touches) {
            let model = &mut self.models[*model];
            // Of a picture nothing counts then.
            if inertial.is_some() && !all && !touches {
                continue;
            }
            let mut solid = match model.solid(element, frame)? {
                Found::Solid(solid) => *solid,
                Found::Absent(file) => {
                    missing = missing.or(Some(file));
                    continue;
                }
                Found::Endless => continue,
            };
            if !model.defaults.weighs(element)? {
                solid.mass = Some(0.0);
            }
            mass += solid.own_mass();
            if all || touches {
                solids.push(solid);
            }
        }
        let mass = inertial.map_or(mass, |inertial| inertial.mass);
        let inertia_box = inertial.and_then(|own| Solid::of_inertia(own.mass, own.tensor, own.pose));
        let label = ["body", &self.links[body].name];
        settled(label, solids, mass, missing.as_deref(), inertia_box, self.strict, &mut self.notes)
    }
}

/// How a joint of a body with this frame turns.
fn turn(joint: &Element, frame: &Isometry3<f64>) -> Result<Turn, Wrong> {
    let anchor = (frame * Point3::from(joint.numbers::<3>("pos")?.unwrap_or_default())).coords;
    Ok(match joint.text("type").unwrap_or("hinge") {
        "hinge" => {
            let axis = joint.numbers::<3>("axis")?.unwrap_or([0.0, 0.0, 1.0]);
            Turn::Hinge { anchor, axis: frame * joint.direction("axis", &axis)?.into_inner() }
        }
        "ball" => Turn::Ball { anchor },
        "slide" => Turn::Other("slide"),
        "free" => Turn::Other("free"),
        other => {
            return Err(joint.wrong(format!("has type `{other}`, which must be hinge, ball, slide or free")));
        }
    })
}

#[cfg(test)]
mod tests;
