#!/usr/bin/env bash
# trimesh (PyPI 5.2.0) and obj2gltf (npm 3.2.0): one shininess of an OBJ becomes a mirror in one converter and satin in the
# other.
#
# Expected: Ns is the exponent of a highlight; its twin is a roughness whose lobe is as wide. Source: Alias|Wavefront,
#   "File Formats" 4.2 (1995), "Material Library File (.mtl)", Ns; Bruce Walter et al., "Microfacet Models for Refraction through Rough Surfaces"
#   (2007), section 5.2: for an exponent n alpha = sqrt(2 / (n + 2)); glTF 2.0, appendix B: alpha is roughness squared.
# Seen: for Ns 100 trimesh follows this and gives roughness 0.374 (alpha 0.14); obj2gltf gives 0.9 (alpha 0.81). For Ns 1000
#   trimesh gives 0.211, obj2gltf 0, a perfect mirror. (bpy 5.0.1 gives 0.684 and 0.)
# Hurts: the same car paint is satin, gloss or chrome; with obj2gltf and its linear scale nearly everything is matt, until it
#   suddenly mirrors, and a mirror cannot be lit by point lights at all.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init --yes >/dev/null
npm install --silent --no-audit --no-fund obj2gltf@3.2.0 2>/dev/null
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check trimesh==5.2.0 numpy==2.4.6
venv/bin/python - <<'PY'
import json
import struct
import subprocess

import trimesh

seen = {}
for exponent in (100, 1000):
    open("shiny.mtl", "w").write(f"newmtl shiny\nKd 0.5 0.5 0.5\nKs 0.5 0.5 0.5\nNs {exponent}\n")
    open("shiny.obj", "w").write("mtllib shiny.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nusemtl shiny\nf 1//1 2//1 3//1\n")
    glb = trimesh.load("shiny.obj").export(file_type="glb")
    (length,) = struct.unpack_from("<I", glb, 12)
    subprocess.run(["node_modules/.bin/obj2gltf", "-i", "shiny.obj", "-o", "shiny.gltf"], check=True, capture_output=True)
    documents = json.loads(glb[20 : 20 + length]), json.load(open("shiny.gltf"))
    seen[exponent] = [round(d["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"], 3) for d in documents]
    print(f"Ns {exponent}: trimesh {seen[exponent][0]}, obj2gltf {seen[exponent][1]}")
same = seen == {100: [0.374, 0.9], 1000: [0.211, 0.0]}
print("as described" if same else "CHANGED: the converters give other roughnesses")
raise SystemExit(not same)
PY
