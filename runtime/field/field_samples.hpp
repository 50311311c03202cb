#pragma once

// A field that another program has computed, and what the vertices of a mesh take of it.

#include <array>
#include <complex>
#include <vector>

#include "runtime/core/result.hpp"
#include "runtime/field/field_mesh.hpp"

namespace espalier {

// Vectors or symmetric tensors at points, all in object space. Either there is a vector for each point, or a tensor.
struct FieldSamples {
    std::vector<glm::vec3> points;  // metres
    std::vector<glm::vec3> vectors;
    std::vector<std::array<float, 6>> tensors;  // xx, yy, zz, xy, xz, yz
    bool operator==(const FieldSamples&) const = default;
};

// Vectors over the walk's UV square, in object space; rows begin at v = 0. A vector of length 0 says nothing.
struct VectorPicture {
    uint32_t width = 0, height = 0;
    std::vector<glm::vec3> texels;
    bool operator==(const VectorPicture&) const = default;
};

// What samples say at each vertex: as of Field. wish: of length 1; 0: there is no direction, or no point lies near.
struct SampledVertices {
    std::vector<std::complex<double>> wish;
    std::vector<float> mean, deviator;
    size_t near = 0;  // vertices that have a point near by, that is within a hundredth of the mesh's radius
};

// A vertex takes the point at its place; where there is none, a mean of those nearest to it, nearer ones counting
// more. The length of a vector and the eigenvalues of a tensor are those of the part that lies in the surface. Fails
// where no vertex has a point near by, and for tensors where the symmetry is odd: they have no front and back.
Result<SampledVertices> sampleVertices(const FieldMesh& mesh, const FieldSamples& samples, uint32_t symmetry);

// What a picture says at the vertices; those at which it says nothing are left out. mesh: made from the surface.
FieldSamples samplesOf(const SurfaceData& surface, const FieldMesh& mesh, const VectorPicture& picture);

}  // namespace espalier
