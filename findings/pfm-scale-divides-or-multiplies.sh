#!/usr/bin/env bash
# OpenCV (PyPI opencv-python-headless 5.0.0.93), OpenImageIO 3.2.2.0, Mitsuba 3.9.1, SimpleImageIO 1.13.0: one PFM file has
# three brightnesses.
#
# Expected: the third line of a PFM holds a scale whose sign is the byte order and whose size tells the units of the samples; a
#   reader multiplies by it or leaves it to the caller. Source: pfm(5) of Netpbm, and Paul Debevec's description of the format.
# Seen: with a scale of 4 and samples of 1, OpenCV divides and returns 0.25, OpenImageIO and Mitsuba multiply and return 4,
#   SimpleImageIO returns 1. None of them warns.
# Hurts: the same file differs by a factor of 16 between two readers; with the usual scale of 1 nobody notices before that.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check OpenImageIO==3.2.2.0 opencv-python-headless==5.0.0.93 \
    mitsuba==3.9.1 simpleimageio==1.13.0 numpy==2.4.6
venv/bin/python - <<'PY'
import cv2
import mitsuba
import numpy as np
import OpenImageIO as oiio
import simpleimageio

mitsuba.set_variant("scalar_rgb")
open("scaled.pfm", "wb").write(b"PF\n2 2\n-4.0\n" + np.ones((2, 2, 3), "<f4").tobytes())
readers = {
    "OpenCV": lambda name: cv2.imread(name, cv2.IMREAD_UNCHANGED),
    "OpenImageIO": lambda name: oiio.ImageInput.open(name).read_image("float"),
    "Mitsuba": lambda name: np.array(mitsuba.Bitmap(name)),
    "SimpleImageIO": simpleimageio.read,
}
seen = {reader: float(read("scaled.pfm").ravel()[0]) for reader, read in readers.items()}
print(seen)
same = seen == {"OpenCV": 0.25, "OpenImageIO": 4.0, "Mitsuba": 4.0, "SimpleImageIO": 1.0}
print("as described" if same else "CHANGED: the readers take the scale otherwise")
raise SystemExit(not same)
PY
