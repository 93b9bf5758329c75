#!/usr/bin/env bash
# gltfpack (npm 1.3.0): -noq, which disables quantisation, still cuts vertex colours to eight linear bits.
#
# Expected: with -noq attributes keep their floats. Source: gltfpack's own help: "-noq: disable quantization". COLOR_0 is
#   linear light, and its values may be floats (glTF 2.0, 3.7.2.1).
# Seen: positions and normals stay floats, colours become normalised unsigned bytes: 0.001 is 0, 0.003 is 1/255 = 0.0039. `-vc
#   16` beside -noq keeps 16 bits.
# Hurts: dark scans turn black and show bands, in the very mode that was asked to lose nothing.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init --yes >/dev/null
npm install --silent --no-audit --no-fund gltfpack@1.3.0
cat >probe.mjs <<'JS'
import fs from 'fs';
import { execFileSync } from 'child_process';
const positions = [0, 0, 0, 1, 0, 0, 0, 1, 0];
const colours = [0.001, 0.003, 0.5, 0.001, 0.003, 0.5, 0.001, 0.003, 0.5];
const data = Buffer.from(new Float32Array([...positions, ...colours]).buffer);
const view = (byteOffset) => ({ buffer: 0, byteOffset, byteLength: 36 });
const accessor = (bufferView) => ({ bufferView, componentType: 5126, count: 3, type: 'VEC3' });
fs.writeFileSync('in.gltf', JSON.stringify({
  asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
  meshes: [{ primitives: [{ attributes: { POSITION: 0, COLOR_0: 1 } }] }],
  buffers: [{ byteLength: data.length, uri: `data:application/octet-stream;base64,${data.toString('base64')}` }],
  bufferViews: [view(0), view(36)],
  accessors: [{ ...accessor(0), min: [0, 0, 0], max: [1, 1, 0] }, accessor(1)],
}));
execFileSync('node', ['node_modules/gltfpack/cli.js', '-i', 'in.gltf', '-o', 'out.gltf', '-noq']);
const out = JSON.parse(fs.readFileSync('out.gltf'));
const { POSITION, COLOR_0 } = out.meshes[0].primitives[0].attributes;
const kind = (index) => out.accessors[index].componentType;
const { byteOffset } = out.bufferViews[out.accessors[COLOR_0].bufferView];
const first = [...fs.readFileSync('out.bin').subarray(byteOffset, byteOffset + 3)];
console.log(`POSITION has type ${kind(POSITION)}, COLOR_0 type ${kind(COLOR_0)} (5126 float, 5121 byte); first colour ${first} of 255`);
const same = kind(POSITION) === 5126 && kind(COLOR_0) === 5121 && `${first}` === '0,1,128';
console.log(same ? 'as described' : 'CHANGED: -noq keeps colours');
process.exit(same ? 0 : 1);
JS
node probe.mjs
