/// Whether a refusal is one that a person can use: the file, the place in it, one line of readable text.
#pragma once
#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace vkpm {

/// The length of ":12:", ":12:34:", ": byte 12:" or ": /json/pointer:" at the start of a text; 0 if there is none.
inline std::size_t placeLength(std::string_view text) {
    if (text.starts_with(": /") || text.starts_with(": byte ")) {
        const std::size_t end = text.find(": ", 2);
        return end == std::string_view::npos ? 0 : end + 1;
    }
    std::size_t end = 0;
    for (int numbers = 0; numbers < 2 && end < text.size() && text[end] == ':'; numbers++) {
        const std::size_t digits = text.find_first_not_of("0123456789", end + 1);
        if (digits == std::string_view::npos || digits == end + 1) break;
        end = digits;
    }
    return end > 0 && text.substr(end).starts_with(": ") ? end + 1 : 0;
}

/// What is wrong with the message that refuses a file whose name begins with `prefix`; empty if nothing is.
inline std::string faultOfRefusal(const std::string& message, const std::string& prefix) {
    const auto fault = [&](const char* what) { return std::string(what) + ": " + message.substr(0, 500); };
    if (!message.starts_with(prefix)) return fault("the refusal does not begin with the file");
    std::size_t name = prefix.size();
    while (name < message.size() && message[name] != ':') name++;
    if (placeLength(std::string_view(message).substr(name)) == 0) return fault("the refusal has no place");
    if (message.find("; ", name) == std::string::npos) return fault("the refusal does not say what is allowed");
    if (message.size() > 2000) return fault("the refusal is long");
    if (std::ranges::any_of(message, [](unsigned char c) { return c < 32 || c == 127; }))
        return fault("the refusal has control characters");
    return "";
}

} // namespace vkpm
