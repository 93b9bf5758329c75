// Buffers of the wavefront and the one way to read them.
//
// Read-only data goes through `fetch_*`, one 16-byte word at a time. The build
// compiles every kernel twice: with FETCH_TEXEL through uniform texel buffers
// (the fastest path on CPU devices), without it through storage buffers.
// The scene's arrays come in up to 8 pages; PAGE_SHIFT is a power of two of words.
#ifndef KERNELS_BINDINGS_GLSL
#define KERNELS_BINDINGS_GLSL
#define GONIO_FETCH

uvec4 fetch_header(uint at);
uvec4 fetch_batch(uint at);
#include "layout/control.glsl"
#include "layout/header.glsl"

layout(local_size_x_id = 0, local_size_y = 1, local_size_z = 1) in;
layout(constant_id = 0) const uint GROUP_SIZE = 64u;
// As many as there may be; the specialisation leaves what the scene has, and a kernel binds no more.
layout(constant_id = 1) const uint NODE_PAGES = 8u;
layout(constant_id = 2) const uint TRIANGLE_PAGES = 8u;
layout(constant_id = 3) const uint DATA_PAGES = 8u;
layout(constant_id = 4) const uint PAGE_SHIFT = 31u;
// Entries of each traversal stack that the scene's hierarchies need.
layout(constant_id = 5) const uint STACK_DEPTH = 32u;
// Choices of the scene, equal to what the Rust twins read in its header or data. Constants, so that a kernel is compiled
// without the rest: devices that walk lanes in lockstep run both sides of every branch.
// Bit n: a material of the scene has MODEL_* n. What no material has costs nothing: the driver cuts it away.
layout(constant_id = 6) const uint MODELS_PRESENT = 0xffffffffu;
#define HAS_MODEL(model) ((MODELS_PRESENT & (1u << (model))) != 0u)
layout(constant_id = 7) const uint SCENE_INTEGRATOR = INTEGRATOR_LOCAL;
layout(constant_id = 8) const uint SCENE_SAMPLING = SAMPLER_SOBOL;
layout(constant_id = 9) const uint SCENE_FILTER = FILTER_BOX;
layout(constant_id = 10) const bool SCENE_HAS_SPHERES = true;
layout(constant_id = 11) const bool SCENE_HAS_AOVS = true;
// Bit n: the scene has an emitter of kind EMITTER_* n.
layout(constant_id = 12) const uint EMITTERS_PRESENT = 0xffffffffu;
#define HAS_EMITTER(kind) ((EMITTERS_PRESENT & (1u << (kind))) != 0u)
layout(constant_id = 13) const bool SCENE_HAS_TEXTURED_EMITTERS = true;
layout(constant_id = 14) const bool SCENE_HAS_ENVIRONMENT_MAP = true;
layout(constant_id = 15) const bool SCENE_HAS_PANES = true;
layout(constant_id = 16) const bool SCENE_HAS_ABSORPTION = true;
// Objects shaded flat or by Gouraud's method.
layout(constant_id = 17) const bool SCENE_HAS_FACETS = true;
// Of materials.
layout(constant_id = 18) const bool SCENE_HAS_TEXTURES = true;
// One instance and no more: no top level to walk.
layout(constant_id = 19) const bool SCENE_IS_ONE_INSTANCE = false;
// Bit n: a texture of the scene has the format TEXEL_* or PATTERN_* n.
layout(constant_id = 20) const uint FORMATS_PRESENT = 0xffffffffu;
// Whether there is a format of the mask. Not `a || b` of two: that is control flow, even among constants.
#define HAS_FORMATS(mask) ((FORMATS_PRESENT & (mask)) != 0u)
layout(constant_id = 21) const bool SCENE_HAS_LENS = true;
// Lights with flaps.
layout(constant_id = 22) const bool SCENE_HAS_FLAPS = true;
#define HAS_FLAPS SCENE_HAS_FLAPS
// SHADOWS_FILTERED only if the scene has something to filter by.
layout(constant_id = 23) const uint SCENE_SHADOWS = SHADOWS_OPAQUE;
// Media with ranks.
layout(constant_id = 24) const bool SCENE_NESTED = true;
// Spots with a picture or a linear ramp.
layout(constant_id = 25) const bool SCENE_HAS_SLIDES = true;
// Objects that cast no shadow.
layout(constant_id = 26) const bool SCENE_SHADOWLESS = true;
// The camera looks through what glows.
layout(constant_id = 27) const bool SCENE_HIDES_EMITTERS = true;
// Contributions have a limit.
layout(constant_id = 28) const bool SCENE_HAS_CLAMP = true;
// Whether paths keep what they have passed since their direction was drawn: panes that filter, objects that cast no shadow.
const bool SCENE_HAS_PASSING = SCENE_SHADOWLESS || SCENE_SHADOWS == SHADOWS_FILTERED;
// Whether extend makes the camera rays of its chunk, or reads what waited.
layout(constant_id = 32) const bool EXTEND_CAMERA = false;
// Whether paths are shaded in groups by the model they hit, each by a kernel that has its models for `MODELS_PRESENT`.
layout(constant_id = 31) const bool SHADE_GROUPED = false;
// Which of them a kernel shades.
layout(constant_id = 29) const uint SHADE_GROUP = SHADE_GROUP_MISSED;
// The one model of that group, or INVALID if there are more. Said of a material once it is found, so that drivers leave out
// what the model excludes.
layout(constant_id = 30) const uint SHADE_MODEL = 0xffffffffu;
#define NAME_MODEL(material) if (SHADE_MODEL != INVALID) material.model = SHADE_MODEL;

// Set 0: the scene.
layout(set = 0, binding = 0) uniform HeaderBlock { uvec4 header_words[SCENE_HEADER_WORDS]; };
// Plus 0, which no driver knows, lest branches hang on uniforms alone (ARCHITECTURE.md, "What lanes share").
uvec4 fetch_header(uint at) { return header_words[at] + gl_WorkGroupID.y; }
// Read by `begin`, while no lane is masked.
SceneHeader header;
#ifdef FETCH_TEXEL
layout(set = 0, binding = 1) uniform usamplerBuffer node_pages[NODE_PAGES];
layout(set = 0, binding = 2) uniform usamplerBuffer triangle_pages[TRIANGLE_PAGES];
layout(set = 0, binding = 3) uniform usamplerBuffer data_pages[DATA_PAGES];
#define GONIO_READ(buffers, page, at) texelFetch(buffers[page], int(at))
#else
layout(set = 0, binding = 1, scalar) readonly buffer NodePage { uvec4 words[]; } node_pages[NODE_PAGES];
layout(set = 0, binding = 2, scalar) readonly buffer TrianglePage { uvec4 words[]; } triangle_pages[TRIANGLE_PAGES];
layout(set = 0, binding = 3, scalar) readonly buffer DataPage { uvec4 words[]; } data_pages[DATA_PAGES];
#define GONIO_READ(buffers, page, at) buffers[page].words[at]
#endif

// A set's page is chosen by comparing with constants: descriptor arrays may not be indexed by data everywhere. Pages that
// the scene does not have are cut away by the specialisation: each fetch is inlined, so every page costs compile time.
#define GONIO_FETCH_PAGED(name, buffers, PAGES)                                \
    uvec4 name(uint at) {                                                      \
        if (PAGES == 1u) return GONIO_READ(buffers, 0, at);                    \
        uint page = at >> PAGE_SHIFT;                                          \
        uint within = at & ((1u << PAGE_SHIFT) - 1u);                          \
        if (PAGES > 7u && page == 7u) return GONIO_READ(buffers, 7, within);   \
        if (PAGES > 6u && page == 6u) return GONIO_READ(buffers, 6, within);   \
        if (PAGES > 5u && page == 5u) return GONIO_READ(buffers, 5, within);   \
        if (PAGES > 4u && page == 4u) return GONIO_READ(buffers, 4, within);   \
        if (PAGES > 3u && page == 3u) return GONIO_READ(buffers, 3, within);   \
        if (PAGES > 2u && page == 2u) return GONIO_READ(buffers, 2, within);   \
        if (PAGES > 1u && page == 1u) return GONIO_READ(buffers, 1, within);   \
        return GONIO_READ(buffers, 0, within);                                 \
    }

GONIO_FETCH_PAGED(fetch_node, node_pages, NODE_PAGES)
GONIO_FETCH_PAGED(fetch_triangle, triangle_pages, TRIANGLE_PAGES)
GONIO_FETCH_PAGED(fetch_data, data_pages, DATA_PAGES)

// Set 1: the work. Bindings 8-11 are read-only views of the buffers bound at 1-4, 13 and 14 of those at 5 and 6.
#ifdef FETCH_TEXEL
layout(set = 1, binding = 8) uniform usamplerBuffer level_words;
layout(set = 1, binding = 9) uniform usamplerBuffer chunk_words;
layout(set = 1, binding = 10) uniform usamplerBuffer hit_words;
layout(set = 1, binding = 11) uniform usamplerBuffer shadow_words;
layout(set = 1, binding = 13) uniform usamplerBuffer slot_words;
layout(set = 1, binding = 14) uniform usamplerBuffer film_words;
uvec4 fetch_level(uint at) { return texelFetch(level_words, int(at)); }
uvec4 fetch_chunk(uint at) { return texelFetch(chunk_words, int(at)); }
uvec4 fetch_hit(uint at) { return texelFetch(hit_words, int(at)); }
uvec4 fetch_shadow(uint at) { return texelFetch(shadow_words, int(at)); }
uvec4 fetch_slot(uint at) { return texelFetch(slot_words, int(at)); }
uvec4 fetch_film(uint at) { return texelFetch(film_words, int(at)); }
#else
layout(set = 1, binding = 8, scalar) readonly buffer LevelWords { uvec4 level_words[]; };
layout(set = 1, binding = 9, scalar) readonly buffer ChunkWords { uvec4 chunk_words[]; };
layout(set = 1, binding = 10, scalar) readonly buffer HitWords { uvec4 hit_words[]; };
layout(set = 1, binding = 11, scalar) readonly buffer ShadowWords { uvec4 shadow_words[]; };
layout(set = 1, binding = 13, scalar) readonly buffer SlotWords { uvec4 slot_words[]; };
layout(set = 1, binding = 14, scalar) readonly buffer FilmWords { uvec4 film_words[]; };
uvec4 fetch_level(uint at) { return level_words[at]; }
uvec4 fetch_chunk(uint at) { return chunk_words[at]; }
uvec4 fetch_hit(uint at) { return hit_words[at]; }
uvec4 fetch_shadow(uint at) { return shadow_words[at]; }
uvec4 fetch_slot(uint at) { return slot_words[at]; }
uvec4 fetch_film(uint at) { return film_words[at]; }
#endif

// Records of the queues are written by the word, too: CPU devices store lane by lane, and a word costs little more than a
// quarter of it.
layout(set = 1, binding = 1, scalar) writeonly buffer LevelBlock { uvec4 levels[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer ChunkBlock { uvec4 chunk[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer HitBlock { uvec4 hits[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer ShadowBlock { uvec4 shadows[]; };
void put_hit(uint at, uvec4 word) { hits[at] = word; }
void put_shadow(uint at, uvec4 word) { shadows[at] = word; }

// Where paths are read and written: extend copies its chunk from the levels, the others go from the chunk to the levels.
#ifdef PATHS_FROM_LEVELS
#define fetch_path fetch_level
void put_path(uint at, uvec4 word) { chunk[at] = word; }
#else
#define fetch_path fetch_chunk
void put_path(uint at, uvec4 word) { levels[at] = word; }
#endif
#include "layout/mod.glsl"

// Arrays of single words in the data heap, as the Rust twins' slices.
uint load_top_instance(uint index) { return fetch_data(header.first_top_instance + (index >> 2u))[index & 3u]; }
uint load_texel(uint word) { return fetch_data(header.first_texel + (word >> 2u))[word & 3u]; }
// The model of a material, without the rest of it.
uint load_model(uint material) { return fetch_data(header.first_material + material * MATERIAL_WORDS).w; }
float load_table(uint index) { return uintBitsToFloat(fetch_data(header.first_table + (index >> 2u))[index & 3u]); }

layout(set = 1, binding = 0, scalar) coherent buffer ControlBlock { Control control; };
layout(set = 1, binding = 5, scalar) coherent buffer SlotBlock { FilmSum slots[]; };
layout(set = 1, binding = 6, scalar) coherent buffer FilmBlock { FilmSum film[]; };
layout(set = 1, binding = 7, scalar) coherent buffer AovBlock { AovPixel aovs[]; };

layout(set = 1, binding = 12, scalar) buffer OrderBlock { uint order[]; };

layout(push_constant) uniform BatchBlock { uvec4 batch_words[BATCH_WORDS]; };
// As `fetch_header`.
uvec4 fetch_batch(uint at) { return batch_words[at] + gl_WorkGroupID.y; }
Batch batch;

// To be called before anything else.
void begin() {
    header = load_scene_header(0u);
    batch = load_batch(0u);
}

#endif
