/// vkpm --help.
#include "commands/commands.h"
#include <cstdio>

namespace vkpm {

int execute(const PrintOptions& options) {
    std::fputs(options.text.c_str(), stdout);
    return 0;
}

} // namespace vkpm
