#!/usr/bin/env bash
# Installs the Debian packages that a build needs, if they are missing. The other scripts run it. Without the rights to
# install, it ends with status 2 and one line on what to do.
set -euo pipefail

command -v cargo >/dev/null || {
    echo "bodyschema: cargo is missing; install Rust (https://www.rust-lang.org/tools/install)" >&2
    exit 2
}

missing=()
command -v cc >/dev/null || missing+=(build-essential)
command -v pkg-config >/dev/null || missing+=(pkg-config)
{ command -v pkg-config >/dev/null && pkg-config --exists ode; } || missing+=(libode-dev)
# What a caller needs beyond that: "FILE PACKAGE" for each.
for pair in "$@"; do
    read -r file package <<<"$pair"
    compgen -G "$file" >/dev/null || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    if command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
        as_root=(sudo -n)
    else
        echo "bodyschema: missing packages; as root run: apt-get install ${missing[*]}" >&2
        exit 2
    fi
fi
command -v apt-get >/dev/null || {
    echo "bodyschema: missing packages: ${missing[*]} (Debian's names); install them and run this again" >&2
    exit 2
}
echo "bodyschema: installing ${missing[*]}" >&2
{
    "${as_root[@]}" apt-get update &&
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
            apt-get install --yes --no-install-recommends "${missing[@]}"
} >/dev/null || {
    echo "bodyschema: apt-get could not install ${missing[*]}" >&2
    exit 2
}
