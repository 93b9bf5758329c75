//! Bad scenes: each a clear error with its place.

use super::{LEAST, read, scene_text, try_files, try_read};
use gonio::scene::SceneError;

/// The message of an error, the temporary folder cut off: `a.xml:line:column: message`.
#[track_caller]
fn refusal(result: Result<gonio::scene::Scene, SceneError>) -> String {
    let text = result.map(|_| ()).expect_err("to be refused").to_string();
    text.find("a.xml").map_or(text.clone(), |place| text[place..].to_owned())
}

/// The only element stands on line 2.
#[track_caller]
fn refused(elements: &str, expected: &str) {
    let error = try_read(elements).map(|_| ()).expect_err("to be refused");
    assert!(matches!(error, SceneError::Bad { .. }), "{error}");
    let text = refusal(Err(error));
    assert!(text.starts_with(expected), "{text}\n{expected}");
}

#[test]
fn xml_that_is_not_well_formed_is_refused_where_it_breaks() {
    let broken = [
        ("<scene version=\"3.0.0\">\n  <shape type=\"sphere\">\n</scene>", "a.xml:3:1: not well-formed XML"),
        ("<scene version=\"3.0.0\">\n<shape type=sphere/></scene>", "a.xml:2:13: not well-formed XML"),
        ("", "a.xml:1:1: not well-formed XML"),
        ("<!DOCTYPE a [<!ENTITY b \"c\">]><scene version=\"3.0.0\">&b;</scene>", "a.xml:1:1: not well-formed XML"),
    ];
    for (text, expected) in broken {
        let found = refusal(try_files(&[("a.xml", text)], &[]));
        assert!(found.starts_with(expected), "{found}");
    }
}

#[test]
fn a_scene_says_its_version() {
    for (text, expected) in [
        ("<scene/>", "a.xml:1:1: <scene> needs the attribute \"version\""),
        ("<scene version=\"new\"/>", "a.xml:1:1: a scene has a version such as \"3.0.0\", found \"new\""),
        ("<bsdf type=\"diffuse\"/>", "a.xml:1:1: the root of a scene is <scene>, found <bsdf>"),
    ] {
        let found = refusal(try_files(&[("a.xml", text)], &[]));
        assert!(found.starts_with(expected), "{found}");
    }
}

#[test]
fn unknown_plugins_are_told_with_the_nearest_and_all_others() {
    refused("<bsdf type=\"difuse\"/>", "a.xml:2:13: the bsdf \"difuse\" is not supported; supported are diffuse, ");
    assert!(try_read("<bsdf type=\"difuse\"/>").unwrap_err().to_string().ends_with("; did you mean \"diffuse\"?"));
    refused("<shape type=\"hair\"/>", "a.xml:2:14: the shape \"hair\" is not supported; supported are obj, ply, ");
    refused("<medium type=\"homogeneous\"/>", "a.xml:2:1: <medium> is not supported: gonio reads surfaces, not media");
    refused("<shpe type=\"cube\"/>", "a.xml:2:1: <shpe> has no meaning in a scene, which holds shape, ");
}

#[test]
fn unknown_properties_are_told_with_the_nearest_and_all_others() {
    refused(
        "<bsdf type=\"diffuse\"><rgb name=\"reflectence\" value=\"1\"/></bsdf>",
        "a.xml:2:33: the bsdf \"diffuse\" has no property \"reflectence\"; it has reflectance; did you mean \"reflectance\"?",
    );
    refused(
        "<bsdf type=\"null\"><float name=\"a\" value=\"1\"/></bsdf>",
        "a.xml:2:32: the bsdf \"null\" has no property \"a\"; it has none",
    );
    refused(
        "<bsdf type=\"diffuse\"><rgb value=\"1\"/></bsdf>",
        "a.xml:2:22: <rgb> in the bsdf \"diffuse\" needs a name; it has reflectance",
    );
    refused(
        "<bsdf type=\"diffuse\"><bsdf type=\"null\"/></bsdf>",
        "a.xml:2:22: <bsdf> in the bsdf \"diffuse\", which holds no objects",
    );
    refused(
        "<bsdf type=\"diffuse\" colour=\"1\"/>",
        "a.xml:2:30: <bsdf> has no attribute \"colour\"; it has type, id, name",
    );
}

#[test]
fn values_of_the_wrong_type_or_range_are_refused_where_they_stand() {
    for (element, expected) in [
        ("<float name=\"radius\" value=\"wide\"/>", "a.xml:2:50: expected a number, found \"wide\""),
        ("<float name=\"radius\" value=\"nan\"/>", "a.xml:2:50: expected a number, found \"nan\", which is no number"),
        (
            "<float name=\"radius\" value=\"-2e12\"/>",
            "a.xml:2:50: expected a number, found \"-2e12\"; numbers are at least -1e12",
        ),
        (
            "<transform name=\"to_world\"><translate x=\"1e11\"/></transform>",
            "a.xml:2:22: object \"sphere\" is too large, too small or too far away: sizes from 1e-10",
        ),
        ("<float name=\"radius\" value=\"-1\"/>", "a.xml:2:22: \"radius\" must be a number from"),
        ("<string name=\"radius\" value=\"1\"/>", "a.xml:2:22: \"radius\" is a number, found <string>"),
        (
            "<float name=\"radius\" value=\"1\"/><float name=\"radius\" value=\"2\"/>",
            "a.xml:2:54: \"radius\" is written twice",
        ),
        ("<boolean name=\"flip_normals\" value=\"yes\"/>", "a.xml:2:58: \"flip_normals\" must be true or false"),
        ("<point name=\"center\" value=\"1, 2\"/>", "a.xml:2:50: expected 1 or 3 numbers, found 2"),
        ("<point name=\"center\" value=\"1\" x=\"2\"/>", "a.xml:2:56: \"value\" and \"x\", \"y\", \"z\" exclude"),
        ("<point name=\"center\" w=\"2\"/>", "a.xml:2:46: <point> has no attribute \"w\""),
    ] {
        refused(&format!("<shape type=\"sphere\">{element}</shape>"), expected);
    }
    refused(
        &"<shape type=\"serialized\"><integer name=\"shape_index\" value=\"1.5\"/></shape>"
            .replace("serialized\">", "serialized\"><string name=\"filename\" value=\"a.xml\"/>"),
        "a.xml:2:100: \"shape_index\" must be an integer",
    );
}

#[test]
fn colours_and_spectra_that_make_no_sense_are_refused() {
    for (value, expected) in [
        ("<rgb name=\"reflectance\" value=\"0.1 0.2\"/>", "a.xml:2:53: a colour is 1 or 3 numbers"),
        ("<rgb name=\"reflectance\" value=\"#12345\"/>", "a.xml:2:53: expected \"#rrggbb\""),
        ("<rgb name=\"reflectance\" value=\"2\"/>", "a.xml:2:53: a reflectance is at most 1"),
        ("<rgb name=\"reflectance\" value=\"-1\"/>", "a.xml:2:53: a colour has no negative part"),
        (
            "<spectrum name=\"reflectance\" value=\"400:1, 500\"/>",
            "a.xml:2:58: expected wavelength:value, found \"500\"",
        ),
        ("<spectrum name=\"reflectance\" value=\"500:1, 400:1\"/>", "a.xml:2:58: the wavelengths of a spectrum ascend"),
        ("<spectrum name=\"reflectance\" value=\"500:1\"/>", "a.xml:2:58: a spectrum has 2 to 65536 wavelengths"),
        ("<spectrum name=\"reflectance\" value=\"grey\"/>", "a.xml:2:58: a spectrum is a number or a list"),
    ] {
        refused(&format!("<bsdf type=\"diffuse\">{value}</bsdf>"), expected);
    }
    refused(
        "<bsdf type=\"conductor\"><string name=\"material\" value=\"Xx\"/></bsdf>",
        "a.xml:2:24: \"material\" must be one of a-C, Ag, Al, ",
    );
    refused(
        "<bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"diamant\"/></bsdf>",
        "a.xml:2:55: \"int_ior\" is a number or one of vacuum, ",
    );
}

#[test]
fn transforms_that_have_no_inverse_or_no_direction_are_refused() {
    for (steps, expected) in [
        ("<scale x=\"0\"/>", "a.xml:2:22: the transform flattens space"),
        ("<rotate angle=\"90\"/>", "a.xml:2:49: <rotate> needs an axis"),
        ("<rotate x=\"1\"/>", "a.xml:2:49: <rotate> needs the attribute \"angle\""),
        ("<lookat origin=\"0,0,0\" target=\"0,0,0\"/>", "a.xml:2:80: \"origin\" and \"target\" are the same point"),
        ("<lookat origin=\"0,0,0\" target=\"0,1,0\" up=\"0,1,0\"/>", "a.xml:2:91: \"up\" is parallel to the view"),
        ("<matrix value=\"1 0 0\"/>", "a.xml:2:64: expected 16 or 9 numbers, found 3"),
        ("<matrix value=\"1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1\"/>", "a.xml:2:64: the last row of an affine matrix"),
        ("<skew x=\"1\"/>", "a.xml:2:49: <skew> is no step of a transform"),
    ] {
        refused(&format!("<shape type=\"sphere\"><transform name=\"to_world\">{steps}</transform></shape>"), expected);
    }
}

#[test]
fn names_without_an_object_and_names_taken_twice_are_refused() {
    refused("<shape type=\"cube\"><ref id=\"wod\"/></shape>", "a.xml:2:29: there is no object with the id \"wod\"");
    refused(
        "<bsdf type=\"null\" id=\"a\"/><bsdf type=\"null\" id=\"a\"/>",
        "a.xml:2:49: the id \"a\" is taken by <bsdf> at",
    );
    refused("<alias id=\"a\" as=\"b\"/>", "a.xml:2:12: there is no object with the id \"a\" above");
    refused(
        "<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf>",
        "a.xml:2:1: more than 16 materials within each other; does one hold itself?",
    );
}

#[test]
fn parameters_without_a_value_and_defines_without_a_parameter_are_refused() {
    refused(
        "<default name=\"spp\" value=\"1\"/><bsdf type=\"$sp\"/>",
        "a.xml:2:44: the parameter \"$sp\" has no value",
    );
    let text = scene_text(&format!("<default name=\"spp\" value=\"1\"/>{LEAST}"));
    let found = refusal(try_files(&[("a.xml", &text)], &[("ssp", "4")]));
    assert_eq!(found, "a.xml: -D ssp: the scene has no parameter \"ssp\"; it has spp");
    let found = refusal(gonio::scene::load::load_with("a.toml".as_ref(), &[], &[("spp".to_owned(), "1".to_owned())]));
    assert_eq!(found, "a.toml: -D spp: only Mitsuba scenes (.xml) have parameters; --set changes keys of others");
}

#[test]
fn files_other_than_textures_that_are_missing_are_named_with_the_place_that_wants_them() {
    for element in
        ["<include filename=\"b.xml\"/>", "<shape type=\"obj\"><string name=\"filename\" value=\"b.xml\"/></shape>"]
    {
        let error = try_read(element).map(|_| ()).expect_err("no such file");
        assert!(matches!(error, SceneError::Io { .. }), "{error}");
        assert!(refusal(Err(error)).ends_with("no file \"b.xml\" beside the scene or in a <path> of it"));
    }
    refused("<path value=\"none\"/>", "a.xml:2:14: there is no folder \"none\"");
}

#[test]
fn files_that_include_themselves_end() {
    let found = refusal(try_files(&[("a.xml", &scene_text("<include filename=\"a.xml\"/>"))], &[]));
    assert_eq!(found, "a.xml:2:1: more than 15 files within each other; does one include itself?");
}

#[test]
fn deep_nesting_and_growing_parameters_end() {
    let deep = "<shape type=\"cube\">".repeat(100_000);
    let found = refusal(try_files(&[("a.xml", &format!("<scene version=\"3.0.0\">{deep}"))], &[]));
    assert!(found.contains("not well-formed XML"), "{found}");
    let closed = format!("{}{}", "<shape type=\"cube\">".repeat(80), "</shape>".repeat(80));
    refused(&closed, "a.xml:2:1217: more than 64 elements within each other");
    // Each parameter is two of the one before.
    let mut bomb = "<default name=\"a0\" value=\"0123456789\"/>".to_owned();
    for i in 1..40 {
        bomb.push_str(&format!("<default name=\"a{i}\" value=\"${{a{}}}${{a{}}}\"/>", i - 1, i - 1));
    }
    let found = refusal(try_read(&bomb));
    assert!(found.contains("parameters make this value too long"), "{found}");
}

#[test]
fn instances_groups_and_emitters_in_the_wrong_place_are_refused() {
    refused("<shape type=\"instance\"/>", "a.xml:2:1: an instance refers to a shapegroup");
    refused(
        "<shape type=\"cube\" id=\"a\"/><shape type=\"instance\"><ref id=\"a\"/></shape>",
        "a.xml:2:51: an instance shows a shapegroup",
    );
    refused(
        "<shape type=\"cube\"><emitter type=\"point\"/></shape>",
        "a.xml:2:20: a shape has an emitter of type \"area\"",
    );
    refused(
        "<emitter type=\"constant\"/><emitter type=\"constant\"/>",
        "a.xml:2:27: a second emitter around the scene",
    );
    refused(
        "<integrator type=\"path\"/><integrator type=\"direct\"/>",
        "a.xml:2:26: a second integrator; the first is at",
    );
    refused(
        "<shape type=\"merge\" id=\"a\"><ref id=\"a\"/></shape>",
        "a.xml:2:1: more than 16 shapes within each other; does one hold itself?",
    );
    refused(
        "<shape type=\"cube\"><bsdf type=\"null\"/><bsdf type=\"null\"/></shape>",
        "a.xml:2:39: a second bsdf in the shape \"cube\"",
    );
}

#[test]
fn text_between_elements_is_refused_and_comments_are_not() {
    refused("hello", "a.xml:1:");
    read(&format!("<!-- hello -->{LEAST}"));
}

#[test]
fn serialized_meshes_that_lie_are_refused_without_taking_memory() {
    let shape = "<shape type=\"serialized\"><string name=\"filename\" value=\"m.serialized\"/></shape>";
    let header = [0x1c, 0x04, 0x04, 0x00];
    let pack = |content: &[u8]| {
        let mut file = header.to_vec();
        file.extend(miniz_oxide::deflate::compress_to_vec_zlib(content, 6));
        file.extend([0; 8]);
        file.extend(1u32.to_le_bytes());
        file
    };
    let mesh = |vertices: u64, faces: u64, tail: &[u8]| {
        let mut content = 0x1000u32.to_le_bytes().to_vec();
        content.extend(b"name\0");
        content.extend(vertices.to_le_bytes());
        content.extend(faces.to_le_bytes());
        content.extend(tail);
        content
    };
    let nan = [f32::NAN.to_le_bytes(); 3].concat();
    let far = [vec![0u8; 12], [0u32, 0, 9].map(u32::to_le_bytes).concat()].concat();
    for (file, expected) in [
        (b"not a mesh".to_vec(), "byte 0: not a serialized mesh"),
        (vec![0x1c, 0x04, 0x09, 0x00], "version 9 of the format"),
        (header.to_vec(), "cannot be unpacked"),
        (pack(&mesh(1 << 60, 1 << 60, &[])), "it claims 1152921504606846976 vertices"),
        (pack(&mesh(1, 0, &nan)), "the position of vertex 0 is not finite"),
        (pack(&mesh(1, 1, &far)), "face 0 refers to vertex 9 of 1"),
        (pack(&mesh(0, 0, &[])), "the mesh has no faces"),
        (pack(&vec![0u8; 64 << 20]), "the mesh has no faces"),
        (pack(&[1, 2]), "the file ends early"),
    ] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::write(folder.path().join("m.serialized"), &file).expect("writable");
        std::fs::write(folder.path().join("a.xml"), scene_text(shape)).expect("writable");
        let found = refusal(gonio::scene::load::load(&folder.path().join("a.xml"), &[]));
        assert!(found.contains(expected), "{found}\n{expected}");
    }
}
