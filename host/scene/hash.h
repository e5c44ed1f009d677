/// FNV-1a (Fowler, Noll & Vo 1991) of 64 bits, over bytes or over words.
#pragma once
#include <cstdint>
#include <fmt/format.h>
#include <string>

namespace vkpm {

class Hash {
public:
    void add(std::uint32_t part) { value = (value ^ part) * 0x100000001b3u; }
    std::string text() const { return fmt::format("{:016x}", value); } // hexadecimal

private:
    std::uint64_t value = 0xcbf29ce484222325u;
};

} // namespace vkpm
