/// What a run of the tests takes of a set that is too large for each run.
#pragma once
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <string>
#include <string_view>

namespace vkpm {

/// Changes with each commit (tools/test), so that what is drawn by it has all of its set in time.
inline std::uint32_t drawSeed() {
    const char* seed = std::getenv("VKPM_DRAW_SEED");
    return seed ? std::uint32_t(std::stoul(seed)) : 1;
}

/// Whether more of a set is wanted than each run has time for (tools/test --all), and all of it (tools/test --nightly).
inline bool isThorough() { return std::getenv("VKPM_THOROUGH") != nullptr; }
inline bool isNightly() { return std::getenv("VKPM_NIGHTLY") != nullptr; }

/// Whether this run takes one of `of` tests, or sets of them, that take long and share a subject: each commit draws
/// one.
inline bool isDrawn(std::uint32_t index, std::uint32_t of = isThorough() ? 2 : 6) {
    return isNightly() || (drawSeed() + index) % of == 0;
}

/// A number of a subject, so that a commit does not draw of all subjects at once.
inline std::uint32_t subjectNumber(std::string_view subject) {
    return std::accumulate(subject.begin(), subject.end(), 0u);
}

/// Skips the running test unless it is drawn.
#define SKIP_UNLESS_DRAWN(index)                                                                                       \
    if (!isDrawn(index + subjectNumber(test_info_->test_suite_name())))                                                \
    GTEST_SKIP() << "drawn by every second commit (without --all every sixth); tools/test --nightly has all"

} // namespace vkpm
