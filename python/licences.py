"""Write the licence texts of all crates that are compiled into the extension: licences.py FILE. cargo must have fetched them."""

import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RUSTC = subprocess.run(["rustc", "-vV"], capture_output=True, text=True, check=True).stdout
PLATFORM = ["--filter-platform", RUSTC.split("host: ")[1].split()[0]]


def crates():
    """All crates that the extension links, and not those that only build it."""
    command = ["cargo", "metadata", "--format-version", "1", "--locked", *PLATFORM]
    metadata = json.loads(subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout)
    packages = {package["id"]: package for package in metadata["packages"]}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    rest = [package["id"] for package in packages.values() if package["name"] == "bodyschema-python"]
    seen = set()
    while rest:
        own = rest.pop()
        if own in seen:
            continue
        seen.add(own)
        is_macro = any("proc-macro" in target["kind"] for target in packages[own]["targets"])
        if not is_macro:
            normal = [dep["pkg"] for dep in nodes[own]["deps"] if any(kind["kind"] is None for kind in dep["dep_kinds"])]
            rest.extend(normal)
    return sorted((packages[own] for own in seen if packages[own]["source"]), key=lambda package: (package["name"], package["version"]))


def texts(package):
    """The licence files of a crate."""
    folder = Path(package["manifest_path"]).parent
    names = ("LICENSE", "LICENCE", "COPYING", "NOTICE", "COPYRIGHT", "UNLICENSE")
    return [path for path in sorted(folder.iterdir()) if path.is_file() and path.name.upper().startswith(names)]


def main():
    lines, known = ["The crates that are compiled into this package, and their licences.", ""], {}
    for package in crates():
        lines.append(f"== {package['name']} {package['version']}: {package['license']}; {package['repository'] or 'no repository named'}")
        for path in texts(package):
            text = path.read_text(encoding="utf-8", errors="replace").strip()
            if text in known:
                lines.append(f"-- {path.name}: as {known[text]}")
            else:
                known[text] = f"{path.name} of {package['name']}"
                lines += [f"-- {path.name}:", text]
        lines.append("")
    Path(sys.argv[1]).write_text("\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
