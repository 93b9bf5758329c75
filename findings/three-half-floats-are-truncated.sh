#!/usr/bin/env bash
# three.js (npm three 0.187.0): DataUtils.toHalfFloat cuts digits off instead of rounding, and makes infinities finite.
#
# Expected: a conversion to half precision rounds to nearest, ties to even, and keeps infinities. Source: IEEE 754-2019,
#   4.3.1 (default rounding) and 5.4.2 (conversions); Imath's `half`, which OpenEXR uses, does so. The documentation of three
#   says only "returns a half precision floating point value from the given single precision".
# Seen: the last bits are dropped, so each value moves towards zero by up to a whole step: 1 + 15/16 of a step becomes 1. Over
#   an even ramp from 0.1 to 1 the mean falls by 0.034 %, where rounding would keep it. Infinity becomes 65504, and the largest
#   values below the smallest subnormal become 0 rather than that subnormal.
# Hurts: EXRExporter and every texture that is made half precision by this function is darker than its source, always in
#   the same direction, so that averaging more samples does not help, and two exports of equal light differ from other tools.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init --yes >/dev/null
npm install --silent --no-audit --no-fund three@0.187.0
cat >probe.mjs <<'JS'
import { DataUtils } from 'three';
const { fromHalfFloat, toHalfFloat } = DataUtils;
console.warn = () => {};
const back = (x) => fromHalfFloat(toHalfFloat(x));
const almost = 1 + 15 / 16 / 1024; // nearest halves: 1 and 1 + 1/1024; the second is fifteen times as near
const tiny = 0.9 * 2 ** -24; // nearest halves: 0 and 2^-24, the smallest subnormal
let mean = 0;
const count = 90000;
for (let i = 0; i < count; i++) {
  const x = 0.1 + (0.9 * i) / count;
  mean += back(x) / x / count;
}
console.log({ almost: back(almost), tiny: back(tiny), infinity: back(Infinity), mean });
const same = back(almost) === 1 && back(tiny) === 0 && back(Infinity) === 65504 && Math.abs(mean - 0.99966) < 2e-5;
console.log(same ? 'as described' : 'CHANGED: toHalfFloat rounds otherwise');
process.exit(same ? 0 : 1);
JS
node probe.mjs
