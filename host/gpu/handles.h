/// The Vulkan handles behind Gpu; included by the sources of host/gpu alone.
#pragma once
#include "gpu/instance.h"
#include "gpu/kernel.h"
#include "shared_paths.h"
#include <deque>
#include <functional>

namespace vkpm {

struct Gpu::Handles {
    Instance instance;
    vk::raii::PhysicalDevice physical{nullptr};
    vk::raii::Device device{nullptr};
    vk::raii::Queue queue{nullptr};
    vk::raii::CommandPool commands{nullptr};
    vk::raii::QueryPool stamps{nullptr};
    std::uint32_t family = 0;
    float nanosecondsPerTick = 0;
    std::uint64_t tickMask = 0; // the bits that a timestamp has
    bool isProcessor = false;   // no GPU: the driver runs on the host
    bool mapsDeviceMemory =
        false; // the host can write device memory directly; VKPM_STAGING says that it cannot, for tests
    std::uint64_t freeBytes = 0;     // of device memory when the device was opened
    std::uint64_t maxAllocation = 0; // bytes in one piece
    vk::PhysicalDeviceMemoryProperties memory;
    DeviceInfo info;
    std::map<std::pair<const std::uint32_t*, std::string>, std::weak_ptr<const RawKernel::Handles>>
        kernels;                                                  // by SPIR-V and features
    std::deque<std::shared_ptr<const RawKernel::Handles>> recent; // kernels that are kept for renderers to come
    mutable std::vector<std::pair<vk::raii::CommandBuffer, std::shared_ptr<const void>>>
        inFlight; // submitted without waiting, and what they use

    ~Handles();

    /// A command buffer that can be recorded.
    vk::raii::CommandBuffer begin() const;
    /// Submits recorded commands, leaves them to run, and keeps what they use until they are done.
    void submit(vk::raii::CommandBuffer commands, std::shared_ptr<const void> used) const;
    /// Ends a recording, submits it, and waits until it, and all before, is done and the host sees what it wrote.
    void submitAndWait(const vk::raii::CommandBuffer& commands) const;
    /// Records commands, submits them and waits until they are done.
    void execute(const std::function<void(const vk::raii::CommandBuffer&)>& record) const;
};

} // namespace vkpm
