/// A list of kernel runs that the device executes in order.
#pragma once
#include "gpu/buffer.h"
#include "gpu/kernel.h"
#include "shared_paths.h"

namespace vkpm {

/// Records runs; each waits for all before it. submit() executes them and adds their times to Gpu::times.
class Recording {
public:
    explicit Recording(Gpu& gpu);
    ~Recording();

    /// Runs `threads` invocations (rounded up to whole groups; kernels check their own bound).
    template <class Args>
    void run(const Kernel<Args>& kernel, std::uint64_t threads, const std::type_identity_t<Args>& args) {
        dispatch(kernel, threads, &args, sizeof(Args));
    }
    /// Runs as many groups as element `index` of `queues` says when the device gets there.
    template <class Args>
    void run(const Kernel<Args>& kernel, const Buffer<Queue>& queues, uint index,
             const std::type_identity_t<Args>& args) {
        dispatchIndirect(kernel, queues, index * sizeof(Queue), &args, sizeof(Args));
    }
    /// Fills a buffer with zero bits.
    void clear(const RawBuffer& buffer);
    /// Executes what was recorded and waits for it; the recording is empty afterwards. Throws Cancelled, before that,
    /// if Gpu::cancel says so.
    void submit();

private:
    void dispatch(const RawKernel& kernel, std::uint64_t threads, const void* args, std::uint32_t bytes);
    void dispatchIndirect(const RawKernel& kernel, const RawBuffer& queues, std::uint64_t offset, const void* args,
                          std::uint32_t bytes);
    void begin();
    void addTimes();

    struct Handles;
    std::unique_ptr<Handles> handles;
};

} // namespace vkpm
