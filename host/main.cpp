/// vkpm on one screen: read the command line, load, render pass by pass, save.
#include "commands/commands.h"
#include "error.h"
#include "gpu/process_limits.h"
#include "interrupt.h"
#include <cerrno>
#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

using namespace vkpm;

int main(int count, char** arguments) {
    try {
        heedLimits();
        catchInterrupts();
        const int code =
            std::visit([](const auto& options) { return execute(options); }, parseOptions(count, arguments));
        if (std::fflush(stdout) != 0 || std::ferror(stdout))
            throw std::system_error(errno, std::generic_category(), "standard output: write");
        return code;
    } catch (const InputError& error) {
        std::fprintf(stderr, "vkpm: %s\n", error.what());
        return 2;
    } catch (const std::bad_alloc&) {
        std::fputs("vkpm: out of memory on this machine (not the device's); a smaller scene or image, or fewer photons "
                   "need less\n",
                   stderr);
        return 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "vkpm: %s\n", error.what());
        return 1;
    }
}
