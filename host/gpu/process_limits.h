/// Limits that a shell or a batch system sets on the process, and that drivers for the processor do not heed.
#pragma once
#include <cstdint>
#include <string>

namespace vkpm {

/// Why a driver for the processor cannot be asked for so many bytes of device memory beside those in use, all of which
/// it maps from a file; empty if nothing is against it. Such drivers take it for granted that they get what they ask
/// the system for, and crash.
std::string whyNotAllocated(std::uint64_t bytes, std::uint64_t used);

/// From now on a crash for want of memory says which limit it ran into, and is an exit with code 1; without such limits
/// nothing changes. Before a limit on processor time kills, SIGXCPU says so when there is time left to save: a tenth, 5
/// seconds at least.
void heedLimits();

} // namespace vkpm
