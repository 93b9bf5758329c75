#!/usr/bin/env bash
# Mitsuba (PyPI mitsuba 3.9.1): a cropped render does not tell where it belongs, and files that tell it are read without.
#
# Expected: a crop of 3 x 2 pixels at (2, 1) of an 8 x 6 film is an OpenEXR data window from (2, 1) to (4, 2) in a display
#   window from (0, 0) to (7, 5). Source: OpenEXR, "Technical Introduction", "Data Window and Display Window"; Mitsuba's
#   documentation of hdrfilm, whose crop_* render a part of the picture.
# Seen: both windows of the file run from (0, 0) to (2, 1). Reading a file that has the right windows, `Bitmap` returns 3 x 2
#   pixels, and neither its metadata nor its size has the place or the full size.
# Hurts: pieces of one picture cannot be put together by file alone: compositors lay them all over one another in the corner.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check mitsuba==3.9.1 OpenEXR==3.5.3 numpy==2.4.6
venv/bin/python - <<'PY'
import mitsuba
import numpy as np
import OpenEXR

mitsuba.set_variant("scalar_rgb")
crop = {"crop_offset_x": 2, "crop_offset_y": 1, "crop_width": 3, "crop_height": 2}
film = {"type": "hdrfilm", "width": 8, "height": 6, **crop}
scene = {
    "type": "scene",
    "integrator": {"type": "direct"},
    "sky": {"type": "constant"},
    "sensor": {"type": "perspective", "film": film, "sampler": {"type": "independent", "sample_count": 1}},
}
loaded = mitsuba.load_dict(scene)
mitsuba.render(loaded)
loaded.sensors()[0].film().write("crop.exr")
header = OpenEXR.File("crop.exr").header()
windows = [tuple(int(v) for corner in header[f"{name}Window"] for v in corner) for name in ("data", "display")]
print(f"windows of the crop: data {windows[0]}, display {windows[1]}")


def box(x0, y0, x1, y1):
    return np.array([x0, y0], "i4"), np.array([x1, y1], "i4")


told = {"compression": OpenEXR.NO_COMPRESSION, "type": OpenEXR.scanlineimage}
told |= {"dataWindow": box(2, 1, 4, 2), "displayWindow": box(0, 0, 7, 5)}
with OpenEXR.File(told, {"RGB": np.ones((2, 3, 3), "f4")}) as file:
    file.write("told.exr")
bitmap = mitsuba.Bitmap("told.exr")
size, metadata = [int(v) for v in bitmap.size()], str(bitmap.metadata())
print(f"a file with windows is read as {size} pixels, metadata: {' '.join(metadata.split())}")
same = windows == [(0, 0, 2, 1)] * 2 and size == [3, 2] and "indow" not in metadata.replace("screenWindow", "")
print("as described" if same else "CHANGED: windows are written or read")
raise SystemExit(not same)
PY
