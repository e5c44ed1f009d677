/// A Vulkan layer that makes a good driver fail: out of memory, device lost, loops cut short. For tests, steered by the
/// environment.
///
/// VKPM_LAYER_MEMORY=bytes   no more device memory than this
/// VKPM_LAYER_LOST=n         the device is lost while it runs the n-th submission
/// VKPM_LAYER_TRIPS=n        the audit's loops end after n trips
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string_view>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

namespace {

std::uint64_t setting(const char* name) {
    const char* text = std::getenv(name);
    return text ? std::strtoull(text, nullptr, 10) : 0;
}

// The next layer's or the driver's functions; a process has one device at a time.
PFN_vkGetInstanceProcAddr nextInstanceProc = nullptr;
PFN_vkGetDeviceProcAddr nextDeviceProc = nullptr;
VkInstance instanceNow = VK_NULL_HANDLE;
VkDevice deviceNow = VK_NULL_HANDLE;

template <class Function> Function next(const char* name) {
    return reinterpret_cast<Function>(nextDeviceProc(deviceNow, name));
}

std::mutex mutex;
std::map<VkDeviceMemory, VkDeviceSize> allocations;
VkDeviceSize allocated = 0;
std::uint64_t submissions = 0;
bool lost = false;

/// The loader's link to the next layer in a chain of creation structs.
template <class Link> Link* findLink(const void* chain, VkStructureType type) {
    auto* link = static_cast<Link*>(const_cast<void*>(chain));
    while (link != nullptr && (link->sType != type || link->function != VK_LAYER_LINK_INFO))
        link = static_cast<Link*>(const_cast<void*>(link->pNext));
    return link;
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                              VkInstance* instance) {
    auto* link = findLink<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
    nextInstanceProc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateInstance>(nextInstanceProc(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, allocator, instance);
    if (result == VK_SUCCESS) instanceNow = *instance;
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* allocator, VkDevice* device) {
    auto* link = findLink<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
    const auto instanceProc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    nextDeviceProc = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateDevice>(instanceProc(instanceNow, "vkCreateDevice"));
    const VkResult result = create(physical, info, allocator, device);
    if (result == VK_SUCCESS) deviceNow = *device;
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL allocateMemory(VkDevice device, const VkMemoryAllocateInfo* info,
                                              const VkAllocationCallbacks* allocator, VkDeviceMemory* memory) {
    const std::lock_guard lock(mutex);
    const std::uint64_t limit = setting("VKPM_LAYER_MEMORY");
    if (limit > 0 && allocated + info->allocationSize > limit) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    const VkResult result = next<PFN_vkAllocateMemory>("vkAllocateMemory")(device, info, allocator, memory);
    if (result == VK_SUCCESS) allocated += allocations[*memory] = info->allocationSize;
    return result;
}

VKAPI_ATTR void VKAPI_CALL freeMemory(VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks* allocator) {
    const std::lock_guard lock(mutex);
    allocated -= allocations[memory];
    allocations.erase(memory);
    next<PFN_vkFreeMemory>("vkFreeMemory")(device, memory, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL queueSubmit2(VkQueue queue, std::uint32_t count, const VkSubmitInfo2* submits,
                                            VkFence fence) {
    if (lost) return VK_ERROR_DEVICE_LOST;
    lost = ++submissions == setting("VKPM_LAYER_LOST");
    return lost ? VK_SUCCESS : next<PFN_vkQueueSubmit2>("vkQueueSubmit2")(queue, count, submits, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL waitForFences(VkDevice device, std::uint32_t count, const VkFence* fences, VkBool32 all,
                                             std::uint64_t timeout) {
    if (lost) return VK_ERROR_DEVICE_LOST;
    return next<PFN_vkWaitForFences>("vkWaitForFences")(device, count, fences, all, timeout);
}

/// The audit's arguments are an address and three words, the last the trips of its loops: more than any other kernel
/// has there.
VKAPI_ATTR void VKAPI_CALL cmdPushConstants(VkCommandBuffer commands, VkPipelineLayout layout,
                                            VkShaderStageFlags stages, std::uint32_t offset, std::uint32_t size,
                                            const void* values) {
    std::uint32_t words[32];
    std::memcpy(words, values, size);
    const std::uint64_t most = setting("VKPM_LAYER_TRIPS");
    if (most > 0 && size <= 24 && words[4] == 100'003) words[4] = static_cast<std::uint32_t>(most);
    next<PFN_vkCmdPushConstants>("vkCmdPushConstants")(commands, layout, stages, offset, size, words);
}

PFN_vkVoidFunction VKAPI_CALL deviceProc(VkDevice device, const char* name);
PFN_vkVoidFunction VKAPI_CALL instanceProc(VkInstance instance, const char* name);

/// The layer's own function of a name, or null.
PFN_vkVoidFunction own(std::string_view name) {
    const auto is = [&](const char* what, auto function) {
        return name == what ? reinterpret_cast<PFN_vkVoidFunction>(function) : nullptr;
    };
    for (const auto function :
         {is("vkCreateInstance", createInstance), is("vkCreateDevice", createDevice),
          is("vkAllocateMemory", allocateMemory), is("vkFreeMemory", freeMemory), is("vkQueueSubmit2", queueSubmit2),
          is("vkWaitForFences", waitForFences), is("vkCmdPushConstants", cmdPushConstants),
          is("vkGetDeviceProcAddr", deviceProc), is("vkGetInstanceProcAddr", instanceProc)})
        if (function != nullptr) return function;
    return nullptr;
}

PFN_vkVoidFunction VKAPI_CALL deviceProc(VkDevice device, const char* name) {
    const PFN_vkVoidFunction function = own(name);
    return function != nullptr ? function : nextDeviceProc(device, name);
}

PFN_vkVoidFunction VKAPI_CALL instanceProc(VkInstance instance, const char* name) {
    const PFN_vkVoidFunction function = own(name);
    return function != nullptr ? function : nextInstanceProc(instance, name);
}

} // namespace

/// Where the loader begins.
extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* versions) {
    versions->loaderLayerInterfaceVersion = 2;
    versions->pfnGetInstanceProcAddr = instanceProc;
    versions->pfnGetDeviceProcAddr = deviceProc;
    versions->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
