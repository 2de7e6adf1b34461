/* ODE hands its messages to handlers as a C va_list, which Rust cannot read; this formats them. */
#include "shim.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <ode/ode.h>

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

/* A fatal error must not return: ODE ends the process right after. The caller's checks are there so
 * that this is never reached; if it is, the user at least reads what ODE said. */
static void say_last_words(int number, const char *format, va_list arguments)
{
    remember(number, format, arguments);
    fprintf(stderr, "bodyschema: the physics engine stopped the program: %s\n", last_message);
}

void ode_shim_install_handlers(void)
{
    dSetMessageHandler(remember);
    dSetErrorHandler(say_last_words);
    dSetDebugHandler(say_last_words);
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
