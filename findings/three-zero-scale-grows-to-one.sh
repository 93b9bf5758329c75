#!/usr/bin/env bash
# three.js (npm three 0.187.0): an object that is hidden or flattened by a scale of 0 is full-sized again after a trip through
# glTF.
#
# Expected: an object of scale 0 0 0 stays invisible, one of scale 1 0 1 stays flat. Source: glTF 2.0, 3.5.3, which allows a
#   scale of zero and lets readers leave out such a node's mesh; the documentation of `Matrix4.decompose`, which gives
#   position, rotation and scale of a matrix.
# Seen: where the determinant is 0, `decompose` returns a scale of 1 1 1 and no rotation. GLTFExporter writes matrices, and
#   GLTFLoader decomposes them, so (0, 0, 0) and (1, 0, 1) come back as (1, 1, 1), without a warning.
# Hurts: props that an animation hides, and blobs that stand for shadows, appear in the middle of the picture; flat labels get
#   thick.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init --yes >/dev/null
npm install --silent --no-audit --no-fund three@0.187.0
cat >probe.mjs <<'JS'
import { Object3D, Scene } from 'three';
import { GLTFExporter } from 'three/addons/exporters/GLTFExporter.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
globalThis.self = globalThis; // what the loader expects of a browser
const words = [];
console.warn = (...text) => words.push(text.join(' '));
const scales = { hidden: [0, 0, 0], flat: [1, 0, 1], twice: [2, 2, 2] };
const scene = new Scene();
for (const [name, scale] of Object.entries(scales)) {
  const object = new Object3D();
  object.name = name;
  object.scale.fromArray(scale);
  scene.add(object);
}
const gltf = await new GLTFExporter().parseAsync(scene, {});
const back = (await new GLTFLoader().parseAsync(JSON.stringify(gltf), '')).scene;
const seen = Object.keys(scales).map((name) => back.getObjectByName(name).scale.toArray().join());
Object.keys(scales).forEach((name, i) => console.log(`${name}: scale ${scales[name]} came back as ${seen[i]}`));
const same = seen.join(' ') === '1,1,1 1,1,1 2,2,2' && words.length === 0;
console.log(same ? 'as described' : 'CHANGED: a scale of 0 survives');
process.exit(same ? 0 : 1);
JS
node probe.mjs
