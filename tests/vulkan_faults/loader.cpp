// A Vulkan loader that fails on purpose. It hands every call on to the system's loader, but for one: of the calls that may
// fail it answers the one whose number GONIO_FAULT_CALL gives (from 1) with the VkResult GONIO_FAULT_CODE. After a lost
// device all that waits or submits is lost too, as a driver would have it. GONIO_FAULT_LOG names a file for the calls, a line
// each. With GONIO_FAULT_GPU every device says that it is a discrete GPU.
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <string>
#include <utility>

namespace {

using Word = long;
// Arguments are integers and pointers, eight at most: enough registers and stack for every function that is failed.
using Call = Word (*)(Word, Word, Word, Word, Word, Word, Word, Word);
using Find = Call (*)(void*, const char*);

constexpr int ERROR_DEVICE_LOST = -4;
constexpr size_t MOST = 64;

struct Function {
    std::string name;
    Call real;
};
Function functions[MOST];
size_t count = 0;
std::atomic<int> calls{0};
std::atomic<bool> lost{false};

const char* variable(const char* name) { return std::getenv(name); }
int number(const char* name) { return variable(name) ? std::atoi(variable(name)) : 0; }

bool starts(const std::string& name, const char* prefix) { return name.compare(0, std::strlen(prefix), prefix) == 0; }

// Whether a function returns a VkResult.
bool may_fail(const std::string& name) {
    for (const char* prefix : {"vkCreate", "vkEnumerate", "vkAllocate", "vkMap", "vkBind", "vkBegin", "vkEnd", "vkQueue", "vkWait", "vkFlush",
                               "vkInvalidate", "vkDeviceWaitIdle", "vkResetFences", "vkResetCommand", "vkGetFenceStatus",
                               "vkGetPipelineCacheData", "vkGetQueryPoolResults"})
        if (starts(name, prefix)) return true;
    return false;
}

bool may_be_lost(const std::string& name) {
    return starts(name, "vkQueue") || starts(name, "vkWait") || starts(name, "vkDeviceWait") || name == "vkGetFenceStatus" ||
           name == "vkGetQueryPoolResults";
}

// The result to give instead of a call's own; 0 for its own.
int fault(const std::string& name) {
    const int call = ++calls;
    const bool is_meant = call == number("GONIO_FAULT_CALL");
    if (const char* path = variable("GONIO_FAULT_LOG"))
        if (FILE* log = std::fopen(path, "a")) {
            std::fprintf(log, "%d %s%s\n", call, name.c_str(), is_meant ? " FAILED" : "");
            std::fclose(log);
        }
    if (is_meant) {
        const int code = number("GONIO_FAULT_CODE");
        if (code == ERROR_DEVICE_LOST) lost = true;
        return code;
    }
    return lost && may_be_lost(name) ? ERROR_DEVICE_LOST : 0;
}

template <size_t N>
Word failing(Word a, Word b, Word c, Word d, Word e, Word f, Word g, Word h) {
    if (const int result = fault(functions[N].name)) return result;
    return functions[N].real(a, b, c, d, e, f, g, h);
}

template <size_t... N>
Call wrapper(size_t at, std::index_sequence<N...>) {
    static const Call all[] = {failing<N>...};
    return all[at];
}

Call properties, properties_2;

// VkPhysicalDeviceProperties has its deviceType behind four words; the other structure has two words and a pointer before it.
constexpr size_t TYPE = 4 * sizeof(int), TYPE_2 = TYPE + 2 * sizeof(void*);
constexpr int DISCRETE_GPU = 2;

Word gpu_properties(Word device, Word to, Word, Word, Word, Word, Word, Word) {
    properties(device, to, 0, 0, 0, 0, 0, 0);
    std::memcpy(reinterpret_cast<char*>(to) + TYPE, &DISCRETE_GPU, sizeof(int));
    return 0;
}

Word gpu_properties_2(Word device, Word to, Word, Word, Word, Word, Word, Word) {
    properties_2(device, to, 0, 0, 0, 0, 0, 0);
    std::memcpy(reinterpret_cast<char*>(to) + TYPE_2, &DISCRETE_GPU, sizeof(int));
    return 0;
}

Call wrapped(const std::string& name, Call real) {
    if (!real) return real;
    if (variable("GONIO_FAULT_GPU")) {
        if (name == "vkGetPhysicalDeviceProperties") return properties = real, gpu_properties;
        if (name == "vkGetPhysicalDeviceProperties2") return properties_2 = real, gpu_properties_2;
    }
    if (!may_fail(name)) return real;
    size_t at = 0;
    while (at < count && functions[at].name != name) at++;
    if (at == MOST) std::abort();
    if (at == count) functions[count++].name = name;
    functions[at].real = real;
    return wrapper(at, std::make_index_sequence<MOST>{});
}

Find system_loader() {
    static void* library = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
    return library ? reinterpret_cast<Find>(dlsym(library, "vkGetInstanceProcAddr")) : nullptr;
}

Find device_functions;

Call find_of_device(void* device, const char* name) { return wrapped(name, device_functions(device, name)); }

}  // namespace

extern "C" Call vkGetInstanceProcAddr(void* instance, const char* name) {
    const Find find = system_loader();
    if (!find) return nullptr;
    const std::string asked = name;
    const Call found = find(instance, name);
    if (asked == "vkGetDeviceProcAddr" && found) {
        device_functions = reinterpret_cast<Find>(found);
        return reinterpret_cast<Call>(find_of_device);
    }
    return wrapped(asked, found);
}
