//! The traversal against brute force: the same bits and ids, whatever the shape of the hierarchy.

mod common;

use common::*;
use glam::{DAffine3, DVec3, Vec3};
use gonio::bake::bake;
use gonio::layout::*;
use gonio::scene::{Geometry, Mesh, Scene, Transform};
use gonio::trace::box_::box_interval;
use gonio::trace::ray::{object_origin, prepare_ray, transform_vector, within_reach};
use gonio::trace::sphere::intersect_sphere;
use gonio::trace::traverse::{stack_used, trace_any, trace_closest};
use gonio::trace::triangle::intersect_triangle;

/// Every primitive of every instance, without a hierarchy.
fn brute_force(scene: &SceneView, ray: &Ray, shadow: bool) -> Hit {
    let mut hit = Hit { t: ray.t_max, instance: INVALID, ..Hit::default() };
    let mut consider = |t: f32, b1: f32, b2: f32, instance: u32, primitive: u32| {
        let tie = t == hit.t && (instance, primitive) < (hit.instance, hit.primitive);
        if t > 0.0 && (t < hit.t || tie) {
            hit = Hit { t, b1, b2, instance, primitive, ..Hit::default() };
        }
    };
    for id in 0..scene.header.instance_count {
        let instance = load_instance(scene, id);
        if shadow && instance.flags & INSTANCE_NO_SHADOW != 0 {
            continue;
        }
        let origin = object_origin(&instance, ray.origin);
        if !within_reach(origin) {
            continue;
        }
        let level = prepare_ray(origin, transform_vector(instance.to_object, ray.direction));
        if instance.kind == KIND_SPHERE {
            let leaves = id == ray.skip_instance;
            consider(intersect_sphere(&level, !leaves, !leaves || ray.skip_inward != 0), 0.0, 0.0, id, 0);
            continue;
        }
        for primitive in 0..faces_of(scene, &instance) {
            if id == ray.skip_instance && primitive == ray.skip_primitive {
                continue;
            }
            let face = load_face(scene, instance.first_face + primitive);
            let [v0, v1, v2] = [face.i0, face.i1, face.i2].map(|i| load_vertex(scene, i).position);
            let found = intersect_triangle(&level, v0, v1, v2);
            consider(found.x, found.y, found.z, id, primitive);
        }
    }
    hit
}

/// Faces of the instance's mesh: up to the next mesh's first one.
fn faces_of(scene: &SceneView, instance: &Instance) -> u32 {
    let others = scene.instances.iter().filter(|i| i.kind == KIND_MESH).map(|i| i.first_face);
    others.filter(|&first| first > instance.first_face).min().unwrap_or(scene.faces.len() as u32) - instance.first_face
}

/// Compares `count` rays and returns how many hit something.
fn compare(scene: &Scene, rays: impl Iterator<Item = Ray>) -> u32 {
    let data = bake(scene).expect("bakes");
    let view = data.view();
    let mut hits = 0;
    for ray in rays {
        let expected = brute_force(&view, &ray, false);
        let found = trace_closest(&view, &ray);
        assert_eq!(found, expected, "{ray:?}");
        assert_eq!(found.t.to_bits(), expected.t.to_bits());
        assert_eq!(trace_any(&view, &ray), brute_force(&view, &ray, true).instance != INVALID, "{ray:?}");
        assert!(stack_used(&view, &ray) <= data.stack_depth, "{ray:?}");
        hits += u32::from(found.instance != INVALID);
    }
    hits
}

#[test]
fn a_random_soup_is_hit_as_by_brute_force() {
    let mut random = Random::new(1);
    for size in [0.02, 0.2, 1.5] {
        let scene = scene_of(vec![soup(&mut random, 400, size)]);
        let hits = compare(&scene, (0..4000).map(|_| random.ray(3.0)));
        assert!(hits > 30, "{hits} hits");
    }
}
