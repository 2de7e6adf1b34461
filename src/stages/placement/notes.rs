//! Say what a user must know about the places of parts and joints.

use super::place::Placement;

/// Share that a rigid motion of the given sites must explain of what a part feels: otherwise the sites are likely to be wrong.
const EXPLAINED: f64 = 0.9;
/// Extent of the sensors, m, from which on a note asks for their unit.
const LARGE: f64 = 20.0;

impl Placement {
    /// What is to be known about it, a line each. `sensors` are the numbers that a user has for the sensors.
    pub fn notes(&self, sensors: &[usize]) -> Vec<String> {
        let mut notes = Vec::new();
        for part in &self.parts {
            if part.explained < EXPLAINED {
                notes.push(format!(
                "part {}: a rigid motion of the given positions and normals explains {:.0} % of what its sensors feel; are rows in the \
                 order of the sensors, and do all normals point out of the surface, and is the part one part?",
                part.part,
                100.0 * part.explained.max(0.0)
            ));
            }
            if !part.left_out.is_empty() {
                let first = sensors[part.left_out[0]];
                notes.push(format!(
                "part {}: {} of its sensors are left out, for they are in another frame than most of them (the first, {first})",
                part.part,
                part.left_out.len()
            ));
            }
        }
        for joint in self.joints.iter().filter(|joint| joint.standard_error.is_none()) {
            let why = match joint.mismatch {
                None => "their motions are known at too few samples",
                Some(_) => "no point near both has the same speed in both",
            };
            notes.push(format!(
                "parts {} and {}: touch does not tell the place of their joint, since {why}; its place is a guess",
                joint.child, joint.parent
            ));
        }
        let extent = |axis: usize| {
            let along = || self.parts.iter().map(|part| part.solid.centre[axis]);
            along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
        };
        let largest = self.parts.iter().map(|part| part.solid.sides.max()).fold(0.0, f64::max);
        let span = largest + (0..3).map(extent).fold(0.0, f64::max);
        if span > LARGE {
            notes.push(format!(
                "the sensors span {span:.0} m; if positions are in millimetres, give them in m"
            ));
        }
        notes
    }
}
