/// The tests of the driver audit and what they expect.
#include "gpu/audit.h"
#include "gpu/recording.h"
#include "shared_audit.h"
#include <cstring>
#include <fmt/format.h>

namespace vkpm {

const uint threads = 64;
const uint trips = 100'003; // stock Mesa 22.3 ends the loops of an invocation after 65,535 trips in all

// The sum that every invocation computes: the sum of i mod 7 over its trips.
static uint expectedSum(uint count) {
    const uint rest = count % 7;
    return count / 7 * 21 + rest * (rest - 1) / 2;
}

static AuditResult check(std::string what, const std::vector<uint>& found, const std::vector<uint>& expected) {
    for (std::size_t i = 0; i < expected.size(); i++)
        if (found[i] != expected[i])
            return {std::move(what), false, fmt::format("invocation {} computed {}, not {}", i, found[i], expected[i])};
    return {std::move(what), true, ""};
}

static std::vector<uint> runAudit(Gpu& gpu, uint test, uint count, uint threadsPerResult = 1) {
    const Kernel<AuditArgs> kernel(gpu, "audit"); // compiled once, as auditDriver has it
    const Buffer<uint> results(gpu, "audit", count);
    Recording recording(gpu);
    recording.clear(results);
    recording.run(kernel, std::uint64_t(count) * threadsPerResult, {results, count, test, trips});
    recording.submit();
    return results.download();
}

static std::vector<uint> filled(uint count, auto&& f) {
    std::vector<uint> values(count);
    for (uint i = 0; i < count; i++) values[i] = f(i);
    return values;
}

std::vector<AuditResult> auditDriver(Gpu& gpu) {
    const Kernel<AuditArgs> compiled(gpu, "audit");
    std::vector<AuditResult> results;
    const uint sum = expectedSum(trips);
    results.push_back(check("long loops run to their end", runAudit(gpu, AUDIT_LOOP, threads),
                            filled(threads, [&](uint i) { return sum + i; })));
    results.push_back(check("divergent loops run to their end", runAudit(gpu, AUDIT_DIVERGENT, threads),
                            filled(threads, [&](uint i) { return expectedSum(trips - 16 * i); })));
    results.push_back(
        check("barriers order shared memory", runAudit(gpu, AUDIT_SHARED, threads),
              filled(threads, [](uint i) { return (i / GROUP * GROUP + GROUP - 1 - i % GROUP) * 3 + 1; })));
    const uint groups = 65'535 + 3;
    results.push_back(check("dispatches of more than 65,535 groups reach every index",
                            runAudit(gpu, AUDIT_WIDE, groups, GROUP),
                            filled(groups, [](uint i) { return (i * GROUP + GROUP - 1) ^ 0x5bd1e995u; })));
    results.push_back(check("single precision keeps infinities and small numbers", runAudit(gpu, AUDIT_FLOAT, 4),
                            {0x7f800000u, 0xff800000u, 0x3f800000u, 0x00800000u}));
    return results;
}

void requireSoundDriver(Gpu& gpu) {
    std::string failures;
    for (const AuditResult& result : auditDriver(gpu))
        if (!result.passed) failures += fmt::format("\n  {}: {}", result.what, result.found);
    if (failures.empty()) return;
    throw GpuError(fmt::format(
        "the driver of {} ({}) computes wrongly, so its pictures would be wrong:{}\n"
        "install a newer one (on Debian 12: mesa-vulkan-drivers from bookworm-backports, as tools/setup does), "
        "or choose another with --device",
        gpu.info().name, gpu.info().driver, failures));
}

} // namespace vkpm
