#!/usr/bin/env bash
# meshio (PyPI 5.3.5): reading OBJ with negative indices joins the wrong vertices, and normals land on the wrong points.
#
# Expected: index -1 is the vertex read last, -3 the third from last; `f 1//3` gives vertex 1 the third normal. Source:
#   Alias|Wavefront, "Object Files (.obj)", on negative reference numbers and on vn.
# Seen: 1 is taken off each index, negative ones too, so -1 becomes -2, which numpy takes from the end without a complaint:
#   the triangle of the last three of four vertices becomes one of the first three. Normals are given to points by their order
#   in the file, whatever the faces say: all corners name (0, 0, 1), the points get (1, 0, 0), (0, 1, 0) and (0, 0, 1).
# Hurts: shapes are quietly wrong, and shading is. No error comes unless the numbers of normals and vertices differ.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check meshio==5.3.5 numpy==2.4.6
venv/bin/python - <<'PY'
import meshio
import numpy as np

open("relative.obj", "w").write("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n")
mesh = meshio.read("relative.obj")
corners = mesh.points[mesh.cells[0].data[0]].tolist()
print(f"corners of the triangle of the last three: {corners}")
open("normals.obj", "w").write("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nvn 0 1 0\nvn 0 0 1\nf 1//3 2//3 3//3\n")
normals = meshio.read("normals.obj").point_data["obj:vn"]
print(f"normals of points whose faces all name 0 0 1: {normals.tolist()}")
same = corners == [[9, 9, 9], [0, 0, 0], [1, 0, 0]] and np.array_equal(normals, np.eye(3))
print("as described" if same else "CHANGED: meshio reads these files otherwise")
raise SystemExit(not same)
PY
