// A Vulkan driver that is not well. MODE is how: 0 crashes when it is first used, 1 never comes back, 2 cannot list its devices.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <unistd.h>

namespace {

using Function = long (*)();
// What the loader wants to find first in every object that it hands calls on with.
struct Object {
    uintptr_t loader = 0x01CDC0DE;
} object;

long nothing() { return 0; }

int create_instance(const void*, const void*, Object** made) {
    if (MODE == 0) std::abort();
    while (MODE == 1) pause();
    *made = &object;
    return 0;
}

int list_devices(Object*, unsigned*, void*) { return -3; }

int list_extensions(const char*, unsigned* count, void*) {
    *count = 0;
    return 0;
}

}  // namespace

extern "C" int vk_icdNegotiateLoaderICDInterfaceVersion(unsigned* version) {
    if (*version > 5) *version = 5;
    return 0;
}

extern "C" Function vk_icdGetInstanceProcAddr(void*, const char* name) {
    if (!std::strcmp(name, "vkCreateInstance")) return reinterpret_cast<Function>(create_instance);
    if (!std::strcmp(name, "vkEnumeratePhysicalDevices")) return reinterpret_cast<Function>(list_devices);
    if (!std::strcmp(name, "vkEnumerateInstanceExtensionProperties")) return reinterpret_cast<Function>(list_extensions);
    // Later versions of these are asked for, and must not be there.
    if (!std::strncmp(name, "vk_icd", 6) || !std::strcmp(name, "vkEnumerateInstanceVersion")) return nullptr;
    return nothing;
}
