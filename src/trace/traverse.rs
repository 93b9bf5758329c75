//! The walk through the two-level hierarchy.
//!
//! One loop for both levels (Ylitie, Karras and Laine 2017, algorithm 1, without triangle postponing): a *group* is
//! (first inner child, hit bits of the children in the top byte | mask of inner children in the lowest byte), a
//! *primitive group* is (first primitive, one bit a primitive). What is not taken yet waits on the stack; a mesh is
//! walked on top of what waits in the top level. Each turn takes one node or one group off, so the loop ends.

use super::box_::{MESH_MARGIN, approx_intersect_node};
use super::ray::{LevelRay, object_origin, prepare_ray, transform_vector, within_reach};
use super::sphere::intersect_sphere;
use super::triangle::intersect_triangle;
use crate::layout::{
    Hit, INSTANCE_NO_SHADOW, INVALID, KIND_SPHERE, Ray, STACK_SIZE, SceneView, load_instance, load_node,
    load_top_instance, load_triangle,
};
use glam::UVec2;

/// Groups with no child left are at most this.
const GROUP_EMPTY: u32 = 0x00ff_ffff;
/// Hit bits of a group whose only child is a root: priority 7 of an empty mask of inner children.
const GROUP_ROOT: u32 = 0x8000_0000;

/// Whether a hit at `t` replaces `hit`: it is nearer, or as near and lower in (instance, primitive), so that the order
/// of the walk does not matter.
#[inline(always)]
fn is_closer(t: f32, instance: u32, primitive: u32, hit: &Hit) -> bool {
    t < hit.t || (t == hit.t && (instance < hit.instance || (instance == hit.instance && primitive < hit.primitive)))
}

/// The index of the highest bit of `x`, which is not 0.
#[inline(always)]
fn highest_bit(x: u32) -> u32 {
    31 - x.leading_zeros()
}

/// Tests triangle `index` of the array; `hit` becomes the closer of both.
#[inline(always)]
fn test_triangle(scene: &SceneView, ray: &Ray, level: &LevelRay, instance: u32, index: u32, hit: &mut Hit) {
    let triangle = load_triangle(scene, index);
    if instance == ray.skip_instance && triangle.primitive == ray.skip_primitive {
        return;
    }
    let found = intersect_triangle(level, triangle.v0, triangle.v1, triangle.v2);
    if found.x > 0.0 && is_closer(found.x, instance, triangle.primitive, hit) {
        hit.t = found.x;
        hit.b1 = found.y;
        hit.b2 = found.z;
        hit.instance = instance;
        hit.primitive = triangle.primitive;
    }
}

/// Tests a sphere; `level` is the ray in its object space.
#[inline(always)]
fn test_sphere(ray: &Ray, level: &LevelRay, instance: u32, hit: &mut Hit) {
    let leaves = instance == ray.skip_instance;
    let t = intersect_sphere(level, !leaves, !leaves || ray.skip_inward != 0);
    if t > 0.0 && is_closer(t, instance, 0, hit) {
        hit.t = t;
        hit.b1 = 0.0;
        hit.b2 = 0.0;
        hit.instance = instance;
        hit.primitive = 0;
    }
}

/// The closest hit, or with `shadow` any hit of an instance that casts a shadow.
/// Rust only: `deepest` becomes the number of stack entries in use at the worst moment.
#[inline(always)]
fn traverse(scene: &SceneView, ray: &Ray, shadow: bool, deepest: &mut u32) -> Hit {
    let mut hit = Hit { t: ray.t_max, instance: INVALID, ..Hit::default() };
    if scene.header.top_root == INVALID || !within_reach(ray.origin) {
        return hit;
    }
    let mut stack = [UVec2::ZERO; STACK_SIZE as usize];
    let mut height: u32 = 0;
    let mut level = prepare_ray(ray.origin, ray.direction);
    let mut margin = scene.header.top_margin;
    // The instance whose mesh is walked, and the height of the stack below it; INVALID and 0 in the top level.
    let mut instance = INVALID;
    let mut floor: u32 = 0;
    let mut group = UVec2::new(scene.header.top_root, GROUP_ROOT);
    let mut primitives;
    loop {
        if group.y > GROUP_EMPTY {
            let bit = highest_bit(group.y);
            let slot = (bit - 24) ^ (level.octant & 255);
            let index = group.x + (group.y & !(0xffff_ffff << slot)).count_ones();
            group.y &= !(1 << bit);
            if group.y > GROUP_EMPTY {
                push(&mut stack, &mut height, group, deepest);
            }
            let node = load_node(scene, index);
            let hits = approx_intersect_node(&node, &level, margin, hit.t);
            group = UVec2::new(node.child_base, (hits & 0xff00_0000) | (node.exponents_imask >> 24));
            primitives = UVec2::new(node.primitive_base, hits & GROUP_EMPTY);
        } else {
            // Instances that waited while another one's mesh was walked.
            primitives = group;
            group = UVec2::ZERO;
        }

        while primitives.y != 0 {
            let bit = highest_bit(primitives.y);
            primitives.y &= !(1 << bit);
            if instance != INVALID {
                test_triangle(scene, ray, &level, instance, primitives.x + bit, &mut hit);
            } else {
                let id = load_top_instance(scene, primitives.x + bit);
                let record = load_instance(scene, id);
                let origin = object_origin(&record, ray.origin);
                if !(shadow && (record.flags & INSTANCE_NO_SHADOW) != 0) && within_reach(origin) {
                    let inner = prepare_ray(origin, transform_vector(record.to_object, ray.direction));
                    if record.kind == KIND_SPHERE {
                        test_sphere(ray, &inner, id, &mut hit);
                    } else {
                        if group.y > GROUP_EMPTY {
                            push(&mut stack, &mut height, group, deepest);
                        }
                        if primitives.y != 0 {
                            push(&mut stack, &mut height, primitives, deepest);
                        }
                        instance = id;
                        floor = height;
                        level = inner;
                        margin = MESH_MARGIN;
                        group = UVec2::new(record.root, GROUP_ROOT);
                        primitives.y = 0;
                    }
                }
            }
            if shadow && hit.instance != INVALID {
                return hit;
            }
        }

        if group.y <= GROUP_EMPTY {
            if instance != INVALID && height == floor {
                instance = INVALID;
                floor = 0;
                level = prepare_ray(ray.origin, ray.direction);
                margin = scene.header.top_margin;
            }
            if height == 0 {
                return hit;
            }
            height -= 1;
            group = stack[height as usize];
        }
    }
}

/// Puts a group aside. Bake has proved that the stack is high enough.
#[inline(always)]
fn push(stack: &mut [UVec2; STACK_SIZE as usize], height: &mut u32, group: UVec2, deepest: &mut u32) {
    debug_assert!(*height < STACK_SIZE, "traversal stack overflows");
    stack[*height as usize] = group;
    *height += 1;
    *deepest = (*deepest).max(*height);
}

/// The closest hit of a ray at 0 < t <= t_max, with ties in t to the lower (instance, primitive);
/// `instance == INVALID` for none.
pub fn trace_closest(scene: &SceneView, ray: &Ray) -> Hit {
    traverse(scene, ray, false, &mut 0)
}

/// Whether anything that casts shadows lies at 0 < t <= t_max.
pub fn trace_any(scene: &SceneView, ray: &Ray) -> bool {
    traverse(scene, ray, true, &mut 0).instance != INVALID
}

/// Stack entries that the ray's closest hit needed: what bake's `stack_depth` bounds. Rust only, for tests.
pub fn stack_used(scene: &SceneView, ray: &Ray) -> u32 {
    let mut deepest = 0;
    traverse(scene, ray, false, &mut deepest);
    deepest
}
