//! Joints of the engine: one set of calls for every kind.

use std::ptr::null_mut;

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3 as Column};
use ode_sys as ode;

use crate::stages::agent::{Freedom, Joint, Vector3};

/// A joint in the engine.
pub(super) struct EngineJoint {
    id: ode::dJointID,
    kind: Kind,
}

/// What the engine calls by another name for each kind.
enum Kind {
    Universal,
    Hinge,
    Ball(Ball),
    Fixed,
}

/// A ball joint knows neither angles nor motors: a second joint is its motor, and the angles come from both bodies.
struct Ball {
    motor: ode::dJointID,
    bodies: [ode::dBodyID; 2],
    /// Rotations of both bodies in the rest pose.
    rest: [Rotation3<f64>; 2],
}

fn rotation(body: ode::dBodyID) -> Rotation3<f64> {
    // SAFETY: ODE keeps three rows of four numbers for a live body, which are read at once.
    let rows = unsafe { *ode::dBodyGetRotation(body).cast::<[[f64; 4]; 3]>() };
    Rotation3::from_matrix_unchecked(Matrix3::from_fn(|row, column| rows[row][column]))
}

fn spin(body: ode::dBodyID) -> Column<f64> {
    // SAFETY: ODE keeps three numbers for a live body, which are read at once.
    Column::from(unsafe { *ode::dBodyGetAngularVel(body).cast::<Vector3>() })
}

/// The vector of a rotation: its axis times its angle, rad. It holds for the smallest and the largest angles, too.
fn vector_of(rotation: Rotation3<f64>) -> Vector3 {
    UnitQuaternion::from_rotation_matrix(&rotation).scaled_axis().into()
}

impl Ball {
    /// # Safety
    /// World and bodies must be live.
    unsafe fn new(world: ode::dWorldID, bodies: [ode::dBodyID; 2]) -> Self {
        const USER: i32 = ode::dAMotorUser as i32;
        const ON_THE_FIRST_BODY: i32 = 1;
        // SAFETY: as the caller promises; the motor is attached before its axes are set.
        let motor = unsafe {
            let motor = ode::dJointCreateAMotor(world, null_mut());
            ode::dJointAttach(motor, bodies[0], bodies[1]);
            ode::dJointSetAMotorMode(motor, USER);
            ode::dJointSetAMotorNumAxes(motor, 3);
            for (number, axis) in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].into_iter().enumerate()
            {
                ode::dJointSetAMotorAxis(motor, number as i32, ON_THE_FIRST_BODY, axis[0], axis[1], axis[2]);
            }
            motor
        };
        Self { motor, bodies, rest: bodies.map(rotation) }
    }

    /// How each body has turned since the rest pose.
    fn turned(&self) -> [Rotation3<f64>; 2] {
        [0, 1].map(|at| rotation(self.bodies[at]) * self.rest[at].inverse())
    }

    fn angles(&self) -> Vector3 {
        let [parent, child] = self.turned();
        vector_of(child.inverse() * parent)
    }

    fn rates(&self) -> Vector3 {
        (self.turned()[0].inverse() * (spin(self.bodies[0]) - spin(self.bodies[1]))).into()
    }
}

impl EngineJoint {
    /// Makes a joint between two bodies, in the pose that they have.
    ///
    /// # Safety
    /// The world and its bodies must be live, and `body` must give the one of each part of the joint. The joint must not be used
    /// after its world is destroyed.
    pub(super) unsafe fn new(
        world: ode::dWorldID,
        body: &dyn Fn(usize) -> ode::dBodyID,
        joint: &Joint,
    ) -> Self {
        let [x, y, z] = joint.anchor;
        let own = [body(joint.parent), body(joint.child)];
        // SAFETY: as the caller promises. Attach first: ODE ignores the anchor and axes of a joint without bodies. The third
        // direction is for a moment only: whenever an axis is set, ODE relates it to the other, and reads what it never
        // wrote if that is parallel, as the one it begins with is to the first.
        unsafe {
            match joint.freedom {
                Freedom::Universal([first, second]) => {
                    let third = Column::from(first).cross(&Column::from(second));
                    let id = ode::dJointCreateUniversal(world, null_mut());
                    ode::dJointAttach(id, own[0], own[1]);
                    ode::dJointSetUniversalAnchor(id, x, y, z);
                    ode::dJointSetUniversalAxis1(id, third[0], third[1], third[2]);
                    ode::dJointSetUniversalAxis2(id, second[0], second[1], second[2]);
                    ode::dJointSetUniversalAxis1(id, first[0], first[1], first[2]);
                    Self { id, kind: Kind::Universal }
                }
                Freedom::Hinge(axis) => {
                    let id = ode::dJointCreateHinge(world, null_mut());
                    ode::dJointAttach(id, own[0], own[1]);
                    ode::dJointSetHingeAnchor(id, x, y, z);
                    ode::dJointSetHingeAxis(id, axis[0], axis[1], axis[2]);
                    Self { id, kind: Kind::Hinge }
                }
                Freedom::Ball => {
                    let id = ode::dJointCreateBall(world, null_mut());
                    ode::dJointAttach(id, own[0], own[1]);
                    ode::dJointSetBallAnchor(id, x, y, z);
                    Self { id, kind: Kind::Ball(Ball::new(world, own)) }
                }
                // Both are one body.
                Freedom::Fixed => Self { id: null_mut(), kind: Kind::Fixed },
            }
        }
    }

    /// Takes the joint from its bodies, which no longer feel it.
    #[cfg(test)]
    pub(super) fn detach(&self) {
        // SAFETY: the joint is live, as its maker promised.
        unsafe { ode::dJointAttach(self.id, null_mut(), null_mut()) }
    }

    /// Its angles, rad: the parent relative to the child, 0 in the rest pose; of a ball joint, the vector of that rotation.
    /// Those that the joint does not have are 0.
    pub(super) fn angles(&self) -> Vector3 {
        let [mut first, mut second] = [0.0; 2];
        // SAFETY: the joint is live, as its maker promised, and of its kind; both angles are written where they may be.
        unsafe {
            match &self.kind {
                Kind::Universal => ode::dJointGetUniversalAngles(self.id, &mut first, &mut second),
                Kind::Hinge => first = ode::dJointGetHingeAngle(self.id),
                Kind::Ball(ball) => return ball.angles(),
                Kind::Fixed => (),
            }
        }
        [first, second, 0.0]
    }

    /// Rates about its axes, rad/s; of a ball joint, about those of the parent's frame.
    pub(super) fn rates(&self) -> Vector3 {
        // SAFETY: the joint is live, as its maker promised, and of its kind.
        unsafe {
            match &self.kind {
                Kind::Universal => [
                    ode::dJointGetUniversalAngle1Rate(self.id),
                    ode::dJointGetUniversalAngle2Rate(self.id),
                    0.0,
                ],
                Kind::Hinge => [ode::dJointGetHingeAngleRate(self.id), 0.0, 0.0],
                Kind::Ball(ball) => ball.rates(),
                Kind::Fixed => [0.0; 3],
            }
        }
    }

    /// Applies torques about its axes for the next step, N·m.
    pub(super) fn apply_torques(&self, torques: Vector3) {
        let [first, second, third] = torques;
        // SAFETY: the joint is live, as its maker promised, and of its kind; ODE copes with any finite torque, and what a
        // large one does is seen after the step.
        unsafe {
            match &self.kind {
                Kind::Universal => ode::dJointAddUniversalTorques(self.id, first, second),
                Kind::Hinge => ode::dJointAddHingeTorque(self.id, first),
                Kind::Ball(ball) => ode::dJointAddAMotorTorques(ball.motor, first, second, third),
                Kind::Fixed => (),
            }
        }
    }

    /// Sets the motor of each axis: the velocity that it strives for, rad/s, and its largest torque, N·m.
    pub(super) fn set_motor(&self, velocities: Vector3, torque: f64) {
        let parameters = [
            (ode::dParamVel1, ode::dParamFMax1),
            (ode::dParamVel2, ode::dParamFMax2),
            (ode::dParamVel3, ode::dParamFMax3),
        ];
        let (set, id, axes): (unsafe extern "C" fn(ode::dJointID, i32, f64), _, _) = match &self.kind {
            Kind::Universal => (ode::dJointSetUniversalParam, self.id, 2),
            Kind::Hinge => (ode::dJointSetHingeParam, self.id, 1),
            Kind::Ball(ball) => (ode::dJointSetAMotorParam, ball.motor, 3),
            Kind::Fixed => return,
        };
        for ((velocity, limit), value) in parameters.into_iter().zip(velocities).take(axes) {
            // SAFETY: the joint is live, as its maker promised, and both parameters are its motors'.
            unsafe {
                set(id, velocity as i32, value);
                set(id, limit as i32, torque);
            }
        }
    }

    /// Distance between the two places that its parts have its anchor at, m. Parts that are fixed have none.
    pub(super) fn separation(&self) -> f64 {
        type Anchor = unsafe extern "C" fn(ode::dJointID, *mut f64);
        let (first_anchor, second_anchor): (Anchor, Anchor) = match self.kind {
            Kind::Universal => (ode::dJointGetUniversalAnchor, ode::dJointGetUniversalAnchor2),
            Kind::Hinge => (ode::dJointGetHingeAnchor, ode::dJointGetHingeAnchor2),
            Kind::Ball(_) => (ode::dJointGetBallAnchor, ode::dJointGetBallAnchor2),
            Kind::Fixed => return 0.0,
        };
        let (mut first, mut second): (ode::dVector3, ode::dVector3) = ([0.0; 4], [0.0; 4]);
        // SAFETY: the joint is live, as its maker promised, and of its kind; both vectors hold the three numbers written.
        unsafe {
            first_anchor(self.id, first.as_mut_ptr());
            second_anchor(self.id, second.as_mut_ptr());
        }
        (0..3).map(|i| (first[i] - second[i]).powi(2)).sum::<f64>().sqrt()
    }
}

/// What is left to turn from `angles` to `target` about the axes of a ball joint, rad: the shorter way round.
pub(crate) fn ball_error(target: Vector3, angles: Vector3) -> Vector3 {
    let turn = |angles: Vector3| Rotation3::from_scaled_axis(Column::from(angles));
    vector_of(turn(angles).inverse() * turn(target))
}
