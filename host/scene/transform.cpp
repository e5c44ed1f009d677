/// Affine transforms: steps of translation, rotation, scale and matrix.
#include "scene/transform.h"
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

namespace vkpm {
using glm::dmat3, glm::dmat4, glm::dvec3, glm::dvec4;

namespace {

dmat4 readRotation(Reader rotation) {
    const Reader axisReader = rotation.at("axis");
    const dvec3 axis = axisReader.place();
    const double degrees = rotation.at("degrees").precise();
    rotation.finish();
    if (glm::length(axis) == 0) axisReader.fail("the axis has length 0", "give a direction, such as [0, 1, 0]");
    return glm::rotate(dmat4{1}, glm::radians(degrees), axis);
}

dmat4 readScale(const Reader& scale) {
    const dvec3 factors = scale.isNumber() ? dvec3{scale.precise()} : scale.place();
    if (factors.x == 0 || factors.y == 0 || factors.z == 0)
        scale.fail("found a factor of 0", "allowed are factors other than 0; a negative one mirrors");
    return glm::scale(dmat4{1}, factors);
}

dmat4 readMatrix(const Reader& reader) {
    const std::vector<Reader> entries = reader.elements(16, 16, "an array of 16 numbers, row by row");
    dmat4 matrix{1};
    for (int i = 0; i < 16; ++i) matrix[i % 4][i / 4] = entries[i].precise();
    if (glm::row(matrix, 3) != dvec4{0, 0, 0, 1})
        reader.fail("the last row is not 0 0 0 1", "only affine matrices are allowed");
    return matrix;
}

dmat4 readStep(Reader step) {
    if (step.keys().size() != 1)
        step.fail(step.describe() + (step.keys().empty() ? " without keys" : " with several keys"),
                  "a step has one of \"translate\", \"rotate\", \"scale\" or \"matrix\"");
    dmat4 matrix{1};
    if (const auto translate = step.find("translate")) matrix = glm::translate(dmat4{1}, translate->place());
    if (const auto rotate = step.find("rotate")) matrix = readRotation(*rotate);
    if (const auto scale = step.find("scale")) matrix = readScale(*scale);
    if (const auto rows = step.find("matrix")) matrix = readMatrix(*rows);
    step.finish();
    return matrix;
}

/// Volume of the parallelepiped of the images of the axes over that of the box of the same edge lengths.
double orthogonality(const dmat3& m) {
    return std::abs(glm::determinant(m)) / (glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2]));
}

} // namespace

Transform::Transform(const Reader& steps) {
    const std::size_t many = 1000;
    for (const Reader& step : steps.elements(0, many, "an array of steps, [{\"translate\": [x, y, z]}, ...]"))
        matrix = readStep(step) * matrix;
    if (isSingular(matrix))
        steps.fail("the transform is singular: it flattens the shape or overflows",
                   "let it keep the three dimensions apart");
}

bool Transform::isSingular(const dmat4& affine) {
    const dvec4 sum = affine[0] + affine[1] + affine[2] + affine[3];
    return !(orthogonality(dmat3{affine}) > 1e-12) || !std::isfinite(sum.x + sum.y + sum.z); // also for NaN
}

dvec3 Transform::point(dvec3 p) const { return dvec3{matrix * dvec4{p, 1}}; }

dvec3 Transform::direction(dvec3 d) const { return dmat3{matrix} * d; }

glm::dvec3 Transform::normal(vec3 n) const { return glm::transpose(glm::inverse(dmat3{matrix})) * dvec3{n}; }

bool Transform::mirrors() const { return glm::determinant(dmat3{matrix}) < 0; }

std::optional<double> Transform::uniformScale() const {
    const dmat3 m{matrix};
    const double factor = std::cbrt(std::abs(glm::determinant(m)));
    const dmat3 stretch = glm::transpose(m) * m / (factor * factor); // the identity for a uniform scale

    constexpr double tolerance = 1e-4; // of matrices written with few digits
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (std::abs(stretch[column][row] - (column == row)) > tolerance) return std::nullopt;
    return factor;
}

} // namespace vkpm
