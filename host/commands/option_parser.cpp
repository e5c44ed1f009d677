/// One command's parser, by CLI11.
#include "commands/option_parser.h"
#include "error.h"
#include <CLI/CLI.hpp>
#include <algorithm>

namespace vkpm {

void refuse(const std::string& option, const std::string& found, const std::string& allowed) {
    throw InputError(fmt::format("{}: found \"{}\"; allowed: {}", option, found, allowed));
}

const char* const versionText = "vkpm " VKPM_VERSION "\n";

/// CLI11's help with a usage line of ours, and with single blank lines between its groups.
struct HelpFormatter : CLI::Formatter {
    explicit HelpFormatter(std::string line) : usage(std::move(line)) { column_width(33); }
    std::string make_usage(const CLI::App*, std::string) const override { return fmt::format("Usage: {}\n", usage); }
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
        std::string text = CLI::Formatter::make_help(app, std::move(name), mode);
        for (std::size_t i; (i = text.find("\n\n\n")) != text.npos;) text.erase(i, 1);
        return text;
    }
    std::string usage;
};

Parser::Parser(const std::string& description, const std::string& usage)
    : app(std::make_unique<CLI::App>(description)) {
    app->set_help_flag("-h,--help", "print this");
    app->set_version_flag("--version", VKPM_VERSION, "print version, commit and driver");
    app->allow_extras();
    app->formatter(std::make_shared<HelpFormatter>(usage));
}
Parser::~Parser() = default;

void Parser::footer(const std::string& text) { app->footer(text); }

void Parser::addText(const std::string& names, const std::string& type, const std::string& help, Take take) {
    options.emplace_back(app->add_option(names, help)->type_name(type)->group(heading), std::move(take));
}

void Parser::flag(const std::string& name, const std::string& help, bool& value) {
    app->add_flag(name, value, help)->group(heading)->disable_flag_override();
}

void Parser::files(const std::string& help, std::function<void(const std::vector<std::string>&)> take) {
    app->add_option("files", fileNames, help)->type_name("FILE");
    takeFiles = std::move(take);
}

/// CLI11's "--passes: 1 required N missing" and "quiet was given a disallowed flag override" in our words.
static std::string mismatch(const std::string& text) {
    if (text.find("flag override") != text.npos)
        return fmt::format("--{}: found a value; allowed: none", text.substr(0, text.find(' ')));
    const char* found = text.find("missing") != text.npos ? "no value" : "more than one value";
    return fmt::format("{}: found {}; allowed: one value", text.substr(0, text.find(':')), found);
}

std::string Parser::parse(std::span<const std::string> arguments) {
    try {
        app->parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::CallForHelp&) {
        return app->help();
    } catch (const CLI::CallForVersion&) {
        return versionText;
    } catch (const CLI::ArgumentMismatch& error) {
        throw InputError(mismatch(error.what()));
    } catch (const CLI::ParseError& error) {
        throw InputError(fmt::format("{}; see vkpm --help", error.what()));
    }
    refuseUnknown();
    for (const auto& [option, take] : options) {
        if (option->empty()) continue;
        const std::string value = option->results()[0];
        if (value.empty() || value.starts_with("--")) refuse(option->get_name(), value, "a value");
        take(value);
    }
    if (takeFiles) takeFiles(fileNames);
    return "";
}

void Parser::refuseUnknown() const {
    std::vector<std::string> unknown = app->remaining();
    if (unknown.empty()) return;
    const auto isOption = [](const std::string& word) { return word.starts_with('-') && word != "--"; };
    std::ranges::stable_partition(unknown, isOption);
    const std::string word = unknown[0].substr(0, unknown[0].find('='));
    if (!isOption(word)) throw InputError(fmt::format("found \"{}\", which belongs to no option", word));
    std::vector<std::string> known;
    for (const CLI::Option* option : app->get_options()) known.push_back(option->get_name());
    throw InputError(fmt::format("{}: unknown option{}; see vkpm --help", word, suggestion(word, known)));
}

} // namespace vkpm
