/* The part of the boundary that only C can speak: handlers that take a va_list. */
#ifndef BODYSCHEMA_ODE_SHIM_H
#define BODYSCHEMA_ODE_SHIM_H

#include <stddef.h>

#include <ode/ode.h>

/* Sends ODE's messages, warnings and fatal errors to this shim instead of ODE's own printing. */
void ode_shim_install_handlers(void);

/* dWorldStep, except that a fatal error inside it returns 1 instead of ending the process; 0 otherwise.
 * After a 1 the world is in an unknown state: it must be neither stepped, read nor destroyed again. */
int ode_shim_world_step(dWorldID world, dReal step);

/* Copies the calling thread's latest message into buffer (at most size - 1 characters, always
 * terminated), forgets it, and returns its length; 0 when ODE has said nothing since. */
size_t ode_shim_take_message(char *buffer, size_t size);

/* sizeof(dReal) as this shim was compiled, to compare with the bindings. */
size_t ode_shim_sizeof_real(void);

/* sizeof(dMass) as this shim was compiled, to compare with the bindings. */
size_t ode_shim_sizeof_mass(void);

#endif
