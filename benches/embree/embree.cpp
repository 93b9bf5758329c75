// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Traces what `gonio bench --export-rays` wrote with Embree (3 or 4): high quality build, all cores, single rays.
//
//   embree [--runs N] [--warmup N] FOLDER...
//
// One line a run, tab-separated: scene, kind of rays, "embree robust" or "embree fast", millions of rays a second.
// What the tracers agree on goes to stderr: the share of rays that hit the same triangle as gonio's (of any-hit rays: that
// hit at all). It is not 100 %: neither the transforms nor the triangle tests round alike, and Embree cannot be told the
// triangle that a ray leaves, only a shortest distance.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

namespace {

constexpr uint32_t NONE = 0xffffffffu;
// Rays a thread takes at a time, as gonio's CPU backend does.
constexpr size_t CHUNK = 1024;

[[noreturn]] void fail(const std::string& message) {
    std::fprintf(stderr, "error: %s\n", message.c_str());
    std::exit(1);
}

template <class T>
std::vector<T> read_array(const std::string& path, size_t width) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (!file) fail("cannot read " + path);
    std::fseek(file, 0, SEEK_END);
    const size_t bytes = static_cast<size_t>(std::ftell(file));
    std::rewind(file);
    if (bytes % (width * sizeof(T)) != 0) fail(path + ": not a whole number of records");
    std::vector<T> data(bytes / sizeof(T));
    if (std::fread(data.data(), 1, bytes, file) != bytes) fail("cannot read " + path);
    std::fclose(file);
    return data;
}

bool exists(const std::string& path) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (file) std::fclose(file);
    return file != nullptr;
}

// What was exported, for one kind of hit: any-hit rays do not see what casts no shadow.
struct Geometry {
    std::vector<float> corners;      // 9 a triangle
    std::vector<uint32_t> ids;       // instance and primitive a triangle
    std::vector<float> spheres;      // centre and radius
    std::vector<uint32_t> instances; // one a sphere
};

Geometry read_geometry(const std::string& folder, bool casting_only) {
    Geometry geometry;
    const auto corners = read_array<float>(folder + "/triangles.f32", 9);
    const auto ids = read_array<uint32_t>(folder + "/triangles.u32", 3);
    for (size_t i = 0; i * 3 < ids.size(); i++) {
        if (casting_only && ids[3 * i + 2] == 0) continue;
        geometry.corners.insert(geometry.corners.end(), &corners[9 * i], &corners[9 * i] + 9);
        geometry.ids.insert(geometry.ids.end(), &ids[3 * i], &ids[3 * i] + 2);
    }
    const auto spheres = read_array<float>(folder + "/spheres.f32", 12);
    const auto instances = read_array<uint32_t>(folder + "/spheres.u32", 2);
    for (size_t i = 0; i * 2 < instances.size(); i++) {
        if (casting_only && instances[2 * i + 1] == 0) continue;
        const float* m = &spheres[12 * i];
        float length[3];
        for (int c = 0; c < 3; c++) length[c] = std::sqrt(m[c] * m[c] + m[4 + c] * m[4 + c] + m[8 + c] * m[8 + c]);
        if (std::fabs(length[0] - length[1]) > 1e-4f * length[0] || std::fabs(length[0] - length[2]) > 1e-4f * length[0]) {
            fail(folder + ": an ellipsoid, which Embree does not know");
        }
        const float sphere[4] = {m[3], m[7], m[11], length[0]};
        geometry.spheres.insert(geometry.spheres.end(), sphere, sphere + 4);
        geometry.instances.push_back(instances[2 * i]);
    }
    return geometry;
}

RTCScene build(RTCDevice device, const Geometry& geometry, bool robust) {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    const auto fill = [](void* to, const void* from, size_t bytes) { std::memcpy(to, from, bytes); };
    if (!geometry.corners.empty()) {
        RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        const size_t corners = geometry.corners.size() / 3;
        void* vertices = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, corners);
        auto* indices = static_cast<uint32_t*>(
            rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, corners / 3));
        fill(vertices, geometry.corners.data(), geometry.corners.size() * sizeof(float));
        for (size_t i = 0; i < corners; i++) indices[i] = static_cast<uint32_t>(i);
        rtcSetGeometryBuildQuality(mesh, RTC_BUILD_QUALITY_HIGH);
        rtcCommitGeometry(mesh);
        rtcAttachGeometryByID(scene, mesh, 0);
        rtcReleaseGeometry(mesh);
    }
    if (!geometry.spheres.empty()) {
        RTCGeometry points = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        void* vertices = rtcSetNewGeometryBuffer(points, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16,
                                                 geometry.spheres.size() / 4);
        fill(vertices, geometry.spheres.data(), geometry.spheres.size() * sizeof(float));
        rtcCommitGeometry(points);
        rtcAttachGeometryByID(scene, points, 1);
        rtcReleaseGeometry(points);
    }
    rtcCommitScene(scene);
    return scene;
}

// What one ray hit: instance and primitive, or NONE twice; of any-hit rays 1 or 0 in the first.
struct Answer {
    uint32_t instance, primitive;
};

RTCRay ray_of(const float* words) {
    RTCRay ray;
    ray.org_x = words[0], ray.org_y = words[1], ray.org_z = words[2], ray.tnear = words[3];
    ray.dir_x = words[4], ray.dir_y = words[5], ray.dir_z = words[6], ray.tfar = words[7];
    ray.time = 0.0f, ray.mask = 0xffffffffu, ray.id = 0, ray.flags = 0;
    return ray;
}

Answer trace(RTCScene scene, const Geometry& geometry, const float* words, bool any, bool coherent) {
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments intersect;
    RTCOccludedArguments occluded;
    rtcInitIntersectArguments(&intersect);
    rtcInitOccludedArguments(&occluded);
    intersect.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    occluded.flags = intersect.flags;
    RTCIntersectArguments* closest_context = &intersect;
    RTCOccludedArguments* any_context = &occluded;
#define CONTEXT(context) scene
#define ARGUMENTS(context) , context
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    RTCIntersectContext *closest_context = &context, *any_context = &context;
#define CONTEXT(context) scene, context
#define ARGUMENTS(context)
#endif
    if (any) {
        RTCRay ray = ray_of(words);
        rtcOccluded1(CONTEXT(any_context), &ray ARGUMENTS(any_context));
        return {ray.tfar < 0.0f ? 1u : 0u, 0u};
    }
    RTCRayHit hit;
    hit.ray = ray_of(words);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(CONTEXT(closest_context), &hit ARGUMENTS(closest_context));
    switch (hit.hit.geomID) {
    case 0: return {geometry.ids[2 * hit.hit.primID], geometry.ids[2 * hit.hit.primID + 1]};
    case 1: return {geometry.instances[hit.hit.primID], 0u};
    default: return {NONE, NONE};
    }
}

// Seconds to trace all rays once on all cores.
double run(RTCScene scene, const Geometry& geometry, const std::vector<float>& rays, bool any, bool coherent,
           std::vector<Answer>& answers) {
    const size_t count = rays.size() / 8;
    std::atomic<size_t> next{0};
    const auto work = [&] {
        _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
        _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
        for (;;) {
            const size_t first = next.fetch_add(CHUNK);
            if (first >= count) return;
            const size_t end = first + CHUNK < count ? first + CHUNK : count;
            for (size_t i = first; i < end; i++) answers[i] = trace(scene, geometry, &rays[8 * i], any, coherent);
        }
    };
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); i++) threads.emplace_back(work);
    work();
    for (auto& thread : threads) thread.join();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double agreement(const std::string& path, bool any, const std::vector<Answer>& answers) {
    const auto hits = read_array<uint32_t>(path, any ? 1 : 2);
    size_t same = 0;
    for (size_t i = 0; i < answers.size(); i++) {
        same += any ? hits[i] == answers[i].instance
                    : hits[2 * i] == answers[i].instance && (hits[2 * i] == NONE || hits[2 * i + 1] == answers[i].primitive);
    }
    return answers.empty() ? 1.0 : static_cast<double>(same) / static_cast<double>(answers.size());
}

void bench(RTCDevice device, const std::string& folder, int runs, int warmup) {
    const std::string name = folder.substr(folder.find_last_of('/') + 1);
    const struct {
        const char* kind;
        bool any, coherent;
    } sets[] = {{"primary", false, true}, {"diffuse", false, false}, {"second", false, false}, {"occlusion", true, false},
                {"shadow", true, true}};
    const Geometry all = read_geometry(folder, false), casting = read_geometry(folder, true);
    for (const bool robust : {true, false}) {
        const char* tracer = robust ? "embree robust" : "embree fast";
        const auto start = std::chrono::steady_clock::now();
        RTCScene closest = build(device, all, robust);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        std::fprintf(stderr, "%s: %s: build %.4f s\n", name.c_str(), tracer, seconds);
        RTCScene any = all.ids.size() + all.instances.size() == casting.ids.size() + casting.instances.size()
                           ? closest
                           : build(device, casting, robust);
        for (const auto& set : sets) {
            const std::string path = folder + "/" + set.kind;
            if (!exists(path + ".rays.f32")) continue;
            const auto rays = read_array<float>(path + ".rays.f32", 8);
            std::vector<Answer> answers(rays.size() / 8);
            for (int i = 0; i < warmup + runs; i++) {
                const double taken =
                    run(set.any ? any : closest, set.any ? casting : all, rays, set.any, set.coherent, answers);
                if (i >= warmup) {
                    std::printf("%s\t%s\t%s\t%.4f\n", name.c_str(), set.kind, tracer, answers.size() / taken * 1e-6);
                }
            }
            const double same = agreement(path + ".hits.u32", set.any, answers);
            std::fprintf(stderr, "%s: %s: %s: %.4f %% as gonio's\n", name.c_str(), tracer, set.kind, 100.0 * same);
        }
        if (any != closest) rtcReleaseScene(any);
        rtcReleaseScene(closest);
    }
}

} // namespace

int main(int count, char** arguments) {
    int runs = 5, warmup = 1;
    std::vector<std::string> folders;
    for (int i = 1; i < count; i++) {
        const std::string argument = arguments[i];
        if ((argument == "--runs" || argument == "--warmup") && i + 1 < count) {
            (argument == "--runs" ? runs : warmup) = std::atoi(arguments[++i]);
        } else {
            folders.push_back(argument);
            while (folders.back().size() > 1 && folders.back().back() == '/') folders.back().pop_back();
        }
    }
    if (folders.empty() || runs < 1 || warmup < 0) fail("usage: embree [--runs N] [--warmup N] FOLDER...");
    RTCDevice device = rtcNewDevice(nullptr);
    if (!device) fail("Embree cannot be started");
    rtcSetDeviceErrorFunction(device, [](void*, RTCError, const char* text) { fail(text ? text : "Embree failed"); },
                              nullptr);
    for (const auto& folder : folders) bench(device, folder, runs, warmup);
    rtcReleaseDevice(device);
}
