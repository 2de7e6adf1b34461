# %% [markdown]
"""
# The paper in five minutes

A body of five cylinders moves at random in a fluid. Can it learn from touch alone which parts it has, and how they are joined?
This follows Mimura, Hagiwara, Taniguchi and Inamura (2017) through all stages, with as long a movement and as many posterior samples.
It takes less than a minute on two cores.
"""

# %% [markdown]
# ## A movement, and what 840 sensors feel
#
# Each joint is locked for 5 s with probability p = 0.9; otherwise it turns to a random target. A sensor that moves outward through the
# fluid feels a pressure, and nothing otherwise.

# %%
import matplotlib.pyplot as plt
import numpy as np

import bodyschema

moved = bodyschema.simulate(duration=10_000, coordination=0.9, random_state=1)
samples, sensors = moved.touch.shape
print(f"{samples} samples of {sensors} sensors; {100 * (moved.touch == 0).mean():.0f} % of all pressures are 0")

# %% [markdown]
# ## From pressures to distances
#
# Pressures become eight symbols. The picture shows two minutes of them; sensors of one part are next to each other. Movements begin every
# 5 s, and the whole body feels them. What differs between parts is finer, and distances measure it.

# %%
symbols = bodyschema.quantise(moved.touch, levels=8)

begin, end = 0, 1200
figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
extent = [0, (end - begin) * moved.interval, sensors, 0]
picture = axes.imshow(symbols[begin:end:3, ::4].T, aspect="auto", cmap="magma", interpolation="nearest", extent=extent)
axes.set(xlabel="time (s)", ylabel="sensor", yticks=range(0, sensors + 1, sensors // 5), title="What the sensors feel")
figure.colorbar(picture, label="symbol")
plt.show()

# %% [markdown]
# The information metric between two sensors is H(X|Y) + H(Y|X): how many bits one lacks who knows the other. Sensors of one part should be
# near to each other.

# %%
distances = bodyschema.information_metric(symbols)

same = moved.parts[:, None] == moved.parts[None, :]
np.fill_diagonal(same, False)
print(f"mean distance: {distances[same].mean():.2f} bit on one part, {distances[~same].mean():.2f} bit between parts")

# %%
figure, axes = plt.subplots(figsize=(4.5, 3.6), layout="constrained")
picture = axes.imshow(distances[::4, ::4], cmap="viridis", interpolation="nearest", extent=[0, sensors, sensors, 0])
ticks = range(0, sensors + 1, sensors // 5)
axes.set(xlabel="sensor", ylabel="sensor", xticks=ticks, yticks=ticks, title="Distances between sensors")
figure.colorbar(picture, label="information metric (bit)")
plt.show()

# %% [markdown]
# ## A body map
#
# Classical multidimensional scaling places the sensors in d dimensions. The paper needs d of about nine or more for the tree, and takes 14.
# The picture shows the first two.

# %%
body_map = bodyschema.body_map(distances, n_components=14)

figure, axes = plt.subplots(figsize=(4.5, 4), layout="constrained")
for part in range(5):
    axes.scatter(*body_map[moved.parts == part, :2].T, s=8, label=f"part {part}")
axes.set(xlabel="dimension 1", ylabel="dimension 2", aspect="equal", title="Two dimensions of the body map")
axes.legend(title="true part", fontsize="small")
plt.show()

# %% [markdown]
# ## Parts and tree from the DPGMM-LJ
#
# A Dirichlet process Gaussian mixture finds the number of parts. Its latent joints draw the clusters of joined parts together, so that the
# tree is inferred at the same time. Each chain gives one posterior sample. A sample with exactly the true parts is *eligible*: the tree
# accuracy is the share of these that recover the true tree.


# %%
def tree_accuracy(posterior):
    scores = [bodyschema.score(labels, tree, moved.parts, moved.tree) for labels, tree in zip(posterior.labels, posterior.trees)]
    eligible = [score for score in scores if score.eligible]
    right = sum(score.tree_correct for score in eligible)
    return f"{len(eligible)} of {len(scores)} samples have the true parts; {right} of these recover the true tree"


posterior = bodyschema.dpgmm_lj(body_map, n_chains=100, random_state=1)
for parts, count in zip(*np.unique(posterior.n_parts, return_counts=True)):
    print(f"{count} posterior samples have {parts} parts")
print(f"DPGMM-LJ: {tree_accuracy(posterior)}")

# %% [markdown]
# ## The baselines
#
# A Dirichlet process mixture without joints finds the number of parts, too. Its tree comes only afterwards, by Prim's algorithm.

# %%
print(f"DPGMM:    {tree_accuracy(bodyschema.dpgmm(body_map, n_chains=100, random_state=1))}")

# %% [markdown]
# Three methods are given the number of parts, and know no tree. They are estimators of scikit-learn.

# %%
from bodyschema.cluster import GaussianMixture, KMeans, Ward

for method in [Ward(5), KMeans(5, random_state=1), GaussianMixture(5, random_state=1)]:
    labels = method.fit_predict(body_map)
    print(f"{method}: adjusted Rand index {bodyschema.score(labels, [], moved.parts, moved.tree).ari:.3f}")

# %% [markdown]
# This is a single simulation, and they differ much. The
# [results of 100 simulations](../../docs/results.md) have intervals.
