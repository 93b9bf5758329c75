//! The camera ray of a sample.

use super::{DIMENSION_FILTER, DIMENSION_LENS};
use crate::layout::{Batch, INVALID, PathState, Ray, SceneView, T_INFINITE};
use crate::shading::camera::{camera_ray, through_lens};
use crate::shading::filter::sample_filter;
use crate::shading::sampling::{SampleKey, sample_2d};
use crate::shading::spectrum::spectrum_from_rgb;
use crate::shading::warp::square_to_disk;
use glam::Vec3;

/// The key of a path's random numbers: they depend on nothing else.
pub fn sample_key(scene: &SceneView, pixel: u32, sample_index: u32, path_id: u32) -> SampleKey {
    let (sampling, strata, seed) = (scene.features.sampler, scene.header.strata, scene.header.seed);
    SampleKey { sampling, strata, seed, pixel, sample_index, path_id }
}

/// Pixel of a slot, counted row by row in the crop.
pub fn slot_pixel(batch: &Batch, slot: u32) -> u32 {
    batch.first_pixel + slot / batch.sample_count // integer
}

/// The state of the sample in `slot` before its first ray is traced: filter importance sampling (Ernst, Stamminger
/// and Greiner 2006, "Filter Importance Sampling") places the ray, so one sample touches one pixel.
pub fn generate(scene: &SceneView, batch: &Batch, slot: u32) -> PathState {
    let index = slot_pixel(batch, slot);
    let x = batch.crop_x + index % batch.crop_width; // integer
    let y = batch.crop_y + index / batch.crop_width; // integer
    let pixel = x | (y << 16);
    let sample_index = batch.first_sample + slot % batch.sample_count; // integer
    let key = sample_key(scene, pixel, sample_index, 0);
    let filter = sample_filter(scene, sample_2d(key, DIMENSION_FILTER));
    let film_x = x as f32 + 0.5 + filter.offset.x;
    let film_y = y as f32 + 0.5 + filter.offset.y;
    let mut camera = camera_ray(&scene.header.camera, film_x, film_y);
    if scene.features.has_lens {
        camera = through_lens(&scene.header.camera, camera, square_to_disk(sample_2d(key, DIMENSION_LENS)));
    }
    PathState {
        ray: Ray {
            origin: camera.origin,
            t_max: T_INFINITE,
            direction: camera.direction,
            skip_instance: INVALID,
            skip_primitive: INVALID,
            skip_inward: 0,
            cone_width: camera.cone_width,
            cone_spread: camera.cone_spread,
        },
        throughput: spectrum_from_rgb(Vec3::splat(filter.weight)),
        slot,
        pixel,
        sample_index,
        path_id: 0,
        depth: 0,
        coverage: filter.weight,
        eta: 1.0,
        pdf: 0.0,
        absorption: Vec3::ZERO,
        interior: 0,
        passed: 0.0,
        flags: 0,
        _pad0: 0,
        _pad1: 0,
    }
}
