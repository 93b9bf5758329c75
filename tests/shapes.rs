//! Named shapes: closed where they should be, the right way out, the right size, uvs in range.

#[path = "common/assets.rs"]
mod assets;

use assets::asset;
use glam::{DVec3, Vec3};
use gonio::scene::Mesh;
use gonio::scene::shape::{
    HeightGrid, Profile, ProfileKind, TEAPOT_PATCHES, cone, cuboid, cylinder, disk, fractal_heights, height_field,
    lathe, polar_disk, quad, sphere_mesh, teapot, teapot_control_points, torus,
};
use std::collections::HashMap;
use std::f64::consts::PI;

fn corners(mesh: &Mesh, face: usize) -> [DVec3; 3] {
    mesh.triangles[face].map(|i| mesh.positions[i as usize].as_dvec3())
}

fn area(mesh: &Mesh) -> f64 {
    (0..mesh.triangles.len())
        .map(|f| {
            let [a, b, c] = corners(mesh, f);
            (b - a).cross(c - a).length() * 0.5
        })
        .sum()
}

/// By the divergence theorem; positive where triangles are counter-clockwise seen from outside.
fn volume(mesh: &Mesh) -> f64 {
    (0..mesh.triangles.len())
        .map(|f| {
            let [a, b, c] = corners(mesh, f);
            a.dot(b.cross(c)) / 6.0
        })
        .sum()
}

/// Each directed edge between welded positions, and how often it occurs.
fn directed_edges(mesh: &Mesh) -> HashMap<([u32; 3], [u32; 3]), usize> {
    let key = |i: u32| mesh.positions[i as usize].to_array().map(f32::to_bits);
    let mut edges = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((key(from), key(to))).or_insert(0) += 1;
        }
    }
    edges
}

/// Edges that lack their twin in the other direction.
fn open_edges(mesh: &Mesh) -> Vec<([u32; 3], [u32; 3])> {
    let edges = directed_edges(mesh);
    assert!(edges.values().all(|n| *n == 1), "{}: an edge is used twice in one direction", mesh.name);
    edges.keys().filter(|(a, b)| !edges.contains_key(&(*b, *a))).copied().collect()
}

/// What every shape promises, closed or not.
fn check(mesh: &Mesh) {
    let n = mesh.positions.len();
    assert!(!mesh.triangles.is_empty() && mesh.normals.len() == n && mesh.uvs.len() == n, "{}", mesh.name);
    let mut used = vec![false; n];
    for (f, triangle) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = corners(mesh, f);
        let face = (b - a).cross(c - a);
        for &i in triangle {
            used[i as usize] = true;
            let normal = mesh.normals[i as usize].as_dvec3();
            assert!((normal.length() - 1.0).abs() < 1e-6, "{} normal {normal}", mesh.name);
            assert!(normal.dot(face) > 0.0, "{} face {f}: normal {normal} against {face}", mesh.name);
            let uv = mesh.uvs[i as usize];
            assert!(uv.min_element() >= 0.0 && uv.max_element() <= 1.0, "{} uv {uv}", mesh.name);
        }
    }
    assert!(used.iter().all(|u| *u), "{} has unused vertices", mesh.name);
}

fn check_closed(mesh: &Mesh, area_expected: f64, volume_expected: f64) {
    check(mesh);
    assert_eq!(open_edges(mesh).len(), 0, "{} is not watertight", mesh.name);
    let (a, v) = (area(mesh), volume(mesh));
    assert!((a / area_expected - 1.0).abs() < 0.01, "{}: area {a}, expected {area_expected}", mesh.name);
    assert!((v / volume_expected - 1.0).abs() < 0.01, "{}: volume {v}, expected {volume_expected}", mesh.name);
}

fn vessel(kind: ProfileKind) -> Profile {
    let points = vec![[0.0, 0.0], [1.0, 0.0], [1.5, 1.0], [1.2, 2.0], [1.1, 2.0], [1.4, 1.0], [0.9, 0.1], [0.0, 0.1]];
    Profile { points, kind, steps: 8, crease: 0.5 }
}

#[test]
fn closed_shapes_are_watertight_and_have_the_area_and_volume_of_their_closed_form() {
    check_closed(&cuboid([1.0, 2.0, 3.0], 1), 22.0, 6.0);
    check_closed(&cuboid([0.1, 0.7, 0.3], 5), 2.0 * (0.07 + 0.21 + 0.03), 0.021);
    check_closed(&sphere_mesh(2.0, 96), 16.0 * PI, 32.0 / 3.0 * PI);
    check_closed(&cylinder(0.5, 3.0, true, 96), 3.0 * PI + 0.5 * PI, 0.75 * PI);
    check_closed(&cone(1.5, 2.0, true, 96), 1.5 * PI * (2.5 + 1.5), 1.5 * PI);
    check_closed(&torus(2.0, 0.5, 96, 64), 4.0 * PI * PI, PI * PI);
}

#[test]
fn coarsest_closed_shapes_are_watertight() {
    for mesh in [sphere_mesh(1.0, 3), cylinder(1.0, 1.0, true, 3), cone(1.0, 1.0, true, 3), torus(1.0, 0.3, 3, 3)] {
        check(&mesh);
        assert_eq!(open_edges(&mesh).len(), 0, "{}", mesh.name);
        assert!(volume(&mesh) > 0.0);
    }
}

#[test]
fn open_shapes_have_their_area_and_face_up() {
    let cases = [(quad([2.0, 3.0], 4), 6.0), (disk(2.0, 128), 4.0 * PI), (polar_disk(2.0, 128), 4.0 * PI)];
    for (mesh, expected) in cases {
        check(&mesh);
        assert!((area(&mesh) / expected - 1.0).abs() < 0.01);
        assert!(mesh.normals.iter().all(|n| *n == Vec3::Y) && mesh.positions.iter().all(|p| p.y == 0.0));
    }
    check(&cylinder(1.0, 1.0, false, 12));
    assert_eq!(open_edges(&cylinder(1.0, 1.0, false, 12)).len(), 24);
    assert_eq!(open_edges(&cone(1.0, 1.0, false, 12)).len(), 12);
}

#[test]
fn quad_carries_an_image_as_it_lies_seen_from_above() {
    let mesh = quad([2.0, 2.0], 1);
    let uv_at = |x: f32, z: f32| {
        let i = mesh.positions.iter().position(|p| *p == Vec3::new(x, 0.0, z)).expect("a corner");
        mesh.uvs[i].to_array()
    };
    assert_eq!(uv_at(-1.0, 1.0), [0.0, 0.0]);
    assert_eq!(uv_at(1.0, -1.0), [1.0, 1.0]);
    assert_eq!(uv_at(1.0, 1.0), [1.0, 0.0]);
}

#[test]
fn sphere_vertices_lie_on_the_sphere_with_its_normals() {
    let mesh = sphere_mesh(3.0, 24);
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        assert!((p.as_dvec3().length() - 3.0).abs() < 1e-6 && (*p / 3.0 - *n).length() < 1e-6, "{p} {n}");
    }
}

#[test]
fn lathe_closes_a_vessel_and_rounds_or_creases_its_profile() {
    for kind in [ProfileKind::Smooth, ProfileKind::Polyline] {
        let mesh = lathe(&vessel(kind), 48).expect("a valid profile");
        check_closed(&mesh, area(&mesh), volume(&mesh));
        assert!(volume(&mesh) > 0.0, "{kind:?}");
    }
    // Straight pieces are frusta: pi/3 h (R^2 + R r + r^2), outside less inside.
    let frustum = |r0: f64, r1: f64, h: f64| PI / 3.0 * h * (r0 * r0 + r0 * r1 + r1 * r1);
    let solid = frustum(1.0, 1.5, 1.0) + frustum(1.5, 1.2, 1.0) - frustum(1.4, 1.1, 1.0) - frustum(0.9, 1.4, 0.9);
    let mesh = lathe(&vessel(ProfileKind::Polyline), 256).expect("a valid profile");
    assert!((volume(&mesh) / solid - 1.0).abs() < 0.001, "{} {solid}", volume(&mesh));
}

#[test]
fn lathe_through_points_of_a_semicircle_is_nearly_a_sphere() {
    let points =
        (0..=8).map(|i| (i, PI * f64::from(i) / 8.0)).map(|(i, t)| [if i == 8 { 0.0 } else { t.sin() }, -t.cos()]);
    let profile = Profile { points: points.collect(), kind: ProfileKind::Smooth, steps: 8, crease: 0.0 };
    let mesh = lathe(&profile, 64).expect("a valid profile");
    check_closed(&mesh, 4.0 * PI, 4.0 / 3.0 * PI);
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        assert!((p.length() - 1.0).abs() < 0.02 && p.normalize().dot(*n) > 0.98, "{p} {n}");
    }
}

#[test]
fn lathe_refuses_bad_profiles_and_says_why() {
    let with = |points: Vec<[f64; 2]>| Profile { points, kind: ProfileKind::Smooth, steps: 4, crease: 0.0 };
    let cases = [
        (with(vec![[1.0, 0.0]]), "1 points"),
        (with(vec![[1.0, 0.0], [-0.5, 1.0]]), "point 1"),
        (with(vec![[1.0, 0.0], [f64::NAN, 1.0]]), "point 1"),
        (with(vec![[1.0, 0.0], [1.0, 0.0]]), "the same"),
        (with(vec![[0.0, 0.0], [0.0, 1.0]]), "all radii"),
        (Profile { steps: 0, ..with(vec![[1.0, 0.0], [1.0, 1.0]]) }, "0 steps"),
    ];
    for (profile, expected) in cases {
        let message = lathe(&profile, 8).expect_err("a bad profile");
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn teapot_has_thirty_two_patches_and_stands_on_the_ground() {
    let patches = teapot_control_points();
    assert_eq!(patches.len(), TEAPOT_PATCHES);
    let mut unique: Vec<[u64; 3]> =
        patches.as_flattened().as_flattened().iter().map(|p| (*p + DVec3::ZERO).to_array().map(f64::to_bits)).collect();
    unique.sort_unstable();
    unique.dedup();
    // Newell lists 306 points, of which 16 coincide with others.
    assert_eq!(unique.len(), 290);
    let mesh = teapot(8);
    check(&mesh);
    let low = mesh.positions.iter().copied().reduce(Vec3::min).expect("points");
    let high = mesh.positions.iter().copied().reduce(Vec3::max).expect("points");
    assert!((low - Vec3::new(-3.0, 0.0, -2.0)).abs().max_element() < 1e-6, "{low}");
    assert!((high - Vec3::new(3.434, 3.15, 2.0)).abs().max_element() < 2e-3, "{high}");
}

#[test]
fn teapot_patches_meet_without_cracks() {
    let mesh = teapot(6);
    let open = open_edges(&mesh);
    // Open rings: lid, inner rim, both ends of the handle, both of the spout; 4 or 2 patches of 6 edges around each.
    assert_eq!(open.len(), 2 * 24 + 4 * 12);
}

#[test]
fn teapot_faces_outwards_on_body_handle_spout_lid_and_bottom() {
    let mesh = teapot(6);
    let side = |p: &Vec3| p.x < -2.05 || (p.x > 2.6 && p.y < 2.3);
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        if side(p) {
            assert!(n.z * p.z >= 0.0, "{p} {n}");
        } else if p.y < 1e-6 {
            assert!(n.y < -0.99, "{p} {n}");
        } else if p.y > 3.149 {
            assert!(n.y > 0.99, "{p} {n}");
        } else if p.z.abs() > 0.7 && p.y < 2.3 && p.y > 0.2 {
            assert!(n.x * p.x + n.z * p.z > 0.0, "{p} {n}");
        }
    }
    assert!(mesh.positions.iter().filter(|p| side(p)).count() > 100);
}

/// Squared distance from `p` to a triangle (Ericson 2005, section 5.1.5).
fn distance_squared(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let on_segment = |a: DVec3, b: DVec3| {
        let t = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-300)).clamp(0.0, 1.0);
        (a + (b - a) * t - p).length_squared()
    };
    let n = (b - a).cross(c - a);
    let inside = [(a, b), (b, c), (c, a)].iter().all(|(u, v)| (*v - *u).cross(p - *u).dot(n) >= 0.0);
    if inside && n.length_squared() > 0.0 {
        return (p - a).dot(n).powi(2) / n.length_squared();
    }
    on_segment(a, b).min(on_segment(b, c)).min(on_segment(c, a))
}

#[test]
fn teapot_lies_within_a_fiftieth_of_the_published_mesh() {
    let Some(file) = asset("meshes/teapot.obj") else { return };
    let text = std::fs::read_to_string(file).expect("readable");
    let points = text.lines().filter_map(|l| l.strip_prefix("v ")).map(|l| {
        let mut numbers = l.split_whitespace().map(|t| t.parse::<f64>().expect("a number"));
        DVec3::from_array(std::array::from_fn(|_| numbers.next().expect("three numbers")))
    });
    let mesh = teapot(10);
    let faces: Vec<[DVec3; 3]> = (0..mesh.triangles.len()).map(|f| corners(&mesh, f)).collect();
    for p in points.step_by(13) {
        let nearest = faces.iter().map(|f| distance_squared(p, *f)).fold(f64::MAX, f64::min);
        assert!(nearest.sqrt() < 0.02, "{p} is {} away", nearest.sqrt());
    }
}

#[test]
fn height_field_of_a_plane_has_its_slope_and_of_a_file_of_the_wrong_size_is_refused() {
    let heights = (0..12).map(|i| (i % 4) as f32).collect();
    let grid = HeightGrid { columns: 4, rows: 3, heights };
    let mesh = height_field(&grid, [3.0, 2.0], 2.0).expect("a valid grid");
    check(&mesh);
    let expected = Vec3::new(-2.0, 1.0, 0.0).normalize();
    assert!(mesh.normals.iter().all(|n| (*n - expected).length() < 1e-6), "{:?}", mesh.normals);
    // The first row is an image's top, at -z.
    let top_left = mesh.positions.iter().position(|p| *p == Vec3::new(-1.5, 0.0, -1.0)).expect("a corner");
    assert_eq!(mesh.uvs[top_left].to_array(), [0.0, 1.0]);
    assert!(height_field(&HeightGrid { rows: 4, ..grid.clone() }, [1.0, 1.0], 1.0).is_err());
    assert!(height_field(&HeightGrid { heights: vec![f32::NAN; 12], ..grid }, [1.0, 1.0], 1.0).is_err());
}

#[test]
fn fractal_landscape_depends_on_its_seed_and_stays_in_range() {
    let heights = |seed| fractal_heights(65, 4.0, 6, 0.5, seed).heights;
    assert_eq!(heights(1), heights(1));
    assert_ne!(heights(1), heights(2));
    let h = heights(7);
    assert!(h.iter().all(|h| h.abs() < 2.0) && h.iter().any(|h| *h > 0.2) && h.iter().any(|h| *h < -0.2));
    // Continuous: neighbours differ little.
    assert!(h.windows(2).enumerate().all(|(i, w)| i % 65 == 64 || (w[0] - w[1]).abs() < 0.5));
    check(&height_field(&fractal_heights(33, 3.0, 5, 0.5, 3), [4.0, 4.0], 0.7).expect("a valid grid"));
}
