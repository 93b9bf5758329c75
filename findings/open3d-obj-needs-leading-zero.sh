#!/usr/bin/env bash
# Open3D (PyPI 0.20.0): an OBJ that writes .5 instead of 0.5 cannot be read.
#
# Expected: .5 is a decimal number as C, Fortran and every other OBJ reader know it. Source: Alias|Wavefront,
#   "Object Files (.obj)", where coordinates are floating point numbers.
# Seen: the vertex is not counted, and a face that names it ends in "OBJ: vertex index out of range" and an empty mesh.
#   trimesh, tobj, VTK, MeshLab and Blender read the file.
# Hurts: small exporters and awk scripts write numbers so; the message points at faces, which are right.
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

for number in (".5", "0.5"):
    open(f"{number}.obj", "w").write(f"v 0 0 0\nv 1 0 0\nv 0 {number} 0\nf 1 2 3\n")
counts = {number: len(open3d.io.read_triangle_mesh(f"{number}.obj").triangles) for number in (".5", "0.5")}
print(f"triangles: {counts}")
same = counts == {".5": 0, "0.5": 1}
print("as described" if same else "CHANGED: the leading zero may be left out")
raise SystemExit(not same)
PY
