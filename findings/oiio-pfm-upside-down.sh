#!/usr/bin/env bash
# OpenImageIO (PyPI 3.2.2.0): ImageInput reads every PFM upside down, its own files too, unless a default is spelled out.
#
# Expected: a PFM stores its lowest row first, and OpenImageIO turns it over. Source: pfm(5) of Netpbm, and the chapter "PNM" of
#   OpenImageIO's documentation, where `pnm:pfmflip` is an input hint whose default of 1 flips PFM files.
# Seen: opened without hints, the first row returned is the lowest one. With a hint of pnm:pfmflip = 1, the documented
#   default, it is the highest. A picture that OpenImageIO itself wrote comes back turned over.
# Hurts: maps, depth and disparity pictures are silently mirrored for whoever opens the file the usual way.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check OpenImageIO==3.2.2.0 numpy==2.4.6
venv/bin/python - <<'PY'
import numpy as np
import OpenImageIO as oiio

top_first = np.array([[1, 2], [3, 4]], "f4")
header = b"Pf\n2 2\n-1.0\n"
open("by-hand.pfm", "wb").write(header + top_first[::-1].tobytes())
writer = oiio.ImageOutput.create("own.pfm")
assert writer.open("own.pfm", oiio.ImageSpec(2, 2, 1, "float")) and writer.write_image(top_first[..., None])
writer.close()
hint = oiio.ImageSpec()
hint.attribute("pnm:pfmflip", 1)


def rows(name, *hints):
    return oiio.ImageInput.open(name, *hints).read_image("float").reshape(2, 2).tolist()


seen = {"by hand": rows("by-hand.pfm"), "own": rows("own.pfm"), "by hand, hint": rows("by-hand.pfm", hint)}
for name, value in seen.items():
    print(f"{name}: {value}")
own_is_standard = open("own.pfm", "rb").read().endswith(top_first[::-1].tobytes())
print(f"the file that it wrote has the lowest row first: {own_is_standard}")
turned, upright = [[3, 4], [1, 2]], [[1, 2], [3, 4]]
same = list(seen.values()) == [turned, turned, upright] and own_is_standard
print("as described" if same else "CHANGED: the order of rows is another")
raise SystemExit(not same)
PY
