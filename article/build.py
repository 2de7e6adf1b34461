"""Typeset article/content.typ with the Python package typst, and compare with the committed article: build.py [--write]

Run by reproduce/article.sh. It compares article/article.pdf byte by byte with what the sources give; with --write it writes the
file, and article/article.sha256: the hash of each source and of the PDF, by which tests/article.rs finds a stale PDF without typst.
"""

import hashlib
import pathlib
import re
import shutil
import sys
import tempfile

import typst

ROOT = pathlib.Path(__file__).resolve().parent.parent
PDF, HASHES = "article/article.pdf", "article/article.sha256"
# All that the PDF is made from, beside the pictures that content.typ names.
SOURCES = ["bibliography.bib", "build.py", "content.typ", "metadata.yaml", "requirements.txt", "template.typ", "values.toml"]


def main():
    sources = [f"article/{name}" for name in SOURCES] + pictures()
    made = built(sources)
    hashes = "".join(f"{digest(data)}  {name}\n" for name, data in [*((name, (ROOT / name).read_bytes()) for name in sources), (PDF, made)])
    if sys.argv[1:] == ["--write"]:
        (ROOT / PDF).write_bytes(made)
        (ROOT / HASHES).write_text(hashes)
    elif not (ROOT / PDF).exists() or (ROOT / PDF).read_bytes() != made or (ROOT / HASHES).read_text() != hashes:
        other = ROOT / "target" / "article.pdf"
        other.parent.mkdir(exist_ok=True)
        other.write_bytes(made)
        sys.exit(f"article: {PDF} is not what its sources give (see {other}); run reproduce/article.sh --write, and commit article/")


def pictures():
    """The pictures that the text names, by their paths from the root."""
    return sorted(set(re.findall(r'"/(docs/[^"]+\.svg)"', (ROOT / "article/content.typ").read_text())))


def built(sources):
    """The PDF. It is made in a folder that has these sources alone, with the fonts that the compiler brings and no time of day: the
    same sources give the same bytes on any machine."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name in sources:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
        return typst.compile(folder / "article/content.typ", root=folder, font_paths=[], ignore_system_fonts=True, format="pdf", timestamp=0)


def digest(data):
    return hashlib.sha256(data).hexdigest()


main()
