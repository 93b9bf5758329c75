#!/usr/bin/env bash
# trimesh (PyPI 5.2.0): whether an exported box is flat or smooth depends on whether someone looked at its normals before.
#
# Expected: reading a property does not change what is written. A mesh without vertex normals stays without them, so a viewer
#   shades it flat. Source: glTF 2.0, 3.7.2.1: where normals are not given, flat normals are calculated.
# Seen: `export` writes vertex normals if they happen to be in the cache. A new box has POSITION alone; after
#   `box.vertex_normals` the same call adds averaged NORMALs, 45 degrees off at every edge. PLY and OBJ behave alike.
# Hurts: a box, a house or a gear looks inflated, with light on its edges that leaks; a print for debugging or a test makes
#   the difference, so it comes and goes.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check trimesh==5.2.0 scipy==1.17.1 numpy==2.4.6
venv/bin/python - <<'PY'
import json
import struct

import trimesh


def attributes(mesh):
    glb = mesh.export(file_type="glb")
    (length,) = struct.unpack_from("<I", glb, 12)
    return sorted(json.loads(glb[20 : 20 + length])["meshes"][0]["primitives"][0]["attributes"])


def normals_in_obj(mesh):
    return mesh.export(file_type="obj").count("\nvn ")


unseen, seen = trimesh.creation.box(), trimesh.creation.box()
looked_at = seen.vertex_normals
print(f"not looked at: {attributes(unseen)}, {normals_in_obj(unseen)} normals in OBJ")
print(f"looked at:     {attributes(seen)}, {normals_in_obj(seen)} normals in OBJ")
same = attributes(unseen) == ["POSITION"] and attributes(seen) == ["NORMAL", "POSITION"] and normals_in_obj(seen) > 0
same &= normals_in_obj(unseen) == 0
print("as described" if same else "CHANGED: looking makes no difference, or another one")
raise SystemExit(not same)
PY
