/// A list of kernel runs that the device executes in order.
#pragma once
#include "gpu/buffer.h"
#include "gpu/kernel.h"
#include "shared_paths.h"

namespace vkpm {

/// Records runs; each waits for all before it. What is recorded is executed in parts, and adds its times to Gpu::times.
class Recording {
public:
    explicit Recording(Gpu& gpu);
    /// Waits for what was submitted, and forgets the rest.
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
    /// Writes a few elements, 64 KiB at most, from the first on.
    template <class T> void write(const Buffer<T>& buffer, std::span<const T> values) {
        update(buffer, values.data(), values.size_bytes());
    }
    /// Reads an element; `value` has it once submit() has returned.
    template <class T> void read(const Buffer<T>& buffer, std::uint64_t index, T& value) {
        fetch(buffer, index * sizeof(T), &value, sizeof(T));
    }
    /// Reads the first elements.
    template <class T, std::size_t N> void read(const Buffer<T>& buffer, std::span<T, N> values) {
        fetch(buffer, 0, values.data(), values.size_bytes());
    }

    /// Has the device begin with what was recorded, and goes on; waits only while earlier parts are under way. Throws
    /// Cancelled, before that, if Gpu::cancel says so.
    void flush();
    /// Waits for the parts that were submitted.
    void wait();
    /// Executes what was recorded and waits for all of it; the recording is empty afterwards. Throws as flush() does.
    void submit();

private:
    void begin();
    void dispatch(const RawKernel& kernel, std::uint64_t threads, const void* args, std::uint32_t bytes);
    void dispatchIndirect(const RawKernel& kernel, const RawBuffer& queues, std::uint64_t offset, const void* args,
                          std::uint32_t bytes);
    void update(const RawBuffer& buffer, const void* data, std::uint64_t bytes);
    void fetch(const RawBuffer& buffer, std::uint64_t offset, void* value, std::uint64_t bytes);

    struct Handles;
    std::unique_ptr<Handles> handles;
};

} // namespace vkpm
