#!/usr/bin/env bash
# MeshLab (PyPI pymeshlab 2025.7.post1): loading and saving an OBJ darkens its material, puts its lamps out and replaces its
# normals.
#
# Expected: a trip without a filter keeps what the format can hold: Kd 0.5, Ke, d, and the normals of the corners. Source:
#   Alias|Wavefront, "Object Files (.obj)" and "Material Library File (.mtl)": normals are unit vectors by use, colours are decimal
#   numbers.
# Seen: colours go through bytes that are cut off, not rounded: Kd 0.5 is 0.498039 after one trip and 0.494118 after two. Ke
#   and d are gone (Tr 0 is written), Ks becomes 1 where none was. The normal (0, 0.6, 0.8) is replaced by one of length pi/2,
#   made from the faces.
# Hurts: smooth shading that a modeller made by hand is lost, a lamp becomes a white wall with a full highlight, and each trip
#   changes the numbers once more.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check pymeshlab==2025.7.post1 numpy==2.4.6
venv/bin/python - <<'PY'
import re

import pymeshlab

open("trip0.mtl", "w").write("newmtl lamp\nKd 0.5 0.5 0.5\nKe 2 3 4\nd 0.5\n")
open("trip0.obj", "w").write("mtllib trip0.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0.6 0.8\nusemtl lamp\nf 1//1 2//1 3//1\n")
kd = []
for trip in (1, 2):
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(f"trip{trip - 1}.obj")
    meshes.save_current_mesh(f"trip{trip}.obj")
    material = open(f"trip{trip}.obj.mtl").read()
    kd.append(float(re.search(r"^Kd (\S+)", material, re.M)[1]))
keys = set(re.findall(r"^(Ke|d|Tr|Ks) .*", material, re.M))
normal = [float(v) for v in re.search(r"^vn (.*)", open("trip1.obj").read(), re.M)[1].split()]
print(f"Kd 0.5 became {kd}; of Ke d Tr Ks there are {sorted(keys)}; normal 0 0.6 0.8 became {normal}")
same = kd == [0.498039, 0.494118] and keys == {"Tr", "Ks"} and normal[:2] == [0, 0] and abs(normal[2] - 1.5707963) < 1e-6
print("as described" if same else "CHANGED: a trip keeps more, or loses something else")
raise SystemExit(not same)
PY
