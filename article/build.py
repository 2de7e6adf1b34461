"""Compile article/content.typ to article/article.pdf with the Python package typst. Run by reproduce/article.sh."""

import pathlib

import typst

folder = pathlib.Path(__file__).resolve().parent
# Only the fonts that the compiler brings, and no time of day: the same input gives the same file on any machine.
typst.compile(
    folder / "content.typ",
    output=folder / "article.pdf",
    root=folder.parent,
    font_paths=[],
    ignore_system_fonts=True,
    timestamp=0,
)
