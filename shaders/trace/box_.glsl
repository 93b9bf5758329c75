// Boxes: the strict interval that bounds every accepted hit, and the approximate node test that never loses one.
//
// The picture must not depend on the shape of the hierarchy, so boxes choose what is visited, never what is hit:
//
// * `box_interval` is strict. A primitive's hit counts only at a t inside the interval of the primitive's own box
//   (grown by the slack below), which holds for every honest hit and forbids those that rounding invents far from a
//   triangle seen edge-on.
// * `approx_intersect_node` may round differently on every device, so its boxes are widened by more than all the
//   rounding between the two. Whatever is accepted lies in a box that is visited.
//
// # The bound
//
// u = 2^-24; d the direction; o the origin; R = `root_reach`: max over axes of |p - o| + 255 step at the root of the mesh
// (for a sphere: max |o| + 1), so that no point of the mesh is farther from the origin, on any axis; S = |d| / |d.kz| <= 1.
//
// 1. Triangle. A corner's sheared coordinate is fl(fl(v - o) - fl(S fl(v - o).kz)): off by at most 3 u R.
//    The sign of an edge function is never wrong, because rounding is monotone (it may become 0), so the triangle
//    that contains the ray in computed coordinates is accepted. Its point above the ray is the corners' weighted mean:
//    inside the box, and off the ray per axis by that error. S is fl(d rcp(d.kz)) and the slabs use rcp(d), each
//    within 2.3 u: 3.3 u R more; the slab's subtraction and product: 2 u R; the mean and its t: 5 u R. Sum: 13.3 u R.
// 2. Sphere. The closest point to the centre is off by 17 u R (`sphere`); with the slabs 22 u R.
// 3. So a slack of 16 u R covers a triangle, twice that a sphere. With R instead of each triangle's own distance it is
//    the same for all of a mesh.
// 4. Node, same level. Its planes contain the box (bake proves it in f64), and every node has |p - o| <= R and
//    255 step <= 2 R, since a grid is less than twice as large as its box. To the slack of 16 u R comes the rounding of
//    the slabs, 4 u R, and the node's own (two differences, two products, one sum), 6 u 3 R: 38 u R. Three slacks, 48 u R,
//    are enough: `NODE_SLACKS`.
// 5. Node of the top level. An object-space hit is off in object space by the transform's rounding,
//    8 u (|O||o| + |O.w|) for the origin and direction and 8 u |O||x - o| for to_object being rounded itself, and by the
//    slack in object space, at most 32 u |O||x - o| + 48 u extents, for a sphere 32 u (|O||x - o| + extents). In world
//    units, with kappa = the largest row sum of |W||O|: relative 48 kappa u R + 22 u R, so `top_margin` = 128 kappa u;
//    and an absolute part that bake adds to the box.
#ifndef TRACE_BOX_GLSL
#define TRACE_BOX_GLSL

#include "layout/records.glsl"
#include "shading/math.glsl"
#include "trace/ray.glsl"

// 16 u: the slack in units of the reach (the bound, step 3).
const float SLACK = 9.536743e-7;
// 32 u: that of a sphere.
const float SPHERE_SLACK = 1.9073486e-6;
// Slacks by which the boxes of a mesh's nodes are wider (the bound, step 4).
const float NODE_SLACKS = 3.0;

// The sizes of a node's grid steps.
vec3 node_steps(uint exponents) {
    return vec3(
        uintBitsToFloat((exponents & 255u) << 23u),
        uintBitsToFloat(((exponents >> 8u) & 255u) << 23u),
        uintBitsToFloat(((exponents >> 16u) & 255u) << 23u)
    );
}

// How far from the ray's origin something below `root` is at most, on any axis: the bound's R.
float root_reach(Node root, LevelRay ray) {
    vec3 size = node_steps(root.exponents_imask) * 255.0;
    float x = abs(root.origin.x - ray.origin.x) + size.x;
    float y = abs(root.origin.y - ray.origin.y) + size.y;
    float z = abs(root.origin.z - ray.origin.z) + size.z;
    return max_(max_(x, y), z);
}

// An extent along each axis in units of t: by how much sooner and later a ray is in a box grown by it.
vec3 axis_slack(LevelRay ray, float extent) {
    return abs(ray.inverse) * extent;
}

// The t at which the ray enters and leaves a box, in (near, far) order; near > far: it does not meet it.
// `low`, `high`: corners minus the ray's origin, finite. `slack`: `axis_slack` of what the box is grown by.
vec2 box_interval(LevelRay ray, vec3 slack, vec3 low, vec3 high) {
    vec3 t0 = low * ray.inverse;
    vec3 t1 = high * ray.inverse;
    float near_x = min_(t0.x, t1.x) - slack.x;
    float near_y = min_(t0.y, t1.y) - slack.y;
    float near_z = min_(t0.z, t1.z) - slack.z;
    float far_x = max_(t0.x, t1.x) + slack.x;
    float far_y = max_(t0.y, t1.y) + slack.y;
    float far_z = max_(t0.z, t1.z) + slack.z;
    return vec2(max_(max_(near_x, near_y), near_z), min_(min_(far_x, far_y), far_z));
}

// Four quantised planes of one word, child 0 in the lowest byte. By way of signed integers: many devices have no
// instruction for the unsigned conversion.
vec4 approx_planes(uint word) {
    ivec4 planes = ivec4(uvec4(word, word >> 8u, word >> 16u, word >> 24u) & 255u);
    return vec4(planes);
}

// `min` and `max` as one instruction where the built-ins care for NaNs: a NaN in `b` stays.
vec4 approx_min(vec4 a, vec4 b) {
    return mix(b, a, lessThan(a, b));
}
vec4 approx_max(vec4 a, vec4 b) {
    return mix(b, a, greaterThan(a, b));
}

// The bits that four children set if the ray meets their boxes. `meta`: their bytes of `child_meta`;
// `near`, `far`: their intervals. Inner children set the bit of their priority in the top byte (Ylitie et al. 2017,
// section 3.3: slot xor octant), leaves one bit a primitive in the lower 24.
uint approx_hit_bits(uint meta, uint octant, vec4 near, vec4 far) {
    uint is_inner = (meta & (meta << 1u)) & 0x10101010u;
    uint inner_mask = (is_inner >> 4u) * 255u;
    uint bit_index = (meta ^ (octant & inner_mask)) & 0x1f1f1f1fu;
    uint child_bits = (meta >> 5u) & 0x07070707u;
    uint hits = 0u;
    // Written as "unless it misses": a NaN would be visited.
    if (!(near.x > far.x)) {
        hits |= (child_bits & 255u) << (bit_index & 31u);
    }
    if (!(near.y > far.y)) {
        hits |= ((child_bits >> 8u) & 255u) << ((bit_index >> 8u) & 31u);
    }
    if (!(near.z > far.z)) {
        hits |= ((child_bits >> 16u) & 255u) << ((bit_index >> 16u) & 31u);
    }
    if (!(near.w > far.w)) {
        hits |= (child_bits >> 24u) << ((bit_index >> 24u) & 31u);
    }
    return hits;
}

// Which of a node's eight children the ray may meet at a t from 0 to `t_max` (both included), as the bits of
// `approx_hit_bits`. `widening`: the `axis_slack` by which boxes are wider.
// Source: Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs",
// section 3; the widening is ours (the bound above).
uint approx_intersect_node(Node node, LevelRay ray, vec3 widening, float t_max) {
    vec3 step_ = node_steps(node.exponents_imask);
    vec3 corner = node.origin - ray.origin;
    vec3 scale = step_ * ray.inverse;
    vec3 start = corner * ray.inverse;
    vec3 low = start - widening;
    vec3 high = start + widening;

    // Near and far planes by the sign of the direction; no swapping per child.
    bvec3 negative = lessThan(ray.inverse, vec3(0.0));
    uvec2 near_x = negative.x ? node.max_x : node.min_x;
    uvec2 far_x = negative.x ? node.min_x : node.max_x;
    uvec2 near_y = negative.y ? node.max_y : node.min_y;
    uvec2 far_y = negative.y ? node.min_y : node.max_y;
    uvec2 near_z = negative.z ? node.max_z : node.min_z;
    uvec2 far_z = negative.z ? node.min_z : node.max_z;

    uint hits = 0u;
    // The two halves are written out: a loop would count against lavapipe's limit of loop iterations.
    vec4 near = approx_max(
        approx_max(approx_planes(near_x.x) * scale.x + low.x, approx_planes(near_y.x) * scale.y + low.y),
        approx_max(approx_planes(near_z.x) * scale.z + low.z, vec4(0.0))
    );
    vec4 far = approx_min(
        approx_min(approx_planes(far_x.x) * scale.x + high.x, approx_planes(far_y.x) * scale.y + high.y),
        approx_min(approx_planes(far_z.x) * scale.z + high.z, vec4(t_max))
    );
    hits |= approx_hit_bits(node.child_meta.x, ray.octant, near, far);
    near = approx_max(
        approx_max(approx_planes(near_x.y) * scale.x + low.x, approx_planes(near_y.y) * scale.y + low.y),
        approx_max(approx_planes(near_z.y) * scale.z + low.z, vec4(0.0))
    );
    far = approx_min(
        approx_min(approx_planes(far_x.y) * scale.x + high.x, approx_planes(far_y.y) * scale.y + high.y),
        approx_min(approx_planes(far_z.y) * scale.z + high.z, vec4(t_max))
    );
    hits |= approx_hit_bits(node.child_meta.y, ray.octant, near, far);
    return hits;
}

#endif
