#!/usr/bin/env bash
# trimesh (PyPI 5.2.0): converting OBJ to GLB turns a matt material into metal and drops its light and its opacity.
#
# Expected: a material of Kd alone is a diffuse one, so its glTF twin has metallicFactor 0. Ke has a twin in emissiveFactor
#   and KHR_materials_emissive_strength, d in the alpha of baseColorFactor. Source: Alias|Wavefront, "File Formats" 4.2 (1995), "Material Library File (.mtl)";
#   glTF 2.0, schema of pbrMetallicRoughness, where a metallicFactor that is not written is 1.
# Seen: the GLB has a baseColorFactor with alpha 1 and a roughnessFactor, and neither metallicFactor nor emissiveFactor.
#   Readers take it for a metal that does not shine. trimesh keeps Ke and d as strings in `material.kwargs`, so they were
#   read.
# Hurts: plaster becomes copper-like, lamps go dark and window panes become walls, and the file is valid.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check trimesh==5.2.0 numpy==2.4.6
venv/bin/python - <<'PY'
import json
import struct

import trimesh

open("lamp.mtl", "w").write("newmtl lamp\nKd 0.6 0.6 0.6\nKe 2 3 4\nd 0.25\n")
open("lamp.obj", "w").write("mtllib lamp.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl lamp\nf 1 2 3\n")
glb = trimesh.load("lamp.obj").export(file_type="glb")
(length,) = struct.unpack_from("<I", glb, 12)
(material,) = json.loads(glb[20 : 20 + length])["materials"]
print(json.dumps(material))
pbr = material["pbrMetallicRoughness"]
same = "metallicFactor" not in pbr and "emissiveFactor" not in material and pbr["baseColorFactor"][3] == 1
print("as described" if same else "CHANGED: the material keeps more")
raise SystemExit(not same)
PY
