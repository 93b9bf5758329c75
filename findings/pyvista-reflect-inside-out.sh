#!/usr/bin/env bash
# PyVista (PyPI 0.49.2 with VTK 9.7.2): reflect and mirrored transforms turn a mesh inside out, and its stored normals say
# otherwise.
#
# Expected: a mirrored sphere is a sphere: its faces are seen from outside, and its volume is positive. Source: PyVista's
#   documentation of `reflect` and `transform`, which names no such change; VTK has vtkReverseSense to turn a mesh back.
# Seen: the order of corners is kept, so all faces point inwards. The point normals that the sphere brings are mirrored
#   rightly and still point outwards, so normals of faces and of points are opposite.
# Hurts: single-sided renderers and slicers show or print a hole, light leaks along shading normals that face away, and an STL
#   of it has its facets the wrong way round.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check pyvista==0.49.2 vtk==9.7.2 numpy==2.4.6
venv/bin/python - <<'PY'
import numpy as np
import pyvista

sphere = pyvista.Sphere(theta_resolution=16, phi_resolution=16)


def outwards(mesh):
    """Shares of faces, by their winding, and of stored point normals that point away from the centre."""
    corners = mesh.points[mesh.regular_faces]
    winding = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    faces = (winding * corners.mean(axis=1)).sum(axis=1) > 0
    points = (mesh.point_data["Normals"] * mesh.points).sum(axis=1) > 0
    return float(faces.mean()), float(points.mean())


mirrored = {
    "as made": sphere,
    "reflect": sphere.reflect((1, 0, 0), transform_all_input_vectors=True),
    "transform": sphere.transform(np.diag([-1.0, 1, 1, 1]), inplace=False),
}
seen = {name: outwards(mesh) for name, mesh in mirrored.items()}
for name, (faces, points) in seen.items():
    print(f"{name}: {faces:.0%} of the faces and {points:.0%} of the point normals point outwards")
same = seen == {"as made": (1, 1), "reflect": (0, 1), "transform": (0, 1)}
print("as described" if same else "CHANGED: mirrored meshes are turned otherwise")
raise SystemExit(not same)
PY
