"""A surrogate of a multiverse: predicts what a configuration would give from its choices.

The model is ridge regression on all single choices and all pairs of them, in its kernel form: the kernel of two configurations is
(1 - w) s + w s², where s is the share of factors in which they agree (a polynomial kernel on indicators; Schölkopf and Smola 2002,
Learning with Kernels, section 13.1). A choice that another one overrides agrees with nothing.
"""

import numpy as np
from sklearn.ensemble import RandomForestRegressor
from sklearn.kernel_ridge import KernelRidge
from sklearn.model_selection import GroupKFold

# What cross-validation chooses from: the weight w of pairs, and the penalty.
PAIRS = (0.0, 0.5, 1.0)
PENALTIES = (0.1, 0.3, 1.0)
FOLDS = 8
# No choice, since another one overrides it.
OVERRIDDEN = -1


def kernel(codes, others, pairs):
    """The kernel of configurations, given as the number of the option of each factor: (n, factors), (m, factors) → (n, m)."""
    agree = np.zeros((len(codes), len(others)))
    for own, other in zip(codes.T, others.T):
        agree += (own[:, None] == other[None, :]) & (own != OVERRIDDEN)[:, None]
    return of_share(agree / codes.shape[1], pairs)


def of_share(share, pairs):
    """The kernel of configurations that agree in this share of factors."""
    return (1 - pairs) * share + pairs * share**2


class Surrogate:
    """A fitted model: a constant and a weight for each configuration that it was fitted to."""

    def __init__(self, codes, values, pairs, penalty):
        self.codes, self.pairs = codes, pairs
        self.constant = float(values.mean())
        self.model = KernelRidge(alpha=penalty, kernel="precomputed")
        self.model.fit(kernel(codes, codes, pairs), values - self.constant)

    def predict(self, codes):
        return self.constant + self.model.predict(kernel(codes, self.codes, self.pairs))

    @property
    def weights(self):
        return self.model.dual_coef_


class Chosen:
    """The surrogate of some values whose settings have the least squared error in cross-validation over movements, and that error.

    `error` is the share of the variance that it leaves in movements that it has not seen, and `forest` that of a random forest, which is not
    tuned. `residuals` are the prediction errors behind `error`. Both are of the folds that chose the settings, so they are a little too small.
    """

    def __init__(self, codes, values, movements, seed):
        folds = GroupKFold(min(FOLDS, len(set(movements))))
        splits = list(folds.split(codes, values, movements))

        def predicted(fit):
            found = np.empty(len(values))
            for train, test in splits:
                found[test] = fit(train).predict(codes[test])
            return found

        settings = [(pairs, penalty) for pairs in PAIRS for penalty in PENALTIES]
        all_predicted = [predicted(lambda train: Surrogate(codes[train], values[train], *one)) for one in settings]
        squares = [((values - found) ** 2).sum() for found in all_predicted]
        best = int(np.argmin(squares))
        means = np.empty(len(values))
        for train, test in splits:
            means[test] = values[train].mean()
        total = ((values - means) ** 2).sum()
        self.pairs, self.penalty = settings[best]
        self.error = squares[best] / total
        self.residuals = values - all_predicted[best]
        self.surrogate = Surrogate(codes, values, self.pairs, self.penalty)
        self.forest = ((values - predicted(lambda train: Forest(codes[train], values[train], seed))) ** 2).sum() / total

    def half_width(self, level=0.9):
        """Half of the width of a prediction interval: a quantile of the sizes of the prediction errors in cross-validation."""
        errors = np.sort(np.abs(self.residuals))
        return float(errors[min(len(errors) - 1, int(np.ceil(level * (len(errors) + 1))) - 1)])


class Forest:
    """The rival: a random forest on the same choices."""

    def __init__(self, codes, values, seed):
        self.counts = codes.max(axis=0) + 1
        self.model = RandomForestRegressor(200, min_samples_leaf=3, max_features=1 / 3, random_state=seed)
        self.model.fit(self.indicators(codes), values)

    def predict(self, codes):
        return self.model.predict(self.indicators(codes))

    def indicators(self, codes):
        return np.concatenate([own[:, None] == np.arange(count) for own, count in zip(codes.T, self.counts)], axis=1)


def knowing(surrogate, codes, overriding=()):
    """The variance that knowing each factor's choice would take away: that of the mean prediction over the options (the numerator of
    Sobol's first-order index; Saltelli et al. 2008, Global Sensitivity Analysis, section 1.2.14).

    Means are over the configurations `codes` to which a factor applies, each with every option in turn; options count by how often they
    are there. An option of an `overriding` factor would leave the others without a choice, so that means are over those that have it.
    """
    agree = np.zeros((len(codes), len(surrogate.codes)))
    matches = [(own[:, None] == other[None, :]) & (own != OVERRIDDEN)[:, None] for own, other in zip(codes.T, surrogate.codes.T)]
    for match in matches:
        agree += match

    def predicted(agree):
        return of_share(agree / codes.shape[1], surrogate.pairs) @ surrogate.weights

    taken = []
    for factor, own in enumerate(codes.T):
        applies = own != OVERRIDDEN
        options, counts = np.unique(own[applies], return_counts=True)
        if factor in overriding:
            means = [predicted(agree[own == option]).mean() for option in options]
        else:
            rest = (agree - matches[factor])[applies]
            means = [predicted(rest + (surrogate.codes[:, factor] == option)).mean() for option in options]
        weights = counts / max(1, counts.sum())
        middle = np.dot(weights, means)
        taken.append(applies.mean() * np.dot(weights, (np.array(means) - middle) ** 2))
    return np.array(taken)
