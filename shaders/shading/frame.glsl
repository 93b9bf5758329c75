// Orthonormal frames, right-handed, z = normal.
#ifndef SHADING_FRAME_GLSL
#define SHADING_FRAME_GLSL

#include "shading/math.glsl"

// tangent x bitangent = normal, all unit.
struct Frame {
    vec3 tangent;
    vec3 bitangent;
    vec3 normal;
};

// A frame around a unit normal (Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3); orthonormal
// within 5e-7. The tangent jumps where normal.z changes its sign.
Frame frame_from_normal(vec3 normal) {
    // Not `>= 0`: whether a subnormal z survives may not decide.
    float sign_ = normal.z > -TINY ? 1.0 : -1.0;
    float a = -rcp(sign_ + normal.z);
    float b = (normal.x * normal.y) * a;
    return Frame(
        vec3(1.0 + (sign_ * normal.x) * (normal.x * a), sign_ * b, -sign_ * normal.x),
        vec3(b, sign_ + (normal.y * normal.y) * a, -normal.y),
        normal
    );
}

// The frame around a unit normal whose tangent is nearest to `tangent` (any length), orthonormal within 1e-6; that of
// `frame_from_normal` if `tangent` is zero or within about 0.1 degrees of the normal's line.
Frame frame_from_tangent(vec3 normal, vec3 tangent) {
    vec3 along = normalize3(tangent);
    vec3 across = along - normal * dot3(normal, along);
    if (dot3(across, across) >= 4e-6) {
        // A second step removes what cancellation in the first one left along the normal.
        vec3 unit = normalize3(across);
        vec3 nearest = normalize3(unit - normal * dot3(normal, unit));
        return Frame(nearest, cross3(normal, nearest), normal);
    }
    return frame_from_normal(normal);
}

// The components of `w` along the frame's axes.
vec3 to_local(Frame frame, vec3 w) {
    return vec3(dot3(frame.tangent, w), dot3(frame.bitangent, w), dot3(frame.normal, w));
}

// The vector with components `w` along the frame's axes.
vec3 to_world(Frame frame, vec3 w) {
    return (frame.tangent * w.x + frame.bitangent * w.y) + frame.normal * w.z;
}

#endif
