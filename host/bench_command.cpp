#include "commands.h"
namespace vkpm { int bench(const Options&) { return 0; } }
