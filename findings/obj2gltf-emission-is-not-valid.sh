#!/usr/bin/env bash
# obj2gltf (npm 3.2.0): a lamp in an OBJ makes a glTF file that is not valid.
#
# Expected: Ke above 1 becomes an emissiveFactor of at most 1 and a KHR_materials_emissive_strength. Source: glTF 2.0, schema
#   of material: each component of emissiveFactor is in 0 to 1; KHR_materials_emissive_strength was made for brighter lamps.
# Seen: Ke 2 3 4 is copied into emissiveFactor. gltf-validator (npm 2.0.0-dev.3.10) reports three errors, VALUE_NOT_IN_RANGE,
#   one a channel.
# Hurts: strict loaders refuse the scene, others cut the lamp to 1 1 1, and only the rest show it as meant; its colour changes
#   too.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init --yes >/dev/null
npm install --silent --no-audit --no-fund obj2gltf@3.2.0 gltf-validator@2.0.0-dev.3.10 2>/dev/null
printf 'newmtl lamp\nKd 0 0 0\nKe 2 3 4\n' >lamp.mtl
printf 'mtllib lamp.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nusemtl lamp\nf 1//1 2//1 3//1\n' >lamp.obj
node_modules/.bin/obj2gltf -i lamp.obj -o lamp.gltf >/dev/null
cat >probe.mjs <<'JS'
import fs from 'fs';
import validator from 'gltf-validator';
const bytes = fs.readFileSync('lamp.gltf');
const [material] = JSON.parse(bytes).materials;
const report = await validator.validateBytes(new Uint8Array(bytes));
const errors = report.issues.messages.filter((m) => m.severity === 0).map((m) => `${m.code} ${m.pointer}`);
console.log(JSON.stringify(material.emissiveFactor), JSON.stringify(material.extensions), errors);
const same = `${material.emissiveFactor}` === '2,3,4' && errors.filter((e) => e.startsWith('VALUE_NOT_IN_RANGE')).length === 3;
console.log(same ? 'as described' : 'CHANGED: emission is converted otherwise');
process.exit(same ? 0 : 1);
JS
node probe.mjs
