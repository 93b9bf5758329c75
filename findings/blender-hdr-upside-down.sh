#!/usr/bin/env bash
# Blender (PyPI bpy 5.0.1): a Radiance HDR picture that is stored bottom up or column by column is shown upside down or on its
# side.
#
# Expected: the resolution line names the order of pixels, in eight ways; "-Y 2 +X 3" is top down, "+Y 2 +X 3" bottom up, "+X
#   3 -Y 2" column by column. Source: Radiance, "File Formats", "Picture File Format (.hdr suffix)", resolution string.
#   OpenImageIO 3.2.2.0, which Blender reads such files with, reports the order as Orientation 4 and 5.
# Seen: Blender leaves the attribute unread. "+Y 2 +X 3" gives the same pixels as "-Y 2 +X 3", and "+X 3 -Y 2" a picture of 2
#   by 3 pixels instead of 3 by 2. OpenCV, three, Mitsuba and the crate image refuse such files.
# Hurts: an environment that is stored so lights the scene from below or from the side, and nothing is said.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3.11 -m venv venv # bpy has a wheel for one Python only
venv/bin/pip install --quiet --disable-pip-version-check bpy==5.0.1
venv/bin/python - <<'PY'
import os

import bpy

row = [bytes([mantissa] * 3 + [129]) for mantissa in (128, 144, 160, 176, 192, 208)]
seen = {}
for order in ("-Y 2 +X 3", "+Y 2 +X 3", "+X 3 -Y 2"):
    name = f"{order}.hdr"
    open(name, "wb").write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{order}\n".encode() + b"".join(row))
    image = bpy.data.images.load(os.path.abspath(name))
    seen[order] = tuple(image.size), list(image.pixels)[::4]
    print(f"{order}: size {seen[order][0]}, red from the lower left {seen[order][1]}")
down, up, columns = seen.values()
same = up == down and down[0] == (3, 2) and columns[0] == (2, 3)
print("as described" if same else "CHANGED: Blender heeds the order of pixels")
raise SystemExit(not same)
PY
