//! `mesh_attribute`: numbers that a mesh brings along, as colours and as anything else.

use super::{scene_text, try_files};
use glam::{Vec2, Vec3};
use gonio::bake::bake;
use gonio::scene::*;
use gonio::shading::texture::sample_texture;

/// Two triangles that share an edge: attributes vertex_color, vertex_rough, face_color and face_paint_color, face_weight.
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                   property float r\nproperty float g\nproperty float b\nproperty float rough_0\nelement face 2\n\
                   property list uchar int vertex_indices\nproperty float weight_x\nproperty float paint_r\n\
                   property float paint_g\nproperty float paint_b\nproperty float pair_x\nproperty float pair_y\nend_header\n\
                   0 0 0  0.1 0.2 0.3  0.5\n1 0 0  0.4 0.5 0.6  0.25\n1 1 0  0.7 0.8 0.9  0.75\n0 1 0  1 0.5 0  1\n\
                   3 0 1 2  0.125 0.9 0.8 0.7  1 2\n3 0 2 3  0.875 0.6 0.5 0.4  3 4\n";

fn try_shown(material: &str) -> Result<Scene, SceneError> {
    let shape = format!(
        "<sensor type=\"perspective\"/><shape type=\"ply\"><string name=\"filename\" value=\"m.ply\"/>{material}</shape>"
    );
    try_files(&[("a.xml", &scene_text(&shape)), ("m.ply", PLY)], &[])
}

#[track_caller]
fn shown(material: &str) -> Scene {
    try_shown(material).unwrap_or_else(|error| panic!("{error}"))
}

fn attribute(property: &str, name: &str) -> String {
    format!("<texture type=\"mesh_attribute\" name=\"{property}\"><string name=\"name\" value=\"{name}\"/></texture>")
}

#[test]
fn the_only_colour_of_a_surface_becomes_vertex_colours() {
    let diffuse = |name: &str| shown(&format!("<bsdf type=\"diffuse\">{}</bsdf>", attribute("reflectance", name)));
    let vertices = diffuse("vertex_color");
    assert_eq!((vertices.meshes[0].positions.len(), vertices.meshes[0].colors[1]), (4, Vec3::new(0.4, 0.5, 0.6)));
    assert_eq!((vertices.textures.len(), vertices.materials[0].color), (0, Rgb::ONE));
    let faces = diffuse("face_paint_color");
    let mesh = &faces.meshes[0];
    assert_eq!(mesh.colors[..3], [Vec3::new(0.9, 0.8, 0.7); 3]);
    assert_eq!(mesh.colors[3..], [Vec3::new(0.6, 0.5, 0.4); 3]);
    assert_eq!(mesh.positions[mesh.triangles[1][2] as usize], Vec3::Y, "each face has corners of its own");
    assert!(mesh.normals.iter().all(|normal| *normal == Vec3::Z));
    // Of one number the same in all channels.
    assert_eq!(diffuse("face_weight").meshes[0].colors[0], Vec3::splat(0.125));
}

#[test]
fn what_is_no_single_colour_becomes_a_picture_that_is_the_attribute_everywhere() {
    let scene = shown(&format!(
        "<bsdf type=\"blendbsdf\">{}<bsdf type=\"diffuse\">{}</bsdf><bsdf type=\"roughconductor\">{}</bsdf></bsdf>",
        attribute("weight", "face_weight"),
        attribute("reflectance", "vertex_color"),
        attribute("alpha", "vertex_rough"),
    ));
    let data = bake(&scene).expect("bakes");
    let mesh = &scene.meshes[0];
    assert!(mesh.colors.is_empty());
    let texture = |parameter: Parameter| {
        let bindings = scene.materials.iter().flat_map(|material| &material.textures);
        let binding = bindings.into_iter().find(|binding| binding.parameter == parameter).expect("bound");
        data.textures[binding.texture.0 as usize]
    };
    let (colors, roughs) =
        ([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6], [0.7, 0.8, 0.9], [1.0, 0.5, 0.0]], [0.5, 0.25, 0.75, 1.0]);
    for (face, (corners, weight)) in [([0, 1, 2], 0.125), ([0, 2, 3], 0.875)].into_iter().enumerate() {
        for b in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.2, 0.5, 0.3], [0.5, 0.0, 0.5]] {
            let uv: Vec2 = (0..3).map(|k| mesh.uvs[mesh.triangles[face][k] as usize] * b[k]).sum();
            let read = |parameter: Parameter| sample_texture(&data.view(), &texture(parameter), uv);
            let color: Vec3 = (0..3).map(|k| Vec3::from_array(colors[corners[k]]) * b[k]).sum();
            let rough: f32 = (0..3).map(|k| roughs[corners[k]] * b[k]).sum();
            // Texture coordinates are 24 bits of a picture four texels wide.
            assert!((read(Parameter::Color).truncate() - color).abs().max_element() < 1e-5, "{face} {b:?}");
            assert!((read(Parameter::Roughness).x - rough).abs() < 1e-5, "{face} {b:?}");
            assert!((read(Parameter::Weight).x - weight).abs() < 1e-5, "{face} {b:?}");
        }
    }
}

#[test]
fn a_lamp_may_glow_as_its_vertices_say() {
    let radiance =
        attribute("radiance", "vertex_color").replace("</texture>", "<float name=\"scale\" value=\"10\"/></texture>");
    let scene = shown(&format!("<emitter type=\"area\">{radiance}</emitter>"));
    let lamp = &scene.materials[scene.objects[0].material.expect("a material").0 as usize];
    assert_eq!((lamp.emission, lamp.textures[0].parameter), (Rgb::ONE, Parameter::Emission));
    let data = bake(&scene).expect("bakes");
    let seen = sample_texture(&data.view(), &data.textures[0], scene.meshes[0].uvs[0]);
    assert!((seen.truncate() - Vec3::new(1.0, 2.0, 3.0)).abs().max_element() < 1e-4, "{seen}");
}

#[test]
fn a_material_of_two_shapes_shows_the_attributes_of_each() {
    let other = PLY.replace("0.125 0.9", "0.625 0.9");
    let shape =
        |file: &str| format!("<shape type=\"ply\"><string name=\"filename\" value=\"{file}\"/><ref id=\"m\"/></shape>");
    let text = scene_text(&format!(
        "<sensor type=\"perspective\"/><bsdf type=\"mask\" id=\"m\">{}<bsdf type=\"diffuse\"/></bsdf>{}{}",
        attribute("opacity", "face_weight"),
        shape("m.ply"),
        shape("n.ply"),
    ));
    let scene = try_files(&[("a.xml", &text), ("m.ply", PLY), ("n.ply", &other)], &[]).expect("readable");
    let data = bake(&scene).expect("bakes");
    let opacity = |object: usize| {
        let material = &scene.materials[scene.objects[object].material.expect("a material").0 as usize];
        sample_texture(
            &data.view(),
            &data.textures[material.textures[0].texture.0 as usize],
            scene.meshes[object].uvs[0],
        )
        .x
    };
    assert!((opacity(0) - 0.125).abs() < 1e-6 && (opacity(1) - 0.625).abs() < 1e-6, "{} {}", opacity(0), opacity(1));
}

#[test]
fn attributes_that_are_not_there_or_not_possible_are_refused_with_their_place() {
    let refused = |material: &str, expected: &str| {
        let text = try_shown(material).map(|_| ()).expect_err("to be refused").to_string();
        assert!(text.contains(expected), "{text}\n{expected}");
    };
    let has = "it has vertex_color, vertex_rough, face_weight, face_paint_color";
    let diffuse = format!("<bsdf type=\"diffuse\">{}</bsdf>", attribute("reflectance", "vertex_colour"));
    refused(&diffuse, &format!("a.xml:2:29: the mesh has no attribute \"vertex_colour\"; {has}"));
    let mask = format!("<bsdf type=\"mask\">{}<bsdf type=\"diffuse\"/></bsdf>", attribute("opacity", "face_pair"));
    refused(&mask, &format!("the mesh has no attribute \"face_pair\"; {has}"));
    let board = "<texture type=\"checkerboard\" name=\"reflectance\"/>";
    let mixed = format!(
        "<bsdf type=\"mask\">{}<bsdf type=\"diffuse\">{board}</bsdf></bsdf>",
        attribute("opacity", "face_weight")
    );
    refused(&mixed, "texture coordinates is not supported beside the attribute \"face_weight\"");
    let ball = scene_text(&format!("<sensor type=\"perspective\"/><shape type=\"sphere\">{diffuse}</shape>"));
    let error = try_files(&[("a.xml", &ball)], &[]).map(|_| ()).expect_err("a ball has none").to_string();
    assert!(error.contains("a.xml:2:29: a sphere has no attribute \"vertex_colour\""), "{error}");
}
