// Geometry as the traversal and the shading steps see it.
#ifndef LAYOUT_GEOMETRY_GLSL
#define LAYOUT_GEOMETRY_GLSL

// One node of the compressed eight-wide BVH (Ylitie, Karras and Laine 2017,
// "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs"),
// in obvhs's order, min and max planes interleaved per axis, but for where children stand. 80 bytes.
// Boxes are conservative: bake has grown each child (DESIGN: strict rule 6).
struct Node {
    // Minimum corner of the node's box, object space of its mesh (or world, for the top level).
    vec3 origin;
    // Bytes 0-2: raw float exponents of the child grid per axis; byte 3: bit mask of inner children.
    uint exponents_imask;
    // Where inner children stand: that of slot s at index root - 7 + (`children` >> 8) + s, with the root of this hierarchy.
    // The lowest byte is 0: there a walk keeps which of them it has yet to visit.
    uint children;
    // Index of the first primitive: into `triangles` (absolute) for a mesh, into `top_instances` for the top level.
    uint primitive_base;
    // Eight bytes: 0 empty; leaf = unary count in the top 3 bits + offset 0..23; inner = 001 and slot + 24.
    uvec2 child_meta;
    // Eight quantised planes each, in units of the grid, child 0 in the lowest byte.
    uvec2 min_x;
    uvec2 max_x;
    uvec2 min_y;
    uvec2 max_y;
    uvec2 min_z;
    uvec2 max_z;
};
const uint NODE_WORDS = 5u;

#ifdef GONIO_FETCH
Node load_node(uint index) {
    uint at = index * NODE_WORDS;
    Node r;
    uvec4 w0 = fetch_node(at);
    r.origin = uintBitsToFloat(w0.xyz);
    r.exponents_imask = w0.w;
    uvec4 w1 = fetch_node(at + 1u);
    r.children = w1.x;
    r.primitive_base = w1.y;
    r.child_meta = w1.zw;
    uvec4 w2 = fetch_node(at + 2u);
    r.min_x = w2.xy;
    r.max_x = w2.zw;
    uvec4 w3 = fetch_node(at + 3u);
    r.min_y = w3.xy;
    r.max_y = w3.zw;
    uvec4 w4 = fetch_node(at + 4u);
    r.min_z = w4.xy;
    r.max_z = w4.zw;
    return r;
}
#endif

// Entries of a traversal stack, one for the top level and one for meshes; bake builds no hierarchy that needs more.
const uint STACK_SIZE = 32u;

// A triangle in traversal order: what the watertight test needs, nothing else. 48 bytes.
struct Triangle {
    // Corners, object space.
    vec3 v0;
    // Index of this triangle in its mesh as written (ties and `skip` use it; it does not depend on the BVH).
    uint primitive;
    vec3 v1;
    uint pad0;
    vec3 v2;
    uint pad1;
};
const uint TRIANGLE_WORDS = 3u;

#ifdef GONIO_FETCH
Triangle load_triangle(uint index) {
    uint at = index * TRIANGLE_WORDS;
    Triangle r;
    uvec4 w0 = fetch_triangle(at);
    r.v0 = uintBitsToFloat(w0.xyz);
    r.primitive = w0.w;
    uvec4 w1 = fetch_triangle(at + 1u);
    r.v1 = uintBitsToFloat(w1.xyz);
    r.pad0 = w1.w;
    uvec4 w2 = fetch_triangle(at + 2u);
    r.v2 = uintBitsToFloat(w2.xyz);
    r.pad1 = w2.w;
    return r;
}
#endif

// What an instance holds.
const uint KIND_MESH = 0u;
// The analytic unit sphere at the object-space origin.
const uint KIND_SPHERE = 1u;

// Instance flag: shadow rays pass through it.
const uint INSTANCE_NO_SHADOW = 1u;
// Instance flag: the transform mirrors (negative determinant), so winding is reversed in world space.
const uint INSTANCE_MIRRORED = 2u;
// Instance flag: its triangles are shaded at their centroid (row 8).
const uint INSTANCE_FLAT = 4u;
// Instance flag: its triangles are shaded at their corners (row 8).
const uint INSTANCE_GOURAUD = 8u;

// One placed object. 128 bytes. Matrices are three rows of four: `p' = (dot(row_i.xyz, p) + row_i.w)`.
struct Instance {
    vec4 to_world[3];
    vec4 to_object[3];
    // `KIND_*`.
    uint kind;
    // Root node of the mesh in the node array (mesh only).
    uint root;
    // First face of the mesh in the face array (mesh only).
    uint first_face;
    // Material of the whole instance, or `INVALID`: then each face names its own.
    uint material;
    // `INSTANCE_*` bits.
    uint flags;
    // Object id for the AOV: index of the object in the scene file, from 0.
    uint object;
    // Density of light samples on it, as `Emitter.density`, divided by the luminance of the material's emission.
    float light_density;
    uint pad0;
};
const uint INSTANCE_WORDS = 8u;

#ifdef GONIO_FETCH
Instance load_instance(uint index) {
    uint at = header.first_instance + index * INSTANCE_WORDS;
    Instance r;
    uvec4 w0 = fetch_data(at);
    r.to_world[0] = uintBitsToFloat(w0);
    uvec4 w1 = fetch_data(at + 1u);
    r.to_world[1] = uintBitsToFloat(w1);
    uvec4 w2 = fetch_data(at + 2u);
    r.to_world[2] = uintBitsToFloat(w2);
    uvec4 w3 = fetch_data(at + 3u);
    r.to_object[0] = uintBitsToFloat(w3);
    uvec4 w4 = fetch_data(at + 4u);
    r.to_object[1] = uintBitsToFloat(w4);
    uvec4 w5 = fetch_data(at + 5u);
    r.to_object[2] = uintBitsToFloat(w5);
    uvec4 w6 = fetch_data(at + 6u);
    r.kind = w6.x;
    r.root = w6.y;
    r.first_face = w6.z;
    r.material = w6.w;
    uvec4 w7 = fetch_data(at + 7u);
    r.flags = w7.x;
    r.object = w7.y;
    r.light_density = uintBitsToFloat(w7.z);
    r.pad0 = w7.w;
    return r;
}
#endif

// Vertex indices (absolute, into the vertex array) and material of one face, in mesh order. 16 bytes.
struct Face {
    uint i0;
    uint i1;
    uint i2;
    uint material;
};
const uint FACE_WORDS = 1u;

#ifdef GONIO_FETCH
Face load_face(uint index) {
    uint at = header.first_face + index * FACE_WORDS;
    Face r;
    uvec4 w0 = fetch_data(at);
    r.i0 = w0.x;
    r.i1 = w0.y;
    r.i2 = w0.z;
    r.material = w0.w;
    return r;
}
#endif

// One vertex, object space. 48 bytes.
struct Vertex {
    vec3 position;
    float u;
    // Unit shading normal.
    vec3 normal;
    float v;
    // Linear Rec. 709 factor on the base colour; 1 where the file has none.
    vec3 color;
    uint pad0;
};
const uint VERTEX_WORDS = 3u;

#ifdef GONIO_FETCH
Vertex load_vertex(uint index) {
    uint at = header.first_vertex + index * VERTEX_WORDS;
    Vertex r;
    uvec4 w0 = fetch_data(at);
    r.position = uintBitsToFloat(w0.xyz);
    r.u = uintBitsToFloat(w0.w);
    uvec4 w1 = fetch_data(at + 1u);
    r.normal = uintBitsToFloat(w1.xyz);
    r.v = uintBitsToFloat(w1.w);
    uvec4 w2 = fetch_data(at + 2u);
    r.color = uintBitsToFloat(w2.xyz);
    r.pad0 = w2.w;
    return r;
}
#endif

#endif
