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
    means = Means(surrogate, codes, overriding)
    return np.array([means.taken(factor) for factor in range(codes.shape[1])])


class Means:
    """Mean predictions of a surrogate over configurations, in which some choices take the place of their own."""

    def __init__(self, surrogate, codes, overriding=()):
        self.surrogate, self.codes, self.overriding = surrogate, codes, overriding
        self.matches = [(own[:, None] == other[None, :]) & (own != OVERRIDDEN)[:, None]
                        for own, other in zip(codes.T, surrogate.codes.T)]
        self.agree = np.sum(self.matches, axis=0, dtype=float)

    def options(self, factor):
        """Its options, and how often they are there."""
        own = self.codes[:, factor]
        found, counts = np.unique(own[own != OVERRIDDEN], return_counts=True)
        return found, counts / max(1, counts.sum())

    def mean(self, chosen):
        """With these options of some factors, over the configurations to which the factors apply; None if there are none."""
        keep = np.full(len(self.codes), True)
        for factor, option in chosen.items():
            own = self.codes[:, factor]
            keep &= own == option if factor in self.overriding else own != OVERRIDDEN
        if not keep.any():
            return None
        agree = self.agree[keep]
        for factor, option in chosen.items():
            if factor not in self.overriding:
                agree = agree - self.matches[factor][keep] + (self.surrogate.codes[:, factor] == option)
        return float((of_share(agree / self.codes.shape[1], self.surrogate.pairs) @ self.surrogate.weights).mean())

    def applies(self, *factors):
        """The share of the configurations to which all of some factors apply."""
        return (self.codes[:, factors] != OVERRIDDEN).all(axis=1).mean()

    def taken(self, factor):
        """The variance that knowing a factor would take away."""
        options, weights = self.options(factor)
        means = np.array([self.mean({factor: option}) for option in options])
        return self.applies(factor) * np.dot(weights, (means - np.dot(weights, means)) ** 2) if len(options) else 0.0

    def taken_together(self, first, second):
        """The variance that knowing two factors would take away beyond that of each alone (the second-order term of Sobol's
        decomposition); 0 if one leaves the other without a choice."""
        options, weights = zip(self.options(first), self.options(second))
        means = [[self.mean({first: one, second: other}) for other in options[1]] for one in options[0]]
        if not means or not means[0] or any(mean is None for row in means for mean in row):
            return 0.0
        means = np.array(means)
        rows, columns = means @ weights[1], weights[0] @ means
        left = means - rows[:, None] - columns[None, :] + weights[0] @ rows
        return self.applies(first, second) * float(weights[0] @ left**2 @ weights[1])
