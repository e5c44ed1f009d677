/// Typed arrays in device memory.
#pragma once
#include "gpu/gpu.h"
#include "shared.h"
#include <span>

namespace vkpm {

/// Rows of bytes in a buffer, `stride` apart from `offset` on; on the host one follows the other.
struct Rows {
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0; // of one
    std::uint64_t count = 1;
    std::uint64_t stride = 0;
};

/// Bytes in device memory, under a name that statistics and error messages show.
class RawBuffer {
public:
    RawBuffer() noexcept;
    RawBuffer(Gpu& gpu, std::string name, std::uint64_t bytes, std::uint64_t slack = 0);
    RawBuffer(RawBuffer&&) noexcept;
    RawBuffer& operator=(RawBuffer&&) noexcept;
    ~RawBuffer();

    void write(const void* data, const Rows& rows);
    void read(void* data, const Rows& rows) const;

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
        write(data.data(), {.offset = first * sizeof(T), .bytes = data.size_bytes()});
    }
    /// Uploads rows of `length` elements, the first of them to `first`, each `stride` elements after the one before.
    void uploadRows(std::span<const T> data, std::uint64_t length, std::uint64_t stride, std::uint64_t first) {
        write(data.data(), rows(length, stride, first, data.size() / length));
    }
    T readElement(std::uint64_t index = 0) const {
        T value;
        read(&value, {.offset = index * sizeof(T), .bytes = sizeof(T)});
        return value;
    }
    std::vector<T> download(std::uint64_t count, std::uint64_t first = 0) const {
        std::vector<T> data(count);
        read(data.data(), {.offset = first * sizeof(T), .bytes = count * sizeof(T)});
        return data;
    }
    /// Downloads such rows.
    void downloadRows(std::span<T> data, std::uint64_t length, std::uint64_t stride, std::uint64_t first) const {
        read(data.data(), rows(length, stride, first, data.size() / length));
    }
    std::vector<T> download() const { return download(size()); }

private:
    static Rows rows(std::uint64_t length, std::uint64_t stride, std::uint64_t first, std::uint64_t count) {
        return {first * sizeof(T), length * sizeof(T), count, stride * sizeof(T)};
    }
};

} // namespace vkpm
