/// The Vulkan handles behind Gpu; included by the sources of host/gpu alone.
#pragma once
#include "gpu/instance.h"
#include "gpu/kernel.h"
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
    bool mapsDeviceMemory = false; // the host can write device memory directly
    std::uint64_t freeBytes = 0; // of device memory when the device was opened
    DeviceInfo info;
    std::map<std::string, std::weak_ptr<const RawKernel::Handles>> kernels; // by name and features

    /// Submits recorded commands and waits until they are done.
    void submitAndWait(const vk::raii::CommandBuffer& commands) const;
    /// Records commands, submits them and waits until they are done.
    void execute(const std::function<void(const vk::raii::CommandBuffer&)>& record) const;
};

} // namespace vkpm
