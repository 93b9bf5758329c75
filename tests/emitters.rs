//! What `path` samples: the environment's sampler against its density, areas, and the choice among emitters.

#[path = "common/chi_square.rs"]
mod chi_square;
#[path = "common/mod.rs"]
mod common;

use chi_square::{Random, direction, integrate_cell, test_sampler};
use common::{empty_scene, globe, object};
use glam::{Vec2, Vec3};
use gonio::bake::{SceneData, bake};
use gonio::layout::{EMITTER_ENVIRONMENT, EMITTER_LIGHT, EMITTER_SPHERE, EMITTER_TRIANGLE, Emitter, KIND_SPHERE};
use gonio::scene::*;
use gonio::shading::environment::{background, equirectangular_direction, pdf_environment, sample_environment};
use gonio::shading::sampling::SampleKey;
use gonio::trace::surface::Surface;
use gonio::transport::emitter::{choose_emitter, pdf_emitter, sample_emitter};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

fn empty() -> Scene {
    let mut scene = empty_scene();
    scene.settings.integrator = Integrator::Path;
    scene
}

fn sky(width: u32, height: u32, texels: Vec<[f32; 4]>, turn: f64) -> SceneData {
    let mut scene = empty();
    scene.textures = vec![Texture {
        name: "sky".into(),
        width,
        height,
        data: TextureData::Float(Arc::new(texels)),
        wrap_u: Wrap::Repeat,
        wrap_v: Wrap::Clamp,
        bilinear: true,
        scale: [1.0; 2],
        offset: [0.0; 2],
        mipmap: false,
        extrapolated: false,
        shear: [0.0; 2],
    }];
    let to_world = Transform::rotate(Vec3::new(0.2, 1.0, -0.4), turn);
    scene.background = Background::Image(Environment { texture: TextureId(0), scale: Rgb::splat(0.5), to_world });
    bake(&scene).unwrap()
}

/// Dark and bright texels, a row of black ones, and one sun.
fn patchy(width: u32, height: u32) -> SceneData {
    let mut random = Random(7);
    let texel = |index: u32| {
        let (x, y) = (index % width, index / width);
        let grey = match (x, y) {
            (3, 2) => 300.0,
            (_, 4) => 0.0,
            _ => random.unit() * random.unit(),
        };
        [grey, 2.0 * grey, 0.5 * grey, 1.0]
    };
    sky(width, height, (0..width * height).map(texel).collect(), 0.7)
}

fn gradient(bottom: f32, top: f32) -> SceneData {
    let mut scene = empty();
    scene.background = Background::Gradient { bottom: Rgb::splat(bottom), top: Rgb::splat(top) };
    bake(&scene).unwrap()
}

fn skies() -> Vec<(&'static str, SceneData)> {
    vec![
        ("patchy", patchy(12, 7)),
        ("one texel", sky(1, 1, vec![[1.0; 4]], 0.0)),
        ("two columns", sky(2, 1, vec![[1.0; 4], [5.0; 4]], 2.0)),
        ("flat", gradient(0.5, 0.5)),
        ("dark below", gradient(0.0, 2.0)),
        ("steep", gradient(3.0, 1.0)),
    ]
}

#[test]
fn the_environments_sampler_follows_its_density_which_integrates_to_1() {
    for (name, data) in skies() {
        let scene = data.view();
        let mut integral = 0.0;
        // The test knows the upper hemisphere only; the lower one is looked at upside down.
        for side in [1.0f32, -1.0] {
            let turned = |w: Vec3| Vec3::new(w.x, w.y, w.z * side);
            let mut random = Random(11);
            let sample = || {
                let drawn = sample_environment(&scene, random.unit2());
                let seen = turned(drawn.wi);
                (drawn.pdf_solid_angle > 0.0 && seen.z > 0.0).then_some(seen)
            };
            let (result, part) = test_sampler(200_000, sample, &|w| f64::from(pdf_environment(&scene, turned(w))));
            integral += part;
            // Twelve tests in all.
            assert!(result.p_value > 1.0e-3 / 12.0, "{name}, side {side}: {result:?}");
        }
        assert!((integral - 1.0).abs() < 2.0e-3, "{name}: the density integrates to {integral}");
    }
}

#[test]
fn a_sample_of_the_environment_knows_its_density_and_radiance() {
    for (name, data) in skies() {
        let scene = data.view();
        let mut random = Random(5);
        for _ in 0..20_000 {
            let drawn = sample_environment(&scene, random.unit2());
            if drawn.pdf_solid_angle == 0.0 {
                continue;
            }
            let density = pdf_environment(&scene, drawn.wi);
            let seen = background(&scene, drawn.wi).truncate();
            assert!((drawn.wi.length() - 1.0).abs() < 1.0e-5, "{name}: {drawn:?}");
            // Through angles and back: a few 1e-7 turns, across which a patchy sky changes by many times its value.
            let near = |a: f32, b: f32| (a - b).abs() <= 2.0e-3 * a.abs().max(b.abs()) + 1.0e-3;
            assert!(near(density, drawn.pdf_solid_angle), "{name}: {drawn:?}, but {density}");
            assert!((0..3).all(|k| near(seen[k], drawn.radiance[k])), "{name}: {drawn:?}, but {seen}");
        }
    }
}

#[test]
fn where_the_environment_shines_it_is_sampled() {
    let data = patchy(12, 7);
    let scene = data.view();
    let mut random = Random(3);
    for _ in 0..100_000 {
        let w = equirectangular_direction(random.unit2());
        let bright = background(&scene, w).y > 1.0e-3;
        assert!(!bright || pdf_environment(&scene, w) > 0.0, "{w}");
    }
}

#[test]
fn the_irradiance_of_an_image_is_that_of_its_texels() {
    // Mean of radiance over density, against the integral over small cells.
    let data = patchy(12, 7);
    let scene = data.view();
    let mut random = Random(9);
    let count = 400_000;
    let mut sum = 0.0;
    for _ in 0..count {
        let drawn = sample_environment(&scene, random.unit2());
        if drawn.pdf_solid_angle > 0.0 {
            sum += f64::from(drawn.radiance.y) / f64::from(drawn.pdf_solid_angle);
        }
    }
    let radiance = |w: Vec3| f64::from(background(&scene, w).y);
    let exact = integrate_cell(&radiance, (-1.0, 1.0), (0.0, TAU), 200);
    assert!((sum / f64::from(count) / exact - 1.0).abs() < 5.0e-3, "{} and {exact}", sum / f64::from(count));
}

#[test]
fn images_lie_as_openexr_says() {
    let mut texels = vec![[0.0f32, 0.0, 0.0, 1.0]; 8 * 4];
    // Left half of the second row: u from 0 to .5 is x > 0.
    for x in 0..4 {
        texels[8 + x] = [1.0, 1.0, 1.0, 1.0];
    }
    texels[4] = [9.0, 9.0, 9.0, 1.0];
    let data = sky(8, 4, texels, 0.0);
    let seen = |w: Vec3| background(&data.view(), w.normalize()).y;
    assert!(seen(Vec3::new(1.0, 0.4, 0.0)) > 0.4, "+x is a quarter from the left");
    assert!(seen(Vec3::new(-1.0, 0.4, 0.0)) == 0.0);
    assert!(seen(Vec3::new(-0.2, 2.0, 1.0)) > 2.0, "+z is the centre, +y the top row");
    assert!(seen(Vec3::new(0.0, -1.0, 0.0)) == 0.0);
}

fn glow(radiance: f32) -> Material {
    Material { emission: Rgb::splat(radiance), ..Material::grey("glow") }
}

/// An ellipsoid, a mesh placed twice, a quad, three lights and a sky.
fn crowd() -> SceneData {
    let mut scene = empty();
    scene.materials = vec![Material::grey("grey"), glow(1.0), glow(50.0)];
    scene.meshes = vec![globe(4), shape::quad([1.0, 2.0], 1)];
    let place = |geometry, scale: Vec3, offset: Vec3, material| Object {
        material: Some(MaterialId(material)),
        ..object(geometry, Transform::scale(scale).then(Transform::translate(offset)))
    };
    scene.objects = vec![
        place(Geometry::Sphere, Vec3::new(1.0, 2.0, 0.5), Vec3::X * 4.0, 1),
        place(Geometry::Mesh(MeshId(0)), Vec3::ONE, Vec3::X * -4.0, 1),
        place(Geometry::Mesh(MeshId(0)), Vec3::new(-2.0, 1.0, 1.0), Vec3::Z * -6.0, 2),
        place(Geometry::Mesh(MeshId(1)), Vec3::ONE, Vec3::Y * 5.0, 1),
        place(Geometry::Mesh(MeshId(1)), Vec3::splat(9.0), Vec3::Y * -5.0, 0),
    ];
    let light = |kind| Light {
        name: "light".into(),
        kind,
        intensity: Rgb::ONE,
        unit: IntensityUnit::Radiometric,
        attenuation: Attenuation::InverseSquare,
        flaps: Flaps::NONE,
        casts_shadow: true,
        slide: None,
    };
    scene.lights = vec![
        light(LightKind::Point { position: Vec3::Y }),
        light(LightKind::Directional { direction: -Vec3::Y }),
        light(LightKind::Spot { position: Vec3::Y, direction: -Vec3::Y, inner: 0.1, outer: 0.2, exponent: 0.0 }),
    ];
    scene.background = Background::flat(Rgb::splat(0.1));
    bake(&scene).unwrap()
}

#[test]
fn emitters_are_chosen_as_often_as_their_density_says() {
    let data = crowd();
    let scene = data.view();
    let mut counts = vec![0u32; data.emitters.len()];
    let mut random = Random(1);
    let total = 4_000_000;
    for _ in 0..total {
        counts[choose_emitter(&scene, random.unit2()) as usize] += 1;
    }
    let mut sum = 0.0;
    for (index, (emitter, &count)) in data.emitters.iter().zip(&counts).enumerate() {
        let area = match emitter.kind {
            EMITTER_TRIANGLE => 0.5 * f64::from(emitter.edge1.cross(emitter.edge2).length()),
            _ => 1.0,
        };
        let wanted = f64::from(emitter.density) * area;
        let found = f64::from(count) / f64::from(total);
        let error = (wanted / f64::from(total)).sqrt();
        assert!((found - wanted).abs() < 5.5 * error, "emitter {index}: {found} instead of {wanted}");
        sum += wanted;
    }
    assert!((sum - 1.0).abs() < 1.0e-5, "probabilities add up to {sum}");
    let kinds = |kind| data.emitters.iter().filter(|emitter| emitter.kind == kind).count();
    let globe_faces = globe(4).triangles.len();
    assert_eq!(kinds(EMITTER_TRIANGLE), 2 * globe_faces + 2);
    assert_eq!([EMITTER_SPHERE, EMITTER_LIGHT, EMITTER_ENVIRONMENT].map(kinds), [1, 3, 1]);
    // Half of the choice is even among four objects, three lights and the sky.
    assert!(data.emitters.iter().filter(|e| e.kind >= EMITTER_SPHERE).all(|e| e.density >= 0.5 / 8.0));
}

/// Chooses the leaf of a glowing blend; there is none here.
fn any_key() -> SampleKey {
    SampleKey { sampling: 2, strata: 1, seed: 0, pixel: 0, sample_index: 0, path_id: 0 }
}

fn lit(position: Vec3) -> Surface {
    Surface {
        position,
        normal_geometric: Vec3::Y,
        normal: Vec3::Y,
        uv: Vec2::ZERO,
        color: Vec3::ONE,
        material: 0,
        object: 4,
        instance: 4,
        primitive: 0,
        kind: KIND_SPHERE,
        error: 0.0,
        cone_width: 0.0,
        cone_spread: 0.0,
    }
}

/// The surface that a sample of an emitter has reached.
fn reached(data: &SceneData, emitter: &Emitter, from: Vec3, wi: Vec3, distance: f32) -> Surface {
    let instance = &data.instances[emitter.instance as usize];
    let position = from + wi * distance;
    let kind = if emitter.kind == EMITTER_SPHERE { KIND_SPHERE } else { gonio::layout::KIND_MESH };
    Surface {
        position,
        normal_geometric: emitter.normal,
        material: instance.material,
        instance: emitter.instance,
        kind,
        ..lit(position)
    }
}

#[test]
fn the_density_of_a_light_sample_is_that_of_a_ray_that_meets_the_light() {
    let data = crowd();
    let scene = data.view();
    let mut random = Random(2);
    for position in [Vec3::ZERO, Vec3::new(4.1, 0.3, 0.1), Vec3::new(3.0, 5.0, -2.0), Vec3::new(4.0, 2.2, 0.0)] {
        for (index, emitter) in data.emitters.iter().enumerate().filter(|(_, e)| e.kind <= EMITTER_SPHERE) {
            for _ in 0..50 {
                let lit = sample_emitter(&scene, emitter, any_key(), &lit(position), random.unit2());
                if lit.pdf_solid_angle == 0.0 {
                    continue;
                }
                let surface = reached(&data, emitter, position, lit.wi, lit.distance);
                let density = pdf_emitter(&scene, position, lit.wi, lit.distance, &surface, surface.material);
                // Grazing light amplifies the rounding of the point.
                assert!(
                    (density / lit.pdf_solid_angle - 1.0).abs() < 1.0e-3,
                    "emitter {index} from {position}: {density} and {lit:?}"
                );
            }
        }
    }
}

/// Mean of cos / density over samples of an emitter: what a white floor facing `normal` receives of radiance 1.
fn irradiance(data: &SceneData, emitter: &Emitter, position: Vec3, normal: Vec3) -> f64 {
    let scene = data.view();
    let mut random = Random(4);
    let count = 200_000;
    let mut sum = 0.0;
    for _ in 0..count {
        let lit = sample_emitter(&scene, emitter, any_key(), &lit(position), random.unit2());
        if lit.pdf_solid_angle > 0.0 {
            sum += f64::from(normal.dot(lit.wi).max(0.0)) / f64::from(lit.pdf_solid_angle);
        }
    }
    sum * f64::from(emitter.density) / f64::from(count)
}

#[test]
fn spheres_are_sampled_over_their_visible_cap_near_and_far_and_from_inside() {
    let mut scene = empty();
    scene.materials = vec![glow(1.0)];
    scene.objects = vec![object(Geometry::Sphere, Transform::scale(Vec3::splat(2.0)))];
    let data = bake(&scene).unwrap();
    for distance in [2.001f32, 2.5, 10.0, 1000.0] {
        let found = irradiance(&data, &data.emitters[0], Vec3::Y * distance, -Vec3::Y);
        let wanted = PI * (2.0 / f64::from(distance)).powi(2);
        assert!((found / wanted - 1.0).abs() < 5.0e-3, "from {distance}: {found} instead of {wanted}");
    }
    for inside in [Vec3::ZERO, Vec3::new(0.3, -1.2, 0.8)] {
        let found = irradiance(&data, &data.emitters[0], inside, Vec3::Z);
        // Points close by are seen under large angles and drawn seldom: more noise than from outside.
        assert!((found / PI - 1.0).abs() < 0.02, "inside at {inside}: {found}");
    }
}

#[test]
fn an_ellipsoids_samples_fill_the_solid_angle_of_the_ellipsoid() {
    let mut scene = empty();
    scene.materials = vec![glow(1.0)];
    let (scale, offset) = (Vec3::new(1.0, 3.0, 0.5), Vec3::new(0.5, 0.0, 4.0));
    scene.objects = vec![object(Geometry::Sphere, Transform::scale(scale).then(Transform::translate(offset)))];
    let data = bake(&scene).unwrap();
    let emitter = &data.emitters[0];
    // By brute force: directions of the hemisphere that meet it.
    let hits = |w: Vec3| {
        let (o, d) = (-offset / scale, w / scale);
        let b = o.dot(d);
        if b < 0.0 && b * b >= d.dot(d) * (o.dot(o) - 1.0) { f64::from(w.z) } else { 0.0 }
    };
    let mut random = Random(8);
    let count = 2_000_000;
    let exact = (0..count).map(|_| hits(random.upper_direction())).sum::<f64>() * TAU / f64::from(count);
    let found = irradiance(&data, emitter, Vec3::ZERO, Vec3::Z);
    assert!((found / exact - 1.0).abs() < 0.01, "{found} instead of {exact}");
    assert!((direction(1.0, 0.0) - Vec3::Z).length() < 1.0e-6);
}
