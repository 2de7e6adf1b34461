"""Draw an estimate: as text, and as a picture for notebooks that needs no other package and no network."""

from __future__ import annotations

import html
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from . import _stages

if TYPE_CHECKING:
    from ._estimate import Estimate

# Okabe and Ito's colours, which the colour-blind tell apart.
COLOURS = ["#0072b2", "#e69f00", "#009e73", "#d55e00", "#56b4e9", "#cc79a7", "#000000"]
SIDE = 320.0
MARGIN = 24.0


def neighbours_of(labels: Iterable[int], tree: np.ndarray) -> dict[int, list[int]]:
    """The parts that each part is joined to, rising."""
    neighbours: dict[int, list[int]] = {int(part): [] for part in labels}
    for child, parent in tree.tolist():
        neighbours[child].append(parent)
        neighbours[parent].append(child)
    return {part: sorted(others) for part, others in neighbours.items()}


def text_tree(names: Mapping[int, str], tree: np.ndarray, support: np.ndarray) -> list[str]:
    """A tree over parts with these names as lines, from its first part on."""
    shares = {frozenset(edge): share for edge, share in zip(tree.tolist(), support.tolist())}
    neighbours = neighbours_of(names, tree)
    lines: list[str] = []
    seen: set[int] = set()
    # Not by recursion: a snake may be long.
    for root in neighbours:
        stack = [(root, "", "")]
        while stack:
            part, first, rest = stack.pop()
            if part in seen:
                continue
            seen.add(part)
            lines.append(first + names[part])
            children = [other for other in neighbours[part] if other not in seen]
            for at, child in reversed(list(enumerate(children))):
                is_last = at + 1 == len(children)
                share = f"{100 * shares[frozenset((part, child))]:.0f} %"
                stack.append((child, f"{rest}{'└' if is_last else '├'}─ {share} ─ ", rest + ("   " if is_last else "│  ")))
    return lines


def page(found: Estimate) -> str:
    """The estimate as HTML."""
    lines = [html.escape(line) for line in str(found).splitlines()[:2]]
    pictures = "".join(filter(None, [_map(found), _tree(found) if found.shows_tree else None]))
    rows = "".join(
        f"<tr><td><span style='color:{_colour(part)}'>{'&#9675;' if _is_hollow(part) else '&#9679;'}</span> {part}</td><td>{len(node['sensors'])}</td>"
        f"<td>{node['rank']}</td><td>{100 * node['residual']:.2f} %</td></tr>"
        for part, node in found._nodes().items()
    )
    note = "" if found.shows_tree else "<p>No tree is shown, since rigid parts do not explain the recording.</p>"
    return (
        f"<div class='bodyschema'><p><b>{lines[0]}</b><br>{lines[1]}</p>{note}{pictures}"
        f"<table><thead><tr><th>part</th><th>sensors</th><th>rank</th><th>residual variance (median)</th></tr></thead>"
        f"<tbody>{rows}</tbody></table></div>"
    )


def _colour(part: int) -> str:
    return COLOURS[part % len(COLOURS)]


def _is_hollow(part: int) -> bool:
    """Whether a part's markers are hollow, since there are fewer colours than parts."""
    return part // len(COLOURS) % 2 == 1


def _paint(part: int) -> str:
    colour = _colour(part)
    return f"fill='{'#fff' if _is_hollow(part) else colour}' stroke='{colour}' stroke-width='1.5'"


def _svg(title: str, body: str) -> str:
    return (
        f"<svg xmlns='http://www.w3.org/2000/svg' width='{SIDE:.0f}' height='{SIDE:.0f}' role='img' "
        f"aria-label='{html.escape(title)}' style='background:#fff'><title>{html.escape(title)}</title>"
        f"<text x='8' y='16' font-size='12' font-family='sans-serif'>{html.escape(title)}</text>{body}</svg>"
    )


def _map(found: Estimate) -> str | None:
    """Sensors on a body map of two dimensions, coloured by part; none where the distances tell nothing apart."""
    try:
        places = _stages.body_map(found.distances, 2)
    except ValueError:
        return None
    low, high = places.min(axis=0), places.max(axis=0)
    scale = (SIDE - 3 * MARGIN) / max(float((high - low).max()), 1e-300)
    at = SIDE / 2 + (places - (low + high) / 2) * scale * np.array([1.0, -1.0]) + np.array([0.0, MARGIN / 2])
    marks = "".join(
        f"<circle cx='{x:.1f}' cy='{y:.1f}' r='2.5' {_paint(part)} opacity='0.75'><title>sensor {sensor}, part {part}</title></circle>"
        for (x, y), sensor, part in zip(at.tolist(), found.mapped.tolist(), found.parts[found.mapped].tolist())
    )
    return _svg("Body map of the sensors", marks)


def _tree(found: Estimate) -> str:
    """The tree, from the part with most joints down."""
    neighbours = neighbours_of(found.labels, found.tree)
    root = max(neighbours, key=lambda part: (len(neighbours[part]), -part))
    depth, parent = {root: 0}, {root: root}
    stack, order = [root], []
    while stack:
        part = stack.pop()
        order.append(part)
        for other in reversed(neighbours[part]):
            if other != parent[part]:
                depth[other], parent[other] = depth[part] + 1, part
                stack.append(other)
    across: dict[int, float] = {}
    leaves = 0
    for part in reversed(order):
        own = [across[other] for other in neighbours[part] if other != parent[part]]
        if not own:
            across[part], leaves = float(leaves), leaves + 1
        else:
            across[part] = sum(own) / len(own)
    wide, high = max(leaves - 1, 1), max(max(depth.values()), 1)

    def place(part: int) -> tuple[float, float]:
        x = SIDE / 2 if leaves == 1 else 2 * MARGIN + (SIDE - 4 * MARGIN) * (1 - across[part] / wide)
        return x, 2 * MARGIN + (SIDE - 4 * MARGIN) * depth[part] / high

    lines, marks = [], []
    for (child, other), support in zip(found.tree.tolist(), found.support.tolist()):
        (x0, y0), (x1, y1) = sorted([place(child), place(other)], key=lambda at: at[1])
        lines.append(f"<line x1='{x0:.1f}' y1='{y0:.1f}' x2='{x1:.1f}' y2='{y1:.1f}' stroke='#6e6e6e' stroke-width='{0.5 + 2.5 * support:.1f}'/>")
        marks.append(
            f"<text x='{x1 + 0.42 * (x0 - x1):.1f}' y='{y1 + 0.42 * (y0 - y1) + 4:.1f}' font-size='10' font-family='sans-serif' "
            f"text-anchor='middle' paint-order='stroke' stroke='#fff' stroke-width='3'>{100 * support:.0f} %</text>"
        )
    for part in neighbours:
        x, y = place(part)
        marks.append(
            f"<circle cx='{x:.1f}' cy='{y:.1f}' r='12' {_paint(part)}/><text x='{x:.1f}' y='{y + 4:.1f}' font-size='12' "
            f"fill='{_colour(part) if _is_hollow(part) else '#fff'}' "
            f"text-anchor='middle' font-family='sans-serif'>{part}</text>"
        )
    return _svg("Tree, with bootstrap support", "".join(lines + marks))
