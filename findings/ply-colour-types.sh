#!/usr/bin/env bash
# trimesh (PyPI 5.2.0), VTK 9.7.2, MeshLab (pymeshlab 2025.7.post1), Mitsuba 3.9.1: the colour of a PLY file depends on the
# type that stores it.
#
# Expected: one colour is read alike as bytes 255 128 64, as ushort 65535 32768 16384 and as float 1 0.5 0.25, or a reader
#   refuses what it does not know. Source: Greg Turk, "The PLY Polygon File Format" (1994): a property may have any scalar
#   type. Blender and Open3D write bytes, Mitsuba and point cloud tools floats or ushort.
# Seen: bytes are right but in Mitsuba, which makes 255 of them, with a warning. ushort: trimesh and VTK keep the low byte
#   (255 0 0), MeshLab has no colour, and Mitsuba decodes sRGB (1 0.214 0.051), though it does so with neither bytes nor
#   floats. float: right in trimesh and Mitsuba; VTK cuts off to 1 0 0 of 255, which is black; MeshLab has no colour.
# Hurts: the same scan is black, red, colourless, blinding or too dark, depending on one word of its header.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check trimesh==5.2.0 pyvista==0.49.2 vtk==9.7.2 pymeshlab==2025.7.post1 \
    mitsuba==3.9.1 numpy==2.4.6
venv/bin/python - <<'PY'
import mitsuba
import numpy as np
import pymeshlab
import pyvista
import trimesh

mitsuba.set_variant("scalar_rgb")
mitsuba.set_log_level(mitsuba.LogLevel.Error)


def write(name, ply_type, numpy_type, colour):
    """A triangle of one colour."""
    axes = "".join(f"property float {axis}\n" for axis in "xyz")
    axes += "".join(f"property {ply_type} {channel}\n" for channel in ("red", "green", "blue"))
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex 3\n{axes}element face 1\n"
    body = b"".join(np.array(p, "<f4").tobytes() + np.array(colour, numpy_type).tobytes() for p in np.eye(3))
    face = b"\3" + np.arange(3, dtype="<i4").tobytes()
    open(name, "wb").write(header.encode() + b"property list uchar int vertex_indices\nend_header\n" + body + face)


def by_trimesh(name):
    return trimesh.load(name, process=False).visual.vertex_colors[0, :3].tolist()


def by_vtk(name):
    return pyvista.read(name)["RGB"][0].tolist()


def by_meshlab(name):
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(name)
    mesh = meshes.current_mesh()
    return (mesh.vertex_color_matrix()[0, :3] * 255).round().tolist() if mesh.has_vertex_color() else None


def by_mitsuba(name):
    colours = mitsuba.traverse(mitsuba.load_dict({"type": "ply", "filename": name}))["vertex_color"]
    return np.array(colours).ravel()[:3].round(3).tolist()


cases = {"uchar": ("u1", [255, 128, 64]), "ushort": ("<u2", [65535, 32768, 16384]), "float": ("<f4", [1, 0.5, 0.25])}
expected = {
    "uchar": [[255, 128, 64], [255, 128, 64], [255, 128, 64], [255, 128, 64]],
    "ushort": [[255, 0, 0], [255, 0, 0], None, [1, 0.214, 0.051]],
    "float": [[255, 128, 64], [1, 0, 0], None, [1, 0.5, 0.25]],
}
same = True
for ply_type, (numpy_type, colour) in cases.items():
    name = f"{ply_type}.ply"
    write(name, ply_type, numpy_type, colour)
    seen = [read(name) for read in (by_trimesh, by_vtk, by_meshlab, by_mitsuba)]
    print(f"{ply_type} {colour}: trimesh {seen[0]}, VTK {seen[1]}, MeshLab {seen[2]}, Mitsuba {seen[3]}")
    for got, wanted in zip(seen, expected[ply_type]):
        same &= got is wanted is None or (got is not None and wanted is not None and np.allclose(got, wanted, atol=2e-3))
print("as described" if same else "CHANGED: some reader takes some type otherwise")
raise SystemExit(not same)
PY
