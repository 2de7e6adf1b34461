#!/usr/bin/env python3
"""Execute the examples of the Python package, and make their pages: reproduce/examples.sh [--check | --write]

Each script of python/examples becomes a notebook, which is executed, and then a page of docs/shown/examples with its output and pictures.
Of the paper's example the notebook is kept, too. With --write, pages and notebook are written; otherwise they are compared with the
committed ones. On a machine of the same kind, all bytes must be the same. On another one, last digits of a body map differ, and with them
posterior samples: there only the text is compared, and that everything runs. Takes about two minutes on two cores.

Needs the package and what python/requirements.txt names; reproduce/examples.sh installs both. Status: 0 the same or written, 1 an
example fails or its page is another one.
"""

import argparse
import base64
import difflib
import hashlib
import html
import os
import pathlib
import re
import shutil
import sys
import tempfile

import jupytext
import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError
from traitlets.config import Config

import bodyschema

ROOT = pathlib.Path(__file__).resolve().parent.parent
EXAMPLES = ROOT / "python" / "examples"
PAGES = ROOT / "docs" / "shown" / "examples"
# Of which the notebook is committed, too.
NOTEBOOKS = ["paper_in_five_minutes"]
KIND = PAGES / "kind.txt"


def main():
    parser = argparse.ArgumentParser(description="Execute the examples of the Python package, and make their pages.")
    choice = parser.add_mutually_exclusive_group()
    choice.add_argument("--check", action="store_true", help="compare with the committed pages (default)")
    choice.add_argument("--write", action="store_true", help="write the pages")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for recording in EXAMPLES.glob("*.bvh"):
            shutil.copy(recording, folder)
        made = {KIND: kind_of_machine().encode()}
        for script in sorted(EXAMPLES.glob("*.py")):
            try:
                made.update(files_of(script, pathlib.Path(folder)))
            except CellExecutionError as error:
                print(f"examples: {script.relative_to(ROOT)} fails:\n{error}", file=sys.stderr)
                return 1
    old = {*PAGES.glob("*"), *EXAMPLES.glob("*.ipynb")} - set(made)
    if not arguments.write:
        return compared(made, old)
    PAGES.mkdir(parents=True, exist_ok=True)
    for path in old:
        path.unlink()
    for path, content in made.items():
        path.write_bytes(content)
    return 0


def kind_of_machine():
    """The hash of a small body map, whose last digits depend on the processor and the C library."""
    touch = bodyschema.simulate(duration=60, coordination=0.0, random_state=1).touch
    body_map = bodyschema.body_map(bodyschema.information_metric(bodyschema.quantise(touch)), n_components=14)
    return hashlib.sha256(body_map.tobytes()).hexdigest() + "\n"


def files_of(script, folder):
    """The page of an example and its pictures, by path; executed in a folder."""
    notebook = executed(script, folder)
    page, pictures = page_of(script.stem, notebook)
    files = {PAGES / name: content for name, content in pictures.items()}
    files[PAGES / f"{script.stem}.md"] = page.encode()
    if script.stem in NOTEBOOKS:
        files[script.with_suffix(".ipynb")] = nbformat.writes(notebook).encode() + b"\n"
    return files


def executed(script, folder):
    """The notebook of a script with its output, without anything that another run would change."""
    notebook = jupytext.read(script)
    notebook.metadata = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    sockets = Config({"KernelManager": {"transport": "ipc", "ip": str(folder / script.stem)}})
    client = NotebookClient(notebook, config=sockets, timeout=600, record_timing=False, resources={"metadata": {"path": str(folder)}})
    # No bars of progress, and no warning that this notebook cannot show them.
    quiet = {"TQDM_DISABLE": "1", "PYTHONWARNINGS": "ignore:IProgress not found"}
    client.execute(env={**{name: value for name, value in os.environ.items() if name != "MPLBACKEND"}, **quiet})
    notebook.metadata.pop("language_info", None)
    for at, cell in enumerate(notebook.cells):
        cell["id"] = f"cell-{at}"
        cell.metadata = {}
        if cell.cell_type == "code":
            cell.outputs = [*streams_of(cell.outputs), *(output for output in cell.outputs if output.output_type != "stream")]
    return notebook


def streams_of(outputs):
    """What a cell printed, after its warnings: which of both arrives first is chance."""
    for name in ["stderr", "stdout"]:
        text = "".join(output.text for output in outputs if output.output_type == "stream" and output.name == name)
        # Without the place that a warning comes from: a file with the number of a process, and a line of the cell.
        text = re.sub(r"^\S*ipykernel_\d+/\d+\.py:\d+: (.*\n)  .*\n", r"\1", text, flags=re.MULTILINE)
        if text:
            yield nbformat.v4.new_output("stream", name=name, text=text)


def page_of(name, notebook):
    """The page in Markdown, and its pictures by name."""
    blocks, pictures = [], {}

    def picture(content, kind, alt):
        file = f"{name}-{len(pictures) + 1}.{kind}"
        pictures[file] = content
        blocks.append(f"![{alt}]({file})")

    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            # Links are those of the script, from a folder that is less deep.
            blocks.append(cell.source.strip().replace("](../../", "](../../../"))
            continue
        blocks.append(f"```python\n{cell.source.strip()}\n```")
        for output in cell.outputs:
            if output.output_type == "stream":
                blocks.append(f"```text\n{output.text.rstrip()}\n```")
                continue
            shown = output.data
            if "image/png" in shown:
                picture(base64.b64decode(shown["image/png"]), "png", title_of(cell.source))
            elif "text/html" in shown:
                # Pages of a repository show no pictures within HTML.
                for drawing in re.findall(r"<svg.*?</svg>", shown["text/html"], flags=re.DOTALL):
                    picture(drawing.encode() + b"\n", "svg", html.unescape(re.search("<title>(.*?)</title>", drawing)[1]))
                table = re.search(r"<table.*?</table>", shown["text/html"], flags=re.DOTALL)
                if table:
                    blocks.append(table[0])
            else:
                blocks.append(f"```text\n{shown['text/plain']}\n```")
    script = f"../../../python/examples/{name}.py"
    note = f"This page is made by `reproduce/examples.py` from [{name}.py]({script})"
    if name in NOTEBOOKS:
        note += f", which is also a [notebook](../../../python/examples/{name}.ipynb)"
    first, *rest = blocks
    heading, _, text = first.partition("\n")
    return "\n\n".join([heading, f"{note}.", text.strip(), *rest]) + "\n", pictures


def title_of(source):
    """The title of a figure, which says what it shows to those who cannot see it."""
    return re.search(r"title=\"([^\"]*)\"", source)[1]


def compared(made, old):
    """0 if what was made is what is committed; says what differs otherwise."""
    same_kind = KIND.exists() and KIND.read_bytes() == made[KIND]
    if not same_kind:
        print("examples: another kind of machine than that of the committed pages; numbers and pictures are not compared")
    different = [path for path, content in made.items() if not is_same(path, content, same_kind)]
    for path in [*different, *old]:
        print(f"examples: {path.relative_to(ROOT)} is not what the example makes; see reproduce/examples.sh --write", file=sys.stderr)
        if path.suffix == ".md" and path.exists() and path in made:
            lines = [text.splitlines(keepends=True) for text in (path.read_text(), made[path].decode())]
            sys.stderr.writelines(difflib.unified_diff(*lines, "committed", "made", n=0))
    return 1 if different or old else 0


def is_same(path, content, same_kind):
    if not path.exists():
        return False
    if same_kind:
        return path.read_bytes() == content
    if path.suffix != ".md":
        return True
    output = re.compile(r"```text\n.*?\n```|<table.*?</table>", re.DOTALL)
    return output.sub("", path.read_text()) == output.sub("", content.decode())


if __name__ == "__main__":
    sys.exit(main())
