/// Affine transforms of shapes, read from a scene file and baked into world space.
#pragma once
#include "scene/reader.h"
#include <glm/mat4x4.hpp>
#include <optional>

namespace vkpm {

/// An invertible affine map in double precision.
class Transform {
public:
    Transform() = default;
    /// The steps of "transform" applied in order. Throws InputError for a singular or overflowing one.
    explicit Transform(const Reader& steps);
    /// Of a matrix that is not singular.
    explicit Transform(const glm::dmat4& affine) : matrix{affine} {}

    /// Whether a matrix flattens shapes, or overflows.
    static bool isSingular(const glm::dmat4& affine);

    glm::dvec3 point(glm::dvec3 p) const;
    glm::dvec3 direction(glm::dvec3 d) const; // of an edge, with its length
    glm::dvec3 normal(vec3 n) const;          // on the same side of the surface as before, not of unit length
    Transform after(const glm::dmat4& first) const { return Transform{matrix * first}; }
    bool mirrors() const;                       // whether it turns right hands into left ones
    std::optional<double> uniformScale() const; // the factor of all lengths, if there is one

private:
    glm::dmat4 matrix{1};
};

} // namespace vkpm
