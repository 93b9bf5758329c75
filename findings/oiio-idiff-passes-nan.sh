#!/usr/bin/env bash
# OpenImageIO (PyPI 3.2.2.0): idiff says PASS where a pixel is NaN or infinite in one picture and a plain number in the other.
#
# Expected: two pictures are equal if no pixel differs by more than the threshold, 1e-6 as delivered. Source: manual page
#   idiff(1), -fail and -hardfail, and the documentation of `ImageBufAlgo::compare` (nfail counts what is over the threshold).
#   An infinite difference is over any threshold, and NaN is equal to nothing (IEEE 754-2019, 5.11).
# Seen: NaN against 3 and infinity against 3 pass with exit code 0, and no pixel is counted; infinity against minus infinity
#   has even a greatest difference of 0. A finite 9 against 3 fails with exit code 2, as it should.
# Hurts: NaN and infinity are the usual marks of a broken renderer, and idiff is the usual guard of its golden pictures.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check OpenImageIO==3.2.2.0 numpy==2.4.6
venv/bin/python - <<'PY'
import subprocess
from pathlib import Path

import numpy as np
import OpenImageIO as oiio


def picture(value):
    """A row of floats whose third is `value`, in memory and as a file."""
    buffer = oiio.ImageBuf(np.array([1, 2, value, 4], "f4").reshape(1, 4, 1))
    name = f"{value}.exr"
    assert buffer.write(name)
    return buffer, name


golden, golden_name = picture(3.0)
seen = {}
for value in (9.0, float("nan"), float("inf")):
    broken, name = picture(value)
    code = subprocess.run(["venv/bin/idiff", "-q", name, golden_name], capture_output=True).returncode
    counted = oiio.ImageBufAlgo.compare(broken, golden, 1e-6, 1e-6)
    seen[str(value)] = (code, counted.nfail, counted.error)
    print(f"{value} against 3.0: idiff exits {code}, pixels that fail: {counted.nfail}, error: {counted.error}")
plus, minus = picture(float("inf"))[0], picture(float("-inf"))[0]
opposite = oiio.ImageBufAlgo.compare(plus, minus, 1e-6, 1e-6)
print(f"inf against -inf: greatest difference {opposite.maxerror}, error: {opposite.error}")
same = seen == {"9.0": (2, 1, True), "nan": (0, 0, False), "inf": (0, 0, False)} and opposite.maxerror == 0
print("as described" if same else "CHANGED: pixels that are not finite are compared otherwise")
raise SystemExit(not same)
PY
