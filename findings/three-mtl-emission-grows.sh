#!/usr/bin/env bash
# three.js (npm three 0.187.0): MTLLoader bends the colours of a material, and emission above 1 explodes.
#
# Expected: Kd, Ks and Ke are multipliers of light, so a lamp of Ke 4 4 4 shines twice as much as one of Ke 2 2 2. Source:
#   Alias|Wavefront, "File Formats" 4.2 (1995), "Material Library File (.mtl)",
#   where Kd is a share of reflected light, may leave the range of
#   0 to 1, and has no transfer function. tobj 4.0.5, bpy 5.0.1 and obj2gltf 3.2.0 take the numbers as they stand.
# Seen: three takes all of them for sRGB and decodes them, beyond 1 too. Kd 0.5 becomes 0.214, and Ke 2 3 4 becomes
#   4.95 12.8 25.3: the lamp of 4 is five times that of 2.
# Hurts: the same OBJ is darker in three, its lamps are brighter, and their colours shift, because channels grow unequally.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init --yes >/dev/null
npm install --silent --no-audit --no-fund three@0.187.0
cat >probe.mjs <<'JS'
import { MTLLoader } from 'three/addons/loaders/MTLLoader.js';
const library = new MTLLoader().parse('newmtl lamp\nKd 0.5 0.5 0.5\nKe 2 3 4\n', '');
library.preload();
const { color, emissive } = library.materials.lamp;
console.log('Kd 0.5 0.5 0.5 ->', color.toArray(), ' Ke 2 3 4 ->', emissive.toArray());
const near = (a, b) => Math.abs(a / b - 1) < 1e-3;
const same = near(color.r, 0.21404) && near(emissive.r, 4.9538) && near(emissive.g, 12.83) && near(emissive.b, 25.315);
console.log(same ? 'as described' : 'CHANGED: MTLLoader reads other colours');
process.exit(same ? 0 : 1);
JS
node probe.mjs
