#!/usr/bin/env bash
# OpenCV (PyPI opencv-python-headless 5.0.0.93), OpenImageIO 3.2.2.0, Mitsuba 3.9.1, SimpleImageIO 1.13.0: a channel slightly
# below 0 is saved in Radiance HDR as nearly the brightest value of its pixel.
#
# Expected: RGBE has no sign, so a negative channel becomes 0. Source: Greg Ward, "Real Pixels", Graphics Gems II (1991), and
#   `setcolr` in Radiance's color.c, which tests each channel for being above 0. The crate image 0.25.10 writes 0.
# Seen: all four cut the mantissa to eight bits without that test, and it wraps around. (0.3, -0.02, 0.9) comes back as
#   (0.297, 0.980, 0.898), and (100, -3, 7) as (100, 125, 7).
# Hurts: such values are common: saturated colours converted from spectra or from a wider gamut, and filters with negative
#   lobes. A purple pixel turns white.
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
pixels = np.array([[[0.3, -0.02, 0.9], [100, -3, 7]]], "f4")
writers = {
    "opencv": lambda name: cv2.imwrite(name, pixels[..., ::-1]),
    "oiio": lambda name: oiio.ImageBuf(pixels).write(name),
    "mitsuba": lambda name: mitsuba.Bitmap(pixels).write(name),
    "simpleimageio": lambda name: simpleimageio.write(name, pixels),
}
same = True
for writer, write in writers.items():
    write(f"{writer}.hdr")
    greens = oiio.ImageInput.open(f"{writer}.hdr").read_image("float")[0, :, 1].tolist()
    print(f"{writer}: green -0.02 became {greens[0]}, green -3 became {greens[1]}")
    same &= greens == [0.98046875, 125.0]
print("as described" if same else "CHANGED: some writer saves negative channels otherwise")
raise SystemExit(not same)
PY
