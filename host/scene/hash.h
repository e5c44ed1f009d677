/// FNV-1a (Fowler, Noll & Vo 1991) of 64 bits, over bytes or over words.
#pragma once
#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <string_view>

namespace vkpm {

class Hash {
public:
    void add(std::uint32_t part) { value = (value ^ part) * 0x100000001b3u; }
    std::string text() const { return fmt::format("{:016x}", value); } // hexadecimal

private:
    std::uint64_t value = 0xcbf29ce484222325u;
};

/// 16 hexadecimal digits that differ if a text differs.
inline std::string hashText(std::string_view text) {
    Hash hash;
    for (const char c : text) hash.add(static_cast<unsigned char>(c));
    return hash.text();
}

} // namespace vkpm
