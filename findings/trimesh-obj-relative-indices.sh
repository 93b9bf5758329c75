#!/usr/bin/env bash
# trimesh (PyPI 5.2.0): negative indices of an OBJ count from the end of the file, so all objects fall onto the last one.
#
# Expected: a negative index counts back from the vertex read last when the face is met, so that pieces can be appended to one
#   another. Source: Alias|Wavefront, "Object Files (.obj)", on negative reference numbers. tobj 4.0.5, VTK
#   9.7.2, bpy 5.0.1 and MeshLab 2025.7 read the file below so.
# Seen: two triangles, at x = 0 and at x = 5, each of indices -3 -2 -1. trimesh returns two triangles at x = 5, and no vertex
#   at x = 0, without a warning.
# Hurts: exporters write such files piece by piece; all pieces but the last vanish, and the last is there many times over,
#   which doubles areas and makes surfaces coincide.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check trimesh==5.2.0 numpy==2.4.6
venv/bin/python - <<'PY'
import trimesh

near = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n"
far = "v 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\n"
open("pieces.obj", "w").write(near + far)
mesh = trimesh.load("pieces.obj", process=False)
corners = mesh.triangles[:, 0, 0].tolist()
print(f"first corners at x = {corners}, {len(mesh.vertices)} vertices, area {mesh.area}")
same = corners == [5.0, 5.0] and len(mesh.vertices) == 3
print("as described" if same else "CHANGED: relative indices are read otherwise")
raise SystemExit(not same)
PY
