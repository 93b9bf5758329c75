//! What elements do to a scene, down to their defaults.

use super::{LEAST, material, read, scene_text, try_files};
use glam::{DVec3, Vec2, Vec3};
use gonio::scene::*;

fn close(a: DVec3, b: [f64; 3]) -> bool {
    (a - DVec3::from_array(b)).abs().max_element() < 1e-6
}

fn mesh_of<'s>(scene: &'s Scene, object: &Object) -> &'s Mesh {
    match object.geometry {
        Geometry::Mesh(id) => &scene.meshes[id.0 as usize],
        Geometry::Sphere => panic!("{} is an analytic sphere", object.name),
    }
}

#[test]
fn a_sensor_without_properties_has_mitsubas_defaults() {
    let scene = read(LEAST);
    assert_eq!((scene.film.width, scene.film.height), (768, 576));
    assert_eq!(scene.film.filter, Filter::Gaussian { radius: 2.0, sigma: 0.5 });
    let camera = scene.camera;
    assert_eq!((camera.eye, camera.target, camera.up), (Vec3::ZERO, Vec3::Z, Vec3::Y));
    // 50 mm on a 36 x 24 mm picture, across the diagonal of a 4:3 one.
    let expected = 2.0 * (0.43266615_f32 / (1.0 + 16.0 / 9.0_f32).sqrt()).atan();
    assert!(matches!(camera.projection, Projection::Perspective { fov_y } if (fov_y - expected).abs() < 1e-6));
}

#[test]
fn the_field_of_view_is_across_the_axis_it_names() {
    let tangent = |axis: &str, size: [u32; 2]| {
        let scene = read(&format!(
            "<sensor type=\"perspective\"><float name=\"fov\" value=\"90\"/><string name=\"fov_axis\" value=\"{axis}\"/>\
             <film type=\"hdrfilm\"><integer name=\"width\" value=\"{}\"/><integer name=\"height\" value=\"{}\"/></film></sensor>\
             <shape type=\"sphere\"/>",
            size[0], size[1]
        ));
        match scene.camera.projection {
            Projection::Perspective { fov_y } => (f64::from(fov_y) / 2.0).tan(),
            Projection::Orthographic { .. } => f64::NAN,
        }
    };
    for (axis, size, expected) in [
        ("x", [200, 100], 0.5),
        ("y", [200, 100], 1.0),
        ("smaller", [200, 100], 1.0),
        ("smaller", [100, 200], 2.0),
        ("larger", [200, 100], 0.5),
        ("larger", [100, 200], 1.0),
        ("diagonal", [300, 400], 0.8),
    ] {
        let found = tangent(axis, size);
        assert!((found - expected).abs() < 1e-6, "{axis} of {size:?}: {found}");
    }
}

#[test]
fn an_orthographic_sensor_sees_two_units_in_width_scaled() {
    let scene = read(
        "<sensor type=\"orthographic\"><transform name=\"to_world\"><scale x=\"1.5\" y=\"1.5\"/>\
         <lookat origin=\"-5, 0, 3\" target=\"0, 0, 1\" up=\"0, 0, 1\"/></transform>\
         <film type=\"hdrfilm\"><integer name=\"width\" value=\"200\"/><integer name=\"height\" value=\"120\"/></film></sensor>\
         <shape type=\"sphere\"/>",
    );
    assert!(matches!(scene.camera.projection, Projection::Orthographic { height } if (height - 1.8).abs() < 1e-6));
    assert_eq!(scene.camera.eye, Vec3::new(-5.0, 0.0, 3.0));
}

#[test]
fn steps_of_a_transform_apply_in_the_order_written() {
    let place = |steps: &str| {
        let scene = read(&format!(
            "<sensor type=\"perspective\"/><shape type=\"cube\"><transform name=\"to_world\">{steps}</transform></shape>"
        ));
        scene.objects[0].transform.0
    };
    let p = DVec3::new(1.0, 2.0, 3.0);
    let moved = place("<scale value=\"2\"/><translate x=\"1\"/>").transform_point3(p);
    assert!(close(moved, [3.0, 4.0, 6.0]), "{moved}");
    let moved = place("<translate x=\"1\"/><scale x=\"2\"/>").transform_point3(p);
    assert!(close(moved, [4.0, 2.0, 3.0]), "{moved}");
    let turned = place("<rotate z=\"1\" angle=\"90\"/>").transform_point3(p);
    assert!(close(turned, [-2.0, 1.0, 3.0]), "{turned}");
    let matrix = place("<matrix value=\"0 1 0 5  2 0 0 6  0 0 3 7  0 0 0 1\"/>").transform_point3(p);
    assert!(close(matrix, [7.0, 8.0, 16.0]), "{matrix}");
    // x is to the left of one who looks along +z.
    let looked =
        place("<lookat origin=\"1,2,3\" target=\"1,2,9\" up=\"0,1,0\"/>").transform_point3(DVec3::new(1.0, 0.0, 2.0));
    assert!(close(looked, [2.0, 2.0, 5.0]), "{looked}");
}

#[test]
fn a_sphere_is_moved_by_its_centre_before_its_transform() {
    let scene = read(
        "<sensor type=\"perspective\"/><shape type=\"sphere\"><point name=\"center\" x=\"1\"/><float name=\"radius\" value=\"0.5\"/>\
         <transform name=\"to_world\"><scale value=\"2\"/></transform></shape>",
    );
    assert_eq!(scene.objects[0].geometry, Geometry::Sphere);
    // Ours stands around y, Mitsuba's around z.
    let pole = scene.objects[0].transform.0.transform_point3(DVec3::Y);
    assert!(close(pole, [2.0, 0.0, 1.0]), "{pole}");
}

#[test]
fn a_sphere_has_its_texture_around_z_from_x_towards_y_whichever_way_it_faces() {
    // Where Mitsuba's (u, v) is, v from the pole at +z.
    let places = [
        ([0.25, 0.5], DVec3::Y),
        ([0.5, 0.5], DVec3::NEG_X),
        ([0.75, 0.5], DVec3::NEG_Y),
        ([0.25, 0.25], DVec3::new(0.0, 0.5f64.sqrt(), 0.5f64.sqrt())),
    ];
    let scene = read(LEAST);
    for (uv, place) in places {
        // Of the analytic sphere: u = 0.5 towards its +z and growing towards +x, v from its pole at -y.
        let (turn, height) = ((uv[0] - 0.5) * std::f64::consts::TAU, (uv[1] - 0.5) * std::f64::consts::PI);
        let own = DVec3::new(turn.sin() * height.cos(), -height.sin(), turn.cos() * height.cos());
        let found = scene.objects[0].transform.0.transform_point3(own);
        assert!((found - place).length() < 1e-6, "{uv:?}: {found}");
    }
    let scene = read(
        "<sensor type=\"perspective\"/><shape type=\"sphere\"><boolean name=\"flip_normals\" value=\"true\"/></shape>",
    );
    let (mesh, transform) = (mesh_of(&scene, &scene.objects[0]), scene.objects[0].transform.0);
    for (uv, place) in places {
        let at = |i: &usize| (transform.transform_point3(mesh.positions[*i].as_dvec3()) - place).length() < 1e-5;
        let vertex = (0..mesh.positions.len()).find(at).expect("a vertex there");
        let found = mesh.uvs[vertex];
        assert!((found - Vec2::new(uv[0] as f32, 1.0 - uv[1] as f32)).length() < 1e-5, "{uv:?}: {found}");
    }
}

#[test]
fn every_face_of_a_cube_has_the_corners_of_mitsubas_table() {
    let scene = read("<sensor type=\"perspective\"/><shape type=\"cube\"/>");
    let mesh = mesh_of(&scene, &scene.objects[0]);
    // Corner, normal and Mitsuba's uv: the first of each face in its source, and one across it.
    for (corner, normal, uv) in [
        ([1.0, -1.0, -1.0], Vec3::NEG_Y, [0.0, 1.0]),
        ([1.0, 1.0, -1.0], Vec3::Y, [0.0, 1.0]),
        ([1.0, -1.0, -1.0], Vec3::X, [0.0, 1.0]),
        ([1.0, 1.0, 1.0], Vec3::X, [1.0, 0.0]),
        ([1.0, -1.0, 1.0], Vec3::Z, [0.0, 1.0]),
        ([-1.0, 1.0, 1.0], Vec3::Z, [1.0, 0.0]),
        ([-1.0, -1.0, 1.0], Vec3::NEG_X, [0.0, 1.0]),
        ([1.0, 1.0, -1.0], Vec3::NEG_Z, [0.0, 1.0]),
    ] {
        let is = |i: &usize| mesh.positions[*i] == Vec3::from_array(corner) && mesh.normals[*i] == normal;
        let vertex = (0..mesh.positions.len()).find(is).expect("a corner");
        assert_eq!(mesh.uvs[vertex], Vec2::new(uv[0], 1.0 - uv[1]), "{corner:?} of {normal}");
    }
}

#[test]
fn merged_shapes_are_shown_each_and_names_of_plugins_may_have_capitals() {
    let scene = read(
        "<sensor type=\"perspective\"/><shape type=\"merge\"><shape type=\"Cube\"/><shape type=\"merge\"><shape type=\"sphere\"/></shape></shape>",
    );
    assert_eq!((scene.objects.len(), scene.objects[1].geometry), (2, Geometry::Sphere));
}

#[test]
fn named_shapes_face_as_in_mitsuba_and_flip() {
    for (shape, expected) in [("rectangle", Vec3::Z), ("disk", Vec3::Z), ("cylinder", Vec3::ZERO), ("cube", Vec3::ZERO)]
    {
        for flip in [false, true] {
            let scene = read(&format!(
                "<sensor type=\"perspective\"/><shape type=\"{shape}\"><boolean name=\"flip_normals\" value=\"{flip}\"/></shape>"
            ));
            let mesh = mesh_of(&scene, &scene.objects[0]);
            let sign = if flip { -1.0 } else { 1.0 };
            for triangle in &mesh.triangles {
                let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
                let (face, shading) = ((b - a).cross(c - a), mesh.normals[triangle[0] as usize]);
                assert!(face.dot(shading) > 0.0, "{shape} {flip}: {face} {shading}");
                let outwards =
                    if expected == Vec3::ZERO { a.with_z(if shape == "cube" { a.z } else { 0.0 }) } else { expected };
                assert!(sign * outwards.dot(shading) > 0.0, "{shape} {flip}: {outwards} {shading}");
            }
        }
    }
}

#[test]
fn the_upper_row_of_a_picture_lies_at_v_0_of_mitsuba() {
    // A rectangle's uv (0, 0) is its corner (-1, -1); here v counts from the bottom row of the picture.
    let scene = read("<sensor type=\"perspective\"/><shape type=\"rectangle\"/>");
    let mesh = mesh_of(&scene, &scene.objects[0]);
    let corner = mesh.positions.iter().position(|p| *p == Vec3::new(-1.0, -1.0, 0.0)).expect("the corner");
    assert_eq!(mesh.uvs[corner], Vec2::new(0.0, 1.0));
}

#[test]
fn obj_coordinates_count_from_the_bottom_and_ply_ones_from_the_top() {
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0.25\nf 1/1 2/1 3/1\n";
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float u\n\
               property float v\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
               0 0 0 0 0.25\n1 0 0 0 0.25\n0 1 0 0 0.25\n3 0 1 2\n";
    for (kind, flip, expected) in
        [("obj", None, 0.25), ("obj", Some(false), 0.75), ("ply", None, 0.75), ("ply", Some(true), 0.25)]
    {
        let flip = flip.map_or(String::new(), |f| format!("<boolean name=\"flip_tex_coords\" value=\"{f}\"/>"));
        let shape = format!("<shape type=\"{kind}\"><string name=\"filename\" value=\"m.{kind}\"/>{flip}</shape>");
        let text = scene_text(&format!("<sensor type=\"perspective\"/>{shape}"));
        let scene = try_files(&[("a.xml", &text), ("m.obj", obj), ("m.ply", ply)], &[]).expect("readable");
        assert_eq!(scene.meshes[0].uvs[0].y, expected, "{kind} {flip}");
    }
}

#[test]
fn a_mesh_without_normals_is_smooth_unless_it_wants_faces() {
    // Three faces of a cube meet at the origin, the one in z = 0 cut in two there.
    let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 -1\nf 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 2\n";
    let read = |flat: bool| {
        let shape = format!(
            "<sensor type=\"perspective\"/><shape type=\"obj\"><string name=\"filename\" value=\"m.obj\"/>\
             <boolean name=\"face_normals\" value=\"{flat}\"/></shape>"
        );
        try_files(&[("a.xml", &scene_text(&shape)), ("m.obj", obj)], &[]).expect("readable").meshes.swap_remove(0)
    };
    assert!(read(true).normals.is_empty());
    let normal = read(false).normals[0];
    // Each face counts with its angle, not once for each triangle.
    let expected = Vec3::new(-1.0, -1.0, 1.0).normalize();
    assert!((normal - expected).length() < 1e-6, "{normal}");
}

#[test]
fn triangles_wound_against_their_normals_are_turned() {
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nf 1//1 2//1 3//1\n";
    let shape = "<sensor type=\"perspective\"/><shape type=\"obj\"><string name=\"filename\" value=\"m.obj\"/></shape>";
    let scene = try_files(&[("a.xml", &scene_text(shape)), ("m.obj", obj)], &[]).expect("readable");
    let mesh = &scene.meshes[0];
    let [a, b, c] = mesh.triangles[0].map(|i| mesh.positions[i as usize]);
    assert!((b - a).cross(c - a).z < 0.0);
}

#[test]
fn references_aliases_includes_and_parameters_lead_to_the_same_object() {
    let main = scene_text(
        "<path value=\"parts\"/><default name=\"grey\" value=\"0.25\"/><default name=\"n\" value=\"4\"/>\
         <include filename=\"materials.xml\"/><alias id=\"wall\" as=\"floor\"/>\
         <sensor type=\"perspective\"><sampler type=\"independent\"><integer name=\"sample_count\" value=\"${n}2\"/></sampler></sensor>\
         <shape type=\"cube\"><ref id=\"wall\"/></shape><shape type=\"cube\"><ref id=\"floor\"/></shape>\
         <shape type=\"cube\"><ref name=\"bsdf\" id=\"later\"/></shape><bsdf type=\"null\" id=\"later\"/>",
    );
    let materials = scene_text("<bsdf type=\"diffuse\" id=\"wall\"><rgb name=\"reflectance\" value=\"$grey\"/></bsdf>");
    let files = [("a.xml", main.as_str()), ("parts/materials.xml", materials.as_str())];
    let scene = try_files(&files, &[]).expect("readable");
    assert_eq!(scene.settings.samples, 42);
    let ids: Vec<_> = scene.objects.iter().map(|object| object.material).collect();
    assert_eq!(ids[0], ids[1]);
    let wall = &scene.materials[ids[0].expect("a material").0 as usize];
    assert_eq!((wall.color, wall.two_sided), (Rgb::splat(0.25), false));
    assert_eq!(scene.materials[ids[2].expect("a material").0 as usize].model, Model::Null);
    assert_eq!(scene.meshes.len(), 1, "three cubes are one mesh");
    // The command line comes before <default>.
    let scene = try_files(&files, &[("grey", "0.5"), ("n", "6")]).expect("readable");
    assert_eq!((scene.settings.samples, scene.materials[0].color), (62, Rgb::splat(0.5)));
}

#[test]
fn instances_show_their_group_where_they_are() {
    let scene = read(
        "<sensor type=\"perspective\"/><shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\">\
         <transform name=\"to_world\"><scale value=\"2\"/></transform></shape><shape type=\"sphere\"/></shape>\
         <shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\"><translate x=\"5\"/></transform></shape>\
         <shape type=\"instance\"><ref id=\"g\"/></shape>",
    );
    assert_eq!((scene.objects.len(), scene.meshes.len()), (4, 1), "the group itself is not shown");
    let corner = scene.objects[0].transform.0.transform_point3(DVec3::ONE);
    assert!(close(corner, [7.0, 2.0, 2.0]), "{corner}");
}

#[test]
fn materials_have_mitsubas_defaults() {
    let glass = (1.5046 / 1.000277) as f32;
    let coat = (1.49 / 1.000277) as f32;
    let mirror = Fresnel::Conductor { eta: Rgb::ZERO, k: Rgb::ONE };
    let rough = |distribution| Model::RoughDielectric {
        distribution,
        alpha_u: 0.1,
        alpha_v: 0.1,
        eta: glass,
        absorption: Rgb::ZERO,
    };
    for (bsdf, model, color) in [
        ("<bsdf type=\"diffuse\"/>", Model::Lambert, 0.5),
        ("<bsdf type=\"dielectric\"/>", Model::Dielectric { eta: glass, absorption: Rgb::ZERO }, 1.0),
        ("<bsdf type=\"thindielectric\"/>", Model::ThinDielectric { eta: glass }, 1.0),
        ("<bsdf type=\"roughdielectric\"/>", rough(Distribution::Beckmann), 1.0),
        (
            "<bsdf type=\"roughdielectric\"><string name=\"distribution\" value=\"ggx\"/></bsdf>",
            rough(Distribution::TrowbridgeReitz),
            1.0,
        ),
        ("<bsdf type=\"conductor\"/>", Model::Conductor { fresnel: mirror }, 1.0),
        (
            "<bsdf type=\"roughconductor\"/>",
            Model::RoughConductor {
                distribution: Distribution::Beckmann,
                alpha_u: 0.1,
                alpha_v: 0.1,
                fresnel: mirror,
                compensate: false,
            },
            1.0,
        ),
        ("<bsdf type=\"plastic\"/>", Model::Plastic { eta: coat, nonlinear: false }, 0.5),
        (
            "<bsdf type=\"roughplastic\"/>",
            Model::RoughPlastic { distribution: Distribution::Beckmann, alpha: 0.1, eta: coat, nonlinear: false },
            0.5,
        ),
        ("<bsdf type=\"null\"/>", Model::Null, 1.0),
        ("<bsdf type=\"principled\"/>", Model::Principled(Principled { eta: 1.5, ..Principled::default() }), 0.5),
        ("", Model::Lambert, 0.5),
    ] {
        let found = material(bsdf);
        match (&found.model, &model) {
            // 2 / (1 - sqrt(0.04)) - 1 in double precision.
            (Model::Principled(found), Model::Principled(expected)) => {
                assert!((found.eta - expected.eta).abs() < 1e-6);
                assert_eq!(Principled { eta: expected.eta, ..*found }, *expected);
            }
            _ => assert_eq!(found.model, model, "{bsdf}"),
        }
        // Opaque materials have a front; what lets light through has two sides.
        let through = bsdf.contains("dielectric") || bsdf.contains("null");
        assert_eq!((found.color, found.two_sided, found.opacity), (Rgb::splat(color), through, 1.0), "{bsdf}");
    }
}

#[test]
fn adapters_change_what_they_hold() {
    let inner = "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"#ffffff\"/></bsdf>";
    let both = material(&format!("<bsdf type=\"twosided\">{inner}</bsdf>"));
    assert_eq!((both.two_sided, both.color), (true, Rgb::ONE));
    let masked = material(&format!(
        "<bsdf type=\"mask\"><float name=\"opacity\" value=\"0.25\"/><bsdf type=\"twosided\">{inner}</bsdf></bsdf>"
    ));
    assert_eq!((masked.opacity, masked.two_sided, masked.model), (0.25, true, Model::Lambert));
    let scene = read(&format!(
        "<sensor type=\"perspective\"/><shape type=\"cube\"><bsdf type=\"twosided\"><bsdf type=\"blendbsdf\">\
         <float name=\"weight\" value=\"0.75\"/>{inner}<bsdf type=\"conductor\"><string name=\"material\" value=\"Cu\"/></bsdf>\
         </bsdf></bsdf></shape>"
    ));
    let id = scene.objects[0].material.expect("a material");
    let Model::Blend { weight, a, b } = scene.materials[id.0 as usize].model else { panic!("{:?}", scene.materials) };
    assert_eq!(weight, 0.75);
    assert_eq!(scene.materials[a.0 as usize].model, Model::Lambert);
    let copper = &scene.materials[b.0 as usize];
    assert!(copper.two_sided, "what is in a twosided has two sides");
    let Model::Conductor { fresnel: Fresnel::Conductor { eta, .. } } = copper.model else { panic!("{copper:?}") };
    assert_eq!(eta, Rgb::new(0.201006, 0.923749, 1.102215));
}

#[test]
fn a_shape_that_emits_is_black_unless_it_says_otherwise_and_emits_in_front() {
    let emitter = "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1 2 3\"/></emitter>";
    let lamp = material(emitter);
    assert_eq!((lamp.emission, lamp.emission_two_sided), (Rgb::new(1.0, 2.0, 3.0), false));
    assert_eq!(lamp.color, Rgb::ZERO);
    let lamp = material(&format!("{emitter}<bsdf type=\"diffuse\"/>"));
    assert_eq!((lamp.emission.z, lamp.color), (3.0, Rgb::splat(0.5)));
}

#[test]
fn emitters_have_mitsubas_defaults() {
    let light = |emitter: &str| read(&format!("{LEAST}{emitter}")).lights.swap_remove(0);
    let point = light("<emitter type=\"point\"><point name=\"position\" value=\"1, 2, 3\"/></emitter>");
    assert_eq!(point.kind, LightKind::Point { position: Vec3::new(1.0, 2.0, 3.0) });
    assert_eq!(
        (point.intensity, point.unit, point.attenuation),
        (Rgb::ONE, IntensityUnit::Radiometric, Attenuation::InverseSquare)
    );
    let spot = light(
        "<emitter type=\"spot\"><transform name=\"to_world\"><lookat origin=\"1,0,0\" target=\"2,0,0\" up=\"0,1,0\"/></transform></emitter>",
    );
    let LightKind::Spot { position, direction, inner, outer, exponent } = spot.kind else { panic!("{spot:?}") };
    assert_eq!((position, direction, exponent), (Vec3::X, Vec3::X, 0.0));
    // A hard edge at the cutoff; the slide falls off to there.
    let Some([from, to]) = spot.slide.expect("a slide").ramp else { panic!("{spot:?}") };
    assert!((outer - 20.0_f32.to_radians()).abs() < 1e-6 && inner == outer && to == outer);
    assert!((from - 15.0_f32.to_radians()).abs() < 1e-6);
    let sun = light(
        "<emitter type=\"directional\"><vector name=\"direction\" value=\"0, -2, 0\"/><rgb name=\"irradiance\" value=\"5\"/></emitter>",
    );
    assert_eq!((sun.kind, sun.intensity), (LightKind::Directional { direction: Vec3::NEG_Y }, Rgb::splat(5.0)));
}

#[test]
fn a_checkerboard_has_its_first_colour_where_u_and_v_are_small() {
    let board = material(
        "<bsdf type=\"diffuse\"><texture type=\"checkerboard\" name=\"reflectance\"><rgb name=\"color1\" value=\"0.9\"/>\
         <transform name=\"to_uv\"><scale x=\"8\" y=\"4\"/><translate y=\"0.5\"/></transform></texture></bsdf>",
    );
    assert_eq!((board.color, board.textures.len()), (Rgb::ONE, 1));
    let scene = read(
        "<sensor type=\"perspective\"/><shape type=\"cube\"><bsdf type=\"diffuse\"><texture type=\"checkerboard\" name=\"reflectance\">\
         <transform name=\"to_uv\"><scale x=\"8\" y=\"4\"/><translate y=\"0.5\"/></transform></texture></bsdf></shape>",
    );
    let texture = &scene.textures[0];
    // Mitsuba's v' = 4 v + 0.5 with v = 1 - v here, and the same of v'.
    assert_eq!((texture.scale, texture.offset), ([8.0, 4.0], [0.0, -3.5]));
    assert_eq!(texture.shear, [0.0, 0.0]);
    let TextureData::Float(texels) = &texture.data else { panic!("{texture:?}") };
    assert_eq!((texels[0][0], texels[1][0], texture.bilinear), (0.4, 0.2, false));
    // Where it is a number, Mitsuba's other function is asked, which has the colours swapped.
    let scene = read(
        "<sensor type=\"perspective\"/><shape type=\"cube\"><bsdf type=\"mask\"><texture type=\"checkerboard\" name=\"opacity\"/>\
         <bsdf type=\"diffuse\"/></bsdf></shape>",
    );
    let TextureData::Float(texels) = &scene.textures[0].data else { panic!("{:?}", scene.textures) };
    assert_eq!((texels[0][0], texels[1][0]), (0.2, 0.4));
}

#[test]
fn a_texture_is_turned_by_to_uv() {
    let scene = read(
        "<sensor type=\"perspective\"/><shape type=\"cube\"><bsdf type=\"diffuse\"><texture type=\"checkerboard\" name=\"reflectance\">\
         <transform name=\"to_uv\"><matrix value=\"2 3 0 5  7 11 0 13  0 0 1 0  0 0 0 1\"/></transform></texture></bsdf></shape>",
    );
    let texture = &scene.textures[0];
    let here = |u: f32, v: f32| {
        let [s, h, o] = [texture.scale, texture.shear, texture.offset];
        [u * s[0] + v * h[0] + o[0], v * s[1] + u * h[1] + o[1]]
    };
    // Mitsuba's (0.25, 0.5) goes to (2 u + 3 v + 5, 7 u + 11 v + 13).
    let (u, v) = (0.25, 0.5);
    assert_eq!(here(u, 1.0 - v), [2.0 * u + 3.0 * v + 5.0, 1.0 - (7.0 * u + 11.0 * v + 13.0)]);
}

#[test]
fn depths_count_surfaces_instead_of_edges() {
    let depth = |text: &str| {
        let value =
            if text.is_empty() { String::new() } else { format!("<integer name=\"max_depth\" value=\"{text}\"/>") };
        read(&format!("{LEAST}<integrator type=\"path\">{value}</integrator>")).settings.max_depth
    };
    assert_eq!(["0", "1", "2", "6", "-1", "", "1000"].map(depth), [0, 0, 1, 5, 64, 64, 64]);
    let wrapped = read(&format!(
        "{LEAST}<integrator type=\"moment\"><integrator type=\"path\"><integer name=\"max_depth\" value=\"3\"/></integrator></integrator>"
    ));
    assert_eq!((wrapped.settings.integrator, wrapped.settings.rr_depth), (Integrator::Path, 5));
    let particles = read(&format!("{LEAST}<integrator type=\"ptracer\"/>"));
    assert_eq!(particles.settings.integrator, Integrator::Path);
    assert!(particles.warnings[0].contains("\"ptracer\" is read as \"path\""), "{:?}", particles.warnings);
    let direct = read(&format!("{LEAST}<integrator type=\"direct\"/>")).settings;
    assert_eq!((direct.integrator, direct.max_depth), (Integrator::Direct, 1));
    assert_eq!((wrapped.settings.max_depth, wrapped.warnings.iter().filter(|w| w.contains("moment")).count()), (2, 0));
}

#[test]
fn filters_and_samplers_are_those_of_the_same_name() {
    let scene = |inner: &str| read(&format!("<sensor type=\"perspective\">{inner}</sensor><shape type=\"sphere\"/>"));
    for (filter, expected) in [
        ("<rfilter type=\"box\"/>", Filter::Box { radius: 0.5 }),
        ("<rfilter type=\"tent\"/>", Filter::Tent { radius: 1.0 }),
        (
            "<rfilter type=\"gaussian\"><float name=\"stddev\" value=\"0.25\"/></rfilter>",
            Filter::Gaussian { radius: 1.0, sigma: 0.25 },
        ),
        ("<rfilter type=\"mitchell\"/>", Filter::Mitchell { radius: 2.0, b: 1.0 / 3.0, c: 1.0 / 3.0 }),
    ] {
        assert_eq!(scene(&format!("<film type=\"hdrfilm\">{filter}</film>")).film.filter, expected);
    }
    for (sampler, expected) in
        [("independent", Sampler::Independent), ("stratified", Sampler::Stratified), ("multijitter", Sampler::Sobol)]
    {
        let settings =
            scene(&format!("<sampler type=\"{sampler}\"><integer name=\"seed\" value=\"7\"/></sampler>")).settings;
        assert_eq!((settings.sampler, settings.samples, settings.seed), (expected, 4, 7));
    }
}
