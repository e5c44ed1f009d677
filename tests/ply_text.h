/// PLY files for tests: a square of two triangles and a pentagon beside it.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <vector>

namespace vkpm {

inline const std::vector<std::array<float, 3>> plyPoints{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                                         {2, 0, 0}, {3, 1, 0}, {2, 2, 0}};
inline const std::vector<std::vector<int>> plyFaces{{0, 1, 2}, {0, 2, 3}, {1, 4, 5, 6, 2}};

inline std::string plyHeader(const std::string& format) {
    return "ply\nformat " + format + " 1.0\ncomment a square\nelement vertex 7\nproperty float x\nproperty float y\n" +
           "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n" +
           "element marker 2\nproperty list uchar short path\nproperty double weight\n" +
           "element face 3\nproperty uchar flags\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string asciiPly() {
    std::string text = plyHeader("ascii");
    for (const auto& [x, y, z] : plyPoints)
        text += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + " 0 0 1 255\n";
    text += "2 7 8 0.5\n0 1e3\n";
    for (const std::vector<int>& face : plyFaces) {
        text += "1 " + std::to_string(face.size());
        for (const int corner : face) text += " " + std::to_string(corner);
        text += "\n";
    }
    return text;
}

template <std::endian order> std::string binaryPly() {
    std::string text = plyHeader(order == std::endian::little ? "binary_little_endian" : "binary_big_endian");
    const auto add = [&](auto value) {
        auto raw = std::bit_cast<std::array<char, sizeof value>>(value);
        if (order != std::endian::native) std::ranges::reverse(raw);
        text.append(raw.data(), raw.size());
    };
    using uchar = unsigned char;
    for (const auto& [x, y, z] : plyPoints) {
        for (const float value : {x, y, z, 0.0f, 0.0f, 1.0f}) add(value);
        add(uchar{255});
    }
    add(uchar{2}), add(short{7}), add(short{8}), add(0.5), add(uchar{0}), add(1e3);
    for (const std::vector<int>& face : plyFaces) {
        add(uchar{1}), add(static_cast<uchar>(face.size()));
        for (const int corner : face) add(corner);
    }
    return text;
}

} // namespace vkpm
