// Textures: nearest and bilinear reading with exact weights, and the means over what a pixel covers (row 27).
//
// Texel centres are at half-integers; v = 0 is the bottom edge.
#ifndef SHADING_TEXTURE_GLSL
#define SHADING_TEXTURE_GLSL

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "shading/coordinate.glsl"
#include "shading/footprint.glsl"
#include "shading/math.glsl"
#include "shading/pattern.glsl"

// Masks, not `a || b`: that is control flow, even among constants.
#define HAS_PATTERN ((FORMATS & (~0u << PATTERN_CHECKER)) != 0u)
#define HAS_IMAGE ((FORMATS & ~(~0u << PATTERN_CHECKER)) != 0u)

// The f32 nearest to 1 / 255; 255 times it is exactly 1.
const float INV_255 = 0.003921569;
// Probes along the longer side of what a pixel covers, at most; beyond, both sides blur.
const float PROBES_MOST = 8.0;
// 1 / `PROBES_MOST`.
const float PROBE_LEAST = 0.125;

// How finely a texture is read: `probes` (1 to 8) in a row, `spacing` apart in its own coordinates, each as wide as
// `width` texels of level 0.
struct Detail {
    vec2 spacing;
    float width;
    uint probes;
};

// The detail that `footprint` leaves: probes along its longer side, each as wide as the shorter one. A texture without
// mip levels is read at the point alone.
// Source: after McCormack et al. 1999, "Feline: Fast Elliptical Lines for Anisotropic Texture Mapping", with equal weights.
Detail texture_detail(Texture texture_record, Footprint footprint) {
    if (texture_record.level_count == 0u) {
        return Detail(vec2(0.0), 0.0, 1u);
    }
    vec2 size = vec2(float(texture_record.width), float(texture_record.height));
    vec2 along = texture_vector(texture_record, footprint.along);
    vec2 across = texture_vector(texture_record, footprint.across);
    vec2 along_texels = along * size;
    vec2 across_texels = across * size;
    float along_length = sqrt_(dot2(along_texels, along_texels));
    float across_length = sqrt_(dot2(across_texels, across_texels));
    vec2 longer = along_length >= across_length ? along : across;
    float major = max_(along_length, across_length);
    float minor = min_(along_length, across_length);
    // Bilinear reading is one texel wide in any case; a pattern can be as sharp as the pixel.
    float finest = texture_record.format >= PATTERN_CHECKER ? 0.0 : 1.0;
    float width = max_(max_(minor, major * PROBE_LEAST), finest);
    float probes = clamp_(floor(div(major, width) + 0.5), 1.0, PROBES_MOST);
    return Detail(longer * rcp(probes), width, uint(probes));
}

// Channel `shift` / 8 of a packed texel, 0..255.
uint texel_byte(uint word, uint shift) {
    return (word >> shift) & 255u;
}

#ifdef GONIO_FETCH
// One texel, linear. `column` from the left, `row` from the bottom, both inside the image.
vec4 read_texel(Texture texture_record, int column, int row) {
    // Stored from the top row down.
    uint index = (texture_record.height - 1u - uint(row)) * texture_record.width + uint(column);
    if (HAS_FORMAT(TEXEL_SRGB8) && texture_record.format == TEXEL_SRGB8) {
        uint word = load_texel(texture_record.first_word + index);
        // The decoding table is the first of the table array.
        return vec4(
            load_table(texel_byte(word, 0u)),
            load_table(texel_byte(word, 8u)),
            load_table(texel_byte(word, 16u)),
            float(texel_byte(word, 24u)) * INV_255
        );
    }
    if (HAS_FORMAT(TEXEL_LINEAR8) && texture_record.format == TEXEL_LINEAR8) {
        uint word = load_texel(texture_record.first_word + index);
        return vec4(
            float(texel_byte(word, 0u)) * INV_255,
            float(texel_byte(word, 8u)) * INV_255,
            float(texel_byte(word, 16u)) * INV_255,
            float(texel_byte(word, 24u)) * INV_255
        );
    }
    // TEXEL_FLOAT
    uint word = texture_record.first_word + 4u * index;
    return vec4(
        uintBitsToFloat(load_texel(word)),
        uintBitsToFloat(load_texel(word + 1u)),
        uintBitsToFloat(load_texel(word + 2u)),
        uintBitsToFloat(load_texel(word + 3u))
    );
}

// The image at its own coordinates `uv` (finite), linear; alpha in lane 3.
vec4 read_image(Texture texture_record, vec2 uv) {
    bool bilinear = texture_record.magnify == MAGNIFY_BILINEAR;
    // 0..size: at most 65,535, so the conversions below are in range.
    float x = wrap_coordinate(uv.x, texture_record.wrap_u) * float(texture_record.width);
    float y = wrap_coordinate(uv.y, texture_record.wrap_v) * float(texture_record.height);
    float shift = bilinear ? 0.5 : 0.0;
    float left = floor(x - shift);
    float below = floor(y - shift);
    float weight_x = (x - shift) - left;
    float weight_y = (y - shift) - below;
    // Nearest: the far edge itself belongs to the last texel.
    uint wrap_u = bilinear ? texture_record.wrap_u : WRAP_CLAMP;
    uint wrap_v = bilinear ? texture_record.wrap_v : WRAP_CLAMP;
    vec4 row = vec4(0.0);
    vec4 image = vec4(0.0);
    // Left and right below, left and right above; nearest takes the first. One place that reads: it is inlined once.
    int corners = bilinear ? 4 : 1;
    for (int corner = 0; corner < 4; corner++) {
        int column_index = wrap_texel(int(left) + (corner & 1), int(texture_record.width), wrap_u);
        int row_index = wrap_texel(int(below) + (corner >> 1), int(texture_record.height), wrap_v);
        vec4 texel = read_texel(texture_record, column_index, row_index);
        // a + (b - a) t leaves equal neighbours exactly as they are.
        row = (corner & 1) == 0 ? texel : row + (texel - row) * weight_x;
        image = corner <= 1 ? row : image;
        if (corner + 1 == corners) {
            break;
        }
    }
    return bilinear ? image + (row - image) * weight_y : image;
}

// The texture at its own coordinates `uv` (finite), linear; alpha in lane 3. Trilinear between the two levels nearest to
// the detail's width, and the mean of its probes.
vec4 filter_texture(Texture texture_record, vec2 uv, Detail detail) {
    bool is_pattern = texture_record.format >= PATTERN_CHECKER;
    // The finer of the two levels, and the share of the coarser.
    float last = max_(float(texture_record.level_count) - 1.0, 0.0);
    float lambda = detail.width > 1.0 ? min_(log2_(detail.width), last) : 0.0;
    float finer = floor(lambda);
    float blend = lambda - finer;
    uint levels = blend > 0.0 ? 2u : 1u;
    vec4 result = vec4(0.0);
    for (uint offset = 0u; offset < 2u; offset++) {
        uint index = uint(finer) + offset;
        Texture level = texture_record;
        if (index != 0u) {
            level = load_texture(texture_record.first_level + (index - 1u));
        }
        vec4 sum = vec4(0.0);
        for (uint probe = 0u; probe < 8u; probe++) {
            vec2 place = uv + detail.spacing * ((float(probe) + 0.5) - 0.5 * float(detail.probes));
            vec4 texel = vec4(0.0);
            if (HAS_PATTERN && is_pattern) {
                texel = sample_pattern(level, place, detail.width * rcp(float(texture_record.width)));
            }
            if (HAS_IMAGE && !is_pattern) {
                texel = read_image(level, place);
            }
            sum = sum + texel;
            if (probe + 1u == detail.probes) {
                break;
            }
        }
        vec4 mean = detail.probes == 1u ? sum : sum * rcp(float(detail.probes));
        result = offset == 0u ? mean : result + (mean - result) * blend;
        if (offset + 1u == levels) {
            break;
        }
    }
    return result;
}

// The image at the surface's `uv`, read at the point alone; any uv is safe. Not for patterns.
vec4 sample_texture(Texture texture_record, vec2 uv) {
    return read_image(texture_record, texture_uv(texture_record, uv));
}
#endif

#endif
