/// The commands of the program; each returns its exit code.
#pragma once
#include "commands/options.h"

namespace vkpm {

int execute(const PrintOptions& options);
int execute(const VersionOptions& options);
int execute(const RenderOptions& options);
int execute(const ViewOptions& options);
int execute(const PlanOptions& options);
int execute(const CompareOptions& options);
int execute(const MergeOptions& options);
int execute(const DevicesOptions& options);
int execute(const BenchOptions& options);

/// What vkpm was built from, as git says it; "unknown" without git.
extern const char* const commit;

} // namespace vkpm
