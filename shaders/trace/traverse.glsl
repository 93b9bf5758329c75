// The walk through the two-level hierarchy.
//
// Ylitie, Karras and Laine 2017, algorithm 1, with up to three groups of triangles postponed (Aila and Laine 2009,
// "Understanding the Efficiency of Ray Traversal on GPUs", section 4): a *group* is where a node's inner children stand
// (`Node.children`) and in its lowest byte which of them were hit, a *primitive group* is (first primitive, one bit a
// primitive). What is not taken yet waits on a stack. Each turn takes one node or one primitive off, so the loops end.
// A child stands at the place of its slot, so that a group is one word: devices that walk lanes in lockstep store and load
// what waits lane by lane.
//
// Loops inside one another, and not one loop with branches for both levels: devices that walk lanes in lockstep run every
// branch of a loop's body on each turn, whether a lane takes it or not, so what is rare has a loop of its own. Each ends by
// a `break` at its end, under a header that decides nothing (ARCHITECTURE.md, "Loops").
#ifndef TRACE_TRAVERSE_GLSL
#define TRACE_TRAVERSE_GLSL
#ifdef GONIO_FETCH

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "trace/box_.glsl"
#include "trace/ray.glsl"
#include "trace/sphere.glsl"
#include "trace/triangle.glsl"

// More turns than any loop here takes.
const uint TURNS_MOST = 0xffffffffu;
// Bits of a group: by priority, the children that were hit and not yet taken.
const uint GROUP_HITS = 0x000000ffu;
// Bits of a primitive group: one a primitive.
const uint PRIMITIVE_HITS = 0x00ffffffu;

// Whether a hit at `t` replaces `hit`: it is nearer, or as near and lower in (instance, primitive), so that the order
// of the walk does not matter.
bool is_closer(float t, uint instance, uint primitive, Hit hit) {
    return t < hit.t
        || (t == hit.t && (instance < hit.instance || (instance == hit.instance && primitive < hit.primitive)));
}

// Index of the highest bit of 1 <= x < 2^24.
uint highest_bit(uint x) {
#ifdef FETCH_TEXEL
    // The exponent of the float that it makes exactly: CPU devices have no vector instruction for it.
    return (floatBitsToUint(float(int(x))) >> 23u) - 127u;
#else
    return uint(findMSB(x));
#endif
}

// The group of a root alone: its priority is 7, and so its place.
uint root_group(uint octant) {
    return ((octant & 7u) << 8u) | 0x80u;
}

// Takes the nearest child out of a group: its index in the node array, less that of the root, plus 7.
uint take_child(inout uint group, uint octant) {
    uint bit = highest_bit(group & GROUP_HITS);
    group &= ~(1u << bit);
    return (group >> 8u) + (bit ^ (octant & 7u));
}

// Takes one primitive out of a primitive group: its index in its array.
uint take_primitive(inout uvec2 group) {
    uint bit = highest_bit(group.y);
    group.y &= ~(1u << bit);
    return group.x + bit;
}

// Tests triangle `index` of the array; `hit` becomes the closer of both. `slack`: of its mesh.
void test_triangle(Ray ray, LevelRay level, vec3 slack, uint instance, uint index, inout Hit hit) {
    Triangle triangle = load_triangle(index);
    if (instance == ray.skip_instance && triangle.primitive == ray.skip_primitive) {
        return;
    }
    vec3 found = intersect_triangle(level, slack, triangle.v0, triangle.v1, triangle.v2);
    if (found.x > 0.0 && is_closer(found.x, instance, triangle.primitive, hit)) {
        hit.t = found.x;
        hit.b1 = found.y;
        hit.b2 = found.z;
        hit.instance = instance;
        hit.primitive = triangle.primitive;
    }
}

// Tests a sphere; `level` is the ray in its object space.
void test_sphere(Ray ray, LevelRay level, uint instance, inout Hit hit) {
    bool leaves = instance == ray.skip_instance;
    float t = intersect_sphere(level, !leaves, !leaves || ray.skip_inward != 0u);
    if (t > 0.0 && is_closer(t, instance, 0u, hit)) {
        hit.t = t;
        hit.b1 = 0.0;
        hit.b2 = 0.0;
        hit.instance = instance;
        hit.primitive = 0u;
    }
}

// Walks the mesh of `instance` below `root`; `level` is the ray in its object space, `hit` becomes the closer of it and
// what is found. With `any` the first hit ends the walk.
void walk_mesh(Ray ray, LevelRay level, uint instance, uint root, bool any, inout Hit hit) {
    uint stack[STACK_DEPTH + 1u];
    uint height = 0u;
    vec3 slack = axis_slack(level, root_reach(load_node(root), level) * SLACK);
    vec3 widening = slack * NODE_SLACKS;
    uint group = root_group(level.octant);
    // What waits to be tested, the last found first. Lanes wait for one another at the end of either loop; what each
    // may put aside evens out what they wait for.
    uvec2 triangles = uvec2(0u);
    uvec2 triangles1 = uvec2(0u);
    uvec2 triangles2 = uvec2(0u);
    bool walking = true;
    for (uint turn = 0u; turn < TURNS_MOST; turn++) {
        // Nodes until there is no room for more triangles.
        for (uint step_ = 0u; step_ < TURNS_MOST; step_++) {
            uint index = root - 7u + take_child(group, level.octant);
            stack[height] = group;
            height += (group & GROUP_HITS) != 0u ? 1u : 0u;
            Node node = load_node(index);
            uint hits = approx_intersect_node(node, level, widening, hit.t);
            group = node.children | (hits >> 24u);
            if ((hits & PRIMITIVE_HITS) != 0u) {
                triangles2 = triangles1;
                triangles1 = triangles;
                triangles = uvec2(node.primitive_base, hits & PRIMITIVE_HITS);
            }
            if ((group & GROUP_HITS) == 0u) {
                walking = height != 0u;
                if (walking) {
                    height -= 1u;
                    group = stack[height];
                }
            }
            if (!walking || triangles2.y != 0u) {
                break;
            }
        }
        for (uint step_ = 0u; step_ < TURNS_MOST; step_++) {
            if (triangles.y != 0u) {
                test_triangle(ray, level, slack, instance, take_primitive(triangles), hit);
                if (triangles.y == 0u) {
                    triangles = triangles1;
                    triangles1 = triangles2;
                    triangles2.y = 0u;
                }
            }
            if (triangles.y == 0u || (any && hit.instance != INVALID)) {
                break;
            }
        }
        if (!walking || (any && hit.instance != INVALID)) {
            break;
        }
    }
}

// Tests what stands at `place` of the top level's order; `hit` becomes the closer of it and what is found.
void enter_instance(Ray ray, uint place, bool any, bool casting, inout Hit hit) {
    uint id = load_top_instance(place);
    Instance record = load_instance(id);
    vec3 origin = object_origin(record, ray.origin);
    if ((casting && (record.flags & INSTANCE_NO_SHADOW) != 0u) || !within_reach(origin)) {
        return;
    }
    LevelRay level = prepare_ray(origin, transform_vector(record.to_object, ray.direction));
    if (HAS_SPHERES && record.kind == KIND_SPHERE) {
        test_sphere(ray, level, id, hit);
    } else {
        walk_mesh(ray, level, id, record.root, any, hit);
    }
}

// The closest hit, or with `any` any hit; with `casting` of an instance that casts a shadow.
// Both are constants wherever this is called: drivers inline it, each time with half its branches.
Hit traverse(Ray ray, bool any, bool casting) {
    Hit hit = Hit(ray.t_max, 0.0, 0.0, INVALID, 0u, 0u, 0u, 0u);
    if (header.top_root == INVALID || !within_reach(ray.origin)) {
        return hit;
    }
    if (IS_ONE_INSTANCE) {
        enter_instance(ray, 0u, any, casting, hit);
        return hit;
    }
    uint stack[STACK_DEPTH];
    uint height = 0u;
    LevelRay world = prepare_ray(ray.origin, ray.direction);
    vec3 widening = axis_slack(world, root_reach(load_node(header.top_root), world) * header.top_margin);
    uint group = root_group(world.octant);
    uvec2 instances = uvec2(0u);
    for (uint turn = 0u; turn < TURNS_MOST; turn++) {
        // Nodes until there is an instance.
        for (uint step_ = 0u; step_ < TURNS_MOST; step_++) {
            if (instances.y == 0u) {
                if ((group & GROUP_HITS) == 0u) {
                    height -= 1u;
                    group = stack[height];
                }
                uint index = header.top_root - 7u + take_child(group, world.octant);
                if ((group & GROUP_HITS) != 0u) {
                    stack[height] = group;
                    height += 1u;
                }
                Node node = load_node(index);
                uint hits = approx_intersect_node(node, world, widening, hit.t);
                group = node.children | (hits >> 24u);
                instances = uvec2(node.primitive_base, hits & PRIMITIVE_HITS);
            }
            if (instances.y != 0u || ((group & GROUP_HITS) == 0u && height == 0u)) {
                break;
            }
        }

        if (instances.y != 0u) {
            enter_instance(ray, take_primitive(instances), any, casting, hit);
        }
        bool done = instances.y == 0u && (group & GROUP_HITS) == 0u && height == 0u;
        if (done || (any && hit.instance != INVALID)) {
            break;
        }
    }
    return hit;
}

// The closest hit of a ray at 0 < t <= t_max, with ties in t to the lower (instance, primitive);
// `instance == INVALID` for none.
Hit trace_closest(Ray ray) {
    return traverse(ray, false, false);
}

// Whether anything that casts shadows lies at 0 < t <= t_max.
bool trace_any(Ray ray) {
    return traverse(ray, true, true).instance != INVALID;
}

// Whether anything at all lies at 0 < t <= t_max.
bool trace_barrier(Ray ray) {
    return traverse(ray, true, false).instance != INVALID;
}

// The closest hit of what casts shadows, as `trace_closest`.
Hit trace_occluder(Ray ray) {
    return traverse(ray, false, true);
}

#endif
#endif
