/// The Vulkan handles behind a buffer; included by the sources of host/gpu alone.
#pragma once
#include "gpu/buffer.h"
#include "gpu/handles.h"

namespace vkpm {

struct RawBuffer::Handles {
    Gpu& gpu;
    std::string name;
    vk::raii::DeviceMemory memory;
    vk::raii::Buffer buffer; // destroyed before its memory
    void* mapped = nullptr;
    std::uint64_t bytes = 0;

    Handles(Gpu& owner, std::string label, vk::raii::DeviceMemory&& backing, vk::raii::Buffer&& handle, void* pointer,
            std::uint64_t size)
        : gpu(owner), name(std::move(label)), memory(std::move(backing)), buffer(std::move(handle)), mapped(pointer),
          bytes(size) {}
    ~Handles();
};

} // namespace vkpm
