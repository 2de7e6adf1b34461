//! What the compiler section and the defaults of MJCF say of all other elements.

use std::collections::HashMap;

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use roxmltree::Node;

use crate::files::import::document::Wrong;
use crate::files::import::document::place;
use crate::files::import::placed::z_to;
use crate::files::import::xml::Element;

/// Attributes that turn a frame, of which an element has one.
const TURNS: [&str; 5] = ["quat", "axisangle", "euler", "xyaxes", "zaxis"];

/// How elements of a file are meant.
pub(super) struct Defaults<'a> {
    /// Sections that hold for every element, the last first.
    top: Vec<Node<'a, 'a>>,
    /// Sections of a class, by its name.
    classes: HashMap<&'a str, Node<'a, 'a>>,
    /// Whether places and directions are those of the world, as MuJoCo read them before 2.3.4.
    pub is_global: bool,
    is_in_radians: bool,
    /// Axes of Euler angles in order: small letters turn with the frame, capitals do not.
    euler: &'a str,
    /// Whether masses are those of the geoms alone.
    pub weighs_geoms: bool,
    /// Groups of geoms that have mass.
    groups: [f64; 2],
    /// The mass of all bodies, kg, if it is set.
    pub total_mass: Option<f64>,
    /// Folder of meshes, as the description names it.
    pub mesh_folder: &'a str,
    /// Whether folders in names of files are left out.
    pub strips_paths: bool,
}

impl<'a> Defaults<'a> {
    /// Those of a file.
    pub(super) fn new(root: Node<'a, 'a>) -> Result<Self, Wrong> {
        let mut compiler = root.children().filter(|node| node.has_tag_name("compiler")).collect::<Vec<_>>();
        compiler.reverse();
        let setting = |key: &str| compiler.iter().find_map(|node| node.attribute(key));
        for (key, sound) in [("angle", ["degree", "radian"]), ("coordinate", ["local", "global"])] {
            if let Some(value) = setting(key).filter(|value| !sound.contains(value)) {
                let sound = sound.join(" or ");
                return Err(format!(
                    "compiler has {key} `{value}`, which is not supported; it must be {sound}"
                ));
            }
        }
        let euler = setting("eulerseq").unwrap_or("xyz");
        if euler.len() != 3 || !euler.chars().all(|axis| "xyzXYZ".contains(axis)) {
            return Err(format!(
                "compiler has eulerseq `{euler}`, which must be three of x, y, z, X, Y and Z"
            ));
        }
        let own = compiler.iter().map(|node| Element::new("compiler", *node)).collect::<Vec<_>>();
        fn number<const N: usize>(own: &[Element], key: &str) -> Result<Option<[f64; N]>, Wrong> {
            own.iter().find_map(|compiler| compiler.numbers(key).transpose()).transpose()
        }
        let sections = root.children().filter(|node| node.has_tag_name("default"));
        let mut top: Vec<Node> = sections.collect();
        let mut classes = HashMap::new();
        for section in &top {
            for node in section.descendants().filter(|node| node.has_tag_name("default")) {
                match node.attribute("class") {
                    Some(class) => _ = classes.insert(class, node),
                    None if node == *section => {}
                    None => return Err(format!("{}: default lacks class; add it", place(node))),
                }
            }
        }
        top.reverse();
        Ok(Self {
            top,
            classes,
            is_global: setting("coordinate") == Some("global"),
            is_in_radians: setting("angle") == Some("radian"),
            euler,
            weighs_geoms: setting("inertiafromgeom") == Some("true"),
            groups: number(&own, "inertiagrouprange")?.unwrap_or([0.0, 1e9]),
            total_mass: number::<1>(&own, "settotalmass")?.map(|[mass]| mass).filter(|mass| *mass > 0.0),
            mesh_folder: setting("meshdir").or(setting("assetdir")).unwrap_or(""),
            strips_paths: setting("strippath") == Some("true"),
        })
    }

    /// An element over its defaults: those of its own class or else that of its surroundings, then of the classes around
    /// that one.
    pub(super) fn over(
        &self,
        label: String,
        node: Node<'a, 'a>,
        surroundings: Option<&'a str>,
    ) -> Result<Element<'a>, Wrong> {
        self.over_named(label, node, surroundings, node.tag_name().name())
    }

    /// An element over the defaults that hold for elements of the kind `tag`.
    pub(super) fn over_as(&self, label: String, node: Node<'a, 'a>, tag: &str) -> Result<Element<'a>, Wrong> {
        self.over_named(label, node, None, tag)
    }

    /// Whether a geom has mass.
    pub(super) fn weighs(&self, geom: &Element) -> Result<bool, Wrong> {
        let group = geom.number("group")?.unwrap_or_default();
        Ok((self.groups[0]..=self.groups[1]).contains(&group))
    }

    fn over_named(
        &self,
        label: String,
        node: Node<'a, 'a>,
        surroundings: Option<&'a str>,
        tag: &str,
    ) -> Result<Element<'a>, Wrong> {
        let element = Element::new(label, node);
        let class = node.attribute("class").or(surroundings);
        let own = match class.filter(|&class| class != "main") {
            Some(class) => Some(*self.classes.get(class).ok_or_else(|| {
                element.wrong(format!("has class `{class}`, which no default has; add one or remove it"))
            })?),
            None => None,
        };
        let around = own.into_iter().flat_map(|class| class.ancestors());
        let sections = around.take_while(|node| node.has_tag_name("default")).chain(self.top.iter().copied());
        Ok(element
            .over(sections.flat_map(|section| section.children()).filter(|node| node.has_tag_name(tag))))
    }

    /// From the frame of an element to the one around it.
    pub(super) fn pose(&self, element: &Element) -> Result<Isometry3<f64>, Wrong> {
        let place = element.numbers("pos")?.unwrap_or_default();
        Ok(Isometry3::from_parts(Translation3::from(Vector3::from(place)), self.turn(element)?))
    }

    fn angle(&self, angle: f64) -> f64 {
        if self.is_in_radians { angle } else { angle.to_radians() }
    }

    fn turn(&self, element: &Element) -> Result<UnitQuaternion<f64>, Wrong> {
        let Some(key) = element.one_of(&TURNS) else { return Ok(UnitQuaternion::identity()) };
        Ok(match key {
            "quat" => {
                let [w, x, y, z] = element.needed_numbers(key)?;
                UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-9)
                    .ok_or_else(|| element.wrong("has quat of length 0; give it a rotation: w, x, y, z"))?
            }
            "axisangle" => {
                let [axis @ .., angle] = element.needed_numbers::<4>(key)?;
                UnitQuaternion::from_axis_angle(&element.direction(key, &axis)?, self.angle(angle))
            }
            "euler" => {
                let angles: [f64; 3] = element.needed_numbers(key)?;
                self.euler.chars().zip(angles).fold(UnitQuaternion::identity(), |turned, (letter, angle)| {
                    let axis = match letter.to_ascii_lowercase() {
                        'x' => Vector3::x_axis(),
                        'y' => Vector3::y_axis(),
                        _ => Vector3::z_axis(),
                    };
                    let next = UnitQuaternion::from_axis_angle(&axis, self.angle(angle));
                    if letter.is_ascii_lowercase() { turned * next } else { next * turned }
                })
            }
            "xyaxes" => {
                let axes: [f64; 6] = element.needed_numbers(key)?;
                let (x, y) = (element.direction(key, &axes[..3])?, element.direction(key, &axes[3..])?);
                let across = y.into_inner() - x.into_inner() * x.dot(&y);
                let y = element.direction(key, across.as_slice())?;
                let z = x.cross(&y);
                UnitQuaternion::from_basis_unchecked(&[x.into_inner(), y.into_inner(), z])
            }
            _ => {
                let axis: [f64; 3] = element.needed_numbers(key)?;
                z_to(&element.direction(key, &axis)?)
            }
        })
    }
}
