#!/usr/bin/env bash
# Builds the physics engine, Open Dynamics Engine 0.16.2 in double precision, from source, for machines without a package of it:
# ode-from-source.sh PREFIX [TARBALL]. It installs into PREFIX, and prints the environment variables with which cargo finds it
# there. Without TARBALL it downloads Debian's copy of the source. Needs a C++ compiler, make and curl, and takes about two minutes of a core.
# Status: 0 built, 2 on an error.
set -euo pipefail

version=0.16.2
sha256=b26aebdcb015e2d89720ef48e0cb2e8a3ca77915f89d853893e7cc861f810f22
url=http://deb.debian.org/debian/pool/main/o/ode/ode_$version.orig.tar.gz

fail() {
    echo "ode-from-source: $1" >&2
    exit 2
}
[ $# -ge 1 ] && [ $# -le 2 ] || fail "usage: ode-from-source.sh PREFIX [TARBALL]"
mkdir -p "$1"
prefix=$(CDPATH= cd -- "$1" && pwd)
for tool in c++ make tar sha256sum; do
    command -v "$tool" >/dev/null || fail "$tool is missing"
done

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
tarball=${2:-}
if [ -z "$tarball" ]; then
    tarball=$work/ode.tar.gz
    curl --silent --show-error --fail --location --output "$tarball" "$url" || fail "could not download $url; give the file as TARBALL"
fi
echo "$sha256  $tarball" | sha256sum --check --quiet || fail "$tarball is not the source of version $version that the results were computed with"

# Nothing here asks for collisions, so that libccd is not needed; no demos. Debian's flags but for hardening, which does not change
# results; -march and -ffast-math would.
tar -xzf "$tarball" -C "$work"
cd "$work/ode-$version"
{
    ./configure --prefix="$prefix" --enable-double-precision --enable-shared --disable-static --disable-demos --disable-libccd \
        CFLAGS="-O2" CXXFLAGS="-O2" && make -j"${JOBS:-1}" && make install
} >"$work/log" 2>&1 || {
    tail -n 20 "$work/log" >&2
    fail "the build failed; its last lines are above"
}

echo "export PKG_CONFIG_PATH=$prefix/lib/pkgconfig\${PKG_CONFIG_PATH:+:\$PKG_CONFIG_PATH}"
echo "export LD_LIBRARY_PATH=$prefix/lib\${LD_LIBRARY_PATH:+:\$LD_LIBRARY_PATH}"
