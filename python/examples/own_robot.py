"""
===============================================
One's own robot: from a table to parts and tree
===============================================

You have a table of pressures, a row for each sample and a column for each sensor, and want to know which rigid parts the robot has,
which sensor sits on which part, and which parts are joined. Call this with the name of your file, ``python own_robot.py recording.csv``.
Without one, a simulated body stands in for the robot.
"""

# %%
# A recording
# -----------
# Record for as long as each joint makes about 100 movements, and drive joints at random, one against the other. Sensors must feel a
# fluid or air: contact does not fit.

import sys
import tempfile
from pathlib import Path

import numpy as np

import bodyschema

truth = None
if len(sys.argv) > 1:
    recording = Path(sys.argv[1])
else:
    truth = bodyschema.simulate("star", duration=500, coordination=0.5, random_state=5)
    recording = Path(tempfile.mkdtemp()) / "recording.csv"
    header = ",".join(f"sensor_{at}" for at in range(truth.touch.shape[1]))
    np.savetxt(recording, truth.touch, delimiter=",", header=header, comments="", fmt="%.9g")

# %%
# Three lines
# -----------
# A file or an array will do, and NaN where a value is missing. The interval between two samples, in s, only labels the time.

found = bodyschema.estimate(recording, interval=0.1)
print(found)

# %%
# First the fit
# -------------
# Rigid parts must explain what the sensors feel. If they do not, parts and tree mean nothing, and the likely cause is named.

if found.fit.verdict != "good":
    print(f"take care: {found.fit.cause}")
print(f"sensors that were left out: {dict(found.dropped) or 'none'}")

# %%
# Parts
# -----
# The residual is the share of what a sensor feels that its part's motion does not explain. Where the residual of the next best part is
# near to it, the part of the sensor is uncertain.

for part in found.labels:
    own = found.sensors_of(part)
    print(f"part {part}: {len(own)} sensors, the first is {own[0]}, median residual {np.median(found.residuals[own]):.4f}")
uncertain = np.flatnonzero(found.residuals > 0.5 * found.next_residuals)
print(f"sensors whose part is uncertain: {uncertain.tolist() or 'none'}")

# %%
# The tree
# --------
# Bootstrap support of a joint is given the parts: it does not see that sensors are on a wrong part.

for (child, parent), support in zip(found.tree, found.support):
    print(f"parts {child} and {parent} are joined, support {100 * support:.0f} %")

# %%
# networkx takes it from here; and a notebook that ends a cell with ``found`` shows its picture, which is HTML.

graph = found.to_networkx()
print(f"most joints are on part {max(graph, key=graph.degree)}")
picture = recording.with_suffix(".html")
picture.write_text(found._repr_html_(), encoding="utf-8")
print(f"picture in {picture}")

# %%
# What the simulation knows
# -------------------------

if truth is not None:
    score = bodyschema.score(found.parts, found.tree, truth.parts, truth.tree)
    print(f"adjusted Rand index {score.ari:.3f}, tree {'right' if score.tree_correct else 'wrong'}")
