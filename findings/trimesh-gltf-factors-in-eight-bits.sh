#!/usr/bin/env bash
# trimesh (PyPI 5.2.0): reading a glTF rounds baseColorFactor to eight bits and drops emissive strength, index and
# transmission.
#
# Expected: baseColorFactor is a linear float in 0 to 1, to be kept as such; extensions that a library does not know should
#   survive or be warned of. Source: glTF 2.0, 3.9.2 and schema of pbrMetallicRoughness; KHR_materials_emissive_strength.
# Seen: 0.001 becomes 0 and 0.003 becomes 1/255 = 0.0039, because factors are held as bytes of 0 to 255 in linear light, where
#   dark colours need the finest steps. A lamp of emissiveStrength 20 is exported with a strength of 1.
# Hurts: black rubber, dark wood and asphalt turn pitch black or a third brighter, and a room lit by its lamps is 20 times
#   darker, after a load and a save that change nothing else.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check trimesh==5.2.0 numpy==2.4.6
venv/bin/python - <<'PY'
import base64
import json
import struct

import numpy as np
import trimesh

data = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4").tobytes()
strength = {"KHR_materials_emissive_strength": {"emissiveStrength": 20.0}}
document = {
    "asset": {"version": "2.0"},
    "extensionsUsed": list(strength),
    "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "materials": [
        {
            "pbrMetallicRoughness": {"baseColorFactor": [0.001, 0.003, 0.5, 1.0], "metallicFactor": 0.0},
            "emissiveFactor": [1.0, 1.0, 1.0],
            "extensions": strength,
        }
    ],
    "buffers": [{"byteLength": len(data), "uri": "data:;base64," + base64.b64encode(data).decode()}],
    "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
}
json.dump(document, open("dark.gltf", "w"))
glb = trimesh.load("dark.gltf").export(file_type="glb")
(length,) = struct.unpack_from("<I", glb, 12)
(material,) = json.loads(glb[20 : 20 + length])["materials"]
print(json.dumps(material))
factor = material["pbrMetallicRoughness"]["baseColorFactor"]
same = np.allclose(factor, [0, 1 / 255, 128 / 255, 1]) and "extensions" not in material
print("as described" if same else "CHANGED: factors or strength survive")
raise SystemExit(not same)
PY
