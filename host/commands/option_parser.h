/// One command's parser.
#pragma once
#include "commands/option_values.h"
#include <fmt/format.h>
#include <memory>
#include <span>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace vkpm {

/// Throws InputError, "option: found; allowed".
[[noreturn]] void refuse(const std::string& option, const std::string& found, const std::string& allowed);

/// What `read` makes of an option's text; throws InputError if that is not allowed.
template <class Read> auto valueOf(const std::string& option, const std::string& text, const Read& read) {
    try {
        return read(text);
    } catch (const NotAllowed& refused) {
        refuse(option, text, refused.allowed);
    }
}

extern const char* const versionText;

/// One command's options. What their values mean is looked at after CLI11 has split the command line, so that --help
/// and unknown options come before wrong values.
class Parser {
public:
    Parser(const std::string& description, const std::string& usage);
    ~Parser();

    void group(const std::string& title) { heading = title; }
    void footer(const std::string& text);

    /// An option whose value `read` puts into the target; without one the text itself.
    template <class Target, class Read = std::identity>
    void add(const std::string& names, const std::string& type, const std::string& help, Target& target,
             Read read = {}) {
        const std::string name = names.substr(names.rfind("--"));
        addText(names, type, help, [&target, name, read](auto& text) { target = valueOf(name, text, read); });
    }
    /// One that takes a word of a list, and puts its place there into the target.
    template <class List, class Target>
    void words(const std::string& name, const List& list, const std::string& help, Target& target, uint usual) {
        add(name, fmt::format("{}", fmt::join(list, "|")), fmt::format("{} (default {})", help, list[usual]), target,
            wordsOf({list.begin(), list.end()}));
    }
    template <class Usual, class Target>
    void count(const std::string& name, const std::string& help, const Usual& usual, Target& target, uint low = 0,
               uint high = MAX_COUNT) {
        add(name, "N", fmt::format("{} (default {})", help, usual), target, countsFrom(low, high));
    }
    void flag(const std::string& name, const std::string& help, bool& value);
    /// Arguments without a name.
    void files(const std::string& help, std::function<void(const std::vector<std::string>&)> take);

    /// Splits the arguments, refuses unknown ones, then takes the values; the text to print for --help, --version.
    std::string parse(std::span<const std::string> arguments);

private:
    using Take = std::function<void(const std::string& value)>;
    void addText(const std::string& names, const std::string& type, const std::string& help, Take take);
    void refuseUnknown() const;

    std::unique_ptr<CLI::App> app;
    std::string heading = "Options";
    std::vector<std::pair<CLI::Option*, Take>> options;
    std::vector<std::string> fileNames;
    std::function<void(const std::vector<std::string>&)> takeFiles;
};

} // namespace vkpm
