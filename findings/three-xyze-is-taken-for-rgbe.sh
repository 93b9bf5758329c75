#!/usr/bin/env bash
# three.js (npm three 0.187.0): HDRLoader reads a Radiance picture in CIE XYZ as if it were red, green and blue.
#
# Expected: FORMAT=32-bit_rle_xyze says that the three numbers are X, Y and Z; a reader converts them or refuses the file.
#   Source: Radiance, "File Formats", "Picture File Format (.hdr suffix)", FORMAT. Mitsuba 3.9.1 marks the bitmap as XYZ;
#   OpenCV 5.0.0.93, OpenImageIO 3.2.2.0 and the crate image 0.25.10 refuse the file.
# Seen: X, Y and Z are returned as the channels of the picture: white of D65, (0.95, 1, 1.09), is a pale blue.
# Hurts: Radiance's ra_xyze writes such files; their colours are wrong by far, reds most, and no word is said.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init --yes >/dev/null
npm install --silent --no-audit --no-fund three@0.187.0
# One pixel, white of D65: mantissas 122 128 139 over 128.
printf '#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n\172\200\213\201' >white.hdr
cat >probe.mjs <<'JS'
import fs from 'fs';
import { FloatType } from 'three';
import { HDRLoader } from 'three/addons/loaders/HDRLoader.js';
const bytes = fs.readFileSync('white.hdr');
const texture = new HDRLoader().setDataType(FloatType).parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
const [r, g, b] = texture.data;
console.log(`white of D65 is read as ${[r, g, b].map((v) => v.toFixed(3))}`);
const same = r / g < 0.97 && b / g > 1.07;
console.log(same ? 'as described' : 'CHANGED: X, Y and Z are converted or refused');
process.exit(same ? 0 : 1);
JS
node probe.mjs
