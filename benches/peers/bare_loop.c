/* The floor of the simulation: the agent of reproduce/paper.toml, every joint locked, and nothing but
 * dWorldStep. Prints the seconds of STEPS steps. A limit of the locks' torque (N m) makes each step solve a
 * complementarity problem; without one, as in src/stages/simulate/world.rs, it is a linear system.
 *
 * cc -O2 bare_loop.c -o bare_loop $(pkg-config --cflags --libs ode) && ./bare_loop 1000000 [TORQUE]
 */
#include <ode/ode.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define PARTS 5

/* ODE remarks on each axis that is set before the other. */
static void say_nothing(int number, const char *message, va_list arguments)
{
    (void)number, (void)message, (void)arguments;
}

int main(int argc, char **argv) {
    const dReal length = 0.5, radius = 0.03, gap = 0.1, density = 1000.0, step = 0.01;
    const long steps = argc > 1 ? atol(argv[1]) : 1000000;
    const dReal torque = argc > 2 ? atof(argv[2]) : dInfinity;
    dInitODE2(0);
    dSetMessageHandler(say_nothing);
    dAllocateODEDataForThread(dAllocateMaskAll);
    dWorldID world = dWorldCreate();
    dThreadingImplementationID threading = dThreadingAllocateSelfThreadedImplementation();
    dWorldSetStepThreadingImplementation(world, dThreadingImplementationGetFunctions(threading), threading);
    dBodyID bodies[PARTS];
    for (int i = 0; i < PARTS; i++) {
        dMass mass;
        dMatrix3 rotation;
        dMassSetCylinder(&mass, density, 3, radius, length);
        dRFromZAxis(rotation, 1, 0, 0);
        bodies[i] = dBodyCreate(world);
        dBodySetMass(bodies[i], &mass);
        dBodySetRotation(bodies[i], rotation);
        dBodySetPosition(bodies[i], i * (length + gap), 0, 0);
        if (i > 0) {
            dJointID joint = dJointCreateUniversal(world, 0);
            dJointAttach(joint, bodies[i - 1], bodies[i]);
            dJointSetUniversalAnchor(joint, (i - 0.5) * (length + gap), 0, 0);
            dJointSetUniversalAxis1(joint, 0, 0, 1);
            dJointSetUniversalAxis2(joint, 0, 1, 0);
            dJointSetUniversalParam(joint, dParamVel, 0);
            dJointSetUniversalParam(joint, dParamVel2, 0);
            dJointSetUniversalParam(joint, dParamFMax, torque);
            dJointSetUniversalParam(joint, dParamFMax2, torque);
        }
    }
    struct timespec before, after;
    clock_gettime(CLOCK_MONOTONIC, &before);
    for (long i = 0; i < steps; i++) {
        dWorldStep(world, step);
    }
    clock_gettime(CLOCK_MONOTONIC, &after);
    printf("%.3f\n", (after.tv_sec - before.tv_sec) + (after.tv_nsec - before.tv_nsec) / 1e9);
    return 0;
}
