//! PLY as programs write it.

use super::support::{Folder, corners, load_one, look, mean, near};
use glam::{Vec2, Vec3};
use gonio::scene::{Integrator, Mesh, Model, Parameter, Rgb, Scene};

/// A square of two triangles. `vertex` and `face` are further properties, the rest what the lines of four vertices and of two
/// faces end with.
fn square(comment: &str, vertex: &str, face: &str, vertices: [&str; 4], faces: [&str; 2]) -> String {
    let places = ["-1 -1 0", "1 -1 0", "1 1 0", "-1 1 0"];
    let lines: String = places.iter().zip(vertices).map(|(place, rest)| format!("{place} {rest}\n")).collect();
    format!(
        "ply\nformat ascii 1.0\n{comment}element vertex 4\nproperty float x\nproperty float y\nproperty float z\n{vertex}\
         element face 2\nproperty list uchar int vertex_indices\n{face}end_header\n{lines}3 0 1 2 {}\n3 0 2 3 {}\n",
        faces[0], faces[1]
    )
}

const WEDGES: &str = "property list uchar float texcoord\n";
const WEDGE_LINES: [&str; 2] = ["6 0 0 1 0 1 1", "6 0 0 1 1 0 1"];

/// The texture coordinates of all corners, in order.
fn uvs(mesh: &Mesh) -> Vec<Vec2> {
    mesh.triangles.iter().flatten().map(|corner| mesh.uvs[*corner as usize]).collect()
}

#[test]
fn corners_have_texture_coordinates_of_their_own() {
    let [a, b, c, d] = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    let scene = load_one("w.ply", square("", "", WEDGES, [""; 4], WEDGE_LINES));
    let mesh = &scene.meshes[0];
    assert_eq!((uvs(mesh), mesh.positions.len()), (vec![a, b, c, a, c, d], 4));
    assert!(scene.warnings[0].ends_with("(texcoord): vertices doubled for them: 0"), "{:?}", scene.warnings);
    // A seam along the diagonal: two vertices are two each. They count before those of vertices.
    let seam = ["6 0 0 1 0 1 1", "6 .5 0 1 .5 0 1"];
    let text = square("", "property float s\nproperty float t\n", WEDGES, [".1 .1"; 4], seam);
    let scene = load_one("w.ply", text);
    let mesh = &scene.meshes[0];
    assert_eq!(uvs(mesh), [a, b, c, Vec2::new(0.5, 0.0), Vec2::new(1.0, 0.5), d]);
    assert_eq!((mesh.positions.len(), mesh.normals.len()), (6, 6));
    assert!(scene.warnings[0].ends_with("vertices doubled for them: 2"), "{:?}", scene.warnings);
    // A face whose list is empty or of another length keeps what its vertices have.
    let text = square("", "property float s\nproperty float t\n", WEDGES, [".1 .1"; 4], ["0", "4 0 0 1 1"]);
    assert_eq!(uvs(&load_one("w.ply", text).meshes[0]), [Vec2::splat(0.1); 6]);
}

#[test]
fn seams_of_texture_coordinates_are_as_smooth_as_the_rest() {
    let text = square("", "", WEDGES, [""; 4], ["6 0 0 1 0 1 1", "6 .5 0 1 .5 0 1"]).replace("-1 1 0", "-1 1 0.2");
    let mesh = &load_one("w.ply", text).meshes[0];
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        let same = |(q, _): &(&Vec3, &Vec3)| *q == p;
        assert!(mesh.positions.iter().zip(&mesh.normals).filter(same).all(|(_, other)| other == n), "{p} {n}");
    }
}

fn with_pictures(text: String) -> Folder {
    let folder = Folder::new(&[("w.ply", text.as_bytes())]);
    folder.picture("red one.png", 1, &[[255, 0, 0, 255]]);
    folder.picture("step.png", 2, &[[0, 0, 0, 255], [255; 4]]);
    folder
}

/// `scene` without light of its own, as bright as its materials' colours.
fn unlit(mut scene: Scene) -> Vec<Vec3> {
    scene.materials.iter_mut().for_each(|material| material.model = Model::Emissive);
    look(scene, Integrator::Local, 0.0, 4)
}

#[test]
fn pictures_that_comments_name_are_shown() {
    for comment in
        ["comment TextureFile step.png\n", "comment VCGLIB generated\r\ncomment  TextureFile\tC:\\scans\\step.png\r\n"]
    {
        let scene = with_pictures(square(comment, "", WEDGES, [""; 4], WEDGE_LINES)).load("w.ply");
        assert_eq!(scene.materials.len(), 1);
        assert!(scene.materials[0].color == Rgb::ONE && scene.materials[0].texture(Parameter::Color).is_some());
        let picture = unlit(scene);
        near(mean(&picture, 7..9, 4..28), Vec3::ZERO, 0.05);
        near(mean(&picture, 23..25, 4..28), Vec3::ONE, 0.05);
    }
    // Vertices may have the coordinates.
    let uv = "property float texture_u\nproperty float texture_v\n";
    let text = square("comment TextureFile red one.png\n", uv, "", ["0 0", "1 0", "1 1", "0 1"], [""; 2]);
    near(mean(&unlit(with_pictures(text).load("w.ply")), 4..28, 4..28), Vec3::X, 1e-3);
}

#[test]
fn faces_say_which_of_several_pictures_they_show() {
    let comment = "comment TextureFile red one.png\ncomment TextureFile step.png\ncomment TextureFile absent.png\n";
    let face = format!("{WEDGES}property int texnumber\n");
    let lines =
        |first: i32, second: i32| [format!("{} {first}", WEDGE_LINES[0]), format!("{} {second}", WEDGE_LINES[1])];
    let load = |numbers: [String; 2]| {
        with_pictures(square(comment, "", &face, [""; 4], [&numbers[0], &numbers[1]])).load("w.ply")
    };
    let scene = load(lines(0, 1));
    let names = |scene: &Scene| -> Vec<Option<String>> {
        let ids = scene.meshes[0].face_materials.iter();
        let texture = |id: &gonio::scene::MaterialId| scene.materials[id.0 as usize].texture(Parameter::Color);
        let name = |id| texture(id).map(|texture| scene.textures[texture.0 as usize].name.clone());
        ids.map(|id| name(id).map(|path| path.rsplit('/').next().unwrap_or_default().to_owned())).collect()
    };
    assert_eq!(names(&scene), [Some("red one.png".to_owned()), Some("step.png".to_owned())]);
    assert!(
        scene.warnings.iter().any(|w| w.contains("no texture: ") && w.contains("absent.png")),
        "{:?}",
        scene.warnings
    );
    assert_eq!(names(&load(lines(-1, 7))), [None, None]);
    assert_eq!(names(&load(lines(1, 2))), [Some("step.png".to_owned()), None]);
}

#[test]
fn a_picture_that_cannot_be_shown_is_said() {
    let scene = with_pictures(square("comment TextureFile step.png\n", "", "", [""; 4], [""; 2])).load("w.ply");
    assert!(scene.warnings[0].ends_with("w.ply: ignored: TextureFile step.png"), "{:?}", scene.warnings);
    assert_eq!(scene.materials[0].color, Rgb::splat(0.7));
    let text = square("comment TextureFile absent.png\n", "", WEDGES, [""; 4], WEDGE_LINES);
    let scene = with_pictures(text).load("w.ply");
    assert!(scene.warnings.iter().any(|w| w.contains("w.ply: no texture: ")), "{:?}", scene.warnings);
    assert_eq!((scene.materials.len(), scene.materials[0].color), (1, Rgb::splat(0.7)));
}

#[test]
fn colours_of_faces_are_those_of_their_corners() {
    let colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    let scene = load_one("w.ply", square("", "", colors, [""; 4], ["255 0 0", "0 0 128"]));
    let mesh = &scene.meshes[0];
    let found: Vec<Vec3> = mesh.triangles.iter().flatten().map(|corner| mesh.colors[*corner as usize]).collect();
    let blue = Vec3::new(0.0, 0.0, 0.215_861);
    assert!(found[..3].iter().all(|c| *c == Vec3::X) && found[3..].iter().all(|c| (*c - blue).length() < 1e-5));
    assert_eq!((mesh.positions.len(), scene.materials[0].color), (6, Rgb::ONE));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let picture = unlit(scene);
    near(mean(&picture, 20..28, 20..28), Vec3::X, 1e-3);
    near(mean(&picture, 4..12, 4..12), blue, 1e-3);
    // Vertices that have colours keep them, and that is said.
    let text = square("", colors, colors, ["0 255 0"; 4], ["255 0 0", "0 0 128"]);
    let scene = load_one("w.ply", text);
    assert_eq!((scene.meshes[0].colors[0], scene.meshes[0].positions.len()), (Vec3::Y, 4));
    assert!(scene.warnings[0].ends_with("ignored: face red, face green, face blue"), "{:?}", scene.warnings);
}

#[test]
fn colours_of_mitsuba_are_linear() {
    let colors = "property float color_0\nproperty float color_1\nproperty float color_2\nproperty float foo_0\n";
    let text = square("", colors, "property float weight_0\n", [".5 .25 1 3"; 4], ["2"; 2]);
    let scene = load_one("m.ply", text);
    assert_eq!(scene.meshes[0].colors, [Vec3::new(0.5, 0.25, 1.0); 4]);
    assert!(scene.warnings[0].ends_with("ignored: vertex foo_0, face weight_0"), "{:?}", scene.warnings);
}

const FACES_FIRST: &str = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nproperty uchar red\n\
    property uchar green\nproperty uchar blue\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\nend_header\n\
    6 0 1 2 3 4 5 255 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n0 0 0\n2 0 0\n";

#[test]
fn faces_may_come_before_their_vertices() {
    // An L, which no fan covers.
    let scene = load_one("a.ply", FACES_FIRST);
    let places = corners(&scene.meshes[0]);
    let areas: Vec<f32> = places.chunks(3).map(|c| (c[1] - c[0]).cross(c[2] - c[0]).z * 0.5).collect();
    assert!(areas.len() == 4 && areas.iter().all(|area| *area >= 0.0) && areas.iter().sum::<f32>() == 3.0, "{areas:?}");
    assert_eq!(scene.meshes[0].colors, [Vec3::X; 6]);
    let message = Folder::new(&[("a.ply", FACES_FIRST.replace("6 0 1 2", "6 9 1 2").as_bytes())]).refused("a.ply");
    assert!(message.starts_with("a.ply:13: face 0 of 1: vertex 9 of 6"), "{message}");
}

#[test]
fn faces_without_three_corners_are_left_out_with_a_word() {
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 6\n\
        property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0\n1 2\n2 0 1\n3 0 1 1\n3 0 1 2\n4 0 2 2 3\n";
    let scene = load_one("a.ply", text);
    assert_eq!(scene.meshes[0].triangles.len(), 2);
    assert!(
        scene.warnings[0].ends_with("faces with fewer than three different corners left out: 5"),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn headers_of_all_writers_are_read() {
    let body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let header = |lines: &str| format!("ply\nformat ascii 1.0\n{lines}end_header\n{body}");
    let vertex = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    let face = "element face 1\nproperty list uchar uint vertex_indices\n";
    for text in [
        header(&format!(
            "comment\ncomment Created by Blender3D 2.49 - www.blender.org, source file: /home/x/ä.blend\n{vertex}{face}"
        )),
        header(&format!("obj_info Generated by CloudCompare!\nobj_info\n{vertex}comment between\n{face}")),
        header(&format!("{vertex}{face}").replace("float", "float32").replace("uchar uint", "uint8 uint32")),
        header(&format!("{vertex}{face}").replace("vertex_indices", "vertex_index")),
        format!("{}\n", header(&format!("{vertex}{face}")).replace('\n', "\r\n")),
        header(&format!("{vertex}{face}")).replace('\n', "\r"),
        header(&format!("{vertex}{face}")).replace("ply\n", "ply \n").replace("end_header", "end_header "),
        header(&format!("{vertex}{face}element edge 0\nproperty int vertex1\n")),
    ] {
        assert_eq!(load_one("a.ply", &text).meshes[0].triangles, [[0, 1, 2]], "{text:?}");
    }
    // Comments in another encoding than UTF-8.
    let latin: Vec<u8> = header(&format!("comment \u{e9}\n{vertex}{face}")).chars().map(|c| c as u8).collect();
    assert_eq!(load_one("a.ply", latin).meshes[0].triangles.len(), 1);
}
