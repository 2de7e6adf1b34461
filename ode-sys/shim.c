/* ODE hands its messages to handlers as a C va_list, which Rust cannot read; this formats them. */
#include "shim.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#ifndef dDOUBLE
#error "bodyschema needs ODE in double precision (dDOUBLE), as Debian's libode-dev provides it"
#endif
_Static_assert(sizeof(dReal) == 8, "dReal must be a double");

static _Thread_local char last_message[512];

static void remember(int number, const char *format, va_list arguments)
{
    int written = snprintf(last_message, sizeof last_message, "ODE message %d: ", number);
    vsnprintf(last_message + written, sizeof last_message - (size_t)written, format, arguments);
}

/* Where a fatal error in this thread's step goes. */
static _Thread_local jmp_buf *way_out;

/* A fatal handler must not return: ODE ends the process right after. Within a step it leaves by the way
 * out. Only frames of ODE's lie between, which hold memory that is then lost, but no Rust. Elsewhere, the
 * caller's checks are there so that this is never reached; if it is, the user at least reads why. */
static void leave_or_say_why(int number, const char *format, va_list arguments)
{
    remember(number, format, arguments);
    if (way_out) {
        longjmp(*way_out, 1);
    }
    fprintf(stderr, "bodyschema: the physics engine stopped the program: %s\n", last_message);
}

int ode_shim_world_step(dWorldID world, dReal step)
{
    jmp_buf here;
    way_out = &here;
    int failed = setjmp(here);
    if (!failed) {
        dWorldStep(world, step);
    }
    way_out = NULL;
    return failed;
}

void ode_shim_install_handlers(void)
{
    dSetMessageHandler(remember);
    dSetErrorHandler(leave_or_say_why);
    dSetDebugHandler(leave_or_say_why);
}

size_t ode_shim_take_message(char *buffer, size_t size)
{
    if (size == 0) {
        return 0;
    }
    snprintf(buffer, size, "%s", last_message);
    last_message[0] = '\0';
    return strlen(buffer);
}

size_t ode_shim_sizeof_real(void)
{
    return sizeof(dReal);
}

size_t ode_shim_sizeof_mass(void)
{
    return sizeof(dMass);
}
