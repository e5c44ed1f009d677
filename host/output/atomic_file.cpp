/// Files that are replaced as a whole: written beside the old one, flushed, then renamed over it.
#include "output/atomic_file.h"
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <stdexcept>
#include <unistd.h>
#include <utility>
#include <vector>

namespace vkpm {
namespace {

namespace fs = std::filesystem;

const char* whatHelps(int error) {
    if (error == ENOSPC || error == EDQUOT) return "; free some space, or choose another folder";
    if (error == EFBIG) return "; raise the limit on the size of files (ulimit -f)";
    if (error == EACCES || error == EROFS) return "; choose a folder that you may write to";
    if (error == ENOENT) return "; create the folder first, or choose another one";
    if (error == EISDIR) return "; choose a name that is not a folder's";
    return "";
}

[[noreturn]] void fail(const fs::path& path, const char* call, int error) {
    throw std::runtime_error(fmt::format("{}: {}: {}{}", path.string(), call, std::strerror(error), whatHelps(error)));
}

} // namespace

/// A file open for writing; removed again at the end of its life unless it was renamed or is a device.
class Output {
public:
    Output(fs::path written, fs::path reported, int flags, bool temporary)
        : path(std::move(written)), shown(std::move(reported)), removed(temporary) {
        descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | flags, 0666);
        if (descriptor < 0) fail(shown, "open", errno);
    }
    ~Output() {
        if (descriptor >= 0) ::close(descriptor);
        if (removed) ::unlink(path.c_str());
    }
    Output(const Output&) = delete;
    Output& operator=(const Output&) = delete;

    void write(std::span<const char> bytes) {
        while (!bytes.empty()) {
            const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
            if (written < 0 && errno != EINTR) fail(shown, "write", errno);
            if (written > 0) bytes = bytes.subspan(static_cast<size_t>(written));
        }
    }

    void writeAt(std::span<const char> bytes, std::uint64_t offset) {
        while (!bytes.empty()) {
            const ssize_t written = ::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
            if (written < 0 && errno != EINTR) fail(shown, "write", errno);
            if (written <= 0) continue;
            bytes = bytes.subspan(static_cast<size_t>(written));
            offset += static_cast<std::uint64_t>(written);
        }
    }

    void flush() {
        // Some file systems cannot flush; that alone is no reason to lose a picture.
        if (::fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP) fail(shown, "fsync", errno);
    }

    void close() {
        const int result = ::close(std::exchange(descriptor, -1));
        if (result != 0 && errno != EINTR) fail(shown, "close", errno);
    }

    void renameTo(const fs::path& target) {
        if (::rename(path.c_str(), target.c_str()) != 0) fail(shown, "rename", errno);
        removed = false;
    }

private:
    fs::path path;
    fs::path shown;
    bool removed;
    int descriptor = -1;
};

namespace {

/// The file that a name stands for: symbolic links stay links, and what they point to is replaced.
fs::path resolve(const fs::path& path) {
    std::error_code error;
    const fs::path target = fs::is_symlink(path, error) ? fs::canonical(path, error) : path;
    return target.empty() ? path : target;
}

/// The temporary file of a target, in the same folder, named so that two processes do not share it.
Output openBeside(const fs::path& target, const fs::path& shown) {
    fs::path part = target;
    part += fmt::format(".{}.part", ::getpid());
    return {part, shown, O_CREAT | O_TRUNC | O_NOFOLLOW, true};
}

/// Removes temporary files of the target that killed processes have left.
void removeLeftovers(const fs::path& target) {
    const std::string prefix = target.filename().string() + ".";
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(target.has_parent_path() ? target.parent_path() : ".", error)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(prefix) || !name.ends_with(".part")) continue;
        const std::string middle = name.substr(prefix.size(), name.size() - prefix.size() - std::strlen(".part"));
        int process = 0;
        const auto [end, problem] = std::from_chars(middle.data(), middle.data() + middle.size(), process);
        const bool gone = process > 0 && ::kill(process, 0) != 0 && errno == ESRCH;
        if (problem == std::errc() && end == middle.data() + middle.size() && gone) ::unlink(entry.path().c_str());
    }
}

/// Whether the name is that of something that cannot be replaced by a file, such as /dev/stdout.
bool isDevice(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) fail(path, "open", EISDIR);
    return fs::exists(status) && !fs::is_regular_file(status);
}

/// Makes a rename survive a power failure; some file systems cannot, and the file is whole either way.
void flushFolder(const fs::path& target) {
    const fs::path folder = target.has_parent_path() ? target.parent_path() : ".";
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::fsync(descriptor);
    ::close(descriptor);
}

} // namespace

struct FileReplacement::Parts {
    explicit Parts(const fs::path& path)
        : device(isDevice(path)), target(device ? path : resolve(path)),
          output(device ? Output(path, path, 0, false) : openBeside(target, path)) {}

    bool device;
    fs::path target;
    Output output;
    std::vector<char> content; // of a device
};

FileReplacement::FileReplacement(const fs::path& path) : parts(std::make_unique<Parts>(path)) {}
FileReplacement::~FileReplacement() = default;

void FileReplacement::write(std::span<const char> bytes, std::uint64_t offset) {
    if (!parts->device) return parts->output.writeAt(bytes, offset);
    if (offset + bytes.size() > parts->content.size()) parts->content.resize(offset + bytes.size());
    std::ranges::copy(bytes, parts->content.begin() + static_cast<std::ptrdiff_t>(offset));
}

void FileReplacement::commit() {
    if (parts->device) return parts->output.write(parts->content);
    parts->output.flush();
    parts->output.close();
    parts->output.renameTo(parts->target);
    flushFolder(parts->target);
}

void replaceFile(const fs::path& path, std::span<const char> bytes) {
    FileReplacement file(path);
    file.write(bytes, 0);
    file.commit();
}

void requireWritable(const fs::path& path) {
    if (isDevice(path)) return;
    openBeside(resolve(path), path);
    removeLeftovers(resolve(path));
}

} // namespace vkpm
