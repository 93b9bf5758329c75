#!/usr/bin/env bash
# Open3D (PyPI 0.20.0): an OBJ of quads is read as an empty mesh, and a pentagon or a quad among triangles is dropped.
#
# Expected: a face of an OBJ has three or more corners, and a reader of triangles splits it. Source: Alias|Wavefront,
#   "Object Files (.obj)", on f; the documentation of `read_triangle_mesh`, whose format table lists obj with
#   no such limit. The same quad as OFF is split into two triangles by Open3D itself.
# Seen: no triangle, no vertex. The only word is an INFO line, "Skipping non-triangle primitive geometry of type: 8".
# Hurts: most modelled meshes are quads; half-triangulated ones lose their flat parts and keep the rest, so counts and bounds
#   look sound.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
missing=()
for library in libusb-1.0.so.0 libGL.so.1 libEGL.so.1 libgomp.so.1; do
    ldconfig -p | grep -q "$library" || missing+=("$library")
done
if ((${#missing[@]})); then # what the wheel of Open3D expects of the system
    apt-get update -qq
    apt-get install -y -qq libusb-1.0-0 libgl1 libegl1 libgomp1 >/dev/null
fi
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check open3d==0.20.0
venv/bin/python - <<'PY'
import open3d

square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
open("quad.obj", "w").write(square + "f 1 2 3 4\n")
open("mixed.obj", "w").write(square + "v 2 0 0\nf 1 2 3 4\nf 2 5 3\n")
open("quad.off", "w").write("OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n")
counts = {name: len(open3d.io.read_triangle_mesh(name).triangles) for name in ("quad.obj", "mixed.obj", "quad.off")}
print(f"triangles: {counts}")
same = counts == {"quad.obj": 0, "mixed.obj": 1, "quad.off": 2}
print("as described" if same else "CHANGED: faces of more corners are read otherwise")
raise SystemExit(not same)
PY
