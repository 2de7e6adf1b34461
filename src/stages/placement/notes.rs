//! Say what a user must know about the places of parts and joints.

use super::place::Placement;

/// Share that a rigid motion of the given sites must explain of what a part feels: otherwise the sites are likely to be wrong.
const EXPLAINED: f64 = 0.9;

impl Placement {
    /// What is to be known about it, a line each. `sensors` are the numbers that a user has for the sensors.
    pub fn notes(&self, sensors: &[usize]) -> Vec<String> {
        let mut notes = Vec::new();
        for part in &self.parts {
            if part.explained < EXPLAINED {
                notes.push(format!(
                "part {}: a rigid motion of the given positions and normals explains {:.0} % of what its sensors feel; are rows in the \
                 order of the sensors, and do all normals point out of the surface?",
                part.part,
                100.0 * part.explained.max(0.0)
            ));
            }
            if !part.left_out.is_empty() {
                let first = sensors[part.left_out[0]];
                notes.push(format!(
                "part {}: {} of its sensors are left out, for they are on another solid than most of it (the first, {first})",
                part.part,
                part.left_out.len()
            ));
            }
        }
        for joint in self.joints.iter().filter(|joint| joint.fit.is_none()) {
            notes.push(format!(
            "parts {} and {}: touch does not tell the place of their joint, since no point has the same speed in both; \
             its place is a guess",
            joint.child, joint.parent
        ));
        }
        notes
    }
}
