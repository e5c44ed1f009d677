/// The program run as a child process.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace vkpm {

namespace fs = std::filesystem;

struct Result {
    int code = 0;
    std::string output; // stdout and stderr
};

inline std::string bytesOf(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Runs the program in a folder of its own.
class Program : public testing::Test {
protected:
    void SetUp() override {
        folder = fs::temp_directory_path() / ("vkpm-program-test-" + std::to_string(::getpid()));
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }

    /// `environment` is set for this run, as in NAME=value.
    Result run(const std::string& arguments, const std::string& environment = "") const {
        const fs::path log = folder / "log.txt";
        const std::string command = "cd '" + folder.string() + "' && " + environment + " '" VKPM_PROGRAM "' " +
                                    arguments + " > '" + log.string() + "' 2>&1";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytesOf(log)};
    }

    static std::string scene(const std::string& name) { return std::string(VKPM_SCENES) + "/" + name + ".json"; }
    const std::string small = " --size 24x16 --passes 2 --photons 500 --caustic-photons 500 ";

    fs::path folder;
};

} // namespace vkpm
