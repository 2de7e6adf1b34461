"""Asks roc-validator whether folders are valid Process Run Crates, without a network: ro_crate.py FOLDER...

Exit status 0 if all are. Needs tests/requirements.txt. The validator fetches the JSON-LD context of RO-Crate 1.1 by its
address; here it finds the copy that the package rocrate brings.
"""

import importlib.resources
import pathlib
import subprocess
import sys
import tempfile

import requests_cache

CONTEXT = "https://w3id.org/ro/crate/1.1/context"

# Recommended, and not ours to say: the address of the program (two checks), which has none, author and
# publisher of the results.
NOT_OURS = ["process-run-crate-0.5_3.2", "process-run-crate-0.5_5.1", "ro-crate-1.1_22.2", "ro-crate-1.1_22.3"]


def fill(cache):
    request = requests_cache.CachedRequest(method="GET", url=CONTEXT)
    headers = {"Content-Type": "application/ld+json"}
    response = requests_cache.CachedResponse(status_code=200, url=CONTEXT, headers=headers, request=request)
    response._content = (importlib.resources.files("rocrate") / "data" / "ro-crate.jsonld").read_bytes()
    with requests_cache.CachedSession(cache, backend="sqlite") as session:
        session.cache.save_response(response)


def is_valid(folder, cache):
    validator = pathlib.Path(sys.executable).with_name("rocrate-validator")
    options = ["--offline", "--cache-path", cache, "--no-paging", "--verbose", "--skip-checks", ",".join(NOT_OURS)]
    profile = ["--profile-identifier", "process-run-crate", "--requirement-severity", "RECOMMENDED"]
    command = [validator, "--no-interactive", "--disable-color", "validate", *options, *profile, folder]
    return subprocess.run(command).returncode == 0


with tempfile.TemporaryDirectory() as folder:
    cache = str(pathlib.Path(folder) / "cache")
    fill(cache)
    sys.exit(not all([is_valid(crate, cache) for crate in sys.argv[1:]]))
