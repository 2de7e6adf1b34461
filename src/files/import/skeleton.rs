//! Make a body of a recorded skeleton: each bone is a capsule from its joint to the next one.

use nalgebra::{Isometry3, Translation3, UnitVector3, Vector3 as Column};

use super::document::Wrong;
use super::joined::{Joined, joined};
use super::notes::names;
use super::options::{Imported, MIN_LENGTH, Options};
use super::placed::{Link, Solid, Turn, z_to};
use super::units::{longest_way, unit};
use crate::files::body::{BodyFile, SkinEntry};
use crate::numerics::range::is_moderate;
use crate::stages::agent::Shape;
use crate::stages::simulate::recorded::{Channel, RecordedMovement};

/// Radius of a capsule over the length of its bone.
const RADIUS: f64 = 0.15;
/// Length of a bone below which it is none, m.
const NO_LENGTH: f64 = 0.01;

/// Joints that do not move against each other, the one that carries all others first.
struct Group {
    joints: Vec<usize>,
    /// The first of them that has a bone.
    lead: Option<usize>,
    /// The group that carries it; none of the first.
    parent: Option<usize>,
}

/// A skeleton in metres.
struct Skeleton<'a> {
    movement: &'a RecordedMovement,
    /// Where each joint is at rest, m, from that of the first part.
    places: Vec<Column<f64>>,
    /// Where the bones of each joint lead, from it, m.
    bones: Vec<Vec<Column<f64>>>,
    /// Whether each joint travels on what carries it.
    travels: Vec<bool>,
    groups: Vec<Group>,
    /// The group of each joint.
    group_of: Vec<usize>,
    notes: Vec<String>,
}

/// The body of capsules of a recorded skeleton, with skin on all bones that are long enough.
///
/// # Errors
/// If it has no bones, or is several bodies, or none that a body may be: the message says what is wrong and what to do.
pub fn body_of_skeleton(movement: &RecordedMovement, options: &Options) -> Result<Imported, Wrong> {
    let [asked_scale, asked_length] = ["scale", "min-length"].map(|name| options.front_end.name(name));
    let min_length = options.min_length.unwrap_or(MIN_LENGTH);
    for (asked, length) in [(&asked_scale, options.scale), (&asked_length, Some(min_length))] {
        if let Some(length) = length.filter(|length| !is_moderate(*length)) {
            return Err(format!("{asked} is {length}, but must be 0.000001 to 1000000 (m)"));
        }
    }
    let (scale, note) = match options.scale {
        Some(scale) => (scale, None),
        None => {
            let way = longest_way(movement);
            let (scale, name) = unit(way);
            let note = format!(
                "the file names no unit: its bones span {way:.4} units at most, so {name} were assumed, which makes {:.2} m; \
                 otherwise give the length of a unit in m with {asked_scale}",
                way * scale
            );
            (scale, Some(note))
        }
    };
    let mut skeleton = Skeleton::new(movement, scale);
    skeleton.notes.extend(note);
    let links = skeleton.links(&asked_scale)?;
    let Joined { mut parts, surfaces, notes } = joined("joint", links, options)?;
    let mut bare = 0;
    for part in &mut parts {
        let [from, to] = [part.from, part.to].map(|end| Column::from(end.unwrap_or_default()));
        if (to - from).norm() < min_length {
            part.skin = Some(SkinEntry { sensors: Some(0), per_area: None });
            bare += 1;
        }
    }
    if bare == parts.len() {
        return Err(format!(
            "no bone is as long as {min_length} m, from which on bones carry skin; lower {asked_length}, or check {asked_scale}"
        ));
    }
    skeleton.notes.extend(notes);
    if bare > 0 {
        skeleton.notes.push(format!(
            "bones shorter than {min_length} m carry no skin, unless {asked_length} says so ({bare} of {})",
            parts.len()
        ));
    }
    let file = BodyFile { density: None, skin: Some(options.skin), parts };
    file.body()?;
    Ok(Imported { file, notes: skeleton.notes, surfaces })
}

impl<'a> Skeleton<'a> {
    fn new(movement: &'a RecordedMovement, scale: f64) -> Self {
        let joints = movement.joints();
        let places = movement.rest().into_iter().map(|place| scale * place).collect();
        let mut bones: Vec<Vec<Column<f64>>> = joints
            .iter()
            .map(|joint| joint.ends.iter().map(|end| scale * Column::from(*end)).collect())
            .collect();
        let mut travels = vec![false; joints.len()];
        for (at, joint) in joints.iter().enumerate() {
            match (joint.parent, movement.bone(at)) {
                (Some(parent), Some(bone)) => bones[parent].push(scale * bone),
                (Some(_), None) => travels[at] = true,
                (None, _) => {}
            }
        }
        for bones in &mut bones {
            bones.retain(|bone| bone.norm() >= NO_LENGTH);
        }
        let mut skeleton = Self {
            movement,
            places,
            bones,
            travels,
            groups: Vec::new(),
            group_of: Vec::new(),
            notes: Vec::new(),
        };
        skeleton.find_groups();
        skeleton
    }

    fn name(&self, joint: usize) -> &'a str {
        &self.movement.joints()[joint].name
    }

    fn find_groups(&mut self) {
        for (at, joint) in self.movement.joints().iter().enumerate() {
            let turns = joint.channels.iter().any(|channel| matches!(channel, Channel::Rotation(_)));
            let on = joint.parent.map(|parent| self.group_of[parent]);
            let group = match on.filter(|_| !turns && !self.travels[at]) {
                Some(group) => group,
                None => {
                    self.groups.push(Group { joints: Vec::new(), lead: None, parent: on });
                    self.groups.len() - 1
                }
            };
            self.group_of.push(group);
            self.groups[group].joints.push(at);
            if !self.bones[at].is_empty() {
                self.groups[group].lead.get_or_insert(at);
            }
        }
    }

    /// The joints that have bones, each after the one that carries it. A joint without bones is passed over: what it carries is carried by
    /// the next joint with bones towards the root, or by the first joint with bones if there is none. Messages call the scale `asked_scale`.
    fn links(&mut self, asked_scale: &str) -> Result<Vec<Link>, Wrong> {
        let mut links: Vec<Link> = Vec::new();
        let mut link_of: Vec<Option<usize>> = vec![None; self.places.len()];
        let (mut first, mut on_first) = (None, Vec::new());
        for group in &self.groups {
            let Some(lead) = group.lead else { continue };
            let carrier = self.carrier(group);
            let parent = match (carrier, first) {
                (Some(carrier), _) => Some(carrier),
                (None, None) => {
                    first = Some(lead);
                    None
                }
                (None, Some(first)) => {
                    if let Some(traveller) =
                        [first, lead].into_iter().find(|joint| self.travels_alone(*joint))
                    {
                        return Err(format!(
                            "`{}` and `{}` are two bodies, because `{}` travels by itself; write each into a file of its own",
                            self.name(first),
                            self.name(lead),
                            self.name(traveller)
                        ));
                    }
                    on_first.push(lead);
                    Some(first)
                }
            };
            let turns = parent.map_or_else(Vec::new, |_| self.turns(group, carrier));
            link_of[lead] = Some(links.len());
            links.push(self.link(lead, parent.and_then(|parent| link_of[parent]), turns));
            for &at in group.joints.iter().filter(|&&at| at != lead && !self.bones[at].is_empty()) {
                let on = self
                    .nearest(at, |joint| link_of[joint].is_some())
                    .filter(|on| self.group_of[*on] == self.group_of[at]);
                link_of[at] = Some(links.len());
                links.push(self.link(at, link_of[on.unwrap_or(lead)], Vec::new()));
            }
        }
        let Some(first) = first else {
            return Err(format!(
                "no bone is as long as {NO_LENGTH} m; check the offsets, or give {asked_scale}"
            ));
        };
        let origin = self.places[first];
        for link in &mut links {
            move_link(link, -origin);
        }
        self.note(first, &on_first);
        Ok(links)
    }

    /// The nearest joint on the way from another one to the root for which this holds.
    fn nearest(&self, joint: usize, holds: impl Fn(usize) -> bool) -> Option<usize> {
        self.to_root(joint).skip(1).find(|at| holds(*at))
    }

    /// A joint and those on its way to the root.
    fn to_root(&self, joint: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(joint), |at| self.movement.joints()[*at].parent)
    }

    /// The joint with bones that carries a group: the nearest one, or the first of the nearest group that has one.
    fn carrier(&self, group: &Group) -> Option<usize> {
        let with_lead = |at: &usize| self.groups[*at].parent;
        let carrying =
            std::iter::successors(group.parent, with_lead).find(|at| self.groups[*at].lead.is_some())?;
        let nearest =
            self.nearest(group.joints[0], |at| self.group_of[at] == carrying && !self.bones[at].is_empty());
        nearest.or(self.groups[carrying].lead)
    }

    /// Whether a joint with bones, or one on its way to the root, travels.
    fn travels_alone(&self, joint: usize) -> bool {
        self.to_root(joint).any(|at| self.travels[at])
    }

    /// How a group turns on the joint that carries it. Several joints at one place are a ball joint together.
    fn turns(&self, group: &Group, carrier: Option<usize>) -> Vec<Turn> {
        let joint = group.joints[0];
        let anchor = self.places[group.lead.unwrap_or(joint)];
        let is_direct = carrier.is_some_and(|carrier| group.parent == Some(self.group_of[carrier]));
        let axes: Vec<usize> = self.movement.joints()[joint]
            .channels
            .iter()
            .filter_map(|channel| match channel {
                Channel::Rotation(axis) => Some(*axis),
                Channel::Position(_) => None,
            })
            .collect();
        if !is_direct || self.travels[joint] || axes.len() == 3 {
            return vec![Turn::Ball { anchor }];
        }
        let axis = |axis: usize| Column::from_fn(|row, _| if row == axis { 1.0 } else { 0.0 });
        axes.into_iter().map(|at| Turn::Hinge { anchor, axis: axis(at) }).collect()
    }

    fn link(&self, joint: usize, parent: Option<usize>, turns: Vec<Turn>) -> Link {
        let origin = self.places[joint];
        let solids = self.bones[joint].iter().map(|bone| capsule(origin, *bone)).collect();
        Link { name: self.name(joint).to_owned(), parent, origin, turns, solids, ..Link::default() }
    }

    /// Notes what is not as in the file.
    fn note(&mut self, first: usize, on_first: &[usize]) {
        let joints = self.movement.joints();
        let named = |wanted: &dyn Fn(usize) -> bool| {
            names((0..joints.len()).filter(|at| wanted(*at)).map(|at| self.name(at)))
        };
        let leads = |at: usize| self.groups[self.group_of[at]].joints[0] == at;
        let carries = |at: usize| {
            let is_on = |other: usize| joints[other].parent == Some(at);
            (0..joints.len()).any(is_on)
        };
        let without_bone = |at: usize| self.bones[at].is_empty();
        let mut notes = Vec::new();
        if let Some(names) = named(&|at| !leads(at)) {
            notes.push(format!("joints that do not turn are fixed to what carries them {names}"));
        }
        if let Some(names) = named(&|at| without_bone(at) && carries(at)) {
            notes.push(format!(
                "joints without a bone of {NO_LENGTH} m are no parts; what they carry is joined to what carries them {names}"
            ));
        }
        if let Some(names) = named(&|at| without_bone(at) && !carries(at)) {
            notes.push(format!(
                "joints that end the skeleton without a bone of {NO_LENGTH} m are left out {names}"
            ));
        }
        if let Some(names) = named(&|at| self.travels[at]) {
            notes.push(format!("joints travel on what carries them, so that no bone leads to them {names}"));
        }
        if let Some(names) = names(on_first.iter().map(|at| self.name(*at))) {
            notes.push(format!(
                "`{}` is the first part, and parts that meet it there are joined to it {names}",
                self.name(first)
            ));
        }
        self.notes.extend(notes);
    }
}

/// The capsule of a bone.
fn capsule(from: Column<f64>, bone: Column<f64>) -> Solid {
    let length = bone.norm();
    let turn = z_to(&UnitVector3::new_normalize(bone));
    let pose = Isometry3::from_parts(Translation3::from(from + bone / 2.0), turn);
    Solid::new(Shape::Capsule { radius: RADIUS * length, length }, pose)
}

fn move_link(link: &mut Link, way: Column<f64>) {
    link.origin += way;
    for turn in &mut link.turns {
        match turn {
            Turn::Hinge { anchor, .. } | Turn::Ball { anchor } => *anchor += way,
            Turn::Other(_) => {}
        }
    }
    for solid in &mut link.solids {
        solid.pose.translation.vector += way;
    }
}

#[cfg(test)]
mod tests;
