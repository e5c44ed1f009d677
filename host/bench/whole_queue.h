/// What lets a kernel that works on a queue work on everything.
#pragma once
#include "gpu/buffer.h"
#include "shared_paths.h"
#include <numeric>

namespace vkpm {

/// A queue of all elements of a list that is 0, 1, 2 ...
struct WholeQueue {
    WholeQueue(Gpu& gpu, std::size_t count) : queue(gpu, "bench queue", 1), list(gpu, "bench list", count) {
        const Queue whole{.count = static_cast<uint>(count)};
        queue.upload(std::span(&whole, 1));
        std::vector<uint> identity(count);
        std::iota(identity.begin(), identity.end(), 0);
        list.upload(identity);
    }
    Buffer<Queue> queue;
    Buffer<uint> list;
};

} // namespace vkpm
