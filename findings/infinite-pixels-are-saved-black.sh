#!/usr/bin/env bash
# OpenCV (PyPI opencv-python-headless 5.0.0.93), OpenImageIO 3.2.2.0, Mitsuba 3.9.1: a pixel that is brighter than
# the file can say is saved black, in all channels.
#
# Expected: what exceeds a format's range becomes its largest value, or the writer refuses. Eight-bit writers saturate so for
#   finite values. Source: Greg Ward, "Real Pixels", Graphics Gems II (1991): RGBE reaches 2^127, about 1.7e38.
# Seen: (2e38, 1, 1), a finite float, and (infinity, 1, 1) become (0, 0, 0) in .hdr by all three, and a PNG by Mitsuba has 0
#   where the pixel is infinite, though 255 where it is 2. OpenImageIO's PNG has 255 for both.
# Hurts: the sun, a mirrored lamp or one firefly turns into a black dot, the reverse of what it is; whoever looks for overflow by
#   searching for bright pixels finds none.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check OpenImageIO==3.2.2.0 opencv-python-headless==5.0.0.93 \
    mitsuba==3.9.1 numpy==2.4.6
venv/bin/python - <<'PY'
import cv2
import mitsuba
import numpy as np
import OpenImageIO as oiio

mitsuba.set_variant("scalar_rgb")
bright = np.array([[[2e38, 1, 1], [np.inf, 1, 1], [2, 1, 1]]], "f4")
assert cv2.imwrite("opencv.hdr", bright[..., ::-1])
assert oiio.ImageBuf(bright).write("oiio.hdr")
mitsuba.Bitmap(bright).write("mitsuba.hdr")
same = True
for name in ("opencv.hdr", "oiio.hdr", "mitsuba.hdr"):
    back = oiio.ImageInput.open(name).read_image("float")[0].tolist()
    print(f"{name}: {back}")
    same &= back == [[0, 0, 0], [0, 0, 0], [2, 1, 1]]
mitsuba.util.write_bitmap("mitsuba.png", bright[:, 1:], write_async=False)
assert oiio.ImageBuf(bright[:, 1:]).write("oiio.png")
reds = [oiio.ImageInput.open(f"{name}.png").read_image("uint8")[0, :, 0].tolist() for name in ("mitsuba", "oiio")]
print(f"red of infinity and of 2 in a PNG: Mitsuba {reds[0]}, OpenImageIO {reds[1]}")
same &= reds == [[0, 255], [255, 255]]
print("as described" if same else "CHANGED: bright pixels are saved otherwise")
raise SystemExit(not same)
PY
