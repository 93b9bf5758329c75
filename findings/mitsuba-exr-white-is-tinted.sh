#!/usr/bin/env bash
# Mitsuba (PyPI mitsuba 3.9.1): white in an OpenEXR file of another white point is tinted, because it is not adapted.
#
# Expected: a file's chromaticities name the white of (1, 1, 1), and conversion to another space maps white to white. Source:
#   OpenEXR, "Technical Introduction", "RGB Color", and "Standard attributes", adoptedNeutral; SMPTE ST 2065-1 and ICC.1:2022,
#   annex E (Bradford adaptation); the matrices of the ACES project from ACEScg to Rec. 709, whose rows add up to 1.
# Seen: Mitsuba converts primaries, which most readers do not, but keeps XYZ as they stand. White of ACEScg (white point
#   0.32168 0.33767) is read as (1.047, 0.995, 0.915), white of an equal-energy file as (1.205, 0.948, 0.909). Files of P3
#   with D65 are right.
# Hurts: an ACEScg environment, the usual output of film tools, tints the whole scene yellow by 13 % between red and blue.
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
spaces = {
    "ACEScg": (0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767),
    "equal energy": (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 1 / 3, 1 / 3),
    "P3-D65": (0.68, 0.32, 0.265, 0.69, 0.15, 0.06, 0.3127, 0.329),
}
expected = {"ACEScg": [1.0471, 0.9945, 0.9153], "equal energy": [1.2050, 0.9483, 0.9086], "P3-D65": [1, 1, 1]}
same = True
for space, chromaticities in spaces.items():
    header = {"compression": OpenEXR.NO_COMPRESSION, "type": OpenEXR.scanlineimage, "chromaticities": chromaticities}
    with OpenEXR.File(header, {"RGB": np.ones((1, 1, 3), "f4")}) as file:
        file.write("white.exr")
    white = np.array(mitsuba.Bitmap("white.exr")).ravel()
    print(f"white of {space} is read as {white.round(4).tolist()}")
    same &= np.allclose(white, expected[space], atol=2e-4)
print("as described" if same else "CHANGED: white is read otherwise")
raise SystemExit(not same)
PY
