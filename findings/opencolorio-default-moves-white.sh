#!/usr/bin/env bash
# OpenColorIO (PyPI opencolorio 2.6.0): the default CPU processor raises 1 to the power of 2.2 and gets 1.00002.
#
# Expected: 1 to any power is 1 and the logarithm of 1 is 0, exactly, as the transforms are defined and as their inverse
#   needs. Source: OpenColorIO's documentation of ExponentTransform and LogTransform (formulas), which name no error; that the
#   default may approximate stands with the flag OPTIMIZATION_FAST_LOG_EXP_POW alone; IEEE 754-2019, 9.2.1: pow(1, y) is 1.
# Seen: with the default optimisation 1 becomes 1.0000223 and log2(1) is 1.29e-5, relative errors reach 2.5e-5, 200 times the
#   spacing of floats. With OPTIMIZATION_LOSSLESS or OPTIMIZATION_NONE both are exact.
# Hurts: white leaves the range of 0 to 1, so that searches for clipping find the whole sky; a golden picture made with the
#   default fails a threshold of 1e-6 against any other tool.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check opencolorio==2.6.0 numpy==2.4.6
venv/bin/python - <<'PY'
import numpy as np
import PyOpenColorIO as ocio


def run(transform, value, flags):
    processor = ocio.Config.CreateRaw().getProcessor(transform)
    cpu = processor.getDefaultCPUProcessor() if flags is None else processor.getOptimizedCPUProcessor(flags)
    return cpu.applyRGB([value] * 3)[0]


power, log2 = ocio.ExponentTransform(value=[2.2, 2.2, 2.2, 1.0]), ocio.LogTransform(base=2.0)
seen = {}
for name, flags in (("default", None), ("lossless", ocio.OPTIMIZATION_LOSSLESS), ("none", ocio.OPTIMIZATION_NONE)):
    seen[name] = run(power, 1.0, flags), run(log2, 1.0, flags)
    print(f"{name}: 1 to the 2.2 is {seen[name][0]:.9f}, log2(1) is {seen[name][1]:.3e}")
same = abs(seen["default"][0] - 1.0000223) < 1e-6 and abs(seen["default"][1] - 1.29e-5) < 1e-6
same &= all(seen[name][0] == 1 and abs(seen[name][1]) < 1e-9 for name in ("lossless", "none"))
print("as described" if same else "CHANGED: the default is exact, or the others are not")
raise SystemExit(not same)
PY
