#!/usr/bin/env bash
# three.js (npm three 0.187.0): GLTFExporter turns back-sided surfaces to the front in silence, loses emissiveIntensity, and
# writes factors that are not valid.
#
# Expected: a surface of which only the back is drawn (`BackSide`, a room or a sky box) is exported with its triangles
#   reversed, or with a warning; emission is colour times intensity for each material that has it; factors stay in 0 to 1.
#   Source: three's documentation of `Material.side` and `MeshPhongMaterial.emissiveIntensity`; glTF 2.0, schemas of material
#   and pbrMetallicRoughness; KHR_materials_emissive_strength for what is brighter.
# Seen: a material of BackSide is exported as one of FrontSide, triangles as they were, and no warning speaks of it. A Phong
#   material of emission 0.5 and intensity 5 is exported with 0.5 and no strength. A physical material of emission 2 and
#   colour 2 is written with these factors, and gltf-validator (npm 2.0.0-dev.3.10) reports VALUE_NOT_IN_RANGE.
# Hurts: a room seen from inside is empty after export, its lamps give a fifth of their light, and strict loaders refuse the
#   file.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init --yes >/dev/null
npm install --silent --no-audit --no-fund three@0.187.0 gltf-validator@2.0.0-dev.3.10
cat >probe.mjs <<'JS'
// The exporter encodes buffers with a browser's FileReader.
globalThis.FileReader = class {
  readAsDataURL(blob) {
    blob.arrayBuffer().then((bytes) => {
      this.result = `data:application/octet-stream;base64,${Buffer.from(bytes).toString('base64')}`;
      this.onloadend();
    });
  }
};
const { BackSide, BufferAttribute, BufferGeometry, Color, Mesh, MeshPhongMaterial, MeshPhysicalMaterial, Scene } = await import('three');
const { GLTFExporter } = await import('three/addons/exporters/GLTFExporter.js');
const { default: validator } = await import('gltf-validator');
const warnings = [];
console.warn = (...words) => warnings.push(words.join(' '));
const corners = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]);
const geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(corners, 3));
const scene = new Scene();
const half = new Color().setRGB(0.5, 0.5, 0.5);
const two = new Color().setRGB(2, 2, 2);
scene.add(new Mesh(geometry, new MeshPhysicalMaterial({ name: 'back', side: BackSide })));
scene.add(new Mesh(geometry, new MeshPhongMaterial({ name: 'phong', emissive: half, emissiveIntensity: 5 })));
scene.add(new Mesh(geometry, new MeshPhysicalMaterial({ name: 'bright', emissive: two, color: two })));
const gltf = await new GLTFExporter().parseAsync(scene, {});
const [back, phong, bright] = gltf.materials;
const stored = Buffer.from(gltf.buffers[0].uri.split(',')[1], 'base64');
const { bufferView } = gltf.accessors[gltf.meshes[0].primitives[0].attributes.POSITION];
const order = [...new Float32Array(stored.buffer.slice(stored.byteOffset + (gltf.bufferViews[bufferView].byteOffset ?? 0)), 0, 9)];
const reversed = order.join() !== corners.join() || 'indices' in gltf.meshes[0].primitives[0];
const report = await validator.validateString(JSON.stringify(gltf));
const errors = report.issues.messages.filter((m) => m.severity === 0 && m.code === 'VALUE_NOT_IN_RANGE').length;
for (const [name, value] of Object.entries({ back, phong, bright, reversed, errors, warnings })) console.log(name, JSON.stringify(value));
const same = !reversed && !('doubleSided' in back) && !warnings.some((w) => /side/i.test(w)) &&
  phong.emissiveFactor[0] === 0.5 && !phong.extensions && bright.emissiveFactor[0] === 2 && errors >= 6;
console.log(same ? 'as described' : 'CHANGED: sides, intensities or factors are exported otherwise');
process.exit(same ? 0 : 1);
JS
node probe.mjs
