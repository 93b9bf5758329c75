#!/usr/bin/env bash
# three.js (npm three 0.187.0): HDRLoader reads every Radiance HDR picture 0.39 % too bright.
#
# Expected: the mantissa of an RGBE pixel is a fraction of 256, so the bytes 128 128 128 129 are 1.0, or 1.0039 where a reader
#   adds half a step. A power of two then survives any number of trips. Source: Greg Ward, "Real Pixels", Graphics Gems II
#   (1991), and `colr_color` in Radiance's color.c: ldexp(1, exponent - (128 + 8)).
# Seen: three divides by 255. What another program writes as 1.0 comes back as 1.00392, 0.5 as 0.50196, and the largest
#   mantissa reaches the next power of two. OpenImageIO 3.2.2.0 (PyPI) reads the same bytes as 1.0 and 0.5.
# Hurts: an environment map lights a scene in three by another amount than in the tool that made it, and each trip through
#   a writer that divides by 256 adds as much again.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init --yes >/dev/null
npm install --silent --no-audit --no-fund three@0.187.0
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check OpenImageIO==3.2.2.0 numpy==2.4.6

# One row: 1.0, 0.5, and the largest mantissa below 1.0.
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 3\n\200\200\200\201\200\200\200\200\377\377\377\200' >row.hdr

cat >read.mjs <<'JS'
import fs from 'fs';
import { FloatType } from 'three';
import { HDRLoader } from 'three/addons/loaders/HDRLoader.js';
const bytes = fs.readFileSync('row.hdr');
const picture = new HDRLoader().setDataType(FloatType).parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
console.log([0, 4, 8].map((i) => picture.data[i]).join(' '));
JS
three=$(node read.mjs)
peer=$(venv/bin/python -c "
import OpenImageIO as oiio
print(*(float(v) for v in oiio.ImageInput.open('row.hdr').read_image('float')[0, :, 0]))")
echo "three:       $three"
echo "OpenImageIO: $peer"
venv/bin/python - "$three" "$peer" <<'PY'
import sys
three, peer = ([float(v) for v in text.split()] for text in sys.argv[1:])
same = peer == [1.0, 0.5, 255 / 256] and all(abs(a - b * 256 / 255) < 1e-6 for a, b in zip(three, peer))
print("as described" if same else "CHANGED: three no longer divides the mantissa by 255")
sys.exit(not same)
PY
