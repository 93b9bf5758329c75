// The frame of every function-level parity kernel: one invocation evaluates one twin on one set of arguments.
//
// Set 0: binding 0 holds ARGUMENTS words for each invocation, binding 1 takes RESULTS words from each. Push constants
// name the function (its number in the kernel's switch, and in `src/verify/twins/`) and count the invocations.
// Arguments and results travel as bits, so that no NaN is touched on the way.
#ifndef KERNELS_PARITY_HARNESS_GLSL
#define KERNELS_PARITY_HARNESS_GLSL

layout(local_size_x = 64, local_size_y = 1, local_size_z = 1) in;
layout(push_constant, scalar) uniform Choice { uint function; uint count; };
layout(set = 0, binding = 0, scalar) readonly buffer Arguments { uint arguments[]; };
layout(set = 0, binding = 1, scalar) writeonly buffer Results { uint results[]; };

const uint ARGUMENTS = 16u;
const uint RESULTS = 8u;

uint argument_u(uint k) { return arguments[gl_GlobalInvocationID.x * ARGUMENTS + k]; }
float argument(uint k) { return uintBitsToFloat(argument_u(k)); }
vec2 argument2(uint k) { return vec2(argument(k), argument(k + 1u)); }
vec3 argument3(uint k) { return vec3(argument(k), argument(k + 1u), argument(k + 2u)); }

void result_u(uint k, uint value) { results[gl_GlobalInvocationID.x * RESULTS + k] = value; }
void result(uint k, float value) { result_u(k, floatBitsToUint(value)); }
void result2(uint k, vec2 value) { result(k, value.x); result(k + 1u, value.y); }
void result3(uint k, vec3 value) { result2(k, value.xy); result(k + 2u, value.z); }
void result4(uint k, vec4 value) { result3(k, value.xyz); result(k + 3u, value.w); }

#endif
