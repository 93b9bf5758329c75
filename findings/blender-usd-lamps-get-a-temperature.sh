#!/usr/bin/env bash
# Blender (PyPI bpy 5.0.1) and OpenUSD (usd-core 26.11): a lamp whose colour temperature is switched off is exported with it
# switched on.
#
# Expected: `use_temperature` off in Blender is `inputs:enableColorTemperature` off in USD, so the lamp's colour alone counts.
#   Source: OpenUSD's schema UsdLux LightAPI: the temperature takes effect when that input is true, and then multiplies the
#   colour by `UsdLuxBlackbodyTemperatureAsRgb`; 6500, called D65 there, is what holds where none is written.
# Seen: Blender writes enableColorTemperature = 1 for each lamp. With its own 6500 K that colours white light (1.043, 0.984,
#   1.035), since a black body of 6500 K is not D65; a slider that was once moved to 3000 K and switched off is written too,
#   and gives (1.771, 0.844, 0.272). Blender's own import of the file has `use_temperature` on.
# Hurts: scenes turn pink, or orange, on their way to any other renderer, and back.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3.11 -m venv venv # bpy has a wheel for one Python only
venv/bin/pip install --quiet --disable-pip-version-check bpy==5.0.1 usd-core==26.11
venv/bin/python - <<'PY'
import re
import subprocess
import sys

import bpy


def fresh():
    bpy.ops.wm.read_factory_settings(use_empty=True)


def export(temperature):
    fresh()
    lamp = bpy.data.lights.new("lamp", "POINT")
    if temperature is not None:
        lamp.temperature = temperature
    assert not lamp.use_temperature and tuple(lamp.color) == (1, 1, 1)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("lamp", lamp))
    bpy.ops.wm.usd_export(filepath="lamp.usda")
    return dict(re.findall(r"inputs:(enableColorTemperature|colorTemperature) = (\S+)", open("lamp.usda").read()))


untouched, moved = export(None), export(3000)
fresh()
bpy.ops.wm.usd_import(filepath="lamp.usda")
switched_on = bpy.data.lights[0].use_temperature
colours = subprocess.run(
    [sys.executable, "-c", "from pxr import UsdLux\nfor t in 6500, 3000: print(*UsdLux.BlackbodyTemperatureAsRgb(t))"],
    capture_output=True, text=True, check=True,
).stdout
rgb = [[round(float(v), 3) for v in line.split()] for line in colours.splitlines()]
print(f"untouched: {untouched}; moved and off: {moved}; on after import: {switched_on}; colours of 6500 K and 3000 K: {rgb}")
same = untouched == {"enableColorTemperature": "1"} and moved == {"enableColorTemperature": "1", "colorTemperature": "3000"}
same &= switched_on and rgb == [[1.043, 0.984, 1.035], [1.771, 0.844, 0.272]]
print("as described" if same else "CHANGED: the switch is exported, or 6500 K is white")
raise SystemExit(not same)
PY
