/// Seeded mutations of scene files: of their JSON values, of their bytes, and of the words of meshes.
#pragma once
#include "judge.h"
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vkpm {

class Mutator {
public:
    using json = nlohmann::json;

    explicit Mutator(uint seed) : random{seed} {}

    std::size_t below(std::size_t count) { return random.bits() % count; }
    template <class T> const T& oneOf(const std::vector<T>& items) { return items[below(items.size())]; }

    /// Replaces, removes, repeats, moves or wraps one of the values.
    void changeValue(json& scene) {
        std::vector<json::json_pointer> places;
        collect(scene, json::json_pointer{}, places);
        const json::json_pointer place = oneOf(places);
        json& value = scene[place];
        switch (below(8)) {
        case 0:
            value = anyValue();
            return;
        case 1:
            value = json(scene[oneOf(places)]);
            return;
        case 2:
            removeOrRepeat(scene, place);
            return;
        case 3:
            addKey(value, json(scene[oneOf(places)]));
            return;
        case 4:
            wrap(value);
            return;
        default:
            changeNumber(value.is_number() ? value : scene[numberIn(scene, places, place)]);
            return;
        }
    }

    /// What no JSON value can say: words that are no numbers, keys given twice, other line ends.
    void changeJsonText(std::string& text) {
        static const std::vector<std::string> words{
            "NaN",          "-NaN",        "nan",       "Infinity",
            "1e400",        "-1e400",      "1e-400",    "1e39",
            "0x10",         "00",          "-0",        "+1",
            ".5",           "1.",          "1e",        "123456789012345678901234567890",
            "\"\\ud800\"",  "\"\\u0000\"", "truefalse", "/*",
            "\xEF\xBB\xBF", "'",           ",",         "{}{}"};
        if (below(3) == 0) return changeLineEnds(text);
        const std::size_t start = text.find_first_of("0123456789", below(text.size() + 1));
        if (start == std::string::npos) return insert(text, oneOf(words));
        const std::size_t end = std::min(text.find_first_not_of("0123456789.+-eE", start), text.size());
        text.replace(start, end - start, oneOf(words));
    }

    /// Words and lines of a mesh.
    void changeMesh(std::string& text) {
        static const std::vector<std::string> words{"nan",     "-inf",
                                                    "1e39",    "1e400",
                                                    "1e-50",   "0",
                                                    "-1",      "-9",
                                                    "1000000", "99999999999999999999",
                                                    "1//",     "//",
                                                    "/",       "1/2/3/4",
                                                    "1/",      "-1//-1",
                                                    "#",       "\\",
                                                    "f",       "v",
                                                    "vn",      "vt",
                                                    "vw",      "o",
                                                    "g",       "s",
                                                    "l",       "p",
                                                    "t",       "usemtl",
                                                    "mtllib",  "t x 2000000000/0/0",
                                                    "\r",      "\n",
                                                    "\r\n",    "f 1 2 3",
                                                    "v 1 2 3", "f 9 9 9",
                                                    "l 7 8",   "p 99",
                                                    "\t"};
        switch (below(4)) {
        case 0:
            return changeLineEnds(text);
        case 1:
            return insert(text, " " + oneOf(words) + " ");
        case 2:
            return insert(text, "\n" + oneOf(words) + "\n");
        default:
            replaceWord(text, oneOf(words));
        }
    }

    /// Words and lines of a PLY file's header, or of an ascii one's values.
    void changePly(std::string& text) {
        static const std::vector<std::string> words{"nan",
                                                    "-inf",
                                                    "1e39",
                                                    "1e400",
                                                    "-1",
                                                    "9",
                                                    "4000000000",
                                                    "99999999999999999999",
                                                    "list",
                                                    "char",
                                                    "uchar",
                                                    "int",
                                                    "float",
                                                    "double",
                                                    "vertex",
                                                    "face",
                                                    "x",
                                                    "nx",
                                                    "red",
                                                    "vertex_index",
                                                    "ascii",
                                                    "1.0",
                                                    "2",
                                                    "3",
                                                    "0",
                                                    "property",
                                                    "element",
                                                    "end_header",
                                                    "\n",
                                                    "\r\n",
                                                    "property list uchar uchar a",
                                                    "element edge 3",
                                                    "comment a",
                                                    "0.5"};
        if (below(4) == 0)
            return insert(text, (below(2) == 0 ? " " : "\n") + oneOf(words) + (below(2) == 0 ? " " : "\n"));
        replaceWord(text, oneOf(words));
    }

    /// Bytes: turned, cut out, put in, repeated, cut off.
    void changeBytes(std::string& text) {
        if (text.empty()) return insert(text, "x");
        const std::size_t start = below(text.size()),
                          length = std::min(1 + below(below(8) == 0 ? text.size() : 8), text.size() - start);
        switch (below(6)) {
        case 0:
            text[start] = static_cast<char>(text[start] ^ (1 << below(8)));
            return;
        case 1:
            text.erase(start, length);
            return;
        case 2:
            return insert(text, std::string(1, static_cast<char>(random.bits())));
        case 3:
            return insert(text, text.substr(start, length));
        case 4:
            text.resize(start);
            return;
        default:
            for (std::size_t i = 0; i < length; i++) text[start + i] = static_cast<char>(random.bits());
        }
    }

private:
    static void collect(const json& value, const json::json_pointer& here, std::vector<json::json_pointer>& places) {
        places.push_back(here);
        if (value.is_object())
            for (const auto& [key, member] : value.items()) collect(member, here / key, places);
        if (value.is_array())
            for (std::size_t i = 0; i < value.size(); i++) collect(value[i], here / i, places);
    }

    json::json_pointer numberIn(const json& scene, const std::vector<json::json_pointer>& places,
                                const json::json_pointer& otherwise) {
        for (int attempt = 0; attempt < 20; attempt++)
            if (const json::json_pointer& place = oneOf(places); scene[place].is_number()) return place;
        return otherwise;
    }

    double anyNumber() {
        static const std::vector<double> numbers{
            0,     -0.0,  1,      -1,           0.5,          1e-45,        1e-38, 1e-30,        1e-9,   1e-7, 1e7,
            1e9,   1e12,  1e13,   1e18,         1e19,         1e30,         1e38,  3.4028235e38, 3.5e38, 1e39, 1e300,
            1e308, -1e38, -1e300, 2147483648.0, 4294967295.0, 4294967296.0, 65536, 65537,        5e-324};
        return oneOf(numbers);
    }

    void changeNumber(json& value) {
        if (!value.is_number()) return void(value = anyNumber());
        const double x = value.get<double>();
        switch (below(4)) {
        case 0:
            value = anyNumber();
            return;
        case 1:
            value = -x;
            return;
        case 2:
            value = x * std::exp2(double(random.between(-130, 130)));
            return;
        default:
            value = x * double{1 + random.between(-1e-6f, 1e-6f)};
        }
    }

    json anyValue() {
        static const std::vector<json> values{nullptr,
                                              true,
                                              false,
                                              "",
                                              "x",
                                              "grey",
                                              "glass",
                                              "mesh",
                                              "sphere",
                                              "../ball.obj",
                                              "/dev/zero",
                                              "/dev/null",
                                              "/etc/passwd",
                                              ".",
                                              "..",
                                              json::array(),
                                              json::object(),
                                              {1, 2, 3},
                                              {1e38, 1e38, 1e38},
                                              {0, 0, 0},
                                              {{"type", "sphere"}},
                                              {{{"scale", 1e38}}, {{"scale", 1e38}}}};
        if (below(3) == 0) return anyNumber();
        if (below(20) == 0) return std::string(1 + below(20'000), "a\"\n\x1b"[below(4)]);
        return oneOf(values);
    }

    void removeOrRepeat(json& scene, const json::json_pointer& place) {
        if (place.empty()) return;
        json& parent = scene[place.parent_pointer()];
        if (parent.is_object()) return void(parent.erase(place.back()));
        const auto index = static_cast<std::ptrdiff_t>(std::stoul(place.back()));
        if (below(2) == 0) return void(parent.erase(parent.begin() + index));
        const json copy = parent[static_cast<std::size_t>(index)];
        for (std::size_t i = 1 + below(below(8) == 0 ? 300 : 3); i > 0; i--) parent.push_back(copy);
    }

    void addKey(json& value, const json& member) {
        static const std::vector<std::string> keys{
            "",         "type", "file",   "smooth",      "transform", "material", "emission", "radius",
            "twoSided", "tint", "ior",    "exteriorIor", "up",        "settings", "film",     "a/b~c",
            "\x1b[31m", "k\n",  "layers", "kernel",      "nearest",   "alpha"};
        if (value.is_array()) return value.push_back(member);
        if (!value.is_object()) return void(value = member);
        value[below(10) == 0 ? std::string(1 + below(5000), 'k') : oneOf(keys)] = member;
    }

    void wrap(json& value) {
        for (std::size_t depth = 1 + below(below(4) == 0 ? 200 : 3); depth > 0; depth--) {
            json inner = std::move(value);
            value = below(2) == 0 ? json{{"k", std::move(inner)}} : json::array({std::move(inner)});
        }
    }

    void insert(std::string& text, const std::string& what) { text.insert(below(text.size() + 1), what); }

    void changeLineEnds(std::string& text) {
        static const std::vector<std::string> ends{"\r\n", "\r", "\n\n", std::string(1, '\0'), "\\\n", "#\n", "\v"};
        if (below(4) == 0) return void(text.insert(0, "\xEF\xBB\xBF"));
        const std::string& end = oneOf(ends);
        std::string changed;
        const bool all = below(2) == 0;
        for (const char c : text) changed += c == '\n' && (all || below(8) == 0) ? end : std::string(1, c);
        text = changed;
    }

    void replaceWord(std::string& text, const std::string& word) {
        const std::size_t start = std::min(text.find_first_not_of(" \n", below(text.size() + 1)), text.size());
        const std::size_t end = std::min(text.find_first_of(" \n", start), text.size());
        text.replace(start, end - start, word);
    }

    Random random;
};

} // namespace vkpm
