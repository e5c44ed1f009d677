/// The commands of the program; each returns its exit code.
#pragma once
#include "options.h"

namespace vkpm {

int render(const Options& options);
int view(const Options& options);
int plan(const Options& options);
int compare(const Options& options);
int merge(const Options& options);
int showDevices(const Options& options);
int bench(const Options& options);
int showVersion(const Options& options);

/// What vkpm was built from, as git says it; "unknown" without git.
extern const char* const commit;

} // namespace vkpm
