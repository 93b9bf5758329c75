// How texture coordinates run over a surface, what a pixel's cone covers of them, and normals from textures (row 27).
#ifndef SHADING_FOOTPRINT_GLSL
#define SHADING_FOOTPRINT_GLSL

#include "layout/records.glsl"
#include "shading/coordinate.glsl"
#include "shading/frame.glsl"
#include "shading/math.glsl"

// Smallest cosine between a cone and the surface it meets: the footprint is at most 1000 times as long as wide.
const float COS_CONE_LEAST = 1.0e-3;
// No footprint is longer than this many times the texture.
const float COVERED_MOST = 65536.0;
// A mapped normal keeps at least this cosine with the one it replaces: what a texture turns further away is a fault.
const float COS_RELIEF_LEAST = 1.0e-3;

// Change of u and of v per unit of distance along a surface: vectors in the plane across its normal. Zero where the
// coordinates do not determine them.
struct UvGradients {
    vec3 u;
    vec3 v;
};

// The gradients of a surface that moves by `dp_du` and `dp_dv` per unit of u and v (any length), across `normal` (unit).
// They follow mirrored transforms and mirrored coordinates.
UvGradients uv_gradients(vec3 dp_du, vec3 dp_dv, vec3 normal) {
    float area = dot3(cross3(dp_du, dp_dv), normal);
    if (abs(area) < TINY || abs(area) > HUGE) {
        return UvGradients(vec3(0.0), vec3(0.0));
    }
    float scale = rcp(area);
    return UvGradients(cross3(dp_dv, normal) * scale, cross3(normal, dp_du) * scale);
}

// The gradients of a texture's own coordinates.
UvGradients texture_gradients(Texture texture_record, UvGradients gradients) {
    return UvGradients(
        gradients.u * texture_record.scale_u + gradients.v * texture_record.shear_u,
        gradients.v * texture_record.scale_v + gradients.u * texture_record.shear_v
    );
}

// What a pixel covers of the texture coordinates: the two axes of an ellipse, in full length.
struct Footprint {
    // The way the ray slants.
    vec2 along;
    // At right angles to it on the surface.
    vec2 across;
};

// A step on the surface as a difference of uvs, within bounds.
vec2 covered(UvGradients gradients, vec3 offset) {
    float u = finite_or_zero(dot3(gradients.u, offset));
    float v = finite_or_zero(dot3(gradients.v, offset));
    return vec2(clamp_(u, -COVERED_MOST, COVERED_MOST), clamp_(v, -COVERED_MOST, COVERED_MOST));
}

// The ellipse in which a cone of `width` around `direction` (unit) meets a surface with the normal `normal` (unit, either
// side), in texture coordinates.
// Source: Akenine-Moeller et al. 2021, "Improved Shader and Texture Level of Detail Using Ray Cones", section 4.
Footprint cone_footprint(UvGradients gradients, vec3 normal, vec3 direction, float width) {
    float cosine = dot3(normal, direction);
    Frame frame = frame_from_tangent(normal, direction);
    float extent = div(width, max_(abs(cosine), COS_CONE_LEAST));
    return Footprint(covered(gradients, frame.tangent * extent), covered(gradients, frame.bitangent * width));
}

// `mapped` (unit), or what is nearest to it at the least cosine from `normal`.
vec3 within_relief(vec3 normal, vec3 mapped) {
    float cosine = dot3(normal, mapped);
    if (cosine < COS_RELIEF_LEAST) {
        return normalize3(mapped + normal * (COS_RELIEF_LEAST - cosine));
    }
    return mapped;
}

// The normal that a normal map says: `texel` 0..1 in each lane, (0.5, 0.5, 1) for `normal` itself; its first lane leans
// towards growing u, its second towards growing v. `strength` scales both. `gradients`: of the texture's own coordinates.
vec3 mapped_normal(vec3 normal, UvGradients gradients, vec3 texel, float strength) {
    // dp_du is across the gradient of v, on the side where u grows.
    vec3 tangent = cross3(gradients.v, normal);
    float grows = dot3(tangent, gradients.u);
    Frame frame = frame_from_tangent(normal, grows < 0.0 ? -tangent : tangent);
    float turned = dot3(frame.bitangent, gradients.v) < 0.0 ? -1.0 : 1.0;
    float x = (2.0 * texel.x - 1.0) * strength;
    float y = (2.0 * texel.y - 1.0) * strength;
    float z = 2.0 * texel.z - 1.0;
    vec3 mapped = normalize3(to_world(frame, vec3(x, y * turned, z)));
    return dot3(mapped, mapped) > 0.5 ? within_relief(normal, mapped) : normal;
}

// The normal of a surface raised by a height that changes by `height_u` and `height_v` (world units) per unit of the
// texture's own coordinates, whose `gradients` are given.
// Source: Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU", equation 2: N minus the surface gradient.
vec3 raised_normal(vec3 normal, UvGradients gradients, float height_u, float height_v) {
    vec3 slope = gradients.u * height_u + gradients.v * height_v;
    vec3 raised = normalize3(normal - slope);
    return dot3(raised, raised) > 0.5 ? within_relief(normal, raised) : normal;
}

#endif
