//! Image textures: texel centres, wrapping, exact weights, formats, and coordinates at the edge.

use glam::{Vec2, Vec3};
use gonio::bake::SceneArrays;
use gonio::bake::srgb::srgb_table;
use gonio::layout::{
    MAGNIFY_BILINEAR, MAGNIFY_NEAREST, TEXEL_FLOAT, TEXEL_LINEAR8, TEXEL_SRGB8, Texture, WRAP_CLAMP, WRAP_MIRROR,
    WRAP_REPEAT,
};
use gonio::shading::texture::sample_texture;

/// Stored 4 x 2, from the top row down: value 10 * row from the bottom + column in lane 0, one word before it unused.
fn grid(magnify: u32, wrap: u32) -> (SceneArrays, Texture) {
    let mut scene = SceneArrays { tables: srgb_table(), texels: vec![0xdead_beef], ..Default::default() };
    for row in [1u32, 0] {
        for column in 0..4u32 {
            let value = (10 * row + column) as f32;
            scene.texels.extend([value, -value, 0.5, 1.0].map(f32::to_bits));
        }
    }
    let texture = Texture {
        width: 4,
        height: 2,
        first_word: 1,
        format: TEXEL_FLOAT,
        wrap_u: wrap,
        wrap_v: wrap,
        magnify,
        scale_u: 1.0,
        scale_v: 1.0,
        ..Default::default()
    };
    (scene, texture)
}

fn read(magnify: u32, wrap: u32, u: f32, v: f32) -> f32 {
    let (scene, texture) = grid(magnify, wrap);
    let texel = sample_texture(&scene.view(), &texture, Vec2::new(u, v));
    assert!((texel.y + texel.x).abs() < 1e-5 && texel.z == 0.5 && texel.w == 1.0, "{texel}");
    texel.x
}

#[test]
fn a_texel_centre_reads_that_texel_and_v_grows_upwards() {
    for wrap in [WRAP_REPEAT, WRAP_CLAMP, WRAP_MIRROR] {
        for magnify in [MAGNIFY_NEAREST, MAGNIFY_BILINEAR] {
            for (column, u) in [0.125, 0.375, 0.625, 0.875].into_iter().enumerate() {
                assert_eq!(read(magnify, wrap, u, 0.25), column as f32);
                assert_eq!(read(magnify, wrap, u, 0.75), 10.0 + column as f32);
            }
        }
    }
}

#[test]
fn bilinear_weights_are_exact_between_centres() {
    assert_eq!(read(MAGNIFY_BILINEAR, WRAP_CLAMP, 0.25, 0.25), 0.5);
    assert_eq!(read(MAGNIFY_BILINEAR, WRAP_CLAMP, 0.437_5, 0.25), 1.25);
    assert_eq!(read(MAGNIFY_BILINEAR, WRAP_CLAMP, 0.375, 0.5), 6.0);
    assert_eq!(read(MAGNIFY_BILINEAR, WRAP_CLAMP, 0.375, 0.437_5), 1.0 + 10.0 * 0.375);
    // One part in 2^12 between two texels, where hardware has steps of 2^-8.
    assert_eq!(read(MAGNIFY_BILINEAR, WRAP_CLAMP, 0.375 + 0.25 / 4096.0, 0.25), 1.0 + 1.0 / 4096.0);
}

#[test]
fn edges_wrap_clamp_or_mirror() {
    // u = 0 lies between the last and the first column.
    assert_eq!(read(MAGNIFY_BILINEAR, WRAP_REPEAT, 0.0, 0.25), 1.5);
    assert_eq!(read(MAGNIFY_BILINEAR, WRAP_REPEAT, 1.0, 0.25), 1.5);
    assert_eq!(read(MAGNIFY_BILINEAR, WRAP_CLAMP, 0.0, 0.25), 0.0);
    assert_eq!(read(MAGNIFY_BILINEAR, WRAP_CLAMP, 7.0, -3.0), 3.0);
    assert_eq!(read(MAGNIFY_BILINEAR, WRAP_MIRROR, 0.0, 0.25), 0.0);
    for (wrap, at) in [(WRAP_REPEAT, 0.0), (WRAP_CLAMP, 3.0), (WRAP_MIRROR, 3.0)] {
        assert_eq!(read(MAGNIFY_NEAREST, wrap, 1.1, 0.25), at, "wrap {wrap}");
    }
    for (wrap, at) in [(WRAP_REPEAT, 3.0), (WRAP_CLAMP, 0.0), (WRAP_MIRROR, 0.0)] {
        assert_eq!(read(MAGNIFY_NEAREST, wrap, -0.1, 0.25), at, "wrap {wrap}");
    }
    assert_eq!(read(MAGNIFY_NEAREST, WRAP_REPEAT, -2.875, 5.75), 10.0);
    // There and back: 1.375 is .625 from the right.
    assert_eq!(read(MAGNIFY_NEAREST, WRAP_MIRROR, 1.375, 0.25), 2.0);
    assert_eq!(read(MAGNIFY_NEAREST, WRAP_MIRROR, 2.125, 0.25), 0.0);
    assert_eq!(read(MAGNIFY_NEAREST, WRAP_MIRROR, -0.375, 0.25), 1.0);
}

#[test]
fn the_last_texel_owns_the_far_edge() {
    for wrap in [WRAP_CLAMP, WRAP_MIRROR] {
        assert_eq!(read(MAGNIFY_NEAREST, wrap, 1.0, 1.0), 13.0);
    }
    // Less than half an ULP below zero: the fraction rounds to 1.
    assert_eq!(read(MAGNIFY_NEAREST, WRAP_REPEAT, -1e-10, -1e-10), 13.0);
    assert_eq!(read(MAGNIFY_BILINEAR, WRAP_REPEAT, -1e-10, 0.25), 1.5);
}

#[test]
fn any_coordinate_is_safe() {
    let wild =
        [0.0f32, -0.0, 1e-45, -1e-38, 1e9, -1e9, 3e38, -3e38, 8_388_609.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
    for wrap in [WRAP_REPEAT, WRAP_CLAMP, WRAP_MIRROR, 77] {
        for magnify in [MAGNIFY_NEAREST, MAGNIFY_BILINEAR] {
            for u in wild {
                for v in wild {
                    let (scene, mut texture) = grid(magnify, wrap);
                    let texel = sample_texture(&scene.view(), &texture, Vec2::new(u, v));
                    assert!(texel.is_finite() && (0.0..=13.0).contains(&texel.x), "{u} {v}: {texel}");
                    // The texture's own scale may overflow what was finite.
                    texture.scale_u = 1e20;
                    texture.offset_v = f32::INFINITY;
                    assert!(sample_texture(&scene.view(), &texture, Vec2::new(u, v)).is_finite());
                }
            }
        }
    }
    assert_eq!(read(MAGNIFY_NEAREST, WRAP_CLAMP, f32::NAN, f32::NAN), 0.0);
    assert_eq!(read(MAGNIFY_NEAREST, WRAP_CLAMP, f32::INFINITY, 0.0), 0.0);
}

#[test]
fn scale_and_offset_apply_before_wrapping() {
    let (scene, mut texture) = grid(MAGNIFY_NEAREST, WRAP_REPEAT);
    texture.scale_u = 2.0;
    texture.offset_u = 0.25;
    texture.offset_v = 0.5;
    // u' = .3 * 2 + .25 = .85, v' = .1 + .5
    assert_eq!(sample_texture(&scene.view(), &texture, Vec2::new(0.3, 0.1)).x, 13.0);
}

#[test]
fn bytes_are_decoded_by_their_format() {
    let mut scene = SceneArrays { tables: srgb_table(), ..Default::default() };
    scene.texels = vec![u32::from_le_bytes([0, 128, 255, 51])];
    let mut texture =
        Texture { width: 1, height: 1, format: TEXEL_SRGB8, scale_u: 1.0, scale_v: 1.0, ..Default::default() };
    let srgb = sample_texture(&scene.view(), &texture, Vec2::splat(0.3));
    assert_eq!(srgb.truncate(), Vec3::new(0.0, scene.tables[128], 1.0));
    assert!((srgb.w - 0.2).abs() < 1e-7, "alpha is linear");
    assert!((srgb.y - 0.215_860_5).abs() < 1e-7);
    texture.format = TEXEL_LINEAR8;
    let linear = sample_texture(&scene.view(), &texture, Vec2::splat(0.3));
    assert_eq!((linear.x, linear.z, linear.w), (0.0, 1.0, srgb.w));
    assert!((linear.y - 128.0 / 255.0).abs() < 1e-7);
}

#[test]
fn an_even_image_stays_exactly_even_under_bilinear_reading() {
    let mut scene = SceneArrays { tables: srgb_table(), ..Default::default() };
    scene.texels = vec![u32::from_le_bytes([77, 200, 3, 129]); 15];
    let texture = Texture {
        width: 5,
        height: 3,
        format: TEXEL_SRGB8,
        magnify: MAGNIFY_BILINEAR,
        scale_u: 1.0,
        scale_v: 1.0,
        ..Default::default()
    };
    let expected = sample_texture(&scene.view(), &texture, Vec2::splat(0.5));
    for i in 0..1000 {
        let uv = Vec2::new(i as f32 * 0.013_7, i as f32 * -0.007_1);
        assert_eq!(sample_texture(&scene.view(), &texture, uv), expected);
    }
}
