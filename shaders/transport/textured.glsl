// Materials with their textures.
#ifndef TRANSPORT_TEXTURED_GLSL
#define TRANSPORT_TEXTURED_GLSL

#include "layout/mod.glsl"
#include "shading/texture.glsl"
#include "trace/surface.glsl"

// The surface's material with its texture and vertex colour applied.
Material material_at(Surface surface) {
    Material material = load_material(surface.material);
    material.color *= surface.color;
    if (material.color_texture != INVALID) {
        vec4 texel = sample_texture(load_texture(material.color_texture), surface.uv);
        material.color *= vec3(texel.x, texel.y, texel.z);
    }
    return material;
}

#endif
