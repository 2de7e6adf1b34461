"""
=========================
The paper in five minutes
=========================

A body of five cylinders moves at random in a fluid. Can it learn from touch alone which parts it has, and how they are joined?
This follows Mimura, Hagiwara, Taniguchi and Inamura (2017) through all stages, with as long a movement and as many posterior samples.
It takes less than a minute on two cores.
"""

# %%
# A movement, and what 840 sensors feel
# -------------------------------------
# Each joint is locked for 5 s with probability p = 0.9; otherwise it turns to a random target. A sensor that moves outward through the
# fluid feels a pressure, and nothing otherwise. So most values are 0.

import numpy as np

import bodyschema

moved = bodyschema.simulate(duration=10_000, coordination=0.9, random_state=1)
samples, sensors = moved.touch.shape
print(f"{samples} samples of {sensors} sensors; {100 * (moved.touch == 0).mean():.0f} % of all pressures are 0")

# %%
# From pressures to distances
# ---------------------------
# Pressures become eight symbols. The information metric between two sensors is H(X|Y) + H(Y|X): how many bits one lacks who knows the
# other. Sensors of one part should be near to each other.

symbols = bodyschema.quantise(moved.touch, levels=8)
distances = bodyschema.information_metric(symbols)

same = moved.parts[:, None] == moved.parts[None, :]
np.fill_diagonal(same, False)
print(f"mean distance: {distances[same].mean():.2f} bit on one part, {distances[~same].mean():.2f} bit between parts")

# %%
# A body map
# ----------
# Classical multidimensional scaling places the sensors in d dimensions. The paper needs d of about nine or more, and takes 14.

body_map = bodyschema.body_map(distances, n_components=14)

# %%
# Parts and tree from the DPGMM-LJ
# --------------------------------
# A Dirichlet process Gaussian mixture finds the number of parts. Its latent joints draw the clusters of joined parts together, so that the
# tree is inferred at the same time. Each chain gives one posterior sample. A sample with exactly the true parts is *eligible*: the tree
# accuracy is the share of these that recover the true tree.


def tree_accuracy(posterior):
    scores = [bodyschema.score(labels, tree, moved.parts, moved.tree) for labels, tree in zip(posterior.labels, posterior.trees)]
    eligible = [score for score in scores if score.eligible]
    right = sum(score.tree_correct for score in eligible)
    return f"{len(eligible)} of {len(scores)} samples have the true parts; {right} of these recover the true tree"


posterior = bodyschema.dpgmm_lj(body_map, n_chains=100, random_state=1)
for parts, count in zip(*np.unique(posterior.n_parts, return_counts=True)):
    print(f"{count} posterior samples have {parts} parts")
print(f"DPGMM-LJ: {tree_accuracy(posterior)}")

# %%
# The baselines
# -------------
# A Dirichlet process mixture without joints finds the number of parts, too. Its tree comes only afterwards, by Prim's algorithm.

print(f"DPGMM:    {tree_accuracy(bodyschema.dpgmm(body_map, n_chains=100, random_state=1))}")

# %%
# Three methods are given the number of parts, and know no tree. They are estimators of scikit-learn.

from bodyschema.cluster import GaussianMixture, KMeans, Ward

for method in [Ward(5), KMeans(5, random_state=1), GaussianMixture(5, random_state=1)]:
    labels = method.fit_predict(body_map)
    print(f"{method}: adjusted Rand index {bodyschema.score(labels, [], moved.parts, moved.tree).ari:.3f}")

# %%
# This is a single simulation, and they differ much. docs/results.md has 100 of them, with intervals.
