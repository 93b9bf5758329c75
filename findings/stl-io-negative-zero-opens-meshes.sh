#!/usr/bin/env bash
# stl_io (crate 0.11.0): a closed mesh has holes where one facet writes 0 and its neighbour -0.
#
# Expected: 0 and -0 are equal, so corners at both are one vertex. Source: IEEE 754-2019, 5.11; docs.rs, stl_io: `read_stl`
#   gives an `IndexedMesh` of shared vertices, and `validate` checks that all edges meet a neighbour. Rotations and mirrors
#   leave -0 in files all the time.
# Seen: a tetrahedron, one corner of which is (0, 0, 0) in three facets and (-0, 0, 0) in the fourth, has 5 vertices, and
#   `validate` refuses it. With 0 throughout it has 4 vertices and passes.
# Hurts: a watertight part counts as broken, and normals that are averaged over shared vertices show a seam.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cargo init --quiet --name probe
cat >>Cargo.toml <<'TOML'
stl_io = "=0.11.0"
TOML
cat >src/main.rs <<'RUST'
use std::io::Cursor;
use stl_io::{Normal, Triangle, Vertex, read_stl, write_stl};

/// Number of vertices of a tetrahedron read back, and whether it counts as closed. The last facet has `origin` as x of its corner.
fn trip(origin: f32) -> (usize, bool) {
    let o = |x| [x, 0.0, 0.0];
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let facets = [[x, y, z], [o(0.0), y, x], [o(0.0), z, y], [o(origin), x, z]];
    let normal = Normal::new([0.0, 0.0, 1.0]);
    let triangles = facets.map(|corners| Triangle { normal, vertices: corners.map(Vertex::new) });
    let mut file = Vec::new();
    write_stl(&mut file, triangles.iter()).unwrap();
    let mesh = read_stl(&mut Cursor::new(file)).unwrap();
    (mesh.vertices.len(), mesh.validate().is_ok())
}

fn main() {
    let (plain, negative) = (trip(0.0), trip(-0.0));
    println!("vertices, closed: {plain:?} with 0, {negative:?} with -0");
    let same = plain == (4, true) && negative == (5, false);
    println!("{}", if same { "as described" } else { "CHANGED: zeros are merged, or closedness means another thing" });
    std::process::exit(i32::from(!same));
}
RUST
cargo run --quiet --release
