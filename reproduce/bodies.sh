#!/usr/bin/env bash
# How often parts and tree of any body are recovered from touch alone, by the design in bodies.toml. An interrupted run
# continues. Writes results/bodies. See run.sh.
root=$(CDPATH= cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)
exec "$root/reproduce/run.sh" bodies bodies --design "$root/reproduce/bodies.toml" "$@"
