/// What a file has and vkpm has not: told once for each kind, with the first place.
#pragma once
#include "scene/reader.h"
#include <fmt/format.h>

namespace vkpm {

class Losses {
public:
    /// `what` says in a sentence what there is and what becomes of it.
    void add(const Reader& where, std::string_view what) {
        for (auto& [known, first, more] : losses)
            if (known == what) return void(++more);
        losses.push_back({std::string{what}, where, 0});
    }

    void tell(std::vector<std::string>& warnings) const {
        for (const auto& [what, first, more] : losses)
            first.warn(warnings, more == 0 ? what : fmt::format("{} (and in {} more places)", what, more));
    }

private:
    struct Loss {
        std::string what;
        Reader first;
        std::size_t more;
    };
    std::vector<Loss> losses;
};

} // namespace vkpm
