// Proves that both sides see the same bytes: every record of `layout/` is read and written, every constant returned.
//
// tests/layout.rs reflects the SPIR-V of this kernel (names, types, offsets, strides, constants), which needs no device.
//
// On a device, one dispatch checks one record. Set 0 (several blocks share each binding: one per record):
// * binding 0: a SceneHeader (288 bytes), then the records to read, back to back.
//   `header.first_*` of the record must be FIRST_WORD; give the others 0xffffff so that a mix-up is seen.
// * binding 1: the same records as they were read, from byte 0 on; or the constants, one u32 each.
// * push constants: `record` (its number in `main`, or RECORD_COUNT for the constants), `count` (records to read).
// One invocation a record. What binding 1 holds must be what was given from byte 288 on: words 0, 1, 2, ... show
// where a misplaced member came from.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

layout(local_size_x_id = 0, local_size_y = 1, local_size_z = 1) in;
layout(push_constant, scalar) uniform Choice { uint record; uint count; };

const uint RECORD_COUNT = 21u;
const uint FIRST_WORD = 18u;
layout(set = 0, binding = 0, scalar) readonly buffer Heap { uvec4 heap[]; };

// What kernels/bindings.glsl declares, over one heap: `load_*` reads it word by word.
#define GONIO_FETCH
uvec4 fetch_header(uint at) { return heap[FIRST_WORD + at]; }
uvec4 fetch_batch(uint at) { return heap[FIRST_WORD + at]; }
#include "layout/header.glsl"
layout(set = 0, binding = 0, scalar) readonly buffer HeaderBlock { SceneHeader header; };
const bool SCENE_HAS_PASSING = true;
uvec4 fetch_data(uint at) { return heap[at]; }
uvec4 fetch_node(uint at) { return heap[FIRST_WORD + at]; }
uvec4 fetch_triangle(uint at) { return heap[FIRST_WORD + at]; }
uvec4 fetch_path(uint at) { return heap[FIRST_WORD + at]; }
uvec4 fetch_hit(uint at) { return heap[FIRST_WORD + at]; }
uvec4 fetch_shadow(uint at) { return heap[FIRST_WORD + at]; }
layout(set = 0, binding = 1, scalar) writeonly buffer WordsOut { uvec4 words_out[]; };
void put_hit(uint at, uvec4 word) { words_out[at] = word; }
void put_path(uint at, uvec4 word) { words_out[at] = word; }
void put_shadow(uint at, uvec4 word) { words_out[at] = word; }
#include "layout/mod.glsl"

// Records without a `load_*` are read as kernels read them: through a block.
#define IN(Record, name)                                                       \
    layout(set = 0, binding = 0, scalar) readonly buffer Record##In {          \
        uvec4 name##_skip[FIRST_WORD];                                         \
        Record name##_in[];                                                    \
    }
IN(Camera, camera);
IN(FilmSum, film_sum);
IN(AovPixel, aov_pixel);
IN(Ray, ray);
IN(DispatchArguments, dispatch_arguments);
IN(Control, control);

#define OUT(Record, name)                                                      \
    layout(set = 0, binding = 1, scalar) writeonly buffer Record##Out { Record name##_out[]; }
OUT(Node, node);
OUT(Triangle, triangle);
OUT(Instance, instance);
OUT(Face, face);
OUT(Vertex, vertex);
OUT(Material, material);
OUT(Light, light);
OUT(Texture, texture);
// Stored by the word; these are here for their layout.
OUT(Hit, hit);
OUT(PathState, path_state);
OUT(ShadowRay, shadow_ray);
OUT(Camera, camera);
OUT(SceneHeader, scene_header);
OUT(Batch, batch);
OUT(FilmSum, film_sum);
OUT(AovPixel, aov_pixel);
OUT(Ray, ray);
OUT(DispatchArguments, dispatch_arguments);
OUT(Control, control);
OUT(Emitter, emitter);
OUT(EnvironmentMap, environment_map);
layout(set = 0, binding = 1, scalar) writeonly buffer ConstantsOut { uint constants[]; };

// Every constant of layout/*.glsl; floats by their bits. A new one is appended here (tests/layout.rs asks for it).
void store_constants() {
    constants[0] = INVALID;
    constants[1] = CAMERA_PERSPECTIVE;
    constants[2] = CAMERA_ORTHOGRAPHIC;
    constants[3] = MAX_LEVELS;
    constants[4] = NODE_WORDS;
    constants[5] = TRIANGLE_WORDS;
    constants[6] = KIND_MESH;
    constants[7] = KIND_SPHERE;
    constants[8] = INSTANCE_NO_SHADOW;
    constants[9] = INSTANCE_MIRRORED;
    constants[10] = INSTANCE_WORDS;
    constants[11] = FACE_WORDS;
    constants[12] = VERTEX_WORDS;
    constants[13] = INTEGRATOR_LOCAL;
    constants[14] = INTEGRATOR_WHITTED;
    constants[15] = SAMPLER_SOBOL;
    constants[16] = SAMPLER_STRATIFIED;
    constants[17] = SAMPLER_INDEPENDENT;
    constants[18] = FILTER_BOX;
    constants[19] = FILTER_TENT;
    constants[20] = FILTER_TABLE;
    constants[21] = FILTER_KNOTS;
    constants[22] = LIGHT_POINT;
    constants[23] = LIGHT_DIRECTIONAL;
    constants[24] = LIGHT_SPOT;
    constants[25] = ATTENUATION_INVERSE_SQUARE;
    constants[26] = ATTENUATION_POLYNOMIAL;
    constants[27] = ATTENUATION_NONE;
    constants[28] = LIGHT_WORDS;
    constants[29] = MODEL_LAMBERT;
    constants[30] = MODEL_PHONG;
    constants[31] = MODEL_BLINN_PHONG;
    constants[32] = MODEL_COOK_TORRANCE;
    constants[33] = MODEL_MIRROR;
    constants[34] = MODEL_DIELECTRIC;
    constants[35] = MODEL_EMISSIVE;
    constants[36] = MATERIAL_FILTERED;
    constants[37] = MATERIAL_CONDUCTOR;
    constants[38] = MATERIAL_LAFORTUNE;
    constants[39] = MATERIAL_D_1982;
    constants[40] = MATERIAL_WORDS;
    constants[41] = floatBitsToUint(T_INFINITE);
    constants[42] = HIT_WORDS;
    constants[43] = PATH_STATE_WORDS;
    constants[44] = SHADOW_RAY_WORDS;
    constants[45] = TEXEL_SRGB8;
    constants[46] = TEXEL_LINEAR8;
    constants[47] = TEXEL_FLOAT;
    constants[48] = WRAP_REPEAT;
    constants[49] = WRAP_CLAMP;
    constants[50] = WRAP_MIRROR;
    constants[51] = MAGNIFY_NEAREST;
    constants[52] = MAGNIFY_BILINEAR;
    constants[53] = TEXTURE_WORDS;
    constants[54] = STACK_SIZE;
    constants[55] = MODEL_OREN_NAYAR;
    constants[56] = MODEL_WARD;
    constants[57] = MODEL_ASHIKHMIN_SHIRLEY;
    constants[58] = MODEL_KELEMEN;
    constants[59] = MODEL_CONDUCTOR;
    constants[60] = MODEL_ROUGH_CONDUCTOR;
    constants[61] = MODEL_ROUGH_DIELECTRIC;
    constants[62] = MODEL_THIN_DIELECTRIC;
    constants[63] = MODEL_PLASTIC;
    constants[64] = MODEL_ROUGH_PLASTIC;
    constants[65] = MODEL_PRINCIPLED;
    constants[66] = MODEL_MEASURED;
    constants[67] = MODEL_NULL;
    constants[68] = MODEL_BLEND;
    constants[69] = MATERIAL_SCHLICK;
    constants[70] = MATERIAL_SMITH;
    constants[71] = MATERIAL_ANISOTROPIC;
    constants[72] = MATERIAL_NONLINEAR;
    constants[73] = MATERIAL_COMPENSATE;
    constants[74] = MATERIAL_ONE_SIDED;
    constants[75] = MATERIAL_EMIT_ONE_SIDED;
    constants[76] = MATERIAL_WARD_1992;
    constants[77] = MATERIAL_WARD_DUER;
    constants[78] = DISTRIBUTION_SHIFT;
    constants[79] = DISTRIBUTION_BECKMANN;
    constants[80] = DISTRIBUTION_GAUSSIAN;
    constants[81] = DISTRIBUTION_TROWBRIDGE_REITZ;
    constants[82] = DISTRIBUTION_PHONG;
    constants[83] = MATERIAL_TRANSMISSIVE;
    constants[84] = ALBEDO_HEADER;
    constants[85] = ALBEDO_KNOTS;
    constants[86] = MAX_LEAVES;
    constants[87] = INTEGRATOR_PATH;
    constants[88] = EMITTER_TRIANGLE;
    constants[89] = EMITTER_SPHERE;
    constants[90] = EMITTER_LIGHT;
    constants[91] = EMITTER_ENVIRONMENT;
    constants[92] = EMITTER_ONE_SIDED;
    constants[93] = EMITTER_TEXTURED;
    constants[94] = EMITTER_WORDS;
    constants[95] = ENVIRONMENT_MAP_WORDS;
    constants[96] = INSTANCE_FLAT;
    constants[97] = INSTANCE_GOURAUD;
    constants[98] = PATTERN_CHECKER;
    constants[99] = PATTERN_NOISE;
    constants[100] = PATTERN_GRADIENT;
    constants[101] = PATTERN_ZONE_PLATE;
    constants[102] = PARAMETER_COLOR;
    constants[103] = PARAMETER_SPECULAR_COLOR;
    constants[104] = PARAMETER_EMISSION;
    constants[105] = PARAMETER_ROUGHNESS;
    constants[106] = PARAMETER_ROUGHNESS_U;
    constants[107] = PARAMETER_ROUGHNESS_V;
    constants[108] = PARAMETER_METALLIC;
    constants[109] = PARAMETER_OPACITY;
    constants[110] = PARAMETER_MASK;
    constants[111] = PARAMETER_WEIGHT;
    constants[112] = PARAMETER_NORMAL;
    constants[113] = PARAMETER_BUMP;
    constants[114] = CHANNEL_R;
    constants[115] = CHANNEL_G;
    constants[116] = CHANNEL_B;
    constants[117] = CHANNEL_A;
    constants[118] = CHANNEL_RGB;
    constants[119] = TEXTURES_MOST;
    constants[120] = MODEL_TABULATED;
    constants[121] = SHADOWS_OFF;
    constants[122] = SHADOWS_OPAQUE;
    constants[123] = SHADOWS_FILTERED;
    constants[124] = SLIDE_ENTRIES;
    constants[125] = MATERIAL_BY_SIDE;
    constants[126] = PARAMETER_ANISOTROPIC;
    constants[127] = PARAMETER_SPEC_TRANS;
    constants[128] = PARAMETER_SPEC_TINT;
    constants[129] = PARAMETER_SHEEN;
    constants[130] = PARAMETER_SHEEN_TINT;
    constants[131] = PARAMETER_FLATNESS;
    constants[132] = PARAMETER_CLEARCOAT;
    constants[133] = PARAMETER_CLEARCOAT_GLOSS;
    constants[134] = MAX_SHADE_GROUPS;
    constants[135] = SHADE_GROUP_MISSED;
    constants[136] = SCENE_HEADER_WORDS;
    constants[137] = BATCH_WORDS;
    constants[138] = PATH_BEHIND_SHADOWLESS;
    constants[139] = FRACTION_BITS;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (record == RECORD_COUNT) {
        if (i == 0u) store_constants();
        return;
    }
    if (i >= count) return;
    switch (record) {
    case 0u: node_out[i] = load_node(i); break;
    case 1u: triangle_out[i] = load_triangle(i); break;
    case 2u: instance_out[i] = load_instance(i); break;
    case 3u: face_out[i] = load_face(i); break;
    case 4u: vertex_out[i] = load_vertex(i); break;
    case 5u: material_out[i] = load_material(i); break;
    case 6u: light_out[i] = load_light(i); break;
    case 7u: texture_out[i] = load_texture(i); break;
    case 8u: store_hit(i, load_hit(i)); break;
    case 9u: store_path_state(i, load_path_state(i)); break;
    case 10u: store_shadow_ray(i, load_shadow_ray(i)); break;
    case 11u: camera_out[i] = camera_in[i]; break;
    case 12u: scene_header_out[i] = load_scene_header(i); break;
    case 13u: batch_out[i] = load_batch(i); break;
    case 14u: film_sum_out[i] = film_sum_in[i]; break;
    case 15u: aov_pixel_out[i] = aov_pixel_in[i]; break;
    case 16u: ray_out[i] = ray_in[i]; break;
    case 17u: dispatch_arguments_out[i] = dispatch_arguments_in[i]; break;
    case 18u: control_out[i] = control_in[i]; break;
    case 19u: emitter_out[i] = load_emitter(i); break;
    case 20u: environment_map_out[i] = load_environment_map(i); break;
    }
}
