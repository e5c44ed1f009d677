/// getrlimit, and signals of crashes.
#include "gpu/process_limits.h"
#include <algorithm>
#include <csignal>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <sys/resource.h>
#include <unistd.h>

namespace vkpm {
namespace {

/// In bytes or seconds; RLIM_INFINITY if there is none.
rlim_t limitOf(__rlimit_resource resource) {
    rlimit limit{};
    return ::getrlimit(resource, &limit) == 0 ? limit.rlim_cur : RLIM_INFINITY;
}

std::uint64_t addressSpaceUsed() {
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::string crash; // the message, made before it is needed

void onCrash(int) {
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, crash.data(), crash.size());
    ::_exit(1);
}

} // namespace

std::string whyNotAllocated(std::uint64_t bytes, std::uint64_t used) {
    const rlim_t file = limitOf(RLIMIT_FSIZE), space = limitOf(RLIMIT_AS);
    if (file != RLIM_INFINITY && used + bytes > file)
        return fmt::format("the driver keeps all memory in one file, and this process may write {:.1f} MiB a file; "
                           "raise the limit (ulimit -f)",
                           double(file) / 1048576);
    if (space != RLIM_INFINITY && addressSpaceUsed() + bytes > space)
        return fmt::format("this process may use {:.1f} MiB of memory, and uses {:.1f}; raise the limit (ulimit -v)",
                           double(space) / 1048576, double(addressSpaceUsed()) / 1048576);
    return "";
}

void heedLimits() {
    for (const auto& [resource, option] :
         {std::pair(RLIMIT_AS, 'v'), std::pair(RLIMIT_DATA, 'd'), std::pair(RLIMIT_FSIZE, 'f')})
        if (const rlim_t limit = limitOf(resource); limit != RLIM_INFINITY)
            crash +=
                fmt::format("{}{:.1f} MiB (ulimit -{})", crash.empty() ? "" : " and ", double(limit) / 1048576, option);
    if (!crash.empty()) {
        crash = fmt::format(
            "vkpm: out of memory: the Vulkan driver crashed in a process that may use {}; raise the limit\n", crash);
        for (const int signal : {SIGSEGV, SIGBUS, SIGABRT}) std::signal(signal, onCrash);
    }
    rlimit seconds{};
    if (::getrlimit(RLIMIT_CPU, &seconds) == 0 && seconds.rlim_max != RLIM_INFINITY) {
        const rlim_t toSave = std::min(seconds.rlim_max / 2, std::max<rlim_t>(5, seconds.rlim_max / 10));
        seconds.rlim_cur = std::min(seconds.rlim_cur, seconds.rlim_max - toSave);
        ::setrlimit(RLIMIT_CPU, &seconds);
    }
}

} // namespace vkpm
