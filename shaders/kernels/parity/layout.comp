// Proves that both sides see the same bytes: every record of the layout is read and written, every constant returned.
//
// tests/layout.rs reflects the SPIR-V of this kernel (names, types, offsets, strides, constants), which needs no device.
//
// On a device, one dispatch checks one record. Set 0 (several blocks share each binding: one per record):
// * binding 0: a SceneHeader, then the records to read, back to back.
//   `header.first` of the record's array must be SCENE_HEADER_WORDS; give the others 0xffffff so that a mix-up is seen.
// * binding 1: the same records as they were read, from byte 0 on; or the constants, one u32 each.
// * push constants: `record` (its number in `RECORDS`, or RECORD_COUNT for the constants), `count` (records to read).
// One invocation a record. What binding 1 holds must be what was given behind the header: words 0, 1, 2, ... show
// where a misplaced member came from.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "layout/features.glsl"
#include "layout/records.glsl"
#include "layout/variant.glsl"

layout(push_constant, scalar) uniform Choice { uint record; uint count; };
layout(set = 0, binding = 0, scalar) readonly buffer Heap { uvec4 heap[]; };
layout(set = 0, binding = 0, scalar) readonly buffer HeaderBlock { SceneHeader header; };

// What kernels/bindings.glsl declares, over one heap: `load_*` reads it word by word.
uvec4 fetch_behind(uint at) { return heap[SCENE_HEADER_WORDS + at]; }
#define fetch_header fetch_behind
#define fetch_batch fetch_behind
#define fetch_node fetch_behind
#define fetch_triangle fetch_behind
#define fetch_path fetch_behind
#define fetch_hit fetch_behind
#define fetch_shadow fetch_behind
uvec4 fetch_data(uint at) { return heap[at]; }
layout(set = 0, binding = 1, scalar) writeonly buffer WordsOut { uvec4 words_out[]; };
void put_hit(uint at, uvec4 word) { words_out[at] = word; }
void put_path(uint at, uvec4 word) { words_out[at] = word; }
void put_shadow(uint at, uvec4 word) { words_out[at] = word; }
#include "layout/fetch.glsl"

// Records without a `load_*` are read as kernels read them: through a block. All are written through one, or stored by the
// word and declared for their layout.
#define IN(Record, name)                                                       \
    layout(set = 0, binding = 0, scalar) readonly buffer Record##In {          \
        uvec4 name##_skip[SCENE_HEADER_WORDS];                                 \
        Record name##_in[];                                                    \
    }
#define OUT(Record, name)                                                      \
    layout(set = 0, binding = 1, scalar) writeonly buffer Record##Out { Record name##_out[]; }
layout(set = 0, binding = 1, scalar) writeonly buffer ConstantsOut { uint constants[]; };
#include "layout/proof.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (record == RECORD_COUNT) {
        if (i == 0u) store_constants();
        return;
    }
    if (i < count) copy_record(record, i);
}
