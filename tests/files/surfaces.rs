//! What OBJ files say of their surfaces: smoothing groups, colours of vertices, and meshes of many faces around one point.

use super::support::{Folder, load_one, look, mean, near};
use glam::Vec3;
use gonio::scene::{Integrator, Rgb, Scene};
use std::fmt::Write;
use std::time::Instant;

/// A ridge of two planes that meet at 30 degrees at x = 0, in two halves: faces 0 and 1 below y = 0, 2 and 3 above.
fn ridge(faces: &str) -> Scene {
    let slope = 15.0f64.to_radians().tan();
    let mut text = String::new();
    for y in -1..=1 {
        for x in -1..=1 {
            writeln!(text, "v {x} {y} {:.7}", -slope * f64::from(i32::abs(x))).expect("a string");
        }
    }
    load_one("r.obj", text + faces)
}

/// The height of the normal at the corner of a face that lies at `x`, 1 for upright.
fn upright(scene: &Scene, face: usize, x: f32) -> f32 {
    let mesh = &scene.meshes[0];
    let corner = mesh.triangles[2 * face].iter().find(|v| mesh.positions[**v as usize].x == x).expect("a corner there");
    if mesh.normals.is_empty() { f32::NAN } else { mesh.normals[*corner as usize].z }
}

#[test]
fn faces_are_smooth_within_their_group_and_flat_outside_of_any() {
    let flat = 15.0f32.to_radians().cos();
    let low = ["f 1 2 5 4\n", "f 2 3 6 5\n"];
    let high = "f 4 5 8 7\nf 5 6 9 8\n";
    let cases = [
        format!("s 1\n{high}s off\n{}{}", low[0], low[1]),
        format!("s 1\n{high}s 2\n{}s 3\n{}", low[0], low[1]),
        format!("s off\n{}{}s 1\n{high}", low[0], low[1]),
        format!("s 5\n{high}s 0\n{}S OFF\n{}", low[0], low[1]),
        // Faces that said nothing come before all groups.
        format!("{high}s 1\n{}s 2\n{}", low[0], low[1]),
    ];
    for text in cases {
        let scene = ridge(&text);
        let first = text.find("f 4 5").expect("there");
        let (smooth, sharp) = if text.find("f 1 2").expect("there") < first { (2, 0) } else { (0, 2) };
        for face in [smooth, smooth + 1] {
            // Of three triangles there two may lie on one side.
            assert!(upright(&scene, face, 0.0) > 0.995, "{text}: {}", upright(&scene, face, 0.0));
        }
        for (face, x) in [(sharp, 0.0), (sharp, -1.0), (sharp + 1, 0.0), (sharp + 1, 1.0)] {
            assert!((upright(&scene, face, x) - flat).abs() < 1e-5, "{text}: {}", upright(&scene, face, x));
        }
    }
}

#[test]
fn a_group_is_smooth_over_edges_of_any_angle_and_a_file_without_groups_is_not() {
    // A roof of 90 degrees.
    let text = "v -1 0 0\nv -1 1 0\nv 0 0 1\nv 0 1 1\nv 1 0 0\nv 1 1 0\nf 1 3 4 2\nf 3 5 6 4\n";
    let at_ridge = |text: &str| {
        let mesh = &load_one("a.obj", text).meshes[0];
        mesh.positions.iter().zip(&mesh.normals).filter(|(p, _)| p.z == 1.0).map(|(_, n)| n.z).collect::<Vec<f32>>()
    };
    let smooth = at_ridge(&format!("s 1\n{text}"));
    assert!(smooth.len() == 2 && smooth.iter().all(|z| *z > 0.94), "{smooth:?}");
    assert!(at_ridge(text).iter().all(|z| (z - 0.5f32.sqrt()).abs() < 1e-6) && at_ridge(text).len() == 4);
}

#[test]
fn seams_of_texture_coordinates_are_as_smooth_as_the_rest() {
    let text = "v -1 0 -.1\nv -1 1 -.1\nv 0 0 0\nv 0 1 0\nv 1 0 -.1\nv 1 1 -.1\nvt 0 0\nvt 1 1\n\
                f 1/1 3/1 4/1 2/1\nf 3/2 5/2 6/2 4/2\n";
    let mesh = &load_one("a.obj", text).meshes[0];
    assert_eq!(mesh.positions.len(), 8, "the seam's vertices are two each");
    for y in [0.0, 1.0] {
        let seam = mesh.positions.iter().zip(&mesh.normals).filter(|(p, _)| p.x == 0.0 && p.y == y);
        let normals: Vec<Vec3> = seam.map(|(_, normal)| *normal).collect();
        assert!(normals.len() == 2 && normals[0] == normals[1] && normals[0].z > 0.998, "{normals:?}");
    }
}

const SQUARE: [[f32; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

fn colored_obj(color: &str) -> String {
    SQUARE.iter().map(|[x, y]| format!("v {x} {y} 0 {color}\n")).collect::<String>() + "f 1 2 3 4\n"
}

/// Of the same mesh as PLY: `types` are those of its three colours.
fn colored_ply(types: &str, color: &str) -> String {
    let vertices: String = SQUARE.iter().map(|[x, y]| format!("{x} {y} 0 {color}\n")).collect();
    format!(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         property {types} red\nproperty {types} green\nproperty {types} blue\nelement face 1\n\
         property list uchar int vertex_indices\nend_header\n{vertices}4 0 1 2 3\n"
    )
}

/// IEC 61966-2-1 of byte 128.
const LINEAR: f32 = 0.215_861;

#[test]
fn colours_of_vertices_are_the_same_in_obj_and_ply() {
    let obj = load_one("a.obj", colored_obj("0.501961 1 0"));
    let ply = load_one("a.ply", colored_ply("uchar", "128 255 0"));
    for scene in [&obj, &ply] {
        assert!((scene.meshes[0].colors[3] - Vec3::new(LINEAR, 1.0, 0.0)).abs().max_element() < 1e-5);
    }
    // Of what has no material they are the colour itself.
    let pictures = [obj, ply].map(|scene| look(scene, Integrator::Path, 1.0, 4));
    assert_eq!(pictures[0].len(), pictures[1].len());
    let [a, b] = pictures.map(|picture| mean(&picture, 4..28, 4..28));
    near(a, Vec3::new(LINEAR, 1.0, 0.0), 0.02);
    near(b, a, 1e-5);
}

#[test]
fn colours_of_0_to_255_behind_coordinates_are_bytes() {
    let bytes = load_one("a.obj", colored_obj("128 255 0"));
    assert!((bytes.meshes[0].colors[0] - Vec3::new(LINEAR, 1.0, 0.0)).abs().max_element() < 1e-5);
    let half = load_one("a.obj", colored_obj("1 1.0000001 -0.1"));
    assert_eq!(half.meshes[0].colors[0], Vec3::new(1.0, 1.0, 0.0), "what rounding adds is cut off");
}

#[test]
fn colours_multiply_the_colour_of_a_material() {
    let text = colored_obj("0.501961 0.501961 0.501961");
    let folder = Folder::new(&[
        ("a.obj", format!("mtllib a.mtl\nusemtl m\n{text}").as_bytes()),
        ("a.mtl", b"newmtl m\nKd .5 1 0\nillum 0\n"),
    ]);
    let scene = folder.load("a.obj");
    assert_eq!(scene.materials[0].color, Rgb::new(0.5, 1.0, 0.0));
    near(mean(&look(scene, Integrator::Local, 0.0, 1), 4..28, 4..28), Vec3::new(0.5, 1.0, 0.0) * LINEAR, 1e-4);
}

/// `count` triangles around one vertex; `corner` writes the corner of a triangle there.
fn fan(count: u32, corner: impl Fn(u32) -> String) -> String {
    let mut text = "v 0 0 1\n".to_owned();
    for i in 0..count {
        let (s, c) = (std::f64::consts::TAU * f64::from(i) / f64::from(count)).sin_cos();
        writeln!(text, "v {c:.6} {s:.6} 0\nvt {c:.3} {s:.4}").expect("a string");
    }
    for i in 0..count {
        writeln!(text, "f {} {} {}", corner(i), i + 2, (i + 1) % count + 2).expect("a string");
    }
    text
}

#[test]
fn a_million_faces_around_one_vertex_are_read_in_linear_time() {
    let time = |count: u32, corner: &dyn Fn(u32) -> String, smoothing: &str| {
        let folder = Folder::new(&[("a.obj", (smoothing.to_owned() + &fan(count, corner)).as_bytes())]);
        let start = Instant::now();
        let scene = folder.load("a.obj");
        assert_eq!(scene.meshes[0].triangles.len(), count as usize);
        start.elapsed().as_secs_f64()
    };
    // One vertex; a vertex for each face by its texture coordinates; and by its normal alone.
    let corners: [(&dyn Fn(u32) -> String, &str); 4] = [
        (&|_| "1".to_owned(), ""),
        (&|i| format!("1/{}", i + 1), ""),
        (&|_| "1".to_owned(), "s off\n"),
        (&|_| "1".to_owned(), "s 1\n"),
    ];
    for (corner, smoothing) in corners {
        let (small, large) = (time(1 << 16, corner, smoothing), time(1 << 20, corner, smoothing));
        println!("{small} s, {large} s");
        // Sixteen times the faces; quadratic time would be 256 times as long.
        assert!(large < 80.0 * small + 1.0, "{small} s, {large} s");
    }
}
