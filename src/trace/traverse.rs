//! The walk through the two-level hierarchy.
//!
//! Ylitie, Karras and Laine 2017, algorithm 1, without triangle postponing: a *group* is where a node's inner children stand
//! (`Node::children`) and in its lowest byte which of them were hit, a *primitive group* is (first primitive, one bit a
//! primitive). What is not taken yet waits on a stack. Each turn takes one node or one primitive off, so the loops end.
//! A child stands at the place of its slot, so that a group is one word: devices that walk lanes in lockstep store and load
//! what waits lane by lane.
//!
//! Three loops, one inside another, and not one loop with branches for both levels: devices that walk lanes in lockstep
//! run every branch of a loop's body on each turn, whether a lane takes it or not, so what is rare has a loop of its own.
//! They also postpone triangles, which lanes of their own need not: the order of tests cannot change a hit.

use super::box_::{Eight, NODE_SLACKS, Portable, SLACK, approx_intersect_node, axis_slack, root_reach};
use super::ray::{LevelRay, object_origin, prepare_ray, transform_vector, within_reach};
use super::sphere::intersect_sphere;
use super::triangle::intersect_triangle;
use crate::layout::{Hit, INSTANCE_NO_SHADOW, INVALID, KIND_SPHERE, Ray, STACK_SIZE, SceneView, load_top_instance};
use glam::{UVec2, Vec3};
use pulp::NullaryFnOnce;
#[cfg(target_arch = "x86_64")]
use pulp::x86::V3;

/// Groups put aside. Bake has proved that it is high enough.
struct Stack {
    groups: [u32; STACK_SIZE as usize],
    len: usize,
}

impl Stack {
    #[inline(always)]
    fn new() -> Self {
        Self { groups: [0; STACK_SIZE as usize], len: 0 }
    }

    /// `deepest` becomes the number of entries in use at the worst moment.
    #[inline(always)]
    fn push(&mut self, group: u32, deepest: &mut u32) {
        self.groups[self.len] = group;
        self.len += 1;
        *deepest = (*deepest).max(self.len as u32);
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<u32> {
        self.len = self.len.checked_sub(1)?;
        Some(self.groups[self.len])
    }
}

/// Bits of a group: by priority, the children that were hit and not yet taken.
const GROUP_HITS: u32 = 0x0000_00ff;
/// Bits of a primitive group: one a primitive.
const PRIMITIVE_HITS: u32 = 0x00ff_ffff;

/// Whether a hit at `t` replaces `hit`: it is nearer, or as near and lower in (instance, primitive), so that the order
/// of the walk does not matter.
#[inline(always)]
fn is_closer(t: f32, instance: u32, primitive: u32, hit: &Hit) -> bool {
    t < hit.t || (t == hit.t && (instance < hit.instance || (instance == hit.instance && primitive < hit.primitive)))
}

/// Index of the highest bit of 1 <= x < 2^24.
#[inline(always)]
fn highest_bit(x: u32) -> u32 {
    31 - x.leading_zeros()
}

/// The group of a root alone: its priority is 7, and so its place.
#[inline(always)]
fn root_group(octant: u32) -> u32 {
    ((octant & 7) << 8) | 0x80
}

/// Takes the nearest child out of a group: its index in the node array, less that of the root, plus 7.
#[inline(always)]
fn take_child(group: &mut u32, octant: u32) -> u32 {
    let bit = highest_bit(*group & GROUP_HITS);
    *group &= !(1 << bit);
    (*group >> 8) + (bit ^ (octant & 7))
}

/// Takes one primitive out of a primitive group: its index in its array.
#[inline(always)]
fn take_primitive(group: &mut UVec2) -> u32 {
    let bit = highest_bit(group.y);
    group.y &= !(1 << bit);
    group.x + bit
}

/// Tests triangle `index` of the array; `hit` becomes the closer of both. `slack`: of its mesh.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "to read like its twin")]
fn test_triangle(
    scene: &SceneView,
    ray: &Ray,
    level: &LevelRay,
    slack: Vec3,
    instance: u32,
    index: u32,
    hit: &mut Hit,
) {
    let triangle = &scene.triangles[index as usize];
    if instance == ray.skip_instance && triangle.primitive == ray.skip_primitive {
        return;
    }
    let found = intersect_triangle(level, slack, &triangle.v0, &triangle.v1, &triangle.v2);
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

/// Walks the mesh of `instance` below `root`; `level` is the ray in its object space, `hit` becomes the closer of it and
/// what is found. With `any` the first hit ends the walk.
/// Rust only: `deepest` becomes the number of stack entries in use at the worst moment.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "to read like its twin")]
fn walk_mesh(
    eight: impl Eight,
    scene: &SceneView,
    ray: &Ray,
    level: &LevelRay,
    instance: u32,
    root: u32,
    any: bool,
    hit: &mut Hit,
    deepest: &mut u32,
) {
    let mut stack = Stack::new();
    let slack = axis_slack(level, root_reach(&scene.nodes[root as usize], level) * SLACK);
    let widening = slack * NODE_SLACKS;
    let mut group = root_group(level.octant);
    let mut walking = true;
    while walking {
        let index = root.wrapping_sub(7).wrapping_add(take_child(&mut group, level.octant));
        if group & GROUP_HITS != 0 {
            stack.push(group, deepest);
        }
        let node = &scene.nodes[index as usize];
        let hits = approx_intersect_node(eight, node, level, widening, hit.t);
        group = node.children | (hits >> 24);
        let mut triangles = UVec2::new(node.primitive_base, hits & PRIMITIVE_HITS);
        while triangles.y != 0 && !(any && hit.instance != INVALID) {
            test_triangle(scene, ray, level, slack, instance, take_primitive(&mut triangles), hit);
        }
        if group & GROUP_HITS == 0 {
            match stack.pop() {
                Some(next) => group = next,
                None => walking = false,
            }
        }
        walking = walking && !(any && hit.instance != INVALID);
    }
}

/// The closest hit, or with `any` any hit; with `casting` of an instance that casts a shadow.
/// Rust only: `deepest` becomes the number of entries of either stack in use at the worst moment.
#[inline(always)]
fn traverse(eight: impl Eight, scene: &SceneView, ray: &Ray, any: bool, casting: bool, deepest: &mut u32) -> Hit {
    let mut hit = Hit { t: ray.t_max, instance: INVALID, ..Hit::default() };
    if scene.header.top_root == INVALID || !within_reach(ray.origin) {
        return hit;
    }
    // A lone instance needs no walk to be found.
    if scene.top_instances.len() == 1 {
        enter_instance(eight, scene, ray, 0, any, casting, &mut hit, deepest);
        return hit;
    }
    let mut stack = Stack::new();
    let world = prepare_ray(ray.origin, ray.direction);
    let reach = root_reach(&scene.nodes[scene.header.top_root as usize], &world);
    let widening = axis_slack(&world, reach * scene.header.top_margin);
    let mut group = root_group(world.octant);
    let mut instances = UVec2::ZERO;
    let mut walking = true;
    while walking {
        // Nodes until there is an instance.
        while instances.y == 0 && (group & GROUP_HITS != 0 || stack.len > 0) {
            if group & GROUP_HITS == 0
                && let Some(next) = stack.pop()
            {
                group = next;
            }
            let index = scene.header.top_root.wrapping_sub(7).wrapping_add(take_child(&mut group, world.octant));
            if group & GROUP_HITS != 0 {
                stack.push(group, deepest);
            }
            let node = &scene.nodes[index as usize];
            let hits = approx_intersect_node(eight, node, &world, widening, hit.t);
            group = node.children | (hits >> 24);
            instances = UVec2::new(node.primitive_base, hits & PRIMITIVE_HITS);
        }

        if instances.y != 0 {
            enter_instance(eight, scene, ray, take_primitive(&mut instances), any, casting, &mut hit, deepest);
        }
        walking = (instances.y != 0 || group & GROUP_HITS != 0 || stack.len > 0) && !(any && hit.instance != INVALID);
    }
    hit
}

/// Tests what stands at `place` of the top level's order; `hit` becomes the closer of it and what is found.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "to read like its twin")]
fn enter_instance(
    eight: impl Eight,
    scene: &SceneView,
    ray: &Ray,
    place: u32,
    any: bool,
    casting: bool,
    hit: &mut Hit,
    deepest: &mut u32,
) {
    let id = load_top_instance(scene, place);
    let record = &scene.instances[id as usize];
    let origin = object_origin(record, ray.origin);
    if (casting && (record.flags & INSTANCE_NO_SHADOW) != 0) || !within_reach(origin) {
        return;
    }
    let level = prepare_ray(origin, transform_vector(record.to_object, ray.direction));
    if record.kind == KIND_SPHERE {
        test_sphere(ray, &level, id, hit);
    } else {
        walk_mesh(eight, scene, ray, &level, id, record.root, any, hit, deepest);
    }
}

/// One call of `traverse`. Rust only.
struct Walk<'a, E, const ANY: bool, const CASTING: bool> {
    eight: E,
    scene: &'a SceneView<'a>,
    ray: &'a Ray,
}

impl<E: Eight, const ANY: bool, const CASTING: bool> NullaryFnOnce for Walk<'_, E, ANY, CASTING> {
    type Output = Hit;

    #[inline(always)]
    fn call(self) -> Hit {
        traverse(self.eight, self.scene, self.ray, ANY, CASTING, &mut 0)
    }
}

impl<const ANY: bool, const CASTING: bool> Walk<'_, Portable, ANY, CASTING> {
    /// The call, with the best vector instructions that this machine has: the same bits, since no compiler may fuse or reorder
    /// what is written.
    #[inline(always)]
    fn run(self) -> Hit {
        #[cfg(target_arch = "x86_64")]
        if let Some(eight) = V3::try_new() {
            return eight.vectorize(Walk::<_, ANY, CASTING> { eight, scene: self.scene, ray: self.ray });
        }
        self.call()
    }
}

/// The closest hit of a ray at 0 < t <= t_max, with ties in t to the lower (instance, primitive);
/// `instance == INVALID` for none.
pub fn trace_closest(scene: &SceneView, ray: &Ray) -> Hit {
    Walk::<_, false, false> { eight: Portable, scene, ray }.run()
}

/// Whether anything that casts shadows lies at 0 < t <= t_max.
pub fn trace_any(scene: &SceneView, ray: &Ray) -> bool {
    Walk::<_, true, true> { eight: Portable, scene, ray }.run().instance != INVALID
}

/// Whether anything at all lies at 0 < t <= t_max.
pub fn trace_barrier(scene: &SceneView, ray: &Ray) -> bool {
    Walk::<_, true, false> { eight: Portable, scene, ray }.run().instance != INVALID
}

/// The closest hit of what casts shadows, as `trace_closest`.
pub fn trace_occluder(scene: &SceneView, ray: &Ray) -> Hit {
    Walk::<_, false, true> { eight: Portable, scene, ray }.run()
}

/// Stack entries that the ray's closest hit needed: what bake's `stack_depth` bounds. Rust only, for tests.
pub fn stack_used(scene: &SceneView, ray: &Ray) -> u32 {
    let mut deepest = 0;
    traverse(Portable, scene, ray, false, false, &mut deepest);
    deepest
}
