/// Device memory: allocation, and copies to and from the host.
#include "gpu/buffer.h"
#include "gpu/buffer_handles.h"
#include "gpu/host_memory.h"
#include "gpu/process_limits.h"
#include <algorithm>
#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <functional>
#include <initializer_list>
#include <mutex>
#include <utility>
#include <vector>

namespace vkpm {

using Usage = vk::BufferUsageFlagBits;
using Property = vk::MemoryPropertyFlagBits;

static int findMemoryType(const vk::PhysicalDeviceMemoryProperties& memory, std::uint32_t allowed,
                          vk::MemoryPropertyFlags wanted) {
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; i++)
        if ((allowed >> i & 1) && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return static_cast<int>(i);
    return -1;
}

struct Allocation {
    vk::raii::Buffer buffer{nullptr};
    vk::raii::DeviceMemory memory{nullptr};
};

static std::uint64_t usedBytes(const Gpu& gpu) {
    std::uint64_t total = 0;
    for (const auto& [_, used] : gpu.memory) total += used;
    return total;
}

static std::string refusal(const Gpu& gpu, const std::string& name, std::uint64_t bytes, const std::string& cause) {
    return fmt::format("allocating {:.1f} MiB of device memory for '{}', beside {:.1f} MiB in use, failed: {}",
                       double(bytes) / 1048576, name, double(usedBytes(gpu)) / 1048576, cause);
}

/// Allocates memory of the first kind that the device has.
static Allocation allocate(const Gpu& gpu, const std::string& name, std::uint64_t bytes,
                           std::initializer_list<vk::MemoryPropertyFlags> kinds) {
    const auto& device = gpu.handles->device;
    if (usedBytes(gpu) + bytes > gpu.handles->freeBytes)
        throw OutOfMemory(refusal(
            gpu, name, bytes,
            fmt::format("{:.1f} MiB were free when the device was opened", double(gpu.handles->freeBytes) / 1048576)));
    if (const std::uint64_t most = gpu.handles->maxAllocation; bytes > most)
        throw OutOfMemory(refusal(
            gpu, name, bytes, fmt::format("the device gives {:.1f} MiB in one piece at most", double(most) / 1048576)));
    if (gpu.handles->isProcessor)
        if (const std::string cause = whyNotAllocated(bytes, usedBytes(gpu)); !cause.empty())
            throw GpuError(refusal(gpu, name, bytes, cause));
    Allocation result;
    try {
        result.buffer = vk::raii::Buffer(
            device, vk::BufferCreateInfo{.size = bytes,
                                         .usage = Usage::eStorageBuffer | Usage::eShaderDeviceAddress |
                                                  Usage::eIndirectBuffer | Usage::eTransferSrc | Usage::eTransferDst});
        const auto needs = result.buffer.getMemoryRequirements();
        int type = -1;
        for (const vk::MemoryPropertyFlags wanted : kinds)
            if (type < 0) type = findMemoryType(gpu.handles->memory, needs.memoryTypeBits, wanted);
        if (type < 0) throw GpuError(fmt::format("no memory type of the device fits buffer '{}'", name));
        const vk::MemoryAllocateFlagsInfo flags{.flags = vk::MemoryAllocateFlagBits::eDeviceAddress};
        result.memory =
            vk::raii::DeviceMemory(device, vk::MemoryAllocateInfo{.pNext = &flags,
                                                                  .allocationSize = needs.size,
                                                                  .memoryTypeIndex = static_cast<std::uint32_t>(type)});
        result.buffer.bindMemory(*result.memory, 0);
    } catch (const vk::SystemError& error) {
        throw OutOfMemory(refusal(gpu, name, bytes, error.what()));
    }
    return result;
}

RawBuffer::RawBuffer() noexcept = default;

RawBuffer::RawBuffer(Gpu& gpu, std::string name, std::uint64_t size, std::uint64_t slack) : bytes(size) {
    if (bytes == 0) return;
    const bool maps = gpu.handles->mapsDeviceMemory;
    const auto wanted =
        maps ? Property::eHostVisible | Property::eHostCoherent : vk::MemoryPropertyFlags(Property::eDeviceLocal);
    Allocation allocation = allocate(gpu, name, bytes + slack, {wanted});
    handles = std::make_unique<Handles>(gpu, std::move(name), std::move(allocation.memory),
                                        std::move(allocation.buffer), nullptr, bytes);
    address = gpu.handles->device.getBufferAddress({.buffer = *handles->buffer});
    if (maps)
        handles->mapped = attempt("mapping device memory for '" + handles->name + "'", "",
                                  [&] { return handles->memory.mapMemory(0, VK_WHOLE_SIZE); });
    gpu.memory[handles->name] += bytes;
    gpu.peakBytes = std::max(gpu.peakBytes, usedBytes(gpu));
}

RawBuffer::Handles::~Handles() { gpu.memory[name] -= bytes; }

RawBuffer::RawBuffer(RawBuffer&& other) noexcept { *this = std::move(other); }

RawBuffer& RawBuffer::operator=(RawBuffer&& other) noexcept {
    handles = std::move(other.handles);
    address = std::exchange(other.address, 0);
    bytes = std::exchange(other.bytes, 0);
    return *this;
}

RawBuffer::~RawBuffer() = default;

HostMemory::HostMemory(const Gpu& gpu, const std::string& name, std::uint64_t size) : bytes(size) {
    const vk::MemoryPropertyFlags visible = Property::eHostVisible | Property::eHostCoherent;
    Allocation allocation = allocate(gpu, name, bytes, {visible | Property::eHostCached, visible});
    memory = std::move(allocation.memory);
    buffer = std::move(allocation.buffer);
    mapped = static_cast<char*>(
        attempt("mapping memory for '" + name + "'", "", [&] { return memory.mapMemory(0, VK_WHOLE_SIZE); }));
}

const std::uint64_t stagingBytes = 16u << 20;

// Copies between the buffer and the host in pieces of the staging memory, which `use` fills or reads, one submission
// for each; one thread at a time. A wait for the device takes a GPU longer than a row, so there is none for each of
// these.
static void stage(const RawBuffer::Handles& handles, const Rows& rows, bool toDevice,
                  const std::function<void(char* staged, std::uint64_t done, std::uint64_t size)>& use) {
    static std::mutex one;
    const std::lock_guard lock(one);
    Gpu& gpu = handles.gpu;
    const std::uint64_t bytes = rows.count * rows.bytes;
    if (!gpu.handles->staging || gpu.handles->staging->bytes < std::min(bytes, stagingBytes))
        gpu.handles->staging = std::make_unique<HostMemory>(
            gpu, "staging", std::min(std::max<std::uint64_t>(std::bit_ceil(bytes), 1u << 16), stagingBytes));
    const HostMemory& staging = *gpu.handles->staging;
    const vk::raii::Fence fence(gpu.handles->device, vk::FenceCreateInfo{});
    for (std::uint64_t done = 0; done < bytes; done += staging.bytes) {
        const std::uint64_t size = std::min(staging.bytes, bytes - done);
        std::vector<vk::BufferCopy> copies;
        for (std::uint64_t at = done; at < done + size; at += copies.back().size) {
            const std::uint64_t inRow = at % rows.bytes, inBuffer = rows.offset + at / rows.bytes * rows.stride + inRow;
            copies.push_back({.srcOffset = toDevice ? at - done : inBuffer,
                              .dstOffset = toDevice ? inBuffer : at - done,
                              .size = std::min(rows.bytes - inRow, done + size - at)});
        }
        if (toDevice) use(staging.mapped, done, size);
        const vk::raii::CommandBuffer commands = gpu.handles->begin();
        if (toDevice) commands.copyBuffer(*staging.buffer, *handles.buffer, copies);
        else commands.copyBuffer(*handles.buffer, *staging.buffer, copies);
        const vk::MemoryBarrier2 after{
            .srcStageMask = vk::PipelineStageFlagBits2::eAllCommands,
            .srcAccessMask = vk::AccessFlagBits2::eMemoryWrite,
            .dstStageMask = vk::PipelineStageFlagBits2::eHost | vk::PipelineStageFlagBits2::eAllCommands,
            .dstAccessMask =
                vk::AccessFlagBits2::eHostRead | vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite};
        commands.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &after});
        commands.end();
        gpu.handles->submit(commands, *fence);
        gpu.waits += gpu.handles->wait(fence);
        gpu.handles->device.resetFences(*fence);
        gpu.times["staging"].dispatches++;
        if (!toDevice) use(staging.mapped, done, size);
    }
}

void RawBuffer::write(const void* data, const Rows& rows) {
    if (rows.count * rows.bytes == 0) return;
    const char* from = static_cast<const char*>(data);
    if (handles->mapped)
        for (std::uint64_t row = 0; row < rows.count; row++)
            std::memcpy(static_cast<char*>(handles->mapped) + rows.offset + row * rows.stride, from + row * rows.bytes,
                        rows.bytes);
    else
        stage(*handles, rows, true,
              [&](char* staged, std::uint64_t done, std::uint64_t part) { std::memcpy(staged, from + done, part); });
}

void RawBuffer::read(void* data, const Rows& rows) const {
    if (rows.count * rows.bytes == 0) return;
    char* to = static_cast<char*>(data);
    if (handles->mapped)
        for (std::uint64_t row = 0; row < rows.count; row++)
            std::memcpy(to + row * rows.bytes,
                        static_cast<const char*>(handles->mapped) + rows.offset + row * rows.stride, rows.bytes);
    else
        stage(*handles, rows, false, [&](const char* staged, std::uint64_t done, std::uint64_t part) {
            std::memcpy(to + done, staged, part);
        });
}

} // namespace vkpm
