#!/usr/bin/env bash
# Blender (PyPI bpy 5.0.1): a scene with a lamp that has a colour temperature cannot be exported as glTF.
#
# Expected: the exporter multiplies the lamp's colour by that of its temperature. Source: Blender 5.0 manual, light objects;
#   KHR_lights_punctual has a linear colour for it.
# Seen: `use_temperature` on, one lamp is enough: the export ends in "TypeError: color[item] = x: assigned value not a number"
#   and no file, because the colour of the temperature, three numbers, is multiplied into one channel.
# Hurts: the feature was made for physical lamps; the message names neither the lamp nor the setting, so that the user has to
#   halve the scene until it works.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3.11 -m venv venv # bpy has a wheel for one Python only
venv/bin/pip install --quiet --disable-pip-version-check bpy==5.0.1
venv/bin/python - <<'PY'
import os

import bpy

bpy.ops.wm.read_factory_settings(use_empty=True)
lamp = bpy.data.lights.new("lamp", "POINT")
bpy.context.scene.collection.objects.link(bpy.data.objects.new("lamp", lamp))
bpy.ops.export_scene.gltf(filepath="cold.glb", export_lights=True)
lamp.use_temperature, lamp.temperature = True, 3000
try:
    bpy.ops.export_scene.gltf(filepath="warm.glb", export_lights=True)
    error = ""
except RuntimeError as failure:
    error = str(failure)
last = [line for line in error.splitlines() if line.startswith("TypeError")]
print(f"without temperature: {os.path.exists('cold.glb')}, with it: {os.path.exists('warm.glb')}, {last}")
same = os.path.exists("cold.glb") and not os.path.exists("warm.glb") and bool(last)
print("as described" if same else "CHANGED: warm lamps are exported")
raise SystemExit(not same)
PY
