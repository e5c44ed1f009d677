/// A part of a recording: commands that are submitted together, and what comes home with them; included by the sources
/// of host/gpu alone.
#pragma once
#include "gpu/host_memory.h"

namespace vkpm {

const std::uint32_t maxStamps = 8192;
const std::uint64_t mailboxBytes = 16384;

/// Parts are kept by their Gpu and used again.
struct RecordingPart {
    /// Bytes of the mailbox that are for the host.
    struct Letter {
        std::uint64_t offset;
        void* value;
        std::uint64_t bytes;
    };

    explicit RecordingPart(const Gpu& gpu);

    vk::raii::CommandBuffer commands{nullptr};
    vk::raii::Fence fence{nullptr};
    vk::raii::QueryPool stamps{nullptr}; // if kernels are timed
    HostMemory mailbox;                  // what comes home, filled by the last commands
    std::uint64_t used = 0;              // bytes of it
    std::vector<Letter> letters;
    std::vector<std::string> names; // of the runs between stamps i and i + 1
};

} // namespace vkpm
