/// The Vulkan handles behind Gpu; included by the sources of host/gpu alone.
#pragma once
#include "gpu/instance.h"
#include "gpu/kernel.h"
#include "shared_paths.h"
#include <deque>

namespace vkpm {

struct HostMemory;
struct RecordingPart;

struct Gpu::Handles {
    Instance instance;
    vk::raii::PhysicalDevice physical{nullptr};
    vk::raii::Device device{nullptr};
    vk::raii::Queue queue{nullptr};
    vk::raii::CommandPool commands{nullptr};
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
    struct ToWarmUp {
        std::shared_ptr<const RawKernel::Handles> kernel;
        std::uint32_t argsBytes;
    };
    std::vector<ToWarmUp> toWarmUp; // when they are created
    std::vector<std::pair<vk::raii::CommandBuffer, std::shared_ptr<const void>>>
        warmingUp;                                         // submitted without waiting, and what they use
    std::vector<std::unique_ptr<RecordingPart>> idleParts; // for recordings to come
    std::unique_ptr<HostMemory> staging;                   // once something is copied by way of the host's memory

    ~Handles();

    /// A command buffer that can be recorded.
    vk::raii::CommandBuffer begin() const;
    /// Submits commands whose recording has ended; the fence, if there is one, tells when they are done.
    void submit(const vk::raii::CommandBuffer& commands, vk::Fence fence) const;
    /// Waits for all that was submitted, before what it uses is freed; of a device that is lost, too, for it may still
    /// be at work.
    void settle() const noexcept;
    /// Waits for the fence of what was submitted; false if that was done already.
    bool wait(const vk::raii::Fence& fence);
};

} // namespace vkpm
