#!/usr/bin/env bash
# three.js (npm three 0.187.0): STLExporter and OBJExporter write a mirrored mesh inside out.
#
# Expected: a mesh under a scale of -1 looks the same after export. three itself draws it right: it swaps front and back where
#   the determinant of a world matrix is negative, as glTF 2.0 asks in "Instantiation". A file without a matrix must therefore reverse the
#   order of each mirrored triangle. Source for STL: 3D Systems, "StereoLithography Interface
#   Specification": seen from outside, a facet's vertices run counter-clockwise and its normal points at the viewer.
# Seen: positions are mirrored, their order is kept. The triangle below faces +z before and after; the STL says `facet normal
#   0 0 -1`, and the OBJ has vn 0 0 1 with a winding that faces -z, so that its two normals contradict each other.
# Hurts: halves made by mirroring print and slice as holes, turn black under single-sided shading, or shade from the wrong side.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init --yes >/dev/null
npm install --silent --no-audit --no-fund three@0.187.0
cat >probe.mjs <<'JS'
import { BufferAttribute, BufferGeometry, Mesh } from 'three';
import { OBJExporter } from 'three/addons/exporters/OBJExporter.js';
import { STLExporter } from 'three/addons/exporters/STLExporter.js';
const geometry = new BufferGeometry();
geometry.setAttribute('position', new BufferAttribute(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]), 3));
geometry.computeVertexNormals();
const mesh = new Mesh(geometry);
mesh.scale.x = -1;
mesh.updateMatrixWorld(true);
const stl = new STLExporter().parse(mesh);
const obj = new OBJExporter().parse(mesh);
const facet = stl.match(/facet normal (.*)/)[1];
const v = [...obj.matchAll(/^v (.*)$/gm)].map((m) => m[1].split(' ').map(Number));
const order = obj.match(/^f (.*)$/m)[1].split(' ').map((word) => v[parseInt(word) - 1]);
const [a, b, c] = order;
const windingZ = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
const written = Number(obj.match(/^vn (.*)$/m)[1].split(' ')[2]);
console.log(`STL facet normal: ${facet}\nOBJ: vn has z ${written}, the winding has z ${windingZ}`);
const same = facet.trim() === '0 0 -1' && written === 1 && windingZ < 0;
console.log(same ? 'as described' : 'CHANGED: the exporters treat mirrored meshes otherwise');
process.exit(same ? 0 : 1);
JS
node probe.mjs
