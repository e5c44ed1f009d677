/// The driver audit passes on this machine, and says so when a driver computes wrongly.
#include "gpu/audit.h"
#include "gpu/spirv.h"
#include "map.h"
#include <gmock/gmock.h>

namespace vkpm {
namespace {

TEST(Audit, ThisDriverIsSound) {
    const auto results = auditDriver(testGpu());
    EXPECT_GE(results.size(), 5u);
    for (const AuditResult& result : results) EXPECT_TRUE(result.passed) << result.what << ": " << result.found;
    EXPECT_NO_THROW(requireSoundDriver(testGpu()));
}

// Puts a kernel that computes nothing in the audit's place.
class BrokenAudit {
public:
    BrokenAudit() : sound(findSpirv("audit")) { SpirvRegistration({{"audit", findSpirv("broken_audit")}}); }
    ~BrokenAudit() { SpirvRegistration({{"audit", sound}}); }

private:
    std::span<const std::uint32_t> sound;
};

TEST(Audit, EveryTestNoticesWrongResults) {
    const BrokenAudit broken;
    for (const AuditResult& result : auditDriver(testGpu())) {
        EXPECT_FALSE(result.passed) << result.what;
        EXPECT_THAT(result.found, testing::HasSubstr("computed 1, not ")) << result.what;
    }
    try {
        requireSoundDriver(testGpu());
        FAIL() << "a broken driver passed";
    } catch (const GpuError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr(testGpu().info().name));
        EXPECT_THAT(error.what(), testing::HasSubstr("long loops run to their end: invocation 0 computed 1"));
    }
}

} // namespace
} // namespace vkpm
