//! Maps on materials: normal and bump maps under any transform, what cones cover, patterns, and each parameter.

mod common;

use common::*;
use glam::{DVec3, Vec2, Vec3, Vec4};
use gonio::bake::{BakeError, SceneData, bake};
use gonio::layout::{
    CHANNEL_A, CHANNEL_B, CHANNEL_G, CHANNEL_R, CHANNEL_RGB, INVALID, PARAMETER_ANISOTROPIC, PARAMETER_MASK,
    PARAMETER_METALLIC, PARAMETER_OPACITY, PARAMETER_ROUGHNESS, PARAMETER_ROUGHNESS_U, PARAMETER_ROUGHNESS_V,
    PARAMETER_WEIGHT, Ray, T_INFINITE,
};
use gonio::scene::*;
use gonio::shading::closure::{Closure, closure_of};
use gonio::shading::footprint::{Footprint, UvGradients, cone_footprint, mapped_normal, raised_normal};
use gonio::shading::parameter::apply_parameter;
use gonio::shading::pattern::{checker, fractal_noise, gradient_noise, square_mean, zone_plate};
use gonio::shading::sampling::SampleKey;
use gonio::shading::texture::{Detail, filter_texture, texture_detail};
use gonio::trace::surface::{Surface, surface_at};
use gonio::trace::tangent::{gradients_at, sphere_tangents};
use gonio::trace::traverse::trace_closest;
use gonio::transport::DIMENSION_LEAF;
use gonio::transport::resolve::resolve_material;
use std::sync::Arc;

/// A square from -1 to 1 in x and y, facing +z, uv 0..1 to the right and up, or as `uv` makes them.
fn square(uv: impl Fn(Vec2) -> Vec2) -> Mesh {
    let corners = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    Mesh {
        name: "square".into(),
        positions: corners.map(|c| (c * 2.0 - Vec2::ONE).extend(0.0)).to_vec(),
        uvs: corners.map(uv).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// A scene of one thing whose only material binds `texture` to `parameter`.
fn textured(mesh: Option<Mesh>, transform: Transform, texture: Texture, parameter: Parameter, scale: f32) -> SceneData {
    let mut scene = scene_of(mesh.into_iter().collect());
    let geometry = if scene.meshes.is_empty() { Geometry::Sphere } else { Geometry::Mesh(MeshId(0)) };
    scene.objects = vec![object(geometry, transform)];
    scene.textures = vec![texture];
    scene.materials[0].color = Vec3::ONE;
    scene.materials[0].textures =
        vec![TextureBinding { parameter, texture: TextureId(0), channel: Channel::Rgb, scale }];
    bake(&scene).expect("bakes")
}

fn constant(texel: [f32; 4]) -> Texture {
    Texture::new("constant", 1, 1, TextureData::Float(Arc::new(vec![texel])))
}

/// The surface with its maps applied, and before.
fn seen(data: &SceneData, ray: &Ray) -> (Closure, Surface, Surface) {
    let view = data.view();
    let hit = trace_closest(&view, ray);
    assert_ne!(hit.instance, INVALID, "missed");
    let before = surface_at(&view, ray, &hit);
    let mut surface = before;
    let material = resolve_material(&view, ray.direction, &hit, key(0), DIMENSION_LEAF, &mut surface);
    (material, surface, before)
}

fn key(sample_index: u32) -> SampleKey {
    SampleKey { seed: 3, pixel: 7, sample_index, path_id: 0, sampling: 2, strata: 1 }
}

#[test]
fn a_texture_on_the_weight_of_a_blend_chooses_its_materials() {
    let mut scene = scene_of(vec![square(|c| c)]);
    let halves = TextureData::Float(Arc::new(vec![[0.0; 4], [0.5; 4]]));
    scene.textures = vec![Texture { bilinear: false, ..Texture::new("halves", 2, 1, halves) }];
    let blend = Model::Blend { weight: 1.0, a: MaterialId(1), b: MaterialId(2) };
    let textures =
        vec![TextureBinding { parameter: Parameter::Weight, texture: TextureId(0), channel: Channel::R, scale: 1.0 }];
    let leaf = |x: f32| Material { color: Rgb::splat(x), ..Material::grey("leaf") };
    scene.materials = vec![Material { model: blend, textures, ..Material::grey("blend") }, leaf(0.25), leaf(0.75)];
    let data = bake(&scene).expect("bakes");
    let view = data.view();
    // On the left always the first; on the right each as often.
    for (x, share) in [(-0.5, 0.0), (0.5, 0.5)] {
        let ray = ray(Vec3::new(x, 0.1, 3.0), Vec3::NEG_Z);
        let hit = trace_closest(&view, &ray);
        let seconds = (0..4000).filter(|&index| {
            let mut surface = surface_at(&view, &ray, &hit);
            let material = resolve_material(&view, ray.direction, &hit, key(index), DIMENSION_LEAF, &mut surface);
            assert_eq!(closure_of(&view, &data.materials[surface.material as usize]).color, material.color);
            material.color.x == 0.75
        });
        let found = seconds.count() as f32 / 4000.0;
        assert!((found - share).abs() < 0.04, "{found} of {share}");
    }
}

/// All ways to stand, some of them mirrored.
fn placements() -> Vec<Transform> {
    let turn = Transform::rotate(Vec3::new(1.0, 2.0, -0.5), 0.8);
    [DVec3::ONE, DVec3::new(-1.0, 1.0, 1.0), DVec3::new(2.0, -0.5, 1.0), DVec3::new(-3.0, -1.0, -1.0)]
        .into_iter()
        .map(|each| Transform(glam::DAffine3::from_scale(each)).then(turn).then(Transform::translate(Vec3::splat(3.0))))
        .collect()
}

#[test]
fn normal_maps_lean_the_way_their_coordinates_grow_on_mirrored_instances_and_mirrored_coordinates() {
    type Coordinates = fn(Vec2) -> Vec2;
    let coordinates: [Coordinates; 4] =
        [|c| c, |c| Vec2::new(1.0 - c.x, c.y), |c| Vec2::new(c.x, 1.0 - c.y), |c| Vec2::new(c.y * 2.0, c.x)];
    // Texels of 45 degrees towards +u, and towards +v.
    let lean = 0.5 + 0.5 * std::f32::consts::FRAC_1_SQRT_2;
    for transform in placements() {
        for uv in coordinates {
            for (texel, along) in [([lean, 0.5, lean, 1.0], 0), ([0.5, lean, lean, 1.0], 1)] {
                let data = textured(Some(square(uv)), transform, constant(texel), Parameter::Normal, 1.0);
                let place = |p: Vec3| transform.0.transform_point3(p.as_dvec3()).as_vec3();
                let (centre, eye) = (place(Vec3::new(0.1, 0.2, 0.0)), place(Vec3::new(0.3, 0.1, 4.0)));
                let (_, surface, before) = seen(&data, &ray(eye, (centre - eye).normalize()));
                // The way in which the coordinate grows, by its own values at neighbouring points of the square.
                let at = |p: Vec2| uv((p + Vec2::ONE) * 0.5)[along];
                let growth = Vec2::new(at(Vec2::X) - at(Vec2::NEG_X), at(Vec2::Y) - at(Vec2::NEG_Y));
                let way = (place(growth.extend(0.0)) - place(Vec3::ZERO)).normalize();
                let n = before.normal;
                assert!(n.dot(eye - centre) > 0.0, "the outside faces the eye");
                let flat = (way - n * n.dot(way)).normalize();
                let want = (flat + n).normalize();
                assert!((surface.normal - want).length() < 2e-4, "{} for {want} along {along}", surface.normal);
                assert!((surface.normal.length() - 1.0).abs() < 1e-6);
            }
        }
    }
}

#[test]
fn a_flat_normal_map_and_a_level_bump_map_change_nothing() {
    for transform in placements() {
        for mesh in [Some(square(|c| c)), None] {
            let eye = transform.0.transform_point3(DVec3::new(0.3, 0.2, 5.0)).as_vec3();
            let target = transform.0.transform_point3(DVec3::new(0.1, 0.2, 0.0)).as_vec3();
            let ray = ray(eye, (target - eye).normalize());
            let flat = textured(mesh.clone(), transform, constant([0.5, 0.5, 1.0, 1.0]), Parameter::Normal, 1.0);
            let (_, surface, before) = seen(&flat, &ray);
            assert!((surface.normal - before.normal).length() < 1e-6);
            let level = textured(mesh, transform, constant([0.7; 4]), Parameter::Bump, 5.0);
            let (_, surface, before) = seen(&level, &ray);
            assert!((surface.normal - before.normal).length() < 1e-6);
        }
    }
}

/// Heights that rise by `slope` per unit of u, 256 texels wide.
fn ramp(slope: f32) -> Texture {
    let texels = (0..256).map(|i| [slope * (i as f32 + 0.5) / 256.0; 4]).collect();
    Texture { wrap_u: Wrap::Clamp, ..Texture::new("ramp", 256, 1, TextureData::Float(Arc::new(texels))) }
}

#[test]
fn a_bump_map_turns_the_normal_as_the_raised_surface_would() {
    for transform in placements() {
        for slope in [0.25, -1.0, 3.0] {
            let data = textured(Some(square(|c| c)), transform, ramp(slope), Parameter::Bump, 2.0);
            let place = |p: Vec3| transform.0.transform_point3(p.as_dvec3()).as_vec3();
            let (centre, eye) = (place(Vec3::new(0.1, 0.2, 0.0)), place(Vec3::new(0.3, 0.1, 4.0)));
            let (_, surface, before) = seen(&data, &ray(eye, (centre - eye).normalize()));
            // u grows by 1 over the square's width, in which the surface rises by 2 slope along its normal.
            let right = place(Vec3::X) - place(Vec3::NEG_X);
            let up = place(Vec3::Y) - place(Vec3::NEG_Y);
            let raised = (right + before.normal * (2.0 * slope)).cross(up).normalize();
            let want = if raised.dot(before.normal) < 0.0 { -raised } else { raised };
            assert!((surface.normal - want).length() < 1e-3, "{} for {want}, slope {slope}", surface.normal);
        }
    }
}

#[test]
fn maps_never_turn_a_normal_below_the_surface() {
    let gradients = UvGradients { u: Vec3::X, v: Vec3::Y };
    for texel in [Vec3::new(1.0, 0.5, 0.0), Vec3::new(0.0, 0.0, 0.2), Vec3::new(0.5, 0.5, 0.0)] {
        let normal = mapped_normal(Vec3::Z, gradients, texel, 4.0);
        assert!(normal.z >= 0.9e-3 && (normal.length() - 1.0).abs() < 1e-5, "{texel}: {normal}");
    }
    let steep = raised_normal(Vec3::Z, gradients, 1e8, -1e8);
    assert!(steep.z >= 0.9e-3 && steep.x < -0.5, "{steep}");
    // Without coordinates there is nothing to lean towards, and no fault.
    let none = UvGradients::default();
    assert_eq!(raised_normal(Vec3::Z, none, 3.0, 4.0), Vec3::Z);
    assert!((mapped_normal(Vec3::Z, none, Vec3::new(0.5, 0.5, 1.0), 1.0) - Vec3::Z).length() < 1e-6);
}

#[test]
fn the_tangents_of_a_sphere_are_the_derivatives_of_its_points() {
    let at = |u: f64, v: f64| {
        let (longitude, latitude) = ((u - 0.5) * std::f64::consts::TAU, (v - 0.5) * std::f64::consts::PI);
        let r = latitude.cos();
        DVec3::new(r * longitude.sin(), latitude.sin(), r * longitude.cos())
    };
    for (u, v) in [(0.3, 0.4), (0.9, 0.7), (0.5, 0.05), (0.01, 0.5)] {
        let tangents = sphere_tangents(at(u, v).as_vec3());
        let h = 1e-6;
        let du = (at(u + h, v) - at(u - h, v)) / (2.0 * h);
        let dv = (at(u, v + h) - at(u, v - h)) / (2.0 * h);
        assert!((tangents.dp_du.as_dvec3() - du).length() < 1e-5, "{:?} {du}", tangents);
        assert!((tangents.dp_dv.as_dvec3() - dv).length() < 1e-5, "{:?} {dv}", tangents);
    }
    assert_eq!(sphere_tangents(Vec3::Y).dp_dv, Vec3::ZERO, "a pole has none");
}

#[test]
fn gradients_tell_how_coordinates_change_over_a_step() {
    let mut random = Random::new(5);
    for transform in placements() {
        let data = textured(
            Some(square(|c| Vec2::new(3.0 * c.x + c.y, c.y))),
            transform,
            constant([1.0; 4]),
            Parameter::Color,
            1.0,
        );
        let view = data.view();
        let place = |p: Vec3| transform.0.transform_point3(p.as_dvec3()).as_vec3();
        for _ in 0..50 {
            let (a, b) = (random.point(0.5) * Vec3::new(1.0, 1.0, 0.0), random.point(0.9) * Vec3::new(1.0, 1.0, 0.0));
            let eye = place(Vec3::new(0.2, 0.3, 3.0));
            let look = |p: Vec3| {
                let ray = ray(eye, (place(p) - eye).normalize());
                let hit = trace_closest(&view, &ray);
                (surface_at(&view, &ray, &hit), hit)
            };
            let ((first, hit), (second, _)) = (look(a), look(b));
            let gradients = gradients_at(&view, &first, &hit);
            let step = second.position - first.position;
            let change = Vec2::new(gradients.u.dot(step), gradients.v.dot(step));
            assert!((change - (second.uv - first.uv)).length() < 1e-4, "{change} for {}", second.uv - first.uv);
        }
    }
}

#[test]
fn a_slanted_cone_covers_an_ellipse() {
    let gradients = UvGradients { u: Vec3::X, v: Vec3::Y };
    // 60 degrees off the normal, in the plane of x and z.
    let direction = Vec3::new(0.866_025_4, 0.0, -0.5);
    let footprint = cone_footprint(gradients, Vec3::Z, direction, 0.01);
    assert!((footprint.along.abs() - Vec2::new(0.02, 0.0)).length() < 1e-6, "{footprint:?}");
    assert!((footprint.across.abs() - Vec2::new(0.0, 0.01)).length() < 1e-6, "{footprint:?}");
    let straight = cone_footprint(gradients, Vec3::Z, Vec3::NEG_Z, 0.01);
    assert!((straight.along.length() - 0.01).abs() < 1e-6 && (straight.across.length() - 0.01).abs() < 1e-6);
}

#[test]
fn cones_grow_with_distance_and_go_on_from_surfaces() {
    let data = textured(Some(square(|c| c)), Transform::default(), constant([1.0; 4]), Parameter::Color, 1.0);
    let mut ray = ray(Vec3::new(0.1, 0.2, 8.0), Vec3::NEG_Z);
    (ray.cone_width, ray.cone_spread) = (0.5, 0.125);
    let (_, surface, _) = seen(&data, &ray);
    assert_eq!((surface.cone_width, surface.cone_spread), (1.5, 0.125));
    let spawned = gonio::trace::spawn::spawn_ray(&surface, Vec3::Z, T_INFINITE);
    assert_eq!((spawned.cone_width, spawned.cone_spread), (1.5, 0.125));
}

/// A checkerboard of single texels, with or without mip levels.
fn board(size: u32, mipmap: bool) -> SceneData {
    let texel = |i: u32| [((i % size + i / size) % 2) as f32; 4];
    let data = TextureData::Float(Arc::new((0..size * size).map(texel).collect()));
    let texture = Texture { mipmap, ..Texture::new("board", size, size, data) };
    textured(Some(square(|c| c)), Transform::default(), texture, Parameter::Color, 1.0)
}

#[test]
fn a_checkerboard_far_away_is_an_even_grey() {
    let data = board(64, true);
    let base = data.textures[0];
    assert_eq!((base.level_count, data.textures[base.first_level as usize].width), (7, 32));
    for width in [4.0, 11.0, 64.0, 1000.0] {
        for uv in [Vec2::new(0.31, 0.77), Vec2::new(5.01, -3.2)] {
            let detail = Detail { spacing: Vec2::ZERO, width, probes: 1 };
            let texel = filter_texture(&data.view(), &base, uv, detail);
            assert!((texel.x - 0.5).abs() < 1e-6, "width {width}: {texel}");
        }
    }
    // At the width of a texel and below, what is there.
    let point = Detail { spacing: Vec2::ZERO, width: 0.5, probes: 1 };
    assert_eq!(filter_texture(&data.view(), &base, Vec2::splat(0.5) / 64.0, point).x, 1.0);
    // Half way from level 0 to level 1.
    let between = Detail { width: std::f32::consts::SQRT_2, ..point };
    let texel = filter_texture(&data.view(), &base, Vec2::splat(0.5) / 64.0, between);
    assert!((texel.x - 0.75).abs() < 1e-6, "{texel}");
}

#[test]
fn a_texture_without_mip_levels_ignores_what_a_pixel_covers() {
    let data = board(64, false);
    let wide = Footprint { along: Vec2::new(4.0, 0.0), across: Vec2::new(0.0, 1.0) };
    assert_eq!(texture_detail(&data.textures[0], wide), Detail { spacing: Vec2::ZERO, width: 0.0, probes: 1 });
}

#[test]
fn probes_line_up_along_the_longer_side() {
    let data = board(64, true);
    // 16 by 4 texels: four probes, four texels apart, each 4 wide.
    let footprint = Footprint { along: Vec2::new(0.0, 16.0 / 64.0), across: Vec2::new(4.0 / 64.0, 0.0) };
    let detail = texture_detail(&data.textures[0], footprint);
    assert_eq!((detail.probes, detail.width), (4, 4.0));
    assert!((detail.spacing - Vec2::new(0.0, 4.0 / 64.0)).length() < 1e-7);
    // More than eight to one blurs the shorter side too.
    let long = Footprint { along: Vec2::new(0.5, 0.0), across: Vec2::new(0.0, 1e-6) };
    let detail = texture_detail(&data.textures[0], long);
    assert_eq!((detail.probes, detail.width), (8, 4.0));
    // Stripes across v are averaged along v and kept along u.
    let stripes = |i: u32| [(i % 64 % 2) as f32; 4];
    let image = TextureData::Float(Arc::new((0..64 * 64).map(stripes).collect()));
    let texture = Texture { mipmap: true, ..Texture::new("stripes", 64, 64, image) };
    let data = textured(Some(square(|c| c)), Transform::default(), texture, Parameter::Color, 1.0);
    let thin = Footprint { along: Vec2::new(0.0, 8.0 / 64.0), across: Vec2::new(1.0 / 64.0, 0.0) };
    let detail = texture_detail(&data.textures[0], thin);
    let texel = filter_texture(&data.view(), &data.textures[0], Vec2::new(3.5, 20.0) / 64.0, detail);
    assert!((texel.x - 1.0).abs() < 1e-6 && detail.probes == 8, "{texel} {detail:?}");
}

#[test]
fn rotated_and_sheared_coordinates_follow_their_matrix() {
    let mut texture = constant([1.0; 4]);
    (texture.scale, texture.shear, texture.offset) = ([0.0, 0.0], [3.0, -2.0], [0.5, 0.25]);
    let data = textured(Some(square(|c| c)), Transform::default(), texture, Parameter::Color, 1.0);
    let uv = gonio::shading::coordinate::texture_uv(&data.textures[0], Vec2::new(0.25, 0.5));
    assert_eq!(uv, Vec2::new(2.0, -0.25));
}

/// Mean of `f` over a square of `width` around `uv`, by 200 x 200 points.
fn mean(f: impl Fn(Vec2) -> f32, uv: Vec2, width: f32) -> f32 {
    let n = 200;
    let mut sum = 0.0f64;
    for i in 0..n * n {
        let p = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32 - Vec2::splat(0.5);
        sum += f64::from(f(uv + p * width));
    }
    (sum / f64::from(n * n)) as f32
}

#[test]
fn a_checker_seen_through_a_pixel_is_the_mean_of_its_fields() {
    assert_eq!([checker(Vec2::splat(0.2), 0.0), checker(Vec2::new(0.7, 0.2), 0.0)], [0.0, 1.0]);
    assert_eq!([checker(Vec2::new(-0.2, 0.2), 0.0), checker(Vec2::new(-1.7, -3.3), 0.0)], [1.0, 1.0]);
    let mut random = Random::new(2);
    for _ in 0..40 {
        let uv = Vec2::new(random.range(-3.0, 3.0), random.range(-3.0, 3.0));
        for width in [0.01, 0.3, 0.5, 0.8, 1.7, 6.1] {
            let expected = mean(|p| checker(p, 0.0), uv, width);
            let got = checker(uv, width);
            // 200 points across: an edge is placed to 1/200 of the width, twice.
            assert!((got - expected).abs() < 0.011, "{uv} {width}: {got} for {expected}");
        }
    }
    for width in [0.5, 1.0, 2.0, 64.0] {
        assert!(square_mean(0.25, width).abs() <= 1.0);
    }
}

#[test]
fn noise_is_continuous_varied_and_within_bounds() {
    let mut random = Random::new(3);
    let (mut low, mut high, mut sum) = (1.0f32, -1.0f32, 0.0f64);
    for _ in 0..20_000 {
        let uv = Vec2::new(random.range(-200.0, 200.0), random.range(-200.0, 200.0));
        let value = fractal_noise(uv, 5, 0.5, 7, 0.0);
        assert!(value.abs() <= 1.0);
        (low, high, sum) = (low.min(value), high.max(value), sum + f64::from(value));
        let near = gradient_noise(uv + Vec2::splat(1e-3), 7) - gradient_noise(uv, 7);
        assert!(near.abs() < 0.02, "a jump of {near} at {uv}");
    }
    assert!(low < -0.45 && high > 0.45 && (sum / 20_000.0).abs() < 0.02, "{low} to {high}, mean {}", sum / 20_000.0);
    assert_eq!(gradient_noise(Vec2::new(3.0, -5.0), 7), 0.0, "zero on the lattice");
    assert_ne!(gradient_noise(Vec2::splat(0.3), 7), gradient_noise(Vec2::splat(0.3), 8), "a seed");
    // What is finer than the pixel is gone, and what is much coarser is not.
    assert_eq!(fractal_noise(Vec2::splat(0.3), 6, 0.5, 7, 0.6), 0.0);
    let smooth = fractal_noise(Vec2::splat(0.3), 6, 0.5, 7, 0.2);
    let first = gradient_noise(Vec2::splat(0.3), gonio::shading::sampling::hash_combine(7, 0));
    assert!((smooth - first / 1.968_75).abs() < 0.21 && smooth != 0.0);
}

#[test]
fn a_zone_plate_has_the_frequency_of_its_radius() {
    assert_eq!(zone_plate(Vec2::ZERO), 1.0);
    // Phase r^2 / 2: from r = 10 to the next crest it is 1 / 10 of a unit, less half its square.
    let next = 102.0f32.sqrt();
    assert!(
        (zone_plate(Vec2::new(10.0, 0.0)) - 1.0).abs() < 1e-5 && (zone_plate(Vec2::new(0.0, next)) - 1.0).abs() < 1e-4
    );
}

#[test]
fn each_parameter_takes_its_texture() {
    let cases = [
        (Parameter::Color, [0.5, 0.25, 0.125, 1.0]),
        (Parameter::SpecularColor, [0.5, 0.25, 0.125, 1.0]),
        (Parameter::Emission, [0.5, 0.25, 0.125, 1.0]),
        (Parameter::Roughness, [0.5, 0.9, 0.9, 1.0]),
        (Parameter::Opacity, [0.5, 0.9, 0.9, 1.0]),
    ];
    let eye = ray(Vec3::new(0.1, 0.2, 3.0), Vec3::NEG_Z);
    for (parameter, texel) in cases {
        let data = textured(Some(square(|c| c)), Transform::default(), constant(texel), parameter, 2.0);
        let data = data.altered(|data| data.materials[0].emission = Vec3::ONE);
        let (got, ..) = seen(&data, &eye);
        let mut want = closure_of(&data.view(), &data.materials[0]);
        let factor = Vec3::new(1.0, 0.5, 0.25);
        match parameter {
            Parameter::Color => want.color *= factor,
            Parameter::SpecularColor => want.specular_color *= factor,
            Parameter::Emission => want.emission *= factor,
            Parameter::Roughness => apply_parameter(&mut want, PARAMETER_ROUGHNESS, Vec3::ONE, 1.0),
            _ => {}
        }
        assert_eq!(got, want, "{parameter:?}");
    }
    let applied = |closure: Closure, parameter, texel: f32| {
        let mut closure = closure;
        apply_parameter(&mut closure, parameter, Vec3::splat(texel), 1.0);
        closure
    };
    let plain = Closure {
        alpha_u: 0.4,
        second_alpha_u: 0.2,
        alpha_v: 0.8,
        second_alpha_v: 0.1,
        roughness: 0.3,
        metallic: 0.5,
        blend: 0.5,
        ..Closure::default()
    };
    let rough = applied(plain, PARAMETER_ROUGHNESS, 0.5);
    assert_eq!([rough.alpha_u, rough.roughness], [0.2, 0.15]);
    assert_eq!(applied(plain, PARAMETER_ROUGHNESS, 0.0).alpha_u, 1.0e-3, "never sharper than this");
    let of = |c: Closure| [c.alpha_u, c.second_alpha_u, c.alpha_v, c.second_alpha_v];
    assert_eq!(of(applied(plain, PARAMETER_ROUGHNESS_U, 0.5)), [0.2, 0.1, 0.8, 0.1]);
    assert_eq!(of(applied(plain, PARAMETER_ROUGHNESS_V, 0.5)), [0.4, 0.2, 0.4, 0.05]);
    assert_eq!(applied(plain, PARAMETER_METALLIC, 0.5).metallic, 0.25);
    assert_eq!(applied(plain, PARAMETER_WEIGHT, 4.0).blend, 1.0, "at most 1");
    let shares = Closure {
        anisotropic: 0.1,
        spec_trans: 0.2,
        spec_tint: 0.3,
        sheen: 0.4,
        sheen_tint: 0.5,
        flatness: 0.6,
        clearcoat: 0.7,
        clearcoat_gloss: 0.8,
        ..plain
    };
    let of = |c: Closure| {
        let first = [c.anisotropic, c.spec_trans, c.spec_tint, c.sheen];
        [first, [c.sheen_tint, c.flatness, c.clearcoat, c.clearcoat_gloss]].concat()
    };
    for which in 0..8 {
        let mut want = of(shares);
        want[which as usize] *= 0.5;
        assert_eq!(of(applied(shares, PARAMETER_ANISOTROPIC + which, 0.5)), want, "{which}");
    }
    assert_eq!(applied(plain, PARAMETER_OPACITY, 0.25).k_t, 0.75);
    let masked = |texel: f32| {
        let mut half = Closure { k_t: 0.5, ..plain };
        apply_parameter(&mut half, PARAMETER_MASK, Vec3::splat(texel), 0.5);
        half.k_t
    };
    assert_eq!(applied(Closure { k_t: 0.5, ..plain }, PARAMETER_OPACITY, 0.5).k_t, 0.75, "half of a half");
    assert_eq!((masked(1.0), masked(0.9)), (0.0, 1.0));
}

#[test]
fn channels_are_told_apart() {
    let texel = Vec4::new(0.1, 0.2, 0.3, 0.4);
    for (channel, want) in [(CHANNEL_R, 0.1), (CHANNEL_G, 0.2), (CHANNEL_B, 0.3), (CHANNEL_A, 0.4), (CHANNEL_RGB, 0.2)]
    {
        assert_eq!(gonio::shading::parameter::channel_value(texel, channel).y, want);
    }
}

#[test]
fn more_textures_than_the_loop_reads_are_refused() {
    let mut scene = scene_of(vec![square(|c| c)]);
    scene.textures = vec![constant([1.0; 4])];
    scene.materials[0].textures = vec![TextureBinding::color(TextureId(0)); 17];
    assert!(matches!(bake(&scene), Err(BakeError::Textures { count: 17, .. })));
}
