// The walk through the two-level hierarchy.
//
// One loop for both levels (Ylitie, Karras and Laine 2017, algorithm 1, without triangle postponing): a *group* is
// (first inner child, hit bits of the children in the top byte | mask of inner children in the lowest byte), a
// *primitive group* is (first primitive, one bit a primitive). What is not taken yet waits on the stack; a mesh is
// walked on top of what waits in the top level. Each turn takes one node or one group off, so the loop ends.
#ifndef TRACE_TRAVERSE_GLSL
#define TRACE_TRAVERSE_GLSL
#ifdef GONIO_FETCH

#include "layout/mod.glsl"
#include "trace/box_.glsl"
#include "trace/ray.glsl"
#include "trace/sphere.glsl"
#include "trace/triangle.glsl"

// Groups with no child left are at most this.
const uint GROUP_EMPTY = 0x00ffffffu;
// Hit bits of a group whose only child is a root: priority 7 of an empty mask of inner children.
const uint GROUP_ROOT = 0x80000000u;

// Whether a hit at `t` replaces `hit`: it is nearer, or as near and lower in (instance, primitive), so that the order
// of the walk does not matter.
bool is_closer(float t, uint instance, uint primitive, Hit hit) {
    return t < hit.t
        || (t == hit.t && (instance < hit.instance || (instance == hit.instance && primitive < hit.primitive)));
}

// Tests triangle `index` of the array; `hit` becomes the closer of both.
void test_triangle(Ray ray, LevelRay level, uint instance, uint index, inout Hit hit) {
    Triangle triangle = load_triangle(index);
    if (instance == ray.skip_instance && triangle.primitive == ray.skip_primitive) {
        return;
    }
    vec3 found = intersect_triangle(level, triangle.v0, triangle.v1, triangle.v2);
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

// The closest hit, or with `shadow` any hit of an instance that casts a shadow.
// `shadow` is a constant wherever this is called: drivers inline it twice, each time with half its branches.
Hit traverse(Ray ray, bool shadow) {
    Hit hit = Hit(ray.t_max, 0.0, 0.0, INVALID, 0u, 0u, 0u, 0u);
    if (header.top_root == INVALID || !within_reach(ray.origin)) {
        return hit;
    }
    uvec2 stack[STACK_SIZE];
    uint height = 0u;
    LevelRay level = prepare_ray(ray.origin, ray.direction);
    float margin = header.top_margin;
    // The instance whose mesh is walked, and the height of the stack below it; INVALID and 0 in the top level.
    uint instance = INVALID;
    uint floor_ = 0u;
    uvec2 group = uvec2(header.top_root, GROUP_ROOT);
    uvec2 primitives;
    bool walking = true;
    do {
        if (group.y > GROUP_EMPTY) {
            uint bit = uint(findMSB(group.y));
            uint slot = (bit - 24u) ^ (level.octant & 255u);
            uint index = group.x + uint(bitCount(group.y & ~(0xffffffffu << slot)));
            group.y &= ~(1u << bit);
            if (group.y > GROUP_EMPTY) {
                stack[height] = group;
                height += 1u;
            }
            Node node = load_node(index);
            uint hits = approx_intersect_node(node, level, margin, hit.t);
            group = uvec2(node.child_base, (hits & 0xff000000u) | (node.exponents_imask >> 24u));
            primitives = uvec2(node.primitive_base, hits & GROUP_EMPTY);
        } else {
            // Instances that waited while another one's mesh was walked.
            primitives = group;
            group = uvec2(0u);
        }

        while (primitives.y != 0u) {
            uint bit = uint(findMSB(primitives.y));
            primitives.y &= ~(1u << bit);
            if (instance != INVALID) {
                test_triangle(ray, level, instance, primitives.x + bit, hit);
            } else {
                uint id = load_top_instance(primitives.x + bit);
                Instance record = load_instance(id);
                vec3 origin = object_origin(record, ray.origin);
                if (!(shadow && (record.flags & INSTANCE_NO_SHADOW) != 0u) && within_reach(origin)) {
                    LevelRay inner = prepare_ray(origin, transform_vector(record.to_object, ray.direction));
                    if (record.kind == KIND_SPHERE) {
                        test_sphere(ray, inner, id, hit);
                    } else {
                        if (group.y > GROUP_EMPTY) {
                            stack[height] = group;
                            height += 1u;
                        }
                        if (primitives.y != 0u) {
                            stack[height] = primitives;
                            height += 1u;
                        }
                        instance = id;
                        floor_ = height;
                        level = inner;
                        margin = MESH_MARGIN;
                        group = uvec2(record.root, GROUP_ROOT);
                        primitives.y = 0u;
                    }
                }
            }
            if (shadow && hit.instance != INVALID) {
                return hit;
            }
        }

        if (group.y <= GROUP_EMPTY) {
            if (instance != INVALID && height == floor_) {
                instance = INVALID;
                floor_ = 0u;
                level = prepare_ray(ray.origin, ray.direction);
                margin = header.top_margin;
            }
            walking = height != 0u;
            if (walking) {
                height -= 1u;
                group = stack[height];
            }
        }
    } while (walking);
    return hit;
}

// The closest hit of a ray at 0 < t <= t_max, with ties in t to the lower (instance, primitive);
// `instance == INVALID` for none.
Hit trace_closest(Ray ray) {
    return traverse(ray, false);
}

// Whether anything that casts shadows lies at 0 < t <= t_max.
bool trace_any(Ray ray) {
    return traverse(ray, true).instance != INVALID;
}

#endif
#endif
