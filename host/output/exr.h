/// Images in OpenEXR files.
#pragma once
#include "output/image.h"
#include <filesystem>
#include <functional>
#include <memory>
#include <span>

namespace vkpm {

/// What the names of our attributes begin with in a file.
inline const std::string exrPrefix = "vkpm/";

/// Rows `first` to `first + count - 1` of an image that need not be in memory as a whole: all its channels, the same
/// for any rows, for no rows too. From several threads at a time.
using ImageRows = std::function<Image(uint first, uint count)>;

/// Writes scanlines, ZIP compressed, linear Rec.709, and the attributes as strings named vkpm/...; the file is replaced
/// as a whole, and depends on the image alone. Returns how many values were too large for 16-bit floats and became the
/// largest of these. Throws std::runtime_error with file and cause.
std::uint64_t writeExr(const std::filesystem::path& path, uvec2 size,
                       const std::map<std::string, std::string>& attributes, const ImageRows& rows);
std::uint64_t writeExr(const std::filesystem::path& path, const Image& image);

/// Pixels from low to high, both included.
struct PixelBox {
    glm::ivec2 low{0};
    glm::ivec2 high{-1};
    bool operator==(const PixelBox&) const = default;
};

/// "10,20 to 73,83", for messages.
std::string describe(const PixelBox& window);

/// An EXR file that is open for reading: all flat parts as one picture, which is what lies in the display window.
/// Channels of other programs have our names as far as they say the same (see output/channel_names.h). Reads what is
/// asked for, and no more than the chunks of rows that have it. Throws InputError with file and cause if the file is
/// missing or damaged.
class ExrFile {
public:
    struct Entry {
        std::string name;   // ours
        std::string inFile; // with the name of the part before it, if that tells channels apart
        PixelBox window;    // that has values, relative to the corner of the picture
        std::string channel;
        int part = 0;
        Storage storage = Storage::float32;
    };

    explicit ExrFile(const std::filesystem::path& path);
    ~ExrFile();
    ExrFile(ExrFile&&) noexcept;
    ExrFile& operator=(ExrFile&&) noexcept;

    uvec2 size() const { return pictureSize; }
    const std::vector<Entry>& entries() const { return list; }
    const std::map<std::string, std::string>& attributes() const { return texts; }
    /// What the file has that is left out, for messages; empty if nothing is.
    const std::string& leftOut() const { return skipped; }

    /// Channels without values.
    Image header() const;
    /// Channels by name, in a region within the windows of all of them.
    Image read(std::span<const std::string> names, const PixelBox& region) const;
    /// Throws InputError unless all channels cover the picture.
    void requireWhole() const;

private:
    struct Parts;
    std::filesystem::path path;
    std::unique_ptr<Parts> parts;
    uvec2 pictureSize{0};
    std::vector<Entry> list;
    std::map<std::string, std::string> texts;
    std::string skipped;
};

/// All channels of the whole picture, and its vkpm/ attributes. Throws InputError also if the channels do not cover the
/// picture.
Image readExr(const std::filesystem::path& path);

/// The same without the values of its channels.
Image readExrHeader(const std::filesystem::path& path);

} // namespace vkpm
