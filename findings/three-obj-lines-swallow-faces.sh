#!/usr/bin/env bash
# three.js (npm three 0.187.0): one line element in an OBJ object turns all faces of that object into loose lines.
#
# Expected: faces (f) and lines (l) are elements of their own, and an object may hold both. Source: Alias|Wavefront,
#   "Object Files (.obj)", on elements: points, lines, faces, curves and surfaces, in any order. Blender writes
#   such objects where a mesh has loose edges.
# Seen: `l` sets the type of the whole object. The two triangles below become six end points of line segments, joined with the
#   two of the line; no mesh is left, and nothing is said.
# Hurts: a model with one stray edge is invisible to ray casting and shading; only its strokes are drawn.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init --yes >/dev/null
npm install --silent --no-audit --no-fund three@0.187.0
cat >probe.mjs <<'JS'
import { OBJLoader } from 'three/addons/loaders/OBJLoader.js';
const faces = 'o sheet\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n';
const list = (text) => new OBJLoader().parse(text).children.map((c) => `${c.type}:${c.geometry.attributes.position.count}`).join(' ');
const alone = list(faces);
const withLine = list(faces + 'l 1 2\n');
console.log(`two faces: ${alone}\nand a line: ${withLine}`);
const same = alone === 'Mesh:6' && withLine === 'LineSegments:8';
console.log(same ? 'as described' : 'CHANGED: faces and lines of one object are told apart, or read otherwise');
process.exit(same ? 0 : 1);
JS
node probe.mjs
