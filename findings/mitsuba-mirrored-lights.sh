#!/usr/bin/env bash
# Mitsuba (PyPI mitsuba 3.9.1): whether mirroring an area light turns it off depends on the shape that carries it.
#
# Expected: a scale of -1 along an axis of a lamp's own plane leaves the lamp as it looks; what faced the floor still does,
#   for each kind of shape alike. Source: Mitsuba's documentation of the emitter `area` (light leaves on the side of the
#   normal) and of shapes, where to_world is any affine map; a normal is mapped by the inverse transpose, which a mirror in
#   the plane leaves alone.
# Seen: one square lamp over a white floor, mirrored along x. As `rectangle`, and as OBJ with normals, it lights the floor as
#   before; as the same OBJ without normals it lights the ceiling. A sphere of scale -1 along x shines inwards and lights
#   nothing. A mirrored rectangle has a geometric normal of -z beside a shading normal of +z.
# Hurts: a room whose right half is its mirrored left half has half its lamps off, and adding normals to a mesh turns them on.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check mitsuba==3.9.1 numpy==2.4.6
venv/bin/python - <<'PY'
import mitsuba
import numpy as np

mitsuba.set_variant("scalar_rgb")
mitsuba.set_log_level(mitsuba.LogLevel.Error)
Transform = mitsuba.ScalarTransform4f

corners = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
open("plain.obj", "w").write(corners + "f 1 2 3\nf 1 3 4\n")
open("normals.obj", "w").write(corners + "vn 0 0 1\nf 1//1 2//1 3//1\nf 1//1 3//1 4//1\n")
shapes = {
    "rectangle": {"type": "rectangle"},
    "disk": {"type": "disk"},
    "OBJ, normals": {"type": "obj", "filename": "normals.obj"},
    "OBJ, none": {"type": "obj", "filename": "plain.obj"},
    "sphere": {"type": "sphere"},
}


def floor_under(shape, mirror):
    """Light of one pixel of a white floor under a lamp that faces down."""
    down = Transform().rotate([1, 0, 0], 180).scale([-0.5 if mirror else 0.5, 0.5, 0.5])
    radiance = {"type": "area", "radiance": {"type": "rgb", "value": 1.0}}
    view = Transform().look_at([3, 0, 0.5], [0, 0, -1], [0, 0, 1])
    film = {"type": "hdrfilm", "width": 1, "height": 1, "rfilter": {"type": "box"}}
    scene = {
        "type": "scene",
        "integrator": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 1},
        "sensor": {"type": "perspective", "fov": 1, "to_world": view, "film": film},
        "floor": {"type": "rectangle", "to_world": Transform().translate([0, 0, -1]).scale(5)},
        "lamp": {**shape, "to_world": down, "emitter": radiance},
    }
    return float(np.array(mitsuba.render(mitsuba.load_dict(scene), spp=1024)).ravel()[0])


seen = {}
for name, shape in shapes.items():
    before, after = floor_under(shape, False), floor_under(shape, True)
    print(f"{name}: {before:.3f} before, {after:.3f} mirrored")
    assert before > 0.05
    seen[name] = after > 0.05
same = seen == {"rectangle": True, "disk": True, "OBJ, normals": True, "OBJ, none": False, "sphere": False}
print("as described" if same else "CHANGED: mirrored lamps shine otherwise")
raise SystemExit(not same)
PY
