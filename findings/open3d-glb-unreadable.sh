#!/usr/bin/env bash
# Open3D (PyPI 0.20.0): the GLB files it writes are not valid, and it cannot read them back itself.
#
# Expected: accessors of floats start at multiples of 4 bytes, and a GLB keeps its data in the binary chunk. Source: glTF 2.0,
#   3.6.2.4 "Data Alignment" and 4.4.3.3 "Binary buffer"; gltf-validator 2.0.0-dev.3.10 (npm) reports
#   ACCESSOR_TOTAL_OFFSET_ALIGNMENT as an error.
# Seen: `write_triangle_mesh("x.glb", ...)` returns True. Positions start right behind 16-bit indices, at byte 6 for one
#   triangle, and all data is a base64 text in the JSON chunk; there is no binary chunk. `read_triangle_mesh` warns "Buffer
#   view ... out of range" and returns an empty mesh. Written as .gltf the same mesh can be read.
# Hurts: a scan that was saved as GLB is lost for the program that saved it, and strict loaders and graphics cards refuse odd
#   offsets.
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
venv/bin/pip install --quiet --disable-pip-version-check open3d==0.20.0 numpy==2.4.6
venv/bin/python - <<'PY'
import json
import struct

import numpy as np
import open3d

corners = open3d.utility.Vector3dVector(np.eye(3))
triangle = open3d.geometry.TriangleMesh(corners, open3d.utility.Vector3iVector([[0, 1, 2]]))
written = open3d.io.write_triangle_mesh("one.glb", triangle) and open3d.io.write_triangle_mesh("one.gltf", triangle)
glb = open("one.glb", "rb").read()
(length,) = struct.unpack_from("<I", glb, 12)
document = json.loads(glb[20 : 20 + length])
primitive = document["meshes"][0]["primitives"][0]
position = document["accessors"][primitive["attributes"]["POSITION"]]
offset = document["bufferViews"][position["bufferView"]].get("byteOffset", 0) + position.get("byteOffset", 0)
has_binary = len(glb) > 20 + length
back = {name: len(open3d.io.read_triangle_mesh(name).triangles) for name in ("one.glb", "one.gltf")}
print(f"written: {written}; positions at byte {offset}; binary chunk: {has_binary}; triangles read back: {back}")
same = written and offset == 6 and not has_binary and back == {"one.glb": 0, "one.gltf": 1}
print("as described" if same else "CHANGED: GLB is written or read otherwise")
raise SystemExit(not same)
PY
