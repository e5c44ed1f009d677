/// The command line: a struct of options for each command.
#pragma once
#include "job/options.h"
#include <variant>
#include <vector>

namespace vkpm {

struct PrintOptions {
    std::string text; // the help, for stdout
};
struct VersionOptions {};
struct ViewOptions : RenderOptions {};
struct PlanOptions : RenderOptions {
    bool json = false;
};
struct CompareOptions {
    std::filesystem::path image;
    std::filesystem::path reference;
    bool json = false;
};
struct MergeOptions {
    std::filesystem::path output; // ends in .exr
    std::vector<std::filesystem::path> parts;
    bool isPart = false; // the result need not begin with pass 0
    std::string device;
};
struct DevicesOptions {
    bool json = false;
};
struct BenchOptions {
    std::filesystem::path scene; // to trace rays in; empty: one of its own
    bool features = false;       // what leaving out saves, for `scenes`
    std::vector<std::filesystem::path> scenes;
    std::string device;
    bool json = false;
};

using Options = std::variant<PrintOptions, VersionOptions, RenderOptions, ViewOptions, PlanOptions, CompareOptions,
                             MergeOptions, DevicesOptions, BenchOptions>;

/// Reads the command line; main's arguments, the program's name first. Throws InputError with the option, what was
/// found and what is allowed.
Options parseOptions(int count, const char* const* arguments);

} // namespace vkpm
