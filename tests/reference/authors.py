"""Makes authors.json: what the sampler in the code of the paper's first author computes, written again in NumPy and SciPy.

Run: pip install numpy==2.4.6 scipy==1.17.1 scikit-learn==1.9.1
     python tests/reference/authors.py            writes authors.json (a few minutes)
     python tests/reference/authors.py --power    only prints p values: does each departure show on the maps?

Source of the description: GitHub mimuratomohiro/Dirichlet_Process_Gaussian_Mixture_Model_with_Latent_Joints, commits
e258b30 and db7d96b. None of its code is here. Each of eight options has the value of that code first and the value of the
paper's equations second.
"""

import json
import pathlib
import sys

import numpy as np
import scipy.stats
import sklearn.cluster
import sklearn.metrics

NO_EDGE = 2.0**24
OPTIONS = {
    "density_floor": (1e-7, 0.0),
    "smallest_part": (1, 2),
    "root": ("component-0", "first-active"),
    "stale_joints": (True, False),
    "densities": ("plain", "logarithmic"),
    "joints_in_scatter": (False, True),
    "mean_covariance": ("inverse-scale", "component"),
    "empty_components": ("inverse", "prior"),
}
AUTHORS = {name: values[0] for name, values in OPTIONS.items()}
EQUATIONS = {name: values[1] for name, values in OPTIONS.items()}


# The sampler.


def log_densities(points, means, covariances):
    """Entry (k, i): of Gaussian k at row i of points, or of points[k] where each Gaussian has its own."""
    roots = np.linalg.cholesky(covariances)
    scaled = np.linalg.solve(roots, np.swapaxes(points - means[:, None], 1, 2))
    scale = np.log(np.diagonal(roots, axis1=1, axis2=2)).sum(axis=1) + 0.5 * means.shape[1] * np.log(2 * np.pi)
    return -0.5 * (scaled**2).sum(axis=1) - scale[:, None]


def draw_gaussian(rng, mean, covariance):
    """Or one draw of each of many."""
    return mean + (np.linalg.cholesky(covariance) @ rng.normal(size=mean.shape)[..., None])[..., 0]


def draw_inverse_wishart(rng, freedom, scale):
    """By Bartlett's decomposition, as scipy.stats.invwishart, but without its checks of the arguments, which take long."""
    d = len(scale)
    triangle = np.tril(rng.normal(size=(d, d)), -1)
    np.fill_diagonal(triangle, np.sqrt(rng.chisquare(freedom - np.arange(d))))
    root = np.linalg.solve(triangle, np.linalg.cholesky(scale).T)
    return root.T @ root


def pairs(active):
    return [(a, b) for a in active for b in active if a < b]


def pair_conditionals(means, covariances, chosen):
    """Means and covariances of the joints of pairs: the normalised products of their Gaussians."""
    precisions = np.linalg.inv(covariances)
    shifts = (precisions @ means[..., None])[..., 0]
    first, second = np.array(chosen, dtype=int).reshape(-1, 2).T
    joint = np.linalg.inv(precisions[first] + precisions[second])
    joint = (joint + np.swapaxes(joint, 1, 2)) / 2
    return (joint @ (shifts[first] + shifts[second])[..., None])[..., 0], joint


def draw_pair_joints(rng, means, covariances, active, last):
    """One draw for each pair of active components; the other pairs keep what they have."""
    joints, chosen = last.copy(), pairs(active)
    for (a, b), q in zip(chosen, draw_gaussian(rng, *pair_conditionals(means, covariances, chosen))):
        joints[a, b] = joints[b, a] = q
    return joints


def edge_costs(options, means, covariances, active, pair_joints):
    components = len(means)
    costs = np.full((components, components), NO_EDGE)
    np.fill_diagonal(costs, 0.0)
    logs = log_densities(pair_joints, means, covariances)  # entry (a, b): of component a at its joint with b
    if options["density_floor"] > 0:
        logs = np.log(np.exp(logs) + options["density_floor"])
    for a, b in pairs(active):
        costs[a, b] = costs[b, a] = -logs[a, b] - logs[b, a]
    return costs


def prim(options, costs, active):
    """The root, the parent of every component (-1: the root) and the edges between active ones, in Prim's order."""
    components = len(costs)
    if options["root"] == "component-0":
        root, reachable, none = 0, list(range(components)), NO_EDGE
    else:
        root, reachable, none = min(active, default=0), list(active), np.inf
    parents = [root] * components
    parents[root] = -1
    best = [none] * components
    waiting = [k for k in reachable if k != root]
    edges, added = [], root
    while added is not None:
        for k in waiting:
            if costs[added, k] < best[k]:
                best[k], parents[k] = costs[added, k], added
        added, cheapest = None, none
        for k in waiting:
            if best[k] < cheapest:
                added, cheapest = k, best[k]
        if added is not None:
            waiting.remove(added)
            edges.append((added, parents[added]))
    return root, parents, edges


def label_weights(options, points, means, covariances, weights):
    """Probabilities of the labels of each point; a row of NaN where all densities underflow."""
    with np.errstate(divide="ignore"):
        logs = np.log(weights)
    densities = log_densities(points, means, covariances).T
    if options["densities"] == "plain":
        products = weights * np.exp(densities)
    else:
        products = np.exp(densities + logs - (densities + logs).max(axis=1, keepdims=True))
    with np.errstate(invalid="ignore"):
        return products / products.sum(axis=1, keepdims=True)


def draw_labels(rng, probabilities, labels):
    drawn = (probabilities.cumsum(axis=1) < rng.random(len(labels))[:, None]).sum(axis=1)
    drawn = np.minimum(drawn, probabilities.shape[1] - 1)
    return np.where(np.isnan(probabilities[:, 0]), labels, drawn)


def observed_joints(options, root, parents, edges, pair_joints, counts):
    """The joints that each component counts as observations."""
    observed = [[] for _ in counts]
    if options["stale_joints"]:
        for k, parent in enumerate(parents):
            if k != root and counts[k] > 0:
                observed[k].append(pair_joints[k, parent])
                if counts[parent] > 0:
                    observed[parent].append(pair_joints[k, parent])
    else:
        for k, parent in edges:
            if min(counts[k], counts[parent]) >= options["smallest_part"]:
                observed[k].append(pair_joints[k, parent])
                observed[parent].append(pair_joints[k, parent])
    return observed


def posterior(options, prior, sensors, joints):
    """Of one component: the inverse Wishart's freedom and scale, and the mean's mean, weight and covariance."""
    m0, k0, psi = np.array(prior["mean"]), prior["mean_weight"], np.array(prior["scale"])
    if len(sensors) == 0:
        total, weight, mean = 0, k0, m0
        scale = np.linalg.inv(psi) if options["empty_components"] == "inverse" else psi
    else:
        everything = np.vstack([sensors, *joints])
        total, centre = len(everything), everything.mean(axis=0)
        scattered = (everything if options["joints_in_scatter"] else sensors) - centre
        scale = psi + scattered.T @ scattered
        scale = scale + k0 * total / (k0 + total) * np.outer(centre - m0, centre - m0)
        weight, mean = k0 + total, (k0 * m0 + total * centre) / (k0 + total)
    of_mean = np.linalg.inv(scale) / weight if options["mean_covariance"] == "inverse-scale" else None
    return {
        "freedom": prior["freedom"] + total,
        "scale": scale,
        "mean": mean,
        "mean_weight": weight,
        "mean_covariance": of_mean,  # None: that of the component, just drawn, by the weight
    }


def draw_component(rng, given):
    covariance = draw_inverse_wishart(rng, given["freedom"], given["scale"])
    of_mean = covariance / given["mean_weight"] if given["mean_covariance"] is None else given["mean_covariance"]
    return draw_gaussian(rng, given["mean"], (of_mean + of_mean.T) / 2), covariance


def find_active(options, counts):
    return [k for k, count in enumerate(counts) if count >= options["smallest_part"]]


def start(rng, case):
    """Weights by stick-breaking, labels that do not look at the points, centres by k-means."""
    points, components = np.array(case["points"]), case["components"]
    sticks = rng.beta(1, case["alpha"], components)
    weights = sticks * np.concatenate([[1.0], np.cumprod(1 - sticks[:-1])])
    weights /= weights.sum()
    labels = rng.choice(components, size=len(points), p=weights)
    k_means = sklearn.cluster.KMeans(components, n_init=1, random_state=int(rng.integers(2**31)))
    means = k_means.fit(points).cluster_centers_
    return weights, labels, means, np.tile(np.eye(points.shape[1]), (components, 1, 1))


def chain(rng, case, start=start):
    """Labels, and the edges of the last tree, after all iterations."""
    options, prior, components = case["options"], case["prior"], case["components"]
    points = np.array(case["points"])
    weights, labels, means, covariances = start(rng, case)
    pair_joints = np.zeros((components, components, points.shape[1]))
    for iteration in range(case["iterations"] + 1):
        counts = np.bincount(labels, minlength=components)
        active = find_active(options, counts)
        pair_joints = draw_pair_joints(rng, means, covariances, active, pair_joints)
        root, parents, edges = prim(options, edge_costs(options, means, covariances, active, pair_joints), active)
        if iteration == case["iterations"]:
            return labels, edges
        labels = draw_labels(rng, label_weights(options, points, means, covariances, weights), labels)
        counts = np.bincount(labels, minlength=components)
        weights = rng.dirichlet(counts + case["alpha"])
        observed = observed_joints(options, root, parents, edges, pair_joints, counts)
        drawn = [
            draw_component(rng, posterior(options, prior, points[labels == k], observed[k])) for k in range(components)
        ]
        means, covariances = np.array([m for m, _ in drawn]), np.array([c for _, c in drawn])


def outcome(case, labels, edges):
    """Parts of at least two points, adjusted Rand index, and the tree with components named by their true part."""
    truth = np.array(case["truth"])
    name = [int(np.bincount(truth[labels == k], minlength=1).argmax()) for k in range(case["components"])]
    named = sorted(f"{min(name[a], name[b])}-{max(name[a], name[b])}" for a, b in edges)
    return {
        "parts": int((np.bincount(labels) >= 2).sum()),
        "ari": round(float(sklearn.metrics.adjusted_rand_score(truth, labels)), 12),
        "tree": " ".join(named),
    }


def outcomes(case, seed, start=start, chains=200):
    return [outcome(case, *chain(np.random.default_rng([seed, i]), case, start)) for i in range(chains)]


# The tests between two sets of chains.


def categories(first, second):
    """The p value of a two-sample chi-squared test; categories with fewer than 10 in both samples together are pooled."""
    counts = {c: (first.count(c), second.count(c)) for c in set(first) | set(second)}
    table = [pair for pair in counts.values() if sum(pair) >= 10]
    rare = [pair for pair in counts.values() if sum(pair) < 10]
    if rare:
        table.append(tuple(map(sum, zip(*rare))))
    return float(scipy.stats.chi2_contingency(table, correction=False).pvalue) if len(table) > 1 else 1.0


def compare(first, second):
    """p values of the three tests between two sets of outcomes."""
    columns = {name: ([o[name] for o in first], [o[name] for o in second]) for name in ["parts", "ari", "tree"]}
    return {
        "parts": categories(*columns["parts"]),
        "ari": float(scipy.stats.ks_2samp(*columns["ari"]).pvalue),
        "tree": categories(*columns["tree"]),
    }


# One iteration from a given state.


def covariance(rng, d, size):
    basis = rng.normal(size=(d, d + 3))
    return np.round(size * basis @ basis.T / (d + 3), 4)


def check_margins(options, costs, logs, active, points_logs):
    """Nothing here may hang on the last digits: no near ties but exact ones, no density at the edge of underflow."""
    some = [(costs[a, b], max(logs[a, b], logs[b, a])) for a, b in pairs(active)]
    for i, (cost, log) in enumerate(some):
        for other, other_log in some[:i]:
            assert abs(cost - other) > 1e-6 or (cost == other and max(log, other_log) < -60), (cost, other)
    if options["densities"] == "plain":
        best = points_logs.max(axis=1)
        assert ((best > -400) | (best < -800)).all(), best


def conditional(name, changes, d, before, now, base=AUTHORS, stale=(), seed=1, line=3.0, size=0.6, spread=1.0, psi=False):
    """One case: labels before (one digit a point) make tree and joints, labels now make the posterior.

    The Gaussians stand on a bent line, in steps of the given length, and the points about them. Of the pairs with a
    component that is not active, those in stale have a joint from an earlier iteration.
    """
    rng = np.random.default_rng([20170615, seed])
    options, components = {**base, **changes}, 4
    before, labels = np.array(list(before), dtype=int), np.array(list(now), dtype=int)
    bend = np.arange(components)[:, None] ** np.arange(1, d + 1) / components ** np.arange(d)
    means = np.round(line * bend + 2 + 0.3 * rng.normal(size=(components, d)), 3)
    covariances = np.array([covariance(rng, d, size) for _ in range(components)])
    points = np.round(means[before] + spread * rng.normal(size=(len(before), d)), 3)
    weights = np.round(rng.dirichlet(np.full(components, 2.0)), 4)
    prior = {
        "mean": points.mean(axis=0),
        "mean_weight": 0.1 if not psi else 0.3,
        "freedom": d + 1.0 if not psi else d + 2.5,
        "scale": covariance(rng, d, 2.0) if psi else np.eye(d),
    }
    active = find_active(options, np.bincount(before, minlength=components))
    pair_joints = np.zeros((components, components, d))
    for a, b in stale:
        assert a not in active or b not in active
        pair_joints[a, b] = pair_joints[b, a] = (means[a] + means[b]) / 2 + rng.normal(size=d)
    pair_joints = np.round(draw_pair_joints(rng, means, covariances, active, pair_joints), 4)
    costs = edge_costs(options, means, covariances, active, pair_joints)
    root, all_parents, edges = prim(options, costs, active)
    check_margins(
        options,
        costs,
        log_densities(pair_joints, means, covariances),
        active,
        log_densities(points, means, covariances).T,
    )
    parents = all_parents if options["stale_joints"] else [dict(edges).get(k, -1) for k in range(components)]
    observed = observed_joints(
        options, root, all_parents, edges, pair_joints, np.bincount(labels, minlength=components)
    )
    return {
        "name": name,
        "options": options,
        "components": components,
        "alpha": 0.5,
        "prior": prior,
        "points": points,
        "gaussians": [{"mean": m, "covariance": c} for m, c in zip(means, covariances)],
        "weights": weights,
        "labels_before": before,
        "active": active,
        "pair_conditionals": [
            {"pair": pair, "mean": mean, "covariance": spread_of_mean}
            for pair, mean, spread_of_mean in zip(pairs(active), *pair_conditionals(means, covariances, pairs(active)))
        ],
        "pair_joints": pair_joints,
        "costs": costs,
        "root": root,
        "tree": edges,
        "all_parents": all_parents,
        "label_probabilities": [
            None if np.isnan(row).any() else row
            for row in label_weights(options, points, means, covariances, weights)
        ],
        "labels": labels,
        "parents": parents,
        "joints": [np.zeros(d) if parent < 0 else pair_joints[k, parent] for k, parent in enumerate(parents)],
        "posterior": [posterior(options, prior, points[labels == k], observed[k]) for k in range(components)],
    }


def conditionals():
    far = {"seed": 20, "line": 70.0, "spread": 15.0}
    floored = {"seed": 10, "line": 5.0}
    return [
        conditional("authors, all active, a singleton now", {}, 2, "000111222333", "000111122223", seed=1),
        conditional(
            "authors, component 0 empty before: every component keeps parent 0",
            {}, 2, "111122223333", "001122223333", stale=[(0, 2)], seed=2,
        ),
        conditional(
            "authors, component 2 empty before and back now, component 1, a parent, has lost all its sensors",
            {}, 3, "000011113333", "000022233333", stale=[(0, 2)], seed=3, psi=True,
        ),
        conditional(
            "first active root, components 0 and 3 empty before and back now",
            {"root": "first-active"}, 2, "111111222222", "001111222233", stale=[(1, 3)], seed=4,
        ),
        conditional(
            "equations, component 0 empty and 3 a singleton before, the other way round now",
            {}, 2, "111112222223", "022111122233", base=EQUATIONS, seed=5, psi=True,
        ),
        conditional(
            "equations, component 3 empty before and now",
            {}, 3, "000011112222", "000001111122", base=EQUATIONS, seed=6, psi=True,
        ),
        conditional(
            "equations, component 1, a parent, a singleton now",
            {}, 2, "000111222333", "000001222333", base=EQUATIONS, seed=8,
        ),
        conditional("authors, far apart: densities underflow", {}, 2, "000111222222", "000111222333", **far),
        conditional(
            "the same by logarithms",
            {"densities": "logarithmic"}, 2, "000111222222", "000111222333", **far,
        ),
        conditional("authors, the floor decides on the tree", {}, 2, "000111222333", "000011122233", **floored),
        conditional("the same without a floor", {"density_floor": 0.0}, 2, "000111222333", "000011122233", **floored),
        conditional("authors, the floor makes ties", {}, 2, "000111222333", "000011122233", seed=8, line=10.0),
        conditional(
            "joints in the scatter, the mean's covariance from the component's, component 3 empty now",
            {"joints_in_scatter": True, "mean_covariance": "component"},
            3, "000111222333", "000011112222", seed=11, psi=True,
        ),
        conditional(
            "component 0 a singleton before, where a part has two, component 1 empty now under the prior itself",
            {"smallest_part": 2, "empty_components": "prior"},
            2, "011112222333", "000022222333", stale=[(0, 3)], seed=12, psi=True,
        ),
        conditional(
            "joints of the tree alone, component 3 a singleton, component 1 empty before and back now",
            {"stale_joints": False}, 2, "000002222223", "000011222223", stale=[(0, 1)], seed=13,
        ),
        conditional(
            "joints of the tree alone, in the scatter, component 2 empty now, under the prior itself",
            {"stale_joints": False, "joints_in_scatter": True, "empty_components": "prior", "mean_covariance": "component"},
            3, "000111222333", "000001111333", seed=14, psi=True,
        ),
    ]


# The maps of the chains.


def chain_case(points, truth, alpha, scale):
    d = points.shape[1]
    prior = {"mean": points.mean(axis=0), "mean_weight": 0.1, "freedom": d + 1.0, "scale": scale * np.eye(d)}
    case = {"options": AUTHORS, "components": 6, "alpha": alpha, "prior": prior, "iterations": 20}
    return {**case, "points": points, "truth": truth}


def maps():
    """Each shows some of the departures."""
    rng = np.random.default_rng(20170616)
    # A line that points at the origin, which stale joints pull to; steps so long that the floor hides who is next to whom.
    truth = np.arange(60) % 5
    line = np.array([[100, 0], [125, 0], [150, 0], [175, 0], [200, 0]])
    first = chain_case(np.round(line[truth] + 0.7 * rng.normal(size=(60, 2)), 3), truth, 0.5, 1.0)
    # One part more than components, so far apart that densities underflow.
    truth = np.arange(63) % 7
    far = 10 * np.array([[0, 0, 0], [9, 0, 0], [15, 15, 0], [0, 15, 15], [-15, 15, 0], [0, 30, 0], [-15, 0, -15]])
    second = chain_case(np.round(far[truth] + rng.normal(size=(63, 3)), 3), truth, 1.0, 1.0)
    # Parts narrower than the prior's scale, and two points alone.
    truth = np.concatenate([np.arange(42) % 3, [3, 4]])
    near = np.array([[3, 3], [5, 3], [7, 3], [3, 9], [12, 3]])
    spread = np.where(truth < 3, 0.2, 0.0)[:, None]
    third = chain_case(np.round(near[truth] + spread * rng.normal(size=(44, 2)), 3), truth, 1.0, 0.25)
    return [first, second, third]


def uniform_start(rng, case):
    """The other start: uniform labels, and everything else drawn given them."""
    points, components = np.array(case["points"]), case["components"]
    labels = rng.integers(components, size=len(points))
    weights = rng.dirichlet(np.bincount(labels, minlength=components) + case["alpha"])
    given = [posterior(case["options"], case["prior"], points[labels == k], []) for k in range(components)]
    means, covariances = zip(*[draw_component(rng, g) for g in given])
    return weights, labels, np.array(means), np.array(covariances)


def departures(case):
    return {name: {**case, "options": {**AUTHORS, name: EQUATIONS[name]}} for name in OPTIONS}


def show_power(cases, baseline, seed):
    print(f"{'map':3} {'departure':18} {'parts':8} {'ari':8} {'tree':8}")
    for i, case in enumerate(cases):
        others = {"none": outcomes(case, seed), "uniform start": outcomes(case, seed, uniform_start)}
        others |= {name: outcomes(departed, seed) for name, departed in departures(case).items()}
        for name, other in others.items():
            values = " ".join(f"{p:<8.1e}" for p in compare(baseline[i], other).values())
            print(f"{i:<3} {name:18} {values}", flush=True)


def strongest(cases, baseline, seed):
    """For each departure the map and the test with the lowest p value."""
    found = {}
    for i, case in enumerate(cases):
        for name, departed in departures(case).items():
            for test, p in compare(baseline[i], outcomes(departed, seed)).items():
                if name not in found or p < found[name]["p"]:
                    found[name] = {"map": i, "test": test, "p": p}
    return found


def plain(value):
    """Arrays as lists, for JSON."""
    if isinstance(value, dict):
        return {key: plain(v) for key, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def main():
    cases = maps()
    baseline = [outcomes(case, seed=1) for case in cases]
    if "--power" in sys.argv[1:]:
        show_power(cases, baseline, seed=3)
        return
    made = {
        "conditionals": conditionals(),
        "chains": [{**case, "outcomes": found} for case, found in zip(cases, baseline)],
        "power": strongest(cases, baseline, seed=2),
    }
    path = pathlib.Path(__file__).with_name("authors.json")
    path.write_text(json.dumps(plain(made), allow_nan=False) + "\n")


if __name__ == "__main__":
    main()
