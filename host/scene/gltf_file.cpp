/// The containers of glTF: .glb chunks, buffers in files and in data URIs.
#include "scene/gltf_file.h"
#include "scene/gltf_compression.h"
#include "scene/text.h"
#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>

namespace vkpm {
namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t maxGltfText = 256ull << 20;

/// What of glTF's extensions may be required: vkpm reads them, or says what it leaves out.
constexpr std::array knownExtensions{"EXT_mesh_gpu_instancing",
                                     "EXT_meshopt_compression",
                                     "KHR_meshopt_compression",
                                     "KHR_draco_mesh_compression",
                                     "KHR_lights_punctual",
                                     "KHR_materials_anisotropy",
                                     "KHR_materials_clearcoat",
                                     "KHR_materials_dispersion",
                                     "KHR_materials_emissive_strength",
                                     "KHR_materials_ior",
                                     "KHR_materials_iridescence",
                                     "KHR_materials_sheen",
                                     "KHR_materials_specular",
                                     "KHR_materials_transmission",
                                     "KHR_materials_unlit",
                                     "KHR_materials_variants",
                                     "KHR_materials_volume",
                                     "KHR_texture_transform",
                                     "KHR_materials_diffuse_transmission",
                                     "KHR_materials_pbrSpecularGlossiness",
                                     "KHR_mesh_quantization",
                                     "KHR_texture_basisu",
                                     "KHR_texture_transform",
                                     "EXT_texture_webp"};

std::uint32_t littleEndian(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i)
        value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
    return value;
}

int base64Digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

/// Base64 (RFC 4648), of either alphabet.
std::string decodeBase64(const Reader& place, std::string_view text) {
    text = text.substr(0, text.find_last_not_of('=') + 1);
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int digit = base64Digit(c);
        if (digit < 0)
            place.fail(fmt::format("found \"{}\" in base64", printable(std::string(1, c))),
                       "allowed are its 64 digits");
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>(bits >> count & 255);
    }
    return bytes;
}

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/// A relative reference (RFC 3986) without its percent signs.
std::string decodePercent(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool coded =
            uri[i] == '%' && i + 2 < uri.size() && hexDigit(uri[i + 1]) >= 0 && hexDigit(uri[i + 2]) >= 0;
        text += coded ? static_cast<char>(16 * hexDigit(uri[i + 1]) + hexDigit(uri[i + 2])) : uri[i];
        if (coded) i += 2;
    }
    return text;
}

/// Whether a reference is data itself (RFC 2397).
bool isDataUri(std::string_view uri) {
    return std::ranges::equal(uri.substr(0, 5), std::string_view{"data:"}, {},
                              [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
}

/// Whether a reference begins with a scheme, such as "https:".
bool hasScheme(std::string_view uri) {
    const std::size_t end = uri.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+.-");
    return end != uri.npos && end > 1 && uri[end] == ':';
}

} // namespace

bool isKnownExtension(std::string_view name) {
    return std::ranges::find(knownExtensions, name) != knownExtensions.end();
}

bool isGltfName(const fs::path& file) { return hasEnding(file, ".gltf") || hasEnding(file, ".glb"); }

GltfFile::GltfFile(fs::path path) : file{std::move(path)} {
    whole = readBytes(file, maxMeshBytes, "cut it into several", &read.emplace_back());
    bytesRead = whole.size();
    if (whole.starts_with("glTF")) openBinary();
    if (whole.size() > maxGltfText)
        refuseFile(file, ":1", fmt::format("found JSON of more than {} MiB", maxGltfText >> 20),
                   "write it as .glb, or with buffers in files of their own");
    if (whole.starts_with("\xEF\xBB\xBF")) whole.erase(0, 3);
    json = parseJson(file, whole);
    whole.clear();
    whole.shrink_to_fit();
    const std::string version = root().at("asset").at("version").text();
    if (!version.starts_with("2."))
        root().at("asset").at("version").fail(fmt::format("found version \"{}\" of glTF", printable(version, 20)),
                                              "allowed is 2.0; write it anew with a program of today");
    if (const auto least = root().at("asset").find("minVersion"); least && least->text() != "2.0")
        least->fail(fmt::format("the file requires version \"{}\" of glTF", printable(least->text(), 20)),
                    "allowed is 2.0; write it anew for that");
    requireExtensions();
}

/// Takes the chunks of a .glb apart (glTF 2.0, section 4): JSON, and what a buffer without "uri" holds.
void GltfFile::openBinary() {
    const auto refuse = [&](std::size_t byte, const std::string& found, std::string_view allowed) {
        refuseFile(file, fmt::format(": byte {}", byte), found, allowed);
    };
    if (whole.size() < 20) refuse(whole.size(), "the file ends here", "a .glb has 20 bytes of header at least");
    if (const std::uint32_t version = littleEndian(whole, 4); version != 2)
        refuse(4, fmt::format("found version {} of GLB", version),
               "allowed is 2; write it anew with a program of today");
    const std::uint64_t length = littleEndian(whole, 8);
    if (length > whole.size() || length < 20)
        refuse(8, fmt::format("the file says that it has {} bytes", length), fmt::format("it has {}", whole.size()));
    std::string text;
    for (std::uint64_t at = 12, chunk = 0; at + 8 <= length; ++chunk) {
        const std::uint64_t bytes = littleEndian(whole, at);
        const std::string_view kind = std::string_view{whole}.substr(at + 4, 4);
        if (bytes > length - at - 8)
            refuse(at, fmt::format("a chunk says that it has {} bytes", bytes),
                   fmt::format("{} are left", length - at - 8));
        if ((chunk == 0) != (kind == "JSON"))
            refuse(at + 4, "found the chunks in another order", "the first, and it alone, is JSON");
        if (chunk == 0) text = whole.substr(at + 8, bytes);
        else if (kind == std::string_view{"BIN\0", 4} && !binary) binary = whole.substr(at + 8, bytes);
        at += 8 + bytes;
    }
    whole = std::move(text);
}

void GltfFile::requireExtensions() const {
    const auto required = root().find("extensionsRequired");
    for (std::size_t i = 0; required && i < required->count(0, 1000, "an array of names"); ++i) {
        const std::string name = required->element(i).text();
        const std::string found = fmt::format("the file requires the extension \"{}\"", printable(name, 60));
        if (!isKnownExtension(name)) required->element(i).fail(found, "vkpm has not got it; write the file without");
    }
}

Reader GltfFile::referenced(const Reader& index, std::string_view list) const {
    const auto all = root().find(list);
    const std::size_t count = all ? all->count(0, NONE, "an array") : 0;
    if (count == 0) index.fail(index.describe(), fmt::format("the file has no \"{}\"", list));
    return all->element(index.integer(0, static_cast<uint>(count - 1)));
}

/// What an object with "buffer", "byteOffset" and "byteLength" refers to.
std::string_view GltfFile::bytesOf(Reader place) {
    const std::string& bytes = buffer(place.at("buffer"));
    const auto offset = place.find("byteOffset");
    const std::uint64_t begin = offset ? offset->integer(0, NONE) : 0, length = place.at("byteLength").integer(1, NONE);
    if (begin + length > bytes.size())
        place.fail(fmt::format("found bytes {} to {} of a buffer", begin, begin + length),
                   fmt::format("it has {}", bytes.size()));
    return std::string_view{bytes}.substr(begin, length);
}

GltfView GltfFile::view(const Reader& index) {
    Reader place = referenced(index, "bufferViews");
    GltfView view{place, {}, std::nullopt};
    if (const auto packed = meshoptOf(place)) {
        const uint number = index.integer(0, NONE);
        if (!unpackedViews.contains(number)) unpackedViews[number] = unpackMeshopt(*packed, bytesOf(*packed));
        view.bytes = unpackedViews[number];
    } else view.bytes = bytesOf(place);
    if (const auto stride = place.find("byteStride")) view.stride = stride->integer(1, 65536);
    return view;
}

const std::string* GltfFile::given(const Reader& accessor) const {
    const auto found = unpacked.find(accessor.integer(0, NONE));
    return found == unpacked.end() ? nullptr : &found->second;
}

const std::string& GltfFile::buffer(const Reader& index) {
    const Reader place = referenced(index, "buffers");
    const std::size_t number = index.integer(0, NONE);
    if (buffers.size() <= number) buffers.resize(number + 1);
    if (!buffers[number]) buffers[number] = loadBuffer(place, number);
    return *buffers[number];
}

std::string GltfFile::loadBuffer(Reader place, std::size_t number) {
    const std::uint64_t length = place.at("byteLength").integer(1, NONE);
    const auto uri = place.find("uri");
    std::string bytes;
    if (uri) {
        bytes = loadUri(*uri);
    } else if (number == 0 && binary) {
        bytes = std::move(*binary);
    } else {
        place.fail("found a buffer without \"uri\"",
                   "only the first one of a .glb may do without: what it holds follows the JSON");
    }
    if (bytes.size() < length)
        place.fail(fmt::format("found a buffer of {} bytes", length),
                   fmt::format("what it names has {}", bytes.size()));
    bytes.resize(length);
    return bytes;
}

std::string GltfFile::loadUri(const Reader& uri) {
    const std::string text = uri.text();
    const std::string_view data = text;
    const std::size_t comma = isDataUri(data) ? data.find(',') : data.npos;
    if (comma == data.npos) return loadFile(uri, text);
    return data.substr(0, comma).ends_with(";base64") ? decodeBase64(uri, data.substr(comma + 1))
                                                      : decodePercent(data.substr(comma + 1));
}

std::string GltfFile::image(Reader& place) {
    if (const auto uri = place.find("uri")) return loadUri(*uri);
    return std::string{view(place.at("bufferView")).bytes};
}

std::string GltfFile::loadFile(const Reader& uri, const std::string& text) {
    if (hasScheme(text))
        uri.fail(fmt::format("found the URI \"{}\"", printable(text, 60)),
                 "allowed is a file, relative to this one, or \"data:...;base64,...\"; vkpm fetches nothing");
    const std::string name = decodePercent(text);
    if (name.find('\0') != name.npos) uri.fail("found a byte 0 in a name", "allowed is the name of a file");
    const fs::path path = file.parent_path() / name;
    if (const std::string problem = fileProblem(path, true); !problem.empty())
        uri.fail(fmt::format("{}: {}", path.string(), problem), "give a file, relative to this one");
    std::string bytes = readBytes(path, maxMeshBytes, "cut it into several", &read.emplace_back());
    bytesRead += bytes.size();
    return bytes;
}

} // namespace vkpm
