#!/usr/bin/env python3
"""Reference values of R-hat and effective sample size, by ArviZ: tests/reference/diagnostics.py > diagnostics.json

Needs NumPy and arviz (made with 0.23.4)."""

import json

import arviz
import numpy as np

rng = np.random.default_rng(20170101)


def autoregressive(chains, draws, coefficient, offsets):
    noise = rng.standard_normal((chains, draws))
    x = np.zeros((chains, draws))
    for t in range(draws):
        x[:, t] = (coefficient * x[:, t - 1] if t else 0) + noise[:, t]
    return x + np.asarray(offsets)[:, None]


cases = {
    "independent": autoregressive(4, 100, 0.0, [0, 0, 0, 0]),
    "slow": autoregressive(4, 201, 0.9, [0, 0, 0, 0]),
    "apart": autoregressive(3, 60, 0.3, [0, 0, 2]),
    "antithetic": autoregressive(4, 100, -0.6, [0, 0, 0, 0]),
    "integers": np.round(autoregressive(4, 120, 0.5, [5, 5, 5, 5.5])),
    "spreads": autoregressive(4, 100, 0.0, [0, 0, 0, 0]) * np.array([1, 1, 1, 3])[:, None],
}
print(
    json.dumps(
        {
            name: {
                "chains": [[round(v, 6) for v in chain] for chain in x.tolist()],
                "r_hat": float(arviz.rhat(np.round(x, 6), method="rank")),
                "ess": float(arviz.ess(np.round(x, 6), method="bulk")),
            }
            for name, x in cases.items()
        }
    )
)
