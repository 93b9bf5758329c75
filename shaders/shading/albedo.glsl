// Tables that bake makes of a lobe's directional albedo: a header of ALBEDO_HEADER floats, then ALBEDO_KNOTS values over
// the square root of the cosine, which gathers the knots at grazing angles.
//
// The header: 0 and 1 hold the constants c of the Gaussian distributions of lobes 0 and 1; 2 the mean of the table,
// 2 integral E(mu) mu dmu; 3 to 5 the mean Fresnel reflectance of each channel; 6 a plastic's inner reflectance.
#ifndef SHADING_ALBEDO_GLSL
#define SHADING_ALBEDO_GLSL

#include "layout/records.glsl"
#include "shading/math.glsl"

// The table's value at a cosine (clamped to 0..1), linear between the knots. `first`: first float of the header.
float albedo_at(uint first, float cos_theta) {
    float last = float(ALBEDO_KNOTS - 1u);
    float x = last * sqrt_(clamp_(cos_theta, 0.0, 1.0));
    float whole = min_(floor(x), last - 1.0);
    uint at = first + ALBEDO_HEADER + uint(whole);
    return mix_(load_table(at), load_table(at + 1u), x - whole);
}

#endif
