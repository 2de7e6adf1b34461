/* What the bindings are generated from: ODE's public header and the shim. */
#include <ode/ode.h>
#include "shim.h"
