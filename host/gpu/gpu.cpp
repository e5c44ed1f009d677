/// Choice of a device, and its one compute queue.
#include "gpu/handles.h"
#include "gpu/recording_part.h"
#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>

namespace vkpm {

/// A queue family that computes; better one that does not draw, since what draws the desktop has to share that. -1 if
/// there is none.
static int computeFamily(const vk::raii::PhysicalDevice& device) {
    const auto families = device.getQueueFamilyProperties();
    int found = -1;
    for (int i = 0; i < static_cast<int>(families.size()); i++) {
        const vk::QueueFlags flags = families[static_cast<std::size_t>(i)].queueFlags;
        if (!(flags & vk::QueueFlagBits::eCompute)) continue;
        if (!(flags & vk::QueueFlagBits::eGraphics)) return i;
        if (found < 0) found = i;
    }
    return found;
}

static std::vector<std::string> findLacks(const vk::raii::PhysicalDevice& device) {
    std::vector<std::string> missing;
    if (device.getProperties().apiVersion < VK_API_VERSION_1_3) return {"Vulkan 1.3"};
    const auto features = device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                                              vk::PhysicalDeviceVulkan13Features>();
    const auto& v12 = features.get<vk::PhysicalDeviceVulkan12Features>();
    const auto& v13 = features.get<vk::PhysicalDeviceVulkan13Features>();
    const auto limits = device.getProperties().limits;
    const auto need = [&](bool has, const char* what) {
        if (!has) missing.push_back(what);
    };
    need(v12.bufferDeviceAddress, "bufferDeviceAddress");
    need(v12.scalarBlockLayout, "scalarBlockLayout");
    need(v13.synchronization2, "synchronization2");
    need(v13.maintenance4, "maintenance4");
    need(limits.maxPushConstantsSize >= 128, "128 bytes of push constants");
    need(limits.maxComputeSharedMemorySize >= 16384, "16 KiB of shared memory");
    const auto subgroup = device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties>()
                              .get<vk::PhysicalDeviceVulkan11Properties>();
    need(bool(subgroup.subgroupSupportedOperations & vk::SubgroupFeatureFlagBits::eArithmetic), "subgroup arithmetic");
    need(limits.maxComputeWorkGroupInvocations >= 64, "64 invocations in a work group");
    need(computeFamily(device) >= 0, "a compute queue");
    return missing;
}

static DeviceInfo describe(const vk::raii::PhysicalDevice& device) {
    DeviceInfo info{.missingRequirements = findLacks(device)};
    const auto properties = device.getProperties();
    info.name = std::string(properties.deviceName.data());
    info.apiVersion =
        fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(properties.apiVersion),
                    VK_API_VERSION_MINOR(properties.apiVersion), VK_API_VERSION_PATCH(properties.apiVersion));
    if (properties.apiVersion >= VK_API_VERSION_1_2) {
        const auto chain = device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties,
                                                 vk::PhysicalDeviceVulkan12Properties>();
        const auto& v12 = chain.get<vk::PhysicalDeviceVulkan12Properties>();
        info.driver = fmt::format("{} {}", v12.driverName.data(), v12.driverInfo.data());
        info.subgroupSize = chain.get<vk::PhysicalDeviceVulkan11Properties>().subgroupSize;
    }
    const auto memory = device.getMemoryProperties();
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; i++)
        if (memory.memoryHeaps[i].flags & vk::MemoryHeapFlagBits::eDeviceLocal)
            info.memoryBytes = std::max<std::uint64_t>(info.memoryBytes, memory.memoryHeaps[i].size);
    return info;
}

static std::string describeAll(const std::vector<vk::raii::PhysicalDevice>& devices) {
    std::string text;
    for (std::size_t i = 0; i < devices.size(); i++) {
        const DeviceInfo info = describe(devices[i]);
        text += fmt::format("\n  {}: {}{}", i, info.name,
                            info.missingRequirements.empty()
                                ? ""
                                : fmt::format(" (lacks {})", fmt::join(info.missingRequirements, ", ")));
    }
    return text;
}

// The device asked for; else the first complete one of the fastest type.
static std::size_t chooseDevice(const std::vector<vk::raii::PhysicalDevice>& devices, std::string_view wanted) {
    if (devices.empty())
        throw GpuError(fmt::format("vkEnumeratePhysicalDevices found no Vulkan device; {}", installHint));
    const auto rank = [&](std::size_t i) {
        const auto type = devices[i].getProperties().deviceType;
        if (!findLacks(devices[i]).empty()) return 4;
        if (type == vk::PhysicalDeviceType::eDiscreteGpu) return 0;
        if (type == vk::PhysicalDeviceType::eIntegratedGpu) return 1;
        return type == vk::PhysicalDeviceType::eCpu ? 3 : 2;
    };
    std::size_t chosen = 0;
    for (std::size_t i = 1; i < devices.size(); i++)
        if (rank(i) < rank(chosen)) chosen = i;
    if (!wanted.empty()) {
        chosen = devices.size();
        for (std::size_t i = devices.size(); i-- > 0;) {
            const bool named =
                std::string_view(devices[i].getProperties().deviceName.data()).find(wanted) != std::string_view::npos;
            if (named || wanted == std::to_string(i)) chosen = i;
        }
    }
    if (chosen == devices.size())
        throw GpuError(fmt::format("no Vulkan device is '{}'; there are:{}", wanted, describeAll(devices)));
    if (rank(chosen) == 4)
        throw GpuError(fmt::format("the Vulkan device lacks what vkpm needs; there are:{}\n{}", describeAll(devices),
                                   installHint));
    return chosen;
}

static bool hasExtension(const vk::raii::PhysicalDevice& device, std::string_view name) {
    const auto extensions = device.enumerateDeviceExtensionProperties();
    return std::ranges::any_of(extensions,
                               [&](const auto& extension) { return name == extension.extensionName.data(); });
}

static vk::raii::Device createDevice(const vk::raii::PhysicalDevice& physical, std::uint32_t family) {
    const float priority = 1;
    const vk::DeviceQueueCreateInfo queue{.queueFamilyIndex = family, .queueCount = 1, .pQueuePriorities = &priority};
    vk::PhysicalDeviceVulkan13Features v13{.synchronization2 = true, .maintenance4 = true};
    vk::PhysicalDeviceVulkan12Features v12{
        .pNext = &v13, .scalarBlockLayout = true, .hostQueryReset = true, .bufferDeviceAddress = true};
    const vk::PhysicalDeviceFeatures2 features{.pNext = &v12};
    vk::DeviceCreateInfo create{.pNext = &features, .queueCreateInfoCount = 1, .pQueueCreateInfos = &queue};
    const std::array portability{"VK_KHR_portability_subset"}; // a device that offers it wants it
    if (hasExtension(physical, portability[0])) create.setPEnabledExtensionNames(portability);
    return attempt("vkCreateDevice", installHint, [&] { return vk::raii::Device(physical, create); });
}

// Bytes of the largest device-local heap that nobody uses yet, as far as the driver tells. Drivers for the processor
// grant any allocation; memory that is not there would end the program when it is first written to.
static std::uint64_t freeBytes(const vk::raii::PhysicalDevice& device) {
    const bool tells = hasExtension(device, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
    const auto memory = device.getMemoryProperties();
    vk::PhysicalDeviceMemoryBudgetPropertiesEXT budget;
    if (tells)
        budget = device
                     .getMemoryProperties2<vk::PhysicalDeviceMemoryProperties2,
                                           vk::PhysicalDeviceMemoryBudgetPropertiesEXT>()
                     .get<vk::PhysicalDeviceMemoryBudgetPropertiesEXT>();
    std::uint64_t most = 0;
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; i++) {
        if (!(memory.memoryHeaps[i].flags & vk::MemoryHeapFlagBits::eDeviceLocal)) continue;
        const std::uint64_t granted = tells ? budget.heapBudget[i] : memory.memoryHeaps[i].size;
        const std::uint64_t used = tells ? budget.heapUsage[i] : 0;
        most = std::max(most, granted - std::min(granted, used));
    }
    return most;
}

static std::unique_ptr<Gpu::Handles> open(std::string_view wanted) {
    auto vk = std::make_unique<Gpu::Handles>();
    auto devices = attempt("vkEnumeratePhysicalDevices", installHint,
                           [&] { return vk->instance.handle.enumeratePhysicalDevices(); });
    vk->physical = std::move(devices[chooseDevice(devices, wanted)]);
    vk->info = describe(vk->physical);
    vk->family = static_cast<std::uint32_t>(computeFamily(vk->physical));
    vk->device = createDevice(vk->physical, vk->family);
    vk->queue = vk->device.getQueue(vk->family, 0);
    vk->commands = vk->device.createCommandPool(
        {.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer, .queueFamilyIndex = vk->family});
    const auto properties = vk->physical.getProperties();
    if (const std::uint32_t bits = vk->physical.getQueueFamilyProperties()[vk->family].timestampValidBits; bits > 0) {
        vk->nanosecondsPerTick = properties.limits.timestampPeriod;
        vk->tickMask = bits < 64 ? (std::uint64_t{1} << bits) - 1 : ~std::uint64_t{0};
    }
    vk->freeBytes = freeBytes(vk->physical);
    vk->maxAllocation =
        vk->physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceMaintenance3Properties>()
            .get<vk::PhysicalDeviceMaintenance3Properties>()
            .maxMemoryAllocationSize;
    vk->memory = vk->physical.getMemoryProperties();
    vk->isProcessor = properties.deviceType == vk::PhysicalDeviceType::eCpu;
    vk->mapsDeviceMemory =
        properties.deviceType != vk::PhysicalDeviceType::eDiscreteGpu && !std::getenv("VKPM_STAGING");
    return vk;
}

Gpu::Handles::~Handles() {
    if (!warmingUp.empty()) settle();
}

void Gpu::Handles::settle() const noexcept {
    try {
        device.waitIdle();
    } catch (const std::exception&) { // a device that says that it is lost runs nothing
    }
}

vk::raii::CommandBuffer Gpu::Handles::begin() const {
    auto buffers = device.allocateCommandBuffers(
        {.commandPool = *commands, .level = vk::CommandBufferLevel::ePrimary, .commandBufferCount = 1});
    buffers[0].begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    return std::move(buffers[0]);
}

static const char* const running = "running commands on the device";
static const char* const runningHint = "another program may have hung or reset it";

void Gpu::Handles::submit(const vk::raii::CommandBuffer& recorded, vk::Fence fence) const {
    const vk::CommandBufferSubmitInfo commandInfo{.commandBuffer = *recorded};
    attempt(running, runningHint, [&] {
        queue.submit2(vk::SubmitInfo2{.commandBufferInfoCount = 1, .pCommandBufferInfos = &commandInfo}, fence);
    });
}

bool Gpu::Handles::wait(const vk::raii::Fence& fence) {
    const bool waits = attempt(running, runningHint, [&] {
        if (fence.getStatus() == vk::Result::eSuccess) return false;
        const vk::Result result = device.waitForFences(*fence, true, UINT64_MAX);
        if (result != vk::Result::eSuccess) throw GpuError("vkWaitForFences returned " + vk::to_string(result));
        return true;
    });
    warmingUp.clear(); // they were before
    return waits;
}

Gpu::Gpu(std::string_view wanted) : handles(open(wanted)) {}
Gpu::~Gpu() = default;

const DeviceInfo& Gpu::info() const { return handles->info; }

std::vector<DeviceInfo> listDevices() {
    const Instance instance;
    std::vector<DeviceInfo> infos;
    for (const auto& device :
         attempt("vkEnumeratePhysicalDevices", installHint, [&] { return instance.handle.enumeratePhysicalDevices(); }))
        infos.push_back(describe(device));
    return infos;
}

DeviceInfo defaultDevice() {
    const Instance instance;
    const auto devices =
        attempt("vkEnumeratePhysicalDevices", installHint, [&] { return instance.handle.enumeratePhysicalDevices(); });
    return describe(devices[chooseDevice(devices, {})]);
}

} // namespace vkpm
