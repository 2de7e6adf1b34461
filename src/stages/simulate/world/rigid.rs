//! Rigid bodies of the engine: parts that are fixed to each other are one, so that a step of the engine costs the same for
//! any number of shapes.

use std::mem::MaybeUninit;

use nalgebra::{Matrix3, Vector3 as Column};
use ode_sys as ode;

use super::Pose;
use super::momentum::{Inertia, matrix};
use crate::stages::agent::{Agent, Part, Shape, Vector3};

/// Where a part is on its rigid body.
#[derive(Debug, Clone)]
pub(super) struct Mount {
    /// The rigid body.
    pub body: usize,
    /// Centre of the part and its rotation in the frame of the body, if it is not the body by itself.
    within: Option<(Column<f64>, Matrix3<f64>)>,
}

fn rows(matrix: &Matrix3<f64>) -> [Vector3; 3] {
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| matrix[(row, column)]))
}

impl Mount {
    /// Where the part is if the body is in this pose.
    pub(super) fn pose(&self, body: Pose) -> Pose {
        let Some((centre, turn)) = &self.within else { return body };
        let rotation = matrix(&body.rotation);
        Pose {
            position: (Column::from(body.position) + rotation * centre).into(),
            rotation: rows(&(rotation * turn)),
        }
    }

    /// Linear velocity of the part's centre, m/s, if the body is in this pose and moves so, in the world's frame.
    pub(super) fn velocity(&self, body: &Pose, linear: Vector3, angular: Vector3) -> Vector3 {
        let Some(lever) = self.lever(body) else { return linear };
        (Column::from(linear) + Column::from(angular).cross(&lever)).into()
    }

    /// The torque about the centre of the body, N m, of a force and a torque about the part's centre, in the world's frame.
    pub(super) fn torque(&self, body: &Pose, force: Vector3, torque: Vector3) -> Vector3 {
        let Some(lever) = self.lever(body) else { return torque };
        (Column::from(torque) + lever.cross(&Column::from(force))).into()
    }

    /// From the centre of the body to that of the part, in the world's frame.
    fn lever(&self, body: &Pose) -> Option<Column<f64>> {
        self.within.as_ref().map(|(centre, _)| matrix(&body.rotation) * centre)
    }
}

/// Mass, kg, and inertia of a part as an even solid about its centre, along the axes of its frame, kg m², by rows.
fn mass_of(part: &Part) -> (f64, Matrix3<f64>) {
    const ALONG_Z: i32 = 3;
    let mut mass = MaybeUninit::<ode::dMass>::uninit();
    let at = mass.as_mut_ptr();
    // SAFETY: the mass is written before it is read. Lengths and density are positive, as their ranges make them.
    let mass = unsafe {
        match part.shape {
            Shape::Cylinder { radius, length } => {
                ode::dMassSetCylinder(at, part.density, ALONG_Z, radius, length);
            }
            Shape::Capsule { radius, length } => {
                ode::dMassSetCapsule(at, part.density, ALONG_Z, radius, length);
            }
            Shape::Sphere { radius } => ode::dMassSetSphere(at, part.density, radius),
            Shape::Box { sides: [x, y, z] } => ode::dMassSetBox(at, part.density, x, y, z),
        }
        mass.assume_init()
    };
    (mass.mass, Matrix3::from_fn(|row, column| mass.I[4 * row + column]))
}

/// Makes the rigid bodies of an agent, at rest in its rest pose, with what it takes to move each; and where each part is on them.
///
/// # Safety
/// The world must be live.
pub(super) unsafe fn make_bodies(
    world: ode::dWorldID,
    agent: &Agent,
) -> (Vec<(ode::dBodyID, Inertia)>, Vec<Mount>) {
    let body_of = agent.rigid_bodies();
    let count = body_of.iter().max().map_or(0, |last| last + 1);
    let mut mounts: Vec<Mount> = body_of.iter().map(|&body| Mount { body, within: None }).collect();
    let mut bodies = Vec::with_capacity(count);
    for body in 0..count {
        let members: Vec<usize> = (0..body_of.len()).filter(|part| body_of[*part] == body).collect();
        let lead = &agent.parts[members[0]];
        let (mass, centre, tensor) = match members[..] {
            [_] if lead.inertia.is_none() => {
                let (mass, tensor) = mass_of(lead);
                (mass, Column::from(lead.centre), tensor)
            }
            _ => whole(agent, &members, &mut mounts),
        };
        // SAFETY: the world is live, and the mass positive.
        bodies.push(unsafe { make_body(world, mass, centre, &tensor, &lead.rotation) });
    }
    (bodies, mounts)
}

/// Mass, centre of mass and inertia of parts that are one rigid body. Its frame has the axes of the first part.
fn whole(agent: &Agent, members: &[usize], mounts: &mut [Mount]) -> (f64, Column<f64>, Matrix3<f64>) {
    let part = |at: &usize| &agent.parts[*at];
    let masses: Vec<(f64, Matrix3<f64>)> = members.iter().map(|at| mass_of(part(at))).collect();
    let mass: f64 = masses.iter().map(|(mass, _)| mass).sum();
    let centre_of = |at: &usize| part(at).inertia.map_or(part(at).centre, |own| own.centre);
    let moment = |(at, (mass, _)): (&usize, &(f64, Matrix3<f64>))| *mass * Column::from(centre_of(at));
    let centre = members.iter().zip(&masses).map(moment).sum::<Column<f64>>() / mass;
    let axes = matrix(&part(&members[0]).rotation);
    let mut tensor = Matrix3::zeros();
    for (at, (mass, own)) in members.iter().zip(masses) {
        let place = axes.transpose() * (Column::from(part(at).centre) - centre);
        let turn = axes.transpose() * matrix(&part(at).rotation);
        let (own, off) = match &part(at).inertia {
            None => (turn * own * turn.transpose(), place),
            Some(own) => {
                let off = axes.transpose() * (Column::from(own.centre) - centre);
                (axes.transpose() * matrix(&own.tensor) * axes, off)
            }
        };
        // Huygens and Steiner.
        let apart = Matrix3::from_diagonal_element(off.norm_squared()) - off * off.transpose();
        tensor += own + mass * apart;
        mounts[*at].within = Some((place, turn));
    }
    // Rounding must not make it lopsided, which the engine refuses.
    (mass, centre, (tensor + tensor.transpose()) / 2.0)
}

/// # Safety
/// The world must be live.
unsafe fn make_body(
    world: ode::dWorldID,
    mass: f64,
    centre: Column<f64>,
    tensor: &Matrix3<f64>,
    axes: &[Vector3; 3],
) -> (ode::dBodyID, Inertia) {
    let padded = |rows: &[Vector3; 3]| -> ode::dMatrix3 {
        let mut numbers = [0.0; 12];
        for (row, own) in numbers.chunks_exact_mut(4).zip(rows) {
            row[..3].copy_from_slice(own);
        }
        numbers
    };
    let tensor = rows(tensor);
    let whole = ode::dMass { mass, c: [0.0; 4], I: padded(&tensor) };
    let rotation = padded(axes);
    // SAFETY: as the caller promises; all that is handed over is finite, and the mass positive.
    unsafe {
        let body = ode::dBodyCreate(world);
        ode::dBodySetMass(body, &whole);
        ode::dBodySetRotation(body, rotation.as_ptr());
        ode::dBodySetPosition(body, centre.x, centre.y, centre.z);
        (body, Inertia::new(mass, tensor))
    }
}

#[cfg(test)]
mod tests;
