// Buffers of the wavefront and the one way to read them.
//
// Read-only data goes through `fetch_*`, one 16-byte word at a time. The build
// compiles every kernel twice: with FETCH_TEXEL through uniform texel buffers
// (the fastest path on CPU devices), without it through storage buffers.
// The scene's arrays come in up to MAX_PAGES pages; PAGE_SHIFT is a power of two of words.
#ifndef KERNELS_BINDINGS_GLSL
#define KERNELS_BINDINGS_GLSL
#define GONIO_FETCH

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "layout/variant.glsl"

layout(set = SET_SCENE, binding = BINDING_HEADER) uniform HeaderBlock { uvec4 header_words[SCENE_HEADER_WORDS]; };
// Plus 0, which no driver knows, lest branches hang on uniforms alone (ARCHITECTURE.md, "What lanes share").
uvec4 fetch_header(uint at) { return header_words[at] + gl_WorkGroupID.y; }
// Read by `begin`, while no lane is masked.
SceneHeader header;
#ifdef FETCH_TEXEL
layout(set = SET_SCENE, binding = BINDING_NODES) uniform usamplerBuffer node_pages[NODE_PAGES];
layout(set = SET_SCENE, binding = BINDING_TRIANGLES) uniform usamplerBuffer triangle_pages[TRIANGLE_PAGES];
layout(set = SET_SCENE, binding = BINDING_DATA) uniform usamplerBuffer data_pages[DATA_PAGES];
#define GONIO_READ(buffers, page, at) texelFetch(buffers[page], int(at))
#else
layout(set = SET_SCENE, binding = BINDING_NODES, scalar) readonly buffer NodePage { uvec4 words[]; } node_pages[NODE_PAGES];
layout(set = SET_SCENE, binding = BINDING_TRIANGLES, scalar) readonly buffer TrianglePage { uvec4 words[]; } triangle_pages[TRIANGLE_PAGES];
layout(set = SET_SCENE, binding = BINDING_DATA, scalar) readonly buffer DataPage { uvec4 words[]; } data_pages[DATA_PAGES];
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

// The work. What a kernel only reads it reads through a view of the same buffer.
#ifdef FETCH_TEXEL
#define GONIO_VIEW(place, Block, words, fetch)                                 \
    layout(set = SET_WORK, binding = place) uniform usamplerBuffer words;      \
    uvec4 fetch(uint at) { return texelFetch(words, int(at)); }
#else
#define GONIO_VIEW(place, Block, words, fetch)                                 \
    layout(set = SET_WORK, binding = place, scalar) readonly buffer Block { uvec4 words[]; }; \
    uvec4 fetch(uint at) { return words[at]; }
#endif
GONIO_VIEW(BINDING_LEVELS_READ, LevelWords, level_words, fetch_level)
GONIO_VIEW(BINDING_CHUNK_READ, ChunkWords, chunk_words, fetch_chunk)
GONIO_VIEW(BINDING_HITS_READ, HitWords, hit_words, fetch_hit)
GONIO_VIEW(BINDING_SHADOWS_READ, ShadowWords, shadow_words, fetch_shadow)
GONIO_VIEW(BINDING_SLOTS_READ, SlotWords, slot_words, fetch_slot)
GONIO_VIEW(BINDING_FILM_READ, FilmWords, film_words, fetch_film)

// Records of the queues are written by the word, too: CPU devices store lane by lane, and a word costs little more than a
// quarter of it.
layout(set = SET_WORK, binding = BINDING_LEVELS, scalar) writeonly buffer LevelBlock { uvec4 levels[]; };
layout(set = SET_WORK, binding = BINDING_CHUNK, scalar) writeonly buffer ChunkBlock { uvec4 chunk[]; };
layout(set = SET_WORK, binding = BINDING_HITS, scalar) writeonly buffer HitBlock { uvec4 hits[]; };
layout(set = SET_WORK, binding = BINDING_SHADOWS, scalar) writeonly buffer ShadowBlock { uvec4 shadows[]; };
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

layout(set = SET_WORK, binding = BINDING_CONTROL, scalar) coherent buffer ControlBlock { Control control; };
layout(set = SET_WORK, binding = BINDING_SLOTS, scalar) coherent buffer SlotBlock { FilmSum slots[]; };
layout(set = SET_WORK, binding = BINDING_FILM, scalar) coherent buffer FilmBlock { FilmSum film[]; };
layout(set = SET_WORK, binding = BINDING_AOVS, scalar) coherent buffer AovBlock { AovPixel aovs[]; };
layout(set = SET_WORK, binding = BINDING_ORDER, scalar) buffer OrderBlock { uint order[]; };

layout(push_constant) uniform BatchBlock { uvec4 batch_words[BATCH_WORDS]; };
// As `fetch_header`.
uvec4 fetch_batch(uint at) { return batch_words[at] + gl_WorkGroupID.y; }
Batch batch;

#include "layout/fetch.glsl"

// The model of a material, without the rest of it.
uint load_model(uint material) { return fetch_data(header.first.materials + material * MATERIAL_WORDS).w; }

// To be called before anything else.
void begin() {
    header = load_scene_header(0u);
    batch = load_batch(0u);
}

#endif
