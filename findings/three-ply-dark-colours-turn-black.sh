#!/usr/bin/env bash
# three.js (npm three 0.187.0): PLYLoader keeps linear colours in eight bits, so dark vertex colours turn black.
#
# Expected: 256 codes stay 256 colours. sRGB spends most of its codes on dark colours; in linear light their steps are far
#   smaller than 1/255: the first is 1/3295. Source: IEC 61966-2-1. three's own textures keep the sRGB bytes and decode
#   them when they are sampled.
# Seen: each byte is decoded, rounded to a multiple of 1/255 and stored as a byte again. Of 256 greys 183 different ones are left;
#   greys 1 to 6 become 0, and neighbours above them merge or jump (grey 20 is 0.0070, and is stored as 0.0078).
# Hurts: scanned and painted models lose their shadows: they show bands, and 0.2 % of reflectance becomes none.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init --yes >/dev/null
npm install --silent --no-audit --no-fund three@0.187.0
cat >probe.mjs <<'JS'
import { PLYLoader } from 'three/addons/loaders/PLYLoader.js';
const greys = [...Array(256).keys()];
const axes = ['float x', 'float y', 'float z', 'uchar red', 'uchar green', 'uchar blue'];
const ply = ['ply', 'format ascii 1.0', 'element vertex 256', ...axes.map((a) => `property ${a}`), 'element face 1',
  'property list uchar int vertex_indices', 'end_header', ...greys.map((g) => `${g} 0 0 ${g} ${g} ${g}`), '3 0 1 2', ''].join('\n');
const colour = new PLYLoader().parse(ply).attributes.color;
const red = greys.map((g) => colour.array[3 * g]);
const black = greys.filter((g) => g > 0 && red[g] === 0);
const distinct = new Set(red).size;
console.log(`${colour.array.constructor.name}, normalized ${colour.normalized}; ${distinct} different of 256; black: ${black}; grey 20: ${red[20]}/255`);
const same = colour.array instanceof Uint8Array && distinct === 183 && black.at(-1) === 6 && red[20] === 2;
console.log(same ? 'as described' : 'CHANGED: PLYLoader keeps vertex colours otherwise');
process.exit(same ? 0 : 1);
JS
node probe.mjs
