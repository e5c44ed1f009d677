/// Which runs of passes may be added.
#include "render/pass_runs.h"

namespace vkpm {

const std::uint64_t siblings = 4;

bool joins(PassRange a, PassRange b) {
    if (a.end != b.begin) return false;
    const std::uint64_t child = b.end - b.begin;
    std::uint64_t node = 1;
    while (node < child) node *= siblings;
    const std::uint64_t before = a.end - a.begin;
    return node == child && b.begin % child == 0 && a.begin % (siblings * child) == 0 && before % child == 0 && before < siblings * child;
}

} // namespace vkpm
