//! MTL as programs write it, in pictures and in the words of our models.

use super::support::{Folder, look, mean, near};
use glam::Vec3;
use gonio::scene::*;

const SQUARE: &str = "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\n\
                      f 1/1 2/2 3/3 4/4\n";

/// The square in the material that the lines `keys` make. Pictures: `step.png` is 0 on the left and 1 on the right, `cut.png`
/// the same in its alpha channel alone, `normals.png` and `heights.png` what they say.
fn scene(keys: &str) -> Scene {
    let folder = Folder::new(&[("a.obj", SQUARE.as_bytes()), ("m.mtl", format!("newmtl m\n{keys}\n").as_bytes())]);
    folder.picture("step.png", 2, &[[0, 0, 0, 255], [255; 4]]);
    folder.picture("cut.png", 2, &[[255, 0, 0, 0], [255, 0, 0, 255]]);
    folder.picture("normals.png", 2, &[[128, 128, 255, 255], [218, 128, 218, 255]]);
    folder.picture("heights.png", 2, &[[202, 202, 202, 255], [203, 203, 203, 255]]);
    folder.picture("half.png", 1, &[[128, 128, 128, 255]]);
    folder.load("a.obj")
}

fn material(keys: &str) -> Material {
    scene(keys).materials.swap_remove(0)
}

/// What a white sky around a square of this material makes of it: the share of light that it gives back.
fn furnace(keys: &str) -> f32 {
    let mut scene = scene(keys);
    scene.materials[0].two_sided = true;
    mean(&look(scene, Integrator::Path, 1.0, 64), 4..28, 4..28).x
}

#[test]
fn no_material_gives_back_more_light_than_comes() {
    // MeshLab writes this for everything that has a texture; its highlight is none.
    assert!((furnace("Ka 0.2 0.2 0.2\nKd 1 1 1\nKs 1 1 1\nTr 0\nillum 2\nNs 0") - 1.0).abs() < 0.01);
    assert_eq!(material("Kd 1 1 1\nKs 1 1 1\nNs 0").model, Model::Lambert);
    for exponent in ["1", "1.5", "2", "4", "6", "10", "40", "1000"] {
        for keys in ["Kd 1 1 1\nKs 1 1 1", "Kd 0 0 0\nKs 1 1 1", "Kd .5 .5 .5\nKs .9 .9 .9", "Kd .9 .9 .9\nKs .2 .2 .2"]
        {
            let keys = format!("{keys}\nNs {exponent}");
            let found = furnace(&keys);
            assert!(found < 1.01, "{keys:?}: {found}");
            let Material { color, k_s, .. } = material(&keys);
            // Blinn's lobe gives back 8 k_s / (n + 2) at most.
            let most = color.x + k_s * 8.0 / (exponent.parse::<f32>().expect("a number") + 2.0);
            assert!(most < 1.000_01, "{keys:?}: {most}");
        }
    }
}

#[test]
fn highlights_that_keep_energy_stay_as_written() {
    let Material { model, color, k_s, .. } = material("Kd .8 .8 .8\nKs .5 .5 .5\nNs 250\nillum 2");
    assert_eq!((model, color, k_s), (Model::BlinnPhong { exponent: 250.0 }, Rgb::splat(0.8), 0.5), "Blender's default");
    let Material { color, k_s, specular_color, .. } = material("Kd .2 0 0\nKs 0 .5 .25\nNs 2\nillum 2");
    assert_eq!((color, k_s, specular_color), (Rgb::new(0.2, 0.0, 0.0), 0.25, Rgb::new(0.0, 1.0, 0.5)), "4 (n + 2) / 8");
}

#[test]
fn tr_of_vtk_is_opaque_and_d_counts_before_tr() {
    let covered = |keys: &str| match material(keys).transparency {
        Some(Transparency::Interpolated { k_t }) => 1.0 - k_t,
        other => {
            assert_eq!(other, None);
            1.0
        }
    };
    let cases = [
        ("Tr 1", 1.0),
        ("Tr 0", 1.0),
        ("Tr .25", 0.75),
        ("tr 0.25", 0.75),
        ("d 1\nTr 1", 1.0),
        ("Tr 0\nd .5", 0.5),
        ("d .5\nTr 0", 0.5),
        ("d 0\nTr 1", 0.0),
    ];
    for (keys, expected) in cases {
        assert_eq!(covered(keys), expected, "{keys:?}");
    }
    let picture = look(scene("illum 0\nKd .8 .4 .1\nTr 1"), Integrator::Local, 0.0, 1);
    near(mean(&picture, 4..28, 4..28), Vec3::new(0.8, 0.4, 0.1), 1e-3);
}

/// The square's left and right quarters, at the middles of the two texels.
fn sides(scene: Scene, integrator: Integrator, sky: f32) -> [Vec3; 2] {
    let picture = look(scene, integrator, sky, 64);
    [mean(&picture, 7..9, 4..28), mean(&picture, 23..25, 4..28)]
}

#[test]
fn a_picture_of_holes_lets_through_what_is_behind() {
    let cases = [
        "illum 0\nKd 1 1 1\nmap_d step.png",
        "illum 0\nKd 1 1 1\nd 1\nmap_d step.png",
        // Some write 0 where a picture is to say it.
        "illum 0\nKd 1 1 1\nd 0\nmap_d step.png",
        "illum 0\nKd 1 1 1\nmap_d cut.png",
        "illum 0\nKd 1 1 1\nmap_d -imfchan m cut.png",
        "illum 0\nKd 1 1 1\nMAP_D step.png -clamp on",
    ];
    for keys in cases {
        let [hole, leaf] = sides(scene(keys), Integrator::Local, 0.25);
        near(hole, Vec3::splat(0.25), 0.05);
        near(leaf, Vec3::ONE, 0.05);
    }
    // Between the middles of texels their values mix: at u = 1/4 +- 1/16 the leaf covers an eighth.
    let picture = look(scene(cases[0]), Integrator::Local, 0.25, 64);
    near(mean(&picture, 4..12, 4..28), Vec3::splat(0.25 + 0.75 / 8.0), 0.01);
    let half = material("d .5\nmap_d step.png");
    assert_eq!((half.opacity, half.transparency), (0.5, None));
    assert_eq!(half.textures[0].parameter, Parameter::Opacity);
}

#[test]
fn a_picture_of_light_glows() {
    for keys in [
        "illum 1\nKd 0 0 0\nKe 1 1 1\nmap_Ke step.png",
        "Kd 0 0 0\nKe 0 0 0\nmap_ke step.png",
        "Kd 0 0 0\nmap_Ke step.png",
    ] {
        let [dark, bright] = sides(scene(keys), Integrator::Path, 0.0);
        near(dark, Vec3::ZERO, 0.05);
        near(bright, Vec3::ONE, 0.05);
    }
    assert_eq!(material("Ke 3 2 1\nmap_Ke step.png").emission, Rgb::new(3.0, 2.0, 1.0));
}

#[test]
fn pictures_of_highlights_normals_and_heights_are_bound() {
    let bound = |keys: &str, parameter| {
        let material = material(keys);
        let binding = material.textures.iter().find(|binding| binding.parameter == parameter);
        binding.map(|binding| (binding.channel, binding.scale))
    };
    assert_eq!(bound("Ks .5 .5 .5\nmap_Ks step.png", Parameter::SpecularColor), Some((Channel::Rgb, 1.0)));
    let specular = material("Kd .1 .1 .1\nmap_Ks step.png");
    assert_eq!((specular.model, specular.k_s), (Model::BlinnPhong { exponent: 32.0 }, 1.0), "white times the picture");
    assert_eq!(bound("norm normals.png", Parameter::Normal), Some((Channel::Rgb, 1.0)));
    assert_eq!(bound("norm -bm 0.5 heights.png", Parameter::Normal), Some((Channel::Rgb, 0.5)), "what it says counts");
    // Blender calls its normal maps bump maps.
    assert_eq!(bound("map_Bump -bm 0.7 normals.png", Parameter::Normal), Some((Channel::Rgb, 0.7)));
    // The picture is two units wide on the square; white is a fiftieth of that high.
    for keys in ["bump heights.png", "map_Bump heights.png", "map_bump -bm 1 heights.png"] {
        let (channel, height) = bound(keys, Parameter::Bump).expect("bound");
        assert!(channel == Channel::R && (height - 0.04).abs() < 1e-6, "{keys}: {height}");
    }
    let (_, height) = bound("bump -bm 3 -s 2 2 heights.png", Parameter::Bump).expect("bound");
    assert!((height - 0.06).abs() < 1e-6, "{height}");
}

#[test]
fn physically_based_keys_make_a_principled_material() {
    let principled = |keys: &str| match material(keys).model {
        Model::Principled(principled) => principled,
        other => panic!("{other:?}"),
    };
    // Blender's coat of weight .5.
    let coat = principled(
        "Kd .8 .4 .1\nKs .5 .5 .5\nNi 1.5\nillum 2\nPr .5\nPm 0\nPs 0.25\nPc 2\nPcr .03\naniso .1\nanisor 0",
    );
    let expected =
        Principled { roughness: 0.5, sheen: 0.25, clearcoat: 0.5, anisotropic: 0.1, ..Principled::default() };
    assert_eq!(Principled { clearcoat_gloss: 0.0, ..coat }, expected);
    // The coat's alpha, .1 to .001, is the square of its roughness.
    assert!((0.1 - 0.099 * coat.clearcoat_gloss - 0.0009).abs() < 0.000_2, "{}", coat.clearcoat_gloss);
    assert_eq!(material("Kd .8 .4 .1\nPr .5").color, Rgb::new(0.8, 0.4, 0.1));
    let metal = material("Kd .8 .4 .1\nNi 1.5\nillum 3\nPr .4\nPm 1");
    assert!(matches!(metal.model, Model::Principled(Principled { metallic: 1.0, roughness: 0.4, .. })));
    assert_eq!(material("Kd .8 .4 .1\nPr 0\nPm 1").model, Model::Mirror);
    assert_eq!(principled("Ni 1\nPr .3").eta, 1.5, "an index of 1 is none");
    assert_eq!(principled("Pc 9").clearcoat, 1.0);
    assert_eq!(principled("Pr 7\nPm -1").roughness, 1.0, "shares are 0 to 1");
    let turned = scene("Pr .5\naniso .5\nanisor .25");
    assert!(turned.warnings[0].ends_with("ignored: anisor"), "{:?}", turned.warnings);
    assert!(scene("Pr .5\naniso 0\nanisor .25").warnings.is_empty());
}

#[test]
fn pictures_of_roughness_metal_sheen_and_coat_are_bound() {
    let keys =
        "Pr 0\nmap_Pr half.png\nmap_Pm half.png\nmap_Ps half.png\nPc 2\nmap_Pc half.png\naniso .5\nmap_aniso half.png";
    let all = material(keys);
    let parameters: Vec<Parameter> = all.textures.iter().map(|binding| binding.parameter).collect();
    use Parameter::{Anisotropic, Clearcoat, Metallic, Roughness, Sheen};
    assert_eq!(parameters, [Roughness, Metallic, Sheen, Clearcoat, Anisotropic]);
    let Model::Principled(principled) = all.model else { panic!("{:?}", all.model) };
    let expected = Principled {
        roughness: 1.0,
        metallic: 1.0,
        sheen: 1.0,
        clearcoat: 0.5,
        anisotropic: 0.5,
        clearcoat_gloss: 1.0,
        ..Principled::default()
    };
    assert_eq!(principled, expected);
    assert!(matches!(material("map_refl half.png").model, Model::Principled(_)), "Blender's metal");
    // Of an exponent the picture is a factor; without one it is a roughness, as Blender writes it.
    let texel = |keys: &str| {
        let scene = scene(keys);
        let binding = scene.materials[0].textures[0];
        assert_eq!((binding.parameter, binding.channel), (Parameter::Roughness, Channel::R));
        let TextureData::Float(texels) = &scene.textures[binding.texture.0 as usize].data else { panic!("floats") };
        f64::from(texels[0][0])
    };
    let half = 128.0 / 255.0;
    assert!((texel("map_Ns half.png") - half).abs() < 1e-6);
    // alpha = sqrt(2 / (n + 2)) is the square of the roughness.
    let alpha = texel("Ns 100\nmap_Ns half.png").powi(2);
    assert!((alpha - (2.0f64 / (100.0 * half + 2.0)).sqrt()).abs() < 1e-6, "{alpha}");
}

#[test]
fn a_material_lights_up_where_its_picture_says_under_every_model() {
    // A mirror-like metal in a white sky is its base colour; rough by a picture it still is within what facets lose.
    let bright = furnace("Kd 1 1 1\nPr .2\nPm 1");
    assert!((0.9..1.05).contains(&bright), "{bright}");
    assert!(furnace("Kd 1 1 1\nmap_Ns half.png") < 1.35, "principled layers do not shade each other");
}
