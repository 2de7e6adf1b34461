//! Simulate the agent in Open Dynamics Engine (section 5.1). This, its joints and its rigid bodies are the only files with `unsafe` code.
//!
//! ODE's assertions end the process, so everything handed to it is checked before, and the state of every
//! body after each step. Each world has its own step threading, because two worlds that share ODE's
//! default one abort when they step at the same time.

use std::f64::consts::TAU;
use std::ffi::CStr;
use std::sync::Once;

use ode_sys as ode;

use self::fluid::Surface;
use self::joints::EngineJoint;
use self::momentum::{Inertia, Moving};
use self::rigid::{Mount, make_bodies};
use super::settings::{AngularMomentum, Physics};
use crate::stages::agent::{Agent, Vector3};

mod fluid;
mod joints;
mod momentum;
mod places;
mod rigid;

pub(super) use self::joints::ball_error;

/// Where a part is and how it is turned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Centre of its shape, m.
    pub position: Vector3,
    /// Rotation matrix from the part's frame to the world's, by rows.
    pub rotation: [Vector3; 3],
}

impl Pose {
    /// Where in the world a point of the part is, given in the part's frame, m.
    pub fn place(&self, point: Vector3) -> Vector3 {
        [0, 1, 2]
            .map(|i| self.position[i] + self.rotation[i].iter().zip(point).map(|(r, x)| r * x).sum::<f64>())
    }

    /// A vector of the world, in the frame of the part.
    pub(crate) fn turned_back(&self, vector: Vector3) -> Vector3 {
        [0, 1, 2].map(|i| (0..3).map(|k| self.rotation[k][i] * vector[k]).sum::<f64>())
    }
}

/// A body whose motion cannot be followed with the present settings.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "{event} at step {step} (t = {time:.3} s): the simulation has become unstable; lower motion.stiffness, \
     motion.damping, motion.servo_gain or physics.step, or make the parts thicker"
)]
pub struct Unstable {
    /// What was seen.
    pub event: String,
    /// Physics steps taken.
    pub step: u64,
    /// Simulated time, s.
    pub time: f64,
}

/// A world with one agent, at rest at first, with all joints locked.
pub(super) struct World {
    world: ode::dWorldID,
    threading: ode::dThreadingImplementationID,
    /// Rigid bodies: parts that are fixed to each other are one.
    bodies: Vec<ode::dBodyID>,
    /// Of each body.
    inertias: Vec<Inertia>,
    /// Where each part is on its body.
    mounts: Vec<Mount>,
    angular_momentum: AngularMomentum,
    /// Of each part, where a fluid pushes it; none where no fluid does.
    surfaces: Vec<Surface>,
    /// The angular momentum that it has given the body about its centre of mass, kg m²/s; not counted where it is not conserved.
    given: Vector3,
    joints: Vec<EngineJoint>,
    step: f64,
    steps: u64,
    /// Fastest rotation that is not called unstable, rad/s.
    fastest: f64,
    /// Square of the fastest part's rotation after the last step, (rad/s)².
    rotation_squared: f64,
    /// Whether the engine gave up in a step, after which the world may not be touched.
    failed: bool,
}

/// Version (as built against), and configuration tokens (as linked) of ODE.
pub fn engine() -> (&'static str, String) {
    initialise();
    // SAFETY: ODE is initialised and returns a static, terminated string.
    let configuration = unsafe { CStr::from_ptr(ode::dGetConfiguration()) };
    (env!("BODYSCHEMA_ODE_VERSION"), configuration.to_string_lossy().trim().to_owned())
}

/// ODE wants one initialisation a process and one a thread.
fn initialise() {
    static ONCE: Once = Once::new();
    // SAFETY: `Once` runs these calls alone and before any other.
    ONCE.call_once(|| unsafe {
        assert_ne!(ode::dInitODE2(0), 0, "ODE cannot be initialised");
        ode::ode_shim_install_handlers();
        assert_eq!(
            ode::dCheckConfiguration(c"ODE_double_precision".as_ptr()),
            1,
            "the installed libode is not double precision"
        );
    });
    // SAFETY: ODE is initialised; this is its documented call for each thread, and may be repeated.
    let allocated = unsafe { ode::dAllocateODEDataForThread(ode::dAllocateMaskAll as u32) };
    assert_ne!(allocated, 0, "ODE cannot allocate its data for this thread");
}

/// What ODE last said in this thread.
fn last_message() -> String {
    let mut buffer = [0_u8; 512];
    // SAFETY: the shim writes at most as many bytes as it is told, and terminates them.
    let length = unsafe { ode::ode_shim_take_message(buffer.as_mut_ptr().cast(), buffer.len() as _) };
    String::from_utf8_lossy(&buffer[..length as usize]).into_owned()
}

impl World {
    /// Puts `agent` into a fresh world with ODE's default parameters.
    ///
    /// Lengths, densities and the step must be in the ranges that [`crate::numerics::range`] and [`Physics::check`] state: that
    /// keeps out of ODE what it would abort on.
    pub(super) fn new(agent: &Agent, physics: &Physics) -> Self {
        initialise();
        // SAFETY: handles are used only while `self` owns them.
        unsafe {
            let world = ode::dWorldCreate();
            let threading = ode::dThreadingAllocateSelfThreadedImplementation();
            ode::dWorldSetStepThreadingImplementation(
                world,
                ode::dThreadingImplementationGetFunctions(threading),
                threading,
            );

            let (bodies, mounts) = make_bodies(world, agent);
            let (bodies, inertias): (Vec<_>, _) = bodies.into_iter().unzip();
            let pushed = if physics.fluid_density > 0.0 { agent.parts.as_slice() } else { &[] };
            let surfaces =
                pushed.iter().map(|part| Surface::new(&part.shape, physics.fluid_density)).collect();
            let body = |part: usize| bodies[mounts[part].body];
            let joint = |joint| EngineJoint::new(world, &body, joint);
            let joints = agent.joints.iter().map(joint).collect();
            let mut world = Self {
                world,
                threading,
                bodies,
                inertias,
                mounts,
                angular_momentum: physics.angular_momentum,
                surfaces,
                given: [0.0; 3],
                joints,
                step: physics.step,
                steps: 0,
                fastest: physics.turn_limit * TAU / physics.step,
                rotation_squared: 0.0,
                failed: false,
            };
            for joint in 0..world.joints.len() {
                world.lock(joint);
            }
            world
        }
    }

    /// Advances the world by one step.
    ///
    /// # Errors
    /// [`Unstable`] if a part turns by more than `physics.turn_limit` in a step, leaves the range of numbers, or makes
    /// the engine give up. The world is then of no more use.
    pub(super) fn step(&mut self) -> Result<(), Unstable> {
        if !self.surfaces.is_empty() {
            self.let_the_fluid_push();
        }
        self.steps += 1;
        let unstable =
            |event: String| Unstable { event, step: self.steps, time: self.steps as f64 * self.step };
        // SAFETY: the world is live and has not failed before, its step is positive, and its state was
        // found finite after the last one.
        if unsafe { ode::ode_shim_world_step(self.world, self.step) } != 0 {
            self.failed = true;
            return Err(unstable(format!("the physics engine gave up ({})", last_message())));
        }
        self.rotation_squared = 0.0;
        for body in 0..self.bodies.len() {
            let squares = |velocity: Vector3| velocity.iter().map(|x| x * x).sum::<f64>();
            let (linear, angular) = self.body_velocity(body);
            let (linear, angular) = (squares(linear), squares(angular));
            self.rotation_squared = self.rotation_squared.max(angular);
            // No real motion of such bodies comes near a kilometre a second.
            for (squared, limit, unit) in [(angular, self.fastest, "rad/s"), (linear, 1e3, "m/s")] {
                if squared.is_nan() || squared >= limit * limit {
                    let part = self.mounts.iter().position(|mount| mount.body == body).unwrap_or(body);
                    return Err(unstable(format!("part {part} reached {:.3e} {unit}", squared.sqrt())));
                }
            }
        }
        if self.angular_momentum == AngularMomentum::Conserved {
            self.take_rotation_off();
        }
        Ok(())
    }

    /// All bodies as they move now.
    fn moving(&self) -> Vec<Moving> {
        let body = |body: usize| {
            let (linear, angular) = self.body_velocity(body);
            Moving { inertia: self.inertias[body], pose: self.body_pose(body), linear, angular }
        };
        (0..self.bodies.len()).map(body).collect()
    }

    /// Applies the forces of the fluid for the next step, and keeps account of the angular momentum that they give if it is needed.
    fn let_the_fluid_push(&mut self) {
        let bodies = self.moving();
        let conserved = self.angular_momentum == AngularMomentum::Conserved;
        let centre = conserved.then(|| momentum::centre_of_mass(&bodies));
        let mut pushes = vec![([0.0; 3], [0.0; 3]); bodies.len()];
        for (surface, mount) in self.surfaces.iter().zip(&self.mounts) {
            let Moving { pose, linear, angular, .. } = &bodies[mount.body];
            let velocity = mount.velocity(pose, *linear, *angular);
            let (force, torque) = surface.push(&mount.pose(*pose), velocity, *angular);
            let torque = mount.torque(pose, force, torque);
            let (forces, torques) = &mut pushes[mount.body];
            for axis in 0..3 {
                forces[axis] += force[axis];
                torques[axis] += torque[axis];
            }
        }
        for (at, (push, part)) in pushes.into_iter().zip(&bodies).enumerate() {
            let ([x, y, z], torque) = fluid::over_step(push, part, self.step);
            // SAFETY: the body is live, and a force is finite: it stops a part that was found to have a finite velocity within
            // the step at most.
            unsafe {
                ode::dBodyAddForce(self.bodies[at], x, y, z);
                ode::dBodyAddTorque(self.bodies[at], torque[0], torque[1], torque[2]);
            }
            let Some(centre) = centre else { continue };
            let [a, b, c] = [0, 1, 2].map(|i| part.pose.position[i] - centre[i]);
            let lever = [b * z - c * y, c * x - a * z, a * y - b * x];
            for axis in 0..3 {
                self.given[axis] += self.step * (torque[axis] + lever[axis]);
            }
        }
    }

    /// Brings the angular momentum back to what the fluid has given, by a rotation of the whole body, which moves no joint.
    fn take_rotation_off(&mut self) {
        let kept = momentum::with_angular_momentum(self.given, &self.moving());
        for (body, ([x, y, z], [a, b, c])) in self.bodies.iter().zip(kept) {
            // SAFETY: the bodies are live, and velocities, of which these are sums with finite factors, were found finite.
            unsafe {
                ode::dBodySetLinearVel(*body, x, y, z);
                ode::dBodySetAngularVel(*body, a, b, c);
            }
        }
    }

    /// Position and rotation of a part.
    pub(super) fn pose(&self, part: usize) -> Pose {
        let mount = &self.mounts[part];
        mount.pose(self.body_pose(mount.body))
    }

    /// Linear (m/s) and angular (rad/s) velocity of a body, in the world's frame.
    fn body_velocity(&self, body: usize) -> (Vector3, Vector3) {
        // SAFETY: both pointers lead to three numbers of a live body, and are read at once.
        unsafe {
            (
                *ode::dBodyGetLinearVel(self.bodies[body]).cast::<Vector3>(),
                *ode::dBodyGetAngularVel(self.bodies[body]).cast::<Vector3>(),
            )
        }
    }

    /// Position and rotation of a body.
    fn body_pose(&self, body: usize) -> Pose {
        // SAFETY: ODE keeps three numbers of position and three rows of four of rotation for a live body.
        let (position, rows) = unsafe {
            (
                *ode::dBodyGetPosition(self.bodies[body]).cast::<Vector3>(),
                *ode::dBodyGetRotation(self.bodies[body]).cast::<[[f64; 4]; 3]>(),
            )
        };
        Pose { position, rotation: rows.map(|[x, y, z, _]| [x, y, z]) }
    }

    /// The angles of a joint, rad in [−π, π]: the parent relative to the child, 0 in the rest pose. Those that it does not have
    /// are 0; of a ball joint, they are the vector of that rotation.
    pub(super) fn angles(&self, joint: usize) -> Vector3 {
        self.joints[joint].angles()
    }

    /// Rates of its angles, rad/s; of a ball joint, about the axes of the parent's frame.
    pub(super) fn rates(&self, joint: usize) -> Vector3 {
        self.joints[joint].rates()
    }

    /// Applies torques about the axes of a joint for the next step, N·m.
    pub(super) fn apply_torques(&mut self, joint: usize, torques: Vector3) {
        debug_assert!(torques.iter().all(|torque| torque.is_finite()));
        self.joints[joint].apply_torques(torques);
    }

    /// Holds a joint at its present angles by a motor of zero velocity and unlimited torque.
    pub(super) fn lock(&mut self, joint: usize) {
        self.set_motor(joint, [0.0; 3], f64::INFINITY);
    }

    /// Lets a joint turn freely.
    pub(super) fn unlock(&mut self, joint: usize) {
        self.set_motor(joint, [0.0; 3], 0.0);
    }

    /// Sets the motors of a joint's axes: the velocity that each strives for, rad/s, and its largest torque, N·m.
    pub(super) fn set_motor(&mut self, joint: usize, velocities: Vector3, torque: f64) {
        debug_assert!(velocities.iter().all(|velocity| velocity.is_finite()));
        self.joints[joint].set_motor(velocities, torque);
    }

    /// Largest distance between the two places that a joint's parts have its anchor at, m; 0 if no joint comes apart.
    pub(super) fn anchor_separation(&self) -> f64 {
        self.joints.iter().map(EngineJoint::separation).fold(0.0, f64::max)
    }

    /// How far the fastest part turns in a step at its rate after the last one, in turns.
    pub(super) fn turn(&self) -> f64 {
        self.rotation_squared.sqrt() * self.step / TAU
    }
}

impl Drop for World {
    fn drop(&mut self) {
        if self.failed {
            return;
        }
        // SAFETY: destroying the world destroys its bodies and joints; the threading outlives it.
        unsafe {
            ode::dWorldDestroy(self.world);
            ode::dThreadingFreeImplementation(self.threading);
        }
    }
}

#[cfg(test)]
mod tests;
