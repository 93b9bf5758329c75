#!/usr/bin/env bash
# three.js (npm three 0.187.0): EXRLoader returns garbage for an OpenEXR file whose colour channels have different types.
#
# Expected: each channel of a file has a type of its own, half, float or uint. Source: OpenEXR, "Technical Introduction",
#   "Channels", and "OpenEXR File Layout", attribute chlist. Files with R as half and G and B as float are valid; Python's
#   OpenEXR 3.5.3 and bpy 5.0.1 read them right.
# Seen: R is right, G and B are wrong in every pixel. (1.125, 1.25, 1.375) is read as (1.125, 0, 0) and the pixel beside it,
#   (1.5, 1.625, 1.75), as (1.5, 1.906, 1.922), with and without compression. Nothing is said.
# Hurts: tools may store each channel as finely as it needs; a texture or an environment made so lights a scene with noise.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init --yes >/dev/null
npm install --silent --no-audit --no-fund three@0.187.0
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check OpenEXR==3.5.3 numpy==2.4.6
venv/bin/python - <<'PY'
import numpy as np
import OpenEXR

rgb = np.arange(18).reshape(2, 3, 3) / 8
channels = {name: rgb[..., i].astype("f2" if name == "R" else "f4") for i, name in enumerate("RGB")}
for name, how in (("plain", OpenEXR.NO_COMPRESSION), ("zip", OpenEXR.ZIP_COMPRESSION)):
    header = {"compression": how, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, {k: v.copy() for k, v in channels.items()}) as file:
        file.write(f"{name}.exr")
    back = OpenEXR.File(f"{name}.exr", separate_channels=True).channels()
    assert all(np.array_equal(back[c].pixels, channels[c]) for c in "RGB")
PY
cat >probe.mjs <<'JS'
import fs from 'fs';
import { FloatType } from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
let same = true;
for (const name of ['plain', 'zip']) {
  const bytes = fs.readFileSync(`${name}.exr`);
  const { data } = new EXRLoader().setDataType(FloatType).parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  const wrong = [0, 0, 0];
  for (let pixel = 0; pixel < 6; pixel++) {
    const row = pixel < 3 ? 1 : 0; // three keeps the lowest row first
    for (let c = 0; c < 3; c++) wrong[c] += data[4 * pixel + c] !== (9 * row + 3 * (pixel % 3) + c) / 8;
  }
  console.log(`${name}: wrong pixels in R, G, B: ${wrong} of 6; first ${[...data.slice(0, 8)].map((v) => +v.toFixed(3))}`);
  same &&= wrong[1] >= 4 && wrong[2] >= 4;
}
console.log(same ? 'as described' : 'CHANGED: mixed types are read otherwise');
process.exit(same ? 0 : 1);
JS
node probe.mjs
