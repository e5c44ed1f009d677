/// Typed arrays in device memory.
#pragma once
#include "gpu/gpu.h"
#include "shared.h"
#include <span>

namespace vkpm {

/// Bytes in device memory, under a name that statistics and error messages show.
class RawBuffer {
public:
    RawBuffer() noexcept;
    RawBuffer(Gpu& gpu, std::string name, std::uint64_t bytes, std::uint64_t slack = 0);
    RawBuffer(RawBuffer&&) noexcept;
    RawBuffer& operator=(RawBuffer&&) noexcept;
    ~RawBuffer();

    void write(const void* data, std::uint64_t bytes, std::uint64_t offset = 0);
    void read(void* data, std::uint64_t bytes, std::uint64_t offset = 0) const;

    struct Handles;
    std::unique_ptr<Handles> handles;
    std::uint64_t address = 0;
    std::uint64_t bytes = 0;
};

/// `count` elements of T in device memory; zero elements occupy nothing and have address 0. The slack behind the last
/// one is for the validation layer, whose bounds check (1.3.239) measures structs with vec3 as if these were aligned to
/// 16 bytes.
template <class T> class Buffer : public RawBuffer {
public:
    Buffer() = default;
    Buffer(Gpu& gpu, std::string name, std::uint64_t count)
        : RawBuffer(gpu, std::move(name), count * sizeof(T), sizeof(T) < 12 ? 0 : sizeof(T) + 16) {}
    Buffer(Gpu& gpu, std::string name, std::span<const T> data) : Buffer(gpu, std::move(name), data.size()) {
        upload(data);
    }

    std::uint64_t size() const { return bytes / sizeof(T); }
    operator Ptr<T>() const { return {address}; }

    void upload(std::span<const T> data, std::uint64_t first = 0) {
        write(data.data(), data.size_bytes(), first * sizeof(T));
    }
    T readElement(std::uint64_t index = 0) const {
        T value;
        read(&value, sizeof(T), index * sizeof(T));
        return value;
    }
    std::vector<T> download(std::uint64_t count, std::uint64_t first = 0) const {
        std::vector<T> data(count);
        read(data.data(), count * sizeof(T), first * sizeof(T));
        return data;
    }
    /// Downloads to the end of a vector.
    void append(std::vector<T>& data, std::uint64_t count, std::uint64_t first) const {
        data.resize(data.size() + count);
        read(data.data() + data.size() - count, count * sizeof(T), first * sizeof(T));
    }
    std::vector<T> download() const { return download(size()); }
};

} // namespace vkpm
