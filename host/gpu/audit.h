/// The driver audit: small computations with known results, for faults that would make a picture silently wrong.
#pragma once
#include "gpu/gpu.h"

namespace vkpm {

struct AuditResult {
    std::string what; // was tested
    bool passed = false;
    std::string found; // if it failed: what came out
};

/// Runs all tests; takes some milliseconds once the driver's shader cache is warm.
std::vector<AuditResult> auditDriver(Gpu& gpu);

/// Throws GpuError with what failed and what to install, if anything failed.
void requireSoundDriver(Gpu& gpu);

} // namespace vkpm
