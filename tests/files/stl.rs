//! STL, in text and in binary.

use super::support::{Folder, corners, load_one};
use glam::Vec3;

/// A tetrahedron.
const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

fn text() -> String {
    let vertex = |i: &usize| format!("      vertex {:e} {} {:.3}\n", CORNERS[*i][0], CORNERS[*i][1], CORNERS[*i][2]);
    let facet = |face: &[usize; 3]| {
        let vertices: String = face.iter().map(vertex).collect();
        format!("  facet normal 0 0 0\n    outer loop\n{vertices}    endloop\n  endfacet\n")
    };
    let facets: String = FACES.iter().map(facet).collect();
    format!("solid my part\n{facets}endsolid my part\n")
}

fn binary(title: &[u8], attribute: [u8; 2]) -> Vec<u8> {
    let mut bytes = vec![0u8; 80];
    bytes[..title.len()].copy_from_slice(title);
    bytes.extend(4u32.to_le_bytes());
    for face in FACES {
        bytes.extend([0u8; 12]);
        face.iter().for_each(|i| bytes.extend(CORNERS[*i].iter().flat_map(|v| v.to_le_bytes())));
        bytes.extend(attribute);
    }
    bytes
}

#[test]
fn text_and_binary_are_the_same_mesh() {
    let expected: Vec<Vec3> = FACES.iter().flatten().map(|i| Vec3::from_array(CORNERS[*i])).collect();
    let forms = [
        text().into_bytes(),
        text().replace('\n', "\r\n").into_bytes(),
        text().replace('\n', "\r").to_uppercase().into_bytes(),
        text().replace("solid my part", "solid").into_bytes(),
        format!("{}{}", "solid a\nendsolid a\n", text()).into_bytes(),
        binary(b"", [0, 0]),
        // Some writers of binary files begin them as text begins.
        binary(b"solid of exporter", [0, 0]),
    ];
    for bytes in forms {
        let scene = load_one("part.stl", &bytes);
        assert_eq!(corners(&scene.meshes[0]), expected);
        assert_eq!((scene.meshes[0].name.as_str(), scene.warnings.len()), ("part", 0), "{:?}", scene.warnings);
        // Four corners in space; the edges are sharp.
        let mesh = &scene.meshes[0];
        assert_eq!((mesh.positions.len(), mesh.normals.len()), (12, 12));
        let [a, b, c] = mesh.triangles[3].map(|i| mesh.normals[i as usize]);
        assert!(a == b && b == c && (a - Vec3::ONE.normalize()).length() < 1e-6, "{a}");
    }
    assert_eq!(load_one("PART.STL", text()).objects[0].name, "PART");
}

#[test]
fn round_parts_are_smooth() {
    // A fan that bends by a few degrees.
    let mut bytes = vec![0u8; 80];
    bytes.extend(12u32.to_le_bytes());
    let rim = |i: usize| {
        let (s, c) = (std::f32::consts::TAU * i as f32 / 12.0).sin_cos();
        [c, s, 0.1 * (i % 2) as f32]
    };
    for i in 0..12 {
        bytes.extend([0u8; 12]);
        // -0 and 0 are one place.
        let middle = [if i % 2 == 0 { 0.0 } else { -0.0 }, 0.0, 0.2];
        [middle, rim(i), rim((i + 1) % 12)].as_flattened().iter().for_each(|v| bytes.extend(v.to_le_bytes()));
        bytes.extend([0u8; 2]);
    }
    let mesh = &load_one("a.stl", bytes).meshes[0];
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (13, 12));
}

#[test]
fn what_is_not_used_is_said() {
    for bytes in [binary(b"COLOR=abcd", [0, 0]), binary(b"", [31, 128])] {
        let scene = load_one("a.stl", bytes);
        assert!(scene.warnings.len() == 1 && scene.warnings[0].ends_with("a.stl: ignored: colours of triangles"));
    }
    let scene = load_one("a.stl", [&binary(b"", [0, 0])[..], b"tail"].concat());
    assert!(scene.warnings[0].ends_with("a.stl: ignored: 4 bytes after the last triangle"), "{:?}", scene.warnings);
    let point = text().replacen("vertex 1e0", "vertex 0e0", 1);
    let scene = load_one("a.stl", point);
    assert!(scene.warnings[0].ends_with("triangles with a repeated corner left out: 1"), "{:?}", scene.warnings);
    assert_eq!(scene.meshes[0].triangles.len(), 3);
}

#[test]
fn broken_files_are_refused_at_their_place() {
    let change = |from: &str, to: &str| text().replacen(from, to, 1).into_bytes();
    let whole = binary(b"", [0, 0]);
    let mut endless = whole.clone();
    endless[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut infinite = whole.clone();
    infinite[84 + 50 + 12..84 + 50 + 16].copy_from_slice(&f32::INFINITY.to_le_bytes());
    let cases = [
        (Vec::new(), "a.stl: not an STL file"),
        (b"hello".to_vec(), "a.stl: not an STL file"),
        (b"solid\nendsolid\n".to_vec(), "a.stl: the file has no triangles"),
        (change("vertex 0e0", "vertex x"), "a.stl:4: expected a number, found \"x\""),
        (change("vertex 0e0 0 0.000", "vertex 0 0"), "a.stl:4: expected a number, found \"\""),
        (change("vertex 0e0", "vertex nan"), "a.stl:7: the corner"),
        (change("endloop", "vertex 0 0 1\nendloop"), "a.stl:8: a facet has three corners, found 4"),
        (change("outer loop", "hello"), "a.stl:3: expected the next part of a facet, found \"hello\""),
        (b"solid\nfacet\nouter loop\nvertex 0 0 0\n".to_vec(), "a.stl:4: the file ends within a facet"),
        (whole[..whole.len() - 1].to_vec(), "a.stl: claims 4 triangles, but only 199 bytes follow, 50 for each"),
        (endless, "a.stl: claims 4294967295 triangles"),
        (infinite, "a.stl: triangle 1 of 4: the corner"),
    ];
    for (bytes, expected) in cases {
        let message = Folder::new(&[("a.stl", &bytes)]).refused("a.stl");
        assert!(message.starts_with(expected), "{message}, expected {expected}");
    }
}

#[test]
fn files_cut_off_or_changed_anywhere_never_panic() {
    let folder = Folder::new(&[]);
    for good in [text().into_bytes(), binary(b"solid", [0, 0])] {
        for at in (0..good.len()).step_by(3) {
            folder.file("a.stl", &good[..at]);
            let _ = folder.try_load("a.stl");
            for value in [0, b' ', b'9', 0xff] {
                let mut changed = good.clone();
                changed[at] = value;
                folder.file("a.stl", &changed);
                let _ = folder.try_load("a.stl");
            }
        }
    }
}
