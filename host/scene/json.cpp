/// Parsing of JSON text with the place of every mistake, refusing what nlohmann's tree would silently accept.
#include "scene/reader.h"
#include "scene/text.h"
#include <algorithm>
#include <fmt/format.h>

namespace vkpm {
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t deepest = 64; // levels of nesting; a scene has 6

/// Builds the tree from the parser's events.
class TreeBuilder : public nlohmann::json_sax<json> {
public:
    json root;

    TreeBuilder(const fs::path& path, const std::string& whole) : file{path}, text{whole} {}

    bool null() override { return put(nullptr); }
    bool boolean(bool value) override { return put(value); }
    bool number_integer(number_integer_t value) override { return put(value); }
    bool number_unsigned(number_unsigned_t value) override { return put(value); }
    bool number_float(number_float_t value, const string_t&) override { return put(value); }
    bool string(string_t& value) override { return put(value); }
    bool binary(binary_t&) override { return false; }

    bool start_object(std::size_t) override { return open(json::object()); }
    bool start_array(std::size_t) override { return open(json::array()); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }

    bool key(string_t& name) override {
        keys.back() = name;
        if (containers.back()->contains(name)) fail("this key is given twice", "give it once");
        return true;
    }

    bool parse_error(std::size_t position, const std::string&, const json::exception& error) override {
        // nlohmann names itself and the place before the message; the place is given anew, counted from the text.
        std::string message = error.what();
        const std::size_t column = message.find("column ");
        const std::size_t start =
            message.find(column == std::string::npos ? "] " : ": ", column == std::string::npos ? 0 : column);
        if (start != std::string::npos) message = message.substr(start + 2);

        const std::string before = text.substr(0, position == 0 ? 0 : position - 1);
        const auto line = 1 + std::count(before.begin(), before.end(), '\n');
        const std::size_t lineStart = before.rfind('\n') + 1; // npos + 1 is 0
        refuseFile(file, fmt::format(":{}:{}", line, before.size() - lineStart + 1), message,
                   "the file must be JSON (RFC 8259)");
    }

private:
    json* place(json value) {
        if (containers.empty()) return &(root = std::move(value));
        if (containers.back()->is_array()) return &containers.back()->emplace_back(std::move(value));
        return &((*containers.back())[keys.back()] = std::move(value));
    }

    bool put(json value) { return place(std::move(value)) != nullptr; }

    bool open(json container) {
        if (containers.size() >= deepest)
            fail(fmt::format("nested deeper than {} levels", deepest), "no scene and no model needs as many");
        containers.push_back(place(std::move(container)));
        keys.emplace_back();
        return true;
    }

    bool close() {
        containers.pop_back();
        keys.pop_back();
        return true;
    }

    /// Fails at the current key or element of the innermost container.
    [[noreturn]] void fail(std::string_view found, std::string_view allowed) const {
        json::json_pointer pointer;
        for (std::size_t i = 0; i < containers.size(); ++i) {
            const std::size_t size = containers[i]->size();
            if (containers[i]->is_object()) pointer /= keys[i];
            else pointer /= i + 1 < containers.size() ? size - 1 : size;
        }
        refuseFile(file, ": " + pointer.to_string(), found, allowed);
    }

    const fs::path& file;
    const std::string& text;
    std::vector<json*> containers; // those that are open, outermost first
    std::vector<std::string> keys; // the current key of each
};

} // namespace

json parseJson(const fs::path& file, const std::string& text) {
    TreeBuilder builder{file, text};
    json::sax_parse(text, &builder);
    return std::move(builder.root);
}

} // namespace vkpm
