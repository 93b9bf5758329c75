#!/usr/bin/env bash
# glTF Transform (npm @gltf-transform/functions 4.5.1): flatten moves and turns objects whose parent is stretched.
#
# Expected: flattening a scene graph leaves every vertex where it was, for it only takes parents away; what a node cannot
#   express, a shear, is kept under its parent, put into the vertices, or warned of. Source: documentation of `flatten`, which
#   speaks of the graph alone; glTF 2.0, 3.5.3: a node's own matrix has no shear, but the product of a rotated child and a
#   stretched parent may.
# Seen: a child turned by 45 degrees under a parent of scale 2 1 1 is given a matrix of rotation and scale near to the
#   product. Its corner (1, 0, 0), which was at (1.414, 0.707), is at (1.155, 1.061). Nothing is logged at the level WARN. The
#   project's issue 1680 tells of it since July 2025.
# Hurts: `gltf-transform optimize` flattens unless told not to: wheels, doors and props of stretched groups lean or no longer
#   fit, and shadows and lightmaps with them.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init --yes >/dev/null
npm install --silent --no-audit --no-fund @gltf-transform/core@4.5.1 @gltf-transform/functions@4.5.1
cat >probe.mjs <<'JS'
import { Document, Logger } from '@gltf-transform/core';
import { flatten } from '@gltf-transform/functions';
const document = new Document();
const words = [];
const hear = (text) => words.push(text);
const logger = new Logger(Logger.Verbosity.WARN);
logger.warn = logger.error = hear;
document.setLogger(logger);
const corners = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]);
const positions = document.createAccessor().setType('VEC3').setArray(corners).setBuffer(document.createBuffer());
const mesh = document.createMesh().addPrimitive(document.createPrimitive().setAttribute('POSITION', positions));
const child = document.createNode('child').setRotation([0, 0, Math.sin(Math.PI / 8), Math.cos(Math.PI / 8)]).setMesh(mesh);
const parent = document.createNode('parent').setScale([2, 1, 1]).addChild(child);
document.createScene().addChild(parent);
const corner = () => child.getWorldMatrix().slice(0, 2).map((v) => Number(v.toFixed(3)));
const before = corner();
await document.transform(flatten());
const after = corner();
console.log(`corner before ${before}, after ${after}; parent of the child: ${child.getParentNode()?.getName()}; logged: ${words.length}`);
const same = `${before}` === '1.414,0.707' && `${after}` === '1.155,1.061' && words.length === 0;
console.log(same ? 'as described' : 'CHANGED: flatten keeps places, or says something');
process.exit(same ? 0 : 1);
JS
node probe.mjs
