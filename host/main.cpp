/// vkpm on one screen: read the command line, load, render pass by pass, save.
#include "commands.h"
#include "options.h"
#include "output/interrupt.h"
#include "gpu/gpu.h"
#include "gpu/process_limits.h"
#include "scene/scene.h"
#include <cerrno>
#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

using namespace vkpm;

static int run(const Options& options) {
    switch (options.command) {
    case Command::Print: std::fputs(options.text.c_str(), stdout); return 0;
    case Command::Version: return showVersion(options);
    case Command::Devices: return showDevices(options);
    case Command::Bench: return bench(options);
    case Command::Plan: return plan(options);
    case Command::Compare: return compare(options);
    case Command::Merge: return merge(options);
    case Command::Render: return render(options);
    case Command::View: return view(options);
    }
    return 0;
}

int main(int count, char** arguments) {
    try {
        heedLimits();
        catchInterrupts();
        const int code = run(parseOptions(count, arguments));
        if (std::fflush(stdout) != 0 || std::ferror(stdout)) throw std::system_error(errno, std::generic_category(), "standard output: write");
        return code;
    } catch (const InputError& error) {
        std::fprintf(stderr, "vkpm: %s\n", error.what());
        return 2;
    } catch (const std::bad_alloc&) {
        std::fputs("vkpm: out of memory on this machine (not the device's); a smaller scene or image, or fewer photons need less\n", stderr);
        return 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "vkpm: %s\n", error.what());
        return 1;
    }
}
